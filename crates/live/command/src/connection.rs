//! Connection with the controller: it is lost when it refuses frames, or the line is gone.

use std::io::{self, ErrorKind};
use std::time::Duration;

/// Failures of sending.
#[derive(Clone, Copy, Debug)]
pub struct Connection {
    /// Failures with which it is lost.
    most: u32,
    failures: u32,
    last: Duration,
    is_lost: bool,
}

impl Connection {
    /// Connection with a controller that gets frames at this interval \[s\].
    pub fn new(interval: f64) -> Self {
        // Failures in a row that are no loss yet: a system reports each refused packet once, with a
        // later one, which may be sent.
        const TOLERATED_FAILURES: u32 = 2;
        // Within 0.5 s, of which every other frame is refused.
        let most = if interval > 0.05 { 1 } else { TOLERATED_FAILURES + 1 };
        Connection { most, failures: 0, last: Duration::ZERO, is_lost: false }
    }

    /// The operator has started the controller again.
    pub fn renew(&mut self) {
        (self.failures, self.is_lost) = (0, false);
    }

    /// Forgets where the platform is, after so long without frames that it may be anywhere.
    pub fn lose(&mut self) {
        self.is_lost = true;
    }

    /// True while it is lost.
    pub fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// Takes what has become of a frame. The reason, if the controller is lost with it.
    pub fn take(&mut self, sent: &io::Result<()>, now: Duration) -> Option<ErrorKind> {
        // Time without a failure after which a failure begins a new row.
        const FAILURE_RESET_TIME: Duration = Duration::from_secs(1);
        let kind = sent.as_ref().err()?.kind();
        if now.saturating_sub(self.last) > FAILURE_RESET_TIME {
            self.failures = 0;
        }
        self.last = now;
        self.failures += 1;
        let loses = !self.is_lost && self.failures >= self.most;
        self.is_lost |= loses;
        loses.then_some(kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The time of the loss \[ms\], with frames at this interval \[ms\], of
    /// which those are refused.
    fn lost(interval: u64, is_refused: impl Fn(u64) -> bool) -> Option<u64> {
        let mut connection = Connection::new(interval as f64 * 1e-3);
        (0..5000).step_by(interval as usize).find(|time| {
            let refused = is_refused(time / interval);
            let sent = if refused { Err(ErrorKind::ConnectionRefused.into()) } else { Ok(()) };
            connection.take(&sent, Duration::from_millis(10_000 + time)).is_some()
        })
    }

    #[test]
    fn a_controller_that_refuses_frames_is_lost_within_half_a_second() {
        for interval in [1, 2, 10, 17, 50, 100, 200] {
            for every in [1, 2] {
                let time = lost(interval, |frame| frame % every == 0).unwrap();
                assert!(time < 500, "{interval} ms: lost after {time} ms");
            }
        }
    }

    #[test]
    fn few_failures_are_no_loss() {
        assert_eq!(lost(10, |frame| frame == 7 || frame == 9), None);
        assert_eq!(lost(10, |frame| frame % 150 == 0), None);
    }

    /// The failure with which the controller is lost, of failures at these times \[ms\].
    fn lost_with(connection: &mut Connection, times: &[u64]) -> Option<usize> {
        let refused = Err(ErrorKind::ConnectionRefused.into());
        let at = |time: &u64| Duration::from_millis(10_000 + time);
        times.iter().position(|time| connection.take(&refused, at(time)) == Some(ErrorKind::ConnectionRefused))
    }

    #[test]
    fn failures_within_a_second_of_each_other_are_a_row() {
        let lost = |times: &[u64]| lost_with(&mut Connection::new(0.01), times);
        assert_eq!(lost(&[0, 1000, 2000]), Some(2));
        assert_eq!(lost(&[0, 1000, 2001, 3002, 4003]), None);
        // Rare frames: each one counts from an interval of more than 50 ms on.
        assert_eq!(lost_with(&mut Connection::new(0.05), &[0, 1, 2]), Some(2));
        assert_eq!(lost_with(&mut Connection::new(0.051), &[0, 1, 2]), Some(0));
    }

    #[test]
    fn a_loss_is_said_once_until_a_person_renews_the_contact() {
        let mut connection = Connection::new(0.01);
        assert!(!connection.is_lost());
        assert_eq!(lost_with(&mut connection, &[0, 1, 2, 3, 4]), Some(2));
        assert!(connection.is_lost() && lost_with(&mut connection, &[5, 6, 7, 8]).is_none());
        connection.renew();
        assert!(!connection.is_lost());
        assert_eq!(lost_with(&mut connection, &[9, 10, 11]), Some(2));
        let mut connection = Connection::new(0.01);
        connection.lose();
        assert!(connection.is_lost() && lost_with(&mut connection, &[0, 1, 2, 3]).is_none());
        // What is sent says nothing of the failures before it.
        let mut connection = Connection::new(0.01);
        assert_eq!(connection.take(&Ok(()), Duration::from_secs(1)), None);
        assert!(!connection.is_lost());
    }
}
