//! The clock of the loop: monotonic, with absolute deadlines.

use std::fmt::{self, Display, Formatter};
use std::time::Duration;

/// Time since the clock's own beginning.
#[cfg(target_os = "linux")]
pub fn now() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::Monotonic);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// Waits until this time.
#[cfg(target_os = "linux")]
pub fn wait_until(time: Duration) {
    use rustix::thread::clock_nanosleep_absolute;
    use rustix::time::{ClockId, Timespec};
    let deadline = Timespec { tv_sec: time.as_secs() as i64, tv_nsec: i64::from(time.subsec_nanos()) };
    // A signal ends the sleep early.
    while clock_nanosleep_absolute(ClockId::Monotonic, &deadline).is_err() && now() < time {}
}

/// Time since the clock's own beginning.
#[cfg(not(target_os = "linux"))]
pub fn now() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static BEGINNING: OnceLock<Instant> = OnceLock::new();
    BEGINNING.get_or_init(Instant::now).elapsed()
}

/// Waits until this time.
#[cfg(not(target_os = "linux"))]
pub fn wait_until(time: Duration) {
    std::thread::sleep(time.saturating_sub(now()));
}

/// Upper ends of the classes of lateness \[us\].
const CLASSES: [u64; 10] = [20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000];

/// Lateness of wake-ups, in classes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lateness {
    counts: [u64; CLASSES.len() + 1],
    largest: Duration,
}

impl Lateness {
    /// Takes a wake-up that came so much too late.
    pub fn take(&mut self, late: Duration) {
        let class = CLASSES.iter().position(|end| late.as_micros() <= u128::from(*end)).unwrap_or(CLASSES.len());
        self.counts[class] += 1;
        self.largest = self.largest.max(late);
    }

    /// The classes: the upper end of each \[ms\], of the last the largest
    /// lateness, and its wake-ups.
    pub fn classes(&self) -> impl Iterator<Item = (f64, u64)> {
        let ends = CLASSES.into_iter().map(|end| end as f64 * 1e-3).chain([self.largest.as_secs_f64() * 1e3]);
        ends.zip(self.counts)
    }

    /// Wake-ups later than the time of a step.
    pub fn overruns(&self) -> u64 {
        let on_time = CLASSES.iter().filter(|end| **end <= 1_000).count();
        self.counts[on_time..].iter().sum()
    }
}

impl Display for Lateness {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        writeln!(f, "wake-up late by at most   steps")?;
        for (end, count) in self.classes().filter(|(_, count)| *count > 0) {
            writeln!(f, "{end:>21.2} ms {count:>7}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wait_does_not_end_early() {
        for k in 0..20 {
            let deadline = now() + Duration::from_micros(300 * k);
            wait_until(deadline);
            assert!(now() >= deadline);
        }
    }

    #[test]
    fn lateness_is_counted_by_classes() {
        let mut lateness = Lateness::default();
        for micros in [0, 20, 21, 1_000, 1_001, 60_000] {
            lateness.take(Duration::from_micros(micros));
        }
        assert_eq!(lateness.overruns(), 2);
        let shown = lateness.to_string();
        assert!(shown.contains("0.02 ms       2") && shown.contains("60.00 ms       1"), "{shown}");
    }
}
