//! From the recording's units and axes to the washout's.

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::Vector3;

use super::conventions::{Conventions, Gravity, Quantity};
use super::sampling::at;
use super::table::Table;

/// The washout's input at each sample.
pub fn inputs(table: &Table, conventions: &Conventions) -> Vec<Input> {
    let signs = Vector3::from(conventions.axes.signs());
    // Roll is about x, which keeps its sign; pitch and yaw are about y and z, which may not.
    let vector = |sample: usize, quantity: fn(usize) -> Quantity, unit: f64| {
        Vector3::from_fn(|axis, _| at(table, quantity(axis), sample) * unit * signs[axis])
    };
    let input = |sample: usize| {
        let orientation = RollPitchYaw::from_vector(vector(sample, Quantity::Angle, conventions.angle_unit.in_si()));
        let acceleration = vector(sample, Quantity::Force, conventions.force_unit.in_si());
        let gravity = match conventions.gravity {
            Gravity::Included => Vector3::zeros(),
            Gravity::Removed => {
                Orientation::new(orientation).rotation.transpose() * Vector3::new(0.0, 0.0, STANDARD_GRAVITY)
            }
        };
        Input {
            specific_force: acceleration + gravity,
            angular_velocity: vector(sample, Quantity::Rate, conventions.rate_unit.in_si()),
            orientation,
            speed: at(table, Quantity::Speed, sample),
            lean: at(table, Quantity::Lean, sample) * conventions.angle_unit.in_si(),
            engaged: true,
        }
    };
    (0..table.time.len()).map(input).collect()
}

/// Leads the inputs in from rest over the first `duration` seconds: x^2 (3 - 2x) of the way after a share x of the time.
pub fn fade_in(inputs: &mut [Input], step: f64, duration: f64) {
    let rest = Input::default();
    let faded = inputs.iter_mut().enumerate().map(|(k, input)| (k as f64 * step, input));
    for (time, input) in faded.take_while(|(time, _)| *time < duration) {
        let x = time / duration;
        *input = rest.towards(input, x * x * (3.0 - 2.0 * x));
    }
}
