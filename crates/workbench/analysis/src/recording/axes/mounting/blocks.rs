//! Means of short blocks of a recording, and those of its blocks at rest.

use moris_washout::nalgebra::Vector3;

use crate::recording::signal::{extremes, median};

/// Time over which samples are averaged before the search \[s\].
pub const BLOCK_TIME: f64 = 0.1;
/// Blocks of a stretch at rest: 1 s.
const REST_BLOCKS: usize = 10;

/// Means of [`BLOCK_TIME`]s of a recording.
pub struct Blocks {
    pub forces: Vec<Vector3<f64>>,
    pub rates: Vec<Vector3<f64>>,
    /// Empty where the speed is not known.
    pub speeds: Vec<f64>,
    /// First blocks of the stretches at rest or at constant speed.
    rests: Vec<usize>,
}

impl Blocks {
    pub fn new(step: f64, forces: &[Vector3<f64>], rates: &[Vector3<f64>], speeds: &[f64]) -> Self {
        let size = ((BLOCK_TIME / step).round() as usize).max(1);
        let means = |vectors: &[Vector3<f64>]| vectors.chunks_exact(size).map(mean).collect::<Vec<_>>();
        let (forces, rates) = (means(forces), means(rates));
        Blocks {
            rests: rest_starts(&forces, &rates),
            forces,
            rates,
            speeds: speeds.chunks_exact(size).map(|speeds| speeds.iter().sum::<f64>() / speeds.len() as f64).collect(),
        }
    }

    /// The first stretch at rest: its first block, and the one after it.
    pub fn first_rest(&self) -> Option<[usize; 2]> {
        let first = *self.rests.first()?;
        let last = self.rests.windows(2).find(|pair| pair[1] > pair[0] + REST_BLOCKS / 2).map(|pair| pair[0]);
        Some([first, last.unwrap_or(self.rests[self.rests.len() - 1]) + REST_BLOCKS])
    }

    /// The median of the specific forces at rest, if there is rest.
    pub fn rest_force(&self) -> Option<Vector3<f64>> {
        self.median_at_rest(&self.forces)
    }

    /// The median of the rates at rest, which is the gyroscope's bias; zero without rest.
    pub fn rest_rate(&self) -> Vector3<f64> {
        self.median_at_rest(&self.rates).unwrap_or_default()
    }

    fn median_at_rest(&self, vectors: &[Vector3<f64>]) -> Option<Vector3<f64>> {
        let means: Vec<Vector3<f64>> =
            self.rests.iter().map(|&start| mean(&vectors[start..start + REST_BLOCKS])).collect();
        (!means.is_empty()).then(|| Vector3::from_fn(|axis, _| median(means.iter().map(|mean| mean[axis]))))
    }
}

/// The mean of at least one vector.
pub fn mean(vectors: &[Vector3<f64>]) -> Vector3<f64> {
    vectors.iter().sum::<Vector3<f64>>() / vectors.len() as f64
}

fn rest_starts(forces: &[Vector3<f64>], rates: &[Vector3<f64>]) -> Vec<usize> {
    // Largest change of the specific force at rest [m/s2].
    const REST_FORCE: f64 = 0.3;
    // Largest angular velocity at rest [rad/s].
    const REST_RATE: f64 = 0.05;
    let is_at_rest = |&start: &usize| {
        let steady = (0..3).all(|axis| {
            let (least, greatest) = extremes(forces[start..start + REST_BLOCKS].iter().map(|force| force[axis]));
            greatest - least < REST_FORCE
        });
        steady && rates[start..start + REST_BLOCKS].iter().all(|rate| rate.norm() < REST_RATE)
    };
    (0..(forces.len() + 1).saturating_sub(REST_BLOCKS)).step_by(REST_BLOCKS / 2).filter(is_at_rest).collect()
}
