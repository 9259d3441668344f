//! The run of a report, out of a simulation and its measures.

use std::array;

use moris_simulation::advice::Advice;
use moris_simulation::measures::Row;
use moris_simulation::{Evaluated, Simulation, capitalised};
use moris_washout::Output;

use super::data::{Chart, Cues, LimitHistory, Line, Run};
use super::thinning::Thinning;

/// The run of a report, without further charts.
pub fn run(evaluated: &Evaluated, name: &str, thinning: &Thinning) -> Run {
    let Simulation { inputs, outputs, step, parameters, .. } = evaluated.simulation;
    let curve = |value: fn(&Output) -> f64| thinning.extremes(|k| value(&outputs[k]));
    let desired_rates = evaluated.simulation.desired_rates();
    let tilt_limits = evaluated.simulation.tilt_limits();
    let leans = inputs.iter().any(|input| input.lean != 0.0);
    Run {
        name: name.to_owned(),
        verdict: evaluated.verdict(),
        findings: evaluated.findings(),
        fitting_scale: evaluated.advice.and_then(Advice::scale),
        times: thinning.at_times(|k| k as f64 * step),
        desired: Cues {
            specific_force: array::from_fn(|axis| thinning.extremes(|k| inputs[k].specific_force[axis])),
            angular_velocity: array::from_fn(|axis| thinning.extremes(|k| desired_rates[k][axis])),
        },
        felt: Cues {
            specific_force: array::from_fn(|axis| thinning.extremes(|k| outputs[k].felt_specific_force[axis])),
            angular_velocity: array::from_fn(|axis| thinning.extremes(|k| outputs[k].felt_angular_velocity[axis])),
        },
        // A pose is that of one time.
        position: array::from_fn(|axis| thinning.at_times(|k| outputs[k].position[axis])),
        orientation: array::from_fn(|axis| thinning.at_times(|k| outputs[k].orientation.to_vector()[axis])),
        legs: array::from_fn(|leg| thinning.extremes(|k| outputs[k].actuators(&parameters.rig)[0][leg])),
        tilt: [curve(|output| output.tilt_roll), curve(|output| output.tilt_pitch)],
        tilt_rate: [curve(|output| output.tilt_roll_rate), curve(|output| output.tilt_pitch_rate)],
        lean: if leans { thinning.at_times(|k| inputs[k].lean) } else { Vec::new() },
        limited: LimitHistory {
            tilt: thinning.any(|k| tilt_limits.iter().flatten().any(|flags| flags[k])),
            tilt_by: tilt_limits.each_ref().map(|axis| axis.each_ref().map(|flags| thinning.any(|k| flags[k]))),
            soft: thinning.any(|k| outputs[k].soft_limited),
            safety: thinning.any(|k| outputs[k].safety_active),
            actuator: thinning.any(|k| outputs[k].actuator_limited),
        },
        limits: parameters.into(),
        measures: evaluated.rows().into_iter().map(|row| Row { subject: capitalised(&row.subject), ..row }).collect(),
        charts: Vec::new(),
    }
}

/// The felt force on an axis without gravity, for the chart of the least possible error.
pub fn felt_chart(simulation: &Simulation, axis: usize, thinning: &Thinning) -> Chart {
    Chart {
        title: format!("{}: the best possible", ["Surge", "Sway", "Heave"][axis]),
        quantity: "specific force without gravity [m/s²]".to_owned(),
        times: Vec::new(),
        lines: vec![Line {
            label: "felt".to_owned(),
            values: thinning.extremes(|k| simulation.felt_without_gravity(k)[axis]),
        }],
        limits: Vec::new(),
    }
}
