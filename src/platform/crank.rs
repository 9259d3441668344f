//! Cranks: six motors, each with an arm and a rod to a joint of the platform.
//!
//! Crank i turns about a horizontal axle through the base joint b. Its arm of length a moves in the
//! vertical plane of its heading u; w is the vertical. A rod of length s leads from the arm's end
//! to the platform joint. With l = p + R a_i - b, the vector from axle to platform joint,
//!
//! ```text
//!     e = 2 a l·w     f = 2 a l·u     g = |l|² + a² - s²     r = sqrt(e² + f² - g²)
//!     A = atan2(e g - f r, f g + e r)                        angle of the arm, 0 along u, positive up
//!     o = u cos A + w sin A     t = -u sin A + w cos A       direction of the arm, its tangent
//!     n = (l - a o)/s           k = n·t = r/(2 a s)          direction of the rod, transmission
//! ```
//!
//! The coordinate of the actuator is the arc q = a A of the arm's end \[m\], in the place of a
//! leg's length. With the velocity V and the acceleration C of the platform joint,
//!
//! ```text
//!     q' = n·V/k     q'' = (n·C + (n·o) q'²/a + |V - t q'|²/s)/k
//! ```
//!
//! At k = 0 the crank is at a dead centre: there another branch of angles begins, and beyond it the
//! rod does not reach. A machine keeps k at least at its limit, so the branch never changes.
//!
//! From half the limit on, angles go on along a line in g/sqrt(e² + f²), with the rates
//! of that half. So every pose has finite numbers, and a demand or a plan beyond the
//! reach finds its way back.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

use nalgebra::{Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::inverse::{LegMotion, Legs};
use super::{Geometry, Jacobian, Joints, PlatformMotion, Pose};
use crate::interface::Rig;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;

/// Fraction of the smallest transmission that is allowed, below which angles go on along a line.
const REGULAR_PART: f64 = 0.5;

/// The six cranks of a rig: their arms, rods and headings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cranks {
    /// Length of an arm, from the axle to the rod \[m\].
    pub arm: f64,
    /// Length of a rod \[m\].
    pub rod: f64,
    /// Smallest transmission that is allowed: the component of a rod's direction along the
    /// tangent at its arm's end.
    pub least_transmission: f64,
    /// Cosines and sines of the headings.
    heading: [[f64; 6]; 2],
}

/// The six arms with their rods in a pose. So laid out, the processor does two at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arms {
    /// From the axles to the platform's joints \[m\].
    joint: Joints,
    /// e, f and g of the closed form \[m2\].
    e: [f64; 6],
    f: [f64; 6],
    pub(crate) g: [f64; 6],
    /// Cosines and sines of the arms' angles.
    cos: [f64; 6],
    sin: [f64; 6],
    /// Transmissions, not negative.
    pub(crate) transmission: [f64; 6],
    /// The same, or what stands for a smaller one as a divisor.
    divisor: [f64; 6],
    /// Angles beyond those of the arms, where the transmission is smaller than the divisor \[rad\].
    beyond: [f64; 6],
}

/// Squares of the joints' distances between two poses, and of their parts in the cranks'
/// planes \[m2\].
pub(crate) struct Chords {
    pub(crate) squares: [f64; 6],
    pub(crate) in_plane: [f64; 6],
}

impl Arms {
    /// Angles of the arms above their headings \[rad\].
    #[inline]
    pub(crate) fn angles(&self) -> [f64; 6] {
        let mut angles = [0.0; 6];
        for (i, angle) in angles.iter_mut().enumerate() {
            *angle = angle_of(self.sin[i], self.cos[i]) + self.beyond[i];
        }
        angles
    }

    /// The squares of distances by which joint `i` is clear of where arms at these lowest and
    /// highest angles, given by cosine and sine, would have it \[m2\].
    ///
    /// An arm at the angle B with its end b has |l - b|² - s² = g - f cos B - e sin B. The
    /// difference is negative for B between the arm's angle and that of the other branch.
    #[inline(always)]
    pub(crate) fn clear_of(&self, i: usize, [lowest, highest]: &[[f64; 2]; 2]) -> [f64; 2] {
        let (e, f, g) = (self.e[i], self.f[i], self.g[i]);
        [g - f * lowest[0] - e * lowest[1], f * highest[0] + e * highest[1] - g]
    }

    /// The smallest transmission of the six.
    #[inline(always)]
    pub(crate) fn least_transmission(&self) -> f64 {
        let [a, b, c, d, e, f] = self.transmission;
        min(min(min(a, c), e), min(min(b, d), f))
    }
}

