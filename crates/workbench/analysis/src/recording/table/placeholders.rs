//! Columns with one value throughout beside others that move: placeholders of a logger.

use moris_interface::shown;

use crate::message::{Message, given};
use crate::recording::columns::Column;
use crate::recording::conventions::{Conventions, EmptyFields, Quantity};
use crate::recording::message::quoted;
use crate::recording::read::{Samples, Sheet};
use crate::recording::signal::is_constant;
use crate::texts::text;

/// Warnings about columns in use with one value throughout, where another moves that is likely the
/// quantity's.
pub fn warnings(sheet: &Sheet, samples: &Samples, layout: &[Column], conventions: &Conventions) -> Vec<Message> {
    // Least samples that show a column dead.
    const LEAST: usize = 50;
    if samples.time.len() < LEAST {
        return Vec::new();
    }
    let values = |place: usize| samples.columns.iter().find(|(other, _)| *other == place).map(|(_, values)| values);
    let lenient = Conventions { empty_fields: EmptyFields::Interpolate, ..conventions.clone() };
    let moves = |&place: &usize| {
        let found = sheet.samples(&[place], &lenient).ok();
        found.is_some_and(|found| {
            let known: Vec<f64> = found.columns[0].1.iter().copied().filter(|value| value.is_finite()).collect();
            known.len() > LEAST / 10 && !is_constant(&known)
        })
    };
    let warning = |column: &Column| {
        let [term] = column.terms[..] else { return None };
        let dead = values(term.place).filter(|values| is_constant(values))?;
        let other = sheet.header.likely(column.quantity, layout).into_iter().find(moves)?;
        let (name, other) = (sheet.header.shown(term.place), sheet.header.name(other));
        let remedy = given("columns", format!("\"{}={other}\"", column.quantity.key()));
        let (value, other) = (shown(dead[0]), quoted(other));
        Some(text!["placeholder", name, value, other, remedy])
    };
    layout.iter().filter(|column| column.quantity != Quantity::Time).filter_map(warning).collect()
}
