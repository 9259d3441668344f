//! The smaller and the larger of two numbers: one instruction, where `f64::min` and `f64::max` take six to leave out NaN on
//! either side. Here one in the first place is left out, and one in the second is returned.

pub fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
