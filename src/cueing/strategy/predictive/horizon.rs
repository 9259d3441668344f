//! The plan's horizon: blocks over which dropped force and tilt acceleration are constant.

/// Number of blocks.
pub const BLOCKS: usize = 8;
/// Durations of the blocks \[s\], each a multiple of [`SAMPLE`]: fine where a plan is
/// about to be carried out.
pub const DURATIONS: [f64; BLOCKS] = [0.04, 0.06, 0.1, 0.18, 0.28, 0.44, 0.72, 1.18];
/// The whole horizon \[s\].
pub const HORIZON: f64 = 3.0;
/// Time between two samples of the reference, and between two plans \[s\].
pub const SAMPLE: f64 = 0.02;

/// Number of samples in each block.
pub const SAMPLES: [usize; BLOCKS] = [2, 3, 5, 9, 14, 22, 36, 59];
/// Number of samples in the horizon.
pub const HORIZON_SAMPLES: usize = 150;

/// End of each block \[s\].
pub fn ends() -> [f64; BLOCKS] {
    let mut time = 0.0;
    DURATIONS.map(|duration| {
        time += duration;
        time
    })
}

/// Number of samples from now to the end of each block.
pub fn end_samples() -> [usize; BLOCKS] {
    let mut count = 0;
    SAMPLES.map(|samples| {
        count += samples;
        count
    })
}

/// The block that is carried out at this age of a plan, if the plan reaches so far.
pub fn block_at(age: f64) -> Option<usize> {
    // Half a microsecond stands above the rounding of a sum of steps.
    ends().iter().position(|&end| age < end - 5e-7)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_whole_numbers_of_samples_and_fill_the_horizon() {
        for (duration, samples) in DURATIONS.iter().zip(SAMPLES) {
            assert!((duration - samples as f64 * SAMPLE).abs() < 1e-15);
        }
        assert!((ends()[BLOCKS - 1] - HORIZON).abs() < 1e-15);
        assert_eq!(end_samples()[BLOCKS - 1], HORIZON_SAMPLES);
    }

    #[test]
    fn a_plan_is_carried_out_block_by_block() {
        assert_eq!(block_at(0.0), Some(0));
        assert_eq!(block_at(0.039), Some(0));
        assert_eq!(block_at(0.04 - 1e-12), Some(1));
        assert_eq!(block_at(2.999), Some(7));
        assert_eq!(block_at(3.0), None);
    }
}
