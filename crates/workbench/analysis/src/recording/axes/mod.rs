//! From the recording's axes to the washout's inputs, turned by the sensor's `mounting`.

mod mounting;

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::{Matrix3, Rotation3, Vector3};

use crate::message::Message;
use crate::recording::conventions::{Conventions, Frame, Gravity, Mounting, Quantity};
use crate::recording::message::RecordingError;
use crate::recording::table::Table;
use crate::texts::text;

/// The washout's input at each sample, with a warning where the mounting was found.
///
/// # Errors
/// The mounting is to be found and cannot be. Forces of the world's axes come without angles.
pub fn inputs(table: &Table, conventions: &Conventions) -> Result<(Vec<Input>, Option<Message>), RecordingError> {
    let has_angles = Quantity::ANGLES.iter().all(|angle| table.columns.contains_key(angle));
    if conventions.force_frame == Frame::World && !has_angles {
        return Err(table.refused(text!["world-forces-without-angles"]));
    }
    let (mounting, warning) = match conventions.mounting {
        None => (None, None),
        Some(Mounting::Angles(angles)) => (Some(Orientation::new(angles).rotation), None),
        Some(Mounting::Auto) => {
            let (rotation, warning) = find_mounting(table, conventions).map_err(|reason| table.refused(reason))?;
            (Some(rotation), Some(warning))
        }
    };
    let inputs =
        (0..table.time.len()).map(|sample| vehicle_input(table, conventions, mounting.as_ref(), sample)).collect();
    Ok((inputs, warning))
}

/// Three columns at a sample, turned to x forward, y left, z up of the sensor.
fn sensor_vector(
    table: &Table,
    conventions: &Conventions,
    sample: usize,
    quantity: fn(usize) -> Quantity,
) -> Vector3<f64> {
    let is_force = matches!(quantity(0), Quantity::Force(_));
    let signs = if is_force { conventions.axes.force_signs() } else { conventions.axes.rotation_signs() };
    Vector3::from_fn(|axis, _| table.value(quantity(axis), sample) * signs[axis])
}

fn find_mounting(table: &Table, conventions: &Conventions) -> Result<(Matrix3<f64>, Message), Message> {
    if conventions.gravity == Gravity::Removed {
        return Err(text!["mounting-without-gravity"]);
    }
    let vectors = |quantity| -> Vec<Vector3<f64>> {
        (0..table.time.len()).map(|sample| sensor_vector(table, conventions, sample, quantity)).collect()
    };
    let speeds = table.columns.get(&Quantity::Speed).map_or(&[][..], Vec::as_slice);
    mounting::find(table.step(), &vectors(Quantity::Force), &vectors(Quantity::Rate), speeds)
}

/// The input at a sample; `mounting` turns the sensor's axes to the vehicle's.
fn vehicle_input(table: &Table, conventions: &Conventions, mounting: Option<&Matrix3<f64>>, sample: usize) -> Input {
    let vector = |quantity| sensor_vector(table, conventions, sample, quantity);
    let turned = |vector: Vector3<f64>| mounting.map_or(vector, |rotation| rotation * vector);
    let sensor = RollPitchYaw::from_vector(vector(Quantity::Angle));
    let orientation = match mounting {
        Some(rotation) if table.has_orientation() => vehicle_orientation(sensor, rotation),
        _ => sensor,
    };
    let gravity = match conventions.gravity {
        Gravity::Included => Vector3::zeros(),
        Gravity::Removed => {
            Orientation::new(orientation).rotation.transpose() * Vector3::new(0.0, 0.0, STANDARD_GRAVITY)
        }
    };
    let (forces, rates) = (vector(Quantity::Force), vector(Quantity::Rate));
    let forces = match conventions.force_frame {
        Frame::Body => turned(forces),
        Frame::World => Orientation::new(orientation).rotation.transpose() * forces,
    };
    Input {
        specific_force: forces + gravity,
        angular_velocity: if conventions.rate_frame == Frame::Body { turned(rates) } else { rates },
        orientation,
        speed: table.value(Quantity::Speed, sample),
        lean: table.value(Quantity::Lean, sample),
        engaged: true,
    }
}

/// Takes gravity that conversion has put back along x and y out again: the forces have it there.
pub fn keep_horizontal_gravity(inputs: &mut [Input]) {
    let gravity = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    for input in inputs {
        input.specific_force += gravity - Orientation::new(input.orientation).rotation.transpose() * gravity;
    }
}

/// The vehicle's orientation from that of the sensor in it.
fn vehicle_orientation(sensor: RollPitchYaw, mounting: &Matrix3<f64>) -> RollPitchYaw {
    let rotation = Orientation::new(sensor).rotation * mounting.transpose();
    let (roll, pitch, yaw) = Rotation3::from_matrix_unchecked(rotation).euler_angles();
    RollPitchYaw::new(roll, pitch, yaw)
}

/// Fades the inputs in from rest over the first `duration` seconds, by x^2 (3 - 2x) after a
/// fraction x of the time.
pub fn fade_in(inputs: &mut [Input], step: f64, duration: f64) {
    let rest = Input::default();
    let faded = inputs.iter_mut().enumerate().map(|(k, input)| (k as f64 * step, input));
    for (time, input) in faded.take_while(|(time, _)| *time < duration) {
        let x = time / duration;
        *input = rest.towards(input, x * x * (3.0 - 2.0 * x));
    }
}
