//! Limits of the tyres' lateral forces, and the conditions for a fall.
//!
//! A tyre's forces X along the road and F across it stay within the friction ellipse (X / μ N)^2 +
//! (F / r μ N)^2 <= 1. The ratio of the frictions is r. Sources: H. B. Pacejka, "Tire and Vehicle
//! Dynamics", and J. Y. Wong, "Theory of Ground Vehicles". The lateral force has priority.
//! [`crate::longitudinal`] uses the remaining friction.
//!
//! The load of [`crate::suspension`] is along the motorcycle's plane, which leans by φ:
//! L = N cos φ + F sin φ, F positive to the side of the lean. The ellipse's end on either side then
//! is F = r μ L / (cos φ ± r μ sin φ).

/// Limits of a tyre's lateral force \[N\], to the left (negative) and to the right.
pub type Limits = (f64, f64);

/// Friction along the road, and across it relative to that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    pub along: f64,
    pub ratio: f64,
}

impl Friction {
    /// Limits of a lateral force for a load in the plane of a motorcycle whose lean has the tangent
    /// `lean`, positive to the right.
    pub fn lateral(&self, load: f64, lean: f64) -> Limits {
        // Least denominator of the ellipse's end.
        const LEAST_FRACTION: f64 = 0.1;
        let friction = self.ratio * self.along;
        let cos = 1.0 / libm::sqrt(1.0 + lean * lean);
        let sin = lean * cos;
        // Leaning more than friction holds, a force to the other side has no limit but the load.
        let end = |inward: f64| friction * load / (cos + friction * inward).max(LEAST_FRACTION);
        (-end(-sin), end(sin))
    }

    /// Load normal to the road of a load in the plane \[N\].
    pub fn normal(&self, load: f64, lateral: f64, lean: f64) -> f64 {
        let hypotenuse = libm::sqrt(1.0 + lean * lean);
        ((load - lateral * lean / hypotenuse) * hypotenuse).max(0.0).min(hypotenuse * load)
    }
}

/// Deceleration of a motorcycle that slides on its side, as a fraction of gravity times friction.
pub const SLIDING_FRICTION_FRACTION: f64 = 0.4;
/// Time constant with which roll and yaw rates of a fallen motorcycle end \[s\].
pub const FALLEN_SETTLING_TIME: f64 = 0.1;

/// True for a motorcycle that has fallen: with a roll, the speed and the lateral velocity of its
/// rear contact.
pub fn has_fallen(roll: f64, lean_limit: f64, speed: f64, lateral_velocity: f64) -> bool {
    // Roll beyond the rider's limit at which the motorcycle has fallen [rad], and the largest roll.
    const FALLEN_ROLL_MARGIN: f64 = 0.35;
    const MAX_FALLEN_ROLL: f64 = 1.35;
    // Slip angle at which it has fallen, as a tangent, above a lateral velocity of 1 m/s.
    const SPUN_SLIP_TANGENT: f64 = 0.7;
    roll.abs() > (lean_limit + FALLEN_ROLL_MARGIN).min(MAX_FALLEN_ROLL)
        || lateral_velocity.abs() > 1.0 + SPUN_SLIP_TANGENT * speed
}
