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
use crate::governor::{CATCH_UP_SHARE, FULL_SHARE, Limits, Motion, REJOIN_DISTANCE, REJOIN_SHARE, ROUNDING};
use crate::interface::{Rig, SafetyParameters};
use crate::motions::Motions;

/// The guard with the commanded legs and the motion that the platform makes on them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActuatorGuard {
    geometry: Geometry,
    neutral_height: f64,
    /// The farthest joint from the platform's origin \[m\].
    radius: f64,
    limits: Limits,
    now: State,
    /// The last step \[s\] and the way that each leg made in it \[m\].
    last_step: f64,
    last_ways: [f64; 6],
    /// What each leg's velocity changed by in it \[m/s\].
    last_changes: [f64; 6],
    /// How the platform comes to rest from here; known while the guard acts.
    braking: Braking,
    /// Whether the motion is not the wanted one.
    acting: bool,
}

/// Where the platform is, or may be next: its coordinates, the same as a motion in the base frame, and its legs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct State {
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
            now: State { coordinates: Coordinates::default(), motion, legs: inverse_kinematics(&geometry, &motion) },
            last_step: 0.0,
            last_ways: [0.0; 6],
            last_changes: [0.0; 6],
            braking: Braking::none(),
            acting: false,
        }
    }

    /// Advances by `step` seconds, at whose end the platform is wanted to move as the coordinates say; `motion` is the
    /// same, in the base frame. `safety` are the limits of surge, sway and heave, which the wanted motion keeps.
    pub fn advance(&mut self, wanted: &Coordinates, motion: &PlatformMotion, safety: &SafetyParameters, step: f64) {
        let legs = inverse_kinematics(&self.geometry, motion);
        let wanted = State { coordinates: *wanted, motion: *motion, legs };
        if self.may_join(&wanted, safety, step) {
            self.acting = false;
            self.take(&wanted, step);
        } else {
            if !self.acting {
                self.braking = self.braking_from(&self.now.coordinates, &self.now.legs, safety);
            }
            self.acting = true;
            self.approach(&wanted, safety, step);
        }
    }

    /// Whether the motion at the step's end can be the wanted one.
    fn may_join(&self, wanted: &State, safety: &SafetyParameters, step: f64) -> bool {
        let joined = !self.acting || self.has_caught_up(wanted, safety, step);
        let share = if self.acting { REJOIN_SHARE } else { FULL_SHARE };
        joined && self.legs_can_go(&wanted.legs, share, step) && self.can_stop(wanted, safety)
    }

    /// Whether nobody would notice if the platform were where it is wanted.
    fn has_caught_up(&self, wanted: &State, safety: &SafetyParameters, step: f64) -> bool {
        let near = REJOIN_DISTANCE * self.limits.acceleration * step * step;
        let expected =
            |i: usize| self.now.legs.length[i] + 0.5 * (self.now.legs.velocity[i] + wanted.legs.velocity[i]) * step;
        let change = wanted.coordinates.linear.velocity - self.now.coordinates.linear.velocity;
        (0..6).all(|i| (wanted.legs.length[i] - expected(i)).abs() <= near)
            && (0..3).all(|k| change[k].abs() <= safety.acceleration_limit[k] * step)
    }

    /// Whether each leg can go there in this step, for whoever sees velocities and also for whoever sees positions only:
    /// the way's mean velocity, and the change of that from one step to the next. Where a velocity jumps within a step,
    /// the velocities at the steps' ends do not tell. `share` of the acceleration limit may be used.
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
            let way = next.length[i] - self.now.legs.length[i];
            can &= (next.velocity[i] - self.now.legs.velocity[i]).abs() <= change;
            can &= way.abs() <= farthest;
            // The mean velocities way/step, multiplied by both steps.
            can &= (way * last_step - self.last_ways[i] * step).abs() <= bend;
            // Leaves room for the step after, which may have to brake.
            can &= (next.velocity[i] * step - way).abs() <= room;
        }
        can
    }

    /// Whether the platform can come to rest from there within all limits.
    fn can_stop(&self, candidate: &State, safety: &SafetyParameters) -> bool {
        self.can_plainly_stop(candidate, safety) || {
            let braking = self.braking_from(&candidate.coordinates, &candidate.legs, safety);
            braking.keeps(&self.limits, &self.geometry, &candidate.coordinates, self.neutral_height)
        }
    }

    fn braking_from(&self, coordinates: &Coordinates, legs: &Legs, safety: &SafetyParameters) -> Braking {
        Braking::from(coordinates, fastest(legs), &self.limits, safety)
    }

    /// Whether it can so plainly that there is no need to look along the way: all coordinates brake in the same time, and
    /// no leg can get near an end of its stroke in that, nor to its limits of speed and acceleration.
    fn can_plainly_stop(&self, State { coordinates, motion, legs }: &State, safety: &SafetyParameters) -> bool {
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
            can &= ahead.abs().max(linear.position[k].abs()) <= safety.position_limit[k];
        }
        can
    }

    /// The platform goes as far towards the wanted motion as is allowed.
    fn approach(&mut self, wanted: &State, safety: &SafetyParameters, step: f64) {
        let braked = self.braking.after(&self.now.coordinates, step);
        let followed = self.followed(&wanted.legs, safety, step);
        let between = |share: f64| self.candidate(braked.towards(&followed, share, &self.now.coordinates, step));
        let allowed =
            |candidate: &State| self.legs_can_go(&candidate.legs, 1.0, step) && self.can_stop(candidate, safety);
        match farthest(between, allowed) {
            Some(candidate) => {
                self.braking = self.braking_from(&candidate.coordinates, &candidate.legs, safety);
                self.take(&candidate, step);
            }
            None => {
                let planned = self.candidate(braked.towards(&followed, 0.0, &self.now.coordinates, step));
                if self.legs_can_go(&planned.legs, FULL_SHARE, step) {
                    self.take(&planned, step);
                } else {
                    self.let_each_leg_follow(&wanted.legs, step);
                }
            }
        }
    }

    /// Where the platform gets to if each leg follows its target under its own limits, and surge, sway and heave keep
    /// theirs.
    fn followed(&self, target: &Legs, safety: &SafetyParameters, step: f64) -> Coordinates {
        let legs = self.each_leg_followed(target, step);
        let rates = Vector6::from(legs.map(|leg| leg.velocity));
        // The Jacobian where the platform will be, not where it is: the legs have to arrive without a jump.
        let ahead = self.now.coordinates.coasted(step).motion(self.neutral_height);
        let twist = jacobian(&self.geometry, &ahead.pose()).lu().solve(&rates).unwrap_or_else(Vector6::zeros);
        let velocity: Vector3<f64> = twist.fixed_rows::<3>(0).into();
        let rates = ahead.orientation.rates(twist.fixed_rows::<3>(3).into()).to_vector();
        let Coordinates { linear, angles } = &self.now.coordinates;
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
            let leg =
                Motion { position: self.now.legs.length[i], velocity: self.now.legs.velocity[i], acceleration: 0.0 };
            let goal = Motion { position: target.length[i], velocity: target.velocity[i], acceleration: 0.0 };
            self.limits.follow(&leg, &goal, CATCH_UP_SHARE * self.limits.acceleration, step)
        })
    }

    /// What is left if the plan of braking itself does not fit: each leg on its own keeps its limits, and the platform
    /// makes what they make. If forward kinematics does not find that (in a rig free of singularities it always does), the
    /// last pose known is reported.
    fn let_each_leg_follow(&mut self, target: &Legs, step: f64) {
        let followed = self.each_leg_followed(target, step);
        let legs = Legs { length: followed.map(|leg| leg.position), velocity: followed.map(|leg| leg.velocity) };
        let accelerations = followed.map(|leg| leg.acceleration);
        let motion = motion_of_legs(&self.geometry, &legs, &accelerations, &self.now.motion.pose())
            .unwrap_or_else(|_| PlatformMotion::at_rest(self.now.motion.pose()));
        let coordinates = Coordinates::reached(&motion, self.neutral_height, &self.now.coordinates, step);
        self.take(&State { coordinates, motion, legs }, step);
    }

    fn candidate(&self, coordinates: Coordinates) -> State {
        let motion = coordinates.motion(self.neutral_height);
        State { coordinates, motion, legs: inverse_kinematics(&self.geometry, &motion) }
    }

    /// Moves on.
    fn take(&mut self, next: &State, step: f64) {
        for i in 0..6 {
            self.last_ways[i] = next.legs.length[i] - self.now.legs.length[i];
            self.last_changes[i] = next.legs.velocity[i] - self.now.legs.velocity[i];
        }
        self.last_step = step;
        self.now = *next;
    }

    /// The commanded legs.
    pub fn legs(&self) -> &Legs {
        &self.now.legs
    }

    /// The accelerations of the commanded legs' lengths \[m/s2\]: over the last step while the guard acts.
    pub fn leg_accelerations(&self) -> [f64; 6] {
        if self.acting {
            self.last_changes.map(|change| change / self.last_step)
        } else {
            leg_accelerations(&self.geometry, &self.now.motion)
        }
    }

    /// The motion that the platform makes.
    pub fn motion(&self) -> &PlatformMotion {
        &self.now.motion
    }

    /// Whether the platform was held back in the last step.
    pub fn acting(&self) -> bool {
        self.acting
    }

    /// The smallest distance of a leg from either end of its stroke \[m\].
    pub fn stroke_margin(&self) -> f64 {
        self.margins().fold(f64::INFINITY, |smallest, (margin, _)| smallest.min(margin))
    }

    /// The time derivative of [`ActuatorGuard::stroke_margin`] \[m/s\].
    pub fn stroke_margin_rate(&self) -> f64 {
        let nearest = self.margins().fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
        nearest.1
    }

    /// Each leg's distance from each end of its stroke, and the rate of it.
    fn margins(&self) -> impl Iterator<Item = (f64, f64)> {
        let Legs { length, velocity } = self.now.legs;
        (0..6).flat_map(move |i| {
            [(length[i] - self.limits.min, velocity[i]), (self.limits.max - length[i], -velocity[i])]
        })
    }
}

/// The speed of the fastest leg \[m/s\].
fn fastest(legs: &Legs) -> f64 {
    legs.velocity.iter().fold(0.0, |fastest, velocity| velocity.abs().max(fastest))
}

/// The candidate farthest on the way from braking (share 0) to following (1) that is allowed, if any but braking is.
fn farthest(between: impl Fn(f64) -> State, allowed: impl Fn(&State) -> bool) -> Option<State> {
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
