//! A manoeuvre: sampled inputs of the vehicle model.

use std::sync::Arc;

use moris_washout::Input;

/// Inputs at equal steps, between which they go linearly.
#[derive(Clone, Debug)]
pub struct Manoeuvre {
    step: f64,
    inputs: Arc<Vec<Input>>,
}

impl Manoeuvre {
    /// Inputs every `step` seconds, the first at time 0.
    ///
    /// # Panics
    /// If the step is not positive.
    pub fn new(step: f64, inputs: Vec<Input>) -> Self {
        assert!(step > 0.0, "a manoeuvre's step must be positive, not {step}");
        Manoeuvre { step, inputs: inputs.into() }
    }

    /// Samples a function of time every `step` seconds over `duration` seconds.
    ///
    /// # Panics
    /// If the step is not positive.
    pub fn sampled(step: f64, duration: f64, input: impl Fn(f64) -> Input) -> Self {
        let count = (duration / step).round() as usize;
        Manoeuvre::new(step, (0..=count).map(|k| input(k as f64 * step)).collect())
    }

    /// Time between inputs \[s\].
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Inputs at all samples.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The inputs, shared without a copy.
    pub fn shared_inputs(&self) -> Arc<Vec<Input>> {
        Arc::clone(&self.inputs)
    }

    /// Time from the first input to the last \[s\].
    pub fn duration(&self) -> f64 {
        self.step * self.inputs.len().saturating_sub(1) as f64
    }
}
