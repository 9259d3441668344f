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

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::inverse::{LegMotion, Legs};
use super::{Geometry, Joints, PlatformMotion, Pose};
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

/// An arm and its rod in a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArmState {
    /// Cosine and sine of the arm's angle.
    cos: f64,
    sin: f64,
    /// Directions of the arm and of the rod, and the tangent of the arm.
    out: Vector3<f64>,
    along: Vector3<f64>,
    tangent: Vector3<f64>,
    /// Transmission, not negative.
    pub(crate) transmission: f64,
    /// The same, or what stands for a smaller one as a divisor.
    divisor: f64,
    /// Angle beyond that of the arm, where the transmission is smaller than the divisor \[rad\].
    beyond: f64,
}

impl ArmState {
    /// Angle of the arm above its heading \[rad\].
    pub(crate) fn angle(&self) -> f64 {
        libm::atan2(self.sin, self.cos) + self.beyond
    }
}

impl Cranks {
    /// The cranks of a rig; none for one with legs.
    pub fn of(rig: &Rig) -> Option<Self> {
        let Rig { crank_arm: arm, crank_rod: rod, crank_least_transmission: least_transmission, .. } = *rig;
        let heading = [rig.crank_heading.map(libm::cos), rig.crank_heading.map(libm::sin)];
        rig.has_cranks().then_some(Cranks { arm, rod, least_transmission, heading })
    }

    /// Crank `i` with its platform joint at `joint` from its axle \[m\].
    #[inline(always)]
    pub(crate) fn arm_state(&self, i: usize, joint: &Vector3<f64>) -> ArmState {
        let Cranks { arm, rod, heading: [cos_heading, sin_heading], .. } = self;
        let (ux, uy) = (cos_heading[i], sin_heading[i]);
        let (e, f) = (2.0 * arm * joint.z, 2.0 * arm * (joint.x * ux + joint.y * uy));
        let g = joint.norm_squared() + arm * arm - rod * rod;
        let square = max(e * e + f * f, f64::MIN_POSITIVE);
        let r = square_root(max(square - g * g, 0.0));
        let per_rod = 1.0 / (2.0 * arm * rod);
        let least = REGULAR_PART * self.least_transmission;
        let (mut c, mut s, mut beyond) = (g, r, 0.0);
        if r * per_rod < least {
            let size = square_root(square);
            s = min(least / per_rod, size);
            c = square_root(max(square - s * s, 0.0)).copysign(g);
            beyond = (g - c) / s;
        }
        let (sin, cos) = ((e * c - f * s) / square, (f * c + e * s) / square);
        let out = Vector3::new(cos * ux, cos * uy, sin);
        ArmState {
            cos,
            sin,
            out,
            along: (joint - *arm * out) / *rod,
            tangent: Vector3::new(-sin * ux, -sin * uy, cos),
            transmission: r * per_rod,
            divisor: max(r * per_rod, least),
            beyond,
        }
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
        (0..6).fold(f64::INFINITY, |least, i| min(self.arm_state(i, &geometry.between(i, pose)).transmission, least))
    }

    /// Arcs and rates of the arms for a motion of the platform.
    #[inline(never)]
    pub(super) fn inverse(&self, geometry: &Geometry, motion: &PlatformMotion) -> Legs {
        let turned = geometry.platform.turned(&motion.orientation.rotation);
        let mut legs = Legs::default();
        for i in 0..6 {
            let at = turned.joint(i);
            let state = self.arm_state(i, &(motion.position + at - geometry.base.joint(i)));
            let velocity = motion.velocity + motion.angular_velocity.cross(&at);
            legs.length[i] = self.arm * state.angle();
            legs.velocity[i] = state.along.dot(&velocity) / state.divisor;
        }
        legs
    }

    /// Arcs, rates and accelerations of the arms for a motion of the platform.
    pub(super) fn motion(&self, geometry: &Geometry, motion: &PlatformMotion) -> LegMotion {
        let turned = geometry.platform.turned(&motion.orientation.rotation);
        let mut legs = LegMotion { transmission: f64::INFINITY, ..LegMotion::default() };
        for i in 0..6 {
            let at = turned.joint(i);
            let state = self.arm_state(i, &(motion.position + at - geometry.base.joint(i)));
            let velocity = motion.velocity + motion.angular_velocity.cross(&at);
            let acceleration = motion.acceleration_at(at);
            let rate = state.along.dot(&velocity) / state.divisor;
            let across = velocity - rate * state.tangent;
            let turning = state.along.dot(&state.out) * rate * rate / self.arm + across.norm_squared() / self.rod;
            legs.length[i] = self.arm * state.angle();
            legs.velocity[i] = rate;
            legs.acceleration[i] = (state.along.dot(&acceleration) + turning) / state.divisor;
            legs.transmission = min(state.transmission, legs.transmission);
        }
        legs
    }

    /// Arcs of the arms in a pose \[m\].
    pub(super) fn arcs(&self, geometry: &Geometry, pose: &Pose) -> [f64; 6] {
        core::array::from_fn(|i| self.arm * self.arm_state(i, &geometry.between(i, pose)).angle())
    }

    /// Factors from a velocity along each rod to the rate of its arc, in a pose.
    pub(super) fn amplifications(&self, geometry: &Geometry, pose: &Pose) -> [f64; 6] {
        core::array::from_fn(|i| 1.0 / self.arm_state(i, &geometry.between(i, pose)).divisor)
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
