//! Recordings that are unusual but possible.

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use super::rates::usual_maximum;
use crate::message::{Message, given, message, named};
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{Conventions, Gravity, Quantity};
use crate::recording::table::Table;

/// Angular velocity that few heads exceed for a hundredth of a recording \[rad/s\].
const BRISK: f64 = 2.5;
/// Mean acceleration above which the sensor or the road is taken as tilted \[m/s2\].
const BIAS: f64 = 0.3;
/// Largest force along x and y below which accelerations of vehicles may be in g \[m/s2\].
const WEAK_FORCE: f64 = 1.5;
/// Cue at the first sample above which the recording begins with a jolt \[m/s2\].
const JOLT: f64 = 1.0;

/// Warnings about a recording that is unusual but possible.
pub fn warnings(table: &Table, inputs: &[Input], conventions: &Conventions) -> Vec<Message> {
    let found = [
        bias(table, inputs, 0),
        bias(table, inputs, 1),
        weak_force(table, inputs, conventions),
        fast_rates(table, inputs),
        jolt(&inputs[0]),
    ];
    found.into_iter().flatten().collect()
}

/// Accelerations that may be in g: without gravity and speed nothing tells their unit.
fn weak_force(table: &Table, inputs: &[Input], conventions: &Conventions) -> Option<Message> {
    let (unit, source) = table.unit(Quantity::Force(0));
    let is_unknown = source == UnitSource::Default && !table.columns.contains_key(&Quantity::Speed);
    let force = inputs.iter().map(|input| input.specific_force.xy().norm()).fold(0.0, f64::max);
    (conventions.gravity == Gravity::Removed && is_unknown && force < WEAK_FORCE).then(|| {
        let (unit, remedy) = (unit.word, given("force-unit", "g"));
        message![
            "Without gravity and speed nothing tells the unit of the accelerations, whose largest along x and y is \
             {force:.2} {unit}: if they are in g, use ",
            remedy,
            "."
        ]
    })
}

/// A lasting force along x or y, and what may be its cause.
fn bias(table: &Table, inputs: &[Input], axis: usize) -> Option<Message> {
    let mean_of = |value: &dyn Fn(&Input) -> f64| inputs.iter().map(value).sum::<f64>() / inputs.len() as f64;
    let mean = mean_of(&|input| input.specific_force[axis]);
    let has_speed = table.columns.contains_key(&Quantity::Speed);
    let gain = inputs[inputs.len() - 1].speed - inputs[0].speed;
    let (name, motion, explained) = if axis == 0 {
        ("x", "the recording ends faster than it begins", gain / (inputs.len() as f64 * table.step()))
    } else {
        ("y", "the bends are mostly to one side", mean_of(&|input| input.speed * input.angular_velocity.z))
    };
    let cause = if has_speed && (mean - explained).abs() < BIAS {
        format!("{motion}, as the speed shows")
    } else if axis == 0 {
        format!("the sensor is tilted by {{tilt}} degrees or biased, or {motion}, or uphill")
    } else {
        format!("the sensor or the road is tilted by {{tilt}} degrees, or the sensor biased, or {motion}")
    };
    let tilt = (mean / STANDARD_GRAVITY).clamp(-1.0, 1.0).asin().to_degrees();
    let cause = cause.replace("{tilt}", &format!("{tilt:.1}"));
    (mean.abs() > BIAS).then(|| {
        format!(
            "The specific force along {name} is {mean:.2} m/s2 on average: {cause}. The platform will lean as much."
        )
        .into()
    })
}

fn fast_rates(table: &Table, inputs: &[Input]) -> Option<Message> {
    let (unit, source) = table.unit(Quantity::Rate(0));
    let fast = usual_maximum(inputs);
    (source == UnitSource::Default && fast > BRISK).then(|| {
        let (unit, option, remedy) = (unit.word, named("rate-unit"), given("rate-unit", "deg/s"));
        message![
            "Angular velocities reach {fast:.1} {unit}, and neither the header nor ",
            option,
            " gives a unit. If they are in deg/s, use ",
            remedy,
            "."
        ]
    })
}

fn jolt(first: &Input) -> Option<Message> {
    let cue = first.specific_force - Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    let remedy = given("fade-in", 1);
    (cue.amax() > JOLT).then(|| {
        message![
            format!(
                "The recording does not begin at rest: the specific force jumps by ({:.1}, {:.1}, {:.1}) m/s2 at once; ",
                cue.x, cue.y, cue.z
            ),
            remedy,
            " fades it in from rest."
        ]
    })
}
