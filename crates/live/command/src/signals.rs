//! Signals of the system: all that can be caught ask for the end.
//!
//! A handler sets a flag, and the loop looks at the flags in each step. So no thread is needed that
//! could end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anyhow::{Context, Result};

/// Flags of signals that have come.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    /// True once Ctrl-C was pressed.
    pub(crate) interrupt: Arc<AtomicBool>,
    /// Another one that ends a program, or stops it.
    termination: Arc<AtomicBool>,
}

impl Signals {
    /// Listens to the signals of this process.
    ///
    /// # Errors
    /// The system does not permit it.
    pub fn listen() -> Result<Self> {
        let signals = Signals::default();
        signals.register().context("cannot listen to signals")?;
        Ok(signals)
    }

    /// True if Ctrl-C was pressed since the last look.
    pub fn is_interrupted(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed)
    }

    #[cfg(unix)]
    fn register(&self) -> std::io::Result<()> {
        use signal_hook::consts::signal::*;
        use signal_hook::flag::register;
        register(SIGINT, Arc::clone(&self.interrupt))?;
        // Ctrl-Z would stop the frames in mid-motion, too. A supervisor's watchdog sends SIGABRT.
        for signal in [
            SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO, SIGABRT,
            SIGTRAP, SIGSYS,
        ] {
            register(signal, Arc::clone(&self.termination))?;
        }
        // A recording that exceeds the limit of a file is an error of its writing. A program in the
        // background that reads or writes the terminal goes on without it: see `terminal`.
        for signal in [SIGXFSZ, SIGTTIN, SIGTTOU] {
            register(signal, Arc::default())?;
        }
        #[cfg(target_os = "linux")]
        self.register_of_linux();
        Ok(())
    }

    /// Signals of Linux alone: the power supply's, the coprocessor's, and those of real time, of
    /// which a C library keeps some for itself.
    #[cfg(target_os = "linux")]
    fn register_of_linux(&self) {
        use rustix::process::Signal;
        // Numbers of the signals of real time.
        const FIRST_REAL_TIME: i32 = 34;
        const LAST_REAL_TIME: i32 = 64;
        let named = [Signal::POWER, Signal::STKFLT].map(Signal::as_raw);
        for signal in named.into_iter().chain(FIRST_REAL_TIME..=LAST_REAL_TIME) {
            let _ = signal_hook::flag::register(signal, Arc::clone(&self.termination));
        }
    }

    #[cfg(not(unix))]
    fn register(&self) -> Result<(), ctrlc::Error> {
        // Closing the console, logging out and shutting down as well: Windows ends the program some
        // seconds after these.
        let interrupt = Arc::clone(&self.interrupt);
        ctrlc::set_handler(move || interrupt.store(true, Ordering::Relaxed))
    }
}

/// The wish to end, by signals.
#[derive(Clone, Debug, Default)]
pub struct Interrupts {
    signals: Signals,
    first: Option<Duration>,
    again: bool,
}

impl Interrupts {
    /// The wish of these signals.
    pub fn new(signals: Signals) -> Self {
        Interrupts { signals, ..Interrupts::default() }
    }

    /// Takes the signals that have come until now.
    pub fn look(&mut self, now: Duration) {
        // Time after a signal in which another one is the same wish: a supervisor sends two.
        const REPEATED_SIGNAL_TIME: Duration = Duration::from_millis(500);
        let interrupted = self.signals.interrupt.swap(false, Ordering::Relaxed);
        let terminated = self.signals.termination.swap(false, Ordering::Relaxed);
        match self.first {
            None if interrupted || terminated => self.first = Some(now),
            Some(first) => self.again |= interrupted && now >= first + REPEATED_SIGNAL_TIME,
            None => (),
        }
    }

    /// True once the platform is to park.
    pub fn ends(&self) -> bool {
        self.first.is_some()
    }

    /// True once the operator at the keyboard asks again: frames end at once.
    pub fn ends_at_once(&self) -> bool {
        self.again
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Effect of Ctrl-C and other signals at these times \[ms\]: parks, and ends at once.
    fn after(interrupts: &[u64], terminations: &[u64]) -> (bool, bool) {
        let signals = Signals::default();
        let mut wish = Interrupts::new(signals.clone());
        for time in 0..2000 {
            if interrupts.contains(&time) {
                signals.interrupt.store(true, Ordering::Relaxed);
            }
            if terminations.contains(&time) {
                signals.termination.store(true, Ordering::Relaxed);
            }
            wish.look(Duration::from_millis(7_000 + time));
        }
        (wish.ends(), wish.ends_at_once())
    }

    #[test]
    fn two_within_half_a_second_are_one() {
        assert_eq!(after(&[], &[]), (false, false));
        assert_eq!(after(&[100], &[]), (true, false));
        assert_eq!(after(&[100, 101, 400, 599], &[102, 103]), (true, false));
        assert_eq!(after(&[100, 600], &[]), (true, true));
    }

    #[test]
    fn only_a_person_at_the_keyboard_ends_at_once() {
        assert_eq!(after(&[], &[100]), (true, false));
        assert_eq!(after(&[], &[100, 700, 1500]), (true, false));
        assert_eq!(after(&[1500], &[100]), (true, true));
    }

    #[cfg(unix)]
    #[test]
    fn signals_of_the_system_are_caught() {
        use signal_hook::consts::signal::*;
        let signals = Signals::listen().unwrap();
        for signal in [SIGXFSZ, SIGTTIN, SIGTTOU] {
            signal_hook::low_level::raise(signal).unwrap();
        }
        let of_linux = if cfg!(target_os = "linux") { &[16, 30, 34, 35, 50, 64][..] } else { &[] };
        let all = [SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1, SIGXCPU, SIGABRT, SIGTRAP, SIGSYS];
        for signal in all.iter().chain(of_linux).copied() {
            assert!(!signals.termination.load(Ordering::Relaxed));
            signal_hook::low_level::raise(signal).unwrap();
            assert!(signals.termination.swap(false, Ordering::Relaxed), "signal {signal}");
        }
    }
}
