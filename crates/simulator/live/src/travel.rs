//! The way between the settled pose and neutral.

use serde::{Deserialize, Serialize};

/// Part of the way from the settled pose, 0, to neutral, 1. It follows its target through three
/// equal lags: without overshoot, and with a continuous acceleration whatever the target does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Travel {
    lags: [f64; 3],
}

/// Largest rate of three lags' answer to a step, in terms of the lags' rate: 2 exp(-2).
const LARGEST_RATE: f64 = 0.270_671;
/// Fastest lag \[1/s\].
const FASTEST: f64 = 3.0;
/// Part of the way that is too short to be seen.
const THERE: f64 = 0.01;

impl Travel {
    /// The rate of the lags with which a way of this length is gone at most at this speed \[1/s\].
    pub fn rate(length: f64, speed: f64) -> f64 {
        (speed / (LARGEST_RATE * length.max(1e-3))).min(FASTEST)
    }

    /// Advances by a step towards 1 if `up`, else towards 0.
    pub fn advance(&mut self, up: bool, rate: f64, step: f64) {
        let mut target = f64::from(up);
        let fraction = -libm::expm1(-rate * step);
        for lag in &mut self.lags {
            *lag += fraction * (target - *lag);
            target = *lag;
        }
    }

    /// At the settled pose at once.
    pub fn settle(&mut self) {
        self.lags = [0.0; 3];
    }

    /// The part of the way that is gone.
    pub fn fraction(&self) -> f64 {
        self.lags[2]
    }

    /// True at neutral.
    pub fn is_up(&self) -> bool {
        self.lags.iter().all(|lag| *lag >= 1.0 - THERE)
    }

    /// True at the settled pose.
    pub fn is_down(&self) -> bool {
        self.lags.iter().all(|lag| *lag <= THERE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_arrives_within_its_speed_and_with_no_sudden_acceleration() {
        let (length, speed, step) = (0.3, 0.15, 1e-3);
        let rate = Travel::rate(length, speed);
        let mut travel = Travel::default();
        let mut way = vec![0.0; 3];
        for k in 0..20_000 {
            // To and fro at any time.
            travel.advance(k / 1_700 % 3 != 1 || k > 12_000, rate, step);
            way.push(length * travel.fraction());
        }
        assert!(travel.is_up() && !travel.is_down());
        let speeds: Vec<f64> = way.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect();
        let accelerations: Vec<f64> = speeds.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect();
        assert!(speeds.iter().all(|found| found.abs() <= speed));
        assert!(accelerations.iter().all(|found| found.abs() <= 0.5));
        assert!(accelerations.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 0.003));
    }
}
