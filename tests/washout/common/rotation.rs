//! Rotations written out axis by axis in plain arrays.

pub type Vec3 = [f64; 3];

pub fn rotate_x(angle: f64, [x, y, z]: Vec3) -> Vec3 {
    let (s, c) = angle.sin_cos();
    [x, c * y - s * z, s * y + c * z]
}

pub fn rotate_y(angle: f64, [x, y, z]: Vec3) -> Vec3 {
    let (s, c) = angle.sin_cos();
    [c * x + s * z, y, c * z - s * x]
}

pub fn rotate_z(angle: f64, [x, y, z]: Vec3) -> Vec3 {
    let (s, c) = angle.sin_cos();
    [c * x - s * y, s * x + c * y, z]
}

/// From the platform's axes to the base's: roll first, then pitch, then yaw,
/// each about a fixed axis.
pub fn to_base([roll, pitch, yaw]: Vec3, v: Vec3) -> Vec3 {
    rotate_z(yaw, rotate_y(pitch, rotate_x(roll, v)))
}

/// The inverse of [`to_base`].
pub fn to_platform([roll, pitch, yaw]: Vec3, v: Vec3) -> Vec3 {
    rotate_x(-roll, rotate_y(-pitch, rotate_z(-yaw, v)))
}

/// The angular velocity, in the base's axes, of a frame that turns from angles `before` to angles
/// `after` within `duration`. The turn must be small: it is the vector of the skew part of
/// R(after) R(before)^T.
pub fn turn(before: Vec3, after: Vec3, duration: f64) -> Vec3 {
    let turned = |axis: Vec3| to_base(after, to_platform(before, axis));
    let (x, y, z) = (turned([1.0, 0.0, 0.0]), turned([0.0, 1.0, 0.0]), turned([0.0, 0.0, 1.0]));
    [y[2] - z[1], z[0] - x[2], x[1] - y[0]].map(|twice| twice / (2.0 * duration))
}
