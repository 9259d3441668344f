//! The experiment's times and the initialization.

use moris_interface::{Model, SlotModel};

use crate::instance_state::Experiment;
use crate::{CallError, Instance, Mode};

impl<M: Model> Instance<M> {
    /// Sets the start and stop time \[s\]. An infinite stop time is none, and the tolerance is not
    /// used: 0 is the value of hosts that have none.
    ///
    /// # Errors
    /// A time or the tolerance is out of range. Then nothing has changed.
    pub fn define_experiment(
        &mut self,
        start: f64,
        stop: Option<f64>,
        tolerance: Option<f64>,
    ) -> Result<(), CallError> {
        if !start.is_finite() {
            return Err(CallError::error(format!(
                "the start time {start} is not a finite number; pass a time in seconds"
            )));
        }
        if let Some(stop) = stop.filter(|stop| stop.is_nan() || *stop < start) {
            return Err(CallError::error(format!(
                "the stop time {stop} must be a number and at least the start time {start}"
            )));
        }
        if let Some(tolerance) = tolerance.filter(|tolerance| !(tolerance.is_finite() && *tolerance >= 0.0)) {
            return Err(CallError::error(format!(
                "the tolerance {tolerance} must be finite and not negative; it is not used"
            )));
        }
        let stop = stop.filter(|stop| stop.is_finite());
        self.state.experiment = Some(Experiment { start, stop });
        self.set_time(start);
        Ok(())
    }

    /// Begins the initialization.
    ///
    /// # Errors
    /// No experiment has been defined. Then nothing has changed.
    pub fn enter_initialization(&mut self) -> Result<(), CallError> {
        if self.state.experiment.is_none() {
            return Err(CallError::error("the experiment has not been set up"));
        }
        self.state.mode = Mode::Initialization;
        Ok(())
    }

    /// Ends the initialization: builds the model from the values as they are.
    ///
    /// # Errors
    /// The model refuses a value. Then the instance stays in initialization, so
    /// that another can be set.
    pub fn exit_initialization(&mut self) -> Result<(), CallError> {
        if self.state.dirty || self.state.model.is_none() {
            let model = M::from_slots(&self.state.values).map_err(|error| {
                CallError::error(format!("{error}. Initialization goes on: set another value and try again"))
            })?;
            self.state.dirty = false;
            model.write_outputs(&mut self.state.values);
            self.state.model = Some(model);
        }
        self.warnings.extend(M::warnings_in(&self.state.values));
        self.state.mode = Mode::StepComplete;
        Ok(())
    }

    /// Makes the outputs those of the values set so far. If the model refuses these, the outputs
    /// stay as they are, and the end of the initialization will say why.
    pub(crate) fn evaluate_start(&mut self) {
        self.state.model = M::from_slots(&self.state.values).ok();
        self.state.dirty = false;
        if let Some(model) = &self.state.model {
            model.write_outputs(&mut self.state.values);
        }
    }
}
