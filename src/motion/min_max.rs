//! Minimum and maximum of two numbers, in one instruction each.
//!
//! `f64::min` and `f64::max` take six, to leave out a NaN on either side. Here a NaN as the first
//! argument is left out, and one as the second is returned.

pub fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

pub fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
