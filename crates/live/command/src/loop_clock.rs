//! The clock of the loop: monotonic, with absolute deadlines. On Linux it goes on while the
//! computer sleeps, so that a gap in the frames is seen after it.

use std::time::Duration;

/// Time since the clock's own beginning.
#[cfg(target_os = "linux")]
pub fn now() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::Boottime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// Waits until this time.
#[cfg(target_os = "linux")]
pub fn wait_until(time: Duration) {
    use rustix::thread::clock_nanosleep_absolute;
    use rustix::time::{ClockId, Timespec};
    let deadline = Timespec { tv_sec: time.as_secs() as i64, tv_nsec: i64::from(time.subsec_nanos()) };
    // A signal ends the sleep early.
    while clock_nanosleep_absolute(ClockId::Boottime, &deadline).is_err() && now() < time {}
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
}