impl Cranks {
    /// The cranks of a rig; none for one with legs.
    pub fn of(rig: &Rig) -> Option<Self> {
        let Rig { crank_arm: arm, crank_rod: rod, crank_least_transmission: least_transmission, .. } = *rig;
        let heading = [rig.crank_heading.map(libm::cos), rig.crank_heading.map(libm::sin)];
        rig.has_cranks().then_some(Cranks { arm, rod, least_transmission, heading })
    }

    /// The arms in a pose. `turned` are the platform's joints from its origin, in the base frame.
    #[inline(always)]
    pub(crate) fn arms(&self, base: &Joints, turned: &Joints, position: &Vector3<f64>) -> Arms {
        let Cranks { arm, rod, heading: [ux, uy], least_transmission } = *self;
        let mut arms = Arms {
            joint: Joints::default(),
            e: [0.0; 6],
            f: [0.0; 6],
            g: [0.0; 6],
            cos: [0.0; 6],
            sin: [0.0; 6],
            transmission: [0.0; 6],
            divisor: [0.0; 6],
            beyond: [0.0; 6],
        };
        let mut root = [0.0; 6];
        let (squares, per_root) = (arm * arm - rod * rod, 1.0 / (2.0 * arm * rod));
        for i in 0..6 {
            let x = position.x + turned.x[i] - base.x[i];
            let y = position.y + turned.y[i] - base.y[i];
            let z = position.z + turned.z[i] - base.z[i];
            (arms.joint.x[i], arms.joint.y[i], arms.joint.z[i]) = (x, y, z);
            let (e, f) = (2.0 * arm * z, 2.0 * arm * (x * ux[i] + y * uy[i]));
            let g = x * x + y * y + z * z + squares;
            (arms.e[i], arms.f[i], arms.g[i]) = (e, f, g);
            root[i] = square_root(max(e * e + f * f - g * g, 0.0));
            arms.transmission[i] = root[i] * per_root;
        }
        arms.divisor = arms.transmission;
        let mut g = arms.g;
        let least = REGULAR_PART * least_transmission;
        if arms.least_transmission() < least {
            for i in 0..6 {
                if arms.transmission[i] < least {
                    let of_crank = [arms.e[i], arms.f[i], arms.g[i]];
                    (g[i], root[i], arms.beyond[i]) = beyond_reach(of_crank, least / per_root);
                    arms.divisor[i] = least;
                }
            }
        }
        for i in 0..6 {
            let (e, f) = (arms.e[i], arms.f[i]);
            let per_square = 1.0 / max(e * e + f * f, f64::MIN_POSITIVE);
            arms.sin[i] = (e * g[i] - f * root[i]) * per_square;
            arms.cos[i] = (f * g[i] + e * root[i]) * per_square;
        }
        arms
    }

    /// The joints' distances between these two poses.
    #[inline(always)]
    pub(crate) fn chords(&self, [start, end]: [&Arms; 2]) -> Chords {
        let [ux, uy] = &self.heading;
        let mut chords = Chords { squares: [0.0; 6], in_plane: [0.0; 6] };
        for i in 0..6 {
            let (x, y) = (end.joint.x[i] - start.joint.x[i], end.joint.y[i] - start.joint.y[i]);
            let z = end.joint.z[i] - start.joint.z[i];
            let along = x * ux[i] + y * uy[i];
            chords.squares[i] = x * x + y * y + z * z;
            chords.in_plane[i] = along * along + z * z;
        }
        chords
    }

    /// The arms in a pose.
    pub(crate) fn arms_in(&self, geometry: &Geometry, pose: &Pose) -> Arms {
        self.arms(&geometry.base, &geometry.platform.turned(&pose.orientation.rotation), &pose.position)
    }

    /// The shortest and the longest rod with which crank `i` reaches a joint at
    /// `joint` from its axle \[m\].
    pub(crate) fn reaching_rods(&self, i: usize, joint: &Vector3<f64>) -> [f64; 2] {
        let [cos, sin] = &self.heading;
        let across = joint.y * cos[i] - joint.x * sin[i];
        let in_plane = square_root(max(joint.norm_squared() - across * across, 0.0));
        [in_plane - self.arm, in_plane + self.arm].map(|reach| square_root(reach * reach + across * across))
    }

    /// The smallest transmission of the six in a pose; 0 where a rod does not reach.
    pub(crate) fn transmission(&self, geometry: &Geometry, pose: &Pose) -> f64 {
        self.arms_in(geometry, pose).least_transmission()
    }

