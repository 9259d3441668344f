//! The actuator guard keeps stroke, speed and acceleration of each leg, and the safety limits of
//! surge, sway and heave, whatever is demanded.
//!
//! The guard is a reference governor with a backup stop plan. Its invariant: **the state lies on a
//! certified stop plan**, a trajectory to rest on which every limit holds at every instant. A step
//! does one of two things:
//!
//! 1. It accepts a candidate state. Both the transition to it and a stop plan from it are
//!    certified; that plan is stored. So is the straight way to neutral from the plan's end.
//! 2. It follows the stored plan, which needs no check.
//!
//! The first candidate is the demand itself; others lie between the plan's next state and a
//! pursuit of the demand.

mod bounds;
mod certificate;
mod home;
mod machine;
mod pursuit;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

pub use self::machine::stroke_reserve;
use self::machine::{Candidate, Machine, Speed, State};
use super::stop_plan::{StopDurations, StopPlan};
use super::{Geometry, Legs, PlatformCoordinates, PlatformMotion, Pose, inverse_kinematics, leg_accelerations};
use crate::interface::{Rig, SafetyParameters};
use crate::motion::braking_law::{Limits, REJOIN_DISTANCE, WITH_ROUNDING};
use crate::motion::min_max::min;

/// The guard with the motion that the platform is commanded, and with its legs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActuatorGuard {
    machine: Machine,
    /// The shortest and the longest that a leg may be \[m\].
    stroke: [f64; 2],
    /// The limits within which each leg pursues its demand.
    pursuit: Limits,
    motion: PlatformMotion,
    legs: Legs,
    speed: Speed,
    /// The certified way to rest. It starts at the present state, unless the last step followed it.
    plan: StopPlan,
    limited: Option<Deviation>,
}

/// The rest of the state while the platform is kept from its demand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Deviation {
    demand: PlatformCoordinates,
    coordinates: PlatformCoordinates,
    /// Accelerations of the legs over the last step \[m/s2\].
    leg_accelerations: [f64; 6],
    /// Time for which the input has been at rest meanwhile \[s\].
    resting: f64,
    /// The fraction of its speed with which the platform goes straight home, if it does.
    homeward: Option<f64>,
}

/// Time for which the input rests while the platform is kept from its demand, before the platform
/// goes straight home \[s\].
const PATIENCE: f64 = 10.0;
/// Factors on the speed of the way home after a step without and with a certified candidate.
const SLOWER: f64 = 1.0 / 64.0;
const FASTER: f64 = 8.0;

impl ActuatorGuard {
    /// At rest at neutral; no step will be longer than `longest_step` \[s\].
    pub fn new(rig: &Rig, longest_step: f64) -> Self {
        let machine = Machine::new(rig, longest_step);
        let motion = PlatformMotion::at_rest(Pose::neutral(rig));
        ActuatorGuard {
            machine,
            stroke: [rig.min_length, rig.max_length],
            pursuit: machine.pursuit_limits(),
            motion,
            legs: inverse_kinematics(&machine.geometry, &motion),
            speed: Speed::default(),
            plan: StopPlan::rest(),
            limited: None,
        }
    }

    /// Joints of the legs.
    pub fn geometry(&self) -> &Geometry {
        &self.machine.geometry
    }

    /// The legs of a motion of the platform.
    #[inline(always)]
    pub fn legs_of(&self, motion: &PlatformMotion) -> Legs {
        inverse_kinematics(&self.machine.geometry, motion)
    }

    /// As [`ActuatorGuard::advance_with_legs`], where the demand's legs are not known.
    #[cfg(test)]
    pub fn advance(
        &mut self,
        demand: &PlatformCoordinates,
        motion: &PlatformMotion,
        safety: &SafetyParameters,
        resting: bool,
        step: f64,
    ) {
        let legs = self.legs_of(motion);
        self.advance_with_legs(demand, motion, &legs, safety, resting, step);
    }

