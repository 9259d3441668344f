//! The sensor's mounting in the vehicle, found from the recording.
//!
//! - `blocks` averages short blocks of the recording, and finds rest among them.
//! - `level` finds horizontal directions, and `forward` decides between them.

mod blocks;
mod forward;
mod level;

use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::{Matrix3, Rotation3, Vector3};

use crate::message::{Message, Remedy, given, message, named};
use crate::recording::conventions::Mounting;
use blocks::{Blocks, mean};
use forward::Forward;

/// The rotation from the sensor's axes to the vehicle's, and a warning with its angles and their
/// evidence. Specific force with gravity \[m/s2\] and angular velocity \[rad/s\] are in the
/// sensor's axes; the vehicle's speed \[m/s\] is empty where it is not known.
///
/// Up is the direction of the specific force at rest, and the module `forward` finds forward.
///
/// # Errors
/// The recording contains no gravity, or forward is unknown, uncertain or contradictory. The
/// message names the option that gives the mounting.
pub fn find(
    step: f64,
    forces: &[Vector3<f64>],
    rates: &[Vector3<f64>],
    speeds: &[f64],
) -> Result<(Matrix3<f64>, Message), Message> {
    // Largest standard error of the forward direction [rad].
    const LARGEST_ERROR: f64 = 15f64.to_radians();
    let [auto, angles] = Mounting::options();
    let blocks = Blocks::new(step, forces, rates, speeds);
    let rest = blocks.rest_force();
    let gravity = rest.unwrap_or_else(|| mean(forces));
    if (gravity.norm() / STANDARD_GRAVITY - 1.0).abs() > 0.2 {
        let (size, unit) = (gravity.norm(), named("force-unit"));
        return Err(message![
            auto,
            " finds no gravity: at rest the specific force is {size:.2} m/s2; check ",
            unit,
            ", or give ",
            angles
        ]);
    }
    let up = gravity.normalize();
    let Forward { direction, error, evidence, may_be_backward } = forward::find(&blocks, &up)?;
    let rotation = mounting_rotation(&up, &direction);
    let (option, degrees) = (option(&rotation), error.to_degrees());
    if error > LARGEST_ERROR {
        return Err(message![
            auto,
            " finds forward from {evidence}, but only to {degrees:.0} degrees; give ",
            angles,
            " in degrees, or take ",
            option
        ]);
    }
    let level = if rest.is_some() { "gravity" } else { "the mean force, as there is no second of rest" };
    let mut warning = message![
        "The sensor's mounting was found, up from {level}, and forward to {degrees:.0} degrees from {evidence}: ",
        option,
        " gives the same."
    ];
    if may_be_backward {
        let turned = self::option(&mounting_rotation(&up, &-direction));
        warning.push(message![" If that acceleration is a braking, forward is backward: use ", turned, "."]);
    }
    Ok((rotation, warning))
}

/// Rotation from the sensor's axes to the vehicle's, of the upward and the forward direction.
fn mounting_rotation(up: &Vector3<f64>, forward: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_rows(&[forward.transpose(), up.cross(forward).transpose(), up.transpose()])
}

/// The option that gives a rotation.
fn option(rotation: &Matrix3<f64>) -> Remedy {
    let (roll, pitch, yaw) = Rotation3::from_matrix_unchecked(*rotation).euler_angles();
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(f64::to_degrees);
    given("mounting", format!("{roll:.1},{pitch:.1},{yaw:.1}"))
}
