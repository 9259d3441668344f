//! Values of options: numbers within bounds, one or several.

use std::ops::RangeInclusive;

/// As many numbers as are asked for, with commas between them; none if the text is something else.
pub fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// A number within a range.
///
/// # Errors
/// The text is something else: what is needed.
pub fn number_in(text: &str, range: RangeInclusive<f64>, needed: &str) -> Result<f64, String> {
    text.parse().ok().filter(|number| range.contains(number)).ok_or_else(|| needed.to_owned())
}
