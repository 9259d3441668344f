//! Which variable a wrong name was meant to be.

use alloc::string::String;

use crate::Row;

/// The variable of these rows whose name looks most like `name`, in any case; none if all differ in
/// more than three tenths of the letters.
#[cfg(feature = "std")]
pub(crate) fn nearest_name(rows: &[Row], name: &str) -> Option<String> {
    // Largest part of a name that may be wrong.
    const MAX_WRONG_FRACTION: f64 = 0.3;
    let name = name.to_lowercase();
    let names = rows.iter().flat_map(|row| (0..row.slots()).map(|element| row.variable_name(element)));
    let edits = |candidate: &String| strsim::levenshtein(&name, &candidate.to_lowercase());
    let (edits, near) = names.map(|candidate| (edits(&candidate), candidate)).min_by_key(|(edits, _)| *edits)?;
    (edits as f64 <= MAX_WRONG_FRACTION * near.len() as f64).then_some(near)
}

/// None: the comparison needs the standard library.
#[cfg(not(feature = "std"))]
pub(crate) fn nearest_name(_: &[Row], _: &str) -> Option<String> {
    None
}
