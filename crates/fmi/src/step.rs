//! Communication steps.

use moris_interface::{Model, SlotModel};

use crate::{CallError, Instance};

/// Tolerance of a step's end beyond a limit, relative to the limit.
const LIMIT_TOLERANCE: f64 = 1e-9;
/// Most of a step by which the rounding of a host in single precision may shift its time. A step
/// that is repeated or left out is off by a whole one.
const MOST_ROUNDING: f64 = 0.9;
/// Number of the step whose input is checked. Some hosts connect inputs from the second step on,
/// and write zeros before.
const CHECKED_STEP: u8 = 2;

/// The rounding of a time that the host has in single precision \[s\]: a unit in the last place.
/// A half is that of the time itself, a half that of the one before, to which the host has added a
/// step. 0 for a time that only double precision has.
fn single_rounding(time: f64) -> f64 {
    if f64::from(time as f32) == time { f64::from(f32::EPSILON) * time.abs() } else { 0.0 }
}

/// Deviation of a step's beginning that is rounding \[s\].
fn time_tolerance(time: f64, step: f64) -> f64 {
    // Tolerance of a host's time, relative to the step ...
    const STEP_TOLERANCE: f64 = 1e-6;
    // ... and to the time itself: a few units in the last place. A larger one would accept a
    // repeated step late in a long simulation, or at a calendar's time.
    const TIME_TOLERANCE: f64 = 8.0 * f64::EPSILON;
    let double = TIME_TOLERANCE * time.abs() + STEP_TOLERANCE * step;
    double.max(single_rounding(time).min(MOST_ROUNDING * step))
}

/// Time beyond the stop time that is rounding \[s\].
fn stop_tolerance(stop: f64, time: f64, step: f64) -> f64 {
    let double = LIMIT_TOLERANCE * (stop.abs() + step);
    double.max(single_rounding(time).min(MOST_ROUNDING * step))
}

/// Longest step accepted by a model with this longest one \[s\], which a host in single precision
/// may have rounded up.
fn longest_accepted(longest: f64, step: f64) -> f64 {
    (longest * (1.0 + LIMIT_TOLERANCE)).max(longest + single_rounding(step))
}

impl<M: Model> Instance<M> {
    /// Advances from `time` by `step` \[s\]. The present time is then `time + step` as the host
    /// computes it, so that nothing accumulates. The inputs' derivatives hold for this step only.
    ///
    /// # Errors
    /// The step does not begin at the present time, is not positive, is too long, or ends beyond
    /// the stop time. Or the model is not initialized. Then nothing has changed.
    #[inline]
    pub fn step(&mut self, time: f64, step: f64) -> Result<(), CallError> {
        let end = time + step;
        let Some(model) = self.state.model.as_mut() else {
            return Err(CallError::error("the model is not initialized"));
        };
        let stop = self.state.experiment.and_then(|experiment| experiment.stop).unwrap_or(f64::INFINITY);
        let off = (time - self.state.time).abs();
        let fits = step > 0.0
            && end.is_finite()
            && off <= time_tolerance(time, step)
            && end <= stop + stop_tolerance(stop, time, step)
            && step <= longest_accepted(model.max_communication_step(), step);
        if !fits {
            return Err(self.why_no_step(time, step));
        }
        if self.first_steps < CHECKED_STEP {
            self.first_steps += 1;
            if self.first_steps == CHECKED_STEP {
                self.warnings.extend(M::input_warnings_in(&self.state.values));
            }
        }
        let derivatives = self.state.derivatives_given.then_some(&*self.state.derivatives);
        model.step_slots(&self.state.values, derivatives, step);
        model.write_outputs(&mut self.state.values);
        if self.state.derivatives_given {
            self.state.derivatives.fill(0.0);
            self.state.derivatives_given = false;
        }
        self.set_time(end);
        Ok(())
    }

    #[cold]
    #[inline(never)]
    fn why_no_step(&self, time: f64, step: f64) -> CallError {
        let (present, end) = (self.state.time, time + step);
        let stop = self.state.experiment.and_then(|experiment| experiment.stop).unwrap_or(f64::INFINITY);
        let longest = self.state.model.as_ref().map_or(f64::INFINITY, M::max_communication_step);
        CallError::error(if !(step > 0.0 && step.is_finite()) {
            format!(
                "the communication step size {step} is not a positive, finite number; pass the length of the step in seconds"
            )
        } else if !end.is_finite() {
            format!(
                "the communication point {time} is not a finite number, or the end of the step overflows; the present time is {present}"
            )
        } else if step > longest_accepted(longest, step) {
            format!(
                "the communication step size {step} is longer than {longest}, the longest possible; divide it or raise solver.maxStep"
            )
        } else if end > stop + stop_tolerance(stop, time, step) {
            format!(
                "the step from {time} to {end} goes beyond the stop time {stop} of the experiment; shorten it, or set up the experiment without a stop time"
            )
        } else {
            let rounding = single_rounding(time);
            let coarse = if rounding >= MOST_ROUNDING * step {
                format!("; in single precision, times are {rounding} s apart there: start at an earlier time")
            } else {
                String::new()
            };
            format!("the communication point {time} is not the present one, {present}: step from there{coarse}")
        })
    }
}