    /// Arcs and rates of the arms for a motion of the platform.
    #[inline(never)]
    pub(super) fn inverse(&self, geometry: &Geometry, motion: &PlatformMotion) -> Legs {
        let [ux, uy] = &self.heading;
        let at = geometry.platform.turned(&motion.orientation.rotation);
        let arms = self.arms(&geometry.base, &at, &motion.position);
        let (v, w) = (motion.velocity, motion.angular_velocity);
        let mut legs = Legs::default();
        for i in 0..6 {
            let across = self.arm * arms.cos[i];
            let along = (arms.joint.x[i] - across * ux[i]) * (v.x + (w.y * at.z[i] - w.z * at.y[i]))
                + (arms.joint.y[i] - across * uy[i]) * (v.y + (w.z * at.x[i] - w.x * at.z[i]))
                + (arms.joint.z[i] - self.arm * arms.sin[i]) * (v.z + (w.x * at.y[i] - w.y * at.x[i]));
            legs.velocity[i] = along / (self.rod * arms.divisor[i]);
        }
        legs.position = self.arcs(&arms);
        legs
    }

    /// Arcs, rates and accelerations of the arms for a motion of the platform.
    pub(super) fn motion(&self, geometry: &Geometry, motion: &PlatformMotion) -> LegMotion {
        let at = geometry.platform.turned(&motion.orientation.rotation);
        let arms = self.arms(&geometry.base, &at, &motion.position);
        let [n, _] = self.rows(&arms, &at);
        let [velocity, acceleration] = self.rates(&arms, &at, &n, motion);
        LegMotion { position: self.arcs(&arms), velocity, acceleration, transmission: arms.least_transmission() }
    }

    /// Accelerations of the arms for a motion of the platform, and the Jacobian there.
    pub(super) fn accelerations_with_jacobian(
        &self,
        geometry: &Geometry,
        motion: &PlatformMotion,
    ) -> ([f64; 6], Jacobian) {
        let at = geometry.platform.turned(&motion.orientation.rotation);
        let arms = self.arms(&geometry.base, &at, &motion.position);
        let rows = self.rows(&arms, &at);
        let [_, acceleration] = self.rates(&arms, &at, &rows[0], motion);
        (acceleration, jacobian_of(&rows))
    }

    /// n/k of each crank, and R a_i x n/k.
    #[inline(always)]
    fn rows(&self, arms: &Arms, at: &Joints) -> [Joints; 2] {
        let [ux, uy] = &self.heading;
        let [mut n, mut m] = [Joints::default(); 2];
        for i in 0..6 {
            let (across, per_rod) = (self.arm * arms.cos[i], 1.0 / (self.rod * arms.divisor[i]));
            n.x[i] = (arms.joint.x[i] - across * ux[i]) * per_rod;
            n.y[i] = (arms.joint.y[i] - across * uy[i]) * per_rod;
            n.z[i] = (arms.joint.z[i] - self.arm * arms.sin[i]) * per_rod;
            m.x[i] = at.y[i] * n.z[i] - at.z[i] * n.y[i];
            m.y[i] = at.z[i] * n.x[i] - at.x[i] * n.z[i];
            m.z[i] = at.x[i] * n.y[i] - at.y[i] * n.x[i];
        }
        [n, m]
    }

    /// Rates and accelerations of the arms, from n/k of each.
    #[inline(always)]
    fn rates(&self, arms: &Arms, at: &Joints, n: &Joints, motion: &PlatformMotion) -> [[f64; 6]; 2] {
        let [ux, uy] = &self.heading;
        let PlatformMotion { velocity: v, acceleration: a, .. } = motion;
        let (w, turn) = (motion.angular_velocity, motion.angular_acceleration);
        let (per_arm, per_rod) = (1.0 / self.arm, 1.0 / self.rod);
        let [mut rates, mut accelerations] = [[0.0; 6]; 2];
        // Written out and not in vectors, so that the processor does two cranks at a time.
        for i in 0..6 {
            let (x, y, z) = (at.x[i], at.y[i], at.z[i]);
            // The joint's velocity and acceleration as the platform turns about its origin.
            let (tx, ty, tz) = (w.y * z - w.z * y, w.z * x - w.x * z, w.x * y - w.y * x);
            let (vx, vy, vz) = (v.x + tx, v.y + ty, v.z + tz);
            let bx = a.x + (turn.y * z - turn.z * y) + (w.y * tz - w.z * ty);
            let by = a.y + (turn.z * x - turn.x * z) + (w.z * tx - w.x * tz);
            let bz = a.z + (turn.x * y - turn.y * x) + (w.x * ty - w.y * tx);
            let rate = n.x[i] * vx + n.y[i] * vy + n.z[i] * vz;
            // Of the rod's ends beside each other: V - t q'.
            let (up, back) = (rate * arms.cos[i], rate * arms.sin[i]);
            let (qx, qy, qz) = (vx + back * ux[i], vy + back * uy[i], vz - up);
            let out = n.x[i] * arms.cos[i] * ux[i] + n.y[i] * arms.cos[i] * uy[i] + n.z[i] * arms.sin[i];
            let turning = out * rate * rate * per_arm + (qx * qx + qy * qy + qz * qz) * per_rod / arms.divisor[i];
            rates[i] = rate;
            accelerations[i] = n.x[i] * bx + n.y[i] * by + n.z[i] * bz + turning;
        }
        [rates, accelerations]
    }

