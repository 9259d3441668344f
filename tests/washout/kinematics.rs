//! Inverse and forward kinematics against each other and against the same formulas
//! written out axis by axis.

use moris_washout::Rig;
use moris_washout::interface::RollPitchYaw;
use moris_washout::motion::orientation::Orientation;
use moris_washout::platform::{
    Geometry, PlatformMotion, Pose, forward_kinematics, inverse_kinematics, jacobian, leg_accelerations, leg_lengths,
    motion_of_legs,
};
use nalgebra::{Vector3, Vector6};
use proptest::prelude::*;

use crate::common::cases;
use crate::common::random::Random;
use crate::common::rotation::{Vec3, to_base, turn};

/// Heights of the joints of the base and of the platform above their planes \[m\].
const BASE_HEIGHTS: [f64; 6] = [0.02, -0.03, 0.0, 0.04, -0.01, 0.03];
const PLATFORM_HEIGHTS: [f64; 6] = [-0.02, 0.01, 0.03, 0.0, -0.04, 0.02];

/// The default rig with joints out of their planes.
fn geometry() -> Geometry {
    let mut rig = Rig::default();
    for i in 0..6 {
        rig.base[i].z = BASE_HEIGHTS[i];
        rig.platform[i].z = PLATFORM_HEIGHTS[i];
    }
    Geometry::from(&rig)
}

fn pose([x, y, z]: Vec3, [roll, pitch, yaw]: Vec3) -> Pose {
    Pose { position: Vector3::new(x, y, z), orientation: Orientation::new(RollPitchYaw::new(roll, pitch, yaw)) }
}

/// Joint positions from the default rig's description: radius and angle in degrees; and heights.
fn joints(radius: f64, degrees: [f64; 6], heights: [f64; 6]) -> [Vec3; 6] {
    std::array::from_fn(|i| {
        let (sin, cos) = degrees[i].to_radians().sin_cos();
        [radius * cos, radius * sin, heights[i]]
    })
}

/// The legs' lengths, with joints and rotations of this test's own.
fn lengths(position: Vec3, angles: Vec3) -> [f64; 6] {
    let base = joints(1.0, [-8.0, 8.0, 112.0, 128.0, 232.0, 248.0], BASE_HEIGHTS);
    let platform = joints(0.85, [-52.0, 52.0, 68.0, 172.0, 188.0, 292.0], PLATFORM_HEIGHTS);
    std::array::from_fn(|i| {
        let turned = to_base(angles, platform[i]);
        let leg: Vec3 = std::array::from_fn(|k| position[k] + turned[k] - base[i][k]);
        (leg[0] * leg[0] + leg[1] * leg[1] + leg[2] * leg[2]).sqrt()
    })
}

/// A smooth motion in which everything moves: position and angles at a time.
fn path(t: f64) -> (Vec3, Vec3) {
    let wave = |amplitude: f64, omega: f64, phase: f64| amplitude * (omega * t + phase).sin();
    (
        [wave(0.15, 1.3, 0.0), wave(0.1, 1.7, 1.0), 1.091 + wave(0.08, 2.1, 2.0)],
        [wave(0.15, 1.9, 0.5), wave(0.12, 1.1, 1.5), wave(0.2, 1.5, 2.5)],
    )
}

