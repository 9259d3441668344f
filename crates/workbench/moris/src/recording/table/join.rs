//! Several files of one recording, joined by time, and gaps in their columns.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use moris_interface::shown;

use super::sampling;
use crate::recording::columns::units::Unit;
use crate::recording::columns::{Column, Term, UnitSource};
use crate::recording::conventions::Quantity;
use crate::recording::median;
use crate::recording::message::RecordingError;
use crate::recording::read::sheet::{Samples, Sheet};

/// Longest gap that is interpolated over without a warning \[s\].
pub const GAP: f64 = 0.2;
/// The same where a file's samples are further apart, as those of a satellite receiver, in steps.
const GAP_STEPS: f64 = 2.5;

/// The samples of one file.
pub struct Part {
    file: PathBuf,
    titles: Vec<String>,
    /// \[s\].
    pub time: Vec<f64>,
    /// Columns in the file's units.
    pub columns: Vec<Vec<f64>>,
    /// The line of the file of each sample.
    pub lines: Vec<u64>,
    /// Warnings, in whole sentences.
    pub warnings: Vec<String>,
}

/// Files that are joined.
pub struct Joined {
    pub time: Vec<f64>,
    pub lines: Vec<u64>,
    /// Columns by their indices.
    pub values: BTreeMap<usize, Vec<f64>>,
    pub warnings: Vec<String>,
}

/// The time of a table whose times are written out.
pub fn time_column(place: usize, unit: Unit) -> Column {
    Column { quantity: Quantity::Time, terms: vec![Term { sign: 1.0, place }], unit, source: UnitSource::Header }
}

impl Part {
    /// Samples of a sheet, whose times are in a unit.
    pub fn new(sheet: &Sheet, samples: Samples, unit: Unit) -> Self {
        Part {
            file: sheet.file.clone(),
            titles: (0..sheet.header.width()).map(|place| sheet.header.shown(place)).collect(),
            time: samples.time.into_iter().map(|time| time * unit.in_si).collect(),
            columns: samples.columns,
            lines: samples.lines,
            warnings: samples.warnings,
        }
    }

    /// Interpolates missing values, and cuts off samples before the first or after the
    /// last value of a column. Returns warnings about long gaps. `places` are the
    /// columns' indices in the file.
    ///
    /// # Errors
    /// A column has no values, or at no time do all columns have values.
    pub fn fill_gaps(&mut self, places: &[usize]) -> Result<Vec<String>, RecordingError> {
        if self.columns.iter().flatten().all(|value| !value.is_nan()) {
            return Ok(Vec::new());
        }
        let refused = |reason| RecordingError::Whole { file: self.file.clone(), reason };
        let mut warnings = Vec::new();
        let (mut first, mut last) = (0, self.time.len() - 1);
        for (values, &place) in self.columns.iter_mut().zip(places) {
            let known: Vec<usize> = (0..values.len()).filter(|&sample| !values[sample].is_nan()).collect();
            let (Some(begin), Some(end)) = (known.first(), known.last()) else {
                return Err(refused(format!("column {} is empty", self.titles[place])));
            };
            (first, last) = (first.max(*begin), last.min(*end));
            for pair in known.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                let span = self.time[b] - self.time[a];
                if span > GAP && b - a > 1 {
                    warnings.push(format!(
                        "Column {} is empty for {span:.2} s after line {}; the gap is interpolated linearly.",
                        self.titles[place], self.lines[a]
                    ));
                }
                for k in a + 1..b {
                    let t = if span > 0.0 { (self.time[k] - self.time[a]) / span } else { 0.0 };
                    values[k] = values[a] + t * (values[b] - values[a]);
                }
            }
        }
        if last <= first {
            return Err(refused("has no time at which all columns have values".to_owned()));
        }
        self.time = self.time[first..=last].to_vec();
        self.lines = self.lines[first..=last].to_vec();
        for values in &mut self.columns {
            *values = values[first..=last].to_vec();
        }
        Ok(warnings)
    }

    /// Checks that time increases.
    fn check_order(&self) -> Result<(), RecordingError> {
        let Some(wrong) = (1..self.time.len()).find(|&k| self.time[k] <= self.time[k - 1]) else { return Ok(()) };
        let (before, after) = (self.time[wrong - 1], self.time[wrong]);
        let what = if after < before { "goes back" } else { "stands still" };
        Err(RecordingError::Line {
            file: self.file.clone(),
            line: self.lines[wrong],
            column: None,
            reason: format!(
                "time {what}: {} s comes after {} s{}",
                shown(after),
                shown(before),
                sampling::remedy_for_equal_times(&self.time, wrong)
            ),
        })
    }

    /// A column at other times, by linear interpolation. The times ascend and are
    /// within the part's range.
    fn at(&self, column: &[f64], times: &[f64]) -> Vec<f64> {
        let mut after = 1;
        let value = |&time: &f64| {
            while after + 1 < self.time.len() && self.time[after] < time {
                after += 1;
            }
            let (t0, t1) = (self.time[after - 1], self.time[after]);
            let t = ((time - t0) / (t1 - t0)).clamp(0.0, 1.0);
            column[after - 1] + t * (column[after] - column[after - 1])
        };
        times.iter().map(value).collect()
    }
}

