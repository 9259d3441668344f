//! The actuator guard: stroke, speed and acceleration of each leg are limits of the machine, and no command exceeds them.
//!
//! A motion is allowed if the platform can come to rest from it, by a plan of [`Braking`] on which the legs keep their
//! limits and the platform its safety limits. While what is wanted is allowed, the guard passes it on. When it is not,
//! the platform goes as far towards it as is allowed; in the worst case it does what it planned before, and brakes. So
//! there is always something left to do that keeps every limit.

use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::braking::{ACCELERATION_SHARE, Braking, LEG_SHARE, braking_time};
use super::{Coordinates, Geometry, Legs, PlatformMotion, Pose};
use super::{inverse_kinematics, jacobian, leg_accelerations, motion_of_legs};
use crate::extremes::{larger, smaller};
use crate::governor::{CATCH_UP_SHARE, FULL_SHARE, Limits, Motion, REJOIN_DISTANCE, REJOIN_SHARE, ROUNDING};
use crate::interface::{Rig, SafetyParameters};
use crate::motions::Motions;

/// The guard with the motion that the platform is commanded, and with its legs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActuatorGuard {
    geometry: Geometry,
    neutral_height: f64,
    /// The farthest joint from the platform's origin \[m\].
    radius: f64,
    limits: Limits,
    motion: PlatformMotion,
    legs: Legs,
    /// The last step \[s\] and the way that each leg made in it \[m\].
    last_step: f64,
    last_ways: [f64; 6],
    /// What was wanted last: the platform's coordinates, unless it is held back.
    wanted: Coordinates,
    held_back: Option<HeldBack>,
}

/// What else there is to know while the platform is not where it is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct HeldBack {
    coordinates: Coordinates,
    /// How the platform comes to rest from here.
    braking: Braking,
    /// Of the legs' lengths, over the last step \[m/s2\].
    leg_accelerations: [f64; 6],
}

/// Where the platform may be next: its coordinates, the same as a motion in the base frame, and its legs.
struct Candidate {
    coordinates: Coordinates,
    motion: PlatformMotion,
    legs: Legs,
}

/// Between braking and following, the best is found to a part in 2^6.
const BISECTIONS: usize = 6;

impl ActuatorGuard {
    /// At rest at neutral; no step will be longer than `longest_step` \[s\].
    pub fn new(rig: &Rig, longest_step: f64) -> Self {
        let geometry = Geometry::from(rig);
        let motion = PlatformMotion::at_rest(Pose::neutral(rig));
        let limits = Limits {
            min: rig.min_length,
            max: rig.max_length,
            velocity: rig.velocity_limit,
            acceleration: rig.acceleration_limit,
            longest_step,
        };
        ActuatorGuard {
            geometry,
            neutral_height: rig.neutral_height,
            radius: rig.platform.iter().fold(0.0, |radius, joint| joint.norm().max(radius)),
            limits,
            motion,
            legs: inverse_kinematics(&geometry, &motion),
            last_step: 0.0,
            last_ways: [0.0; 6],
            wanted: Coordinates::default(),
            held_back: None,
        }
    }

    /// Advances by `step` seconds, at whose end the platform is wanted to move as the coordinates say; `motion` is the
    /// same, in the base frame. `safety` are the limits of surge, sway and heave, which the wanted motion keeps.
    #[inline(always)]
    pub fn advance(&mut self, wanted: &Coordinates, motion: &PlatformMotion, safety: &SafetyParameters, step: f64) {
        let legs = inverse_kinematics(&self.geometry, motion);
        if self.may_join(wanted, motion, &legs, safety, step) {
            self.held_back = None;
            self.take(motion, &legs, step);
        } else {
            self.hold_back(&legs, safety, step);
        }
        self.wanted = *wanted;
    }

    /// Whether the motion at the step's end can be the wanted one.
    #[inline(always)]
    fn may_join(
        &self,
        wanted: &Coordinates,
        motion: &PlatformMotion,
        legs: &Legs,
        safety: &SafetyParameters,
        step: f64,
    ) -> bool {
        let joined = !self.acting() || self.has_caught_up(wanted, legs, safety, step);
        let share = if self.acting() { REJOIN_SHARE } else { FULL_SHARE };
        joined && self.legs_can_go(legs, share, step) && self.can_stop(wanted, motion, legs, safety)
    }

