//! The sensor's mounting in the vehicle: given as angles, or found from the recording.

use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::{Matrix3, Rotation3, Vector3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::median;

/// The sensor's orientation in the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub enum Mounting {
    /// To be found from gravity and the first acceleration.
    Auto,
    /// Roll, pitch and yaw of the sensor in the vehicle's axes \[rad\].
    Angles(RollPitchYaw),
}

/// The mounting in a file of conventions.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Written {
    /// auto
    Word(String),
    /// Roll, pitch and yaw of the sensor in the vehicle's axes, in degrees
    Angles([f64; 3]),
}

impl TryFrom<Written> for Mounting {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Word(word) => Mounting::parse(&word),
            Written::Angles(degrees) => Mounting::of_degrees(degrees),
        }
    }
}

impl Mounting {
    /// `auto`, or `ROLL,PITCH,YAW` in degrees.
    ///
    /// # Errors
    /// The text is neither.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.trim() == "auto" {
            return Ok(Mounting::Auto);
        }
        let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        let angles = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
        Self::of_degrees(angles.ok_or("write auto, or ROLL,PITCH,YAW in degrees, as in 0,90,0")?)
    }

    fn of_degrees(degrees: [f64; 3]) -> Result<Self, String> {
        if degrees.iter().any(|angle| !(-360.0..=360.0).contains(angle)) {
            return Err("roll, pitch and yaw must be from -360 to 360 degrees".to_owned());
        }
        Ok(Mounting::Angles(RollPitchYaw::from_vector(Vector3::from(degrees).map(f64::to_radians))))
    }
}

/// Rotation from the sensor's axes to the vehicle's.
pub fn rotation(angles: RollPitchYaw) -> Matrix3<f64> {
    Orientation::new(angles).rotation
}

/// A recording in the sensor's axes.
pub struct SensorMotion<'a> {
    /// Time between samples \[s\].
    pub step: f64,
    /// Specific force with gravity \[m/s2\].
    pub forces: &'a [Vector3<f64>],
    /// Angular velocity \[rad/s\].
    pub rates: &'a [Vector3<f64>],
    /// Speed of the vehicle \[m/s\].
    pub speeds: Option<&'a [f64]>,
}

/// A mounting that was found.
pub struct Found {
    /// Rotation from the sensor's axes to the vehicle's.
    pub rotation: Matrix3<f64>,
    /// The angles and their evidence, in a sentence.
    pub warning: String,
}

/// Time over which samples are averaged before the search \[s\].
const BLOCK: f64 = 0.1;
/// Blocks of a stretch at rest: 1 s.
const REST: usize = 10;
/// Largest change of the specific force at rest \[m/s2\].
const REST_FORCE: f64 = 0.3;
/// Largest angular velocity at rest \[rad/s\].
const REST_RATE: f64 = 0.05;
/// Horizontal specific force above which an acceleration begins, and below which it ends \[m/s2\].
const ACCELERATION: [f64; 2] = [0.5, 0.25];
/// Largest angular velocity about the vertical in an acceleration straight ahead \[rad/s\].
const STRAIGHT: f64 = 0.1;
/// Shortest acceleration, in blocks: 0.5 s.
const SHORTEST: usize = 5;
/// Least change of speed that determines the forward direction, as a standard deviation
/// of its rate \[m/s2\].
const SPEED_CHANGE: f64 = 0.2;

/// Means of [`BLOCK`]s of a recording.
struct Blocks {
    forces: Vec<Vector3<f64>>,
    rates: Vec<Vector3<f64>>,
    speeds: Vec<f64>,
}

impl Blocks {
    fn new(motion: &SensorMotion) -> Self {
        let size = ((BLOCK / motion.step).round() as usize).max(1);
        let mean = |vectors: &[Vector3<f64>]| vectors.iter().sum::<Vector3<f64>>() / vectors.len() as f64;
        let means = |vectors: &[Vector3<f64>]| vectors.chunks_exact(size).map(mean).collect::<Vec<_>>();
        let speeds = motion.speeds.unwrap_or_default().chunks_exact(size);
        Blocks {
            forces: means(motion.forces),
            rates: means(motion.rates),
            speeds: speeds.map(|speeds| speeds.iter().sum::<f64>() / speeds.len() as f64).collect(),
        }
    }

