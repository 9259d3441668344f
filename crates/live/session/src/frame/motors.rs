//! The motors of cranks: their angles in the units that controllers take.

use std::f64::consts::{PI, TAU};

use moris_washout::Rig;

use super::{Frames, FramesError};

/// Names of the units, each with a number from 1 for the crank.
pub const MOTOR_UNITS: [&str; 4] = ["radians", "degrees", "pulse", "steps"];

/// Arcs of the arms to numbers of their motors, and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motors {
    /// Length of an arm \[m\]; 0 for a rig with legs.
    arm: f64,
    /// Angle of each motor while its arm is level \[rad\].
    zero: [f64; 6],
    /// Motors that turn against their arms.
    reversed: [bool; 6],
    /// Number per radian, and at an angle of 0, for each of [`MOTOR_UNITS`].
    scale: [[f64; 2]; 4],
}

impl Motors {
    /// Motors of this rig's cranks, as the frames describe them.
    pub fn new(frames: &Frames, rig: &Rig) -> Self {
        let pulse_per_radian = frames.pulse_per_degree.unwrap_or_default() * 180.0 / PI;
        let steps_per_radian = frames.steps_per_turn.unwrap_or_default() / TAU;
        Motors {
            arm: rig.crank_arm,
            zero: frames.zero_degrees.map(f64::to_radians),
            reversed: std::array::from_fn(|crank| frames.reversed.contains(&(crank + 1))),
            scale: [[1.0, 0.0], [180.0 / PI, 0.0], [pulse_per_radian, frames.pulse_centre], [steps_per_radian, 0.0]],
        }
    }

    /// Checks that the frames say how large a unit of [`MOTOR_UNITS`] is.
    ///
    /// # Errors
    /// The size is missing.
    pub fn check(&self, unit: usize) -> Result<(), FramesError> {
        match (MOTOR_UNITS[unit], self.scale[unit][0]) {
            ("pulse", 0.0) => {
                Err(FramesError::Range("pulse1 needs pulse-per-degree, the servo's change in us per degree"))
            }
            ("steps", 0.0) => {
                Err(FramesError::Range("steps1 needs steps-per-turn, the motor's steps in a turn of the arm"))
            }
            _ => Ok(()),
        }
    }

    /// The number of a motor in one of [`MOTOR_UNITS`] for its arm's arc \[m\].
    pub fn number(&self, unit: usize, crank: usize, arc: f64) -> f64 {
        let [per_radian, at_zero] = self.scale[unit];
        let angle = arc / self.arm;
        let turned = if self.reversed[crank] { -angle } else { angle };
        at_zero + per_radian * (self.zero[crank] + turned)
    }

    /// The arc of an arm \[m\] for its motor's number, as [`Motors::number`] gives it.
    pub fn arc(&self, unit: usize, crank: usize, number: f64) -> f64 {
        let [per_radian, at_zero] = self.scale[unit];
        let turned = (number - at_zero) / per_radian - self.zero[crank];
        self.arm * if self.reversed[crank] { -turned } else { turned }
    }
}
