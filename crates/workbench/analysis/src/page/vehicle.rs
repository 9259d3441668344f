//! The vehicle of a recording, which the report draws on the platform.

use moris_pages::report::Vehicle;
use moris_washout::Input;

use crate::recording::Recording;

/// A car if the lateral force of bends goes with the yaw rate, else a motorcycle.
pub fn vehicle(recording: &Recording) -> Vehicle {
    if turns_flat(recording.inputs(), recording.step()) { Vehicle::Car } else { Vehicle::Motorcycle }
}

fn turns_flat(inputs: &[Input], step: f64) -> bool {
    // Time over which forces and rates are averaged [s].
    const AVERAGING_TIME: f64 = 0.5;
    // Yaw rate from which on the vehicle is in a bend [rad/s].
    const MIN_BEND_YAW_RATE: f64 = 0.05;
    // Lateral force of bends by their yaw rate, which is the speed of a vehicle that does not lean
    // [m/s], and its correlation with the yaw rate. A leaning rider feels no lateral force.
    const LEAST_SPEED: f64 = 3.0;
    const LEAST_CORRELATION: f64 = 0.7;
    let block = ((AVERAGING_TIME / step).round() as usize).max(1);
    let mean = |block: &[Input], value: fn(&Input) -> f64| block.iter().map(value).sum::<f64>() / block.len() as f64;
    let bends = inputs
        .chunks_exact(block)
        .map(|block| [mean(block, |input| input.specific_force.y), mean(block, |input| input.angular_velocity.z)])
        .filter(|[_, rate]| rate.abs() > MIN_BEND_YAW_RATE);
    let [product, force, rate] =
        bends.fold([0.0; 3], |[product, force, rate], [f, w]| [product + f * w, force + f * f, rate + w * w]);
    product > LEAST_SPEED * rate && product > LEAST_CORRELATION * (force * rate).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bends at 10 m/s, of whose lateral force so much is felt.
    fn bends(felt: f64) -> Vec<Input> {
        let input = |k: usize| {
            let mut input = Input::default();
            input.angular_velocity.z = 0.3 * (0.005 * k as f64).sin();
            input.specific_force.y = felt * 10.0 * input.angular_velocity.z;
            input
        };
        (0..3000).map(input).collect()
    }

    #[test]
    fn a_vehicle_that_does_not_lean_is_a_car() {
        assert!(turns_flat(&bends(1.0), 0.01));
        assert!(!turns_flat(&bends(0.0), 0.01));
        assert!(!turns_flat(&bends(-0.1), 0.01));
        assert!(!turns_flat(&vec![Input::default(); 1000], 0.01), "no bends");
    }
}
