//! Everything that distinguishes an instance from a fresh one: what a state saves and restores.

use serde::{Deserialize, Serialize};

use crate::Mode;

/// The times between which an experiment runs \[s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Experiment {
    pub start: f64,
    pub stop: Option<f64>,
}

/// State of an instance: mode, time, values and the model.
#[derive(Debug, Serialize, Deserialize)]
pub struct InstanceState<M> {
    pub(crate) mode: Mode,
    /// The experiment, once the host has defined it.
    pub(crate) experiment: Option<Experiment>,
    /// The present communication point \[s\].
    pub(crate) time: f64,
    /// The value of each slot.
    pub(crate) values: Box<[f64]>,
    /// The time derivative of each slot; zero for all that are not inputs, and
    /// unless the host gives one.
    pub(crate) derivatives: Box<[f64]>,
    /// True if any of `derivatives` may differ from zero.
    pub(crate) derivatives_given: bool,
    /// The model: there from the end of initialization on, and before that whenever
    /// `values` has been tried.
    pub(crate) model: Option<M>,
    /// During initialization: something has been set since `values` was last tried.
    pub(crate) dirty: bool,
}

impl<M> InstanceState<M> {
    /// A run that has not begun, with these start values.
    pub(crate) fn fresh(start: &[f64]) -> Self {
        InstanceState {
            mode: Mode::Instantiated,
            experiment: None,
            time: 0.0,
            values: start.into(),
            derivatives: vec![0.0; start.len()].into(),
            derivatives_given: false,
            model: None,
            dirty: false,
        }
    }
}

impl<M: Clone> Clone for InstanceState<M> {
    fn clone(&self) -> Self {
        InstanceState {
            values: self.values.clone(),
            derivatives: self.derivatives.clone(),
            model: self.model.clone(),
            ..*self
        }
    }

    /// Copies into memory that is there already.
    fn clone_from(&mut self, source: &Self) {
        self.values.clone_from(&source.values);
        self.derivatives.clone_from(&source.derivatives);
        self.model.clone_from(&source.model);
        let InstanceState { mode, experiment, time, derivatives_given, dirty, .. } = *source;
        (self.mode, self.experiment, self.time) = (mode, experiment, time);
        (self.derivatives_given, self.dirty) = (derivatives_given, dirty);
    }
}
