//! Time of a sample: from its packet's clock, or else its arrival.
//!
//! The packet's clock times its rate, which is estimated, runs with the session's. A sample's time
//! is its corrected clock plus the least lag of the arrivals behind it. A sample that was held up
//! is late, with the time at which it was true; a lag that lasts is the clock's own.

/// Time of a window in which the least lag is taken, and number of windows \[s\].
const LAG_WINDOW: f64 = 0.1;
const LAG_WINDOW_COUNT: usize = 10;

/// Time of a sample as the clock sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stamp {
    /// The sample's time \[s\].
    At(f64),
    /// The sample takes the place of the one before it.
    Instead,
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
    stamp: f64,
    /// Usual time between arrivals \[s\].
    interval: f64,
    lag: Lag,
}

/// Lag of the arrivals behind the corrected clock.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lag {
    /// Seconds of the session in one of the clock's.
    rate: f64,
    /// The corrected clock \[s\].
    clock: f64,
    /// The lag \[s\].
    lag: f64,
    /// Least lags of the last windows, the newest last; those not yet known are infinite.
    least: [f64; LAG_WINDOW_COUNT],
    /// Arrival at which the newest window began \[s\].
    since: f64,
}

impl Lag {
    fn new(arrival: f64, rate: f64) -> Lag {
        let mut least = [f64::INFINITY; LAG_WINDOW_COUNT];
        least[LAG_WINDOW_COUNT - 1] = 0.0;
        Lag { rate, clock: arrival, lag: 0.0, least, since: arrival }
    }

    /// Takes a packet whose clock has advanced by `advance` within `passed`.
    fn take(&mut self, arrival: f64, advance: f64, passed: f64) {
        // A lag that has been longer by this for `CLOCK_STOP_WINDOWS` windows is the clock's own
        // [s].
        const CLOCK_STOP_THRESHOLD: f64 = 0.05;
        const CLOCK_STOP_WINDOWS: usize = 3;
        // Largest speed at which the lag follows a longer one.
        const MAX_LAG_RATE: f64 = 0.05;
        // Longest time after a packet for which the lag follows [s].
        const LONGEST_STEP: f64 = 0.05;
        self.clock += self.rate * advance;
        let behind = arrival - self.clock;
        if passed > LAG_WINDOW * LAG_WINDOW_COUNT as f64 {
            self.least = [f64::INFINITY; LAG_WINDOW_COUNT];
        }
        if arrival - self.since >= LAG_WINDOW {
            self.since = arrival;
            self.adjust();
            self.least.rotate_left(1);
            self.least[LAG_WINDOW_COUNT - 1] = behind;
        }
        let newest = &mut self.least[LAG_WINDOW_COUNT - 1];
        *newest = newest.min(behind);
        if behind <= self.lag {
            self.lag = behind;
            return;
        }
        let lasting = least(&self.least[LAG_WINDOW_COUNT - CLOCK_STOP_WINDOWS..]);
        let is_known = self.least[LAG_WINDOW_COUNT - CLOCK_STOP_WINDOWS].is_finite();
        if is_known && lasting > self.lag + CLOCK_STOP_THRESHOLD {
            self.lag = lasting;
            return;
        }
        let longer = least(&self.least) - self.lag;
        self.lag += longer.clamp(0.0, MAX_LAG_RATE * passed.clamp(0.0, LONGEST_STEP));
    }

    /// Adjusts the rate to the slope of the least lags.
    fn adjust(&mut self) {
        // Gain of the rate on the slope of the least lag, for each window.
        const RATE_GAIN: f64 = 0.08;
        // Slowest and fastest clocks, as seconds of the session in one of theirs.
        const CLOCK_RATE_RANGE: [f64; 2] = [0.2, 20.0];
        let half = LAG_WINDOW_COUNT / 2;
        let [old, new] = [least(&self.least[..half]), least(&self.least[half..])];
        if old.is_finite() && new.is_finite() {
            let slope = (new - old) / (half as f64 * LAG_WINDOW);
            let rate = (self.rate * (1.0 + RATE_GAIN * slope.clamp(-0.5, 2.0)))
                .clamp(CLOCK_RATE_RANGE[0], CLOCK_RATE_RANGE[1]);
            self.rate = rate;
        }
    }
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

impl Clock {
    /// All arrivals until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        if let Some(last) = &mut self.last {
            last.arrival -= time;
            last.stamp -= time;
            last.lag.clock -= time;
            last.lag.since -= time;
        }
    }

    /// Seconds of the session in one of the source's clock, as estimated.
    #[cfg(test)]
    fn rate(&self) -> f64 {
        self.last.map_or(1.0, |last| last.lag.rate)
    }

    /// The time of a sample with this packet's clock that arrived then.
    pub fn stamp(&mut self, arrival: f64, clock: Option<f64>) -> Stamp {
        // Packets whose clock leaps ahead of their arrivals by more show a clock that was set [s].
        const CLOCK_SET_THRESHOLD: f64 = 0.25;
        // A clock that goes back by less has two packets in the wrong order; by more, it has been
        // started again [s].
        const MAX_REORDERING: f64 = 0.5;
        // A sample that would have to be so much later than its arrival, to be later than the one
        // before it, is one of too many [s].
        const MAX_SAMPLE_LEAD: f64 = 0.005;
        // Part of the usual interval of arrivals below which packets come in a burst.
        const BURST_INTERVAL_FRACTION: f64 = 0.3;
        let Some(last) = self.last else {
            self.last = Some(Last { arrival, clock, stamp: arrival, interval: 0.0, lag: Lag::new(arrival, 1.0) });
            return Stamp::At(arrival);
        };
        let passed = arrival - last.arrival;
        let mut next = Last { arrival, clock, ..last };
        let stamp = match [clock, last.clock] {
            [Some(now), Some(before)] if now <= before && now > before - MAX_REORDERING => return Stamp::Repeated,
            [Some(now), Some(before)]
                if now < before || last.lag.rate * (now - before) - passed > CLOCK_SET_THRESHOLD + behind(&last) =>
            {
                next.lag = Lag::new(arrival, last.lag.rate);
                Stamp::Restarted(arrival.max(last.stamp + 1e-3))
            }
            [Some(now), Some(before)] => {
                next.lag.take(arrival, now - before, passed);
                Stamp::At((next.lag.clock + next.lag.lag).max(last.stamp + 1e-4))
            }
            [_, before] => {
                next.lag = Lag::new(arrival, 1.0);
                let is_crowded = before.is_none() && passed < BURST_INTERVAL_FRACTION * last.interval;
                let gain = if is_crowded { 0.005 } else { 0.1 };
                next.interval += if passed < 0.5 { gain * (passed - last.interval) } else { 0.0 };
                // Of a burst the newest counts: when the others were true is unknown.
                if is_crowded { Stamp::Instead } else { Stamp::At(arrival.max(last.stamp + 1e-3)) }
            }
        };
        match stamp {
            Stamp::Instead => (),
            Stamp::At(stamp) | Stamp::Restarted(stamp) if stamp <= arrival + MAX_SAMPLE_LEAD => {
                next.stamp = stamp;
            }
            _ => return Stamp::Repeated,
        }
        self.last = Some(next);
        stamp
    }
}

