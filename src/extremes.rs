//! The smaller and the larger of two numbers, neither of which is NaN: one instruction, where `f64::min` and `f64::max`
//! take six to look for NaN as well.

pub fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
