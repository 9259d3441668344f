//! The journal: events on standard error, and the recorded session.

use std::io;
use std::time::Duration;

use moris_live::log::Entry;
use moris_live::session::TelemetryFault;
use moris_live::signs::{Check, Verdict};
use moris_live::source::{DropReason, Health};
use moris_live::table_check::TableFault;
use moris_live::{Legs, Refusal, State};
use rtrb::Consumer;

use super::console;
use super::frames::Loss;
use super::page::ControlBroker;
use super::recorder::Recorder;
use super::thread_monitor::Part;

/// Something that happened at a time \[s\].
#[derive(Clone, Copy, Debug)]
pub enum Note {
    /// An event or a sample, for the recorded session.
    Entry(Entry),
    /// A new state.
    State(f64, State),
    /// A new health of the source, and the cause of its last pause.
    Source(f64, Health, &'static str),
    /// A command was refused.
    Refused(f64, Refusal),
    /// A check of the signs has decided.
    Sign(f64, Check, Verdict),
    /// The telemetry does not fit its table.
    Table(f64, TableFault),
    /// Of so many samples so many were dropped, the last one for this reason.
    SamplesDropped(f64, [u64; 2], DropReason),
    /// Samples, and those of them that repeat the one before.
    SamplesRepeated(f64, [u64; 2]),
    /// Parameters were chosen; true if they are in force.
    Retuned(f64, bool),
    /// The computer was late: the session's clock has slipped by this time \[s\].
    Slipped(f64, f64),
    /// The controller does not follow any more.
    Lost(f64, Loss),
    /// The place of the legs at a start, and the time for which the first lengths are held \[s\].
    Located(f64, Legs, f64),
    /// The operator says that the platform is settled, and the last frames have left
    /// it so far away \[m\].
    Doubted(f64, f64),
    /// The telemetry's delay is long \[s\].
    Delayed(f64, f64),
    /// A thread has ended by an error of this program.
    Failed(f64, Part),
}

/// The line of a new state.
pub fn state_line(time: f64, state: State) -> String {
    format!("{time:9.3} s  {}", state.name())
}

/// The line of what happened; none for what is only recorded.
fn line(note: &Note) -> Option<String> {
    Some(match note {
        Note::Entry(_) => return None,
        Note::State(time, state) => state_line(*time, *state),
        Note::Source(time, health @ Health::Paused, cause) => {
            format!("{time:9.3} s  telemetry: {}: {cause}", health.name())
        }
        Note::Source(time, health, _) => format!("{time:9.3} s  telemetry: {}", health.name()),
        Note::Refused(time, refusal) => format!("{time:9.3} s  refused: {refusal}"),
        Note::Sign(time, check, Verdict::Contradicts) => {
            format!("{time:9.3} s  {}", TelemetryFault::Sign(*check))
        }
        Note::Sign(time, check, _) => format!("{time:9.3} s  sign agrees: {}", check.text()),
        Note::Table(time, fault) => format!("{time:9.3} s  {}", TelemetryFault::Table(*fault)),
        Note::SamplesDropped(time, [received, dropped], reason) => {
            format!("{time:9.3} s  {dropped} of {received} samples dropped: {reason}")
        }
        Note::SamplesRepeated(time, [received, same]) => format!(
            "{time:9.3} s  {same} of {received} samples repeat the one before: the motion changes in steps. Let the \
             source send each sample once"
        ),
        Note::Retuned(_, true) => return None,
        Note::Retuned(time, false) => format!("{time:9.3} s  refused: these parameters cannot change now"),
        Note::Slipped(time, late) => format!("{time:9.3} s  the computer was late by {late:.3} s"),
        Note::Lost(time, loss) => format!("{time:9.3} s  {loss}"),
        Note::Located(time, Legs::Reported(_), _) => format!("{time:9.3} s  legs: as the controller reports"),
        Note::Located(time, Legs::Slow, hold) => {
            format!("{time:9.3} s  legs: a slow start; the first lengths are held for {hold:.0} s")
        }
        Note::Located(time, legs, _) => format!("{time:9.3} s  legs: {}", legs.name()),
        Note::Doubted(time, away) => format!(
            "{time:9.3} s  refused: the last frames have left a leg {:.0} mm from the lowest pose. Look, and say settled \
             again if it is there",
            1e3 * away
        ),
        Note::Delayed(time, delay) => {
            format!("{time:9.3} s  the telemetry's delay is {:.0} ms: packets come with gaps", 1e3 * delay)
        }
        Note::Failed(time, part) => {
            format!("{time:9.3} s  the thread that {} has failed: the session parks and ends", part.name())
        }
    })
}

/// Keeps the journal until the loop has ended. The page gets its lines, too.
///
/// # Errors
/// The file cannot be written.
pub fn write_notes(
    mut notes: Consumer<Note>,
    mut record: Option<Recorder>,
    page: Option<&ControlBroker>,
) -> io::Result<()> {
    let mut recorded = Ok(());
    loop {
        let ended = notes.is_abandoned();
        while let Ok(note) = notes.pop() {
            if let (Note::Entry(entry), Some(recorder)) = (note, &record) {
                recorded = recorder.take(entry);
            } else if let Some(line) = line(&note) {
                say(&line, page);
            }
            // The platform goes on without its recording.
            if let (Err(error), Some(_)) = (&recorded, &record) {
                say(&format!("the recording has ended: {error}"), page);
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

/// Prints a line, and shows it in the page.
pub fn say(line: &str, page: Option<&ControlBroker>) {
    console::line(line);
    page.inspect(|page| page.log_line(line));
}