/// Lag of the last sample behind its arrival: what a burst catches up with \[s\].
fn behind(last: &Last) -> f64 {
    (last.arrival - last.stamp).max(0.0)
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
        assert!(matches!(clock.stamp(1.3, Some(0.1)), Stamp::At(stamp) if (stamp - 1.3).abs() < 1e-9));
    }

    /// A packet of up to half a second ago is out of order; an older one is of another start.
    #[test]
    fn packets_within_half_a_second_are_out_of_order() {
        for back in [1e-3, 0.1, 0.3, 0.49] {
            let mut clock = Clock::default();
            assert_eq!(clock.stamp(1.0, Some(50.0)), Stamp::At(1.0));
            assert_eq!(clock.stamp(1.01, Some(50.0 - back)), Stamp::Repeated, "{back} s back");
            assert!(matches!(clock.stamp(1.02, Some(50.02)), Stamp::At(stamp) if (stamp - 1.02).abs() < 1e-9));
        }
        for back in [0.51, 0.7, 2.0, 49.0] {
            let mut clock = Clock::default();
            assert_eq!(clock.stamp(1.0, Some(50.0)), Stamp::At(1.0));
            assert_eq!(clock.stamp(1.01, Some(50.0 - back)), Stamp::Restarted(1.01), "{back} s back");
        }
    }

    #[test]
    fn packets_that_were_held_up_have_the_times_at_which_they_were_true() {
        for held in [0.3, 0.45, 0.6, 0.9, 3.0] {
            let mut clock = Clock::default();
            for k in 0..1000 {
                let time = f64::from(k) * 0.01;
                let arrival = if time > 4.0 && time < 4.0 + held { 4.0 + held } else { time };
                let Stamp::At(stamp) = clock.stamp(7.0 + arrival, Some(time)) else { panic!("sample {k}") };
                assert!((stamp - 7.0 - time).abs() < 5e-3, "held for {held} s, sample {k}: {}", stamp - 7.0 - time);
            }
        }
    }

    #[test]
    fn a_clock_that_stood_still_is_followed_after_a_moment() {
        let mut clock = Clock::default();
        for k in 0..1000 {
            let time = f64::from(k) * 0.01;
            let arrival = if time > 4.0 { time + 0.8 } else { time };
            let Stamp::At(stamp) = clock.stamp(7.0 + arrival, Some(time)) else { panic!("sample {k}") };
            let behind = 7.0 + arrival - stamp;
            assert!(time < 4.5 || behind < 0.02, "sample {k}: {behind} s behind");
        }
    }

    #[test]
    fn clocks_of_any_rate_are_followed() {
        for rate in [0.5, 0.9, 0.95, 0.99, 0.995, 0.999, 1.0, 1.001, 1.005, 1.1] {
            let mut clock = Clock::default();
            let mut worst = 0.0_f64;
            for k in 0..6000 {
                let time = f64::from(k) * 0.01;
                let arrival = 7.0 + time + 0.004 * f64::from(k * 7919 % 100) / 99.0;
                let Stamp::At(stamp) = clock.stamp(arrival, Some(rate * time)) else { panic!("{rate}: sample {k}") };
                if time > 8.0 {
                    worst = worst.max(7.0 + time - stamp);
                }
            }
            assert!(worst < 0.008, "{rate}: {worst} s behind");
            assert!((clock.rate() * rate - 1.0).abs() < 5e-3, "{rate}: {}", clock.rate());
        }
    }

    #[test]
    fn without_a_clock_the_arrival_is_the_time_and_the_newest_of_a_burst_counts() {
        let mut clock = Clock::default();
        for k in 0..50 {
            let arrival = 1.0 + f64::from(k) * 0.01;
            assert_eq!(clock.stamp(arrival, None), Stamp::At(arrival));
        }
        assert_eq!(clock.stamp(2.0, None), Stamp::At(2.0));
        assert!((0..80).all(|_| clock.stamp(2.0, None) == Stamp::Instead));
        assert_eq!(clock.stamp(2.01, None), Stamp::At(2.01));
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
                    Stamp::Instead | Stamp::Repeated => (),
                }
            }
            assert!(taken <= 10_100, "{taken}");
        }
    }
}
