//! The platform's Jacobian, from the platform's velocity to the rates of legs or cranks.

use nalgebra::{Matrix6, Vector6};

use super::{Geometry, Joints, PlatformMotion, Pose, leg_accelerations, leg_lengths};
use crate::motion::square_root::square_root;

/// The Jacobian, with a row for each leg. Its columns are the velocity x, y, z \[m/s\] and the
/// angular velocity x, y, z \[rad/s\], in the base frame.
pub type Jacobian = Matrix6<f64>;

/// The Jacobian in a pose. Row i is (n_i, R a_i x n_i), with n_i the direction of leg i. With
/// cranks, n_i is the direction of the rod, and the row is divided by the transmission.
///
/// ```
/// use moris_washout::Rig;
/// use moris_washout::nalgebra::Vector6;
/// use moris_washout::platform::{Geometry, Pose, jacobian};
///
/// let rig = Rig::default();
/// let jacobian = jacobian(&Geometry::from(&rig), &Pose::neutral(&rig));
/// // The force that holds 500 kg at neutral, shared by the six legs: their axial forces add up to it.
/// let weight = Vector6::new(0.0, 0.0, 500.0 * 9.80665, 0.0, 0.0, 0.0);
/// let forces = jacobian.transpose().lu().solve(&weight).expect("not singular");
/// assert!((forces.dot(&jacobian.column(2)) - weight[2]).abs() < 1e-6);
/// ```
pub fn jacobian(geometry: &Geometry, pose: &Pose) -> Jacobian {
    let Geometry { base, platform, cranks } = geometry;
    if let Some(cranks) = cranks {
        return cranks.arcs_with_jacobian(geometry, pose).1;
    }
    let (arm, p) = (platform.turned(&pose.orientation.rotation), pose.position);
    // The directions of the legs, and their moments about the platform's origin.
    let [mut n, mut m] = [Joints::default(); 2];
    // Written out and not in vectors, so that the processor does two legs at a time.
    for i in 0..6 {
        let (x, y, z) = (p.x + arm.x[i] - base.x[i], p.y + arm.y[i] - base.y[i], p.z + arm.z[i] - base.z[i]);
        let length = square_root(x * x + y * y + z * z);
        (n.x[i], n.y[i], n.z[i]) = (x / length, y / length, z / length);
        m.x[i] = arm.y[i] * n.z[i] - arm.z[i] * n.y[i];
        m.y[i] = arm.z[i] * n.x[i] - arm.x[i] * n.z[i];
        m.z[i] = arm.x[i] * n.y[i] - arm.y[i] * n.x[i];
    }
    Matrix6::from_columns(&[n.x, n.y, n.z, m.x, m.y, m.z].map(Vector6::from))
}

/// Lengths of the legs, or arcs of the cranks, in a pose \[m\], and the Jacobian there.
pub(crate) fn lengths_with_jacobian(geometry: &Geometry, pose: &Pose) -> ([f64; 6], Jacobian) {
    match &geometry.cranks {
        None => (leg_lengths(geometry, pose), jacobian(geometry, pose)),
        Some(cranks) => cranks.arcs_with_jacobian(geometry, pose),
    }
}

/// Accelerations of legs or cranks for a motion of the platform \[m/s2\], and the Jacobian there.
pub(crate) fn accelerations_with_jacobian(geometry: &Geometry, motion: &PlatformMotion) -> ([f64; 6], Jacobian) {
    match &geometry.cranks {
        None => (leg_accelerations(geometry, motion), jacobian(geometry, &motion.pose())),
        Some(cranks) => cranks.accelerations_with_jacobian(geometry, motion),
    }
}
