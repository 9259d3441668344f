//! The washout through the C functions of its shared library, as a host of FMI 2.0 calls them.

use std::path::Path;

use anyhow::{Result, ensure};
use moris_fmu_host::{Fmu, Instance, State, Status, variables_of};
use moris_interface::{Causality, Kind, Variability};
use moris_washout::interface::PREVIEW_SAMPLES;
use moris_washout::{Preview, Washout};

use super::{Inputs, Target};
use crate::hunter::episode::Scope;
use crate::hunter::oracle::{Derivative, Sample};
use crate::hunter::variables::{IDENTITY, REAL_INPUTS, Variables};

/// An instance with what a host keeps beside it. Fields are dropped in their order.
pub struct FmuTarget {
    instance: Option<Instance>,
    fmu: Fmu,
    time: f64,
    fresh: Option<State>,
    saved: Option<(State, f64)>,
    /// The state to which a trial goes back.
    trial: Option<(State, f64)>,
    bytes: Option<(Vec<u8>, f64)>,
    inputs: Vec<u32>,
    engaged: u32,
    preview_count: u32,
    preview: Vec<u32>,
    outputs: Vec<u32>,
    values: Vec<f64>,
    derivatives: Vec<f64>,
    /// Where the outputs that the oracle knows begin among the real outputs.
    places: Places,
}

/// Places among the real outputs.
struct Places {
    position: usize,
    velocity: usize,
    acceleration: usize,
    orientation: usize,
    angular_velocity: usize,
    length: usize,
    leg_velocity: usize,
}

impl FmuTarget {
    /// Opens an FMU (a file ending in `.fmu`) or its shared library alone.
    ///
    /// # Errors
    /// The FMU or the library cannot be opened.
    pub fn open(file: &Path, variables: &Variables) -> Result<Self> {
        let fmu = if file.extension().is_some_and(|extension| extension == "fmu") {
            Fmu::open(file)?
        } else {
            Fmu::with_variables(file, &moris_interface::guid::<Washout>(), variables_of(&IDENTITY))?
        };
        let reference = |name: &str| Ok::<_, anyhow::Error>(variables.slot(name)? as u32);
        let inputs = variables.inputs();
        let outputs: Vec<u32> = (0..IDENTITY.slots.len())
            .filter(|&slot| {
                let row = IDENTITY.row(slot);
                row.causality == Causality::Output && matches!(row.kind, Kind::Real(_))
            })
            .map(|slot| slot as u32)
            .collect();
        let place = |name: &str| {
            let slot = reference(name)?;
            outputs.iter().position(|&output| output == slot).ok_or_else(|| anyhow::anyhow!("{name} is no output"))
        };
        let places = Places {
            position: place("platform.position.x")?,
            velocity: place("platform.velocity.x")?,
            acceleration: place("platform.acceleration.x")?,
            orientation: place("platform.orientation.roll")?,
            angular_velocity: place("platform.angularVelocity.x")?,
            length: place("actuator[1].length")?,
            leg_velocity: place("actuator[1].velocity")?,
        };
        let mut preview = vec![reference("vehicle.preview.step")?];
        for axis in ["x", "y"] {
            for k in 1..=PREVIEW_SAMPLES {
                preview.push(reference(&format!("vehicle.preview.specificForce.{axis}[{k}]"))?);
            }
        }
        Ok(FmuTarget {
            instance: None,
            fmu,
            time: 0.0,
            fresh: None,
            saved: None,
            trial: None,
            bytes: None,
            inputs: inputs[..REAL_INPUTS].iter().map(|(name, _)| reference(name)).collect::<Result<_>>()?,
            engaged: reference(&inputs[REAL_INPUTS].0)?,
            preview_count: reference("vehicle.preview.count")?,
            preview,
            values: vec![0.0; outputs.len()],
            derivatives: vec![0.0; outputs.len()],
            outputs,
            places,
        })
    }

    fn instance(&mut self) -> &mut Instance {
        self.instance.as_mut().expect("a machine is made before it is driven")
    }

    fn free_states(&mut self) {
        if let Some(instance) = &mut self.instance {
            let saved = [self.saved.take(), self.trial.take()].into_iter().flatten().map(|(state, _)| state);
            for state in self.fresh.take().into_iter().chain(saved) {
                instance.free_state(state);
            }
        }
        self.bytes = None;
    }
}

impl Drop for FmuTarget {
    fn drop(&mut self) {
        self.free_states();
    }
}

impl Target for FmuTarget {
    fn make(&mut self, slots: &[f64]) -> Result<()> {
        self.free_states();
        self.time = 0.0;
        let mut instance = self.fmu.instantiate("hunter")?;
        let parameters: Vec<(String, f64)> = [Variability::Fixed, Variability::Tunable]
            .into_iter()
            .flat_map(|variability| {
                let is_set = move |slot: &usize| {
                    let row = IDENTITY.row(*slot);
                    row.causality == Causality::Parameter && row.variability == variability
                };
                (0..IDENTITY.slots.len()).filter(is_set).map(|slot| (IDENTITY.variable_name(slot), slots[slot]))
            })
            .collect();
        let parameters: Vec<(&str, f64)> = parameters.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        instance.initialize(&parameters, None)?;
        self.fresh = Some(instance.get_state()?);
        self.instance = Some(instance);
        Ok(())
    }

    fn rewind(&mut self) {
        for (state, _) in [self.saved.take(), self.trial.take()].into_iter().flatten() {
            self.instance().free_state(state);
        }
        self.bytes = None;
        self.time = 0.0;
        let FmuTarget { instance: Some(instance), fresh: Some(fresh), .. } = self else { return };
        instance.set_state(fresh);
    }