    /// Whether nobody would notice if the platform were where it is wanted.
    fn has_caught_up(&self, wanted: &Coordinates, legs: &Legs, safety: &SafetyParameters, step: f64) -> bool {
        let near = REJOIN_DISTANCE * self.limits.acceleration * step * step;
        let expected = |i: usize| self.legs.length[i] + 0.5 * (self.legs.velocity[i] + legs.velocity[i]) * step;
        let change = wanted.linear.velocity - self.motion.velocity;
        (0..6).all(|i| (legs.length[i] - expected(i)).abs() <= near)
            && (0..3).all(|k| change[k].abs() <= safety.acceleration_limit[k] * step)
    }

    /// Whether each leg can go there in this step, for whoever sees velocities and also for whoever sees positions only:
    /// the way's mean velocity, and the change of that from one step to the next. Where a velocity jumps within a step,
    /// the velocities at the steps' ends do not tell. `share` of the acceleration limit may be used.
    #[inline(always)]
    fn legs_can_go(&self, next: &Legs, share: f64, step: f64) -> bool {
        let Limits { velocity, acceleration, .. } = self.limits;
        let change = share * acceleration * step;
        let farthest = velocity * step + ROUNDING;
        let half_change = 0.5 * acceleration * step;
        let (both, last_step) = (step + self.last_step, self.last_step);
        let bend = (half_change * last_step + ROUNDING) * both;
        let room = half_change * step + ROUNDING;
        let mut can = true;
        for i in 0..6 {
            let way = next.length[i] - self.legs.length[i];
            can &= (next.velocity[i] - self.legs.velocity[i]).abs() <= change;
            can &= way.abs() <= farthest;
            // The mean velocities way/step, multiplied by both steps.
            can &= (way * last_step - self.last_ways[i] * step).abs() <= bend;
            // Leaves room for the step after, which may have to brake.
            can &= (next.velocity[i] * step - way).abs() <= room;
        }
        can
    }

    /// Whether the platform can come to rest from there within all limits.
    #[inline(always)]
    fn can_stop(
        &self,
        coordinates: &Coordinates,
        motion: &PlatformMotion,
        legs: &Legs,
        safety: &SafetyParameters,
    ) -> bool {
        self.can_plainly_stop(coordinates, motion, legs, safety) || self.can_stop_by_plan(coordinates, legs, safety)
    }

    #[cold]
    fn can_stop_by_plan(&self, coordinates: &Coordinates, legs: &Legs, safety: &SafetyParameters) -> bool {
        let braking = self.braking_from(coordinates, legs, safety);
        braking.keeps(&self.limits, &self.geometry, coordinates, self.neutral_height)
    }

    fn braking_from(&self, coordinates: &Coordinates, legs: &Legs, safety: &SafetyParameters) -> Braking {
        Braking::from(coordinates, fastest(legs), &self.limits, safety)
    }

    /// Whether it can so plainly that there is no need to look along the way: all coordinates brake in the same time, and
    /// no leg can get near an end of its stroke in that, nor to its limits of speed and acceleration.
    #[inline(always)]
    fn can_plainly_stop(
        &self,
        coordinates: &Coordinates,
        motion: &PlatformMotion,
        legs: &Legs,
        safety: &SafetyParameters,
    ) -> bool {
        let Limits { min, max, velocity, acceleration, .. } = self.limits;
        let fastest = fastest(legs);
        let linear = &coordinates.linear;
        let time = braking_time(&linear.velocity, fastest, &self.limits, safety);
        // What turning may add to the acceleration of a leg: of its own, of its joint's and of the angles' rates.
        let turning = motion.angular_velocity.norm_squared() * self.radius;
        let joint_speed_squared = 2.0 * (motion.velocity.norm_squared() + turning * self.radius);
        let curvature = joint_speed_squared / min + 4.0 * turning;
        let way = 0.5 * time * (fastest + curvature * time);
        let mut can = curvature <= (ACCELERATION_SHARE - LEG_SHARE) * acceleration;
        can &= fastest + curvature * time <= velocity;
        for length in legs.length {
            can &= length - way >= min && length + way <= max;
        }
        for k in 0..3 {
            let ahead = linear.position[k] + 0.5 * time * linear.velocity[k];
            can &= larger(ahead.abs(), linear.position[k].abs()) <= safety.position_limit[k];
        }
        can
    }

