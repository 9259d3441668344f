//! Filter chains whose coefficients change in motion.
//!
//! A chain with other coefficients starts with the platform's position and velocity, and may leave
//! them within a tenth of a second. The chain before therefore goes on beside it, and the motion
//! fades from one to the other over [`FADE_TIME`], without a jump up to the acceleration.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::bumpless::FadingOffset;
use super::chain::{Chains, Denominator};
use crate::motion::Motion;
use crate::motion::min_max::min;

/// Chains, and those before the last change while they fade.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FadedChains {
    chains: Chains,
    before: Chains,
    /// Correction to the input, after which the chains' high-pass is what it was before the change.
    offset: FadingOffset,
    /// Rest of the same correction of the chains before.
    offset_before: FadingOffset,
    /// The input at the end of the last step.
    input: Vector3<f64>,
    /// Fraction of the fade that has passed; 1 without one.
    fraction: f64,
    /// Coefficients that come into force once the fade is over.
    next: Option<[Denominator; 3]>,
    /// Number of states that make up the motion and are kept at a change.
    kept: usize,
}

/// Time in which the motion fades to that of other coefficients \[s\].
const FADE_TIME: f64 = 1.8;

impl FadedChains {
    /// Chains at rest, of which the first `kept` states make up the motion, ready for steps of
    /// `usual_step` seconds.
    pub fn new(denominators: [Denominator; 3], kept: usize, usual_step: f64) -> Self {
        let chains = Chains::new(denominators, usual_step);
        FadedChains {
            chains,
            before: chains,
            offset: FadingOffset::default(),
            offset_before: FadingOffset::default(),
            input: Vector3::zeros(),
            fraction: 1.0,
            next: None,
            kept,
        }
    }

    /// Changes the coefficients. A change during a fade waits for its end.
    pub fn retune(&mut self, denominators: [Denominator; 3]) {
        if self.fraction < 1.0 {
            self.next = Some(denominators);
        } else if self.chains.denominators() != &denominators {
            self.before = self.chains;
            self.chains.retune(denominators, self.kept);
            if !self.chains.is_at_rest() {
                self.fraction = 0.0;
                self.offset_before = self.offset;
                self.offset.add(self.before.high_pass(self.input) - self.chains.high_pass(self.input));
            }
        }
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`.
    #[inline(always)]
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) {
        self.input = end;
        if self.fraction >= 1.0 && self.offset.is_over() {
            self.chains.advance(start, end, step);
        } else {
            self.advance_fade(start, end, step);
        }
    }

    #[cold]
    fn advance_fade(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) {
        let both = [(&mut self.chains, &mut self.offset), (&mut self.before, &mut self.offset_before)];
        for (chains, offset) in both {
            let (offset_start, offset_end) = offset.advance(step);
            chains.advance(start + offset_start, end + offset_end, step);
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
        let of = |chains: &Chains, input: Vector3<f64>| Motion {
            position: chains.second_integral(),
            velocity: chains.first_integral(),
            acceleration: chains.high_pass(input),
        };
        let motion = of(&self.chains, self.corrected_input());
        if self.fraction >= 1.0 {
            motion
        } else {
            self.faded(&of(&self.before, self.input + self.offset_before.value()), &motion)
        }
    }

    /// The first integral of the high-pass, and the high-pass itself.
    #[inline(always)]
    pub fn angle_and_rate(&self) -> (Vector3<f64>, Vector3<f64>) {
        let of = |chains: &Chains, input: Vector3<f64>| Motion {
            position: chains.first_integral(),
            velocity: chains.high_pass(input),
            acceleration: Vector3::zeros(),
        };
        let mut motion = of(&self.chains, self.corrected_input());
        if self.fraction < 1.0 {
            motion = self.faded(&of(&self.before, self.input + self.offset_before.value()), &motion);
        }
        (motion.position, motion.velocity)
    }

    #[inline(always)]
    fn corrected_input(&self) -> Vector3<f64> {
        if self.offset.is_over() { self.input } else { self.input + self.offset.value() }
    }

    /// The motion at this fraction of the way from one to the other.
    #[cold]
    fn faded(&self, before: &Motion<Vector3<f64>>, after: &Motion<Vector3<f64>>) -> Motion<Vector3<f64>> {
        let t = self.fraction;
        // The smoothest step from 0 to 1 of fifth order, with its derivatives.
        let weight = t * t * t * (10.0 + t * (6.0 * t - 15.0));
        let slope = 30.0 * t * t * (1.0 - t) * (1.0 - t) / FADE_TIME;
        let bend = 60.0 * t * (1.0 - t) * (1.0 - 2.0 * t) / (FADE_TIME * FADE_TIME);
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
    /// [`FadedChains::motion`] has them.
    pub fn set_motion(&mut self, position: &Vector3<f64>, velocity: &Vector3<f64>) {
        if self.fraction >= 1.0 {
            return self.chains.set_integrals(velocity, position);
        }
        let demanded = self.motion();
        for chains in [&mut self.chains, &mut self.before] {
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
            return self.chains.set_first_integral(angle);
        }
        let (demanded, _) = self.angle_and_rate();
        for chains in [&mut self.chains, &mut self.before] {
            let angle = chains.first_integral() + angle - demanded;
            chains.set_first_integral(&angle);
        }
    }
}
