//! Automatic scale: a factor on force and rates, as large as the rig can give them the right way
//! round.
//!
//! A rig that is asked for more than it has gives the right amount at the wrong time. The `bank`
//! moves shadow platforms at fixed scales beside the real one, and compares what each would feel
//! with what it should. The largest scale whose shape error is small enough is the goal. The
//! factor goes there, fast when it falls and slowly when it rises. A scale is lowered only where a
//! lower one would have been better.
//!
//! Where the force is previewed, the shadows foresee it as the platform does (`ahead`).
//!
//! The factor acts in front of everything that limits: no limit depends on it. Heave keeps its
//! size.

mod ahead;
mod bank;
mod platform;

use moris_interface::ParameterError;
use serde::{Deserialize, Serialize};

use self::bank::Bank;
use crate::cueing::strategy::Unsolvable;
use crate::cueing::strategy::predictive::preview::PreviewedCue;
use crate::interface::{AutomaticScale, AutomaticScaleParameters, Parameters};
use crate::motion::min_max::{max, min};

/// The factor, and what it is chosen by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FittingScale {
    factor: f64,
    /// Relative rate of change of the factor \[1/s\], until the bank's next sample.
    rate: f64,
    /// None while the scale is not automatic.
    bank: Option<Bank>,
}

/// Largest relative rate at which the factor falls \[1/s\].
const FASTEST_FALL: f64 = 1.0;
/// Time constant with which a factor that is no longer automatic returns to 1 \[s\].
const RETURN_TIME: f64 = 2.0;
/// A factor as near to 1 as this is 1.
const UNITY_TOLERANCE: f64 = 1e-6;

impl FittingScale {
    /// Before the ride.
    ///
    /// # Errors
    /// There is no regulator for the platform's limits.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        let bank = new_bank(parameters)?;
        Ok(FittingScale {
            factor: if bank.is_some() { parameters.automatic_scale.start } else { 1.0 },
            rate: 0.0,
            bank,
        })
    }

    /// Takes other parameters. The factor continues from its value; it begins anew if the scale
    /// becomes automatic while nothing is cued.
    ///
    /// # Errors
    /// There is no regulator for the platform's limits. Nothing has changed then.
    pub fn retune(&mut self, parameters: &Parameters, nothing_cued: bool) -> Result<(), ParameterError> {
        let is_automatic = parameters.automatic_scale.automatic == AutomaticScale::On;
        match &mut self.bank {
            Some(bank) if is_automatic => bank.retune(parameters).map_err(Unsolvable::of_automatic_scale)?,
            None if !is_automatic => {}
            _ if nothing_cued => *self = Self::new(parameters)?,
            bank => *bank = new_bank(parameters)?,
        }
        Ok(())
    }

    /// The factor now.
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// Rate of the factor now \[1/s\].
    pub fn factor_rate(&self) -> f64 {
        self.rate * self.factor
    }

    /// True while the factor is chosen.
    pub fn is_automatic(&self) -> bool {
        self.bank.is_some()
    }

    /// Sets the courses that the references will take, if they are previewed.
    pub fn preview(&mut self, courses: &[PreviewedCue; 2]) {
        self.bank.iter_mut().for_each(|bank| bank.preview(courses));
    }

    /// Delays courses that have just been given by `lag` seconds.
    pub fn delay_preview(&mut self, lag: f64) {
        self.bank.iter_mut().for_each(|bank| bank.delay_preview(lag));
    }

    /// Advances by `step` seconds. `references` are the forces of surge and sway at the step's end
    /// that would be cued at a factor of 1 without a limit \[m/s2\].
    pub fn advance(&mut self, references: [f64; 2], parameters: &Parameters, step: f64) {
        match &mut self.bank {
            Some(bank) => {
                let AutomaticScaleParameters { automatic: _, error, memory, fall_time, rise_time, start: _ } =
                    parameters.automatic_scale;
                if let Some(goal) = bank.advance(references, &parameters.conditioning.force_limit, error, memory, step)
                {
                    let distance = libm::log(goal.scale / self.factor);
                    self.rate = if distance < 0.0 {
                        max(distance / fall_time, -FASTEST_FALL)
                    } else {
                        goal.activity * distance / rise_time
                    };
                }
                self.factor = min(self.factor * (1.0 + self.rate * step), 1.0);
            }
            None if self.factor == 1.0 => {}
            None => self.return_to_one(step),
        }
    }

    fn return_to_one(&mut self, step: f64) {
        self.rate = (1.0 - self.factor) / (self.factor * RETURN_TIME);
        self.factor += self.factor * self.rate * step;
        if 1.0 - self.factor < UNITY_TOLERANCE {
            (self.factor, self.rate) = (1.0, 0.0);
        }
    }
}

/// The bank that the parameters ask for, at rest.
fn new_bank(parameters: &Parameters) -> Result<Option<Bank>, ParameterError> {
    match parameters.automatic_scale.automatic {
        AutomaticScale::Off => Ok(None),
        AutomaticScale::On => Bank::new(parameters).map(Some).map_err(Unsolvable::of_automatic_scale),
    }
}
