//! Volume of a platform's workspace, by the Monte Carlo method.

use std::f64::consts::TAU;

use moris_washout::Rig;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::reach::stroke_clearance;
use moris_washout::platform::{Geometry, Pose, jacobian};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use crate::random::unit;

/// The tilt for which the workspace is measured beside the level one \[rad\].
pub const WORKSPACE_TILT: f64 = 10.0 * TAU / 360.0;
/// Number of points in a block. Each block has its own stream of random numbers, so that the points
/// are the same on any number of cores.
const POINTS_PER_BLOCK: u32 = 10_000;

/// Workspace of the platform's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Workspace {
    /// With the platform level.
    pub level: Volume,
    /// With the platform also able to tilt by [`WORKSPACE_TILT`] in each of eight directions.
    pub tilted: Volume,
    /// Smallest and largest coordinates found with the platform level, in the base frame \[m\].
    /// The range includes at least a small box around neutral.
    pub extent: [Vector3<f64>; 2],
    /// Number of points tested.
    pub samples: u32,
}

/// A volume found by testing points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Volume of the workspace \[m3\].
    pub size: f64,
    /// Standard deviation of `size` over other choices of points \[m3\].
    pub standard_error: f64,
}

impl Workspace {
    /// Tests points uniformly distributed over a box that contains the workspace.
    ///
    /// A point counts if all legs are inside their stroke there and the Jacobian's determinant
    /// has the same sign as at neutral. The second condition excludes the platform's mirror
    /// image below the base.
    pub fn of(rig: &Rig, samples: u32) -> Self {
        let [low, high] = workspace_box(rig);
        let blocks = samples.div_ceil(POINTS_PER_BLOCK);
        let samples = blocks * POINTS_PER_BLOCK;
        let found = (0..blocks)
            .into_par_iter()
            .map(|block| tried_block(rig, low, high, block))
            .reduce(Coverage::nothing, Coverage::and);
        let size = (high - low).product();
        let neutral = Pose::neutral(rig).position;
        let little = Vector3::repeat(0.1 * rig.stroke_length());
        Workspace {
            level: Volume::of(found.level, samples, size),
            tilted: Volume::of(found.tilted, samples, size),
            extent: [found.extent[0].inf(&(neutral - little)), found.extent[1].sup(&(neutral + little))],
            samples,
        }
    }
}

impl Volume {
    /// The volume from the number of points inside, for a box of this size.
    fn of(inside: u32, samples: u32, size: f64) -> Self {
        let fraction = f64::from(inside) / f64::from(samples);
        Volume {
            size: fraction * size,
            standard_error: size * (fraction * (1.0 - fraction) / f64::from(samples)).sqrt(),
        }
    }
}

/// A box that contains every position of the level platform. The origin is never farther than a
/// leg's longest length from the point where that leg's joints would coincide.
fn workspace_box(rig: &Rig) -> [Vector3<f64>; 2] {
    let reach = Vector3::repeat(rig.farthest_joint());
    let meeting = (0..6).map(|i| rig.base[i] - rig.platform[i]);
    meeting.fold([-Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::INFINITY)], |[low, high], point| {
        [low.sup(&(point - reach)), high.inf(&(point + reach))]
    })
}

/// Result of a block of points.
#[derive(Clone, Copy)]
struct Coverage {
    level: u32,
    tilted: u32,
    extent: [Vector3<f64>; 2],
}

impl Coverage {
    fn nothing() -> Self {
        let nowhere = Vector3::repeat(f64::INFINITY);
        Coverage { level: 0, tilted: 0, extent: [nowhere, -nowhere] }
    }

    fn and(self, other: Coverage) -> Self {
        let [low, high] = self.extent;
        Coverage {
            level: self.level + other.level,
            tilted: self.tilted + other.tilted,
            extent: [low.inf(&other.extent[0]), high.sup(&other.extent[1])],
        }
    }
}

fn tried_block(rig: &Rig, low: Vector3<f64>, high: Vector3<f64>, block: u32) -> Coverage {
    // Seed of the streams.
    const STREAM_SEED: u64 = 1;
    let mut random = ChaCha8Rng::seed_from_u64(STREAM_SEED);
    random.set_stream(u64::from(block));
    let geometry = Geometry::from(rig);
    let sign = |pose: &Pose| jacobian(&geometry, pose).determinant().signum();
    let neutral = sign(&Pose::neutral(rig));
    let level = Orientation::new(RollPitchYaw::default());
    let mut found = Coverage::nothing();
    for _ in 0..POINTS_PER_BLOCK {
        let fraction = Vector3::from_fn(|_, _| unit(&mut random));
        let position = low + fraction.component_mul(&(high - low));
        let pose = Pose { position, orientation: level };
        if stroke_clearance(rig, &pose) < 0.0 || sign(&pose) != neutral {
            continue;
        }
        let tilted =
            tilted_orientations().all(|orientation| stroke_clearance(rig, &Pose { position, orientation }) >= 0.0);
        found = found.and(Coverage { level: 1, tilted: u32::from(tilted), extent: [position, position] });
    }
    found
}

/// The platform tilted by [`WORKSPACE_TILT`] in each direction.
fn tilted_orientations() -> impl Iterator<Item = Orientation> {
    // Number of directions in which the platform is tilted.
    const TILT_DIRECTIONS: u32 = 8;
    (0..TILT_DIRECTIONS).map(|k| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(TILT_DIRECTIONS)).sin_cos();
        Orientation::new(RollPitchYaw::new(WORKSPACE_TILT * cos, WORKSPACE_TILT * sin, 0.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With all joints of a kind in one point and legs that may shrink to nothing, the workspace is
    /// a ball. Its Jacobian is singular, so the counting is tested without it, on the volume alone.
    #[test]
    fn the_share_of_points_inside_gives_the_volume_and_its_error() {
        let volume = Volume::of(250, 1000, 8.0);
        assert_eq!(volume.size, 2.0);
        assert!((volume.standard_error - 8.0 * (0.25f64 * 0.75 / 1000.0).sqrt()).abs() < 1e-12);
    }

    /// A quadrature of the same volume on a grid, leg by leg, agrees within the errors of both.
    #[test]
    fn the_default_workspace_agrees_with_a_grid() {
        let rig = Rig::default();
        let [low, high] = workspace_box(&rig);
        const N: usize = 120;
        let at = |axis: usize, k: usize| low[axis] + (k as f64 + 0.5) / N as f64 * (high[axis] - low[axis]);
        let mut inside = 0u32;
        for i in 0..N {
            for j in 0..N {
                for k in 0..N {
                    let position = Vector3::new(at(0, i), at(1, j), at(2, k));
                    let reached = (0..6).all(|leg| {
                        let length = (position + rig.platform[leg] - rig.base[leg]).norm();
                        (rig.min_length..=rig.max_length).contains(&length)
                    });
                    inside += u32::from(reached && position.z > 0.0);
                }
            }
        }
        let cell = (high - low).product() / (N * N * N) as f64;
        let expected = f64::from(inside) * cell;
        let found = Workspace::of(&rig, 200_000).level;
        let difference = (found.size - expected).abs();
        assert!(difference < 4.0 * found.standard_error, "{found:?}, grid {expected}");
    }

    #[test]
    fn the_same_points_are_tried_every_time() {
        let rig = Rig::default();
        assert_eq!(Workspace::of(&rig, 20_000), Workspace::of(&rig, 20_000));
    }
}
