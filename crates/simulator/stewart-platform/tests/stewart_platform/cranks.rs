//! Cranks. The drives respond in angle. The forces carry the body through arms and rods.

use moris_stewart_platform::{Input, Model, Parameters, StewartPlatform};
use moris_washout::Rig;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::platform::{Geometry, Pose, forward_kinematics, leg_lengths};
use nalgebra::Vector3;

const ARM: f64 = 0.184_15;
const ROD: f64 = 0.7239;
const HEADINGS: [f64; 6] = [150.0, -90.0, 30.0, 150.0, -90.0, 30.0];
const STEP: f64 = 0.001;

/// A published machine with arms of 184 mm; joints 6, 5 and 4 mirror 1, 2 and 3.
pub fn with_cranks() -> Parameters {
    let joints = |half: [[f64; 2]; 3]| {
        std::array::from_fn(|i| {
            let [x, y] = half[i.min(5 - i)];
            Vector3::new(if i < 3 { x } else { -x }, y, 0.0)
        })
    };
    let rig = Rig {
        base: joints([[0.2032, 0.351_953], [0.4064, 0.0], [0.2032, -0.351_953]]),
        platform: joints([[0.306_456, 0.257_147], [0.375_924, 0.136_825], [0.069_468, -0.393_972]]),
        neutral_height: 0.648_134,
        crank_arm: ARM,
        crank_rod: ROD,
        crank_heading: HEADINGS.map(f64::to_radians),
        velocity_limit: 6.0 * ARM,
        acceleration_limit: 60.0 * ARM,
        ..Rig::default()
    };
    let mut parameters = Parameters { rig, ..Parameters::default() };
    parameters.actuators.bandwidth = 12.0;
    parameters.actuators.damping = 0.6;
    parameters.actuators.dead_time = 0.0;
    parameters
}

/// Rods as long as they are: |p + R a - b - arm| = rod.
fn check_rods(parameters: &Parameters, platform: &StewartPlatform) {
    let output = platform.output();
    let rotation = Orientation::new(output.orientation).rotation;
    for (k, heading) in HEADINGS.iter().enumerate() {
        let ((up, level), (y, x)) = (output.angle[k].sin_cos(), heading.to_radians().sin_cos());
        let from_axle = output.position + rotation * parameters.rig.platform[k] - parameters.rig.base[k];
        let rod = from_axle - ARM * Vector3::new(level * x, level * y, up);
        assert!((rod.norm() - ROD).abs() < 1e-9, "crank {k}: {} m", rod.norm());
        assert!((from_axle.norm() - output.length[k]).abs() < 1e-12, "axle {k}: {} m", output.length[k]);
    }
}

/// x'' + 2 z w x' + w^2 x = w^2 u for a step of u, at rest before.
fn step_response(time: f64) -> f64 {
    let (w, z) = (12.0_f64, 0.6_f64);
    let damped = w * (1.0 - z * z).sqrt();
    1.0 - (-z * w * time).exp() * ((damped * time).cos() + z * w / damped * (damped * time).sin())
}

#[test]
fn a_step_of_the_angles_is_followed_as_a_second_order_system() {
    let parameters = with_cranks();
    let mut platform = StewartPlatform::new(&parameters, &Input::default()).unwrap();
    let neutral = platform.output().angle;
    let steps = [0.2, -0.1, 0.15, 0.05, -0.2, 0.1];
    let input = Input { angle: std::array::from_fn(|k| neutral[k] + steps[k]), ..Input::default() };
    for k in 1..=1500 {
        platform.step(&input, STEP);
        let response = step_response(STEP * f64::from(k));
        let output = platform.output();
        for (crank, step) in steps.iter().enumerate() {
            let error = output.angle[crank] - neutral[crank] - step * response;
            assert!(error.abs() < 1e-11, "crank {crank} is off by {error} rad after {k} ms");
        }
        check_rods(&parameters, &platform);
        assert!(!output.drive_limited && !output.force_limited && !output.command_refused);
    }
    let rates = platform.output_derivative();
    assert_eq!(rates.angle, platform.output().angular_rate);
    assert_eq!(rates.length, platform.output().leg_velocity);
}

#[test]
fn fast_commands_keep_the_arms_speed_acceleration_and_range() {
    let mut parameters = with_cranks();
    parameters.actuators.bandwidth = 200.0;
    // A drive without force for its motion is moved by the others.
    parameters.actuators.force_limit = 1e6;
    let mut platform = StewartPlatform::new(&parameters, &Input::default()).unwrap();
    let (mut fastest, mut hardest, mut before) = (0.0_f64, 0.0_f64, [0.0; 6]);
    for k in 0..4500 {
        // To and fro, and then time to arrive.
        let sign = if k < 3000 && k / 500 % 2 == 0 { 1.0 } else { -1.0 };
        // The third command, of 80 degrees, is outside of the range and is refused.
        let angle = [0.9 * sign, -0.5 * sign, 1.4, 0.8 * sign, 0.0, -0.4 * sign];
        platform.step(&Input { angle, ..Input::default() }, STEP);
        let output = platform.output();
        assert!(output.command_refused && output.angle[2].abs() < 1e-3, "{}", output.angle[2]);
        for (rate, last) in output.angular_rate.iter().zip(before) {
            (fastest, hardest) = (fastest.max(rate.abs()), hardest.max((rate - last).abs() / STEP));
        }
        before = output.angular_rate;
        check_rods(&parameters, &platform);
    }
    assert!((5.9..6.0 + 1e-9).contains(&fastest) && (59.0..60.0 + 1e-6).contains(&hardest), "{fastest} {hardest}");
    assert!((platform.output().angle[0] + 0.9).abs() < 1e-6);
}

/// Virtual work: the force at an arm's end is the weight times the rise of its centre with the arc.
#[test]
fn forces_at_the_arms_ends_carry_the_weight() {
    let mut parameters = with_cranks();
    parameters.masses.payload_mass = 60.0;
    parameters.masses.payload_centre = Vector3::new(0.1, -0.05, 0.4);
    let platform = StewartPlatform::new(&parameters, &Input::default()).unwrap();
    let (geometry, neutral) = (Geometry::from(&parameters.rig), Pose::neutral(&parameters.rig));
    let arcs = leg_lengths(&geometry, &neutral);
    let weights = {
        let masses = &parameters.masses;
        let parts = [
            (masses.platform_mass, masses.platform_centre),
            (masses.rider_mass, masses.rider_centre),
            (masses.payload_mass, masses.payload_centre),
        ];
        parts.map(|(mass, centre)| (mass * parameters.setting.gravity, centre))
    };
    let energy = |arcs: &[f64; 6]| {
        let pose = forward_kinematics(&geometry, arcs, &neutral).unwrap();
        let height = |centre: &Vector3<f64>| (pose.position + pose.orientation.rotation * centre).z;
        weights.iter().map(|(weight, centre)| weight * height(centre)).sum::<f64>()
    };
    for k in 0..6 {
        let moved = |by: f64| std::array::from_fn(|i| arcs[i] + if i == k { by } else { 0.0 });
        let expected = (energy(&moved(1e-4)) - energy(&moved(-1e-4))) / 2e-4;
        let found = platform.output().force[k];
        assert!((found - expected).abs() < 1e-3 * expected.abs(), "crank {k}: {found} N, not {expected} N");
    }
    // Level: the neutral pose of this machine.
    assert!(neutral.orientation == Orientation::new(RollPitchYaw::default()));
}
