//! The numbers of a recording, column by column, in SI units.
//!
//! - `files` reads a table from files, and `memory` from columns in memory.
//! - `clocks` continues clocks that begin again.
//! - `gaps` fills gaps in columns, and `join` makes one table of several files.
//! - [`interleaved`] finds samples of several sensors by turns, and [`outliers`] those that no
//!   vehicle causes.
//! - `placeholders` finds columns that stand still beside others that move.
//! - [`laps`] chooses one of several laps.
//! - [`sampling`] makes the steps of time equal, by `interpolation`. `times` examines times.

mod clocks;
mod files;
mod gaps;
pub mod interleaved;
mod interpolation;
mod join;
pub mod laps;
mod memory;
pub mod outliers;
mod placeholders;
pub mod sampling;
mod times;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::path::PathBuf;

use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::{Quaternion, UnitQuaternion};

use crate::message::Message;
use crate::recording::columns::{Column, UnitSource};
use crate::recording::conventions::{Conventions, Gravity, Quantity, Unit};
use crate::recording::message::RecordingError;
use crate::recording::read::Samples;
use crate::texts::text;

pub use files::{read, recordings};
pub use memory::of_columns;

/// A recording's columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Where it is from.
    pub file: PathBuf,
    /// The time column \[s\].
    pub time: Vec<f64>,
    /// All others, in SI units and the file's axes.
    pub columns: BTreeMap<Quantity, Vec<f64>>,
    /// The columns of the file, with their units.
    pub layout: Vec<Column>,
    /// The line of the file from which each sample is.
    pub lines: Vec<u64>,
    /// Warnings, in whole sentences.
    pub warnings: Vec<Message>,
    /// First and last time at which all columns have values of their own \[s\]; none where they
    /// always do.
    complete: Option<(f64, f64)>,
}

impl Table {
    /// A table of the sums that the layout describes, of samples with the time in seconds. What the
    /// recording lacks is as at rest.
    fn new(
        file: PathBuf,
        layout: Vec<Column>,
        samples: Samples,
        conventions: &Conventions,
    ) -> Result<Self, RecordingError> {
        let Samples { time, columns, lines, warnings, complete } = samples;
        let values: BTreeMap<usize, Vec<f64>> = columns.into_iter().collect();
        let sum = |column: &Column| -> Vec<f64> {
            let at = |sample: usize| column.terms.iter().map(|t| t.factor * values[&t.place][sample]).sum::<f64>();
            (0..time.len()).map(|sample| at(sample) * column.unit.in_si).collect()
        };
        let measured = layout.iter().filter(|column| column.quantity != Quantity::Time);
        let columns = measured.map(|column| (column.quantity, sum(column))).collect();
        let mut table = Table { file, time, columns, layout, lines, warnings, complete };
        table.rest(conventions);
        table.centre_angles();
        table.orient(conventions)?;
        Ok(table)
    }

    /// Adds the quantities that the recording lacks as at rest, with a warning.
    fn rest(&mut self, conventions: &Conventions) {
        let is_missing = |quantity: &Quantity| {
            quantity.is_required() && *quantity != Quantity::Time && !self.columns.contains_key(quantity)
        };
        let missing: Vec<Quantity> = Quantity::all().filter(is_missing).collect();
        for &quantity in &missing {
            let is_vertical = quantity == Quantity::Force(2) && conventions.gravity == Gravity::Included;
            let rest = if is_vertical { STANDARD_GRAVITY * conventions.axes.force_signs()[2] } else { 0.0 };
            self.columns.insert(quantity, vec![rest; self.time.len()]);
        }
        if !missing.is_empty() {
            let names = missing.into_iter().map(Quantity::key).collect::<Vec<_>>().join(", ");
            self.warnings.push(format!("The recording has no {names}: they are taken as at rest.").into());
        }
    }

