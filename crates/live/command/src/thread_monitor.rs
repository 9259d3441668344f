//! Threads of a session: an end that nobody has asked for is a failure, after which it parks.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU8, Ordering};

/// A thread of a session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Commands,
    Telemetry,
    Frames,
    Journal,
    Page,
}

impl Part {
    /// All parts of the program that are watched.
    pub const ALL: [Part; 5] = [Part::Commands, Part::Telemetry, Part::Frames, Part::Journal, Part::Page];

    /// The part's work, in a word.
    pub fn name(self) -> &'static str {
        match self {
            Part::Commands => "reads commands",
            Part::Telemetry => "receives telemetry",
            Part::Frames => "sends frames",
            Part::Journal => "keeps the journal",
            Part::Page => "serves the page",
        }
    }
}

/// Threads that have failed.
#[derive(Debug, Default)]
pub struct Failed(AtomicU8);

impl Failed {
    /// A thread has failed.
    pub fn add(&self, part: Part) {
        self.0.fetch_or(1 << part as u8, Ordering::Relaxed);
    }

    /// True if a thread has failed.
    pub fn has(&self, part: Part) -> bool {
        self.0.load(Ordering::Relaxed) & 1 << part as u8 != 0
    }
}

/// Does a thread's work; none after a panic, which is its failure.
pub fn watch<T>(failed: &Failed, part: Part, work: impl FnOnce() -> T) -> Option<T> {
    // What the threads share is whole between two operations: rings, flags and counts.
    let done = catch_unwind(AssertUnwindSafe(work));
    if done.is_err() {
        failed.add(part);
    }
    done.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_the_failure_of_its_thread_alone() {
        for part in Part::ALL {
            let failed = Failed::default();
            assert_eq!(watch(&failed, part, || 7), Some(7));
            assert!(!failed.has(part));
            assert_eq!(watch(&failed, part, || -> u8 { panic!("deliberate") }), None);
            for other in Part::ALL {
                assert_eq!(failed.has(other), other == part);
            }
        }
    }
}
