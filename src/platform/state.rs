//! The platform's state, whole: what follows from its coordinates is computed in one place.

use serde::{Deserialize, Serialize};

use super::{Geometry, Legs, PlatformCoordinates, PlatformMotion, inverse_kinematics};
use crate::motion::orientation::RotationalMotion;

/// Coordinates of the platform, the same as a motion in the base frame, and its legs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlatformState {
    pub coordinates: PlatformCoordinates,
    pub motion: PlatformMotion,
    pub legs: Legs,
}

impl PlatformState {
    /// The state with these coordinates.
    pub fn new(coordinates: PlatformCoordinates, geometry: &Geometry, neutral_height: f64) -> Self {
        Self::turning(coordinates, &RotationalMotion::new(&coordinates.angles), geometry, neutral_height)
    }

    /// As [`PlatformState::new`], where it is known how the angles turn the platform.
    #[inline]
    pub fn turning(
        coordinates: PlatformCoordinates,
        turning: &RotationalMotion,
        geometry: &Geometry,
        neutral_height: f64,
    ) -> Self {
        let motion = PlatformMotion::new(&coordinates.linear, turning, neutral_height);
        PlatformState { coordinates, motion, legs: inverse_kinematics(geometry, &motion) }
    }
}
