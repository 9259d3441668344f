//! Recordings that are unusual but possible.

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use super::rates::usual_maximum;
use crate::recording::columns::UnitSource;
use crate::recording::conventions::Quantity;
use crate::recording::message::{given, named};
use crate::recording::table::Table;

/// Angular velocity that few heads exceed for a hundredth of a recording \[rad/s\].
const BRISK: f64 = 2.5;
/// Mean acceleration above which the sensor or the road is taken as tilted \[m/s2\].
const BIAS: f64 = 0.3;
/// Cue at the first sample above which the recording begins with a jolt \[m/s2\].
const JOLT: f64 = 1.0;

/// Warnings about a recording that is unusual but possible.
pub fn warnings(table: &Table, inputs: &[Input]) -> Vec<String> {
    [bias(inputs, 0, "x"), bias(inputs, 1, "y"), fast_rates(table, inputs), jolt(&inputs[0])]
        .into_iter()
        .flatten()
        .collect()
}

fn bias(inputs: &[Input], axis: usize, name: &str) -> Option<String> {
    let mean = inputs.iter().map(|input| input.specific_force[axis]).sum::<f64>() / inputs.len() as f64;
    let tilt = (mean / STANDARD_GRAVITY).clamp(-1.0, 1.0).asin().to_degrees();
    (mean.abs() > BIAS).then(|| {
        format!(
            "The specific force along {name} is {mean:.2} m/s2 on average: the sensor is tilted by {tilt:.1} degrees or \
             biased, or the recording ends faster than it begins, or uphill. The platform will lean as much."
        )
    })
}

fn fast_rates(table: &Table, inputs: &[Input]) -> Option<String> {
    let (unit, source) = table.unit(Quantity::Rate(0));
    let fast = usual_maximum(inputs);
    (source == UnitSource::Default && fast > BRISK).then(|| {
        let (unit, option, remedy) = (unit.word, named("rate-unit"), given("rate-unit", "deg/s"));
        format!(
            "Angular velocities reach {fast:.1} {unit}, and neither the header nor {option} gives a unit. If they are in \
             deg/s, use {remedy}."
        )
    })
}

fn jolt(first: &Input) -> Option<String> {
    let cue = first.specific_force - Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    let remedy = given("fade-in", 1);
    (cue.amax() > JOLT).then(|| {
        format!(
            "The recording does not begin at rest: the specific force jumps by ({:.1}, {:.1}, {:.1}) m/s2 at once; \
             {remedy} fades it in from rest.",
            cue.x, cue.y, cue.z
        )
    })
}
