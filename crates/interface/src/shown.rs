//! Numbers in messages.

use alloc::{
    format,
    string::{String, ToString},
};

/// The number in few characters: very large and very small ones with an exponent. Otherwise 1e308
/// would be a 1 and 308 zeros.
pub fn shown(value: f64) -> String {
    let size = value.abs();
    if value.is_finite() && size != 0.0 && !(1e-5..1e16).contains(&size) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_the_same_when_read() {
        for (value, text) in [(0.0, "0"), (-1.0, "-1"), (1e-9, "1e-9"), (1e9, "1000000000"), (-1e308, "-1e308")] {
            assert_eq!(shown(value), text);
        }
        for value in [f64::MIN_POSITIVE, f64::MAX, -1.7e-300, 123_456.789, 5e-324, 0.1 + 0.2] {
            let text = shown(value);
            assert!(text.len() < 25 && text.parse() == Ok(value), "{text}");
        }
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(shown(value), value.to_string());
        }
    }
}
