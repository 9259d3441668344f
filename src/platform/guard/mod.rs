//! The actuator guard: stroke, speed and acceleration of each leg are limits of the machine, and no command exceeds them.
//!
//! A motion is allowed if the platform can come to rest from it, by a plan of [`Braking`] on which the legs keep their
//! limits and the platform its safety limits. While what is wanted is allowed, the guard passes it on. When it is not,
//! the platform goes as far towards it as is allowed; in the worst case it does what it planned before, and brakes. So
//! there is always something left to do that keeps every limit.

mod hold_back;

use serde::{Deserialize, Serialize};

use super::stop_plan::{ACCELERATION_SHARE, Braking, LEG_SHARE, braking_time};
use super::{Coordinates, Geometry, Legs, PlatformMotion, Pose, inverse_kinematics, leg_accelerations};
use crate::interface::{Rig, SafetyParameters};
use crate::motion::braking_law::{FULL_SHARE, Limits, REJOIN_DISTANCE, REJOIN_SHARE, ROUNDING};
use crate::motion::extremes::{larger, smaller};

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
#[derive(Clone, Copy)]
struct Candidate<'a> {
    coordinates: &'a Coordinates,
    motion: &'a PlatformMotion,
    legs: &'a Legs,
}

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
        if self.may_join(Candidate { coordinates: wanted, motion, legs: &legs }, safety, step) {
            self.held_back = None;
            self.take(motion, &legs, step);
        } else {
            self.hold_back(&legs, safety, step);
        }
        self.wanted = *wanted;
    }

    /// Whether the motion at the step's end can be the wanted one.
    #[inline(always)]
    fn may_join(&self, wanted: Candidate, safety: &SafetyParameters, step: f64) -> bool {
        let joined = !self.acting() || self.has_caught_up(wanted.coordinates, wanted.legs, safety, step);
        let share = if self.acting() { REJOIN_SHARE } else { FULL_SHARE };
        joined && self.legs_can_go(wanted.legs, share, step) && self.can_stop(wanted, safety)
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
    fn can_stop(&self, candidate: Candidate, safety: &SafetyParameters) -> bool {
        self.can_plainly_stop(candidate, safety) || self.can_stop_by_plan(candidate.coordinates, candidate.legs, safety)
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
    fn can_plainly_stop(&self, candidate: Candidate, safety: &SafetyParameters) -> bool {
        let Candidate { coordinates, motion, legs } = candidate;
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
