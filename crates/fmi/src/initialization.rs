//! From the start values to the first step.

use moris_interface::Model;

use crate::run::Experiment;
use crate::{Complaint, Instance, Mode};

impl<M: Model> Instance<M> {
    /// Defines between which times \[s\] the instance runs.
    ///
    /// # Errors
    /// A time or a tolerance that cannot be; then nothing has changed.
    pub fn define_experiment(
        &mut self,
        start: f64,
        stop: Option<f64>,
        tolerance: Option<f64>,
    ) -> Result<(), Complaint> {
        if !start.is_finite() {
            return Err(Complaint::error(format!("the start time {start} is not a finite number")));
        }
        if let Some(stop) = stop.filter(|stop| !stop.is_finite() || *stop < start) {
            return Err(Complaint::error(format!("the stop time {stop} is not a time after the start time {start}")));
        }
        if let Some(tolerance) = tolerance.filter(|tolerance| !(tolerance.is_finite() && *tolerance > 0.0)) {
            return Err(Complaint::error(format!("the tolerance {tolerance} is not a positive number")));
        }
        self.run.experiment = Some(Experiment { start, stop });
        self.set_time(start);
        Ok(())
    }

    /// Begins the initialization.
    ///
    /// # Errors
    /// No experiment has been defined; then nothing has changed.
    pub fn enter_initialization(&mut self) -> Result<(), Complaint> {
        if self.run.experiment.is_none() {
            return Err(Complaint::error("the experiment has not been set up"));
        }
        self.run.mode = Mode::Initialization;
        Ok(())
    }

    /// Ends the initialization: builds the model from the values as they are.
    ///
    /// # Errors
    /// The model refuses a value. Then the instance stays in initialization, so that another can be set.
    pub fn exit_initialization(&mut self) -> Result<(), Complaint> {
        if self.run.untried || self.run.model.is_none() {
            let model = M::new(&self.run.values).map_err(|refusal| {
                Complaint::error(format!("{refusal}. Initialization goes on: set another value and try again"))
            })?;
            self.run.untried = false;
            model.outputs(&mut self.run.values);
            self.run.model = Some(model);
        }
        self.run.mode = Mode::StepComplete;
        Ok(())
    }

    /// Makes the outputs those of the values set so far. If the model refuses these, the outputs stay as they are, and
    /// the end of the initialization will say why.
    pub(crate) fn try_values(&mut self) {
        self.run.model = M::new(&self.run.values).ok();
        self.run.untried = false;
        if let Some(model) = &self.run.model {
            model.outputs(&mut self.run.values);
        }
    }
}