/// The platform's motion on the path, with derivatives by central differences of positions and of
/// this test's rotations.
fn motion_on_path(t: f64) -> PlatformMotion {
    const H: f64 = 1e-4;
    let at = |t: f64| Vector3::from(path(t).0);
    let omega = |t: f64| Vector3::from(turn(path(t - H).1, path(t + H).1, 2.0 * H));
    let (position, angles) = path(t);
    PlatformMotion {
        velocity: (at(t + H) - at(t - H)) / (2.0 * H),
        acceleration: (at(t + H) - 2.0 * at(t) + at(t - H)) / (H * H),
        angular_velocity: omega(t),
        angular_acceleration: (omega(t + H) - omega(t - H)) / (2.0 * H),
        ..PlatformMotion::at_rest(pose(position, angles))
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn lengths_are_those_of_the_written_out_formula(
        position in [-0.6..0.6, -0.6..0.6, 0.6..1.6], angles in [-0.8..0.8, -0.8..0.8, -3.0..3.0],
    ) {
        let ours = leg_lengths(&geometry(), &pose(position, angles));
        for (ours, theirs) in ours.iter().zip(lengths(position, angles)) {
            prop_assert!((ours - theirs).abs() < 1e-12);
        }
    }

    #[test]
    fn angular_velocity_and_acceleration_are_the_rotations(t in 0.0..20.0) {
        const H: f64 = 1e-4;
        let angles = |t: f64| Vector3::from(path(t).1);
        let rates = RollPitchYaw::from_vector((angles(t + H) - angles(t - H)) / (2.0 * H));
        let accelerations = RollPitchYaw::from_vector((angles(t + H) - 2.0 * angles(t) + angles(t - H)) / (H * H));
        let motion = motion_on_path(t);
        let omega = motion.orientation.angular_velocity(rates);
        prop_assert!((omega - motion.angular_velocity).amax() < 1e-7);
        let alpha = motion.orientation.angular_acceleration(rates, accelerations);
        prop_assert!((alpha - motion.angular_acceleration).amax() < 1e-6);
        let back = motion.orientation.rates(omega);
        prop_assert!((back.to_vector() - rates.to_vector()).amax() < 1e-14);
    }

    #[test]
    fn rates_and_accelerations_are_those_of_the_lengths(t in 0.0..20.0) {
        const H: f64 = 1e-4;
        let at = |t: f64| lengths(path(t).0, path(t).1);
        let legs = inverse_kinematics(&geometry(), &motion_on_path(t));
        let accelerations = leg_accelerations(&geometry(), &motion_on_path(t));
        let (before, now, after) = (at(t - H), at(t), at(t + H));
        for i in 0..6 {
            let rate = (after[i] - before[i]) / (2.0 * H);
            prop_assert!((legs.velocity[i] - rate).abs() < 1e-7, "{} {rate}", legs.velocity[i]);
            let acceleration = (after[i] - 2.0 * now[i] + before[i]) / (H * H);
            prop_assert!((accelerations[i] - acceleration).abs() < 1e-6, "{} {acceleration}", accelerations[i]);
        }
    }

    #[test]
    fn the_jacobian_gives_the_rates(t in 0.0..20.0) {
        let motion = motion_on_path(t);
        let twist = Vector6::from_iterator(motion.velocity.iter().chain(motion.angular_velocity.iter()).copied());
        let rates = jacobian(&geometry(), &motion.pose()) * twist;
        let legs = inverse_kinematics(&geometry(), &motion);
        prop_assert!((rates - Vector6::from(legs.velocity)).amax() < 1e-14);
    }

    #[test]
    fn the_motion_of_the_legs_is_the_platforms(t in 0.0..20.0) {
        let motion = motion_on_path(t);
        let legs = inverse_kinematics(&geometry(), &motion);
        let accelerations = leg_accelerations(&geometry(), &motion);
        let back = motion_of_legs(&geometry(), &legs, &accelerations, &Pose::neutral(&Rig::default())).unwrap();
        prop_assert!((back.position - motion.position).amax() < 1e-12);
        prop_assert!((back.orientation.rotation - motion.orientation.rotation).amax() < 1e-12);
        prop_assert!((back.velocity - motion.velocity).amax() < 1e-11);
        prop_assert!((back.angular_velocity - motion.angular_velocity).amax() < 1e-11);
        prop_assert!((back.acceleration - motion.acceleration).amax() < 1e-10);
        prop_assert!((back.angular_acceleration - motion.angular_acceleration).amax() < 1e-10);
    }
}

/// Forward kinematics from neutral must find legs of these lengths, and the same
/// pose from anywhere near.
fn inverts(target: [f64; 6], random: &mut Random) {
    let geometry = geometry();
    let neutral = Pose::neutral(&Rig::default());
    let found = forward_kinematics(&geometry, &target, &neutral).expect("a pose");
    let RollPitchYaw { roll, pitch, yaw } = found.orientation.angles;
    let back = lengths(found.position.into(), [roll, pitch, yaw]);
    for i in 0..6 {
        assert!((back[i] - target[i]).abs() < 1e-10, "{target:?}: {back:?}");
    }
    let mut near = || random.between(-0.03, 0.03);
    let guess = Pose {
        position: found.position + Vector3::new(near(), near(), near()),
        orientation: Orientation::new(RollPitchYaw::new(roll + near(), pitch + near(), yaw + near())),
    };
    let again = forward_kinematics(&geometry, &target, &guess).expect("a pose");
    assert!((again.position - found.position).amax() < 1e-9, "two poses for {target:?}");
    assert!((again.orientation.rotation - found.orientation.rotation).amax() < 1e-9, "two poses for {target:?}");
}

#[test]
fn forward_kinematics_keeps_a_pose_that_fits() {
    let geometry = geometry();
    let mut random = Random::new(29);
    for _ in 0..100 {
        let mut between = |largest: f64| random.between(-largest, largest);
        let guess = Pose {
            position: Vector3::new(between(0.1), between(0.1), 1.2 + between(0.05)),
            orientation: Orientation::new(RollPitchYaw::new(between(0.2), between(0.2), between(0.2))),
        };
        let target = leg_lengths(&geometry, &guess).map(|length| length + 5e-14);
        assert_eq!(forward_kinematics(&geometry, &target, &guess), Ok(guess));
    }
}

#[test]
fn forward_kinematics_converges_near_a_pitch_of_90_degrees() {
    for degrees in [60.0_f64, 80.0, 85.0, 87.0, 88.5] {
        let pitch = degrees.to_radians();
        let target = lengths([0.05, 0.02, 1.0], [0.1, pitch, 0.05]);
        let guess = pose([0.051, 0.021, 1.001], [0.102, pitch - 0.002, 0.053]);
        let found = forward_kinematics(&geometry(), &target, &guess).expect("a pose");
        let again = leg_lengths(&geometry(), &found);
        assert!((0..6).all(|i| (again[i] - target[i]).abs() < 1e-12), "at {degrees} degrees");
        assert!(
            (found.orientation.angles.pitch - pitch).abs() < 1e-8,
            "at {degrees} degrees: {:?}",
            found.orientation.angles
        );
    }
}

#[test]
fn forward_kinematics_inverts_on_a_grid_of_the_whole_box() {
    let mut random = Random::new(3);
    for index in 0..4_usize.pow(6) {
        let level = |leg: u32| (index / 4_usize.pow(leg)) % 4;
        inverts(std::array::from_fn(|leg| 1.0 + 0.2 * level(leg as u32) as f64), &mut random);
    }
}

#[test]
fn forward_kinematics_inverts_at_random_points_of_the_box() {
    let mut random = Random::new(4);
    for _ in 0..20_000 {
        let target = std::array::from_fn(|_| random.between(1.0, 1.6));
        inverts(target, &mut random);
    }
}

/// On legs of kilometres, rounding errors exceed the tolerance; the pose reached is accepted.
#[test]
fn forward_kinematics_of_a_huge_rig_ends_where_rounding_does() {
    const SIZE: f64 = 2000.0;
    let mut rig = Rig::default();
    for joint in rig.base.iter_mut().chain(&mut rig.platform) {
        *joint *= SIZE;
    }
    let geometry = Geometry::from(&rig);
    let neutral = pose([0.0, 0.0, 1.091 * SIZE], [0.0; 3]);
    let mut random = Random::new(5);
    for _ in 0..200 {
        let mut off = |most: f64| std::array::from_fn(|_| random.between(-most, most));
        let [x, y, z]: Vec3 = off(0.3);
        let target = pose([x, y, 1.091 * SIZE + z], off(1e-4));
        let found = forward_kinematics(&geometry, &leg_lengths(&geometry, &target), &neutral).expect("a pose");
        assert!((found.position - target.position).norm() < 1e-9);
    }
}

#[test]
fn impossible_lengths_are_reported() {
    let neutral = Pose::neutral(&Rig::default());
    let one_too_long = [1.3, 1.3, 1.3, 1.3, 1.3, 9.0];
    assert!(forward_kinematics(&geometry(), &one_too_long, &neutral).is_err());
    assert!(forward_kinematics(&geometry(), &[f64::NAN; 6], &neutral).is_err());
}
