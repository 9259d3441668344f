//! Specific force at the head, against finite differences of its position.

use moris_motorcycle::{Input, Model, Motorcycle, Output, Parameters};
use nalgebra::{Rotation3, Vector3};

use crate::common::{at_speed, motorcycle};

/// A ride with everything in it, smooth enough for differences.
fn ride(time: f64) -> Input {
    let swing = |amplitude: f64, hertz: f64| amplitude * (2.0 * std::f64::consts::PI * hertz * time).sin();
    Input {
        throttle: 0.3 + swing(0.2, 0.3),
        brake: 0.1 + swing(0.1, 0.2),
        lean: swing(0.5, 0.22),
        rider_lean: swing(0.2, 0.31),
        wind: Vector3::new(swing(50.0, 0.7), swing(60.0, 0.5), swing(80.0, 0.9)),
    }
}

fn rotation(output: &Output) -> Rotation3<f64> {
    // from_euler_angles is Rz(yaw) Ry(pitch) Rx(roll), as in eq. (2).
    let o = output.orientation;
    Rotation3::from_euler_angles(o.roll, o.pitch, o.yaw)
}

/// Steps through the ride, giving every three outputs in a row.
fn three_by_three(step: f64, steps: u32, mut check: impl FnMut(&[Output; 3])) {
    let mut parameters = at_speed(15.0);
    parameters.run.max_step = step;
    let mut vehicle: Motorcycle = motorcycle(&parameters);
    let mut last = [vehicle.output(); 3];
    for k in 0..steps {
        let time = f64::from(k) * step;
        vehicle.step_between(&ride(time), &ride(time + step), step);
        last = [last[1], last[2], vehicle.output()];
        if k > 200 {
            check(&last);
        }
    }
}

#[test]
fn the_specific_force_is_the_second_difference_of_the_heads_position() {
    let step = 5e-4;
    let (mut largest_roll, mut off): (f64, f64) = (0.0, 0.0);
    three_by_three(step, 16_000, |[before, now, after]| {
        let acceleration = (after.head_position - 2.0 * now.head_position + before.head_position) / (step * step);
        let head = rotation(now) * Rotation3::from_axis_angle(&Vector3::x_axis(), now.lean);
        let felt = head.inverse() * (acceleration + Vector3::new(0.0, 0.0, 9.80665));
        off = off.max((felt - now.specific_force).norm());
        largest_roll = largest_roll.max(now.orientation.roll.abs());
    });
    assert!(largest_roll > 0.4, "the ride is meant to lean: {largest_roll}");
    assert!(off < 2e-3, "off by {off} m/s2");
}

#[test]
fn the_heads_velocity_is_the_difference_of_its_position() {
    let step = 5e-4;
    three_by_three(step, 8_000, |[before, now, after]| {
        let velocity = (after.head_position - before.head_position) / (2.0 * step);
        assert!((velocity - now.head_velocity).norm() < 1e-4);
    });
}

#[test]
fn the_angular_velocity_is_the_difference_of_the_orientation() {
    let step = 5e-4;
    three_by_three(step, 8_000, |[before, now, after]| {
        let turned = rotation(after) * rotation(before).inverse();
        let rate = turned.scaled_axis() / (2.0 * step);
        assert!((rate - now.angular_velocity).norm() < 1e-4, "{rate} instead of {}", now.angular_velocity);
    });
}

#[test]
fn the_head_is_where_pose_and_suspension_put_it() {
    let parameters = Parameters::default();
    let rider = parameters.rider;
    let axis = (221.0 * 0.642 + 22.0 * 1.205 + 12.0 * 1.448) / 270.0;
    three_by_three(1e-3, 4_000, |[_, _, now]| {
        let o = now.orientation;
        let plane = Rotation3::from_euler_angles(o.roll, 0.0, o.yaw);
        // Heave from the springs' travels: the front goes down by pitch times its arm, the rear up.
        let heave = -(now.rear_travel * (1.448 - axis) + now.front_travel * axis) / 1.448;
        let seat = Vector3::new(rider.head_x - axis, 0.0, rider.head_height - rider.torso_length);
        let torso = Vector3::new(0.0, -now.lean.sin(), now.lean.cos()) * rider.torso_length;
        let head = now.position + plane * Vector3::new(axis, 0.0, heave) + rotation(now) * (seat + torso);
        assert!((head - now.head_position).norm() < 1e-12);
    });
}

#[test]
fn body_axes_are_the_worlds_turned() {
    let mut world = at_speed(15.0);
    world.run.initial_heading = 1.0;
    let mut body = world;
    body.run.angular_velocity_frame = moris_washout::interface::AngularVelocityFrame::Body;
    let (mut world, mut body) = (motorcycle(&world), motorcycle(&body));
    for k in 0..2000 {
        let input = ride(f64::from(k) * 1e-3);
        world.step(&input, 1e-3);
        body.step(&input, 1e-3);
        let turned = rotation(&world.output()).inverse() * world.output().angular_velocity;
        assert!((turned - body.output().angular_velocity).norm() < 1e-12);
    }
}
