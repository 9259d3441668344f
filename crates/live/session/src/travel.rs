//! The way between the lengths at which the legs rest and neutral.

use crate::session::STEP;

/// Units of the way: sums of whole numbers are exact, so that both ends are reached.
const WHOLE_DISTANCE: i64 = 1 << 40;
/// Steps over which the ramp is averaged, twice.
const RAMP_WINDOW_STEPS: usize = 400;

/// Part of the way from the lengths at rest, 0, to neutral, 1: a ramp of constant speed, averaged
/// twice over 0.4 s. Both ends are reached exactly, without overshoot. The acceleration is
/// continuous whatever the target does, and at most 2.5 times the ramp's speed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Travel {
    ramp: i64,
    first: Average,
    second: Average,
}

/// Mean of the last values.
#[derive(Clone, Debug, PartialEq)]
struct Average {
    values: [i64; RAMP_WINDOW_STEPS],
    next: usize,
    sum: i64,
}

impl Default for Average {
    fn default() -> Self {
        Average { values: [0; RAMP_WINDOW_STEPS], next: 0, sum: 0 }
    }
}

impl Average {
    fn take(&mut self, value: i64) -> i64 {
        self.sum += value - std::mem::replace(&mut self.values[self.next], value);
        self.next = (self.next + 1) % RAMP_WINDOW_STEPS;
        self.sum / RAMP_WINDOW_STEPS as i64
    }

    fn is(&self, value: i64) -> bool {
        self.values.iter().all(|found| *found == value)
    }
}

impl Travel {
    /// Time of each average \[s\].
    pub const SMOOTHING: f64 = RAMP_WINDOW_STEPS as f64 * STEP;

    /// Advances by a step of at most `part` of the way towards 1 if `up`, else towards 0.
    pub fn advance(&mut self, up: bool, part: f64) {
        let most = (part.clamp(0.0, 1.0) * WHOLE_DISTANCE as f64) as i64;
        let target = if up { WHOLE_DISTANCE } else { 0 };
        self.ramp += (target - self.ramp).clamp(-most, most);
        let averaged = self.first.take(self.ramp);
        self.second.take(averaged);
    }

    /// At the lengths at rest at once.
    pub fn settle(&mut self) {
        *self = Travel::default();
    }

    /// The part of the way that is gone.
    pub fn fraction(&self) -> f64 {
        self.second.sum as f64 / (WHOLE_DISTANCE * RAMP_WINDOW_STEPS as i64) as f64
    }

    /// True at neutral, and at rest there.
    pub fn is_up(&self) -> bool {
        self.ramp == WHOLE_DISTANCE && self.first.is(WHOLE_DISTANCE) && self.second.is(WHOLE_DISTANCE)
    }

    /// True at the lengths at rest, and at rest there.
    pub fn is_down(&self) -> bool {
        self.ramp == 0 && self.first.is(0) && self.second.is(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_arrives_exactly_within_its_speed_and_with_no_sudden_acceleration() {
        let (length, speed, step) = (0.3, 0.15, 1e-3);
        let part = speed / length * step;
        let mut travel = Travel::default();
        let mut way = vec![0.0; 3];
        for k in 0..20_000 {
            // To and fro at any time.
            travel.advance(k / 1_700 % 3 != 1 || k > 12_000, part);
            way.push(length * travel.fraction());
        }
        assert!(travel.is_up() && !travel.is_down());
        assert_eq!(travel.fraction(), 1.0);
        let slopes = |values: &[f64]| -> Vec<f64> { values.windows(2).map(|two| (two[1] - two[0]) / step).collect() };
        let speeds = slopes(&way);
        let accelerations = slopes(&speeds);
        assert!(speeds.iter().all(|found| found.abs() <= speed + 1e-9));
        // Twice the speed within 0.4 s where it turns round.
        assert!(accelerations.iter().all(|found| found.abs() <= 2.0 * speed / 0.4 + 1e-6));
        assert!(accelerations.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 0.003));
        assert!(way.iter().all(|value| (0.0..=length).contains(value)));
    }
}
