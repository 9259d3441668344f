//! Parameters that change in flight. Lengths and their rates do not jump, and the new
//! values apply from then on.

use moris_stewart_platform::{Input, Model, Output, Parameters, StewartPlatform};

const STEP: f64 = 0.001;

/// Input of a platform in motion.
fn input(time: f64) -> Input {
    let neutral = Input::default();
    let lengths = std::array::from_fn(|i| neutral.length[i] + 0.05 * (6.0 * time + 0.3 * i as f64).sin());
    Input { length: lengths, ..neutral }
}

fn run(platform: &mut StewartPlatform, from: f64, count: u32) {
    for k in 0..count {
        let time = from + STEP * f64::from(k);
        platform.step_between(&input(time), &input(time + STEP), STEP);
    }
}

fn in_motion() -> StewartPlatform {
    let mut platform = StewartPlatform::new(&Parameters::default(), &Input::default()).unwrap();
    run(&mut platform, 0.0, 1000);
    platform
}

/// The largest change of a length less that by its rate, and the largest change of a rate beyond
/// its acceleration limit.
fn jumps(before: &Output, after: &Output, acceleration: f64) -> (f64, f64) {
    let mut jumps = (0.0_f64, 0.0_f64);
    for i in 0..6 {
        let moved = after.length[i] - before.length[i];
        let covered = 0.5 * STEP * (before.leg_velocity[i] + after.leg_velocity[i]);
        jumps.0 = jumps.0.max((moved - covered).abs());
        jumps.1 = jumps.1.max((after.leg_velocity[i] - before.leg_velocity[i]).abs() - acceleration * STEP);
    }
    jumps
}

type Change = fn(&mut Parameters);

#[test]
fn lengths_and_rates_do_not_jump() {
    let changes: &[(&str, Change)] = &[
        ("bandwidth", |p| p.actuators.bandwidth = 20.0),
        ("damping", |p| p.actuators.damping = 3.0),
        ("dead time", |p| p.actuators.dead_time = 0.1),
        ("no dead time", |p| p.actuators.dead_time = 0.0),
        ("force limit", |p| p.actuators.force_limit = 1200.0),
        ("rider off", |p| p.masses.rider_mass = 0.0),
        ("payload", |p| p.masses.payload_mass = 100.0),
        ("speed limit", |p| p.rig.velocity_limit = 0.05),
        ("acceleration limit", |p| p.rig.acceleration_limit = 3.0),
    ];
    for (name, change) in changes {
        let mut platform = in_motion();
        let mut parameters = *platform.parameters();
        change(&mut parameters);
        let before = platform.output();
        platform.retune(&parameters).unwrap();
        let after = platform.output();
        assert_eq!((after.length, after.leg_velocity), (before.length, before.leg_velocity), "{name}");
        assert_eq!((after.position, after.orientation), (before.position, before.orientation), "{name}");
        let limit = parameters.actuators.force_limit;
        assert_eq!(after.force, before.force.map(|force| force.clamp(-limit, limit)), "{name}");
        assert_eq!(after.stop_force, before.stop_force, "{name}");
        // Drives with too little force are moved by the body's momentum, and keep
        // no acceleration limit.
        let allowed = if *name == "force limit" { 100.0 } else { parameters.rig.acceleration_limit };
        let mut last = before;
        for k in 0..500 {
            run(&mut platform, 1.0 + STEP * f64::from(k), 1);
            let now = platform.output();
            let (position, velocity) = jumps(&last, &now, allowed);
            assert!(position < 1e-4 * allowed * STEP + 0.5 * allowed * STEP * STEP, "{name}: {position} m");
            assert!(velocity < 1e-9, "{name}: {velocity} m/s");
            last = now;
        }
    }
}

/// After the transition the platform behaves as if it had always had the parameters.
#[test]
fn the_new_values_hold() {
    let changes: &[Change] = &[
        |p| p.actuators.bandwidth = 20.0,
        |p| p.actuators.dead_time = 0.05,
        |p| p.actuators.dead_time = 0.0,
        |p| p.masses.rider_mass = 0.0,
        |p| p.rig.velocity_limit = 0.2,
    ];
    for change in changes {
        let mut parameters = Parameters::default();
        change(&mut parameters);
        let mut platform = in_motion();
        platform.retune(&parameters).unwrap();
        run(&mut platform, 1.0, 4000);
        let mut expected = StewartPlatform::new(&parameters, &Input::default()).unwrap();
        run(&mut expected, 0.0, 5000);
        let (is, should) = (platform.output(), expected.output());
        for i in 0..6 {
            assert!((is.length[i] - should.length[i]).abs() < 1e-7, "{} {}", is.length[i], should.length[i]);
            // Commands in the delay line may be interpolated at other points. The rider's
            // weight is 130 N a leg.
            assert!((is.force[i] - should.force[i]).abs() < 5.0, "{} {}", is.force[i], should.force[i]);
        }
    }
}

#[test]
fn what_cannot_change_is_refused_and_nothing_has_changed() {
    let cases: &[(&str, Change)] = &[
        ("gravity", |p| p.setting.gravity = 1.62),
        ("rig.neutralHeight", |p| p.rig.neutral_height = 1.1),
        ("rig.base[3].y", |p| p.rig.base[2].y += 0.01),
        ("actuator.maxLength", |p| p.rig.max_length = 1.7),
        ("actuator.bandwidth", |p| p.actuators.bandwidth = 0.0),
        ("rider.inertia", |p| p.masses.rider_inertia.xy = 100.0),
        ("actuator.forceLimit", |p| p.actuators.force_limit = 100.0),
    ];
    for (variable, change) in cases {
        let mut platform = in_motion();
        let mut parameters = *platform.parameters();
        change(&mut parameters);
        let before = platform.clone();
        assert_eq!(platform.retune(&parameters).unwrap_err().variable, *variable);
        assert_eq!(platform, before);
    }
}
