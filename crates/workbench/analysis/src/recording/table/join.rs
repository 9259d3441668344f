//! Several files of one recording, joined by time.

use std::path::{Path, PathBuf};

use super::interpolation::{places, values};
use super::times::{LONGEST_GAP, disorder, gaps, median_step, spread_equal_times};
use crate::message::Message;
use crate::recording::columns::{Column, period};
use crate::recording::conventions::Quantity;
use crate::recording::message::RecordingError;
use crate::recording::read::Samples;
use crate::texts::text;

/// The samples of one file, with the time in seconds.
pub struct Part {
    pub file: PathBuf,
    pub samples: Samples,
}

impl Part {
    /// Checks that time increases.
    fn check_order(&self) -> Result<(), RecordingError> {
        let Some((wrong, reason)) = disorder(&self.samples.time) else { return Ok(()) };
        Err(RecordingError::line(&self.file, self.samples.lines[wrong], None, reason))
    }

    /// First and last time of the table.
    fn span(&self) -> (f64, f64) {
        (self.samples.time[0], self.samples.time[self.samples.time.len() - 1])
    }

    /// True if it holds a term of a column.
    fn holds(&self, column: &Column) -> bool {
        let mut places = self.samples.columns.iter().map(|(place, _)| *place);
        places.any(|place| column.terms.iter().any(|term| term.place == place))
    }

    /// A warning about the first long gap.
    fn gap(&self) -> Option<Message> {
        // Longest gap that is interpolated over without a warning where a file's samples are
        // further apart, as those of a satellite receiver [steps].
        const GAP_STEPS: f64 = 2.5;
        let Samples { time, lines, .. } = &self.samples;
        let longest = LONGEST_GAP.max(GAP_STEPS * median_step(time));
        let (step, line) = gaps(time, lines, longest).next()?;
        Some(text!["file-with-a-gap", file = self.file.display().to_string(), step, line])
    }
}

/// Joins files over the time that those with required columns have in common. The samples are those
/// of the file with ax. The others are interpolated linearly, and hold their first and last values
/// beyond their ends.
///
/// # Errors
/// Time does not increase in a file, or the files have no time in common.
pub fn by_time(
    name: &Path,
    mut parts: Vec<Part>,
    layout: &[Column],
    spreads_equal_times: bool,
) -> Result<Samples, RecordingError> {
    for part in &mut parts {
        if spreads_equal_times {
            part.samples.warnings.extend(spread_equal_times(&mut part.samples.time));
        }
        part.check_order()?;
    }
    let holds = |part: &Part, is_meant: fn(Quantity) -> bool| {
        layout.iter().any(|column| is_meant(column.quantity) && part.holds(column))
    };
    let (from, to) = common_time(parts.iter().filter(|part| holds(part, Quantity::is_required)));
    let (begin, end) = common_time(parts.iter());
    let main = parts.iter().find(|part| holds(part, |quantity| quantity == Quantity::Force(0)));
    let Some(main) = main.filter(|_| end > begin) else {
        let shown = |part: &Part| {
            let (first, last) = part.span();
            format!("{} from {first:.2} s to {last:.2} s", part.file.display())
        };
        let spans = parts.iter().map(shown).collect::<Vec<_>>().join(", ");
        return Err(RecordingError::whole(name, format!("the files have no time in common: {spans}")));
    };
    let of_main = main.samples.time.iter().zip(&main.samples.lines);
    let (time, lines): (Vec<f64>, Vec<u64>) = of_main.filter(|(time, _)| (from..=to).contains(*time)).unzip();
    if time.len() < 2 {
        return Err(RecordingError::whole(name, "the files have fewer than two samples in common"));
    }
    let complete = (begin > from || end < to).then_some((begin, end));
    let mut joined = Samples { time, columns: Vec::new(), lines, warnings: Vec::new(), complete };
    for part in &parts {
        if let Some((begin, end)) = part.samples.complete {
            let (from, to) = joined.complete.unwrap_or((begin, end));
            joined.complete = Some((begin.max(from), end.min(to)));
        }
        let places = places(&part.samples.time, &joined.time);
        let columns = part.samples.columns.iter();
        let columns = columns.map(|(place, column)| (*place, values(&places, column, period(layout, *place))));
        joined.columns.extend(columns);
        joined.warnings.extend(part.samples.warnings.iter().cloned().chain(part.gap()));
    }
    Ok(joined)
}

/// The time that parts have in common, from its beginning to its end.
fn common_time<'a>(parts: impl Iterator<Item = &'a Part>) -> (f64, f64) {
    let all = (f64::NEG_INFINITY, f64::INFINITY);
    parts.map(Part::span).fold(all, |(from, to), (first, last)| (from.max(first), to.min(last)))
}
