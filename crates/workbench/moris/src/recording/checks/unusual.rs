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
    let mut warnings = Vec::new();
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let mean = inputs.iter().map(|input| input.specific_force[axis]).sum::<f64>() / inputs.len() as f64;
        if mean.abs() > BIAS {
            warnings.push(format!(
                "The specific force along {name} is {mean:.2} m/s2 on average: the sensor is tilted by {:.1} degrees or \
                 biased, or the recording ends faster than it begins, or uphill. The platform will lean as much.",
                (mean / STANDARD_GRAVITY).clamp(-1.0, 1.0).asin().to_degrees()
            ));
        }
    }
    let (rate_unit, source) = table.unit(Quantity::Rate(0));
    let fast = usual_maximum(inputs);
    if source == UnitSource::Default && fast > BRISK {
        warnings.push(format!(
            "Angular velocities reach {fast:.1} {}, and neither the header nor {} gives a unit. If they are in deg/s, \
             use {}.",
            rate_unit.word,
            named("rate-unit"),
            given("rate-unit", "deg/s")
        ));
    }
    let first = inputs[0].specific_force - Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    if first.amax() > JOLT {
        warnings.push(format!(
            "The recording does not begin at rest: the specific force jumps by ({:.1}, {:.1}, {:.1}) m/s2 at once; \
             {} fades it in from rest.",
            first.x,
            first.y,
            first.z,
            given("fade-in", 1)
        ));
    }
    warnings
}
