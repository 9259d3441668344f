//! Motion that another washout computed for a recording, made a [`Simulation`]: the same measures,
//! findings and curves.
//!
//! - [`ForeignMotion`] has what is given: felt forces, felt rates, poses, legs.
//! - `evaluate` makes forces and rates of poses, and legs; `differences` takes the derivatives.
//! - `limits` finds where legs exceed the actuators' limits.
//! - `plausible` finds wrong units, signs and frames. `findings` has the sentences.
//! - [`on_samples`] brings series with other times to the recording's samples.

mod differences;
mod evaluate;
mod findings;
mod limits;
mod plausible;
mod times;

use moris_washout::nalgebra::Vector3;
use moris_washout::platform::reach::clearance_of_lengths;
use moris_washout::platform::{Geometry, Pose, leg_lengths};
use moris_washout::{Input, Output, Parameters};
use serde::{Deserialize, Serialize};

use crate::{Refusal, Simulation, refuse};
pub use times::on_samples;

/// Motion of a platform as another washout commands it. Each series has a value for each sample of
/// the recording, or, for finer steps, one for each of a whole number of equal parts of a step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ForeignMotion {
    /// Felt specific force in head axes, gravity's reaction included \[m/s2\].
    pub force: Option<Vec<[f64; 3]>>,
    /// Felt angular velocity in head axes \[rad/s\].
    pub rate: Option<Vec<[f64; 3]>>,
    /// Position of the platform frame's origin in the base frame \[m\], and roll, pitch, yaw
    /// \[rad\].
    pub pose: Option<Vec<[f64; 6]>>,
    /// Lengths of the actuators \[m\].
    pub legs: Option<Vec<[f64; 6]>>,
}

/// Parts of a simulation that were given, and the observations about them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Foreign {
    /// True if rates are known: given, or those of poses.
    pub has_rate: bool,
    /// True if the legs are known: given, or those of poses.
    pub has_legs: bool,
    /// The greatest excess of each of the actuators' limits.
    pub excesses: Vec<String>,
    /// True if a unit, a sign or an axis of what is felt seems wrong.
    pub(crate) is_doubtful: bool,
    /// Sentences about the series, such as that they were interpolated.
    pub notes: Vec<String>,
    /// Observations that let wrong units, signs or frames be suspected, as sentences.
    pub(crate) suspicions: Vec<String>,
}

impl Foreign {
    /// Sentences on what is suspected of the motion, and on how it was read.
    pub fn remarks(&self) -> impl Iterator<Item = &str> {
        self.suspicions.iter().chain(&self.notes).map(String::as_str)
    }
}

impl ForeignMotion {
    /// A simulation with this motion in place of the washout's, judged on the rig, at the washout
    /// location and with the scale of these parameters. `notes` are sentences for the findings.
    ///
    /// # Errors
    /// Nothing to judge is given, or a series does not fit the recording or cannot be meant.
    pub fn simulation(
        &self,
        inputs: &[Input],
        step: f64,
        parameters: &Parameters,
        notes: Vec<String>,
    ) -> Result<Simulation, Refusal> {
        let ForeignMotion { force, rate, pose, legs } = self;
        if force.is_none() && pose.is_none() && legs.is_none() {
            refuse!("nothing to judge is given; give felt_force, pose or legs");
        }
        let samples = inputs.len();
        check_rows("felt_force", force, samples)?;
        check_rows("felt_rate", rate, samples)?;
        check_rows("pose", pose, samples)?;
        check_rows("legs", legs, samples)?;
        plausible::check(pose, legs, parameters)?;

        let of_legs = match (pose, legs) {
            (None, Some(legs)) => Some(evaluate::poses_of_legs(legs, parameters)?),
            _ => None,
        };
        let poses = pose.as_ref().or(of_legs.as_ref());
        let moved = poses.map(|poses| evaluate::Evaluation::of(poses, inputs, step, parameters)).transpose()?;
        let neutral = Pose::neutral(&parameters.rig);
        let mut outputs = vec![at_neutral(&neutral, parameters); samples];
        if let Some(moved) = &moved {
            moved.write(&mut outputs);
        }
        let mut foreign = Foreign {
            has_rate: rate.is_some() || moved.is_some(),
            has_legs: legs.is_some() || moved.is_some(),
            notes,
            ..Foreign::default()
        };
        let legs = legs.as_ref().or(moved.as_ref().map(|moved| &moved.legs));
        if let Some(legs) = legs {
            foreign.excesses = limits::judge(legs, step, &parameters.rig, &mut outputs);
        }
        let mut felt_within_steps: Vec<[f64; 3]> = moved.as_ref().map_or_else(Vec::new, |moved| moved.force.clone());
        match (force, poses, &moved) {
            (Some(force), Some(poses), Some(moved)) => {
                let found = plausible::contradiction(force, poses, &moved.force, samples, step);
                foreign.suspicions.extend(found);
            }
            (None, Some(poses), _) => foreign.suspicions.extend(plausible::rounding(poses, samples, step)),
            _ => (),
        }
        if let (Some(legs), Some(_), Some(moved)) = (legs, pose, &moved) {
            foreign.suspicions.extend(plausible::other_legs(legs, &moved.legs));
        }
        let mut write = |series: &[[f64; 3]], of: fn(&mut Output) -> &mut Vector3<f64>| {
            let parts = (series.len() - 1) / (samples - 1);
            let at_samples = outputs.iter_mut().zip(series.iter().step_by(parts));
            at_samples.for_each(|(output, felt)| *of(output) = (*felt).into());
        };
        if let Some(force) = force {
            write(force, |output| &mut output.felt_specific_force);
            felt_within_steps.clone_from(force);
        }
        if let Some(rate) = rate {
            write(rate, |output| &mut output.felt_angular_velocity);
        }
        let felt_within_steps = felt_within_steps.into_iter().map(Into::into).collect();
        let mut simulation = Simulation {
            step,
            parameters: *parameters,
            inputs: inputs.to_vec().into(),
            outputs,
            felt_within_steps,
            foreign: None,
        };
        let suspicions = plausible::suspicions(&simulation, foreign.has_rate);
        foreign.is_doubtful = !suspicions.is_empty();
        foreign.suspicions.extend(suspicions);
        simulation.foreign = Some(foreign);
        Ok(simulation)
    }
}

/// The output of a platform at rest at neutral, of whose rider nothing is known.
fn at_neutral(neutral: &Pose, parameters: &Parameters) -> Output {
    let length = leg_lengths(&Geometry::from(&parameters.rig), neutral);
    Output {
        position: neutral.position,
        felt_specific_force: Vector3::new(0.0, 0.0, parameters.structure.gravity),
        length,
        stroke_margin: clearance_of_lengths(&parameters.rig, &length),
        ..Output::default()
    }
}

/// Checks a series against the number of the recording's samples.
///
/// # Errors
/// Its length is not that of whole parts of the steps, or a value is not finite.
fn check_rows<const N: usize>(argument: &str, series: &Option<Vec<[f64; N]>>, samples: usize) -> Result<(), Refusal> {
    let Some(series) = series else { return Ok(()) };
    let found = series.len();
    if samples < 2 || found < samples || (found - 1) % (samples - 1) != 0 {
        refuse!(sentence!["rows", argument, found, samples, steps = samples.wrapping_sub(1)]);
    }
    for (row, values) in series.iter().enumerate() {
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            refuse!(sentence!["not-finite", argument, row, value]);
        }
    }
    Ok(())
}
