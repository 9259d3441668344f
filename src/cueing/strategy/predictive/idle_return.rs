//! The way home: travel returns to neutral while the vehicle asks for nothing.
//!
//! The plan's weights of travel and velocity alone return at some 0.2 1/s, so that the platform
//! would stand centimetres from neutral long after a stop. Once the cue of an axis has been still
//! for a while, a force is felt beside the plan that brings travel x with velocity v back,
//! critically damped:
//!
//! ```text
//!     e = part * (-p (p x + 2 v)),   within the largest unnoticed force
//! ```

use serde::{Deserialize, Serialize};

use super::super::law::AxisState;

/// Pace p of the return \[rad/s\].
const RETURN_PACE: f64 = 1.2;
/// Largest force of the return, well below the threshold of 0.17 m/s2 \[m/s2\].
const MAX_RETURN_FORCE: f64 = 0.08;
/// A cue of up to this magnitude is still \[m/s2\].
const MAX_STILL_CUE: f64 = 0.05;
/// Stillness after which the return begins, the time in which it fades in, and that in which it
/// fades out \[s\].
const RETURN_DELAY: f64 = 1.0;
const FADE_IN: f64 = 3.0;
const FADE_OUT: f64 = 0.5;

/// The return of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct IdleReturn {
    /// Time for which the cue has been still \[s\].
    still: f64,
    /// Part of the return in force, 0 to 1.
    part: f64,
}

impl IdleReturn {
    /// Advances by `step` seconds with this cue; `unknown` is true if nothing is known of the time
    /// ahead.
    pub fn advance(&mut self, cue: f64, unknown: bool, step: f64) {
        let is_still = unknown && cue.abs() <= MAX_STILL_CUE;
        self.still = if is_still { (self.still + step).min(RETURN_DELAY) } else { 0.0 };
        let change = if self.still >= RETURN_DELAY { step / FADE_IN } else { -step / FADE_OUT };
        self.part = (self.part + change).clamp(0.0, 1.0);
    }

    /// The force to be felt beside the plan in this state of the axis \[m/s2\].
    pub fn force(&self, axis: &AxisState) -> f64 {
        let returning = -RETURN_PACE * (RETURN_PACE * axis.position + 2.0 * axis.velocity);
        self.part * returning.clamp(-MAX_RETURN_FORCE, MAX_RETURN_FORCE)
    }
}
