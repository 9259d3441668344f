//! The journal: events on standard error, and the recorded session.

use std::fmt::Display;
use std::io;
use std::time::Duration;

use moris_live::log::Entry;
use moris_live::session::TelemetryFault;
use moris_live::signs::{Check, Verdict};
use moris_live::source::{DropReason, Health};
use moris_live::table_check::TableFault;
use moris_live::{Legs, Refusal, State};
use rtrb::Consumer;

use super::Shared;
use super::frames::Loss;
use super::recorder::Recorder;
use super::thread_monitor::Part;

/// Something that happened at a time \[s\].
#[derive(Clone, Copy, Debug)]
pub enum Note {
    /// An event or a sample, for the recorded session.
    Entry(Entry),
    /// A new state.
    State(State),
    /// A new health of the source, and the cause of its last pause.
    Source(Health, &'static str),
    /// A command was refused.
    Refused(Refusal),
    /// A check of the signs has decided.
    Sign(Check, Verdict),
    /// The telemetry does not fit its table.
    Table(TableFault),
    /// Of so many samples so many were dropped, the last one for this reason.
    SamplesDropped([u64; 2], DropReason),
    /// Samples, and those of them that repeat the one before.
    SamplesRepeated([u64; 2]),
    /// Parameters were chosen; true if they are in force.
    Retuned(bool),
    /// The computer was late: the session's clock has slipped by this time \[s\].
    Slipped(f64),
    /// The controller does not follow any more.
    Lost(Loss),
    /// The place of the legs at a start, and the time for which the first lengths are held \[s\].
    Located(Legs, f64),
    /// The operator says that the platform is settled, and the last frames have left
    /// it so far away \[m\].
    Doubted(f64),
    /// The telemetry's delay is long \[s\].
    Delayed(f64),
    /// A thread has ended by an error of this program.
    Failed(Part),
}

/// A line with the time \[s\] at which it was so.
pub fn timed(time: f64, text: impl Display) -> String {
    format!("{time:9.3} s  {text}")
}

/// The text of a note; none if only the recording has it.
fn text(note: &Note) -> Option<String> {
    Some(match note {
        Note::Entry(_) | Note::Retuned(true) => return None,
        Note::State(state) => state.name().to_owned(),
        Note::Source(health @ Health::Paused, cause) => format!("telemetry: {}: {cause}", health.name()),
        Note::Source(health, _) => format!("telemetry: {}", health.name()),
        Note::Refused(refusal) => format!("refused: {refusal}"),
        Note::Sign(check, Verdict::Contradicts) => TelemetryFault::Sign(*check).to_string(),
        Note::Sign(check, _) => format!("sign agrees: {}", check.text()),
        Note::Table(fault) => TelemetryFault::Table(*fault).to_string(),
        Note::SamplesDropped([received, dropped], reason) => {
            format!("{dropped} of {received} samples dropped: {reason}")
        }
        Note::SamplesRepeated([received, same]) => format!(
            "{same} of {received} samples repeat the one before: the motion changes in steps. Let the source send \
             each sample once"
        ),
        Note::Retuned(false) => "refused: these parameters cannot change now".to_owned(),
        Note::Slipped(late) => format!("the computer was late by {late:.3} s"),
        Note::Lost(loss) => loss.to_string(),
        Note::Located(Legs::Reported(_), _) => "legs: as the controller reports".to_owned(),
        Note::Located(Legs::Slow, hold) => {
            format!("legs: a slow start; the first lengths are held for {hold:.0} s")
        }
        Note::Located(legs, _) => format!("legs: {}", legs.name()),
        Note::Doubted(away) => format!(
            "refused: the last frames have left a leg {:.0} mm from the lowest pose. Look, and say settled again if it \
             is there",
            1e3 * away
        ),
        Note::Delayed(delay) => {
            format!("the telemetry's delay is {:.0} ms: packets come with gaps", 1e3 * delay)
        }
        Note::Failed(part) => {
            format!("the thread that {} has failed: the session parks and ends", part.name())
        }
    })
}

/// Keeps the journal until the loop has ended. The page gets its lines, too.
///
/// # Errors
/// The file cannot be written.
pub fn write_notes(mut notes: Consumer<(f64, Note)>, mut record: Option<Recorder>, shared: &Shared) -> io::Result<()> {
    let mut recorded = Ok(());
    loop {
        let ended = notes.is_abandoned();
        while let Ok((time, note)) = notes.pop() {
            if let (Note::Entry(entry), Some(recorder)) = (note, &record) {
                recorded = recorder.take(entry);
            } else if let Some(text) = text(&note) {
                shared.say(&timed(time, text));
            }
            // The platform goes on without its recording.
            if let (Err(error), Some(_)) = (&recorded, &record) {
                shared.say(&format!("the recording has ended: {error}"));
                record = None;
            }
        }
        if ended {
            let recorded = recorded.and_then(|()| record.map_or(Ok(()), Recorder::end));
            // As a text: a pipe that is closed is no success of the command here.
            return recorded.map_err(|error| io::Error::other(error.to_string()));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}