    fn set(&mut self, slots: &[f64], changed: &[usize]) -> bool {
        let is_real = |slot: &&usize| matches!(IDENTITY.row(**slot).kind, Kind::Real(_));
        let (reals, others): (Vec<&usize>, Vec<&usize>) = changed.iter().partition(is_real);
        let references: Vec<u32> = reals.iter().map(|&&slot| slot as u32).collect();
        let values: Vec<f64> = reals.iter().map(|&&slot| slots[slot]).collect();
        // An empty call is right, too, but says nothing.
        let set = references.is_empty() || self.instance().set_real(&references, &values) == Status::Ok;
        let references: Vec<u32> = others.iter().map(|&&slot| slot as u32).collect();
        let values: Vec<i32> = others.iter().map(|&&slot| slots[slot] as i32).collect();
        set && (references.is_empty() || self.instance().set_integer(&references, &values) == Status::Ok)
    }

    fn preview(&mut self, preview: &Preview) {
        let references = std::mem::take(&mut self.preview);
        let count = self.preview_count;
        let values: Vec<f64> = [preview.step].iter().chain(&preview.surge).chain(&preview.sway).copied().collect();
        let instance = self.instance();
        // A count out of its range and what is not a number are refused. Then the preview stays as it was.
        let counted = instance.set_integer(&[count], &[preview.count]);
        if (counted, instance.set_real(&references, &values)) != (Status::Ok, Status::Ok) {
            instance.take_messages();
        }
        self.preview = references;
    }

    fn step(&mut self, start: &Inputs, end: Option<&Inputs>, step: f64) -> Result<()> {
        let (time, engaged) = (self.time, self.engaged);
        let references = std::mem::take(&mut self.inputs);
        let instance = self.instance();
        // What is not a number is refused, and the inputs stay as they were.
        let set = instance.set_real(&references, &start.reals);
        if let Some(end) = end.filter(|_| set == Status::Ok) {
            let slopes: [f64; REAL_INPUTS] = std::array::from_fn(|k| (end.reals[k] - start.reals[k]) / step);
            instance.set_real_input_derivatives(&references, &slopes);
        }
        if set != Status::Ok {
            instance.take_messages();
        }
        instance.set_boolean(&[engaged], &[i32::from(start.engaged)]);
        let status = instance.do_step(time, step);
        ensure!(status == Status::Ok, "fmi2DoStep: {status:?}: {:?}", instance.take_messages());
        self.inputs = references;
        self.time = time + step;
        Ok(())
    }

    fn sample(&mut self, neutral_height: f64) -> Sample {
        let FmuTarget { instance, outputs, values, derivatives, places, .. } = self;
        let instance = instance.as_mut().expect("a machine is made before it is driven");
        let read = instance.get_real(outputs, values);
        let derived = instance.get_real_output_derivatives(outputs, derivatives);
        let mut sample = Sample {
            position: part(values, places.position),
            velocity: part(values, places.velocity),
            acceleration: part(values, places.acceleration),
            angular_velocity: part(values, places.angular_velocity),
            length: part(values, places.length),
            leg_velocity: part(values, places.leg_velocity),
            derivative: Derivative {
                position: part(derivatives, places.position),
                velocity: part(derivatives, places.velocity),
                orientation: part(derivatives, places.orientation),
                length: part(derivatives, places.length),
                leg_velocity: part(derivatives, places.leg_velocity),
            },
            sum: values.iter().chain(&*derivatives).sum(),
        };
        sample.position[2] -= neutral_height;
        if (read, derived) != (Status::Ok, Status::Ok) {
            sample.sum = f64::NAN;
        }
        sample
    }

    fn save(&mut self, scope: Scope) -> Result<()> {
        let FmuTarget { instance, saved, trial, bytes, time, .. } = self;
        let instance = instance.as_mut().expect("a machine is made before it is driven");
        let place = match scope {
            Scope::Memory => saved,
            Scope::Trial => trial,
            Scope::Bytes => {
                let state = instance.get_state()?;
                *bytes = Some((instance.serialize(&state)?, *time));
                instance.free_state(state);
                return Ok(());
            }
        };
        let (mut state, _) = match place.take() {
            Some(saved) => saved,
            None => (instance.get_state()?, *time),
        };
        let status = instance.get_state_into(&mut state);
        *place = Some((state, *time));
        ensure!(status == Status::Ok, "fmi2GetFMUstate: {status:?}");
        Ok(())
    }

    fn restore(&mut self, scope: Scope) -> Result<()> {
        let FmuTarget { instance, saved, trial, bytes, .. } = self;
        let instance = instance.as_mut().expect("a machine is made before it is driven");
        let in_memory = if scope == Scope::Trial { trial } else { saved };
        let (status, time) = match (scope, in_memory, bytes) {
            (Scope::Memory | Scope::Trial, Some((state, time)), _) => (instance.set_state(state), *time),
            (Scope::Bytes, _, Some((bytes, time))) => {
                let state = instance.deserialize(bytes)?;
                let status = instance.set_state(&state);
                instance.free_state(state);
                (status, *time)
            }
            _ => anyhow::bail!("no state has been saved"),
        };
        ensure!(status == Status::Ok, "fmi2SetFMUstate: {status:?}");
        self.time = time;
        Ok(())
    }
}

/// Some values from this place on.
fn part<const COUNT: usize>(values: &[f64], place: usize) -> [f64; COUNT] {
    std::array::from_fn(|k| values[place + k])
}
