//! What the actuator guard does when the wanted motion is not allowed: as near to it as is, and in the worst case brake.

use nalgebra::{Vector3, Vector6};

use super::{ActuatorGuard, Candidate, HeldBack};
use crate::interface::SafetyParameters;
use crate::motion::Motions;
use crate::motion::braking_law::{CATCH_UP_SHARE, FULL_SHARE, Limits, Motion};
use crate::platform::stop_plan::Braking;
use crate::platform::{Coordinates, Legs, PlatformMotion, inverse_kinematics, jacobian, motion_of_legs};

/// What is tried: a [`Candidate`] of its own.
struct Try {
    coordinates: Coordinates,
    motion: PlatformMotion,
    legs: Legs,
}

impl Try {
    fn candidate(&self) -> Candidate<'_> {
        Candidate { coordinates: &self.coordinates, motion: &self.motion, legs: &self.legs }
    }
}

/// Between braking and following, the best is found to a part in 2^6.
const BISECTIONS: usize = 6;

impl ActuatorGuard {
    /// What is wanted, with these legs, is not allowed.
    #[cold]
    pub(super) fn hold_back(&mut self, wanted: &Legs, safety: &SafetyParameters, step: f64) {
        let now = *self.coordinates();
        let braking = match &self.held_back {
            Some(held_back) => held_back.braking,
            None => self.braking_from(&now, &self.legs, safety),
        };
        let (next, braking) = self.nearest(&now, &braking, wanted, safety, step);
        self.held_back = Some(HeldBack {
            coordinates: next.coordinates,
            braking,
            leg_accelerations: std::array::from_fn(|i| (next.legs.velocity[i] - self.legs.velocity[i]) / step),
        });
        self.take(&next.motion, &next.legs, step);
    }

    /// As far towards the wanted legs as is allowed, and how to come to rest from there; in the worst case as planned.
    fn nearest(
        &self,
        now: &Coordinates,
        planned: &Braking,
        wanted: &Legs,
        safety: &SafetyParameters,
        step: f64,
    ) -> (Try, Braking) {
        let braked = planned.after(now, step);
        let followed = self.followed(now, wanted, safety, step);
        let between = |share: f64| self.tried(braked.towards(&followed, share, now, step));
        let allowed =
            |tried: &Try| self.legs_can_go(&tried.legs, 1.0, step) && self.can_stop(tried.candidate(), safety);
        if let Some(found) = farthest(between, allowed) {
            let braking = self.braking_from(&found.coordinates, &found.legs, safety);
            return (found, braking);
        }
        let as_planned = between(0.0);
        if self.legs_can_go(&as_planned.legs, FULL_SHARE, step) {
            (as_planned, *planned)
        } else {
            (self.each_leg_alone(now, wanted, step), *planned)
        }
    }

    /// Where the platform gets to if each leg follows its target under its own limits, and surge, sway and heave keep
    /// theirs.
    fn followed(&self, now: &Coordinates, target: &Legs, safety: &SafetyParameters, step: f64) -> Coordinates {
        let legs = self.each_leg_followed(target, step);
        let rates = Vector6::from(legs.map(|leg| leg.velocity));
        // The Jacobian where the platform will be, not where it is: the legs have to arrive without a jump.
        let ahead = now.coasted(step).motion(self.neutral_height);
        let twist = jacobian(&self.geometry, &ahead.pose()).lu().solve(&rates).unwrap_or_else(Vector6::zeros);
        let velocity: Vector3<f64> = twist.fixed_rows::<3>(0).into();
        let rates = ahead.orientation.rates(twist.fixed_rows::<3>(3).into()).to_vector();
        let Coordinates { linear, angles } = now;
        // All change less where one may not change so much: the legs would go elsewhere otherwise.
        let change = velocity - linear.velocity;
        let least = Vector3::repeat(f64::MIN_POSITIVE);
        let share = (step * safety.acceleration_limit).component_div(&change.abs().sup(&least)).min().min(1.0);
        let velocity = linear.velocity + share * change;
        let rates = angles.velocity.lerp(&rates, share);
        let longest_step = self.limits.longest_step;
        Coordinates {
            linear: Motions::from_axes(|k| {
                Limits::safety(safety, k, longest_step).at_velocity(&linear.axis(k), velocity[k], step)
            }),
            angles: angles.at_velocity(rates, step),
        }
    }

    /// Each leg follows its target as far as its limits allow.
    fn each_leg_followed(&self, target: &Legs, step: f64) -> [Motion; 6] {
        std::array::from_fn(|i| {
            let leg = Motion { position: self.legs.length[i], velocity: self.legs.velocity[i], acceleration: 0.0 };
            let goal = Motion { position: target.length[i], velocity: target.velocity[i], acceleration: 0.0 };
            self.limits.follow(&leg, &goal, CATCH_UP_SHARE * self.limits.acceleration, step)
        })
    }

    /// What is left if the plan of braking itself does not fit: each leg on its own keeps its limits, and the platform
    /// makes what they make. If forward kinematics does not find that (in a rig free of singularities it always does), the
    /// last pose known is reported.
    fn each_leg_alone(&self, now: &Coordinates, target: &Legs, step: f64) -> Try {
        let followed = self.each_leg_followed(target, step);
        let legs = Legs { length: followed.map(|leg| leg.position), velocity: followed.map(|leg| leg.velocity) };
        let accelerations = followed.map(|leg| leg.acceleration);
        let motion = motion_of_legs(&self.geometry, &legs, &accelerations, &self.motion.pose())
            .unwrap_or_else(|_| PlatformMotion::at_rest(self.motion.pose()));
        let coordinates = Coordinates::reached(&motion, self.neutral_height, now, step);
        Try { coordinates, motion, legs }
    }

    fn tried(&self, coordinates: Coordinates) -> Try {
        let motion = coordinates.motion(self.neutral_height);
        Try { coordinates, motion, legs: inverse_kinematics(&self.geometry, &motion) }
    }
}

/// The farthest on the way from braking (share 0) to following (1) that is allowed, if any but braking is.
fn farthest(between: impl Fn(f64) -> Try, allowed: impl Fn(&Try) -> bool) -> Option<Try> {
    let all_the_way = between(1.0);
    if allowed(&all_the_way) {
        return Some(all_the_way);
    }
    let (mut low, mut high, mut found) = (0.0, 1.0, None);
    for _ in 0..BISECTIONS {
        let share = 0.5 * (low + high);
        let tried = between(share);
        if allowed(&tried) {
            (low, found) = (share, Some(tried));
        } else {
            high = share;
        }
    }
    found
}
