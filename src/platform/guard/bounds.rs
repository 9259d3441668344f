//! Bounds on the derivatives of a leg's length, from bounds on the platform's coordinates.
//!
//! The vector of a leg from joint to joint is g = p + R a - b, its length L = |g|, and r = |a|. The
//! bounds hold on a piece on which all coordinates have a steady acceleration. There, v and s are
//! the largest linear speed and acceleration. W and e are the largest sums of the magnitudes of the
//! angles' rates and accelerations. Then
//!
//! |g'| <= G1 = v + W r, |g''| <= G2 = s + (W² + e) r, |g'''| <= G3 = (W³ + 3 W e) r.
//!
//! Each angle's rotation has derivatives of norm at most 1, and R is the product of three such
//! rotations. The products' terms therefore add up to the powers of W. With n = g/L and g'⊥ the
//! part of g' across n, L L' = g·g' gives
//!
//! L'' = n·g'' + |g'⊥|²/L, L''' = 3 (g'⊥·g''⊥ - L' |g'⊥|²/L)/L + n·g'''.
//!
//! With k = 2/(3 √3), the largest value of x (1 - x²) for x from 0 to 1, it follows that
//!
//! |L'| <= G1, |L''| <= G2 + G1²/L, |L'''| <= 3 G1 (G2 + k G1²/L)/L + G3.

/// Largest value of x (1 - x²).
const LARGEST_PRODUCT: f64 = 0.384_900_179_459_750_5;

/// Bounds on the first three derivatives of the vector from a base joint to its platform
/// joint, over one piece.
#[derive(Clone, Copy, Debug)]
pub struct JointBounds {
    /// G1 \[m/s\].
    pub velocity: f64,
    /// G2 \[m/s2\].
    pub acceleration: f64,
    /// G3 \[m/s3\].
    pub jerk: f64,
}

impl JointBounds {
    /// From the largest speeds (v \[m/s\], W \[rad/s\]) and accelerations (s
    /// \[m/s2\], e \[rad/s2\]) of the piece; no joint is farther than `radius` \[m\]
    /// from the platform's origin.
    pub fn new([v, w]: [f64; 2], [s, e]: [f64; 2], radius: f64) -> Self {
        JointBounds {
            velocity: v + w * radius,
            acceleration: s + (w * w + e) * radius,
            jerk: w * (w * w + 3.0 * e) * radius,
        }
    }

    /// Bound on |L'''| where no leg is shorter than `length` \[m/s3\].
    pub fn leg_jerk(&self, length: f64) -> f64 {
        let turning = LARGEST_PRODUCT * self.velocity * self.velocity / length;
        3.0 * self.velocity * (self.acceleration + turning) / length + self.jerk
    }
}
