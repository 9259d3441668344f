//! Forward and inverse dynamics: Newton's and Euler's equations for the platform on its
//! legs, at one instant.
//!
//! The legs have no mass, so that each transmits a force along its axis only. The equations are
//!
//! M x'' + c = J^T F, L'' = J x'' + d.
//!
//! - x'' = (p'', alpha): linear acceleration of the platform's origin, and angular acceleration.
//! - F: forces of the legs; L: lengths of the legs; J: Jacobian of the legs.
//! - M: inertia matrix of the body at the origin; c: its weight and its velocity-dependent forces.
//! - d: accelerations of the legs while x'' is zero.
//!
//! With cranks L are the arcs of the arms' ends, and F the forces along them: a torque per arm.

use moris_washout::platform::{Geometry, PlatformMotion, jacobian, leg_accelerations};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::body::Body;

/// The equations at an instant, for given pose and velocities of the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// J: Jacobian of the legs.
    jacobian: Matrix6<f64>,
    /// The inverse of M.
    mobility: Matrix6<f64>,
    /// M: inertia matrix of the body at the origin.
    inertia: Matrix6<f64>,
    /// c: force \[N\] and moment about the platform's origin \[N m\] at zero acceleration.
    bias: Vector6<f64>,
    /// d: accelerations of the legs while x'' is zero \[m/s2\].
    drift: Vector6<f64>,
}

impl Dynamics {
    /// The equations for a motion's pose and velocities. Its accelerations are ignored. `gravity`
    /// is the downward acceleration \[m/s2\].
    pub fn new(geometry: &Geometry, body: &Body, motion: &PlatformMotion, gravity: f64) -> Self {
        let rotation = motion.orientation.rotation;
        let arm = rotation * body.centre;
        let about_origin = rotation * body.inertia * rotation.transpose();
        let omega = motion.angular_velocity;
        let weight = Vector3::new(0.0, 0.0, body.mass * gravity);
        let force = body.mass * omega.cross(&omega.cross(&arm)) + weight;
        let moment = omega.cross(&(about_origin * omega)) + arm.cross(&weight);
        let inertia = spatial_inertia(body.mass, arm, about_origin);
        let unaccelerated =
            PlatformMotion { acceleration: Vector3::zeros(), angular_acceleration: Vector3::zeros(), ..*motion };
        Dynamics {
            jacobian: jacobian(geometry, &motion.pose()),
            // The matrix of a body with mass and extent is invertible. Other
            // parameters are refused.
            mobility: inertia.try_inverse().unwrap_or_else(Matrix6::zeros),
            inertia,
            bias: stacked_vectors(force, moment),
            drift: Vector6::from(leg_accelerations(geometry, &unaccelerated)),
        }
    }

    /// The legs' forces \[N\] for these accelerations of the legs \[m/s2\]: inverse dynamics.
    pub fn forces(&self, leg_accelerations: &Vector6<f64>) -> Vector6<f64> {
        // Rigs are checked to have no singularities, so that J is invertible in every
        // pose within the stroke.
        let acceleration = self.jacobian.lu().solve(&(leg_accelerations - self.drift)).unwrap_or_else(Vector6::zeros);
        let wrench = self.inertia * acceleration + self.bias;
        self.jacobian.transpose().lu().solve(&wrench).unwrap_or_else(Vector6::zeros)
    }

    /// The platform's acceleration (p'', alpha) under these forces of the legs: forward dynamics.
    pub fn acceleration(&self, forces: &Vector6<f64>) -> Vector6<f64> {
        self.mobility * (self.jacobian.tr_mul(forces) - self.bias)
    }

    /// The legs' accelerations under these forces \[m/s2\].
    pub fn leg_accelerations(&self, forces: &Vector6<f64>) -> Vector6<f64> {
        self.jacobian * self.acceleration(forces) + self.drift
    }

    /// J M^-1 J^T: acceleration of each leg per force of each leg \[1/kg\]. The matrix is symmetric
    /// and positive definite.
    pub fn leg_mobility(&self) -> Matrix6<f64> {
        self.jacobian * self.mobility * self.jacobian.transpose()
    }
}

/// M: force and moment at the platform's origin per unit of its acceleration. The centre of mass is
/// at `arm` from the origin.
fn spatial_inertia(mass: f64, arm: Vector3<f64>, about_origin: Matrix3<f64>) -> Matrix6<f64> {
    let moment = mass * arm.cross_matrix();
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&(mass * Matrix3::identity()));
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&-moment);
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&moment);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&about_origin);
    matrix
}

/// Two vectors as one.
fn stacked_vectors(linear: Vector3<f64>, angular: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
