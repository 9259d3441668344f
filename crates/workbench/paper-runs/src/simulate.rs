//! Steps the FMU through a run by its C functions, as a host does.

use anyhow::{Context, Result, ensure};
use moris_fmu_host::{Fmu, Instance, Status};
use moris_measures::LimitFlags;

use crate::manoeuvres::Manoeuvre;
use crate::parameter_set::ParameterSet;
use crate::trace::{Sample, Trace};

const INPUTS: [&str; 8] = [
    "vehicle.specificForce.x",
    "vehicle.specificForce.y",
    "vehicle.specificForce.z",
    "vehicle.angularVelocity.x",
    "vehicle.angularVelocity.y",
    "vehicle.angularVelocity.z",
    "vehicle.orientation.roll",
    "vehicle.speed",
];

const OUTPUTS: [&str; 17] = [
    "rider.specificForce.x",
    "rider.specificForce.y",
    "rider.specificForce.z",
    "rider.angularVelocity.x",
    "rider.angularVelocity.y",
    "rider.angularVelocity.z",
    "actuator[1].length",
    "actuator[2].length",
    "actuator[3].length",
    "actuator[4].length",
    "actuator[5].length",
    "actuator[6].length",
    "platform.position.x",
    "platform.position.y",
    "platform.position.z",
    "tilt.rollRate",
    "tilt.pitchRate",
];

const FLAGS: [&str; 4] = ["status.tiltLimited", "status.softLimited", "status.safetyActive", "status.actuatorLimited"];

/// Simulates one run with one set of parameters, in communication steps of `step` seconds.
///
/// Inputs are set at the beginning of a step and held, as by a simple host. Felt and desired
/// signals are compared at its end. So the felt signals respond to inputs that are one step old,
/// and the measured delays include this step.
///
/// # Errors
/// The step is not between 0 and the run's duration, the FMU lacks a variable, or one of its
/// functions fails. The error then contains the FMU's message.
pub fn simulate(fmu: &Fmu, run: &Manoeuvre, parameters: &ParameterSet, step: f64) -> Result<Trace> {
    ensure!(step > 0.0 && step <= run.duration, "the step must be between 0 and {} s, not {step} s", run.duration);
    let references = References::of(fmu)?;
    let mut instance = fmu.instantiate(run.name)?;
    instance.initialize(parameters.values, Some(run.duration))?;

    let steps = (run.duration / step).round() as usize;
    let mut samples = Vec::with_capacity(steps + 1);
    samples.push(references.sample(&mut instance, run, 0.0)?);
    for k in 0..steps {
        let time = k as f64 * step;
        references.set_inputs(&mut instance, run, time)?;
        let step = step.min(run.duration - time);
        instance.step(time, step)?;
        samples.push(references.sample(&mut instance, run, time + step)?);
    }
    Ok(Trace {
        run: run.name,
        parameters: parameters.name,
        step,
        neutral_height: instance.get("rig.neutralHeight")?,
        stroke: [instance.get("actuator.minLength")?, instance.get("actuator.maxLength")?],
        samples,
    })
}

/// The value references of the variables that a run needs.
struct References {
    inputs: [u32; INPUTS.len()],
    outputs: [u32; OUTPUTS.len()],
    flags: [u32; FLAGS.len()],
}

impl References {
    fn of(fmu: &Fmu) -> Result<Self> {
        Ok(References {
            inputs: value_references(fmu, INPUTS)?,
            outputs: value_references(fmu, OUTPUTS)?,
            flags: value_references(fmu, FLAGS)?,
        })
    }

    fn set_inputs(&self, instance: &mut Instance, run: &Manoeuvre, time: f64) -> Result<()> {
        let motion = run.motion(time);
        let [fx, fy, fz] = motion.specific_force();
        let [wx, wy, wz] = motion.angular_velocity();
        let status = instance.set_real(&self.inputs, &[fx, fy, fz, wx, wy, wz, motion.roll, motion.speed]);
        check(instance, status)
    }

    fn sample(&self, instance: &mut Instance, run: &Manoeuvre, time: f64) -> Result<Sample> {
        let mut values = [0.0; OUTPUTS.len()];
        let status = instance.get_real(&self.outputs, &mut values);
        check(instance, status)?;
        let mut flags = [0; FLAGS.len()];
        let status = instance.get_boolean(&self.flags, &mut flags);
        check(instance, status)?;

        let [fx, fy, fz, wx, wy, wz, l1, l2, l3, l4, l5, l6, px, py, pz, roll_rate, pitch_rate] = values;
        let [tilt, soft, safety, actuator] = flags.map(|flag| flag != 0);
        let motion = run.motion(time);
        Ok(Sample {
            time,
            desired_force: motion.specific_force(),
            desired_rate: motion.angular_velocity(),
            felt_force: [fx, fy, fz],
            felt_rate: [wx, wy, wz],
            legs: [l1, l2, l3, l4, l5, l6],
            position: [px, py, pz],
            tilt_rate: [roll_rate, pitch_rate],
            limited: LimitFlags { tilt, soft, safety, actuator },
        })
    }
}

fn value_references<const N: usize>(fmu: &Fmu, names: [&str; N]) -> Result<[u32; N]> {
    let mut references = [0; N];
    for (reference, name) in references.iter_mut().zip(names) {
        *reference = fmu.variable(name).with_context(|| format!("the FMU has no variable {name}"))?.value_reference;
    }
    Ok(references)
}

/// An error with the FMU's last message, unless the status is OK.
fn check(instance: &Instance, status: Status) -> Result<()> {
    let message = || instance.messages().last().map_or_else(String::new, |message| message.text.clone());
    ensure!(status == Status::Ok, "the FMU returned {status:?}: {}", message());
    Ok(())
}
