//! The platform's Jacobian: how the legs' rates follow from the platform's velocity.

use nalgebra::{Matrix6, Vector6};

use super::{Geometry, Pose};

/// A row for each leg; columns: velocity x, y, z \[m/s\], angular velocity x, y, z \[rad/s\], in the base frame.
pub type Jacobian = Matrix6<f64>;

/// The Jacobian in a pose: row i is (n_i, R a_i x n_i), with n_i the direction of leg i.
pub fn jacobian(geometry: &Geometry, pose: &Pose) -> Jacobian {
    let Geometry { base, platform } = geometry;
    let (arm, p) = (platform.turned(&pose.orientation.rotation), pose.position);
    let mut columns = [[0.0; 6]; 6];
    // Written out and not in vectors, so that the processor does two legs at a time.
    for i in 0..6 {
        let (x, y, z) = (p.x + arm.x[i] - base.x[i], p.y + arm.y[i] - base.y[i], p.z + arm.z[i] - base.z[i]);
        let length = (x * x + y * y + z * z).sqrt();
        let (x, y, z) = (x / length, y / length, z / length);
        columns[0][i] = x;
        columns[1][i] = y;
        columns[2][i] = z;
        columns[3][i] = arm.y[i] * z - arm.z[i] * y;
        columns[4][i] = arm.z[i] * x - arm.x[i] * z;
        columns[5][i] = arm.x[i] * y - arm.y[i] * x;
    }
    Matrix6::from_columns(&columns.map(Vector6::from))
}
