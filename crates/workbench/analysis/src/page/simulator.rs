//! Data with which the report's page can simulate the recording with other parameters.

use moris_interface::{Group as _, Kind, Row, slots_of};
use moris_pages::report::{Parameter, ParameterKind, SIMULATION_MODULE, Simulator};
use moris_washout::Parameters;
use moris_washout::interface::Rig;

use crate::outcome::Outcome;
use crate::recording::Recording;
use crate::texts::text;

/// True if pages can simulate.
pub fn is_compiled() -> bool {
    !SIMULATION_MODULE.is_empty()
}

/// The simulator of a recording from the parameters of an outcome; none if it was not compiled.
/// `command` is what stands before the name of a parameter file.
pub fn of(recording: &Recording, outcome: &Outcome, command: &str) -> Option<Simulator> {
    // More samples do not fit into a page.
    const MOST_SAMPLES: usize = 250_000;
    if !is_compiled() {
        return None;
    }
    let samples: Vec<_> = recording.inputs().iter().take(MOST_SAMPLES).map(slots_of).collect();
    let slots = samples[0].len();
    let (name, rig_name) = (&recording.name, outcome.setup.rig_name.clone());
    Some(Simulator {
        module: SIMULATION_MODULE.to_vec(),
        step: recording.step(),
        samples: recording.inputs().len(),
        inputs: (0..slots).map(|slot| samples.iter().map(|sample| sample[slot]).collect()).collect(),
        bounds: outcome.evaluated().bounds,
        parameters: parameters(&outcome.simulation.parameters, &recording.parameters(&outcome.setup.rig_alone)),
        heading: text!["heading-of-page", name, rig = &rig_name, parameters = &outcome.setup.parameters_name]
            .to_string(),
        command: command.to_owned(),
        file: format!("{name}.toml"),
        rig_name,
        actuator_diameter: outcome.setup.actuator_diameter,
    })
}

/// The parameters for a page, slot by slot: with their start values, and those of the rig
/// with default parameters.
pub fn parameters(from: &Parameters, base: &Parameters) -> Vec<Parameter> {
    let half_stroke = 0.5 * (from.rig.max_length - from.rig.min_length);
    let values = slots_of(from).into_iter().zip(slots_of(base));
    values
        .zip(Parameters::SLOTS)
        .map(|((start, base), slot)| {
            let (row, element) = (&Parameters::ROWS[usize::from(slot.row)], usize::from(slot.element));
            page_parameter(row, element, [start, base], half_stroke)
        })
        .collect()
}

/// The slider's range. Without a usual one it is a decade to either side. Values of the rig go from
/// a fifth to twice their start, and lengths of its legs by half a stroke.
fn slider_range(row: &Row, start: f64, half_stroke: f64) -> [f64; 2] {
    if let Some((least, greatest)) = row.usual {
        return [least.min(start), greatest.max(start)];
    }
    let (least, greatest) = row.bounds();
    let size = 10.0 * start.abs();
    let is_length = matches!(row.kind, Kind::Real(unit) if unit.name == "m") && is_of_rig(row);
    let [low, high] = match (row.heading, start) {
        (Some("Rig"), _) if is_length => [start - half_stroke, start + half_stroke],
        (Some("Rig"), _) => [0.2 * start, 2.0 * start],
        (_, 0.0) => [-1.0, 10.0],
        _ if least > 0.0 => [0.1 * start, size],
        _ => [-size, size],
    };
    [low.max(least), high.min(greatest)]
}

fn is_of_rig(row: &Row) -> bool {
    Rig::ROWS.iter().any(|of_rig| of_rig.name == row.name)
}

fn page_parameter(row: &Row, element: usize, [start, base]: [f64; 2], half_stroke: f64) -> Parameter {
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
        slider: slider_range(row, start, half_stroke),
        group: row.heading.map(str::to_owned),
        used_if: row.conditions(element).map(|needed| (needed.variable.to_owned(), needed.values.to_vec())).collect(),
        is_free: !is_of_rig(row) && name != "angularVelocityFrame",
        start,
        base,
        name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_has_the_slider_the_heading_and_the_conditions_of_its_row() {
        let parameters = parameters(&Parameters::default(), &Parameters::default());
        let of = |name: &str| parameters.iter().find(|parameter| parameter.name == name).unwrap();
        let conditions = |name| {
            let used_if = &of(name).used_if;
            used_if.iter().map(|(other, values)| format!("{other} {}", values.join(" "))).collect::<Vec<_>>()
        };
        assert_eq!((of("splitter.z.zeta1").slider, &of("splitter.z.zeta1").group), ([0.3, 2.0], &None));
        assert_eq!(of("optimal.splitTime").group.as_deref(), Some("The strategy's weights"));
        assert_eq!((of("actuator.minLength").slider, of("safety.x.velocityLimit").slider), ([0.7, 1.3], [0.2, 2.0]));
        assert_eq!(of("automaticScale.fallTime").slider, [0.1, 6.0]);
        assert_eq!(conditions("splitter.x.omega2"), ["strategy classical", "splitter.order 3 4"]);
        assert_eq!(conditions("splitter.z.omega2"), ["splitter.order 3 4"]);
        assert_eq!(conditions("predictive.memory"), ["strategy predictive", "predictive.forecast learned"]);
    }
}
