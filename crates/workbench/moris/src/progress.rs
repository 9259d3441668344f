//! Progress on standard error: a bar on a terminal, lines in a log.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

/// Progress of one recording through its phases.
pub struct Progress {
    name: String,
    bar: ProgressBar,
    /// True for a standard error that is not a terminal: lines in place of the bar, for which the
    /// steps are counted.
    is_logged: bool,
    phase: &'static str,
    done: u64,
    total: u64,
    last: Instant,
}

impl Progress {
    /// Begins with a phase of unknown length, which is shown at once.
    ///
    /// # Errors
    /// No error is possible, because the bar's template is fixed.
    pub fn new(name: &str, phase: &'static str) -> Result<Self> {
        // Time between two updates of the bar.
        const UPDATE_INTERVAL: Duration = Duration::from_millis(200);
        let bar = ProgressBar::new_spinner();
        bar.set_style(ProgressStyle::with_template("{spinner} {msg} {wide_bar} {percent:>3} %")?);
        let is_logged = !stderr().is_terminal();
        if !is_logged {
            bar.enable_steady_tick(UPDATE_INTERVAL);
        }
        let mut progress =
            Progress { name: name.to_owned(), bar, is_logged, phase, done: 0, total: 0, last: Instant::now() };
        progress.phase(phase, 0);
        Ok(progress)
    }

    /// Begins the next phase of `steps` steps; 0 where their number is unknown.
    pub fn phase(&mut self, phase: &'static str, steps: u64) {
        self.bar.set_message(format!("{}: {phase}", self.name));
        self.bar.set_length(steps.max(1));
        self.bar.set_position(0);
        (self.phase, self.done, self.total, self.last) = (phase, 0, steps, Instant::now());
        if self.is_logged {
            eprintln!("{}: {phase}", self.name);
        }
    }

    /// Advances the bar by a step.
    pub fn step(&mut self) {
        // Time between the lines of a log.
        const LOG_EVERY: Duration = Duration::from_secs(2);
        if !self.is_logged {
            return self.bar.inc(1);
        }
        self.done += 1;
        // Reading the clock takes longer than reading a counter.
        if self.done.is_multiple_of(256) && self.total > 0 && self.last.elapsed() > LOG_EVERY {
            self.last = Instant::now();
            eprintln!("{}: {}, {} %", self.name, self.phase, 100 * self.done / self.total);
        }
    }

    /// Removes the bar.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}
