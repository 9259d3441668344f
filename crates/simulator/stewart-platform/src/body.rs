//! The moving masses as one rigid body.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::interface::Masses;

/// A rigid body in the platform frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub centre: Vector3<f64>,
    /// Matrix of inertia about the platform frame's origin \[kg m2\].
    pub inertia: Matrix3<f64>,
}

impl Body {
    /// Platform, rider and payload together.
    pub fn new(masses: &Masses) -> Self {
        let parts = [
            (masses.platform_mass, masses.platform_centre, masses.platform_inertia.matrix()),
            (masses.rider_mass, masses.rider_centre, masses.rider_inertia.matrix()),
            (masses.payload_mass, masses.payload_centre, Matrix3::zeros()),
        ];
        let mass: f64 = parts.iter().map(|(mass, ..)| mass).sum();
        let moment: Vector3<f64> = parts.iter().map(|(mass, centre, _)| *mass * centre).sum();
        // Steiner: each about its own centre, and its mass at its distance from the origin.
        let inertia: Matrix3<f64> = parts
            .iter()
            .map(|(mass, centre, inertia)| {
                inertia + *mass * (centre.norm_squared() * Matrix3::identity() - centre * centre.transpose())
            })
            .sum();
        Body { mass, centre: moment / mass, inertia }
    }
}
