//! A target that writes its outputs to a table.

use std::io::Write;

use anyhow::Result;
use moris_washout::Preview;

use super::{Inputs, Target};
use crate::hunter::episode::Scope;
use crate::hunter::oracle::Sample;

/// A target with a table of its outputs, as CSV: a line for the outputs before the first
/// step and one after each.
pub struct Traced<T, W> {
    inner: T,
    out: W,
    step: f64,
}

impl<T: Target, W: Write> Traced<T, W> {
    /// Writes the table's head.
    ///
    /// # Errors
    /// The head cannot be written.
    pub fn new(inner: T, mut out: W) -> Result<Self> {
        write!(out, "step")?;
        for name in ["position", "velocity", "acceleration", "angularVelocity"] {
            write!(out, ",{name}.x,{name}.y,{name}.z")?;
        }
        for name in ["length", "legVelocity"] {
            for leg in 1..=6 {
                write!(out, ",{name}[{leg}]")?;
            }
        }
        writeln!(out)?;
        Ok(Traced { inner, out, step: 0.0 })
    }
}

impl<T: Target, W: Write> Target for Traced<T, W> {
    fn make(&mut self, slots: &[f64]) -> Result<()> {
        self.inner.make(slots)
    }

    fn rewind(&mut self) {
        self.inner.rewind();
    }

    fn set(&mut self, slots: &[f64], changed: &[usize]) -> bool {
        self.inner.set(slots, changed)
    }

    fn preview(&mut self, preview: &Preview) {
        self.inner.preview(preview);
    }

    fn step(&mut self, start: &Inputs, end: Option<&Inputs>, step: f64) -> Result<()> {
        self.step = step;
        self.inner.step(start, end, step)
    }

    fn sample(&mut self, neutral_height: f64) -> Sample {
        let sample = self.inner.sample(neutral_height);
        let Sample { position, velocity, acceleration, angular_velocity, length, leg_velocity, .. } = &sample;
        let linear = [position, velocity, acceleration, angular_velocity];
        let values = linear.into_iter().flatten().chain(length).chain(leg_velocity);
        let line = values.fold(format!("{:e}", self.step), |line, value| line + &format!(",{value:e}"));
        // A closed table does not end the search.
        _ = writeln!(self.out, "{line}");
        sample
    }

    fn save(&mut self, scope: Scope) -> Result<()> {
        self.inner.save(scope)
    }

    fn restore(&mut self, scope: Scope) -> Result<()> {
        self.inner.restore(scope)
    }
}
