//! The actuator guard keeps stroke, speed and acceleration of each leg, and the safety limits of
//! surge, sway and heave, whatever is demanded.
//!
//! The guard is a reference governor with a backup stop plan. Its invariant: **the state lies on a
//! certified stop plan**, a trajectory to rest on which every limit holds at every instant. A step
//! does one of two things:
//!
//! 1. The guard accepts a candidate state. Both the transition to it and a stop plan from it are
//!    certified, and so is the straight path to neutral from the plan's end. The plan is stored.
//! 2. The guard follows the stored plan, which needs no check.
//!
//! The first candidate is the demand itself, unless the platform is behind it; others lie between
//! the plan's next state and a pursuit of the demand. A leg's length means a crank's arc, too.

mod bounds;
mod certificate;
mod certifier;
mod cranks;
mod home;
mod pursuit;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

pub use self::certifier::step_margin;
use self::certifier::{Certifier, Speed};
use super::stop_plan::{StopDurations, StopPlan};
use super::{Geometry, Legs, PlatformCoordinates, PlatformState, leg_accelerations};
use crate::interface::{Rig, SafetyParameters};
use crate::motion::braking_law::{Limits, REJOIN_TOLERANCE, WITH_ROUNDING};
use crate::motion::min_max::min;

/// The guard with the state that the platform is commanded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActuatorGuard {
    certifier: Certifier,
    /// The shortest and the longest that a leg may be \[m\].
    stroke: [f64; 2],
    /// The limits within which each leg pursues its demand.
    pursuit: Limits,
    commanded: PlatformState,
    plan: CertifiedStop,
    deviation: Option<Deviation>,
}

/// The certified way to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum CertifiedStop {
    /// From the commanded state, all coordinates in this duration \[s\].
    Straight(f64),
    Plan(StopPlan),
}

/// The rest of the state while the platform is kept from its demand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Deviation {
    demand: PlatformCoordinates,
    /// Accelerations of the legs over the last step \[m/s2\].
    leg_accelerations: [f64; 6],
    /// Time for which the input has been at rest meanwhile \[s\].
    rest_while_limited: f64,
    /// The fraction of its speed with which the platform goes straight home, if it does.
    homing_fraction: Option<f64>,
}

/// Time for which the input rests while the platform is kept from its demand, before the platform
/// goes straight home \[s\].
const REST_BEFORE_RETURN: f64 = 10.0;
/// Factors on the speed of the way home after a step without and with a certified candidate.
const RETURN_SPEED_DECREASE: f64 = 1.0 / 64.0;
const RETURN_SPEED_INCREASE: f64 = 8.0;

impl ActuatorGuard {
    /// At rest at neutral; no step will be longer than `max_step` \[s\].
    pub fn new(rig: &Rig, max_step: f64) -> Self {
        let certifier = Certifier::new(rig, max_step);
        ActuatorGuard {
            certifier,
            stroke: rig.stroke(),
            pursuit: certifier.pursuit_limits(),
            commanded: certifier.state(PlatformCoordinates::default()),
            plan: CertifiedStop::Straight(0.0),
            deviation: None,
        }
    }

    /// Joints of the legs.
    pub fn geometry(&self) -> &Geometry {
        &self.certifier.geometry
    }

    /// The state of the platform with these coordinates.
    pub fn state(&self, coordinates: PlatformCoordinates) -> PlatformState {
        self.certifier.state(coordinates)
    }

    /// Advances by `step` seconds, at whose end the platform is to be in the state `demand`.
    /// `safety` are the limits of surge, sway and heave in force. `is_at_rest` tells that the input
    /// asks for no motion.
    #[inline(always)]
    pub fn advance(&mut self, demand: &PlatformState, safety: &SafetyParameters, is_at_rest: bool, step: f64) {
        if self.deviation.is_none()
            && let Some(duration) = self.certifier.certify_home_by_bounds(&self.commanded, demand, safety, step)
        {
            self.commanded = *demand;
            self.plan = CertifiedStop::Straight(duration);
        } else {
            self.advance_uncertified(demand, safety, is_at_rest, step);
        }
    }

    /// Advances towards a demand that bounds alone do not certify, or that the platform is behind.
    #[cold]
    fn advance_uncertified(&mut self, demand: &PlatformState, safety: &SafetyParameters, is_at_rest: bool, step: f64) {
        let may_join = self.deviation.is_none() || self.has_caught_up(demand, safety, step);
        let held_plan = self.plan().advanced(step);
        let plan = if may_join { self.certified_with_way_home(demand, &held_plan, safety, step) } else { None };
        if let Some(plan) = plan {
            (self.commanded, self.plan, self.deviation) = (*demand, CertifiedStop::Plan(plan), None);
            return;
        }
        let before = self.commanded.legs;
        let (rest_while_limited, homing_fraction) = self.rest_time(is_at_rest, step);
        // A pursuit may swing about its demand for ever. Only a platform at rest begins to go home.
        let stops = rest_while_limited > REST_BEFORE_RETURN && homing_fraction.is_none();
        let found = if stops { None } else { self.nearest(demand, &held_plan, homing_fraction, safety, step) };
        let homing_fraction = homing_fraction.map(|fraction| {
            if found.is_some() { min(RETURN_SPEED_INCREASE * fraction, 1.0) } else { RETURN_SPEED_DECREASE * fraction }
        });
        let (next, plan) = found.unwrap_or_else(|| (self.state_on_plan(&held_plan, step), held_plan));
        (self.commanded, self.plan) = (next, CertifiedStop::Plan(plan));
        self.deviation = Some(Deviation {
            demand: demand.coordinates,
            leg_accelerations: core::array::from_fn(|i| (next.legs.velocity[i] - before.velocity[i]) / step),
            rest_while_limited,
            homing_fraction,
        });
    }

