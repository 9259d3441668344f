//! Steps the FMU through a run by its C functions, as a host does.

use anyhow::{Result, ensure};
use moris_fmu_host::{Fmu, HostError, Instance};
use moris_simulation::measures::Limits;

use crate::parameter_set::ParameterSet;
use crate::trace::{Sample, Trace};
use moris_simulation::drives::runs::Manoeuvre;

const AXES: [&str; 3] = ["x", "y", "z"];

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
    let mut instance = fmu.instantiate(run.name)?;
    instance.initialize(&parameters.values(), Some(run.duration))?;

    let steps = (run.duration / step).round() as usize;
    let mut samples = vec![sample(&mut instance, run, 0.0)?];
    for k in 0..steps {
        let time = k as f64 * step;
        set_inputs(&mut instance, run, time)?;
        let step = step.min(run.duration - time);
        instance.step(time, step)?;
        samples.push(sample(&mut instance, run, time + step)?);
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

fn set_inputs(instance: &mut Instance, run: &Manoeuvre, time: f64) -> Result<(), HostError> {
    let motion = run.motion(time);
    let (force, rate) = (motion.specific_force(), motion.angular_velocity());
    for (k, axis) in AXES.into_iter().enumerate() {
        instance.set(&format!("vehicle.specificForce.{axis}"), force[k])?;
        instance.set(&format!("vehicle.angularVelocity.{axis}"), rate[k])?;
    }
    instance.set("vehicle.orientation.roll", motion.roll)?;
    instance.set("vehicle.speed", motion.speed)
}

fn sample(instance: &mut Instance, run: &Manoeuvre, time: f64) -> Result<Sample, HostError> {
    let motion = run.motion(time);
    let mut is_set = |flag: &str| Ok(instance.get(flag)? != 0.0);
    let limited = Limits {
        tilt: is_set("status.tiltLimited")?,
        soft: is_set("status.softLimited")?,
        safety: is_set("status.safetyActive")?,
        actuator: is_set("status.actuatorLimited")?,
    };
    let mut vector = |name: &str| values(instance, AXES.map(|axis| format!("{name}.{axis}")));
    Ok(Sample {
        time,
        desired_force: motion.specific_force(),
        desired_rate: motion.angular_velocity(),
        felt_force: vector("rider.specificForce")?,
        felt_rate: vector("rider.angularVelocity")?,
        position: vector("platform.position")?,
        legs: values(instance, [1, 2, 3, 4, 5, 6].map(|leg| format!("actuator[{leg}].length")))?,
        tilt_rate: values(instance, ["tilt.rollRate", "tilt.pitchRate"].map(str::to_owned))?,
        limited,
    })
}

fn values<const N: usize>(instance: &mut Instance, names: [String; N]) -> Result<[f64; N], HostError> {
    let mut values = [0.0; N];
    for (value, name) in values.iter_mut().zip(&names) {
        *value = instance.get(name)?;
    }
    Ok(values)
}
