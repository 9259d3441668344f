//! Equation (8) where an angle is limited.

use moris_washout::cueing::gravitational::tilt_target;
use nalgebra::Vector3;

use crate::common::G;
use crate::common::rotation::to_platform;

const LIMIT: f64 = 0.4;

#[test]
fn a_limited_pitch_leaves_the_roll_right_for_the_gravity_that_it_leaves() {
    // 8 m/s2 ask for 0.95 rad of pitch.
    for (surge, sway, lean) in [(8.0, 2.0, 0.0), (-8.0, 1.0, 0.1), (9.0, -1.5, -0.2), (12.0, 0.7, 0.0)] {
        let (tilt, limited) = tilt_target(Vector3::new(surge, sway, 0.0), G, lean, LIMIT);
        assert!(limited);
        assert_eq!(tilt.pitch, -LIMIT.copysign(surge));
        // The specific force of rest in the head's axes, which lean beside the platform's roll.
        let [_, felt, _] = to_platform([tilt.roll + lean, tilt.pitch, 0.0], [0.0, 0.0, G]);
        assert!((felt - sway).abs() < 1e-12, "{felt} instead of {sway}");
    }
}

#[test]
fn a_limited_roll_leaves_the_pitch_as_it_is() {
    let (tilt, limited) = tilt_target(Vector3::new(1.0, 6.0, 0.0), G, 0.0, LIMIT);
    assert!(limited);
    assert_eq!((tilt.roll, tilt.pitch), (LIMIT, -(1.0 / G).asin()));
    // The lean is taken off a roll that has been limited, and the rest is limited once more.
    let (tilt, _) = tilt_target(Vector3::new(1.0, 6.0, 0.0), G, -0.3, LIMIT);
    assert_eq!(tilt.roll, LIMIT);
    let (tilt, _) = tilt_target(Vector3::new(1.0, 6.0, 0.0), G, 0.3, LIMIT);
    assert!((tilt.roll - 0.1).abs() < 1e-15, "{}", tilt.roll);
}