    /// Advances by `step` seconds. At their end the platform is to move as `demand` says; `motion`
    /// is the same in the base frame, and `legs` are its legs. `safety` are the limits of surge,
    /// sway and heave in force. `resting` tells that the input asks for no motion.
    #[inline(always)]
    pub fn advance_with_legs(
        &mut self,
        demand: &PlatformCoordinates,
        motion: &PlatformMotion,
        legs: &Legs,
        safety: &SafetyParameters,
        resting: bool,
        step: f64,
    ) {
        let candidate = Candidate { coordinates: demand, motion, legs };
        if self.limited.is_none()
            && let Some(duration) = self.machine.certify_by_bounds(self.state(), candidate, safety, step)
            && self.machine.sees_home_by_bounds(candidate, duration)
        {
            self.move_to(candidate);
            self.plan.restart(demand, StopDurations::common(duration));
        } else {
            self.advance_in_doubt(candidate, safety, resting, step);
        }
    }

    /// Advances towards a demand that bounds alone do not certify, or that the platform is behind.
    #[cold]
    fn advance_in_doubt(&mut self, demand: Candidate, safety: &SafetyParameters, resting: bool, step: f64) {
        let joined = self.limited.is_none() || self.has_caught_up(demand, safety, step);
        let followed = self.plan.advanced(step);
        let plan = if joined { self.certified_to_see_home(demand, &followed, safety, step) } else { None };
        if let Some(plan) = plan {
            self.accept(demand, plan);
            self.limited = None;
            return;
        }
        let before = self.legs;
        let (resting, homeward) = self.patience(resting, step);
        // A pursuit may swing about its demand for ever. Only a platform at rest begins to go home.
        let stops = resting > PATIENCE && homeward.is_none();
        let found = if stops { None } else { self.nearest(demand, &followed, homeward, safety, step) };
        let homeward =
            homeward.map(|fraction| if found.is_some() { min(FASTER * fraction, 1.0) } else { SLOWER * fraction });
        let (next, plan) = found.unwrap_or_else(|| (self.following(&followed, step), followed));
        self.accept(next.candidate(), plan);
        self.limited = Some(Deviation {
            demand: *demand.coordinates,
            coordinates: next.coordinates,
            leg_accelerations: std::array::from_fn(|i| (self.legs.velocity[i] - before.velocity[i]) / step),
            resting,
            homeward,
        });
    }

    /// Time for which the input has been at rest, `step` seconds later. Once that is longer than
    /// [`PATIENCE`], the platform stops. From rest it goes straight home, and the fraction of its
    /// speed is given. It goes on until it joins its demand or the input moves.
    fn patience(&self, resting: bool, step: f64) -> (f64, Option<f64>) {
        let Some(Deviation { resting: before, homeward, .. }) = self.limited.filter(|_| resting) else {
            return (0.0, None);
        };
        let at_rest = self.speed == Speed::default();
        (before + step, homeward.or_else(|| (before > PATIENCE && at_rest).then_some(1.0)))
    }

    /// A certified stop plan from the candidate that keeps each axis's limit of velocity no later
    /// than the plan held. This matters where a tightened limit is not kept yet.
    ///
    /// `followed` is the plan held, at the step's end.
    fn certified(&self, to: Candidate, followed: &StopPlan, safety: &SafetyParameters, step: f64) -> Option<StopPlan> {
        let plan = self.machine.certify(self.state(), to, safety, step)?;
        let limits = WITH_ROUNDING * safety.velocity_limit;
        let (next, held) = (plan.times_until_within(&limits), followed.times_until_within(&limits));
        (0..3).all(|k| next[k] <= held[k]).then_some(plan)
    }

