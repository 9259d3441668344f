//! From the legs' forces to the platform's acceleration, and back: Newton's and Euler's equations
//! at one instant.
//!
//! The legs have no mass, so that each pushes along itself and nothing else. With x'' = (p'',
//! alpha) the acceleration of the platform's origin and F the legs' forces, M x'' + c = J^T F: M is
//! the body's matrix of inertia at the origin, c its weight and what turning adds, J the Jacobian
//! of the legs. The legs accelerate by L'' = J x'' + d.

use moris_washout::platform::{Geometry, PlatformMotion, jacobian, leg_accelerations};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::body::Body;

/// The equations at an instant: with the platform where it is and as fast as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// J.
    jacobian: Matrix6<f64>,
    /// The inverse of M.
    mobility: Matrix6<f64>,
    /// M.
    inertia: Matrix6<f64>,
    /// c: force \[N\] and moment about the platform's origin \[N m\] that no acceleration takes.
    bias: Vector6<f64>,
    /// d: accelerations of the legs while x'' is zero \[m/s2\].
    drift: Vector6<f64>,
}

impl Dynamics {
    /// For a motion's pose and velocities; its accelerations do not count. `gravity` points down
    /// \[m/s2\].
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
            // A body with mass and extent has an inverse; parameters without are refused.
            mobility: inertia.try_inverse().unwrap_or_else(Matrix6::zeros),
            inertia,
            bias: stacked(force, moment),
            drift: Vector6::from(leg_accelerations(geometry, &unaccelerated)),
        }
    }

    /// The legs' forces \[N\] that accelerate them so \[m/s2\]: inverse dynamics.
    pub fn forces(&self, leg_accelerations: &Vector6<f64>) -> Vector6<f64> {
        // Rigs are checked to be free of singularities, so that J has an inverse wherever the legs can be.
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

    /// J M^-1 J^T: how much each leg accelerates for a force of each \[1/kg\]; symmetric and
    /// positive definite.
    pub fn leg_mobility(&self) -> Matrix6<f64> {
        self.jacobian * self.mobility * self.jacobian.transpose()
    }
}

/// M: what force and moment at the platform's origin accelerating it takes, with the centre of mass
/// at `arm` from it.
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
fn stacked(linear: Vector3<f64>, angular: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
