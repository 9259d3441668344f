//! The sender of telemetry that a session follows, and what is said of other packets.

use std::net::SocketAddr;
use std::time::Duration;

/// The sender that is followed. Two of them would be two vehicles in one.
#[derive(Debug, Default)]
pub struct Followed {
    sender: Option<(SocketAddr, Duration)>,
    named: Vec<SocketAddr>,
}

impl Followed {
    /// True for a good packet of the sender that is followed; for the first of another one, a line
    /// about it.
    pub fn accepts(&mut self, from: SocketAddr, now: Duration) -> Result<(), Option<String>> {
        // Silence after which another sender is followed.
        const SENDER_TIMEOUT: Duration = Duration::from_millis(1500);
        match &mut self.sender {
            Some((sender, last)) if *sender != from && now.saturating_sub(*last) < SENDER_TIMEOUT => {
                let sender = *sender;
                Err(self.first_of(from).then(|| {
                    format!(
                        "telemetry comes from {from} too: it is not used until {sender}, which is followed, has been \
                         silent for 1.5 s"
                    )
                }))
            }
            sender => {
                *sender = Some((from, now));
                Ok(())
            }
        }
    }

    fn first_of(&mut self, from: SocketAddr) -> bool {
        // Most addresses that are named.
        const MAX_NAMED_ADDRESSES: usize = 16;
        let is_new = !self.named.contains(&from) && self.named.len() < MAX_NAMED_ADDRESSES;
        if is_new {
            self.named.push(from);
        }
        is_new
    }
}

/// Packets that are not of the format.
#[derive(Debug, Default)]
pub struct Dropped {
    count: u64,
    last: Option<Duration>,
}

impl Dropped {
    /// Takes one. True if there should be a line about it: at once, and then every 5 s.
    pub fn take(&mut self, now: Duration) -> Option<u64> {
        // Time between lines about dropped packets.
        const DROPPED_PACKET_LOG_INTERVAL: Duration = Duration::from_secs(5);
        self.count += 1;
        let is_due = self.last.is_none_or(|last| now.saturating_sub(last) >= DROPPED_PACKET_LOG_INTERVAL);
        is_due.then(|| {
            self.last = Some(now);
            std::mem::take(&mut self.count)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sender_is_followed_until_it_is_silent() {
        let [one, other] = [4000, 5000].map(|port| SocketAddr::from(([127, 0, 0, 1], port)));
        let mut followed = Followed::default();
        let at = Duration::from_millis;
        for time in (0..3000).step_by(10) {
            assert_eq!(followed.accepts(one, at(time)), Ok(()));
            let named = followed.accepts(other, at(time + 5)).unwrap_err();
            assert_eq!(named.is_some(), time == 0);
            assert!(named.is_none_or(|line| line.contains("127.0.0.1:5000") && line.contains("127.0.0.1:4000")));
        }
        assert_eq!(followed.accepts(other, at(2990 + 1499)), Err(None));
        assert_eq!(followed.accepts(other, at(2990 + 1500)), Ok(()));
        assert!(followed.accepts(one, at(5000)).is_err());
    }

    #[test]
    fn dropped_packets_are_reported_at_once_and_then_now_and_then() {
        let mut dropped = Dropped::default();
        let reported: Vec<(u64, u64)> = (0..12_000)
            .step_by(10)
            .filter_map(|time| Some((time, dropped.take(Duration::from_millis(time))?)))
            .collect();
        assert_eq!(reported, [(0, 1), (5000, 500), (10_000, 500)]);
    }
}
