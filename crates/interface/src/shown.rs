//! Numbers in messages.

use alloc::string::{String, ToString};
use core::fmt;

/// A number that is written in few characters: a very large or very small one with an exponent,
/// since 1e308 would be a 1 and 308 zeros. A precision is the number of decimals, as for `f64`.
///
/// Without the feature `std` it is written to 12 digits, by less code than that of `core`.
#[derive(Clone, Copy)]
pub struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        #[cfg(feature = "std")]
        if formatter.precision().is_none() && has_exponent(self.0) {
            fmt::LowerExp::fmt(&self.0, formatter)
        } else {
            self.0.fmt(formatter)
        }
        #[cfg(not(feature = "std"))]
        write_number(self.0, formatter)
    }
}

/// The text of [`Shown`].
pub fn shown(value: f64) -> String {
    Shown(value).to_string()
}

fn has_exponent(value: f64) -> bool {
    value.is_finite() && value != 0.0 && !(1e-5..1e16).contains(&value.abs())
}

/// Writes a number to 12 digits, or to the formatter's precision.
#[cfg(any(test, not(feature = "std")))]
fn write_number(value: f64, formatter: &mut fmt::Formatter) -> fmt::Result {
    let sign = if value.is_sign_negative() && !value.is_nan() { "-" } else { "" };
    if !value.is_finite() {
        return write!(formatter, "{sign}{}", if value.is_nan() { "NaN" } else { "inf" });
    }
    let (mut size, mut exponent, precision) = (value.abs(), 0, formatter.precision());
    if precision.is_none() && has_exponent(value) {
        while size >= 10.0 {
            (size, exponent) = (size / 10.0, exponent + 1);
        }
        while size < 1.0 {
            (size, exponent) = (size * 10.0, exponent - 1);
        }
    }
    let (mut decimals, mut scale) = (0, 1_u64);
    let rounded = loop {
        let scaled = size * scale as f64;
        // Half a unit is added, because `core` has no rounding.
        let rounded = (scaled + 0.5) as u64;
        let is_exact = (rounded as f64 - scaled).abs() <= 1e-13 * scaled;
        if precision.map_or(is_exact, |precision| decimals >= precision) {
            break rounded;
        }
        (decimals, scale) = (decimals + 1, scale.saturating_mul(10));
    };
    write!(formatter, "{sign}{}", rounded / scale)?;
    if decimals > 0 {
        write!(formatter, ".{:0decimals$}", rounded % scale)?;
    }
    if exponent != 0 { write!(formatter, "e{exponent}") } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As it is written without the feature `std`.
    struct Short(f64);

    impl fmt::Display for Short {
        fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
            write_number(self.0, formatter)
        }
    }

    #[test]
    fn numbers_are_short_and_the_same_when_read() {
        for (value, text) in [(0.0, "0"), (-1.0, "-1"), (1e-9, "1e-9"), (1e9, "1000000000"), (-1e308, "-1e308")] {
            assert_eq!([shown(value), Short(value).to_string()], [text, text]);
        }
        for value in [f64::MIN_POSITIVE, f64::MAX, -1.7e-300, 123_456.789, 5e-324, 0.1 + 0.2] {
            let text = shown(value);
            assert!(text.len() < 25 && text.parse() == Ok(value), "{text}");
        }
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!([shown(value), Short(value).to_string()], [value.to_string(), value.to_string()]);
        }
    }

    #[test]
    fn the_short_code_writes_a_number_of_up_to_12_digits_as_the_standard_library_does() {
        for digits in (0..1_000_000_u64).step_by(997).chain([123_456_789_012, 999_999_999_999]) {
            for exponent in -20..20 {
                let value: f64 = format!("{digits}e{exponent}").parse().unwrap();
                for value in [value, -value] {
                    assert_eq!(Short(value).to_string(), shown(value));
                }
            }
            // Away from a half, which lies between two texts.
            let value = digits as f64 / 997.0 + 1e-5;
            assert_eq!(format!("{:.3} {:.0}", Short(value), Short(-value)), format!("{value:.3} {:.0}", -value));
        }
        assert_eq!(Short(0.1 + 0.2).to_string(), "0.3");
    }
}
