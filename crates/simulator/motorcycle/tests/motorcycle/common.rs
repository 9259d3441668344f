//! Helpers of several tests.

use moris_motorcycle::whipple::{Bicycle, Body, Wheel};
use moris_motorcycle::{Input, Model, Motorcycle, Parameters};

/// The benchmark bicycle of Meijaard et al. (2007), table 1.
pub fn benchmark() -> Bicycle {
    Bicycle {
        w: 1.02,
        c: 0.08,
        caster_angle: std::f64::consts::PI / 10.0,
        r: Wheel { r: 0.3, m: 2.0, xx: 0.0603, yy: 0.12 },
        b: Body { x: 0.3, z: -0.9, m: 85.0, xx: 9.2, xz: 2.4, zz: 2.8 },
        h: Body { x: 0.9, z: -0.7, m: 4.0, xx: 0.05892, xz: -0.00756, zz: 0.00708 },
        f: Wheel { r: 0.35, m: 3.0, xx: 0.1405, yy: 0.28 },
    }
}

/// Gravity of the benchmark \[m/s2\].
pub const GRAVITY: f64 = 9.81;

/// Asserts that two numbers differ by no more than `tolerance`, relative where they are larger than
/// 1.
#[track_caller]
pub fn assert_near(number: f64, expected: f64, tolerance: f64, what: &str) {
    let off = (number - expected).abs() / expected.abs().max(1.0);
    assert!(off <= tolerance, "{what}: {number} instead of {expected}, off by {off:e}");
}

/// A motorcycle with these parameters, ready to go.
pub fn motorcycle(parameters: &Parameters) -> Motorcycle {
    Motorcycle::new(parameters, &Input::default()).unwrap()
}

/// The default motorcycle, rolling at a speed \[m/s\].
pub fn at_speed(speed: f64) -> Parameters {
    let mut parameters = Parameters::default();
    parameters.run.initial_speed = speed;
    parameters
}

/// The throttle that brings a motorcycle to a speed \[m/s\] and keeps it there.
pub fn cruise(motorcycle: &Motorcycle, speed: f64) -> f64 {
    let p = motorcycle.parameters().longitudinal;
    let needed = 0.5 * p.air_density * p.drag_area * speed * speed + 50.0;
    let available = p.drive_force.min(p.power / speed.max(1.0));
    (needed + 500.0 * (speed - motorcycle.output().speed)) / available
}
