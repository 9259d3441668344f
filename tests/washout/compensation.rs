//! Block (4) against differences of a point's positions on a turning platform.

use moris_washout::cueing::compensation::compensated;
use moris_washout::cueing::gravitational::Tilt;
use moris_washout::interface::Compensation;
use moris_washout::motion::Motion;
use moris_washout::motion::orientation::RotationalMotion;
use nalgebra::Vector3;

use crate::common::G;
use crate::common::rotation::to_base;

const ARM: [f64; 3] = [0.3, -0.2, 1.2];

/// Angles that turn at these rates and change them.
fn turning(rates: Vector3<f64>, accelerations: Vector3<f64>) -> Motion<Vector3<f64>> {
    Motion { position: Vector3::new(0.2, -0.3, 0.5), velocity: rates, acceleration: accelerations }
}

/// The acceleration of the arm's end, by a second difference of its positions.
fn by_differences(angles: &Motion<Vector3<f64>>) -> Vector3<f64> {
    const H: f64 = 1e-4;
    let at = |t: f64| {
        let turned = angles.position + t * angles.velocity + 0.5 * t * t * angles.acceleration;
        Vector3::from(to_base(turned.into(), ARM))
    };
    (at(H) - 2.0 * at(0.0) + at(-H)) / (H * H)
}

fn compensation(item: Compensation, angles: &Motion<Vector3<f64>>) -> Vector3<f64> {
    let turning = RotationalMotion::new(angles);
    let arm = turning.orientation.rotation * Vector3::from(ARM);
    let tilt = Tilt { roll: angles.position.x, pitch: angles.position.y };
    compensated(item, &turning, arm, &tilt, G)
}

#[test]
fn full_compensation_is_the_whole_acceleration_of_turning() {
    let rates = Vector3::new(0.7, -0.4, 0.9);
    for accelerations in [Vector3::zeros(), Vector3::new(-1.1, 2.0, 0.6)] {
        let angles = turning(rates, accelerations);
        let error = compensation(Compensation::Full, &angles) - by_differences(&angles);
        assert!(error.norm() < 1e-6, "{error}");
    }
}

#[test]
fn centripetal_compensation_lacks_the_tangential_term_alone() {
    // About one axis the two are at right angles to each other: towards the axis, and along the circle.
    let angles = turning(Vector3::new(0.0, 0.0, 0.9), Vector3::new(0.0, 0.0, 2.0));
    let whole = by_differences(&angles);
    let centripetal = compensation(Compensation::Centripetal, &angles);
    let arm = RotationalMotion::new(&angles).orientation.rotation * Vector3::from(ARM);
    let outward = Vector3::new(arm.x, arm.y, 0.0).normalize();
    assert!((centripetal - outward * outward.dot(&whole)).norm() < 1e-6, "{centripetal}");
    assert!(centripetal.norm() > 0.1 && (whole - centripetal).norm() > 0.1);
    assert_eq!(compensation(Compensation::None, &angles), Vector3::zeros());
}
