//! Parameters that change in flight.

use moris_motorcycle::{Input, Model, Motorcycle, Output, Parameters};

use crate::common::{at_speed, motorcycle};

const STEP: f64 = 0.001;

type Change = fn(&mut Parameters);

/// Braking into a bend.
fn input(step: u32) -> Input {
    Input { throttle: 0.1, brake: 0.15, lean: 0.3 * (0.002 * f64::from(step)).sin(), ..Input::default() }
}

fn run(motorcycle: &mut Motorcycle, from: u32, count: u32) {
    for k in from..from + count {
        motorcycle.step(&input(k), STEP);
    }
}

fn in_a_bend() -> Motorcycle {
    let mut motorcycle = motorcycle(&at_speed(25.0));
    run(&mut motorcycle, 0, 1000);
    motorcycle
}

fn changed(motorcycle: &Motorcycle, change: Change) -> Parameters {
    let mut parameters = *motorcycle.parameters();
    change(&mut parameters);
    parameters
}

const CHANGES: &[(&str, Change)] = &[
    ("aero.dragArea", |p| p.longitudinal.drag_area = 0.9),
    ("drive.power", |p| p.longitudinal.power = 40e3),
    ("more power", |p| p.longitudinal.power = 120e3),
    ("drive.forceLimit", |p| p.longitudinal.drive_force = 1500.0),
    ("drive.engineBraking", |p| p.longitudinal.engine_braking = 250.0),
    ("drive.timeConstant", |p| p.longitudinal.drive_time = 0.5),
    ("brake.forceLimit", |p| p.longitudinal.brake_force = 5000.0),
    ("brake.frontShare", |p| p.longitudinal.brake_front_share = 0.3),
    ("wheelLift.reserve", |p| p.longitudinal.lift_reserve = 0.2),
    ("tyre.friction", |p| p.tyres.friction = 0.6),
    ("tyre.rollingResistance", |p| p.tyres.rolling_resistance = 0.05),
    ("suspension.front.damping", |p| p.suspension.front_damping = 1500.0),
    ("rider.leanLimit", |p| p.rider.lean_limit = 0.1),
    ("rider.leanFrequency", |p| p.rider.lean_frequency = 10.0),
    ("rider.leanRateLimit", |p| p.rider.lean_rate_limit = 0.1),
    ("rider.torqueWeight", |p| p.rider.torque_weight = 10.0),
    ("a gentle rider", |p| p.rider.torque_weight = 100.0),
    ("rider.bodyLeanShare", |p| p.rider.body_lean_share = 0.5),
];

/// Quantities with inertia, each with its rate if that is an output.
fn pairs(output: &Output) -> [(f64, f64); 4] {
    [
        (output.speed, output.acceleration),
        (output.steer_angle, output.steer_rate),
        (output.head_position.y, output.head_velocity.y),
        (output.head_position.z, output.head_velocity.z),
    ]
}

#[test]
fn what_has_inertia_does_not_jump() {
    for (name, change) in CHANGES {
        let mut motorcycle = in_a_bend();
        let parameters = changed(&motorcycle, *change);
        let before = motorcycle.output();
        motorcycle.retune(&parameters).unwrap();
        assert_eq!(motorcycle.output(), before, "{name}: nothing changes before a step");
        run(&mut motorcycle, 1000, 1);
        let after = motorcycle.output();
        for (k, ((from, rate_from), (to, rate_to))) in pairs(&before).into_iter().zip(pairs(&after)).enumerate() {
            let covered = 0.5 * STEP * (rate_from + rate_to);
            // A rate that is itself a state changes by no more than an acceleration of 50 m/s2 or rad/s2 makes.
            assert!(
                (to - from - covered).abs() < 25.0 * STEP * STEP + 0.5 * STEP * (rate_to - rate_from).abs(),
                "{name}: {k}"
            );
        }
        assert!((after.orientation.roll - before.orientation.roll).abs() < 2e-3, "{name}");
        assert!((after.steer_rate - before.steer_rate).abs() < 50.0 * STEP, "{name}");
        assert!((after.steer_torque - before.steer_torque).abs() < 0.5, "{name}: the rider's torque");
        assert!((after.front_travel - before.front_travel).abs() < 1e-3, "{name}");
        assert!((after.throttle - before.throttle).abs() < 1e-2 && (after.brake - before.brake).abs() < 1e-2, "{name}");
    }
}

/// The motorcycle rides on, upright, and after a while as one that has had the parameters all the
/// time.
#[test]
fn the_new_values_hold() {
    for (name, change) in CHANGES.iter().step_by(crate::cases::cases(1, 5)) {
        let mut motorcycle = in_a_bend();
        let parameters = changed(&motorcycle, *change);
        motorcycle.retune(&parameters).unwrap();
        let mut expected =
            Motorcycle::new(&Parameters { run: at_speed(25.0).run, ..parameters }, &Input::default()).unwrap();
        let cruise = Input { throttle: 0.15, lean: 0.1, ..Input::default() };
        for _ in 0..80_000 {
            motorcycle.step(&cruise, STEP);
            expected.step(&cruise, STEP);
        }
        let (is, should) = (motorcycle.output(), expected.output());
        assert!((is.speed - should.speed).abs() < 2e-2 * should.speed, "{name}: {} {}", is.speed, should.speed);
        assert!((is.orientation.roll - should.orientation.roll).abs() < 1e-4, "{name}");
        assert!(
            (is.steer_torque - should.steer_torque).abs() < 0.05,
            "{name}: {} {}",
            is.steer_torque,
            should.steer_torque
        );
    }
}

#[test]
fn what_cannot_change_is_refused_and_nothing_has_changed() {
    let cases: &[(&str, Change)] = &[
        ("gravity", |p| p.run.gravity = 1.62),
        ("frame.mass", |p| p.machine.frame_mass = 250.0),
        ("suspension.front.stiffness", |p| p.suspension.front_stiffness = 8e3),
        ("initial.speed", |p| p.run.initial_speed = 3.0),
        ("aero.height", |p| p.longitudinal.aero_height = 0.7),
        ("tyre.friction", |p| p.tyres.friction = 0.0),
        ("drive.power", |p| p.longitudinal.drag_area = 0.01),
        ("solver.maxStep", |p| p.suspension.rear_damping = 1e6),
    ];
    for (variable, change) in cases {
        let mut motorcycle = in_a_bend();
        let parameters = changed(&motorcycle, *change);
        let before = motorcycle.clone();
        assert_eq!(motorcycle.retune(&parameters).expect_err(variable).variable, *variable);
        assert_eq!(motorcycle.parameters(), before.parameters());
        assert_eq!((motorcycle.rider(), motorcycle.state()), (before.rider(), before.state()));
        let mut expected = before;
        run(&mut motorcycle, 1000, 100);
        run(&mut expected, 1000, 100);
        assert_eq!(motorcycle.output(), expected.output());
    }
}
