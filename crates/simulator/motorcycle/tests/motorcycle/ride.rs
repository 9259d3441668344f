//! A whole ride: accelerate, slalom, brake to a stop.

use moris_motorcycle::{Input, Model, Parameters};

use crate::common::motorcycle;

#[test]
fn it_accelerates_slaloms_and_brakes_to_a_stop() {
    let mut vehicle = motorcycle(&Parameters::default());
    let (mut most_left, mut most_right, mut fastest) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (mut hardest, mut end_of_slalom) = (0.0_f64, 0.0);
    for k in 0..30_000 {
        let time = f64::from(k) * 0.001;
        let slalom = 15.0_f64.to_radians() * (0.5 * std::f64::consts::PI * (time - 8.0)).sin();
        let input = Input {
            throttle: if time < 6.0 { 0.4 } else { 0.1 * f64::from(time < 18.0) },
            brake: 0.7 * f64::from(time > 19.0),
            lean: if (8.0..16.0).contains(&time) { slalom } else { 0.0 },
            ..Input::default()
        };
        vehicle.step(&input, 0.001);
        let output = vehicle.output();
        most_left = most_left.min(output.orientation.roll);
        most_right = most_right.max(output.orientation.roll);
        fastest = fastest.max(output.speed);
        hardest = hardest.min(output.acceleration);
        if k == 17_500 {
            end_of_slalom = output.orientation.roll;
        }
    }
    let degrees = f64::to_degrees;
    assert!((12.0..17.0).contains(&degrees(most_right)) && (-17.0..-12.0).contains(&degrees(most_left)));
    assert!(degrees(end_of_slalom).abs() < 0.5, "upright after the slalom: {end_of_slalom}");
    assert!(fastest > 20.0 && hardest < -7.0, "{fastest} m/s, {hardest} m/s2");
    let output = vehicle.output();
    assert_eq!(output.speed, 0.0);
    assert!(output.angular_velocity.norm() < 1e-3 && output.orientation.roll.abs() < 1e-3);
    assert_eq!(output.feet_down, 1.0);
}
