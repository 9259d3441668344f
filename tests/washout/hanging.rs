//! A platform below its base, as good as one above it.

use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::reach::{Axis, single_axis_range};
use moris_washout::platform::{
    Geometry, PlatformMotion, Pose, forward_kinematics, inverse_kinematics, leg_accelerations, leg_lengths, survey,
};
use moris_washout::{Input, Parameters, Rig, Washout, check};

/// The rig upside down: every z with the other sign.
fn mirrored(rig: &Rig) -> Rig {
    let joints = |joints: [Vector3<f64>; 6]| joints.map(flipped);
    Rig { base: joints(rig.base), platform: joints(rig.platform), neutral_height: -rig.neutral_height, ..*rig }
}

fn flipped(vector: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, -vector.z)
}

/// Of a rotation's axis: what a mirror makes of it.
fn counter(axis: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(-axis.x, -axis.y, axis.z)
}

/// A rig whose joints are at several heights.
fn uneven() -> Rig {
    let mut rig = Rig::default();
    for i in 0..6 {
        rig.base[i].z = 0.01 * i as f64;
        rig.platform[i].z = -0.02 * (i % 3) as f64;
    }
    rig
}

#[test]
fn a_mirrored_motion_moves_the_mirrored_legs_alike() {
    let rig = uneven();
    let below = mirrored(&rig);
    let [geometry, mirror] = [&rig, &below].map(Geometry::from);
    let orientation = Orientation::new(RollPitchYaw { roll: 0.1, pitch: -0.15, yaw: 0.2 });
    // Roll and pitch of a mirror image have the other sign.
    let other = Orientation::new(RollPitchYaw { roll: -0.1, pitch: 0.15, yaw: 0.2 });
    let motion = PlatformMotion {
        position: Vector3::new(0.1, -0.05, 1.15),
        velocity: Vector3::new(0.2, 0.1, -0.3),
        acceleration: Vector3::new(1.0, -2.0, 0.5),
        orientation,
        angular_velocity: Vector3::new(0.2, -0.1, 0.3),
        angular_acceleration: Vector3::new(-0.5, 1.0, 0.7),
    };
    let reflected = PlatformMotion {
        position: flipped(motion.position),
        velocity: flipped(motion.velocity),
        acceleration: flipped(motion.acceleration),
        orientation: other,
        angular_velocity: counter(motion.angular_velocity),
        angular_acceleration: counter(motion.angular_acceleration),
    };
    let near = |a: &[f64; 6], b: &[f64; 6]| assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} {b:?}");
    let [above, under] = [inverse_kinematics(&geometry, &motion), inverse_kinematics(&mirror, &reflected)];
    near(&above.position, &under.position);
    near(&above.velocity, &under.velocity);
    near(&leg_accelerations(&geometry, &motion), &leg_accelerations(&mirror, &reflected));

    let found = forward_kinematics(&mirror, &above.position, &Pose::neutral(&below)).expect("found");
    assert!((found.position - reflected.position).norm() < 1e-9, "{:?}", found.position);
    assert!((found.orientation.rotation - other.rotation).norm() < 1e-9);
}

#[test]
fn a_mirrored_rig_has_the_mirrored_reach_and_the_same_survey() {
    let rig = uneven();
    let below = mirrored(&rig);
    for axis in Axis::ALL {
        let [above, under] = [&rig, &below].map(|rig| single_axis_range(rig, axis));
        let [min, max] = if matches!(axis, Axis::Heave | Axis::Roll | Axis::Pitch) {
            [-under.max, -under.min]
        } else {
            [under.min, under.max]
        };
        assert!((above.min - min).abs() < 1e-9 && (above.max - max).abs() < 1e-9, "{axis:?} {above:?} {under:?}");
    }
    let [above, under] = [&rig, &below].map(|rig| survey(rig).expect("not singular"));
    assert!((above.worst_condition - under.worst_condition).abs() < 1e-6);
    assert!((above.smallest_singular_value - under.smallest_singular_value).abs() < 1e-9);
}

/// The same machine with the base's origin on the floor under it: its motion is the same, and the
/// legs are within their limits.
#[test]
fn a_ride_below_the_base_is_that_on_the_same_rig_from_the_floor() {
    const FLOOR: f64 = 2.0;
    let mut hanging = Parameters::default();
    hanging.rig = mirrored(&hanging.rig);
    let mut standing = hanging;
    standing.rig.neutral_height += FLOOR;
    standing.rig.base.iter_mut().for_each(|joint| joint.z += FLOOR);
    check(&hanging).expect("accepted");
    let [mut below, mut above] = [&hanging, &standing].map(|parameters| Washout::new(parameters).expect("accepted"));
    let Rig { min_length, max_length, .. } = hanging.rig;
    let mut travel: f64 = 0.0;
    for step in 0..20_000 {
        let time = 0.001 * f64::from(step);
        let force = Vector3::new(3.0 * (0.9 * time).sin(), 2.0 * (1.7 * time).sin(), 9.80665 + (2.3 * time).sin());
        let rates = Vector3::new(0.2 * (1.1 * time).sin(), 0.2 * (0.7 * time).cos(), 0.1);
        let input = Input { specific_force: force, angular_velocity: rates, ..Input::default() };
        below.step(&input, 0.001);
        above.step(&input, 0.001);
        let [under, over] = [below.output(), above.output()];
        for i in 0..6 {
            assert!((under.length[i] - over.length[i]).abs() < 1e-9, "{time} s");
            assert!((min_length..=max_length).contains(&under.length[i]), "{time} s");
        }
        assert!((under.position.z + FLOOR - over.position.z).abs() < 1e-9, "{time} s");
        assert!((under.felt_specific_force - over.felt_specific_force).norm() < 1e-9, "{time} s");
        travel = travel
            .max((under.length[0] - leg_lengths(&Geometry::from(&hanging.rig), &Pose::neutral(&hanging.rig))[0]).abs());
    }
    assert!(travel > 0.05, "{travel} m");
}
