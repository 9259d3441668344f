//! Which variable a wrong name was meant to be.

use alloc::{string::String, vec::Vec};

use crate::Row;

/// Largest part of a name that may be wrong.
const MAX_WRONG_FRACTION: f64 = 0.3;

/// The variable of these rows whose name looks most like `name`; none if all differ in more than
/// three tenths of the letters.
pub(crate) fn nearest_name(rows: &[Row], name: &str) -> Option<String> {
    let names = rows.iter().flat_map(|row| (0..row.slots()).map(|element| row.variable_name(element)));
    let (edits, near) =
        names.map(|candidate| (edit_distance(name, &candidate), candidate)).min_by_key(|(edits, _)| *edits)?;
    (edits as f64 <= MAX_WRONG_FRACTION * near.len() as f64).then_some(near)
}

/// Number of letters to insert, remove or replace until `from` is `to` (Levenshtein), in any
/// case.
fn edit_distance(from: &str, to: &str) -> usize {
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, letter) in from.bytes().enumerate() {
        let mut diagonal = i;
        row[0] = i + 1;
        for (j, other) in to.bytes().enumerate() {
            let replaced = diagonal + usize::from(!letter.eq_ignore_ascii_case(&other));
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[to.len()]
}
