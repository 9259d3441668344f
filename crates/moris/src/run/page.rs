//! The report's data.

use moris_measures::Row;
use moris_report::{Better, Chart, Cues, Finding, Limited, Limits, Line, Measure, Report, Run, Weight};
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;
use moris_washout::{Output, Parameters};

use super::{Outcome, Recording, findings};
use crate::ride::Ride;

/// The report of a ride with one or several sets of parameters, of which the first is shown first.
pub fn report(ride: &Ride, outcomes: &[Outcome]) -> Report {
    let first = &outcomes[0];
    let remarks = ride.remarks.iter().map(|remark| Finding { weight: Weight::Warning, text: remark.clone() });
    Report {
        title: ride.name.clone(),
        subtitle: format!(
            "{:.1} s on {}, parameters: {}",
            ride.manoeuvre.duration(),
            first.setup.rig_name,
            outcomes.iter().map(|outcome| outcome.setup.parameters_name.as_str()).collect::<Vec<_>>().join(", ")
        ),
        findings: findings::of(first).into_iter().chain(remarks).collect(),
        provenance: vec![
            ("Recording".to_owned(), format!("{}, {:.0} samples a second", ride.name, 1.0 / ride.step())),
            ("Gravity".to_owned(), gravity(ride).to_owned()),
            ("Made by".to_owned(), format!("moris {}", env!("CARGO_PKG_VERSION"))),
        ],
        rig: (&first.setup.parameters).into(),
        runs: outcomes.iter().map(run).collect(),
        selected: 0,
    }
}

/// Method of removing gravity.
fn gravity(ride: &Ride) -> &'static str {
    if ride.has_orientation {
        "removed as gravityRemoval says, by the recorded orientation"
    } else {
        "no orientation recorded: what is cued is what differs from (0, 0, g), the force felt at rest"
    }
}

fn run(outcome: &Outcome) -> Run {
    let Outcome { setup, recording, measures, .. } = outcome;
    let outputs = |value: fn(&Output) -> f64| recording.outputs.iter().map(value).collect::<Vec<f64>>();
    let flags = |value: fn(&Output) -> bool| recording.outputs.iter().map(value).collect::<Vec<bool>>();
    let leans = recording.inputs.iter().any(|input| input.lean != 0.0);
    Run {
        name: setup.parameters_name.clone(),
        times: recording.times(),
        desired: Cues {
            specific_force: by_axis(recording.inputs.iter().map(|input| input.specific_force)),
            angular_velocity: by_axis(recording.desired_rates().into_iter()),
        },
        felt: Cues {
            specific_force: by_axis(recording.outputs.iter().map(|output| output.felt_specific_force)),
            angular_velocity: by_axis(recording.outputs.iter().map(|output| output.felt_angular_velocity)),
        },
        position: by_axis(recording.outputs.iter().map(|output| output.position)),
        orientation: by_axis(recording.outputs.iter().map(|output| output.orientation.to_vector())),
        legs: std::array::from_fn(|leg| recording.outputs.iter().map(|output| output.length[leg]).collect()),
        tilt: [outputs(|output| output.tilt_roll), outputs(|output| output.tilt_pitch)],
        tilt_rate: [outputs(|output| output.tilt_roll_rate), outputs(|output| output.tilt_pitch_rate)],
        lean: if leans { recording.inputs.iter().map(|input| input.lean).collect() } else { Vec::new() },
        limited: Limited {
            tilt: flags(|output| output.tilt_limited),
            safety: flags(|output| output.safety_active),
            actuator: flags(|output| output.actuator_limited),
        },
        limits: limits(recording),
        measures: measures.rows().into_iter().chain(bound_rows(outcome)).map(measure).collect(),
        charts: bound_charts(outcome),
    }
}

/// The bounds' rows, beside what was felt.
fn bound_rows(outcome: &Outcome) -> Vec<Row> {
    let on_axis = |axis: usize| {
        let bound = outcome.bounds[axis].as_ref()?;
        let felt = outcome.measures.force[axis]?.rms_error;
        Some(moris_measures::bound_rows(["x", "y", "z"][axis], bound.desired_rms(), felt, &bound.bound))
    };
    (0..3).filter_map(on_axis).flatten().collect()
}

/// The bound, axis by axis.
fn bound_charts(outcome: &Outcome) -> Vec<Chart> {
    let times = outcome.recording.times();
    let chart = |axis: usize| {
        let bound = outcome.bounds[axis].as_ref()?;
        let felt = outcome.recording.outputs.iter().map(|output| output.felt_specific_force[axis]);
        let rest = [0.0, 0.0, STANDARD_GRAVITY][axis];
        let line = |label: &str, values: Vec<f64>| Line { label: label.to_owned(), values };
        Some(Chart {
            title: format!("{}: the best possible", ["Surge", "Sway", "Heave"][axis]),
            quantity: "specific force without gravity [m/s²]".to_owned(),
            times: Vec::new(),
            lines: vec![
                line("desired", bound.desired.clone()),
                line("felt", felt.map(|force| force - rest).collect()),
                line("best possible", times.iter().map(|&time| bound.bound.trajectory.felt(time)).collect()),
            ],
            limits: Vec::new(),
        })
    };
    (0..3).filter_map(chart).collect()
}

fn by_axis(vectors: impl Iterator<Item = Vector3<f64>>) -> [Vec<f64>; 3] {
    let vectors: Vec<Vector3<f64>> = vectors.collect();
    std::array::from_fn(|axis| vectors.iter().map(|vector| vector[axis]).collect())
}

fn limits(recording: &Recording) -> Limits {
    let Parameters { tilt, safety, rig, .. } = &recording.parameters;
    Limits {
        tilt_angle: tilt.angle_limit,
        tilt_rate: tilt.rate_limit,
        tilt_acceleration: tilt.acceleration_limit,
        safety_position: safety.position_limit.into(),
        safety_velocity: safety.velocity_limit.into(),
        safety_acceleration: safety.acceleration_limit.into(),
        actuator_velocity: rig.velocity_limit,
        actuator_acceleration: rig.acceleration_limit,
    }
}

fn measure(row: Row) -> Measure {
    Measure {
        group: capitalised(&row.subject),
        name: row.name.to_owned(),
        value: row.value.into(),
        unit: row.unit.to_owned(),
        better: better(row.name),
        definition: row.definition.to_owned(),
        source: row.source.to_owned(),
    }
}

/// Which of two values of a measure of this name is the better.
fn better(name: &str) -> Better {
    match name {
        "correlation" | "smallest stroke margin" => Better::More,
        "stroke used" | "sensed in the vehicle" | "largest tilt rate" | "bound" | "bound, of what is desired" => {
            Better::Neither
        }
        _ => Better::Less,
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