/// Joins files over the time that those with required columns have in common. The samples are those
/// of the file with index `base`. The others are interpolated linearly, and hold their first and
/// last values beyond their ends.
///
/// # Errors
/// Time does not increase in a file, or the files have no time in common.
pub fn by_time(
    name: &Path,
    mut parts: Vec<(Vec<usize>, Part)>,
    base: usize,
    spreads_equal_times: bool,
    is_required: impl Fn(usize) -> bool,
) -> Result<Joined, RecordingError> {
    for (_, part) in &mut parts {
        if spreads_equal_times {
            part.warnings.extend(sampling::spread_equal_times(&mut part.time));
        }
        part.check_order()?;
    }
    let common = |parts: &mut dyn Iterator<Item = &Part>| {
        parts.fold((f64::NEG_INFINITY, f64::INFINITY), |(from, to), part| {
            (from.max(part.time[0]), to.min(part.time[part.time.len() - 1]))
        })
    };
    let is_needed = |(places, _): &&(Vec<usize>, Part)| places.iter().any(|&place| is_required(place));
    let (from, to) = common(&mut parts.iter().filter(is_needed).map(|(_, part)| part));
    let all = common(&mut parts.iter().map(|(_, part)| part));
    let main = parts.iter().find(|(places, _)| places.contains(&base)).map(|(_, part)| part);
    let (Some(main), true) = (main, all.1 > all.0) else {
        let span = |part: &Part| {
            let (first, last) = (part.time[0], part.time[part.time.len() - 1]);
            format!("{} from {first:.2} s to {last:.2} s", part.file.display())
        };
        let spans: Vec<String> = parts.iter().map(|(_, part)| span(part)).collect();
        let reason = format!("the files have no time in common: {}", spans.join(", "));
        return Err(RecordingError::Whole { file: name.to_owned(), reason });
    };
    let kept: Vec<usize> = (0..main.time.len()).filter(|&k| (from..=to).contains(&main.time[k])).collect();
    if kept.len() < 2 {
        let reason = "the files have fewer than two samples in common".to_owned();
        return Err(RecordingError::Whole { file: name.to_owned(), reason });
    }
    let time: Vec<f64> = kept.iter().map(|&k| main.time[k]).collect();
    let lines = kept.iter().map(|&k| main.lines[k]).collect();
    let mut values = BTreeMap::new();
    let mut warnings = Vec::new();
    for (places, part) in &parts {
        for (&place, column) in places.iter().zip(&part.columns) {
            values.insert(place, part.at(column, &time));
        }
        warnings.extend(part.warnings.iter().cloned());
        let longest = GAP.max(GAP_STEPS * median(part.time.windows(2).map(|pair| pair[1] - pair[0])));
        let gap = part.time.windows(2).zip(&part.lines).find(|(pair, _)| pair[1] - pair[0] > longest);
        if let Some((pair, line)) = gap {
            warnings.push(format!(
                "{} has no samples for {:.2} s after line {line}; the gap is interpolated linearly.",
                part.file.display(),
                pair[1] - pair[0]
            ));
        }
    }
    Ok(Joined { time, lines, values, warnings })
}
