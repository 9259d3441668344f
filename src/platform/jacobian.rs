//! The platform's Jacobian: how the legs' rates follow from the platform's velocity.

use nalgebra::Matrix6;

use super::inverse::leg;
use super::{Geometry, Pose};

/// A row for each leg; columns: velocity x, y, z \[m/s\], angular velocity x, y, z \[rad/s\], in the base frame.
pub type Jacobian = Matrix6<f64>;

/// The Jacobian in a pose: row i is (n_i, R a_i x n_i), with n_i the direction of leg i.
pub fn jacobian(geometry: &Geometry, pose: &Pose) -> Jacobian {
    let mut matrix = Matrix6::zeros();
    for i in 0..6 {
        let direction = leg(geometry, pose, i).normalize();
        let moment = (pose.orientation.rotation * geometry.platform.joint(i)).cross(&direction);
        matrix.fixed_view_mut::<1, 3>(i, 0).copy_from(&direction.transpose());
        matrix.fixed_view_mut::<1, 3>(i, 3).copy_from(&moment.transpose());
    }
    matrix
}