    /// The certified way to rest, which starts at the commanded state unless the last step
    /// followed it.
    fn plan(&self) -> StopPlan {
        match self.plan {
            CertifiedStop::Straight(duration) => {
                StopPlan::new(&self.commanded.coordinates, StopDurations::common(duration))
            }
            CertifiedStop::Plan(plan) => plan,
        }
    }

    /// Time for which the input has been at rest, `step` seconds later. Once that is longer
    /// than [`REST_BEFORE_RETURN`], the platform stops. From rest it goes straight home,
    /// and the fraction of its speed is given. The way ends where the platform joins its
    /// demand or the input moves.
    fn rest_time(&self, is_at_rest: bool, step: f64) -> (f64, Option<f64>) {
        let Some(Deviation { rest_while_limited: before, homing_fraction, .. }) = self.deviation.filter(|_| is_at_rest)
        else {
            return (0.0, None);
        };
        let stands = Speed::of(&self.commanded.coordinates) == Speed::default();
        (before + step, homing_fraction.or_else(|| (before > REST_BEFORE_RETURN && stands).then_some(1.0)))
    }

    /// A certified stop plan from the candidate that keeps each axis's limit of velocity no later
    /// than the plan held. This matters where a tightened limit is not kept yet.
    ///
    /// `held_plan` is the stored plan at the step's end.
    fn certified(
        &self,
        to: &PlatformState,
        held_plan: &StopPlan,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<StopPlan> {
        let plan = self.certifier.certify(&self.commanded, to, safety, step)?;
        let limits = WITH_ROUNDING * safety.velocity_limit;
        let (next, held) = (plan.times_until_within(&limits), held_plan.times_until_within(&limits));
        (0..3).all(|k| next[k] <= held[k]).then_some(plan)
    }

    /// As [`ActuatorGuard::certified`], with a certified way home from the end of the stop.
    fn certified_with_way_home(
        &self,
        to: &PlatformState,
        held_plan: &StopPlan,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<StopPlan> {
        let plan = self.certified(to, held_plan, safety, step)?;
        let [.., duration] = plan.durations().breakpoints();
        let cranks = self.certifier.geometry.cranks.is_some();
        let returns = !cranks && self.certifier.has_way_home_by_bounds(to, duration)
            || self.certifier.has_way_home(&plan.at(duration));
        returns.then_some(plan)
    }

    /// True if the platform may join the demand. The positions must differ from what the
    /// velocities account for by at most [`REJOIN_TOLERANCE`] a h², with the limit of
    /// acceleration a and the step h.
    fn has_caught_up(&self, demand: &PlatformState, safety: &SafetyParameters, step: f64) -> bool {
        let near = REJOIN_TOLERANCE * step * step;
        let (legs, next) = (&self.commanded.legs, &demand.legs);
        let (now, linear) = (&self.commanded.coordinates.linear, &demand.coordinates.linear);
        let apart = |before: f64, after: f64, v: f64, w: f64| (after - before - 0.5 * (v + w) * step).abs();
        (0..6).all(|i| {
            apart(legs.position[i], next.position[i], legs.velocity[i], next.velocity[i])
                <= near * self.pursuit.acceleration
        }) && (0..3).all(|k| {
            apart(now.position[k], linear.position[k], now.velocity[k], linear.velocity[k])
                <= near * safety.acceleration_limit[k]
        })
    }

    /// The commanded state.
    #[inline(always)]
    pub fn commanded(&self) -> &PlatformState {
        &self.commanded
    }

    /// The coordinates that were demanded last.
    pub fn demand(&self) -> &PlatformCoordinates {
        self.deviation.as_ref().map_or(&self.commanded.coordinates, |deviation| &deviation.demand)
    }

    /// The accelerations of the commanded legs' lengths \[m/s2\], within their limit.
    ///
    /// While the guard limits the motion, they are means over the last step. Otherwise they are
    /// those of the platform's motion. Where these jump, the legs make the jump over a step, and
    /// keep their limit with the mean; an acceleration beyond the limit is then given as the limit.
    pub fn leg_accelerations(&self) -> [f64; 6] {
        let most = self.certifier.limits.acceleration;
        let accelerations = match &self.deviation {
            Some(deviation) => deviation.leg_accelerations,
            None => leg_accelerations(&self.certifier.geometry, &self.commanded.motion),
        };
        accelerations.map(|acceleration| acceleration.clamp(-most, most))
    }

    /// True if the platform was kept from its demand in the last step.
    pub fn limited(&self) -> bool {
        self.deviation.is_some()
    }

    /// The smallest distance of a leg from either end of its stroke \[m\].
    pub fn actuator_clearance(&self) -> f64 {
        let [shortest, longest] = self.stroke;
        let [least, greatest] = self.commanded.legs.extremes();
        min(least - shortest, longest - greatest)
    }

    /// The time derivative of [`ActuatorGuard::actuator_clearance`] \[m/s\].
    pub fn actuator_clearance_rate(&self) -> f64 {
        self.clearances().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, rate)| rate)
    }

    /// Each leg's distance from each end of its stroke, and the rate of it.
    fn clearances(&self) -> impl Iterator<Item = (f64, f64)> {
        let Legs { position, velocity } = self.commanded.legs;
        let [start, end] = self.stroke;
        (0..6).flat_map(move |i| [(position[i] - start, velocity[i]), (end - position[i], -velocity[i])])
    }
}
