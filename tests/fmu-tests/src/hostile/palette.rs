//! Values that a hostile host likes.

use super::choices::Choices;

/// Reals at which arithmetic goes wrong.
const NASTY: [f64; 16] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    -0.0,
    0.0,
    1e300,
    -1e-300,
    1e18,
    -1e9,
    1e-12,
    -1.0,
    1e5,
];

/// A real near `start`, anywhere in the usual, or nasty.
pub fn real(choices: &mut Choices, start: f64) -> f64 {
    match choices.below(16) {
        0..8 => start * (0.5 + choices.fraction()) + (choices.fraction() - 0.5),
        8..12 => 40.0 * (choices.fraction() - 0.5),
        12..15 => choices.of(&NASTY),
        _ => f64::from_bits(choices.bits()),
    }
}

/// An integer near the small ones that mean something, or nasty.
pub fn integer(choices: &mut Choices) -> i32 {
    match choices.below(8) {
        0..6 => choices.below(6) as i32 - 1,
        6 => choices.of(&[i32::MIN, i32::MAX, -2, 7]),
        _ => choices.bits() as i32,
    }
}

/// A real that is not finite.
pub fn not_finite(choices: &mut Choices) -> f64 {
    choices.of(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY])
}
