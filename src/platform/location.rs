//! Where the washout location is on the platform: the rider's head with the rider's lean, eq.
//! (4), or another point.

use alloc::format;

use moris_interface::{ParameterError, Shown, refuse};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::interface::{StructureParameters, WashoutLocation};

/// The washout location and the axes of the frame there, seen from the platform.
///
/// ```
/// use moris_washout::Parameters;
/// use moris_washout::nalgebra::Vector3;
/// use moris_washout::platform::LocationFrame;
///
/// // A rider who leans to the right by 0.3 rad: the head moves to the right, which is -y.
/// let head = LocationFrame::new(&Parameters::default().structure, 0.3);
/// assert!(head.point.y < 0.0);
/// // In the head's axes, gravity at rest pulls to the head's right as well.
/// assert!(head.to_location_axes(Vector3::new(0.0, 0.0, -9.80665)).y < 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LocationFrame {
    /// The location in the platform frame \[m\].
    pub point: Vector3<f64>,
    /// Roll of the frame at the location relative to the platform: the rider's lean, or 0 where
    /// no rider leans \[rad\].
    pub lean: f64,
    sin_lean: f64,
    cos_lean: f64,
}

impl LocationFrame {
    /// The washout location with the rider leaning by `lean` \[rad\].
    ///
    /// Eq. (4) as corrected: p_h^P = (0, -b sin(lean), (h - b) + b cos(lean)), so that an upright
    /// rider's head is above the platform's origin. The lean moves only the head: the other
    /// locations are points of the platform.
    pub fn new(structure: &StructureParameters, lean: f64) -> Self {
        match structure.washout_location {
            WashoutLocation::Head => LocationFrame::leaning(structure.head_height, structure.torso_length, lean),
            WashoutLocation::Platform => LocationFrame::fixed(Vector3::zeros()),
            WashoutLocation::Custom => LocationFrame::fixed(structure.washout_point),
        }
    }

    /// The head of a rider who leans by `lean` \[rad\] about the seat, `torso` below the upright
    /// head at `height` \[m\].
    pub fn leaning(height: f64, torso: f64, lean: f64) -> Self {
        // The rider sits upright for most of the time.
        let (sin_lean, cos_lean) = if lean == 0.0 { (lean, 1.0) } else { libm::sincos(lean) };
        let point = Vector3::new(0.0, -torso * sin_lean, height - torso + torso * cos_lean);
        LocationFrame { point, lean, sin_lean, cos_lean }
    }

    /// A point of the platform.
    pub fn fixed(point: Vector3<f64>) -> Self {
        LocationFrame { point, lean: 0.0, sin_lean: 0.0, cos_lean: 1.0 }
    }

    /// A vector in the axes of the frame at the location, R_H^P v with R_H^P = Rx(lean),
    /// in the platform's axes.
    pub fn to_platform_axes(&self, v: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(v.x, self.cos_lean * v.y - self.sin_lean * v.z, self.sin_lean * v.y + self.cos_lean * v.z)
    }

    /// The inverse of [`LocationFrame::to_platform_axes`].
    pub fn to_location_axes(&self, v: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(v.x, self.cos_lean * v.y + self.sin_lean * v.z, self.cos_lean * v.z - self.sin_lean * v.y)
    }
}

/// Checks that the seat, a torso's length below the head \[m\], is not below the ground, whose name
/// the message gives.
///
/// # Errors
/// The torso is longer than the head is high.
pub fn check_torso(torso_length: f64, head_height: f64, ground: &str) -> Result<(), ParameterError> {
    if torso_length <= head_height {
        return Ok(());
    }
    refuse(
        "head.torsoLength",
        format!(
            "is {} m, which puts the seat below the {ground}; it must not exceed head.height, {} m",
            Shown(torso_length),
            Shown(head_height)
        ),
    )
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;

    /// The frame turns by the lean about x; the head is a torso's length along its z from the seat.
    #[test]
    fn the_head_leans_about_the_seat() {
        let (height, torso) = (1.2, 0.7);
        for lean in [-0.5, -0.01, 0.0, 0.2, 1.0] {
            let frame = LocationFrame::leaning(height, torso, lean);
            let rotation = Rotation3::from_axis_angle(&Vector3::x_axis(), lean);
            let expected = Vector3::new(0.0, 0.0, height - torso) + rotation * Vector3::new(0.0, 0.0, torso);
            assert!((frame.point - expected).amax() < 1e-15 && frame.lean == lean, "{frame:?}");
            for v in [Vector3::x(), Vector3::y(), Vector3::z(), Vector3::new(0.3, -2.0, 9.0)] {
                assert!((frame.to_platform_axes(v) - rotation * v).amax() < 1e-14);
                assert!((frame.to_location_axes(v) - rotation.inverse() * v).amax() < 1e-14);
            }
        }
    }

    #[test]
    fn only_a_head_leans() {
        let with = |washout_location| {
            let structure = StructureParameters { washout_location, ..crate::Parameters::default().structure };
            (LocationFrame::new(&structure, 0.3), structure)
        };
        let (head, structure) = with(WashoutLocation::Head);
        assert_eq!(head, LocationFrame::leaning(structure.head_height, structure.torso_length, 0.3));
        let v = Vector3::new(1.0, 2.0, 3.0);
        let (platform, _) = with(WashoutLocation::Platform);
        let (custom, structure) = with(WashoutLocation::Custom);
        for (frame, point) in [(platform, Vector3::zeros()), (custom, structure.washout_point)] {
            assert_eq!((frame.point, frame.lean), (point, 0.0));
            assert_eq!((frame.to_platform_axes(v), frame.to_location_axes(v)), (v, v));
        }
    }

    #[test]
    fn a_seat_below_the_ground_is_refused() {
        assert!(check_torso(1.2, 1.2, "platform").is_ok() && check_torso(0.5, 1.2, "platform").is_ok());
        let error = check_torso(1.3, 1.2, "platform").unwrap_err();
        assert_eq!(error.variable, "head.torsoLength");
        assert!(error.reason.contains("1.3 m") && error.reason.contains("1.2 m") && error.reason.contains("platform"));
    }
}
