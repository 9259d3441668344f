//! The sensor's mounting in the vehicle, found from the recording.
//!
//! - `blocks` averages short blocks of the recording, and finds rest among them.
//! - `level` finds horizontal directions, and `forward` decides between them.

mod blocks;
mod forward;
mod level;

use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::{Matrix3, Rotation3, Vector3};

use crate::message::{Message, Remedy, given};
use crate::texts::text;
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

    let blocks = Blocks::new(step, forces, rates, speeds);
    let rest = blocks.rest_force();
    let gravity = rest.unwrap_or_else(|| mean(forces));
    if (gravity.norm() / STANDARD_GRAVITY - 1.0).abs() > 0.2 {
        return Err(text!["mounting-finds-no-gravity", size = gravity.norm()]);
    }
    let up = gravity.normalize();
    let Forward { direction, error, evidence, may_be_backward } = forward::find(&blocks, &up)?;
    let rotation = mounting_rotation(&up, &direction);
    let (option, degrees) = (option(&rotation), error.to_degrees());
    if error > LARGEST_ERROR {
        return Err(text!["forward-uncertain", evidence, degrees, option]);
    }
    let level = if rest.is_some() { "gravity" } else { "the mean force, as there is no second of rest" };
    let mut warning = text!["mounting-found", level, degrees, evidence, option];
    if may_be_backward {
        let turned = self::option(&mounting_rotation(&up, &-direction));
        warning.push(text!["forward-may-be-backward", turned]);
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
