//! The journal: events on standard error, and the recorded session.

use std::fs::File;
use std::io::{self, BufWriter, Write, stderr};
use std::time::Duration;

use moris_live::log::Entry;
use moris_live::signs::{Check, Verdict};
use moris_live::source::Health;
use moris_live::{Refusal, State};
use rtrb::Consumer;

/// Something that happened at a time \[s\].
#[derive(Clone, Copy, Debug)]
pub enum Note {
    /// An event or a sample, for the recorded session.
    Entry(Entry),
    /// A new state.
    State(f64, State),
    /// A new health of the source.
    Source(f64, Health),
    /// A command was refused.
    Refused(f64, Refusal),
    /// A check of the signs has decided.
    Sign(f64, Check, Verdict),
    /// The computer was late: the session's clock has slipped by this time \[s\].
    Slipped(f64, f64),
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
        Note::Source(time, health) => format!("{time:9.3} s  telemetry: {}", health.name()),
        Note::Refused(time, refusal) => format!("{time:9.3} s  refused: {refusal}"),
        Note::Sign(time, check, Verdict::Contradicts) => {
            format!("{time:9.3} s  WRONG SIGN, expected: {}", check.text())
        }
        Note::Sign(time, check, _) => format!("{time:9.3} s  sign agrees: {}", check.text()),
        Note::Slipped(time, late) => format!("{time:9.3} s  the computer was late by {late:.3} s"),
    })
}

/// Keeps the journal until the loop has ended.
///
/// # Errors
/// The file cannot be written.
pub fn keep(mut notes: Consumer<Note>, record: Option<File>) -> io::Result<()> {
    let mut record = record.map(BufWriter::new);
    loop {
        let ended = notes.is_abandoned();
        while let Ok(note) = notes.pop() {
            match (note, &mut record) {
                (Note::Entry(entry), Some(file)) => writeln!(file, "{entry}")?,
                // The reader of the lines may be gone.
                _ => drop(line(&note).map(|line| writeln!(stderr(), "{line}"))),
            }
        }
        if ended {
            return record.map_or(Ok(()), |mut file| file.flush());
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}
