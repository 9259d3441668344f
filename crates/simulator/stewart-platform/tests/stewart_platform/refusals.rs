//! Parameters that no platform can have are refused, and the refusal names what is wrong.

use moris_stewart_platform::{Input, Model, Parameters, StewartPlatform};

/// The variable that a refusal of these parameters names, and why.
fn refusal(change: impl Fn(&mut Parameters)) -> (String, String) {
    let mut parameters = Parameters::default();
    change(&mut parameters);
    let refusal = StewartPlatform::new(&parameters, &Input::default()).expect_err("it must be refused");
    (refusal.variable, refusal.reason)
}

#[test]
fn each_names_its_variable() {
    type Change = fn(&mut Parameters);
    let cases: &[(&str, Change)] = &[
        ("actuator.bandwidth", |p| p.actuators.bandwidth = -1.0),
        ("actuator.bandwidth", |p| p.actuators.bandwidth = f64::NAN),
        ("actuator.damping", |p| p.actuators.damping = 0.0),
        ("actuator.deadTime", |p| p.actuators.dead_time = -0.1),
        ("actuator.deadTime", |p| p.actuators.dead_time = f64::INFINITY),
        ("platform.mass", |p| p.masses.platform_mass = 0.0),
        ("payload.mass", |p| p.masses.payload_mass = -1.0),
        ("rider.centreOfMass.y", |p| p.masses.rider_centre.y = f64::NAN),
        ("platform.inertia", |p| p.masses.platform_inertia.xx = 500.0),
        ("platform.inertia", |p| p.masses.platform_inertia.yz = 90.0),
        ("rider.inertia", |p| p.masses.rider_inertia.xy = 100.0),
        ("solver.maxStep", |p| p.setting.max_step = 0.0),
        ("head.torsoLength", |p| p.setting.torso_length = 1.5),
        ("rig.neutralHeight", |p| p.rig.neutral_height = 2.0),
        ("actuator.minLength", |p| p.rig.min_length = 1.7),
        ("crank.rod", |p| p.rig.crank_arm = 0.2),
        ("rig.base, rig.platform", |p| p.rig.platform = p.rig.base),
    ];
    for (variable, change) in cases {
        assert_eq!(refusal(change).0, *variable);
    }
}

#[test]
fn drives_too_weak_to_carry_the_platform_are_told_what_they_lack() {
    let (variable, reason) = refusal(|p| p.actuators.force_limit = 600.0);
    assert_eq!(variable, "actuator.forceLimit");
    // A sixth of the weight, on legs that are 1.29996 m long and 1.091 m high.
    let carried = 330.0 * 9.80665 / 6.0 * 1.29996 / 1.091;
    assert!(reason.starts_with("is 600 N; at rest at neutral actuator "), "{reason}");
    assert!(reason.ends_with(&format!(" carries {carried:.1} N; raise the limit or lower the masses")), "{reason}");
}

#[test]
fn a_platform_without_rider_and_payload_is_one() {
    let mut parameters = Parameters::default();
    parameters.masses.rider_mass = 0.0;
    parameters.masses.rider_inertia = Default::default();
    parameters.actuators.dead_time = 0.0;
    assert!(StewartPlatform::new(&parameters, &Input::default()).is_ok());
}
