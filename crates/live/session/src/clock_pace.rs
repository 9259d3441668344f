//! Pace of a source's clock beside the arrivals: one in another unit is no slow motion.

/// The pace of a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClockPace {
    last: Option<(f64, f64)>,
    block: Block,
    wrong: Option<f64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Block {
    samples: f64,
    leaps: f64,
    restarts: f64,
    passed: f64,
    advanced: f64,
}

impl ClockPace {
    /// Seconds by which the clock advances in a second, if no slow or fast motion does that.
    pub fn wrong(&self) -> Option<f64> {
        self.wrong
    }

    /// Takes a sample's arrival and clock \[s\]. `leaps`: the clock has gone on too far, or back.
    pub fn take(&mut self, arrival: f64, clock: Option<f64>, leaps: bool) {
        // Time and samples over which the pace is measured [s].
        const BLOCK_TIME: f64 = 2.0;
        const BLOCK_SAMPLES: f64 = 20.0;
        // Paces of slow and fast motion.
        const USUAL_PACES: [f64; 2] = [0.15, 6.0];
        // Part of the samples at which the clock leaps, with which it does so all the time.
        const LEAPING_PART: f64 = 0.8;
        let Some(clock) = clock else { return };
        let Some((before, earlier)) = self.last.replace((arrival, clock)) else { return };
        let [passed, advanced] = [arrival - before, clock - earlier];
        let block = &mut self.block;
        block.samples += 1.0;
        block.passed += passed.max(0.0);
        block.advanced += advanced.max(0.0);
        block.leaps += f64::from(leaps && advanced > 0.0);
        block.restarts += f64::from(leaps && advanced <= 0.0);
        if block.passed < BLOCK_TIME {
            return;
        }
        let Block { samples, leaps, restarts, passed, advanced } = std::mem::take(block);
        let pace = advanced / passed;
        let is_steady = leaps + restarts == 0.0 || leaps > LEAPING_PART * samples;
        let is_usual = (USUAL_PACES[0]..=USUAL_PACES[1]).contains(&pace);
        self.wrong = (samples >= BLOCK_SAMPLES && is_steady && !is_usual).then_some(pace);
    }

    /// All arrivals until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        self.last.iter_mut().for_each(|(arrival, _)| *arrival -= time);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pace of a clock that is so many times the time, with a sample each 10 ms that leaps as
    /// the session's clock would see it.
    fn wrong(clock: impl Fn(f64) -> f64) -> Option<f64> {
        let mut pace = ClockPace::default();
        let mut before = f64::NEG_INFINITY;
        for k in 0..500 {
            let now = clock(0.01 * f64::from(k));
            pace.take(3.0 + 0.01 * f64::from(k), Some(now), now < before || now - before > 0.26);
            before = now;
        }
        pace.wrong()
    }

    #[test]
    fn a_clock_in_another_unit_is_known_and_slow_motion_is_none() {
        for factor in [1000.0, 1e6, 100.0, 1e-3, 0.05] {
            let found = wrong(|t| factor * t).unwrap();
            assert!((found / factor - 1.0).abs() < 0.01, "{factor}: {found}");
        }
        for factor in [0.2, 0.5, 1.0, 5.0] {
            assert_eq!(wrong(|t| factor * t), None, "{factor}");
        }
        // A clock that is set once, and packets that come in fives.
        assert_eq!(wrong(|t| if t > 3.0 { t + 1000.0 } else { t }), None);
        let mut pace = ClockPace::default();
        for k in 0..500 {
            pace.take(0.05 * f64::from(k / 5), Some(0.01 * f64::from(k)), false);
        }
        assert_eq!(pace.wrong(), None);
    }
}
