//! Getting and setting variables. All variables and values of a call are checked before any is written.

use std::mem::MaybeUninit;

use moris_interface::Model;

use crate::{Complaint, Instance, Mode, Role, Scalar, VariableCheck, Variables};

/// The slots of output derivatives, each with the derivative's order.
pub trait OrderedSlots: Iterator<Item = (u32, i32)> + Clone {}
impl<I: Iterator<Item = (u32, i32)> + Clone> OrderedSlots for I {}

impl<M: Model> Instance<M> {
    /// Reads the variables into `room`, which is for as many values as they have.
    ///
    /// # Errors
    /// A slot of no variable, or of one of another type; then nothing is written.
    #[inline]
    pub fn get<S: Scalar>(&mut self, variables: impl Variables, room: &mut [MaybeUninit<S>]) -> Result<(), Complaint> {
        if !variables.slots().all(|slot| self.check::<S>(slot).is_some()) {
            return Err(self.why_not_readable::<S>(variables));
        }
        if self.run.untried {
            self.try_and_read(variables, room);
        } else {
            self.read(variables, room);
        }
        Ok(())
    }

    /// Writes `values`, of which there are as many as the variables have. Tunable parameters that change between steps take
    /// effect at once, all of the call together.
    ///
    /// # Errors
    /// A slot of no variable, of one of another type, or of one that cannot be set now; a value outside the variable's
    /// range, or that the model refuses. Then nothing has changed.
    #[inline]
    pub fn set<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) -> Result<(), Complaint> {
        // Inputs can be set in every mode in which anything can, and the calling sequences let nothing be set in others.
        let is_for_input = |(slot, values): (u32, &[S])| {
            self.check::<S>(slot)
                .is_some_and(|check| matches!(check.role, Role::Input { .. }) && accepts(check, values))
        };
        if !variables.with_values(values).all(is_for_input) {
            return self.set_others(variables, values);
        }
        if self.run.mode != Mode::StepComplete {
            self.run.untried = true;
        }
        self.write(variables, values);
        Ok(())
    }

    /// Gives inputs a time derivative that holds for the next step.
    ///
    /// # Errors
    /// A reference to anything but a continuous real input, an order other than 1, a value that is not finite. Then
    /// nothing has changed.
    pub fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Complaint> {
        let requests = references.iter().copied().zip(orders.iter().copied());
        self.check_derivatives(requests, Role::Input { continuous: true }, "a continuous input")?;
        if let Some(i) = values.iter().position(|value| !value.is_finite()) {
            let name = self.name(references[i]);
            return Err(Complaint::discard(format!("the derivative of {name} = {} is not finite", values[i])));
        }
        for (&reference, &value) in references.iter().zip(values) {
            self.run.derivatives[reference as usize] = value;
        }
        self.run.derivatives_given |= !references.is_empty();
        Ok(())
    }

    /// Reads the outputs' time derivatives into `values`, which has as many as `requests`.
    ///
    /// # Errors
    /// A slot of anything but a continuous real output, or an order other than 1; then nothing is written.
    pub fn get_output_derivatives(
        &mut self,
        requests: impl OrderedSlots,
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Complaint> {
        let role = Role::Output { continuous: true };
        self.check_derivatives(requests.clone(), role, "a continuous output")?;
        let Some(model) = &self.run.model else {
            return Err(Complaint::error("there are no derivatives before the model is initialized"));
        };
        model.output_derivatives(&mut self.output_derivatives);
        for ((slot, _), value) in requests.zip(values) {
            value.write(self.output_derivatives[slot as usize]);
        }
        Ok(())
    }

    fn check_derivatives(&self, requests: impl OrderedSlots, role: Role, role_text: &str) -> Result<(), Complaint> {
        for (slot, order) in requests {
            let Some(check) = self.tables.checks.get(slot as usize) else {
                return Err(self.no_such_variable(slot));
            };
            if check.role != role {
                let name = self.name(slot);
                return Err(Complaint::error(format!("{name} has no derivative: it is not {role_text}")));
            }
            if order != 1 {
                let name = self.name(slot);
                return Err(Complaint::error(format!(
                    "the derivative of {name} of order {order}: only order 1 exists"
                )));
            }
        }
        Ok(())
    }

    /// Access to the slot, if it exists and is of this type.
    #[inline]
    fn check<S: Scalar>(&self, slot: u32) -> Option<&'static VariableCheck> {
        self.tables.checks.get(slot as usize).filter(|check| S::is(check.value_type))
    }

    #[inline]
    fn read<S: Scalar>(&self, variables: impl Variables, room: &mut [MaybeUninit<S>]) {
        for (first, places) in variables.with_room(room) {
            for (slot, place) in (first as usize..).zip(places) {
                place.write(S::from_slot(self.run.values[slot]));
            }
        }
    }

    /// Reads variables during initialization: outputs are those of the values set so far.
    #[cold]
    #[inline(never)]
    fn try_and_read<S: Scalar>(&mut self, variables: impl Variables, room: &mut [MaybeUninit<S>]) {
        let is_output = |slot| matches!(self.tables.checks[slot as usize].role, Role::Output { .. });
        if variables.slots().any(is_output) {
            self.try_values();
        }
        self.read(variables, room);
    }

    #[inline]
    fn write<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) {
        for (first, values) in variables.with_values(values) {
            for (slot, value) in (first as usize..).zip(values) {
                self.run.values[slot] = value.to_slot();
            }
        }
    }

    /// Sets variables that are not all inputs, or refuses to. Out of the way of the calls that set inputs at every step.
    #[inline(never)]
    fn set_others<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) -> Result<(), Complaint> {
        let mode = self.run.mode;
        let is_settable = |(slot, values): (u32, &[S])| {
            self.check::<S>(slot).is_some_and(|check| check.settable.contains(mode) && accepts(check, values))
        };
        if !variables.with_values(values).all(is_settable) {
            return Err(self.why_not_settable(variables, values));
        }
        if mode == Mode::StepComplete {
            return self.set_and_retune(variables, values);
        }
        self.run.untried = true;
        self.write(variables, values);
        Ok(())
    }

    /// Writes values of which some are tunable parameters, and tells the model if any of these has changed.
    fn set_and_retune<S: Scalar>(&mut self, variables: impl Variables, values: &[S]) -> Result<(), Complaint> {
        self.old_values.copy_from_slice(&self.run.values);
        self.write(variables, values);
        let changed = one_by_one(variables, values).map(|(slot, _)| slot as usize).any(|slot| {
            self.tables.checks[slot].role == Role::Parameter && self.run.values[slot] != self.old_values[slot]
        });
        let Some(model) = self.run.model.as_mut().filter(|_| changed) else { return Ok(()) };
        model.retune(&self.run.values).map_err(|refusal| {
            self.run.values.copy_from_slice(&self.old_values);
            Complaint::discard(format!("{refusal}. The values of this call have not been taken; the old ones hold"))
        })
    }

    /// The variable's name in quotes.
    fn name(&self, slot: u32) -> String {
        format!("'{}'", M::IDENTITY.variable_name(slot as usize))
    }

    fn no_such_variable(&self, reference: u32) -> Complaint {
        let count = self.tables.checks.len();
        Complaint::error(format!("no variable has the value reference {reference}: they are 0 to {}", count - 1))
    }

    fn wrong_type<S: Scalar>(&self, slot: u32) -> Complaint {
        let name = self.name(slot);
        let type_name = S::type_name(self.tables.checks[slot as usize].value_type);
        Complaint::error(format!("{name} is of type {type_name}: use the functions for that type"))
    }

    #[cold]
    #[inline(never)]
    fn why_not_readable<S: Scalar>(&self, variables: impl Variables) -> Complaint {
        let complaints = variables.slots().filter_map(|slot| match self.tables.checks.get(slot as usize) {
            None => Some(self.no_such_variable(slot)),
            Some(check) => (!S::is(check.value_type)).then(|| self.wrong_type::<S>(slot)),
        });
        first(complaints)
    }

    /// The first wrong slot or, where all are right, the first wrong value.
    #[cold]
    #[inline(never)]
    fn why_not_settable<S: Scalar>(&self, variables: impl Variables, values: &[S]) -> Complaint {
        let about_slots = variables.slots().filter_map(|slot| self.why_slot_not_settable::<S>(slot));
        let about_values =
            one_by_one(variables, values).filter_map(|(slot, value)| self.why_value_not_taken(slot, value.to_slot()));
        first(about_slots.chain(about_values))
    }

    fn why_slot_not_settable<S: Scalar>(&self, slot: u32) -> Option<Complaint> {
        let Some(check) = self.tables.checks.get(slot as usize) else {
            return Some(self.no_such_variable(slot));
        };
        if !S::is(check.value_type) {
            return Some(self.wrong_type::<S>(slot));
        }
        if check.settable.contains(self.run.mode) {
            return None;
        }
        let name = self.name(slot);
        Some(Complaint::error(match check.role {
            Role::Time => format!("{name} cannot be set: it follows from the steps"),
            Role::Output { .. } => format!("{name} cannot be set: it is an output"),
            Role::Parameter | Role::Input { .. } => format!(
                "{name} cannot be set in state '{}', but only in: {}. Reset the instance to set a fixed parameter again",
                self.run.mode.name(),
                check.settable.names()
            ),
        }))
    }

    fn why_value_not_taken(&self, reference: u32, value: f64) -> Option<Complaint> {
        let slot = reference as usize;
        if self.tables.checks[slot].accepts(value) {
            return None;
        }
        let (name, reason) = (self.name(reference), M::IDENTITY.row(slot).reason(value));
        let old = self.run.values[slot];
        Some(Complaint::discard(format!(
            "{name} {reason}. No value of this call has been taken; {name} is still {old}"
        )))
    }
}

/// Checks these values for a variable.
#[inline]
fn accepts<S: Scalar>(check: &VariableCheck, values: &[S]) -> bool {
    values.iter().all(|value| check.accepts(value.to_slot()))
}

/// The variables' slots, all of them, each with its value.
fn one_by_one<S>(variables: impl Variables, values: &[S]) -> impl Iterator<Item = (u32, &S)> {
    let parts = variables.with_values(values);
    parts.flat_map(|(first, values)| (0..).zip(values).map(move |(element, value)| (first + element, value)))
}

/// The first of some complaints, of which there is one.
fn first(mut complaints: impl Iterator<Item = Complaint>) -> Complaint {
    complaints.next().unwrap_or_else(|| Complaint::error("the call was refused"))
}
