//! Parameters that cannot be used are refused by name; the others ride.

use moris_motorcycle::{Input, Model, Motorcycle, Parameters};

#[track_caller]
fn assert_refused(change: impl FnOnce(&mut Parameters), variable: &str) {
    let mut parameters = Parameters::default();
    change(&mut parameters);
    let refusal = Motorcycle::new(&parameters, &Input::default()).expect_err(variable);
    assert_eq!(refusal.variable, variable, "{refusal}");
    println!("{refusal}");
}

#[test]
fn what_no_motorcycle_has_is_refused() {
    assert_refused(|p| p.machine.wheelbase = 0.0, "geometry.wheelbase");
    assert_refused(|p| p.machine.frame_mass = f64::NAN, "frame.mass");
    assert_refused(|p| p.machine.frame_x = 3.0, "frame.centre.x");
    assert_refused(|p| p.machine.frame_xz = 1e3, "frame.inertia.xz");
    assert_refused(|p| p.longitudinal.drag_area = 1e-6, "drive.power");
    assert_refused(|p| p.longitudinal.brake_front_share = 1.5, "brake.frontShare");
    assert_refused(|p| p.rider.torso_length = 2.0, "head.torsoLength");
    assert_refused(|p| p.rider.torso_mass = 300.0, "rider.torsoMass");
    assert_refused(|p| p.tyres.front_relaxation = 1e-4, "solver.maxStep");
    assert_refused(|p| p.suspension.rear_damping = 1e7, "solver.maxStep");
    assert_refused(|p| p.run.initial_speed = -1.0, "initial.speed");
}

#[test]
fn other_motorcycles_can_be_ridden() {
    let changes: [fn(&mut Parameters); 6] = [
        |p| p.machine.frame_mass = 400.0,
        |p| p.machine.trail = 0.08,
        |p| p.tyres.front_cornering = 8.0,
        |p| p.rider.torque_weight = 5.0,
        |p| p.rider.torque_weight = 300.0,
        |p| p.run.gravity = 1.62,
    ];
    for change in changes {
        let mut parameters = Parameters::default();
        change(&mut parameters);
        parameters.run.initial_speed = 15.0;
        let mut vehicle = Motorcycle::new(&parameters, &Input::default()).unwrap();
        for _ in 0..6000 {
            vehicle.step(&Input { lean: 0.2, throttle: 0.1, ..Input::default() }, 0.001);
        }
        let roll = vehicle.output().orientation.roll;
        assert!((roll - 0.2).abs() < 0.02, "{roll}");
    }
}