    /// Arcs of the arms \[m\].
    pub(crate) fn arcs(&self, arms: &Arms) -> [f64; 6] {
        arms.angles().map(|angle| self.arm * angle)
    }

    /// Arcs of the arms in a pose \[m\], and their Jacobian: row i is (n, R a_i x n)/k.
    pub(super) fn arcs_with_jacobian(&self, geometry: &Geometry, pose: &Pose) -> ([f64; 6], Jacobian) {
        let at = geometry.platform.turned(&pose.orientation.rotation);
        let arms = self.arms(&geometry.base, &at, &pose.position);
        (self.arcs(&arms), jacobian_of(&self.rows(&arms, &at)))
    }

    /// The rods as legs of a fixed length: their base joints are the ends of the arms at these arcs
    /// \[m\].
    pub(super) fn rods(&self, geometry: &Geometry, arcs: &[f64; 6]) -> Geometry {
        let [cos, sin] = &self.heading;
        let ends: [Vector3<f64>; 6] = core::array::from_fn(|i| {
            let (up, across) = libm::sincos(arcs[i] / self.arm);
            geometry.base.joint(i) + self.arm * Vector3::new(across * cos[i], across * sin[i], up)
        });
        Geometry { base: Joints::from(&ends), cranks: None, ..*geometry }
    }
}

/// The angle from -pi to pi with this sine and cosine \[rad\], as `libm::atan2` has it but for
/// rounding. Without branches, so that the processor does two at a time.
#[inline(always)]
fn angle_of(sin: f64, cos: f64) -> f64 {
    /// Minimax polynomial of the arc tangent up to 7/16, that of `libm`.
    const ARC_TANGENT: [f64; 11] = [
        3.333_333_333_333_293e-1,
        -1.999_999_999_987_648_3e-1,
        1.428_571_427_250_346_6e-1,
        -1.111_111_040_546_235_6e-1,
        9.090_887_133_436_507e-2,
        -7.691_876_205_044_83e-2,
        6.661_073_137_387_531e-2,
        -5.833_570_133_790_573e-2,
        4.976_877_994_615_932e-2,
        -3.653_157_274_421_692e-2,
        1.628_582_011_536_578_2e-2,
    ];
    let (x, y) = (cos.abs(), sin.abs());
    // Beyond half a right angle and a quarter of one, the rest to the right angle or to half of it.
    let (steep, slanted) = (x < (SQRT_2 - 1.0) * y, y > (SQRT_2 - 1.0) * x);
    let across = if steep { -x } else { y - if slanted { x } else { 0.0 } };
    let along = if steep { y } else { x + if slanted { y } else { 0.0 } };
    let base = if steep { FRAC_PI_2 } else { if slanted { FRAC_PI_4 } else { 0.0 } };
    let tangent = across / max(along, f64::MIN_POSITIVE);
    let square = tangent * tangent;
    let mut series = 0.0;
    for coefficient in ARC_TANGENT.iter().rev() {
        series = (series + coefficient) * square;
    }
    let angle = base + (tangent - tangent * series);
    (if cos < 0.0 { PI - angle } else { angle }).copysign(sin)
}

/// The Jacobian of these rows.
#[inline(always)]
fn jacobian_of([n, m]: &[Joints; 2]) -> Jacobian {
    Matrix6::from_columns(&[n.x, n.y, n.z, m.x, m.y, m.z].map(Vector6::from))
}

/// From e, f and g of a crank whose root is smaller than `least`: the g and the root that stand for
/// them, and the angle beyond \[rad\].
#[cold]
fn beyond_reach([e, f, g]: [f64; 3], least: f64) -> (f64, f64, f64) {
    let square = max(e * e + f * f, f64::MIN_POSITIVE);
    let root = min(least, square_root(square));
    let kept = square_root(max(square - root * root, 0.0)).copysign(g);
    (kept, root, (g - kept) / root)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_arc_tangent() {
        let turns = (-4000..=4000).map(|k| f64::from(k) * PI / 4000.0);
        let edges = [0.0, -0.0, 1e-300, FRAC_PI_4, FRAC_PI_2, 0.5 * FRAC_PI_4, 1.5 * FRAC_PI_4, PI];
        for angle in turns.chain(edges) {
            let (sin, cos) = libm::sincos(angle);
            let (found, expected) = (angle_of(sin, cos), libm::atan2(sin, cos));
            assert!((found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs(), "{found}, not {expected}");
        }
        assert_eq!(angle_of(0.0, 0.0), 0.0);
    }
}
