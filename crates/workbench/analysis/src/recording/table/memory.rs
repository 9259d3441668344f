//! Tables of columns that are in memory already.

use std::path::PathBuf;

use super::{Table, gaps};
use crate::message::Message;
use crate::recording::columns::{Header, value_places};
use crate::recording::conventions::{Conventions, EmptyFields, Quantity};
use crate::recording::message::{RecordingError, quoted};
use crate::recording::read::Samples;
use crate::texts::text;

/// The recording in columns, by the rules for a file's: names, and units in their brackets. `name`
/// is what messages call it.
///
/// # Errors
/// As [`super::read`]; columns of different lengths.
pub fn of_columns(
    name: &str,
    columns: &[(String, Vec<f64>)],
    conventions: &Conventions,
) -> Result<Table, RecordingError> {
    let file = PathBuf::from(name);
    let refused = |reason: Message| RecordingError::whole(&file, reason);
    let header = Header::new(columns.iter().map(|(title, _)| title.as_str()));
    let layout = header.columns(conventions, conventions.rate.is_some()).map_err(refused)?;
    let count = layout.first().and_then(|column| column.terms.first()).map_or(0, |term| columns[term.place].1.len());
    // The time is the first of all quantities.
    let of_time = layout.first().filter(|column| column.quantity == Quantity::Time);
    let time: Vec<f64> = (0..count)
        .map(|sample| match (of_time, conventions.rate) {
            (Some(column), _) => {
                let values =
                    column.terms.iter().map(|term| term.factor * columns[term.place].1.get(sample).unwrap_or(&0.0));
                column.unit.in_si * values.sum::<f64>()
            }
            (None, rate) => sample as f64 / rate.unwrap_or(1.0),
        })
        .collect();
    if time.len() < 2 {
        return Err(refused("has fewer than two samples".into()));
    }
    let time_place = of_time.and_then(|column| column.terms.first()).map(|term| term.place);
    for term in layout.iter().flat_map(|column| &column.terms) {
        let (title, values) = &columns[term.place];
        let (title, expected) = (quoted(title), time.len());
        if values.len() != expected {
            return Err(refused(format!("column {title} has {} values, others have {expected}", values.len()).into()));
        }
        let may_be_empty = conventions.empty_fields == EmptyFields::Interpolate && Some(term.place) != time_place;
        let is_wrong = |value: &f64| !(value.is_finite() || value.is_nan() && may_be_empty);
        if let Some(sample) = values.iter().position(is_wrong) {
            let reason = text!["gap", value = values[sample].to_string()];
            return Err(RecordingError::line(&file, sample as u64 + 1, Some(title), reason));
        }
    }
    let mut samples = Samples {
        columns: value_places(&layout).into_iter().map(|place| (place, columns[place].1.clone())).collect(),
        lines: (1..=time.len() as u64).collect(),
        time,
        warnings: Vec::new(),
        complete: None,
    };
    gaps::fill(&mut samples, (&file, &header), &layout, conventions)?;
    Table::new(file, layout, samples, conventions)
}
