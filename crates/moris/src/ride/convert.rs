//! Conversion from the recording's axes to the washout's.

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
    let vector = |sample: usize, quantity: fn(usize) -> Quantity| {
        Vector3::from_fn(|axis, _| at(table, quantity(axis), sample) * signs[axis])
    };
    let input = |sample: usize| {
        let orientation = RollPitchYaw::from_vector(vector(sample, Quantity::Angle));
        let acceleration = vector(sample, Quantity::Force);
        let gravity = match conventions.gravity {
            Gravity::Included => Vector3::zeros(),
            Gravity::Removed => {
                Orientation::new(orientation).rotation.transpose() * Vector3::new(0.0, 0.0, STANDARD_GRAVITY)
            }
        };
        Input {
            specific_force: acceleration + gravity,
            angular_velocity: vector(sample, Quantity::Rate),
            orientation,
            speed: at(table, Quantity::Speed, sample),
            lean: at(table, Quantity::Lean, sample),
            engaged: true,
        }
    };
    (0..table.time.len()).map(input).collect()
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
