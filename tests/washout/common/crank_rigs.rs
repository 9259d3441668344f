//! Rigs with cranks, from measures of published machines.

use moris_washout::platform::reach::{Axis, single_axis_range};
use moris_washout::{Parameters, Rig};
use nalgebra::Vector3;

/// A simulator that carries a person: arms of 184 mm, from a published machine's measures.
pub fn person() -> Rig {
    let base = [[0.2032, 0.351_953], [0.4064, 0.0], [0.2032, -0.351_953]];
    let platform = [[0.306_456, 0.257_147], [0.375_924, 0.136_825], [0.069_468, -0.393_972]];
    symmetric(base, platform, [150.0, -90.0, 30.0, 150.0, -90.0, 30.0], [0.648_134, 0.184_15, 0.7239], 60.0)
}

/// A model with servos: arms of 15 mm.
pub fn hobby() -> Rig {
    let base = [[0.046_391, 0.061_450], [0.076_413, 0.009_451], [0.030_021, -0.070_901]];
    let platform = [[0.010_006, 0.048_789], [0.047_256, -0.015_729], [0.037_250, -0.033_060]];
    symmetric(base, platform, [-60.0, 120.0, 180.0, 0.0, 60.0, -120.0], [0.132_943_591_247_488, 0.015, 0.14], 80.0)
}

/// A rig whose joints 6, 5 and 4 are the mirror images of these three in the y axis.
fn symmetric(base: [[f64; 2]; 3], platform: [[f64; 2]; 3], headings: [f64; 6], sizes: [f64; 3], degrees: f64) -> Rig {
    let joints = |half: [[f64; 2]; 3]| {
        std::array::from_fn(|i| {
            let [x, y] = half[i.min(5 - i)];
            Vector3::new(if i < 3 { x } else { -x }, y, 0.0)
        })
    };
    let [neutral_height, crank_arm, crank_rod] = sizes;
    Rig {
        base: joints(base),
        platform: joints(platform),
        neutral_height,
        crank_arm,
        crank_rod,
        crank_heading: headings.map(f64::to_radians),
        crank_min_angle: -degrees.to_radians(),
        crank_max_angle: degrees.to_radians(),
        velocity_limit: 6.0 * crank_arm,
        acceleration_limit: 60.0 * crank_arm,
        ..Rig::default()
    }
}

/// Parameters on a rig; the safety limits are 95 % of what it reaches along an axis.
pub fn on(rig: Rig) -> Parameters {
    let reach = [Axis::Surge, Axis::Sway, Axis::Heave].map(|axis| 0.95 * single_axis_range(&rig, axis).min_reach());
    let mut parameters = Parameters { rig, ..Parameters::default() };
    parameters.safety.position_limit = Vector3::from(reach).map(|reach| reach.max(1e-9));
    parameters
}