    /// The median of the specific forces in stretches at rest or at constant speed, if there are
    /// any.
    fn rest(&self) -> Option<Vector3<f64>> {
        let is_quiet = |&start: &usize| {
            let forces = &self.forces[start..start + REST];
            let steady = (0..3).all(|axis| {
                let values = forces.iter().map(|force| force[axis]);
                values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min) < REST_FORCE
            });
            steady && self.rates[start..start + REST].iter().all(|rate| rate.norm() < REST_RATE)
        };
        let starts = (0..(self.forces.len() + 1).saturating_sub(REST)).step_by(REST / 2);
        let quiet: Vec<Vector3<f64>> = starts
            .filter(is_quiet)
            .map(|start| self.forces[start..start + REST].iter().sum::<Vector3<f64>>() / REST as f64)
            .collect();
        (!quiet.is_empty()).then(|| Vector3::from_fn(|axis, _| median(quiet.iter().map(|force| force[axis]))))
    }

    /// The horizontal specific force correlated with the change of speed.
    fn along_speed(&self, up: &Vector3<f64>) -> Option<Vector3<f64>> {
        let changes: Vec<f64> = self.speeds.windows(3).map(|s| (s[2] - s[0]) / (2.0 * BLOCK)).collect();
        let size = (changes.iter().map(|change| change * change).sum::<f64>() / changes.len().max(1) as f64).sqrt();
        let forces = self.forces.iter().skip(1);
        (size > SPEED_CHANGE).then(|| changes.iter().zip(forces).map(|(c, f)| *c * horizontal(f, up)).sum())
    }

    /// The time of the first acceleration straight ahead in blocks, and the sum of its horizontal
    /// specific forces.
    fn first_acceleration(&self, up: &Vector3<f64>) -> Option<(usize, Vector3<f64>)> {
        let is_straight = |block: usize| self.rates[block].dot(up).abs() < STRAIGHT;
        let force = |block: usize| horizontal(&self.forces[block], up);
        let mut block = 0;
        while block < self.forces.len() {
            if force(block).norm() < ACCELERATION[0] || !is_straight(block) {
                block += 1;
                continue;
            }
            let last = (block..self.forces.len()).find(|&k| force(k).norm() < ACCELERATION[1] || !is_straight(k));
            let end = last.unwrap_or(self.forces.len());
            if end - block >= SHORTEST {
                return Some((block, (block..end).map(force).sum()));
            }
            block = end;
        }
        None
    }
}

/// Finds the mounting. Up is the direction of the specific force at rest. Forward follows from the
/// change of speed, or from the first acceleration straight ahead.
///
/// # Errors
/// The recording contains no gravity, or no acceleration straight ahead.
pub fn find(motion: &SensorMotion) -> Result<Found, String> {
    let blocks = Blocks::new(motion);
    let rest = blocks.rest();
    let whole = || motion.forces.iter().sum::<Vector3<f64>>() / motion.forces.len() as f64;
    let gravity = rest.unwrap_or_else(whole);
    if (gravity.norm() / STANDARD_GRAVITY - 1.0).abs() > 0.2 {
        return Err(format!(
            "--mounting auto finds no gravity: at rest the specific force is {:.2} m/s2; check --force-unit, or give \
             --mounting ROLL,PITCH,YAW",
            gravity.norm()
        ));
    }
    let up = gravity.normalize();
    let (along, evidence) = match blocks.along_speed(&up) {
        Some(along) => (along, "the change of speed".to_owned()),
        None => {
            let (block, along) = blocks.first_acceleration(&up).ok_or(
                "--mounting auto finds no acceleration straight ahead that lasts 0.5 s, so forward is unknown; give \
                 --mounting ROLL,PITCH,YAW in degrees",
            )?;
            let time = block as f64 * BLOCK;
            (along, format!("the first acceleration, at {time:.1} s (if it is a braking, add 180 to yaw)"))
        }
    };
    let forward = horizontal(&along, &up).normalize();
    let left = up.cross(&forward);
    let rotation = Matrix3::from_rows(&[forward.transpose(), left.transpose(), up.transpose()]);
    let (roll, pitch, yaw) = Rotation3::from_matrix_unchecked(rotation).euler_angles();
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(f64::to_degrees);
    let level = if rest.is_some() { "gravity" } else { "the mean force, as the recording has no second of rest" };
    let warning = format!(
        "The sensor's mounting was found from {level} and {evidence}: --mounting={roll:.1},{pitch:.1},{yaw:.1} gives the \
         same."
    );
    Ok(Found { rotation, warning })
}

/// The part of a vector that is perpendicular to `up`.
fn horizontal(vector: &Vector3<f64>, up: &Vector3<f64>) -> Vector3<f64> {
    vector - up * vector.dot(up)
}
