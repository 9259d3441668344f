//! Forces, rates and legs of poses.

use std::array;

use moris_washout::cueing::evaluator::felt;
use moris_washout::motion::Motion;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw, RotationalMotion};
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::{Geometry, LocationFrame, PlatformMotion, Pose, forward_kinematics, inverse_kinematics};
use moris_washout::{Input, Output, Parameters};

use super::differences::{MIN_DERIVATIVE_SAMPLES, derivatives, unwrapped};
use crate::{Refusal, refuse};

/// The motion through a series of poses, and what is felt on it.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Poses to a step of the recording.
    parts: usize,
    motions: Vec<PlatformMotion>,
    rate: Vec<Vector3<f64>>,
    /// Felt specific force at each pose \[m/s2\].
    pub force: Vec<[f64; 3]>,
    /// Lengths of the actuators at each pose \[m\].
    pub legs: Vec<[f64; 6]>,
    leg_rates: Vec<[f64; 6]>,
}

impl Evaluation {
    /// Evaluates poses whose derivatives are finite differences over five samples.
    ///
    /// # Errors
    /// There are too few poses.
    pub fn of(poses: &[[f64; 6]], inputs: &[Input], step: f64, parameters: &Parameters) -> Result<Self, Refusal> {
        if poses.len() < MIN_DERIVATIVE_SAMPLES {
            let (found, fewest) = (poses.len(), MIN_DERIVATIVE_SAMPLES);
            refuse!("pose has {found} rows, but forces of poses need at least {fewest}");
        }
        let parts = (poses.len() - 1) / (inputs.len() - 1);
        let step = step / parts as f64;
        let coordinates: [Vec<f64>; 6] = array::from_fn(|k| {
            let values: Vec<f64> = poses.iter().map(|pose| pose[k]).collect();
            if k < 3 { values } else { unwrapped(&values) }
        });
        let derivatives = coordinates.each_ref().map(|values| derivatives(values, step));
        let axes = |sample: usize, first: usize| {
            let axis = |k: usize| {
                let [velocity, acceleration] = derivatives[first + k][sample];
                Motion { position: coordinates[first + k][sample], velocity, acceleration }
            };
            Motion::<Vector3<f64>>::from_axes(axis)
        };
        let motion =
            |sample: usize| PlatformMotion::new(&axes(sample, 0), &RotationalMotion::new(&axes(sample, 3)), 0.0);
        let motions: Vec<PlatformMotion> = (0..poses.len()).map(motion).collect();
        let geometry = Geometry::from(&parameters.rig);
        let legs = motions.iter().map(|motion| inverse_kinematics(&geometry, motion));
        let (legs, leg_rates) = legs.map(|legs| (legs.position, legs.velocity)).unzip();
        let head = |sample: usize| {
            let (before, part) = (sample / parts, sample % parts);
            let lean = match part {
                0 => inputs[before].lean,
                part => inputs[before].towards(&inputs[before + 1], part as f64 / parts as f64).lean,
            };
            LocationFrame::new(&parameters.structure, lean)
        };
        let felt = motions.iter().enumerate().map(|(k, motion)| felt(motion, &head(k), parameters.structure.gravity));
        let (force, rate) = felt.map(|felt| (<[f64; 3]>::from(felt.specific_force), felt.angular_velocity)).unzip();
        Ok(Evaluation { parts, motions, rate, force, legs, leg_rates })
    }

    /// Writes the motion at the recording's samples.
    pub fn write(&self, outputs: &mut [Output]) {
        for (k, output) in outputs.iter_mut().enumerate() {
            let k = k * self.parts;
            let motion = &self.motions[k];
            *output = Output {
                position: motion.position,
                velocity: motion.velocity,
                acceleration: motion.acceleration,
                orientation: motion.orientation.angles,
                angular_velocity: motion.angular_velocity,
                length: self.legs[k],
                leg_velocity: self.leg_rates[k],
                felt_specific_force: self.force[k].into(),
                felt_angular_velocity: self.rate[k],
                ..*output
            };
        }
    }
}

/// The poses in which the legs have these lengths, from neutral on.
///
/// # Errors
/// There is no such pose near the one before.
pub fn poses_of_legs(legs: &[[f64; 6]], parameters: &Parameters) -> Result<Vec<[f64; 6]>, Refusal> {
    let geometry = Geometry::from(&parameters.rig);
    let mut last = Pose::neutral(&parameters.rig);
    let pose = |(row, lengths): (usize, &[f64; 6])| {
        let found = forward_kinematics(&geometry, lengths, &last);
        let Ok(pose) = found else {
            refuse!(sentence!["no-such-pose", row, lengths = format!("{lengths:?}")]);
        };
        last = Pose { orientation: Orientation::new(pose.orientation.angles), ..pose };
        let RollPitchYaw { roll, pitch, yaw } = pose.orientation.angles;
        Ok([pose.position.x, pose.position.y, pose.position.z, roll, pitch, yaw])
    };
    legs.iter().enumerate().map(pose).collect()
}
