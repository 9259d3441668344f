//! Wrong units and axes of the specific force, by gravity.

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use super::{Channels, remedy};
use crate::message::{Message, given, message, named};
use crate::recording::conventions::{Axes, Conventions, Gravity, Quantity, Unit};
use crate::recording::signal::median;

/// Largest distance of the median specific force from standard gravity \[m/s2\]: sensors
/// are biased and tilted.
const GRAVITY_TOLERANCE: f64 = 3.0;
/// Size of gravity from which it may be in counts \[1\].
const COUNTS: f64 = 60.0;
/// Medians below this contain no gravity \[m/s2\].
const NO_GRAVITY: f64 = 3.0;

/// Compares the medians of the accelerations, which manoeuvres hardly change, with gravity.
pub fn check(channels: &Channels) -> Result<(), Message> {
    let Channels { table, inputs, conventions, .. } = channels;
    let median = Vector3::from_fn(|axis, _| median(channels.force(axis)));
    let gravity = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    let is_near = (median - gravity).norm() < GRAVITY_TOLERANCE;
    if is_near || is_driven_hard(&median, inputs) || is_steady_bend(&median, inputs) {
        return Ok(());
    }
    // As the file has it: without the gravity that conversion has added, in the file's unit.
    let added = if conventions.gravity == Gravity::Removed { gravity } else { Vector3::zeros() };
    let (unit, _) = table.unit(Quantity::Force(2));
    let raw = (median - added) / unit.in_si;
    let is_mounted = conventions.mounting.is_some();
    let signs = if is_mounted { [1.0; 3] } else { conventions.axes.signs() };
    let size = raw.norm();
    let is_gravity_in = |other: &Unit| (0.75..1.25).contains(&(size * other.in_si / STANDARD_GRAVITY));
    let mut other_units = Quantity::Force(2).dimension().units().filter(|other| *other != unit);
    let meaning = match other_units.find(is_gravity_in) {
        Some(other) => {
            let remedy = remedy(table, Quantity::Force(2), other.word);
            message![format!("which is gravity in {}, not in {}: ", other.word, unit.word), remedy]
        }
        None if size > COUNTS => counts(size, conventions),
        None => meaning(&median, channels),
    };
    let (x, y, z, unit) = (raw.x, raw.y * signs[1], raw.z * signs[2], unit.word);
    let turned = if is_mounted { message![", turned by ", named("mounting"), ","] } else { Message::default() };
    Err(message!["most of the time the accelerations", turned, " are about ({x:.2}, {y:.2}, {z:.2}) {unit}, ", meaning])
}

/// True if driving explains a horizontal median, as on a circuit with more bends one way. Then the
/// force varies by more than the median. And its z is nearer to gravity than under a tilt with this
/// horizontal part.
fn is_driven_hard(median: &Vector3<f64>, inputs: &[Input]) -> bool {
    let horizontal = median.xy().norm();
    let tilted = (STANDARD_GRAVITY.powi(2) - horizontal.powi(2)).max(0.0).sqrt();
    let distance = |z: f64| (median.z - z).abs();
    let is_level = distance(STANDARD_GRAVITY) < GRAVITY_TOLERANCE && distance(STANDARD_GRAVITY) < distance(tilted);
    is_level && self::median(inputs.iter().map(|input| (input.specific_force - median).xy().norm())) > horizontal
}

/// True if the speed and the yaw rate explain a lateral median, as on a steady circle.
fn is_steady_bend(median: &Vector3<f64>, inputs: &[Input]) -> bool {
    let turning = self::median(inputs.iter().map(|input| input.speed * input.angular_velocity.z));
    (median - Vector3::new(0.0, turning, STANDARD_GRAVITY)).norm() < GRAVITY_TOLERANCE
}

/// Gravity in counts of a sensor, and its scale.
fn counts(size: f64, conventions: &Conventions) -> Message {
    let columns = conventions.scaled(&[0, 1, 2].map(Quantity::Force), &format!("/ {size:.0}"));
    let unit = given("force-unit", "g");
    message![
        "which is gravity in no unit: if they are counts of the sensor, its scale factor is about {size:.0} a g, and the \
         exact one is in its data sheet: use ",
        columns,
        " with ",
        unit,
        ", and the scale of the rates likewise"
    ]
}

/// The meaning of a median in the right unit that is not gravity along z.
fn meaning(median: &Vector3<f64>, channels: &Channels) -> Message {
    let conventions = channels.conventions;
    if conventions.gravity == Gravity::Removed {
        let (removed, included) = (given("gravity", "removed"), given("gravity", "included"));
        message!["which includes gravity although ", removed, " was given: use ", included]
    } else if (median + Vector3::new(0.0, 0.0, STANDARD_GRAVITY)).norm() < GRAVITY_TOLERANCE {
        let opposite = || {
            let forces = [0, 1, 2].map(Quantity::Force);
            let turned = forces.map(|force| format!("{}={}", force.key(), conventions.turned_column(force)));
            given("columns", format!("\"{}\"", turned.join(",")))
        };
        match conventions.axes {
            // Axes that point down keep the sign of bends.
            _ if channels.speed_of_bends().is_some_and(|speed| speed < 0.0) => {
                message!["so all forces have the opposite sign, as the bends' have: use ", opposite()]
            }
            Axes::ForwardLeftUp => message!["so z points down: use ", given("axes", "forward-right-down")],
            Axes::ForwardRightDown => message!["so z points up: use ", given("axes", "forward-left-up")],
        }
    } else if median.norm() < NO_GRAVITY {
        message!["so gravity has been taken out: use ", given("gravity", "removed")]
    } else if (median.norm() - STANDARD_GRAVITY).abs() < GRAVITY_TOLERANCE {
        let axis = ["x", "y", "z"][median.iamax()];
        message![
            "so {axis} is nearest to the vertical; name the column of each axis with ",
            named("columns"),
            ", or use ",
            given("mounting", "auto")
        ]
    } else {
        "which is gravity in no unit known here: convert the file to m/s2 or g".into()
    }
}
