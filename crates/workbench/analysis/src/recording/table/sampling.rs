//! Resampling at equal steps. Measures and comparisons need them, the washout's filters do not.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::Range;

use super::Table;
use super::interpolation::{orientations, places, values};
use super::times::{LONGEST_GAP, disorder, gaps, median_step, spread_equal_times};
use moris_interface::shown;

use crate::message::{Message, given};
use crate::recording::conventions::{Conventions, Dimension, Quantity, Unit};
use crate::recording::message::RecordingError;
use crate::texts::text;

/// Finest step: below it, time is in another unit \[s\].
pub const MIN_SAMPLE_STEP: f64 = 1e-4;

/// The recording at equal steps, with warnings. Equal steps stay unchanged; an option
/// asks for interpolation.
///
/// # Errors
/// Time does not increase, the steps are unequal and interpolation is off, or the steps are too
/// coarse or too fine for the unit of time.
pub fn at_equal_steps(mut table: Table, conventions: &Conventions) -> Result<(Table, Vec<Message>), RecordingError> {
    if conventions.resample.is_some() {
        table.warnings.extend(spread_equal_times(&mut table.time));
    }
    if let Some((wrong, reason)) = disorder(&table.time) {
        return Err(table.refused_at(wrong, Quantity::Time, reason));
    }
    check_unit(&table, conventions)?;
    check_clock(&table)?;
    match conventions.resample {
        Some(rate) => resampled_at(table, rate),
        None => check_equal(&table).map(|()| (table, Vec::new())),
    }
}

fn check_unit(table: &Table, conventions: &Conventions) -> Result<(), RecordingError> {
    // Coarsest step of a usable recording [s].
    const COARSEST: f64 = 0.25;
    // Ticks of 100 ns of our days, since the year 1601 or 1.
    const TICKS: Range<f64> = 1.2e17..7e17;
    let usual = median_step(&table.time);
    let (unit, _) = table.unit(Quantity::Time);
    let rate = |other: Unit| unit.in_si / (usual * other.in_si);
    let fits = |other: &Unit| (4.0..=2000.0).contains(&rate(*other));
    let fitting: Vec<String> = Dimension::Time
        .units()
        .filter(fits)
        .map(|other| format!("{} if it is in {}", shown(rate(other).round()), other.word))
        .collect();
    let fitting = if fitting.is_empty() { String::new() } else { format!(" ({})", fitting.join(", ")) };
    let reason = if usual > COARSEST && TICKS.contains(&(table.time[0] / unit.in_si)) {
        text!["ticks-of-100-ns", columns = conventions.scaled(&[Quantity::Time], "/ 10000000")]
    } else if usual > COARSEST {
        text!["too-coarse", fitting = fitting.replacen(" (", " (samples a second: ", 1)]
    } else if usual < MIN_SAMPLE_STEP {
        text!["too-fine", rate = 1.0 / usual, fitting]
    } else {
        return Ok(());
    };
    Err(table.refused(text!["unit-of-time", usual = usual.to_string(), unit = unit.word, reason]))
}

/// Refuses a gap that is longer than all the rest.
fn check_clock(table: &Table) -> Result<(), RecordingError> {
    // Gap from which it may be longer than the recording [s].
    const LONGEST_REFUSED: f64 = 10.0;
    let longest = (1..table.time.len()).max_by(|&a, &b| step_to(table, a).total_cmp(&step_to(table, b))).unwrap_or(1);
    let gap = step_to(table, longest);
    // Of a usual recording a gap is a small part.
    if gap > LONGEST_REFUSED && gap > table.time[table.time.len() - 1] - table.time[0] - gap {
        return Err(table.refused_at(longest, Quantity::Time, text!["clock-has-jumped", gap]));
    }
    Ok(())
}

fn check_equal(table: &Table) -> Result<(), RecordingError> {
    // Largest distance of a sample from its time at equal steps [fractions of a step]. It allows
    // for times written with few digits.
    const JITTER: f64 = 0.2;
    let (step, usual) = (table.step(), median_step(&table.time));
    let expected = |k: usize| table.time[0] + k as f64 * step;
    let Some(off) = (0..table.time.len()).find(|&k| (table.time[k] - expected(k)).abs() > JITTER * step) else {
        return Ok(());
    };
    // The sample that is farthest off rarely has the unusual step. So the first
    // unusual step is named.
    let odd = (1..table.time.len()).find(|&k| (step_to(table, k) - usual).abs() > JITTER * usual).unwrap_or(off);
    let remedy = given("resample", format!("{:.0}", 1.0 / usual));
    let reason = text!["unequal-steps", step = step_to(table, odd), usual, remedy];
    Err(table.refused_at(odd, Quantity::Time, reason))
}

/// Time from the sample before to a sample \[s\].
fn step_to(table: &Table, sample: usize) -> f64 {
    table.time[sample] - table.time[sample - 1]
}

/// Linear interpolation at `rate` samples a second, with warnings about gaps.
fn resampled_at(table: Table, rate: f64) -> Result<(Table, Vec<Message>), RecordingError> {
    // Largest number of samples that are interpolated, unless there are a quarter as many already.
    const MOST_SAMPLES: f64 = 2e6;
    let (first, last) = (table.time[0], table.time[table.time.len() - 1]);
    let steps = (last - first) * rate + 1e-6;
    if steps > MOST_SAMPLES.max(4.0 * table.time.len() as f64) {
        return Err(table.refused(text!["too-many-samples", duration = last - first, rate = rate.to_string()]));
    }
    let count = (steps.floor() as usize + 1).max(2);
    let time: Vec<f64> = (0..count).map(|k| first + k as f64 / rate).collect();
    let places = places(&table.time, &time);
    let interpolated = |(&quantity, column): (&Quantity, &Vec<f64>)| {
        (quantity, values(&places, column, quantity.is_angle().then_some(TAU)))
    };
    let mut columns: BTreeMap<Quantity, Vec<f64>> = table.columns.iter().map(interpolated).collect();
    if let [Some(roll), Some(pitch), Some(yaw)] = Quantity::ANGLES.map(|angle| table.columns.get(&angle)) {
        columns.extend(Quantity::ANGLES.into_iter().zip(orientations(&places, [roll, pitch, yaw])));
    }
    let lines = places.iter().map(|place| table.lines[place.after]).collect();
    let gap = |(step, line): (f64, u64)| text!["gap-in-the-recording", step, line];
    let warnings = gaps(&table.time, &table.lines, LONGEST_GAP).map(gap).collect();
    Ok((Table { time, columns, lines, ..table }, warnings))
}
