//! The rider: gains compared with closed forms, stability at all speeds, and tracking of the lean.

use moris_motorcycle::lateral::place;
use moris_motorcycle::{Input, Model, Parameters};
use nalgebra::{Complex, SMatrix, SVector};

use crate::common::{assert_near, at_speed, cruise, motorcycle};

/// Kalman's identity for x' = A x + b u with the cost x' Q x + u^2 / e.
///
/// Let g = (i w - A)^-1 b. The gain k minimises the cost exactly if |1 + k g|^2 = 1 + e g* Q g
/// at every frequency w.
#[test]
fn the_riders_gains_minimise_the_cost_that_they_are_said_to() {
    let parameters = Parameters::default();
    let vehicle = motorcycle(&parameters);
    let cost = [0.0, 0.0, 4.0, 0.25, 100.0, 25.0, 0.0, 0.0, 100.0];
    let inverse_weight = parameters.rider.torque_weight * parameters.rider.torque_weight;
    for knot in [32, 36, 40, 46] {
        let speed = vehicle.rider().knot(knot);
        assert!(speed > 3.0, "no feet on the road at {speed} m/s");
        let gains = vehicle.rider().gains(speed);
        let state_matrix = vehicle.lateral().state_matrix(speed, 0.0);
        let torque = vehicle.lateral().torque;
        for frequency in [0.1, 0.5, 1.0, 3.0, 10.0, 30.0, 100.0] {
            let matrix = SMatrix::<Complex<f64>, 9, 9>::from_fn(|i, j| {
                let a = if i < 8 && j < 8 { state_matrix[(i, j)] } else { f64::from(i == 8 && j == place::LEAN) };
                Complex::new(-a, if i == j { frequency } else { 0.0 })
            });
            let b = SVector::<Complex<f64>, 9>::from_fn(|i, _| Complex::from(if i < 8 { torque[i] } else { 0.0 }));
            let g = matrix.lu().solve(&b).unwrap();
            let gain = gains.gain.push(gains.error_gain);
            let returned: Complex<f64> = (0..9).map(|i| g[i] * gain[i]).sum();
            let expected = 1.0 + inverse_weight * (0..9).map(|i| cost[i] * g[i].norm_sqr()).sum::<f64>();
            assert_near(
                (1.0 + returned).norm_sqr() / expected,
                1.0,
                5e-3,
                &format!("{frequency} rad/s at {speed} m/s"),
            );
        }
    }
}

#[test]
fn at_every_speed_motorcycle_and_rider_are_stable() {
    let vehicle = motorcycle(&Parameters::default());
    for k in 0..=1000 {
        let speed = 0.1 * f64::from(k);
        let poles = vehicle.rider().closed_loop(vehicle.lateral(), speed).complex_eigenvalues();
        let slowest = poles.iter().map(|pole| pole.re).fold(f64::MIN, f64::max);
        // Near the speed at which foot support ends, the accumulated error decays slowly. At other
        // speeds all modes decay within seconds.
        let limit = if speed < 2.5 { -0.1 } else { -0.5 };
        assert!(slowest < limit, "{slowest} 1/s at {speed} m/s");
        for pole in poles.iter() {
            let damping = -pole.re / pole.norm();
            assert!(damping > 0.07, "damping {damping} of {pole} at {speed} m/s");
        }
    }
}

#[test]
fn a_commanded_lean_is_there_within_seconds_at_any_speed() {
    for speed in [4.0, 7.0, 12.0, 20.0, 35.0, 50.0] {
        let lean = if speed < 5.0 { 0.1 } else { 0.35 };
        let mut vehicle = motorcycle(&at_speed(speed));
        let mut largest: f64 = 0.0;
        for k in 0..8000 {
            let throttle = cruise(&vehicle, speed);
            vehicle.step(&Input { lean, throttle, ..Input::default() }, 0.001);
            let roll = vehicle.output().orientation.roll;
            largest = largest.max(roll);
            if k > 5000 {
                assert!((roll - lean).abs() < 0.02 * lean, "{roll} at {speed} m/s after {k} ms");
            }
        }
        assert!(largest < 1.2 * lean, "overshoot to {largest} at {speed} m/s");
    }
}

#[test]
fn to_lean_to_the_right_he_first_steers_to_the_left() {
    let mut vehicle = motorcycle(&at_speed(20.0));
    for _ in 0..50 {
        vehicle.step(&Input { lean: 0.3, ..Input::default() }, 0.001);
    }
    let output = vehicle.output();
    assert!(output.steer_torque > 1.0, "torque {}", output.steer_torque);
    assert!(output.steer_angle > 0.0, "steer {}", output.steer_angle);
    for _ in 0..3000 {
        vehicle.step(&Input { lean: 0.3, ..Input::default() }, 0.001);
    }
    assert!(vehicle.output().steer_angle < 0.0, "in the turn the rider steers into it");
}

#[test]
fn a_gust_from_the_side_is_held() {
    let mut vehicle = motorcycle(&at_speed(25.0));
    let mut wind = Input::default();
    wind.wind.y = 300.0;
    for _ in 0..10_000 {
        wind.throttle = cruise(&vehicle, 25.0);
        vehicle.step(&wind, 0.001);
    }
    // The wind has displaced it to the left, where it turned while it leant into the wind.
    assert!(vehicle.output().position.y > 1.0, "{}", vehicle.output().position.y);
    // The error's integral restores the commanded lean in any wind. The path is
    // then curved by the wind.
    assert!(vehicle.output().orientation.roll.abs() < 1e-3);
}

#[test]
fn a_torso_that_leans_to_the_right_turns_the_motorcycle_to_the_right_upright() {
    let mut vehicle = motorcycle(&at_speed(15.0));
    for _ in 0..8000 {
        let throttle = cruise(&vehicle, 15.0);
        vehicle.step(&Input { rider_lean: 0.2, throttle, ..Input::default() }, 0.001);
    }
    let output = vehicle.output();
    assert!(output.orientation.roll.abs() < 1e-3, "roll {}", output.orientation.roll);
    // The weight of the torso out of the plane, against the centripetal force of all masses and the wheels' spin.
    let static_moment = 221.0 * 0.669 + 22.0 * 0.767 + 12.0 * 0.294 + 15.0 * 0.299;
    let spin = 0.8 / 0.299 + 0.6 / 0.294;
    let expected = -44.5 * 0.4 * 0.2 * 9.80665 / ((static_moment + spin) * output.speed);
    assert_near(output.angular_velocity.z / expected, 1.0, 0.03, "yaw rate");
}

#[test]
fn his_torso_leans_as_told_and_into_the_turn() {
    let mut vehicle = motorcycle(&at_speed(20.0));
    for _ in 0..4000 {
        vehicle.step(&Input { lean: 0.3, rider_lean: -0.1, ..Input::default() }, 0.001);
    }
    assert_near(vehicle.output().lean, 0.1 * 0.3 - 0.1, 1e-6, "torso");
}
