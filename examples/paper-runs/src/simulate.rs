//! Steps the FMU through a run by its C functions, as a host does.

use anyhow::{Context, Result, ensure};
use moris_fmu_host::{Fmu, Instance, Status};
use moris_simulation::measures::Limits;

use crate::parameter_set::ParameterSet;
use crate::trace::{Sample, Trace};
use moris_simulation::drives::runs::Manoeuvre;

const STATUS_FLAGS: [&str; 4] =
    ["status.tiltLimited", "status.softLimited", "status.safetyActive", "status.actuatorLimited"];

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
    instance.initialize(&parameters.values(), Some(run.duration))?;

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
    desired_force: [u32; 3],
    desired_rate: [u32; 3],
    roll_and_speed: [u32; 2],
    felt_force: [u32; 3],
    felt_rate: [u32; 3],
    legs: [u32; 6],
    position: [u32; 3],
    tilt_rate: [u32; 2],
    flags: [u32; STATUS_FLAGS.len()],
}

impl References {
    fn of(fmu: &Fmu) -> Result<Self> {
        let vector = |name: &str| value_references(fmu, ["x", "y", "z"].map(|axis| format!("{name}.{axis}")));
        Ok(References {
            desired_force: vector("vehicle.specificForce")?,
            desired_rate: vector("vehicle.angularVelocity")?,
            roll_and_speed: value_references(fmu, ["vehicle.orientation.roll", "vehicle.speed"])?,
            felt_force: vector("rider.specificForce")?,
            felt_rate: vector("rider.angularVelocity")?,
            legs: value_references(fmu, [1, 2, 3, 4, 5, 6].map(|leg| format!("actuator[{leg}].length")))?,
            position: vector("platform.position")?,
            tilt_rate: value_references(fmu, ["tilt.rollRate", "tilt.pitchRate"])?,
            flags: value_references(fmu, STATUS_FLAGS)?,
        })
    }

    fn set_inputs(&self, instance: &mut Instance, run: &Manoeuvre, time: f64) -> Result<()> {
        let motion = run.motion(time);
        let mut set = |references: &[u32], values: &[f64]| {
            let status = instance.set_real(references, values);
            check_status(instance, status)
        };
        set(&self.desired_force, &motion.specific_force())?;
        set(&self.desired_rate, &motion.angular_velocity())?;
        set(&self.roll_and_speed, &[motion.roll, motion.speed])
    }

    fn sample(&self, instance: &mut Instance, run: &Manoeuvre, time: f64) -> Result<Sample> {
        let mut flags = [0; STATUS_FLAGS.len()];
        let status = instance.get_boolean(&self.flags, &mut flags);
        check_status(instance, status)?;
        let [tilt, soft, safety, actuator] = flags.map(|flag| flag != 0);
        let motion = run.motion(time);
        Ok(Sample {
            time,
            desired_force: motion.specific_force(),
            desired_rate: motion.angular_velocity(),
            felt_force: get_reals(instance, &self.felt_force)?,
            felt_rate: get_reals(instance, &self.felt_rate)?,
            legs: get_reals(instance, &self.legs)?,
            position: get_reals(instance, &self.position)?,
            tilt_rate: get_reals(instance, &self.tilt_rate)?,
            limited: Limits { tilt, soft, safety, actuator },
        })
    }
}

fn value_references<const N: usize>(fmu: &Fmu, names: [impl AsRef<str>; N]) -> Result<[u32; N]> {
    let mut references = [0; N];
    for (reference, name) in references.iter_mut().zip(&names) {
        let name = name.as_ref();
        *reference = fmu.variable(name).with_context(|| format!("the FMU has no variable {name}"))?.value_reference;
    }
    Ok(references)
}

fn get_reals<const N: usize>(instance: &mut Instance, references: &[u32; N]) -> Result<[f64; N]> {
    let mut values = [0.0; N];
    let status = instance.get_real(references, &mut values);
    check_status(instance, status)?;
    Ok(values)
}

/// An error with the FMU's last message, unless the status is OK.
fn check_status(instance: &Instance, status: Status) -> Result<()> {
    let message = || instance.messages().last().map_or_else(String::new, |message| message.text.clone());
    ensure!(status == Status::Ok, "the FMU returned {status:?}: {}", message());
    Ok(())
}
