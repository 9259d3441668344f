//! Communication steps.

use moris_interface::Model;

use crate::{Complaint, Instance};

/// Tolerance of a step's end beyond a limit, relative to the limit.
const LIMIT_TOLERANCE: f64 = 1e-9;
/// Tolerance of a host's time, relative to the step ...
const STEP_TOLERANCE: f64 = 1e-6;
/// ... and to the time itself: a few units in the last place. More would let a step be made twice late in a long run, or
/// where time is that of a calendar.
const TIME_TOLERANCE: f64 = 8.0 * f64::EPSILON;

impl<M: Model> Instance<M> {
    /// Advances from `time` by `step` \[s\]. The present time is then `time + step` as the host reckons it, so that
    /// nothing accumulates. The inputs' derivatives hold for this step only.
    ///
    /// # Errors
    /// A step that cannot be made; then nothing has changed.
    #[inline]
    pub fn step(&mut self, time: f64, step: f64) -> Result<(), Complaint> {
        let end = time + step;
        let Some(model) = self.run.model.as_mut() else { return Err(Complaint::error("the model is not initialized")) };
        let stop = self.run.experiment.and_then(|experiment| experiment.stop).unwrap_or(f64::INFINITY);
        let off = (time - self.run.time).abs();
        let fits = step > 0.0
            && end.is_finite()
            && off <= TIME_TOLERANCE * time.abs() + STEP_TOLERANCE * step
            && end <= stop + LIMIT_TOLERANCE * (stop.abs() + step)
            && step <= model.longest_step() * (1.0 + LIMIT_TOLERANCE);
        if !fits {
            return Err(self.why_no_step(time, step));
        }
        let derivatives = self.run.derivatives_given.then_some(&*self.run.derivatives);
        model.step(&self.run.values, derivatives, step);
        model.outputs(&mut self.run.values);
        if self.run.derivatives_given {
            self.run.derivatives.fill(0.0);
            self.run.derivatives_given = false;
        }
        self.set_time(end);
        Ok(())
    }

    #[cold]
    #[inline(never)]
    fn why_no_step(&self, time: f64, step: f64) -> Complaint {
        let (present, end) = (self.run.time, time + step);
        let stop = self.run.experiment.and_then(|experiment| experiment.stop).unwrap_or(f64::INFINITY);
        let longest = self.run.model.as_ref().map_or(f64::INFINITY, M::longest_step);
        Complaint::error(if !(step > 0.0 && step.is_finite()) {
            format!("the communication step size {step} is not a positive, finite number")
        } else if !end.is_finite() {
            format!("the communication point {time} is not a finite number, or the step ends beyond all numbers")
        } else if step > longest * (1.0 + LIMIT_TOLERANCE) {
            format!("the communication step size {step} is longer than {longest}, the longest possible here")
        } else if end > stop + LIMIT_TOLERANCE * (stop.abs() + step) {
            format!("the step from {time} to {end} goes beyond the stop time {stop} that was set up")
        } else {
            format!("the communication point {time} is not the present one, {present}: step from there")
        })
    }
}
