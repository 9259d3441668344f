//! Getting and setting variables. All variables and values of a call are checked
//! before any is written.

use std::mem::MaybeUninit;

use moris_interface::{Model, SlotModel, shown};

use crate::{CallError, Instance, Mode, Role, Scalar, VariableInfo, Variables};

/// The slots of output derivatives, each with the derivative's order.
pub trait OrderedSlots: Iterator<Item = (u32, i32)> + Clone {}
impl<I: Iterator<Item = (u32, i32)> + Clone> OrderedSlots for I {}

impl<M: Model> Instance<M> {
    /// Reads the variables into `buffer`, which has the length of all their values.
    ///
    /// # Errors
    /// A slot has no variable, or one of another type. Then nothing is written.
    #[inline]
    pub fn get<S: Scalar>(
        &mut self,
        variables: impl Variables,
        buffer: &mut [MaybeUninit<S>],
    ) -> Result<(), CallError> {
        if !variables.slots().all(|slot| self.info::<S>(slot).is_some()) {
            return Err(self.why_not_readable::<S>(variables));
        }
        if self.state.dirty {
            self.initialize_and_read(variables, buffer);
        } else {
            self.read(variables, buffer);
        }
        Ok(())
    }

    /// Writes `values`, one for each value of the variables. Tunable parameters that change between
    /// steps take effect at once, all of the call together.
    ///
    /// # Errors
    /// A slot has no variable, one of another type, or one that cannot be set now. Or a value is
    /// outside the variable's range, or refused by the model. Then nothing has changed.
    #[inline]
    pub fn set<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) -> Result<(), CallError> {
        // Inputs can be set in every mode in which any variable can. In other modes the calling
        // sequences refuse the call.
        let is_for_input = |(slot, values): (u32, &[S])| {
            self.info::<S>(slot).is_some_and(|info| {
                matches!(info.role, Role::Input { .. }) && values.iter().all(|value| info.contains(value.to_slot()))
            })
        };
        if !variables.with_values(values).all(is_for_input) {
            return self.set_parameters(variables, values);
        }
        if self.state.mode != Mode::StepComplete {
            self.state.dirty = true;
        }
        self.write(variables, values);
        Ok(())
    }

    /// Sets time derivatives of inputs for the next step.
    ///
    /// # Errors
    /// A reference is not that of a continuous real input, an order is not 1, or a value is not
    /// finite. Then nothing has changed.
    pub fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), CallError> {
        let requests = references.iter().copied().zip(orders.iter().copied());
        self.check_derivatives(requests, Role::Input { continuous: true }, "a continuous input")?;
        if let Some(i) = values.iter().position(|value| !value.is_finite()) {
            let name = self.name(references[i]);
            return Err(CallError::discard(format!("the derivative of {name} = {} is not finite", values[i])));
        }
        for (&reference, &value) in references.iter().zip(values) {
            self.state.derivatives[reference as usize] = value;
        }
        self.state.derivatives_given |= !references.is_empty();
        Ok(())
    }

    /// Reads the outputs' time derivatives into `values`, which has as many as `requests`.
    ///
    /// # Errors
    /// A slot is not that of a continuous real output, an order is not 1, or the model is not
    /// initialized. Then nothing is written.
    pub fn get_output_derivatives(
        &mut self,
        requests: impl OrderedSlots,
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), CallError> {
        let role = Role::Output { continuous: true };
        self.check_derivatives(requests.clone(), role, "a continuous output")?;
        let Some(model) = &self.state.model else {
            return Err(CallError::error("there are no derivatives before the model is initialized"));
        };
        model.write_output_derivatives(&mut self.output_derivatives);
        for ((slot, _), value) in requests.zip(values) {
            value.write(self.output_derivatives[slot as usize]);
        }
        Ok(())
    }

    fn check_derivatives(&self, requests: impl OrderedSlots, role: Role, role_text: &str) -> Result<(), CallError> {
        for (slot, order) in requests {
            let Some(info) = self.tables.infos.get(slot as usize) else {
                return Err(self.no_such_variable(slot));
            };
            if info.role != role {
                let name = self.name(slot);
                return Err(CallError::error(format!("{name} has no derivative: it is not {role_text}")));
            }
            if order != 1 {
                let name = self.name(slot);
                return Err(CallError::error(format!(
                    "the derivative of {name} of order {order}: only order 1 exists"
                )));
            }
        }
        Ok(())
    }

    /// Access to the slot, if it exists and is of this type.
    #[inline]
    fn info<S: Scalar>(&self, slot: u32) -> Option<&'static VariableInfo> {
        self.tables.infos.get(slot as usize).filter(|info| S::is(info.value_type))
    }

    #[inline]
    fn read<S: Scalar>(&self, variables: impl Variables, buffer: &mut [MaybeUninit<S>]) {
        for (first, places) in variables.with_buffer(buffer) {
            for (slot, place) in (first as usize..).zip(places) {
                place.write(S::from_slot(self.state.values[slot]));
            }
        }
    }

    /// Reads variables during initialization: outputs are those of the values set so far.
    #[cold]
    #[inline(never)]
    fn initialize_and_read<S: Scalar>(&mut self, variables: impl Variables, buffer: &mut [MaybeUninit<S>]) {
        let is_output = |slot| matches!(self.tables.infos[slot as usize].role, Role::Output { .. });
        if variables.slots().any(is_output) {
            self.evaluate_start();
        }
        self.read(variables, buffer);
    }

    #[inline]
    fn write<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) {
        for (first, values) in variables.with_values(values) {
            for (slot, value) in (first as usize..).zip(values) {
                self.state.values[slot] = value.to_slot();
            }
        }
    }

    /// Sets variables that are not all inputs within their ranges, or refuses to. Out of the way of
    /// the calls that set inputs at every step.
    #[inline(never)]
    fn set_parameters<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) -> Result<(), CallError> {
        let mode = self.state.mode;
        let is_settable = |(slot, values): (u32, &[S])| {
            self.info::<S>(slot).is_some_and(|info| {
                (info.settable.contains(mode) || self.repeats(slot, values))
                    && values.iter().all(|value| info.accepts(value.to_slot()))
            })
        };
        if !variables.with_values(values).all(is_settable) {
            return Err(self.why_not_settable(variables, values));
        }
        if mode == Mode::StepComplete {
            self.set_and_retune(variables, values)?;
        } else {
            self.state.dirty = true;
            self.write(variables, values);
        }
        self.note_range(variables, values);
        Ok(())
    }

    /// Writes values of which some are tunable parameters, and tells the model if any
    /// of these has changed.
    fn set_and_retune<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) -> Result<(), CallError> {
        self.old_values.copy_from_slice(&self.state.values);
        self.write(variables, values);
        let changed = one_by_one(variables, values).map(|(slot, _)| slot as usize).any(|slot| {
            self.tables.infos[slot].role == Role::Parameter && self.state.values[slot] != self.old_values[slot]
        });
        let Some(model) = self.state.model.as_mut().filter(|_| changed) else { return Ok(()) };
        model.retune_from(&self.state.values).map_err(|error| {
            self.state.values.copy_from_slice(&self.old_values);
            CallError::discard(format!("{error}. The values of this call have not been taken; the old ones hold"))
        })?;
        self.note_unusual(variables, values);
        Ok(())
    }

    /// Warns of parameters that have changed between steps and are beyond their
    /// usual range, once of each.
    fn note_unusual<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) {
        for (slot, value) in one_by_one(variables, values) {
            let (place, value, row) = (slot as usize, value.to_slot(), M::IDENTITY.row(slot as usize));
            let is_new = self.old_values[place] != value && !self.warned_parameters.contains(&slot);
            if is_new && self.tables.infos[place].role == Role::Parameter && row.is_unusual(value) {
                self.warned_parameters.push(slot);
                self.warnings.extend(row.unusual_value(&M::IDENTITY.variable_name(place), value));
            }
        }
    }

    /// Warns of the first value beyond its input's range among values that have been taken, unless
    /// the host knows of one. Zero does not count: hosts set inputs to zero for which they have no
    /// value yet.
    fn note_range<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) {
        if self.warned_of_range {
            return;
        }
        let beyond = one_by_one(variables, values)
            .map(|(slot, value)| (slot, value.to_slot()))
            .find(|&(slot, value)| value != 0.0 && self.tables.infos[slot as usize].replacement(value).is_some());
        if let Some((slot, value)) = beyond {
            self.warnings.push(self.about_range(slot, value));
            self.warned_of_range = true;
        }
    }

    /// The model's value for an input beyond its range.
    fn about_range(&self, slot: u32, value: f64) -> String {
        let (name, reason) = (self.name(slot), M::IDENTITY.row(slot as usize).reason(value));
        let end = self.tables.infos[slot as usize].replacement(value).unwrap_or(value);
        format!(
            "{name} {reason}; the model uses {}. Later values beyond a range are treated alike, without a message",
            shown(end)
        )
    }

    /// The variable's name in quotes.
    fn name(&self, slot: u32) -> String {
        format!("'{}'", M::IDENTITY.variable_name(slot as usize))
    }

    fn no_such_variable(&self, reference: u32) -> CallError {
        let count = self.tables.infos.len();
        CallError::error(format!("no variable has the value reference {reference}: they are 0 to {}", count - 1))
    }

    fn wrong_type<S: Scalar>(&self, slot: u32) -> CallError {
        let name = self.name(slot);
        let type_name = S::type_name(self.tables.infos[slot as usize].value_type);
        CallError::error(format!("{name} is of type {type_name}: use the functions for that type"))
    }

    #[cold]
    #[inline(never)]
    fn why_not_readable<S: Scalar>(&self, variables: impl Variables) -> CallError {
        let errors = variables.slots().filter_map(|slot| match self.tables.infos.get(slot as usize) {
            None => Some(self.no_such_variable(slot)),
            Some(info) => (!S::is(info.value_type)).then(|| self.wrong_type::<S>(slot)),
        });
        first_error(errors)
    }

    /// The first wrong slot or, where all are right, the first wrong value.
    #[cold]
    #[inline(never)]
    fn why_not_settable<S: Scalar>(&self, variables: impl Variables, values: &[S]) -> CallError {
        let about_slots =
            variables.with_values(values).filter_map(|(slot, values)| self.why_slot_not_settable(slot, values));
        let about_values =
            one_by_one(variables, values).filter_map(|(slot, value)| self.why_value_rejected(slot, value.to_slot()));
        first_error(about_slots.chain(about_values))
    }

    /// True if a parameter gets the values that it has while steps are made. Hosts write all their
    /// parameters again then, fixed ones too.
    fn repeats<S: Scalar>(&self, slot: u32, values: &[S]) -> bool {
        let slot = slot as usize;
        let present = self.state.values[slot..].iter();
        self.state.mode == Mode::StepComplete
            && self.tables.infos[slot].role == Role::Parameter
            && present.zip(values).all(|(present, value)| *present == value.to_slot())
    }

    fn why_slot_not_settable<S: Scalar>(&self, slot: u32, values: &[S]) -> Option<CallError> {
        let Some(info) = self.tables.infos.get(slot as usize) else {
            return Some(self.no_such_variable(slot));
        };
        if !S::is(info.value_type) {
            return Some(self.wrong_type::<S>(slot));
        }
        if info.settable.contains(self.state.mode) || self.repeats(slot, values) {
            return None;
        }
        let name = self.name(slot);
        Some(CallError::error(match info.role {
            Role::Time => format!("{name} cannot be set: it is the time and advances with the steps"),
            Role::Output { .. } => format!("{name} cannot be set: it is an output"),
            Role::Parameter | Role::Input { .. } => format!(
                "{name} cannot be set in state '{}', but only in: {}. Reset the instance to set a fixed parameter again",
                self.state.mode.name(),
                info.settable.names()
            ),
        }))
    }

    fn why_value_rejected(&self, reference: u32, value: f64) -> Option<CallError> {
        let slot = reference as usize;
        if self.tables.infos[slot].accepts(value) {
            return None;
        }
        let (name, reason) = (self.name(reference), M::IDENTITY.row(slot).reason(value));
        let old = self.state.values[slot];
        Some(CallError::discard(format!("{name} {reason}. No value of this call has been set; {name} is still {old}")))
    }
}

/// The variables' slots, all of them, each with its value.
fn one_by_one<S>(variables: impl Variables, values: &[S]) -> impl Iterator<Item = (u32, &S)> {
    let parts = variables.with_values(values);
    parts.flat_map(|(first, values)| (0..).zip(values).map(move |(element, value)| (first + element, value)))
}

/// The first of some errors, of which there is one.
fn first_error(mut errors: impl Iterator<Item = CallError>) -> CallError {
    errors.next().unwrap_or_else(|| CallError::error("the call was refused"))
}