    /// What is wanted, with these legs, is not allowed.
    #[cold]
    fn hold_back(&mut self, wanted: &Legs, safety: &SafetyParameters, step: f64) {
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
    ) -> (Candidate, Braking) {
        let braked = planned.after(now, step);
        let followed = self.followed(now, wanted, safety, step);
        let between = |share: f64| self.candidate(braked.towards(&followed, share, now, step));
        let allowed = |Candidate { coordinates, motion, legs }: &Candidate| {
            self.legs_can_go(legs, 1.0, step) && self.can_stop(coordinates, motion, legs, safety)
        };
        if let Some(candidate) = farthest(between, allowed) {
            let braking = self.braking_from(&candidate.coordinates, &candidate.legs, safety);
            return (candidate, braking);
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
    fn each_leg_alone(&self, now: &Coordinates, target: &Legs, step: f64) -> Candidate {
        let followed = self.each_leg_followed(target, step);
        let legs = Legs { length: followed.map(|leg| leg.position), velocity: followed.map(|leg| leg.velocity) };
        let accelerations = followed.map(|leg| leg.acceleration);
        let motion = motion_of_legs(&self.geometry, &legs, &accelerations, &self.motion.pose())
            .unwrap_or_else(|_| PlatformMotion::at_rest(self.motion.pose()));
        let coordinates = Coordinates::reached(&motion, self.neutral_height, now, step);
        Candidate { coordinates, motion, legs }
    }

    fn candidate(&self, coordinates: Coordinates) -> Candidate {
        let motion = coordinates.motion(self.neutral_height);
        Candidate { coordinates, motion, legs: inverse_kinematics(&self.geometry, &motion) }
    }

    /// Moves on.
    #[inline(always)]
    fn take(&mut self, motion: &PlatformMotion, legs: &Legs, step: f64) {
        for i in 0..6 {
            self.last_ways[i] = legs.length[i] - self.legs.length[i];
        }
        self.last_step = step;
        self.motion = *motion;
        self.legs = *legs;
    }

    /// The platform's coordinates.
    fn coordinates(&self) -> &Coordinates {
        self.held_back.as_ref().map_or(&self.wanted, |held_back| &held_back.coordinates)
    }

    /// The coordinates that were wanted last.
    pub fn wanted(&self) -> &Coordinates {
        &self.wanted
    }

    /// The commanded legs.
    pub fn legs(&self) -> &Legs {
        &self.legs
    }

    /// The accelerations of the commanded legs' lengths \[m/s2\]: over the last step while the guard acts.
    pub fn leg_accelerations(&self) -> [f64; 6] {
        match &self.held_back {
            Some(held_back) => held_back.leg_accelerations,
            None => leg_accelerations(&self.geometry, &self.motion),
        }
    }

    /// The motion that the platform makes.
    pub fn motion(&self) -> &PlatformMotion {
        &self.motion
    }

    /// Whether the platform was held back in the last step.
    pub fn acting(&self) -> bool {
        self.held_back.is_some()
    }

    /// The smallest distance of a leg from either end of its stroke \[m\].
    pub fn stroke_margin(&self) -> f64 {
        self.margins().fold(f64::INFINITY, |least, (margin, _)| smaller(margin, least))
    }

    /// The time derivative of [`ActuatorGuard::stroke_margin`] \[m/s\].
    pub fn stroke_margin_rate(&self) -> f64 {
        let nearest = self.margins().fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
        nearest.1
    }

    /// Each leg's distance from each end of its stroke, and the rate of it.
    fn margins(&self) -> impl Iterator<Item = (f64, f64)> {
        let Legs { length, velocity } = self.legs;
        (0..6).flat_map(move |i| {
            [(length[i] - self.limits.min, velocity[i]), (self.limits.max - length[i], -velocity[i])]
        })
    }
}

/// The speed of the fastest leg \[m/s\].
fn fastest(legs: &Legs) -> f64 {
    legs.velocity.iter().fold(0.0, |fastest, velocity| larger(velocity.abs(), fastest))
}

/// The candidate farthest on the way from braking (share 0) to following (1) that is allowed, if any but braking is.
fn farthest(between: impl Fn(f64) -> Candidate, allowed: impl Fn(&Candidate) -> bool) -> Option<Candidate> {
    let all_the_way = between(1.0);
    if allowed(&all_the_way) {
        return Some(all_the_way);
    }
    let (mut low, mut high, mut found) = (0.0, 1.0, None);
    for _ in 0..BISECTIONS {
        let share = 0.5 * (low + high);
        let candidate = between(share);
        if allowed(&candidate) {
            (low, found) = (share, Some(candidate));
        } else {
            high = share;
        }
    }
    found
}
