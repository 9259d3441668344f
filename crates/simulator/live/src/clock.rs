//! Time of a sample: from its packet's clock, or else its arrival.

/// Packets that come so much later than the clock says show that the clock has been stopped or runs
/// slowly. A packet that comes so much earlier shows that the clock has leapt \[s\].
const LATEST: f64 = 0.25;
/// A clock that goes back by less has two packets in the wrong order; by more, it has been started
/// again \[s\].
const REORDERED: f64 = 0.5;
/// Rate at which the least lag may grow: a source's clock may be slower than this one's.
const DRIFT: f64 = 1e-3;

/// A sample that would have to be so much later than its arrival, to be later than the one before
/// it, is one of too many \[s\].
const AHEAD: f64 = 0.005;

/// Time of a sample as the clock sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stamp {
    /// The sample's time \[s\].
    At(f64),
    /// The time of an earlier sample, or one of too many at once: the sample is dropped.
    Repeated,
    /// The clock has been started again, or has jumped; the sample's time \[s\].
    Restarted(f64),
}

/// The clock of a source. Times of samples are of the receiver's clock, increase, and are never
/// later than the arrival by more than 5 ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    last: Option<Last>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Last {
    arrival: f64,
    clock: Option<f64>,
    /// Least lag of the arrival behind the packet's clock \[s\].
    lag: f64,
    stamp: f64,
}

impl Clock {
    /// All arrivals until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        if let Some(last) = &mut self.last {
            last.arrival -= time;
            last.lag -= time;
            last.stamp -= time;
        }
    }

    /// The time of a sample with this packet's clock that arrived then.
    pub fn stamp(&mut self, arrival: f64, clock: Option<f64>) -> Stamp {
        let behind = clock.map_or(0.0, |clock| arrival - clock);
        let Some(last) = self.last else {
            self.last = Some(Last { arrival, clock, lag: behind, stamp: arrival });
            return Stamp::At(arrival);
        };
        let anew = arrival.max(last.stamp + 1e-3);
        let (stamp, lag, restarted) = match [clock, last.clock] {
            [Some(now), Some(before)] if now <= before && now > before - REORDERED => return Stamp::Repeated,
            [Some(now), Some(before)] => {
                let lag = behind.min(last.lag + DRIFT * (arrival - last.arrival));
                let leaps = now - before - (arrival - last.arrival) > LATEST;
                match now < before || leaps || behind - lag > LATEST {
                    true => (anew, behind, true),
                    false => ((now + lag).max(last.stamp + 1e-4), lag, false),
                }
            }
            _ => (anew, behind, false),
        };
        if stamp > arrival + AHEAD {
            return Stamp::Repeated;
        }
        self.last = Some(Last { arrival, clock, lag, stamp });
        if restarted { Stamp::Restarted(stamp) } else { Stamp::At(stamp) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_leaps_has_been_started_again_and_a_lost_second_has_not() {
        let mut clock = Clock::default();
        for k in 0..100 {
            let time = f64::from(k) / 60.0;
            assert!(matches!(clock.stamp(7.0 + time, Some(time)), Stamp::At(_)));
        }
        assert!(matches!(clock.stamp(9.7, Some(2.7)), Stamp::At(stamp) if (stamp - 9.7).abs() < 1e-9));
        assert_eq!(clock.stamp(9.75, Some(1002.75)), Stamp::Restarted(9.75));
        assert!(matches!(clock.stamp(9.8, Some(1002.8)), Stamp::At(stamp) if (stamp - 9.8).abs() < 1e-9));
    }

    #[test]
    fn a_packet_s_clock_takes_the_jitter_out() {
        let mut clock = Clock::default();
        for k in 0..1000 {
            let time = f64::from(k) / 60.0;
            // Delayed by 5 to 13 ms.
            let arrival = 7.0 + time + 0.005 + 0.008 * f64::from(k * 7919 % 100) / 99.0;
            let Stamp::At(stamp) = clock.stamp(arrival, Some(time)) else { panic!("sample {k}") };
            assert!(stamp <= arrival + 1e-9);
            assert!(k < 100 || (stamp - (7.005 + time)).abs() < 2e-3, "sample {k}: {}", stamp - time - 7.0);
        }
    }

    #[test]
    fn a_repeated_time_is_seen_and_a_restarted_clock_as_well() {
        let mut clock = Clock::default();
        assert_eq!(clock.stamp(1.0, Some(50.0)), Stamp::At(1.0));
        assert_eq!(clock.stamp(1.1, Some(50.0)), Stamp::Repeated);
        assert_eq!(clock.stamp(1.1, Some(49.9)), Stamp::Repeated);
        assert_eq!(clock.stamp(1.2, Some(0.0)), Stamp::Restarted(1.2));
        assert_eq!(clock.stamp(1.3, Some(0.1)), Stamp::At(1.3));
        // A clock that stood still for a second.
        assert_eq!(clock.stamp(2.4, Some(0.2)), Stamp::Restarted(2.4));
    }

    #[test]
    fn without_a_clock_the_arrival_is_the_time() {
        let mut clock = Clock::default();
        assert_eq!(clock.stamp(1.0, None), Stamp::At(1.0));
        assert_eq!(clock.stamp(1.5, None), Stamp::At(1.5));
        assert_eq!(clock.stamp(1.5, None), Stamp::At(1.501));
    }

    #[test]
    fn a_flood_does_not_run_ahead() {
        for clock_of in [|_: i32| None, |k| Some(f64::from(k)), |k| Some(-f64::from(k))] {
            let mut clock = Clock::default();
            let mut taken = 0;
            for k in 0..100_000 {
                let arrival = f64::from(k) * 1e-5;
                match clock.stamp(arrival, clock_of(k)) {
                    Stamp::At(stamp) | Stamp::Restarted(stamp) => {
                        assert!(stamp <= arrival + 0.005 + 1e-9);
                        taken += 1;
                    }
                    Stamp::Repeated => (),
                }
            }
            assert!((1000..=10_100).contains(&taken), "{taken}");
        }
    }
}
