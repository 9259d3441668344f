//! Progress on standard error: a bar on a terminal, lines in a log.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

/// Progress of one recording through its phases.
pub struct Progress {
    name: String,
    bar: ProgressBar,
    /// Time of the last line where standard error is not a terminal: lines in place of the bar.
    logged: Option<Instant>,
}

impl Progress {
    /// Begins with a phase of unknown length, which is shown at once.
    ///
    /// # Errors
    /// No error is possible, because the bar's template is fixed.
    pub fn new(name: &str, phase: &str) -> Result<Self> {
        // Time between two updates of the bar.
        const UPDATE_INTERVAL: Duration = Duration::from_millis(200);
        let bar = ProgressBar::new_spinner();
        bar.set_style(ProgressStyle::with_template("{spinner} {msg} {wide_bar} {percent:>3} %")?);
        let logged = (!stderr().is_terminal()).then(Instant::now);
        if logged.is_none() {
            bar.enable_steady_tick(UPDATE_INTERVAL);
        }
        let mut progress = Progress { name: name.to_owned(), bar, logged };
        progress.phase(phase, 0);
        Ok(progress)
    }

    /// Begins the next phase of `steps` steps; 0 where their number is unknown.
    pub fn phase(&mut self, phase: &str, steps: u64) {
        self.bar.set_message(format!("{}: {phase}", self.name));
        self.bar.set_length(steps.max(1));
        self.bar.set_position(0);
        if let Some(last) = &mut self.logged {
            *last = Instant::now();
            eprintln!("{}: {phase}", self.name);
        }
    }

    /// Advances the bar by a step.
    pub fn step(&mut self) {
        // Time between the lines of a log.
        const LOG_EVERY: Duration = Duration::from_secs(2);
        self.bar.inc(1);
        if let Some(last) = &mut self.logged
            && last.elapsed() > LOG_EVERY
            && let Some(steps @ 2..) = self.bar.length()
        {
            *last = Instant::now();
            eprintln!("{}, {} %", self.bar.message(), 100 * self.bar.position() / steps);
        }
    }

    /// Removes the bar.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}
