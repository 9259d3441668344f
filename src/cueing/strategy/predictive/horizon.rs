//! The plan's horizon: blocks over which the dropped force is linear and the tilt acceleration
//! constant after a ramp.

use serde::{Deserialize, Serialize};

use crate::motion::min_max::min;

/// Number of blocks.
pub const BLOCKS: usize = 8;
/// Time between two samples of the reference, and between two plans \[s\].
pub const PLAN_INTERVAL: f64 = 0.02;
/// Time over which the reference is forecast: the near horizon's \[s\] ...
pub const FORECAST_TIME: f64 = 3.0;
/// ... and in samples.
pub const FORECAST_SAMPLES: usize = 150;
/// Number of samples in each block of the near horizon.
pub const BLOCK_SAMPLES: [usize; BLOCKS] = [2, 3, 5, 9, 14, 22, 36, 59];

/// Length of a plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Horizon {
    /// As far as the reference is forecast.
    #[default]
    Near,
    /// Twice as far, for a long preview or a foreseen stop of the vehicle.
    Far,
}

impl Horizon {
    /// Durations of the blocks \[s\]: short where a plan is about to be carried out.
    pub const fn durations(self) -> &'static [f64; BLOCKS] {
        match self {
            Horizon::Near => &[0.04, 0.06, 0.1, 0.18, 0.28, 0.44, 0.72, 1.18],
            Horizon::Far => &[0.1, 0.2, 0.3, 0.4, 0.6, 0.9, 1.4, 2.1],
        }
    }

    /// End of each block \[s\].
    pub fn ends(self) -> [f64; BLOCKS] {
        let mut time = 0.0;
        self.durations().map(|duration| {
            time += duration;
            time
        })
    }

    /// The block that is carried out at this age of a plan, if the plan reaches so far.
    pub fn block_at(self, age: f64) -> Option<usize> {
        // Half a microsecond stands above the rounding of a sum of steps.
        self.ends().iter().position(|&end| age < end - 5e-7)
    }
}

/// Time in a plan from which its margins at the ends of stroke and travel are kept \[s\].
const FULL_MARGIN_TIME: f64 = 0.2;

/// The fraction of a margin that a plan keeps after `time` seconds.
///
/// The fraction grows from 0: disturbances that the plan before did not see use up part of the
/// margin, and restoring it at once would jolt.
pub fn margin_ramp(time: f64) -> f64 {
    min(time / FULL_MARGIN_TIME, 1.0)
}

/// Number of samples from now to the end of each block of the near horizon.
pub fn end_samples() -> [usize; BLOCKS] {
    let mut count = 0;
    BLOCK_SAMPLES.map(|samples| {
        count += samples;
        count
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_the_near_horizon_are_whole_numbers_of_samples_and_fill_the_forecast() {
        for (duration, samples) in Horizon::Near.durations().iter().zip(BLOCK_SAMPLES) {
            assert!((duration - samples as f64 * PLAN_INTERVAL).abs() < 1e-15);
        }
        assert!((Horizon::Near.ends()[BLOCKS - 1] - FORECAST_TIME).abs() < 1e-15);
        assert_eq!(end_samples()[BLOCKS - 1], FORECAST_SAMPLES);
    }

    #[test]
    fn the_far_horizon_is_twice_the_near_one() {
        assert!((Horizon::Far.ends()[BLOCKS - 1] - 2.0 * FORECAST_TIME).abs() < 1e-14);
    }

    #[test]
    fn a_plan_is_carried_out_block_by_block() {
        assert_eq!(Horizon::Near.block_at(0.0), Some(0));
        assert_eq!(Horizon::Near.block_at(0.039), Some(0));
        assert_eq!(Horizon::Near.block_at(0.04 - 1e-12), Some(1));
        assert_eq!(Horizon::Near.block_at(2.999), Some(7));
        assert_eq!(Horizon::Near.block_at(3.0), None);
        assert_eq!(Horizon::Far.block_at(3.0), Some(6));
        assert_eq!(Horizon::Far.block_at(6.0), None);
    }
}
