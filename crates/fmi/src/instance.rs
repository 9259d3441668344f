//! An instance of a model, for any version of FMI. The version's own layer checks in which
//! mode a call is allowed.

use moris_interface::Model;

use crate::{InstanceState, Mode, Tables};

/// An instance of a model.
///
/// Methods are in the modules named for what they do: `access` (get and set), `initialization`,
/// `step` and `serialisation`.
pub struct Instance<M> {
    pub(crate) tables: Tables,
    /// Everything that distinguishes the instance from a fresh one.
    pub(crate) state: InstanceState<M>,
    /// Room for the outputs' time derivatives.
    pub(crate) output_derivatives: Box<[f64]>,
    /// Room for all values as they were before parameters are set.
    pub(crate) old_values: Box<[f64]>,
    /// Sentences about values that can be used and may be wrong, from the call under way: none
    /// from a call that fails.
    pub(crate) warnings: Vec<String>,
    /// An input beyond its range has had its warning, the only one until the instance is reset.
    pub(crate) warned_of_range: bool,
    /// Parameters changed between steps that have had their warning.
    pub(crate) warned_parameters: Vec<u32>,
    /// Steps made until the input is checked, no more.
    pub(crate) first_steps: u8,
}

impl<M: Model> Instance<M> {
    /// A fresh instance of the model to which the tables belong.
    pub fn new(tables: Tables) -> Self {
        let buffer = || vec![0.0; tables.start.len()].into();
        Instance {
            tables,
            state: InstanceState::fresh(tables.start),
            output_derivatives: buffer(),
            old_values: buffer(),
            warnings: Vec::new(),
            warned_of_range: false,
            warned_parameters: Vec::new(),
            first_steps: 0,
        }
    }

    /// Where in its life the instance is.
    #[inline]
    pub fn mode(&self) -> Mode {
        self.state.mode
    }

    /// The present communication point \[s\].
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Tables shared by all instances of the model.
    pub fn tables(&self) -> &Tables {
        &self.tables
    }

    /// Makes the instance as it was when it was new.
    pub fn reset(&mut self) {
        self.state = InstanceState::fresh(self.tables.start);
        self.warned_of_range = false;
        self.warned_parameters.clear();
        self.first_steps = 0;
    }

    /// Marks the instance as unusable until it is reset or a state restored: the model
    /// broke off in the middle.
    pub fn fail(&mut self) {
        self.state.mode = Mode::Error;
        self.state.dirty = false;
    }

    /// Moves to the time `time` \[s\], which the independent variable shows.
    pub(crate) fn set_time(&mut self, time: f64) {
        self.state.time = time;
        if let Some(slot) = self.tables.time_slot {
            self.state.values[slot] = time;
        }
    }
}
