//! Steady turns, compared with the balance of moments and forces of the masses.

use moris_motorcycle::{Input, Model, Motorcycle};

use crate::common::{assert_near, at_speed, cruise, motorcycle};

/// The default motorcycle after 12 s of a turn at a speed with a lean, the rider's torso upright in
/// it.
fn turning(speed: f64, lean: f64) -> Motorcycle {
    turning_with(0.0, speed, lean)
}

/// The same with the torso leaning by this fraction of the lean.
fn turning_with(body_lean_share: f64, speed: f64, lean: f64) -> Motorcycle {
    let mut parameters = at_speed(speed);
    parameters.rider.body_lean_share = body_lean_share;
    parameters.rider.lean_limit = 0.9;
    let mut vehicle = motorcycle(&parameters);
    for _ in 0..12_000 {
        let throttle = cruise(&vehicle, speed);
        vehicle.step(&Input { lean, throttle, ..Input::default() }, 0.001);
    }
    vehicle
}

const GRAVITY: f64 = 9.80665;

#[test]
fn the_lean_is_that_of_speed_and_radius() {
    for speed in [10.0, 20.0, 30.0] {
        for lean in [-0.7_f64, -0.2, 0.1, 0.5] {
            let output = turning(speed, lean).output();
            let rate = output.angular_velocity.z;
            // For a point mass, lean = atan(v^2 / (g R)). The wheels' spin requires some more lean.
            let radius = output.speed / rate.abs();
            let ideal = (output.speed * output.speed / (GRAVITY * radius)).atan();
            let ratio = output.orientation.roll.abs().tan() / ideal.tan();
            assert!((1.01..1.03).contains(&ratio), "{ratio} at {speed} m/s and {lean} rad");
            assert!(rate * lean < 0.0, "a lean to the right turns to the right");
        }
    }
}

#[test]
fn the_lean_beyond_a_point_masss_is_the_documented_one() {
    let excess = |fraction: f64, speed: f64| {
        let output = turning_with(fraction, speed, 0.3).output();
        let point_mass = output.speed * output.angular_velocity.z.abs() / GRAVITY;
        100.0 * (output.orientation.roll.tan() / point_mass - 1.0)
    };
    for (speed, default, upright) in [(10.0, 0.4, 1.4), (20.0, 1.3, 2.4), (30.0, 1.5, 2.5)] {
        let (a, b) = (excess(0.1, speed), excess(0.0, speed));
        assert!((a - default).abs() < 0.1 && (b - upright).abs() < 0.1, "{a} % and {b} % at {speed} m/s");
    }
}

#[test]
fn moments_about_the_road_balance_with_the_wheels_spin() {
    for speed in [8.0, 20.0] {
        let vehicle = turning(speed, 0.4);
        let o = vehicle.output();
        let turn_right = -o.angular_velocity.z * o.speed;
        let static_moment = 221.0 * 0.669 + 22.0 * 0.767 + 12.0 * 0.294 + 15.0 * 0.299;
        let spin = 0.8 / 0.299 + 0.6 / 0.294;
        // Steering moves the front assembly, and the contact under it, out of the plane.
        let (sin, cos) = 0.467_748_239_534_480_3_f64.sin_cos();
        let ahead = |x: f64, height: f64| (x - 1.448 - 0.1176) * cos + height * sin;
        let load = 270.0 * (221.0 * 0.642 + 22.0 * 1.205 + 12.0 * 1.448) / 270.0;
        let steered = 22.0 * ahead(1.205, 0.767) + 12.0 * ahead(1.448, 0.294) + 0.1176 / 1.448 * cos * load;
        let gravity = GRAVITY * (static_moment * o.orientation.roll.tan() - steered * o.steer_angle);
        assert_near(gravity / ((static_moment + spin) * turn_right), 1.0, 1e-3, "moments");
    }
}

#[test]
fn tyres_give_the_centripetal_force_and_no_moment_of_yaw() {
    let vehicle = turning(20.0, 0.4);
    let o = vehicle.output();
    let to_left = o.angular_velocity.z * o.speed;
    assert_near((o.front_lateral + o.rear_lateral) / (270.0 * to_left), 1.0, 1e-4, "force");
    let static_x = 221.0 * 0.642 + 22.0 * 1.205 + 12.0 * 1.448;
    assert_near(o.front_lateral * 1.448 / (static_x * to_left), 1.0, 1e-3, "moment");
}

#[test]
fn hardly_any_force_is_felt_sideways_and_all_along_the_plane() {
    for (speed, lean) in [(10.0, 0.3), (20.0, 0.5), (30.0, 0.7)] {
        let felt = turning(speed, lean).output().specific_force;
        assert!(felt.y.abs() < 0.05 * GRAVITY * lean.tan(), "{} m/s2 at {speed} m/s and {lean} rad", felt.y);
        // The plane's own direction: gravity and centripetal acceleration together.
        assert_near(felt.z * lean.cos() / GRAVITY, 1.0, 0.02, "weight in the turn");
    }
}

#[test]
fn in_a_turn_the_springs_carry_more() {
    let output = turning(20.0, 0.6).output();
    let expected = 270.0 * GRAVITY / 0.6_f64.cos();
    assert_near((output.front_load + output.rear_load) / expected, 1.0, 0.02, "loads in the plane");
    assert!(output.front_travel > 0.005 && output.rear_travel > 0.005);
}
