//! Another washout as an FMU, stepped through a recording.
//!
//! [`Map`] names its inputs and outputs. [`WashoutFmu::motion`] steps it, and gives its motion as a
//! table of felt motion, which is then judged as any other.

mod map;

use std::path::{Path, PathBuf};

use moris_fmu_host::{Causality, Running};
use moris_simulation::foreign::ForeignMotion;
use moris_washout::Input;

use crate::error::{About, Result, bail, ensure};
use crate::message::Message;
use crate::recording::Quantity;
use crate::recording::Recording;
use crate::recording::felt::{FeltTable, Kind};
use crate::texts::text;
pub use map::Map;
use map::{MappedOutput, MappedVariable};

/// Tolerance of the ratio of two steps against a whole number.
const STEP_RATIO_TOLERANCE: f64 = 1e-6;

/// A washout's FMU and its map.
#[derive(Clone, Debug)]
pub struct WashoutFmu {
    /// The FMU.
    pub file: PathBuf,
    map: Map,
}

/// A variable that takes a quantity.
struct Taken {
    quantity: Quantity,
    name: String,
    /// Factor from SI.
    factor: f64,
    offset: f64,
    /// True if it takes the slope.
    has_slope: bool,
}

/// An output, or a constant.
struct Given {
    title: String,
    /// The variable and the factor to SI.
    variable: Option<(String, f64)>,
    offset: f64,
}

impl WashoutFmu {
    /// The FMU with the map in a file.
    ///
    /// # Errors
    /// The map cannot be used.
    pub fn with_map(file: &Path, map: &Path) -> Result<Self> {
        Ok(WashoutFmu { file: file.to_owned(), map: Map::read(map)? })
    }

    /// The washout's motion for a recording, and sentences about it. The inputs are
    /// linear between the samples; an FMU that takes slopes gets those of each step,
    /// others the values at its start.
    ///
    /// # Errors
    /// The FMU lacks a variable of the map or has it in another unit, or does not make a step.
    pub fn motion(&self, recording: &Recording) -> Result<(ForeignMotion, Vec<String>)> {
        let sample = recording.step();
        let step = self.map.step.unwrap_or(sample);
        let parts = (sample / step).round().max(1.0);
        let is_part = (sample / step - parts).abs() <= STEP_RATIO_TOLERANCE * parts;
        let steps = (recording.manoeuvre.duration() / step - STEP_RATIO_TOLERANCE).ceil().max(1.0) as usize;
        let frame = recording.angular_velocity_frame;
        let (mut running, taken, given) = self.start(&recording.inputs()[0], recording)?;
        let mut columns: Vec<(String, Vec<f64>)> =
            given.iter().map(|output| (output.title.clone(), Vec::new())).collect();
        let mut read = |running: &mut Running| -> Result<()> {
            for (output, (_, values)) in given.iter().zip(&mut columns) {
                let value = match &output.variable {
                    Some((name, factor)) => running.get(name).about(|| name.clone())? * factor,
                    None => 0.0,
                };
                values.push(value + output.offset);
            }
            Ok(())
        };
        read(&mut running)?;
        let at = |k: usize| at_part(recording.inputs(), k as f64 * step / sample);
        let mut start = at(0);
        for k in 0..steps {
            let end = at(k + 1);
            for input in &taken {
                let value = |of: &Input| self.map.value(input.quantity, of, frame) * input.factor + input.offset;
                let [from, to] = [value(&start), value(&end)];
                running.set(&input.name, from).about(|| input.name.clone())?;
                if input.has_slope {
                    running.set_slope(&input.name, end_slope(from, to, step)).about(|| input.name.clone())?;
                }
            }
            let time = k as f64 * step;
            running
                .step(time, step)
                .about(|| format!("the step of {step} s at {time:.4} s; `step` of the map sets its length"))?;
            read(&mut running)?;
            start = end;
        }
        if !is_part {
            let times = (0..=steps).map(|k| recording.start + k as f64 * step).collect();
            columns.push(("time".to_owned(), times));
        }
        let name = self.file.display().to_string();
        let notes = stillness_sentence(&columns);
        let (motion, others) = FeltTable::of_columns(&name, &columns)?.motion(recording).map_err(Message::from)?;
        Ok((motion, notes.into_iter().chain(others).collect()))
    }

    /// The FMU at the first input, and its variables.
    fn start(&self, first: &Input, recording: &Recording) -> Result<(Running, Vec<Taken>, Vec<Given>)> {
        // The variables are known once it is open: it is started again with the first input.
        let start: Vec<(&str, f64)> = self.map.start.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let running = Running::start(&self.file, &start)?;
        let (taken, given) = (self.taken(&running)?, self.given(&running)?);
        let value = |input: &Taken| {
            let frame = recording.angular_velocity_frame;
            self.map.value(input.quantity, first, frame) * input.factor + input.offset
        };
        let values = start.into_iter().chain(taken.iter().map(|input| (input.name.as_str(), value(input))));
        let running = Running::start(&self.file, &values.collect::<Vec<_>>())?;
        Ok((running, taken, given))
    }