    /// As [`ActuatorGuard::certified`], with a certified way home from the end of the stop.
    fn certified_to_see_home(
        &self,
        to: Candidate,
        followed: &StopPlan,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<StopPlan> {
        let plan = self.certified(to, followed, safety, step)?;
        let [.., duration] = plan.durations().breakpoints();
        let sees = self.machine.sees_home_by_bounds(to, duration) || self.machine.sees_home(&plan.at(duration));
        sees.then_some(plan)
    }

    /// True if the platform may join the demand. The positions must differ from what the
    /// velocities account for by at most [`REJOIN_DISTANCE`] a h², with the limit of
    /// acceleration a and the step h.
    fn has_caught_up(&self, demand: Candidate, safety: &SafetyParameters, step: f64) -> bool {
        let near = REJOIN_DISTANCE * step * step;
        let (legs, next) = (&self.legs, demand.legs);
        let (now, linear) = (&self.coordinates().linear, &demand.coordinates.linear);
        let apart = |before: f64, after: f64, v: f64, w: f64| (after - before - 0.5 * (v + w) * step).abs();
        (0..6).all(|i| {
            apart(legs.length[i], next.length[i], legs.velocity[i], next.velocity[i])
                <= near * self.pursuit.acceleration
        }) && (0..3).all(|k| {
            apart(now.position[k], linear.position[k], now.velocity[k], linear.velocity[k])
                <= near * safety.acceleration_limit[k]
        })
    }

    /// Commits a state from which this plan is certified, or which lies on it.
    #[inline(always)]
    fn accept(&mut self, state: Candidate, plan: StopPlan) {
        self.move_to(state);
        self.plan = plan;
    }

    #[inline(always)]
    fn move_to(&mut self, state: Candidate) {
        self.motion = *state.motion;
        self.legs = *state.legs;
        self.speed = Speed::of(state.coordinates);
    }

    #[inline(always)]
    fn state(&self) -> State<'_> {
        State { coordinates: self.coordinates(), motion: &self.motion, speed: self.speed }
    }

    /// The platform's coordinates.
    #[inline(always)]
    pub fn coordinates(&self) -> &PlatformCoordinates {
        match &self.limited {
            Some(limited) => &limited.coordinates,
            None => self.plan.start(),
        }
    }

    /// The coordinates that were demanded last.
    pub fn demand(&self) -> &PlatformCoordinates {
        match &self.limited {
            Some(limited) => &limited.demand,
            None => self.plan.start(),
        }
    }

    /// The commanded legs.
    pub fn legs(&self) -> &Legs {
        &self.legs
    }

    /// The accelerations of the commanded legs' lengths \[m/s2\], within their limit.
    ///
    /// While the guard limits the motion, they are means over the last step. Otherwise they are
    /// those of the platform's motion. Where these jump, the legs make the jump over a step, and
    /// keep their limit with the mean; an acceleration beyond the limit is then given as the limit.
    pub fn leg_accelerations(&self) -> [f64; 6] {
        let most = self.machine.limits.acceleration;
        let accelerations = match &self.limited {
            Some(limited) => limited.leg_accelerations,
            None => leg_accelerations(&self.machine.geometry, &self.motion),
        };
        accelerations.map(|acceleration| acceleration.clamp(-most, most))
    }

    /// The motion that the platform makes.
    pub fn motion(&self) -> &PlatformMotion {
        &self.motion
    }

    /// True if the platform was kept from its demand in the last step.
    pub fn limited(&self) -> bool {
        self.limited.is_some()
    }

    /// The smallest distance of a leg from either end of its stroke \[m\].
    pub fn stroke_margin(&self) -> f64 {
        let [shortest, longest] = self.stroke;
        let [least, greatest] = self.legs.extremes();
        min(least - shortest, longest - greatest)
    }

    /// The time derivative of [`ActuatorGuard::stroke_margin`] \[m/s\].
    pub fn stroke_margin_rate(&self) -> f64 {
        self.margins().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, rate)| rate)
    }

    /// Each leg's distance from each end of its stroke, and the rate of it.
    fn margins(&self) -> impl Iterator<Item = (f64, f64)> {
        let Legs { length, velocity } = self.legs;
        (0..6)
            .flat_map(move |i| [(length[i] - self.stroke[0], velocity[i]), (self.stroke[1] - length[i], -velocity[i])])
    }
}
