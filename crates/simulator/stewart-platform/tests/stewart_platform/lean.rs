//! Specific force of a leaning rider on a platform at rest: gravity rotated by the lean. The force
//! to the left is g sin(lean). Its rate is g cos(lean) times the lean's rate.

use moris_stewart_platform::{Input, Model, Parameters, StewartPlatform};

const RATE: f64 = 0.4;

/// The input at neutral with this lean of the rider.
fn leaning(lean: f64) -> Input {
    Input { lean, ..Input::default() }
}

#[test]
fn the_rate_of_what_is_felt_has_the_lean_s() {
    let parameters = Parameters::default();
    let gravity = parameters.setting.gravity;
    for step in [0.001, 0.0004, 0.02] {
        let mut platform = StewartPlatform::new(&parameters, &Input::default()).unwrap();
        for k in 0..20 {
            let (from, to) = (RATE * step * f64::from(k), RATE * step * f64::from(k + 1));
            platform.step_between(&leaning(from), &leaning(to), step);
            let felt = platform.output().felt_specific_force;
            assert!((felt.y - gravity * to.sin()).abs() < 1e-9, "{felt}");
            let middle = to - 0.5 * RATE * step.min(parameters.setting.max_step);
            let rate = platform.output_derivative().felt_specific_force.y;
            assert!((rate - gravity * middle.cos() * RATE).abs() < 1e-5, "{rate} at {to} in steps of {step}");
        }
    }
}

#[test]
fn a_lean_that_stays_has_no_rate() {
    let mut platform = StewartPlatform::new(&Parameters::default(), &Input { lean: 0.2, ..Input::default() }).unwrap();
    assert!(platform.output_derivative().felt_specific_force.norm() == 0.0);
    platform.step(&leaning(0.2), 0.01);
    assert!(platform.output_derivative().felt_specific_force.norm() < 1e-9);
}