    fn taken(&self, running: &Running) -> Result<Vec<Taken>> {
        let taken = |(quantity, variable): (&Quantity, &MappedVariable)| -> Result<Taken> {
            let declaration = running.declaration(&variable.at);
            let (key, name) = (quantity.key(), &variable.at);
            if declaration.is_none_or(|declaration| declaration.causality != Causality::Input) {
                return Err(
                    text!["no-input-of-fmu", key, name, listed = listed_names(running, Causality::Input)].into()
                );
            }
            let in_si = si_factor(running, variable, Kind::Of(quantity.dimension()), Causality::Input);
            let in_si = in_si.about(|| format!("[inputs] {}", quantity.key()))?;
            let is_real = declaration.is_some_and(|declaration| declaration.element == "Real");
            Ok(Taken {
                quantity: *quantity,
                name: variable.at.clone(),
                factor: variable.scale / in_si,
                offset: variable.offset,
                has_slope: is_real && running.takes_slopes(),
            })
        };
        self.map.inputs.iter().map(taken).collect()
    }

    fn given(&self, running: &Running) -> Result<Vec<Given>> {
        let given = |(name, output): (&String, &MappedOutput)| -> Result<Given> {
            let (variable, offset) = match output {
                MappedOutput::Constant(value) => (None, *value),
                MappedOutput::Variable(variable) => {
                    let kind = self.map.kind(name).ok_or_else(|| Message::from("the map was checked"))?;
                    let in_si = si_factor(running, variable, kind, Causality::Output);
                    let in_si = in_si.about(|| format!("[outputs] {name}"))?;
                    (Some((variable.at.clone(), variable.scale * in_si)), variable.offset)
                }
            };
            Ok(Given { title: name.clone(), variable, offset })
        };
        self.map.outputs.iter().map(given).collect()
    }
}

/// The factor of a variable to SI: by the map's unit, else by the FMU's.
fn si_factor(running: &Running, variable: &MappedVariable, kind: Kind, causality: Causality) -> Result<f64> {
    let name = &variable.at;
    let Some(declaration) = running.declaration(name) else {
        bail!("the FMU has no variable {name} that is a number; {}", listed_names(running, causality));
    };
    ensure!(!running.is_array(name), "{name} is an array; the map needs its elements, such as \"{name}[1]\"");
    let declared = declaration.unit.as_deref().filter(|unit| *unit != "1");
    let of_fmu = declared.map(|unit| (unit, kind.factor(unit)));
    let of_map = match &variable.unit {
        Some(unit) => {
            let reason = || Message::from(format!("unit {unit}: write {}", kind.units()));
            Some(kind.factor(unit).ok_or_else(reason)?)
        }
        None => None,
    };
    match (of_map, of_fmu) {
        (Some(map), Some((unit, Some(fmu)))) if (map / fmu - 1.0).abs() > 1e-6 => {
            let of_map = variable.unit.as_deref().unwrap_or_default();
            bail!("{name} is in {unit} by the FMU, but in {of_map} by the map; correct or leave out `unit`")
        }
        (Some(factor), _) | (None, Some((_, Some(factor)))) => Ok(factor),
        (None, Some((unit, None))) => {
            bail!("{name} is in {unit} by the FMU; if it is the right variable, say its `unit`: {}", kind.units())
        }
        (None, None) => Ok(1.0),
    }
}

/// The FMU's variables of a role, as a message lists them.
fn listed_names(running: &Running, causality: Causality) -> String {
    // Names of variables that a message lists.
    const MAX_LISTED_NAMES: usize = 12;
    let names = running.names(causality);
    let role = if causality == Causality::Input { "inputs" } else { "outputs" };
    let more = if names.len() > MAX_LISTED_NAMES {
        format!(" and {} more", names.len() - MAX_LISTED_NAMES)
    } else {
        String::new()
    };
    format!("its {role} are {}{more}", names[..names.len().min(MAX_LISTED_NAMES)].join(", "))
}

/// The input at so many samples from the first, linear between samples.
fn at_part(inputs: &[Input], place: f64) -> Input {
    let last = inputs.len() - 1;
    let near = place.round();
    if (place - near).abs() <= STEP_RATIO_TOLERANCE {
        return inputs[(near as usize).min(last)];
    }
    let before = (place as usize).min(last);
    match inputs.get(before + 1) {
        Some(next) => inputs[before].towards(next, place - before as f64),
        None => inputs[last],
    }
}

/// The slope with which a step ends at the value, to the bit where one does.
fn end_slope(from: f64, to: f64, step: f64) -> f64 {
    let slope = (to - from) / step;
    let near = [slope, slope.next_up(), slope.next_down()];
    near.into_iter().find(|slope| from + step * slope == to).unwrap_or(slope)
}

/// A sentence on poses and legs that do not change.
fn stillness_sentence(columns: &[(String, Vec<f64>)]) -> Option<String> {
    // Motion that is none: what the outputs of poses and legs change by [m, rad].
    const STANDSTILL_TOLERANCE: f64 = 1e-9;
    let moves =
        |(_, values): &(String, Vec<f64>)| values.iter().any(|value| (value - values[0]).abs() > STANDSTILL_TOLERANCE);
    let is_still = !columns.iter().filter(|(title, _)| title != "time").any(moves);
    is_still.then(|| {
        "The FMU's outputs do not change. Check [inputs] of the map, and whether the FMU needs a start value that engages it."
            .to_owned()
    })
}
