//! Data with which the report's page can simulate the recording with other parameters.

use moris_interface::{Group as _, Kind, Row, slots_of};
use moris_pages::report::{MODULE, Parameter, ParameterKind, Simulator};
use moris_washout::Parameters;
use moris_washout::interface::{Rig, StrategyKind};

use crate::outcome::Outcome;
use crate::recording::Recording;
use crate::tune::space::{Group, ranges};

/// True if pages can simulate.
pub fn is_compiled() -> bool {
    !MODULE.is_empty()
}

/// The simulator of a recording from the parameters of an outcome; none if it was not compiled.
/// `command` is what stands before the name of a parameter file.
pub fn of(recording: &Recording, outcome: &Outcome, command: Option<String>) -> Option<Simulator> {
    if !is_compiled() {
        return None;
    }
    let samples: Vec<_> = recording.inputs().iter().map(slots_of).collect();
    let slots = samples[0].len();
    let name = &recording.name;
    Some(Simulator {
        module: MODULE.to_vec(),
        step: recording.step(),
        samples: samples.len(),
        inputs: (0..slots).map(|slot| samples.iter().map(|sample| sample[slot]).collect()).collect(),
        bounds: outcome.evaluated().bounds,
        parameters: parameters(&outcome.simulation.parameters, &recording.parameters(&outcome.setup.rig_alone)),
        heading: format!(
            "Chosen in the report of {name} on {}, from {}",
            outcome.setup.rig_name, outcome.setup.parameters_name
        ),
        command: command.unwrap_or_else(|| format!("cargo moris simulate {name}.csv --parameters")),
        file: format!("{name}.toml"),
        rig_name: outcome.setup.rig_name.clone(),
        actuator_diameter: outcome.setup.actuator_diameter,
    })
}

/// The parameters for a page, slot by slot: with their start values, and those of the rig
/// with default parameters.
pub fn parameters(from: &Parameters, base: &Parameters) -> Vec<Parameter> {
    let (start, base) = (slots_of(from), slots_of(base));
    let mut parameters: Vec<Parameter> = Vec::with_capacity(start.len());
    for row in Parameters::ROWS {
        for element in 0..row.slots() {
            let slot = parameters.len();
            parameters.push(parameter(row, element, start[slot], base[slot]));
        }
    }
    for (group, heading) in HEADINGS {
        for (slot, range) in ranges_of(from, group) {
            let parameter = &mut parameters[slot];
            parameter.slider = [range[0].min(parameter.start), range[1].max(parameter.start)];
            parameter.group = is_prominent(&parameter.name).then(|| heading.to_owned());
        }
    }
    for parameter in &mut parameters {
        if parameter.name == "strategy" {
            parameter.group = Some("Strategy".to_owned());
        } else if let Some(range) = of_rig(&parameter.name, parameter.start, from) {
            parameter.slider = [range[0].max(parameter.accepted[0]), range[1].min(parameter.accepted[1])];
            parameter.group = Some("Rig".to_owned());
        }
    }
    parameters
}

/// The slider's range of a value of the rig; none for joints and for what is not the rig's.
fn of_rig(name: &str, start: f64, from: &Parameters) -> Option<[f64; 2]> {
    let half_stroke = 0.5 * (from.rig.max_length - from.rig.min_length);
    match name {
        "actuator.minLength" | "actuator.maxLength" | "rig.neutralHeight" => {
            Some([start - half_stroke, start + half_stroke])
        }
        "actuator.velocityLimit" | "actuator.accelerationLimit" => Some([0.2 * start, 2.0 * start]),
        _ if name.starts_with("safety.") => Some([0.2 * start, 2.0 * start]),
        _ => None,
    }
}

/// Headings of the parameters that matter most.
const HEADINGS: [(Group, &str); 6] = [
    (Group::Strategy, "The strategy's weights"),
    (Group::Scale, "Scales"),
    (Group::Splitter, "Break frequencies"),
    (Group::Angular, "Break frequencies"),
    (Group::Tilt, "Tilt limits"),
    (Group::Cutoff, ""),
];

/// True for all parameters that may be tuned but dampings and the low-passes of the input.
fn is_prominent(name: &str) -> bool {
    !name.contains(".zeta") && !name.starts_with("input.") || name.starts_with("adaptive.")
}

/// Slots and ranges of a group, with any strategy: the page changes it.
fn ranges_of(parameters: &Parameters, group: Group) -> Vec<(usize, [f64; 2])> {
    let with = |strategy: &StrategyKind| {
        let mut parameters = *parameters;
        parameters.structure.strategy = *strategy;
        ranges(&parameters, &[group])
    };
    StrategyKind::ALL.iter().flat_map(with).collect()
}

fn parameter(row: &Row, element: usize, start: f64, base: f64) -> Parameter {
    let (kind, unit, items) = match row.kind {
        Kind::Real(unit) => (ParameterKind::Real, unit.name, Vec::new()),
        Kind::Integer => (ParameterKind::Integer, "", Vec::new()),
        Kind::Boolean => (ParameterKind::Boolean, "", Vec::new()),
        Kind::Enumeration(enumeration) => {
            (ParameterKind::Enumeration, "", enumeration.items.iter().map(|item| item.name.to_owned()).collect())
        }
    };
    let (least, greatest) = row.bounds();
    let name = row.variable_name(element);
    Parameter {
        text: row.text().to_owned(),
        unit: unit.to_owned(),
        kind,
        items,
        accepted: [least, greatest],
        slider: usual(start, [least, greatest]),
        group: None,
        is_free: !Rig::ROWS.iter().any(|of_rig| of_rig.name == row.name) && name != "angularVelocityFrame",
        start,
        base,
        name,
    }
}

/// A slider's range for a parameter without a usual one: a decade to either side of its value.
fn usual(start: f64, [least, greatest]: [f64; 2]) -> [f64; 2] {
    let size = 10.0 * start.abs();
    let [low, high] = match start {
        0.0 => [-1.0, 10.0],
        _ if least > 0.0 => [0.1 * start, size],
        _ => [-size, size],
    };
    [low.max(least), high.min(greatest)]
}