    /// Makes roll, pitch and yaw of the columns of a quaternion, unless there are angles.
    fn orient(&mut self, conventions: &Conventions) -> Result<(), RecordingError> {
        // Largest distance of a quaternion's norm from 1, as few digits leave it.
        const NORM: f64 = 0.05;
        let [Some(w), Some(x), Some(y), Some(z)] = Quantity::QUATERNION.map(|part| self.columns.remove(&part)) else {
            return Ok(());
        };
        if Quantity::ANGLES.iter().any(|angle| self.columns.contains_key(angle)) {
            return Ok(());
        }
        let quaternion = |k: usize| Quaternion::new(w[k], x[k], y[k], z[k]);
        let is_off = |&k: &usize| (quaternion(k).norm() - 1.0).abs() > NORM;
        if let Some(sample) = (0..w.len()).find(is_off) {
            let norm = quaternion(sample).norm();
            let decimals = if norm > 10.0 { 0 } else { 3 };
            let columns = conventions.scaled(&Quantity::QUATERNION, &format!("/ {norm:.decimals$}"));
            let reason = if norm < NORM { text!["no-quaternion"] } else { text!["norm-of-quaternion", norm, columns] };
            return Err(self.refused_at(sample, Quantity::Quaternion(0), reason));
        }
        let angles = (0..w.len()).map(|k| UnitQuaternion::new_normalize(quaternion(k)).euler_angles());
        let (roll, (pitch, yaw)): (Vec<_>, (Vec<_>, Vec<_>)) = angles.map(|(r, p, y)| (r, (p, y))).unzip();
        self.columns.extend(Quantity::ANGLES.into_iter().zip([roll, pitch, yaw]));
        Ok(())
    }

    /// Brings roll, pitch and lean of 0 to 360 degrees to -180 to 180: the same angles. Such
    /// columns jump by a turn.
    fn centre_angles(&mut self) {
        for quantity in [Quantity::Angle(0), Quantity::Angle(1), Quantity::Lean] {
            let Some(angles) = self.columns.get_mut(&quantity) else { continue };
            let is_of_one_turn = angles.iter().all(|angle| (0.0..=TAU).contains(angle));
            if is_of_one_turn && angles.windows(2).any(|pair| (pair[1] - pair[0]).abs() > PI) {
                angles.iter_mut().filter(|angle| **angle > PI).for_each(|angle| *angle -= TAU);
            }
        }
    }

    /// The part in which all columns have values of their own, and the samples that it is of. The
    /// whole table where there are few of them.
    pub fn complete(&self) -> (Cow<'_, Table>, Range<usize>) {
        // Least number of samples that checks look at.
        const LEAST_CHECKED: usize = 100;
        let whole = 0..self.time.len();
        let Some((from, to)) = self.complete else { return (Cow::Borrowed(self), whole) };
        let range = self.time.partition_point(|time| *time < from)..self.time.partition_point(|time| *time <= to);
        if range.len() < LEAST_CHECKED {
            return (Cow::Borrowed(self), whole);
        }
        let mut part = self.clone();
        part.keep(range.clone());
        (Cow::Owned(part), range)
    }

    /// Mean time between samples \[s\].
    pub fn step(&self) -> f64 {
        match self.time.as_slice() {
            [first, .., last] => (last - first) / (self.time.len() - 1) as f64,
            _ => 0.0,
        }
    }

    /// True where the recording holds the vehicle's orientation: its roll and pitch at least.
    pub fn has_orientation(&self) -> bool {
        self.columns.contains_key(&Quantity::Angle(0)) && self.columns.contains_key(&Quantity::Angle(1))
    }

    /// The unit of a quantity's column, and its source.
    pub fn unit(&self, quantity: Quantity) -> (Unit, UnitSource) {
        let column = self.layout.iter().find(|column| column.quantity == quantity);
        let default = (quantity.dimension().default_unit(), UnitSource::Default);
        column.map_or(default, |column| (column.unit, column.source))
    }

    /// The value of a quantity at a sample; zero where there is no such column.
    pub fn value(&self, quantity: Quantity, sample: usize) -> f64 {
        self.columns.get(&quantity).map_or(0.0, |column| column[sample])
    }

    /// Leaves out all samples but those of a range.
    fn keep(&mut self, range: Range<usize>) {
        self.time = self.time[range.clone()].to_vec();
        self.lines = self.lines[range.clone()].to_vec();
        for values in self.columns.values_mut() {
            *values = values[range.clone()].to_vec();
        }
    }

    /// An error of the recording as a whole.
    pub fn refused(&self, reason: impl Into<Message>) -> RecordingError {
        RecordingError::whole(&self.file, reason)
    }

    /// An error of a quantity at a sample.
    pub fn refused_at(&self, sample: usize, quantity: Quantity, reason: impl Into<Message>) -> RecordingError {
        RecordingError::line(&self.file, self.lines[sample], Some(quantity.key().to_owned()), reason)
    }
}
