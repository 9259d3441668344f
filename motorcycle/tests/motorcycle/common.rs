//! What several tests need.

use moris_motorcycle::whipple::{Bicycle, Body, Wheel};

/// The benchmark bicycle of Meijaard et al. (2007), table 1.
pub fn benchmark() -> Bicycle {
    Bicycle {
        w: 1.02,
        c: 0.08,
        lambda: std::f64::consts::PI / 10.0,
        r: Wheel { r: 0.3, m: 2.0, xx: 0.0603, yy: 0.12 },
        b: Body { x: 0.3, z: -0.9, m: 85.0, xx: 9.2, xz: 2.4, zz: 2.8 },
        h: Body { x: 0.9, z: -0.7, m: 4.0, xx: 0.05892, xz: -0.00756, zz: 0.00708 },
        f: Wheel { r: 0.35, m: 3.0, xx: 0.1405, yy: 0.28 },
    }
}

/// Gravity of the benchmark \[m/s2\].
pub const GRAVITY: f64 = 9.81;

/// Asserts that two numbers differ by no more than `tolerance`, relative where they are larger than 1.
#[track_caller]
pub fn assert_near(number: f64, expected: f64, tolerance: f64, what: &str) {
    let off = (number - expected).abs() / expected.abs().max(1.0);
    assert!(off <= tolerance, "{what}: {number} instead of {expected}, off by {off:e}");
}
