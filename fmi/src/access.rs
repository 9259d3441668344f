//! Getting and setting variables. All references and values of a call are checked before any is written.

use std::mem::MaybeUninit;

use model_interface::{Kind, Model};

use crate::{Complaint, Instance, Mode, Role, Scalar};

impl<M: Model> Instance<M> {
    /// Reads the variables of `references` into `values`, which has as many.
    ///
    /// # Errors
    /// A reference to no variable, or to one of another type; then nothing is written.
    #[inline]
    pub fn get<S: Scalar>(&mut self, references: &[u32], values: &mut [MaybeUninit<S>]) -> Result<(), Complaint> {
        let mut output = false;
        for &reference in references {
            match self.tables.checks.get(reference as usize) {
                Some(check) if check.value_type == S::TYPE => output |= matches!(check.role, Role::Output { .. }),
                _ => return Err(self.why_not_readable::<S>(references)),
            }
        }
        if output && self.run.untried {
            self.try_values();
        }
        for (&reference, value) in references.iter().zip(values) {
            value.write(S::from_slot(self.run.values[reference as usize]));
        }
        Ok(())
    }

    /// Writes `values` into the variables of `references`. Tunable parameters that change between steps take effect at
    /// once, all of the call together.
    ///
    /// # Errors
    /// A reference to no variable, to one of another type, or to one that cannot be set now; a value outside the
    /// variable's range, or that the model refuses. Then nothing has changed.
    #[inline]
    pub fn set<S: Scalar>(&mut self, references: &[u32], values: &[S]) -> Result<(), Complaint> {
        let mode = self.run.mode;
        let mut parameter = false;
        for (&reference, value) in references.iter().zip(values) {
            match self.tables.checks.get(reference as usize) {
                Some(check)
                    if check.value_type == S::TYPE
                        && check.settable.contains(mode)
                        && check.accepts(value.to_slot()) =>
                {
                    parameter |= matches!(check.role, Role::Parameter);
                }
                _ => return Err(self.why_not_settable(references, values)),
            }
        }
        if mode == Mode::StepComplete {
            if parameter {
                return self.set_and_retune(references, values);
            }
        } else {
            self.run.untried = true;
        }
        self.write(references, values);
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
        self.check_derivatives(references, orders, Role::Input { continuous: true }, "a continuous Real input")?;
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

    /// Reads the outputs' time derivatives into `values`, which has as many as `references`.
    ///
    /// # Errors
    /// A reference to anything but a continuous real output, or an order other than 1; then nothing is written.
    pub fn get_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Complaint> {
        self.check_derivatives(references, orders, Role::Output { continuous: true }, "a continuous Real output")?;
        let Some(model) = &self.run.model else {
            return Err(Complaint::error("there are no derivatives before the model is initialized"));
        };
        model.output_derivatives(&mut self.output_derivatives);
        for (&reference, value) in references.iter().zip(values) {
            value.write(self.output_derivatives[reference as usize]);
        }
        Ok(())
    }

    fn check_derivatives(
        &self,
        references: &[u32],
        orders: &[i32],
        role: Role,
        role_text: &str,
    ) -> Result<(), Complaint> {
        for (&reference, &order) in references.iter().zip(orders) {
            let Some(check) = self.tables.checks.get(reference as usize) else {
                return Err(self.no_such_variable(reference));
            };
            let name = self.name(reference);
            if check.role != role {
                return Err(Complaint::error(format!("{name} has no derivative: it is not {role_text}")));
            }
            if order != 1 {
                return Err(Complaint::error(format!(
                    "the derivative of {name} of order {order}: only order 1 exists"
                )));
            }
        }
        Ok(())
    }

    #[inline]
    fn write<S: Scalar>(&mut self, references: &[u32], values: &[S]) {
        for (&reference, value) in references.iter().zip(values) {
            self.run.values[reference as usize] = value.to_slot();
        }
    }

    /// Writes values of which some are tunable parameters, and tells the model if any of these has changed.
    #[inline(never)]
    fn set_and_retune<S: Scalar>(&mut self, references: &[u32], values: &[S]) -> Result<(), Complaint> {
        let old: Vec<f64> = references.iter().map(|&reference| self.run.values[reference as usize]).collect();
        self.write(references, values);
        let changed = references.iter().zip(&old).any(|(&reference, old)| {
            let slot = reference as usize;
            self.tables.checks[slot].role == Role::Parameter && self.run.values[slot] != *old
        });
        let Some(model) = self.run.model.as_mut().filter(|_| changed) else { return Ok(()) };
        model.retune(&self.run.values).map_err(|refusal| {
            // Backwards: of a variable named twice, the first of its old values is the one to keep.
            for (&reference, old) in references.iter().zip(old).rev() {
                self.run.values[reference as usize] = old;
            }
            Complaint::discard(format!("{refusal}. The values of this call have not been taken; the old ones hold"))
        })
    }

    /// The variable's name in quotes.
    fn name(&self, reference: u32) -> String {
        format!("'{}'", M::IDENTITY.variable_name(reference as usize))
    }

    fn no_such_variable(&self, reference: u32) -> Complaint {
        let count = self.tables.checks.len();
        Complaint::error(format!("no variable has the value reference {reference}: they are 0 to {}", count - 1))
    }

    fn wrong_type<S: Scalar>(&self, reference: u32) -> Complaint {
        let name = self.name(reference);
        let value_type = self.tables.checks[reference as usize].value_type;
        Complaint::error(format!("{name} is of type {value_type:?}, not {:?}", S::TYPE))
    }

    #[cold]
    #[inline(never)]
    fn why_not_readable<S: Scalar>(&self, references: &[u32]) -> Complaint {
        let complaints = references.iter().filter_map(|&reference| match self.tables.checks.get(reference as usize) {
            None => Some(self.no_such_variable(reference)),
            Some(check) => (check.value_type != S::TYPE).then(|| self.wrong_type::<S>(reference)),
        });
        first(complaints)
    }

    /// The first wrong reference or, where all are right, the first wrong value.
    #[cold]
    #[inline(never)]
    fn why_not_settable<S: Scalar>(&self, references: &[u32], values: &[S]) -> Complaint {
        let about_references =
            references.iter().filter_map(|&reference| self.why_reference_not_settable::<S>(reference));
        let pairs = references.iter().zip(values);
        let about_values = pairs.filter_map(|(&reference, value)| self.why_value_not_taken(reference, value.to_slot()));
        first(about_references.chain(about_values))
    }

    fn why_reference_not_settable<S: Scalar>(&self, reference: u32) -> Option<Complaint> {
        let Some(check) = self.tables.checks.get(reference as usize) else {
            return Some(self.no_such_variable(reference));
        };
        if check.value_type != S::TYPE {
            return Some(self.wrong_type::<S>(reference));
        }
        if check.settable.contains(self.run.mode) {
            return None;
        }
        let name = self.name(reference);
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
        let row = M::IDENTITY.row(slot);
        let wanted = match (row.kind, row.range) {
            _ if !value.is_finite() => "not a finite number".into(),
            (Kind::Enumeration(enumeration), _) => {
                let items = enumeration.items.iter().enumerate();
                let items: Vec<_> = items.map(|(i, item)| format!("{} ({})", i + 1, item.name)).collect();
                format!("none of {}", items.join(", "))
            }
            (_, Some((min, max))) => format!("not within {min} to {max}"),
            (_, None) => "out of range".into(),
        };
        let (name, old) = (self.name(reference), self.run.values[slot]);
        Some(Complaint::discard(format!(
            "{name} = {value} is {wanted}. No value of this call has been taken; {name} is still {old}"
        )))
    }
}

/// The first of some complaints, of which there is one.
fn first(mut complaints: impl Iterator<Item = Complaint>) -> Complaint {
    complaints.next().unwrap_or_else(|| Complaint::error("the call was refused"))
}
