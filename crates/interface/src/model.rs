//! The trait of a model, for those who host it.

use alloc::{string::String, vec::Vec};

use serde::{Serialize, de::DeserializeOwned};

use crate::units::S;
use crate::{Causality, Group, Row, Slot, interface, slot_of};

/// Name, version and variables of a model.
#[derive(Clone, Copy, Debug)]
pub struct Identity {
    /// The name, also a legal C identifier: FMI's modelName and modelIdentifier.
    pub name: &'static str,
    pub version: &'static str,
    /// A sentence or two on what the model does.
    pub text: &'static str,
    /// The rows of time, inputs, outputs and parameters, in this order, and their slots.
    pub rows: &'static [Row],
    pub slots: &'static [Slot],
    /// The default experiment's stop time and step \[s\].
    pub stop_time: f64,
    pub step_size: f64,
}

interface! {
    /// The independent variable, the first of every model.
    pub struct Time: Independent, Continuous {
        /// Simulation time.
        "time" time: f64 [S] = 0.0;
    }
}

impl Identity {
    /// The row that a slot belongs to.
    pub fn row(&self, slot: usize) -> &'static Row {
        &self.rows[usize::from(self.slots[slot].row)]
    }

    /// The name of a slot's variable.
    pub fn variable_name(&self, slot: usize) -> String {
        self.row(slot).variable_name(usize::from(self.slots[slot].element))
    }

    /// The slots in the order in which descriptions list them: everything but parameters,
    /// the main parameters, the other parameters; otherwise in their own order. The slots
    /// of a row stay together.
    pub fn listed_slots(&self) -> Vec<usize> {
        let rank = |&slot: &usize| {
            let row = self.row(slot);
            (row.causality == Causality::Parameter, row.importance_rank.unwrap_or(u8::MAX))
        };
        let mut slots: Vec<usize> = (0..self.slots.len()).collect();
        slots.sort_by_key(rank);
        slots
    }

    /// The slot of the variable of this name.
    pub fn slot(&self, name: &str) -> Option<usize> {
        slot_of(self.rows, name).map(|(slot, _)| slot)
    }
}

/// Why a set of parameters cannot be used: which variable, its value, and the reason.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{variable}: {reason}")]
pub struct ParameterError {
    pub variable: String,
    pub reason: String,
}

/// An error: this variable cannot be used, for this reason.
///
/// # Errors
/// Always.
pub fn refuse<T>(variable: impl Into<String>, reason: impl Into<String>) -> Result<T, ParameterError> {
    Err(ParameterError { variable: variable.into(), reason: reason.into() })
}

/// Shorter steps than this do nothing: a change of the input in so short a time is lost to rounding
/// \[s\].
pub const SHORTEST_STEP: f64 = 1e-12;

/// Largest number of internal steps in a communication step.
pub const MOST_INTERNAL_STEPS: f64 = 1e6;

/// A model that a host steps, in terms of its structs of variables.
///
/// ```
/// use moris_interface::units::M;
/// use moris_interface::{Group, Identity, Model, ParameterError, SlotModel, interface, variables};
/// use serde::{Deserialize, Serialize};
///
/// interface! {
///     /// The signal.
///     pub struct Input: Input, Continuous {
///         /// Length.
///         "length" length: f64 [M] = 1.0;
///     }
/// }
/// interface! {
///     /// The delayed signal.
///     pub struct Output: Output, Continuous {
///         /// Length at the last step's end.
///         "delayed" delayed: f64 [M] = 1.0;
///     }
/// }
/// interface! {
///     /// Parameters.
///     pub struct Parameters: Parameter, Tunable {
///         /// Ratio of output to input.
///         "gain" gain: f64 { 0.0 ..= 10.0 } = 1.0;
///     }
/// }
/// variables!(Input, Output, Parameters);
///
/// #[derive(Clone, Serialize, Deserialize)]
/// struct Gain(Parameters, f64);
///
/// impl Model for Gain {
///     type Input = Input;
///     type Output = Output;
///     type Parameters = Parameters;
///     const IDENTITY: Identity = Identity {
///         name: "Gain",
///         version: "1",
///         text: "A gain.",
///         rows: Variables::ROWS,
///         slots: Variables::SLOTS,
///         stop_time: 1.0,
///         step_size: 0.01,
///     };
///     fn new(parameters: &Parameters, input: &Input) -> Result<Self, ParameterError> {
///         Ok(Gain(*parameters, parameters.gain * input.length))
///     }
///     fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
///         self.0 = *parameters;
///         Ok(())
///     }
///     fn step_between(&mut self, _start: &Input, end: &Input, _step: f64) {
///         self.1 = self.0.gain * end.length;
///     }
///     fn output(&self) -> Output {
///         Output { delayed: self.1 }
///     }
///     fn output_derivative(&self) -> Output {
///         Output { delayed: 0.0 }
///     }
/// }
///
/// // The slots are time, length, delayed and gain.
/// let mut slots = [0.0; 4];
/// Gain::start_slots(&mut slots);
/// slots[3] = 3.0;
/// let mut model = Gain::from_slots(&slots)?;
/// slots[1] = 2.0;
/// model.step_slots(&slots, None, 0.01);
/// model.write_outputs(&mut slots);
/// assert_eq!(slots, [0.0, 2.0, 6.0, 3.0]);
/// # Ok::<(), ParameterError>(())
/// ```
pub trait Model: Clone + Serialize + DeserializeOwned + Send + 'static {
    type Input: Group;
    type Output: Group;
    type Parameters: Group;
    const IDENTITY: Identity;

    /// The model at rest before its first step.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    fn new(parameters: &Self::Parameters, input: &Self::Input) -> Result<Self, ParameterError>;

    /// Changes tunable parameters. On an error nothing has changed.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    fn retune(&mut self, parameters: &Self::Parameters) -> Result<(), ParameterError>;

    /// Doubts about parameters that can be used, in sentences.
    fn warnings(_parameters: &Self::Parameters) -> Vec<String> {
        Vec::new()
    }

    /// Doubts about the first step's input, in sentences.
    fn input_warnings(_parameters: &Self::Parameters, _input: &Self::Input) -> Vec<String> {
        Vec::new()
    }

    /// Longest communication step \[s\].
    fn max_communication_step(&self) -> f64 {
        f64::INFINITY
    }

    /// Advances by `step` seconds with an input whose slopes are unknown; by default it is held.
    fn step(&mut self, input: &Self::Input, step: f64) {
        self.step_between(input, input, step);
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`.
    fn step_between(&mut self, start: &Self::Input, end: &Self::Input, step: f64);

    /// The input after `step` seconds at these slopes, zero where the host gives none.
    fn input_after(start: &Self::Input, slope: &Self::Input, step: f64) -> Self::Input {
        start.extrapolated(slope, step)
    }

    /// The outputs now.
    fn output(&self) -> Self::Output;

    /// The outputs' time derivatives now.
    fn output_derivative(&self) -> Self::Output;
}
