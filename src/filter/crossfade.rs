//! Filter chains whose coefficients change in motion.
//!
//! A chain with other coefficients starts with the platform's position and velocity, and may leave
//! them within a tenth of a second. The chain before therefore goes on beside it, and the motion
//! fades from one to the other over [`FADE_TIME`], without a jump up to the acceleration.

use core::f64::consts::TAU;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::bumpless::DecayingOffset;
use super::chain::{Chains, Denominator};
use crate::motion::Motion;
use crate::motion::min_max::min;

/// Chains with a correction to their input, after which their high-pass is what it was before they
/// were changed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct CorrectedChains {
    chains: Chains,
    offset: DecayingOffset,
}

impl CorrectedChains {
    fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) {
        let (offset_start, offset_end) = self.offset.advance(step);
        self.chains.advance(start + offset_start, end + offset_end, step);
    }

    #[inline(always)]
    fn corrected(&self, input: Vector3<f64>) -> Vector3<f64> {
        if self.offset.is_over() { input } else { input + self.offset.value() }
    }

    /// The second and the first integral of the high-pass, and the high-pass itself.
    #[inline(always)]
    fn motion(&self, input: Vector3<f64>) -> Motion<Vector3<f64>> {
        Motion {
            position: self.chains.second_integral(),
            velocity: self.chains.first_integral(),
            acceleration: self.chains.high_pass(self.corrected(input)),
        }
    }

    /// The first integral of the high-pass, and the high-pass itself, as position and velocity.
    #[inline(always)]
    fn angle_and_rate(&self, input: Vector3<f64>) -> Motion<Vector3<f64>> {
        Motion {
            position: self.chains.first_integral(),
            velocity: self.chains.high_pass(self.corrected(input)),
            acceleration: Vector3::zeros(),
        }
    }
}

/// Chains, and those before the last change while they fade.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrossfadedChains {
    now: CorrectedChains,
    before: CorrectedChains,
    /// The input at the end of the last step.
    input: Vector3<f64>,
    /// Fraction of the fade that has passed; 1 without one.
    fraction: f64,
    /// Coefficients that come into force once the fade is over.
    next: Option<[Denominator; 3]>,
    /// Number of states that make up the motion and are kept at a change.
    kept_states: usize,
}

/// Time in which the motion fades to that of other coefficients \[s\].
const FADE_TIME: f64 = 1.98;

impl CrossfadedChains {
    /// Chains at rest whose motion is a position and a velocity, ready for steps of `max_step`
    /// seconds.
    pub fn of_position(denominators: [Denominator; 3], max_step: f64) -> Self {
        CrossfadedChains::new(denominators, 2, max_step)
    }

    /// Chains at rest whose motion is an angle, ready for steps of `max_step` seconds.
    pub fn of_angle(denominators: [Denominator; 3], max_step: f64) -> Self {
        CrossfadedChains::new(denominators, 1, max_step)
    }

    fn new(denominators: [Denominator; 3], kept_states: usize, max_step: f64) -> Self {
        let now = CorrectedChains { chains: Chains::new(denominators, max_step), offset: DecayingOffset::default() };
        CrossfadedChains { now, before: now, input: Vector3::zeros(), fraction: 1.0, next: None, kept_states }
    }

    /// Changes the coefficients. A change during a fade waits for its end.
    pub fn retune(&mut self, denominators: [Denominator; 3]) {
        if self.fraction < 1.0 {
            self.next = Some(denominators);
        } else if self.now.chains.denominators() != &denominators {
            self.before = self.now;
            let CorrectedChains { chains, offset } = &mut self.now;
            chains.retune(denominators, self.kept_states);
            if !chains.is_at_rest() {
                self.fraction = 0.0;
                offset.add(self.before.chains.high_pass(self.input) - chains.high_pass(self.input));
            }
        }
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`.
    #[inline(always)]
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) {
        self.input = end;
        if self.fraction >= 1.0 && self.now.offset.is_over() {
            self.now.chains.advance(start, end, step);
        } else {
            self.advance_fade(start, end, step);
        }
    }

    #[cold]
    fn advance_fade(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) {
        for corrected in [&mut self.now, &mut self.before] {
            corrected.advance(start, end, step);
        }
        self.fraction = min(self.fraction + step / FADE_TIME, 1.0);
        if self.fraction == 1.0
            && let Some(next) = self.next.take()
        {
            self.retune(next);
        }
    }

    /// The second and the first integral of the high-pass, and the high-pass itself.
    #[inline(always)]
    pub fn motion(&self) -> Motion<Vector3<f64>> {
        let motion = self.now.motion(self.input);
        if self.fraction >= 1.0 { motion } else { self.faded(CorrectedChains::motion, &motion) }
    }

    /// The first integral of the high-pass, and the high-pass itself.
    #[inline(always)]
    pub fn angle_and_rate(&self) -> (Vector3<f64>, Vector3<f64>) {
        let mut motion = self.now.angle_and_rate(self.input);
        if self.fraction < 1.0 {
            motion = self.faded(CorrectedChains::angle_and_rate, &motion);
        }
        (motion.position, motion.velocity)
    }

    /// The motion at this fraction of the way from that `of` the chains before to the one after.
    #[cold]
    fn faded(
        &self,
        of: fn(&CorrectedChains, Vector3<f64>) -> Motion<Vector3<f64>>,
        after: &Motion<Vector3<f64>>,
    ) -> Motion<Vector3<f64>> {
        let before = of(&self.before, self.input);
        // A cycloid: its third derivative, which times a distance of positions is felt as a jolt, is as
        // large at the ends as in the middle.
        let (sin, cos) = libm::sincos(TAU * self.fraction);
        let weight = self.fraction - sin / TAU;
        let slope = (1.0 - cos) / FADE_TIME;
        let bend = TAU * sin / (FADE_TIME * FADE_TIME);
        let position = after.position - before.position;
        let velocity = after.velocity - before.velocity;
        let acceleration = after.acceleration - before.acceleration;
        Motion {
            position: before.position + weight * position,
            velocity: before.velocity + weight * velocity + slope * position,
            acceleration: before.acceleration + weight * acceleration + 2.0 * slope * velocity + bend * position,
        }
    }

    /// Continues from a motion that is not the one demanded: its position and velocity, as
    /// [`CrossfadedChains::motion`] has them.
    pub fn set_motion(&mut self, position: &Vector3<f64>, velocity: &Vector3<f64>) {
        if self.fraction >= 1.0 {
            return self.now.chains.set_integrals(velocity, position);
        }
        let demanded = self.motion();
        for CorrectedChains { chains, .. } in [&mut self.now, &mut self.before] {
            let velocity = chains.first_integral() + velocity - demanded.velocity;
            let position = chains.second_integral() + position - demanded.position;
            chains.set_integrals(&velocity, &position);
        }
    }

    /// Sets the input at the end of the last step.
    pub fn set_input(&mut self, input: Vector3<f64>) {
        self.input = input;
    }

    /// Continues from an angle that is not the one demanded.
    pub fn set_angle(&mut self, angle: &Vector3<f64>) {
        if self.fraction >= 1.0 {
            return self.now.chains.set_first_integral(angle);
        }
        let (demanded, _) = self.angle_and_rate();
        for CorrectedChains { chains, .. } in [&mut self.now, &mut self.before] {
            let angle = chains.first_integral() + angle - demanded;
            chains.set_first_integral(&angle);
        }
    }
}
