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
    /// Smallest transmission that is allowed, the sine of the transmission angle.
    pub least_transmission: f64,
    /// Cosines and sines of the headings.
    heading: [[f64; 6]; 2],
}

/// The six arms with their rods in a pose. So laid out, the processor does two at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arms {
    /// From the axles to the platform's joints \[m\].
    joint: Joints,
    /// e, f and g of the closed form \[m2\].
    e: [f64; 6],
    f: [f64; 6],
    g: [f64; 6],
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

impl Arms {
    /// Angle of arm `i` above its heading \[rad\].
    pub(crate) fn angle(&self, i: usize) -> f64 {
        libm::atan2(self.sin[i], self.cos[i]) + self.beyond[i]
    }

    /// The smallest squares of distances by which the joints are clear of where arms at these
    /// lowest and highest angles, given by cosine and sine, would have them \[m2\].
    ///
    /// An arm at the angle B with its end b has |l - b|² - s² = g - f cos B - e sin B. The
    /// difference is negative for B between the arm's angle and that of the other branch.
    #[inline(always)]
    pub(crate) fn clear_of(&self, [lowest, highest]: [[f64; 2]; 2]) -> [f64; 2] {
        let [mut below, mut above] = [f64::INFINITY; 2];
        for i in 0..6 {
            let (e, f, g) = (self.e[i], self.f[i], self.g[i]);
            below = min(g - f * lowest[0] - e * lowest[1], below);
            above = min(f * highest[0] + e * highest[1] - g, above);
        }
        [below, above]
    }

    /// The smallest g of the six \[m2\].
    #[inline(always)]
    pub(crate) fn least_g(&self) -> f64 {
        let [a, b, c, d, e, f] = self.g;
        min(min(min(a, c), e), min(min(b, d), f))
    }

    /// The largest distance of a joint from where it is at neutral \[m\].
    #[inline(always)]
    pub(crate) fn farthest_from_neutral(&self, geometry: &Geometry, neutral_height: f64) -> f64 {
        let Geometry { base, platform, .. } = geometry;
        let mut largest = 0.0;
        for i in 0..6 {
            let x = self.joint.x[i] - (platform.x[i] - base.x[i]);
            let y = self.joint.y[i] - (platform.y[i] - base.y[i]);
            let z = self.joint.z[i] - (neutral_height + platform.z[i] - base.z[i]);
            largest = max(x * x + y * y + z * z, largest);
        }
        square_root(largest)
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
        legs.length = self.arcs(&arms);
        legs
    }

    /// Arcs, rates and accelerations of the arms for a motion of the platform.
    pub(super) fn motion(&self, geometry: &Geometry, motion: &PlatformMotion) -> LegMotion {
        let [ux, uy] = &self.heading;
        let turned = geometry.platform.turned(&motion.orientation.rotation);
        let arms = self.arms(&geometry.base, &turned, &motion.position);
        let mut legs = LegMotion { transmission: arms.least_transmission(), ..LegMotion::default() };
        for i in 0..6 {
            let at = turned.joint(i);
            let (sin, cos) = (arms.sin[i], arms.cos[i]);
            let out = Vector3::new(cos * ux[i], cos * uy[i], sin);
            let tangent = Vector3::new(-sin * ux[i], -sin * uy[i], cos);
            let along = (arms.joint.joint(i) - self.arm * out) / self.rod;
            let velocity = motion.velocity + motion.angular_velocity.cross(&at);
            let rate = along.dot(&velocity) / arms.divisor[i];
            let across = velocity - rate * tangent;
            let turning = along.dot(&out) * rate * rate / self.arm + across.norm_squared() / self.rod;
            legs.velocity[i] = rate;
            legs.acceleration[i] = (along.dot(&motion.acceleration_at(at)) + turning) / arms.divisor[i];
        }
        legs.length = self.arcs(&arms);
        legs
    }

    /// Arcs of the arms \[m\].
    pub(crate) fn arcs(&self, arms: &Arms) -> [f64; 6] {
        core::array::from_fn(|i| self.arm * arms.angle(i))
    }

    /// Arcs of the arms in a pose \[m\], and their Jacobian: row i is (n, R a_i x n)/k.
    pub(super) fn arcs_with_jacobian(&self, geometry: &Geometry, pose: &Pose) -> ([f64; 6], Jacobian) {
        let [ux, uy] = &self.heading;
        let at = geometry.platform.turned(&pose.orientation.rotation);
        let arms = self.arms(&geometry.base, &at, &pose.position);
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
        (self.arcs(&arms), Matrix6::from_columns(&[n.x, n.y, n.z, m.x, m.y, m.z].map(Vector6::from)))
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

/// From e, f and g of a crank whose root is smaller than `least`: the g and the root that stand for
/// them, and the angle beyond \[rad\].
#[cold]
fn beyond_reach([e, f, g]: [f64; 3], least: f64) -> (f64, f64, f64) {
    let square = max(e * e + f * f, f64::MIN_POSITIVE);
    let root = min(least, square_root(square));
    let kept = square_root(max(square - root * root, 0.0)).copysign(g);
    (kept, root, (g - kept) / root)
}
