//! Encoding of series in the page, which `page/data.js` decodes.
//!
//! Values are whole multiples of a quantum, six digits of the largest. Their second differences,
//! small where a curve is smooth, are written as variable-length numbers, deflated, in base64:
//! about a byte a sample, a fifth of 32-bit numbers in base64. A series with a value that is not a
//! number has its 32-bit numbers.

use std::io::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde::{Serialize, Serializer};

/// A series in the page.
#[derive(Serialize)]
struct Series {
    /// The quantum as a power of two; none for 32-bit numbers.
    power: Option<i32>,
    deflated: String,
}

impl Series {
    /// A series with a quantum of this power.
    fn of(values: &[f64], power: i32) -> Self {
        let quantum = f64::from(power).exp2();
        let mut bytes = Vec::with_capacity(2 * values.len());
        let (mut last, mut slope) = (0, 0);
        for value in values {
            let number = (value / quantum).round() as i64;
            write_number(&mut bytes, number - last - slope);
            (slope, last) = (number - last, number);
        }
        Series { power: Some(power), deflated: deflated_text(&bytes) }
    }

    /// A series for display.
    fn looked_at(values: &[f64]) -> Self {
        // Powers between the quantum and the largest value of a series: six digits.
        const RESOLUTION_BITS: i32 = 21;
        let largest = largest_size(values);
        if values.iter().all(|value| value.is_finite()) {
            Series::of(values, power_of(largest) - RESOLUTION_BITS)
        } else {
            let bytes: Vec<u8> = values.iter().flat_map(|&value| (value as f32).to_le_bytes()).collect();
            Series { power: None, deflated: deflated_text(&bytes) }
        }
    }
}

fn largest_size(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

/// The power of two that is at least this.
fn power_of(value: f64) -> i32 {
    // Values below this power of two count as zero.
    const MIN_EXPONENT: i32 = -1000;
    (value.log2().ceil() as i32).max(MIN_EXPONENT)
}

/// Appends a number in groups of seven bits, the lowest first; all but the last byte have their
/// highest bit set. The lowest bit of the whole is the sign.
fn write_number(bytes: &mut Vec<u8>, number: i64) {
    let mut left = ((number << 1) ^ (number >> 63)) as u64;
    while left >= 0x80 {
        bytes.push(left as u8 | 0x80);
        left >>= 7;
    }
    bytes.push(left as u8);
}

fn deflated_text(bytes: &[u8]) -> String {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    STANDARD.encode(written.expect("memory takes whatever is written"))
}

/// A series for display only, with six digits. An empty series is null.
///
/// # Errors
/// The serializer's.
pub fn curve<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    (!values.is_empty()).then(|| Series::looked_at(values)).serialize(serializer)
}

/// Several such series, none of them null.
///
/// # Errors
/// The serializer's.
pub fn curves<S: Serializer>(series: &[Vec<f64>], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(series.iter().map(|values| Series::looked_at(values)))
}

/// Times. None are null.
///
/// # Errors
/// The serializer's.
pub fn times<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    // The power of the quantum of times: a nanosecond, or more where times are longer than some
    // days.
    const OF_TIMES: i32 = -30;
    // Powers between the quantum and the largest time, with which all differences are whole numbers
    // in a script.
    const OF_LONG_TIMES: i32 = 49;
    let power = OF_TIMES.max(power_of(largest_size(values)) - OF_LONG_TIMES);
    (!values.is_empty()).then(|| Series::of(values, power)).serialize(serializer)
}

/// Flags, one byte each, deflated.
///
/// # Errors
/// The serializer's.
pub fn flags<S: Serializer>(values: &[bool], serializer: S) -> Result<S::Ok, S::Error> {
    let bytes: Vec<u8> = values.iter().map(|&value| u8::from(value)).collect();
    serializer.serialize_str(&deflated_text(&bytes))
}

/// Bytes, deflated.
///
/// # Errors
/// The serializer's.
pub fn bytes<S: Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&deflated_text(bytes))
}

/// Series whose values a page needs to the last bit. The first bytes of all values come first, then
/// the second ones: the bytes of signs and exponents repeat, those of digits do not.
///
/// # Errors
/// The serializer's.
pub fn exact<S: Serializer>(series: &[Vec<f64>], serializer: S) -> Result<S::Ok, S::Error> {
    let bytes = |values: &[f64]| {
        let planes = (0..8).flat_map(|place| values.iter().map(move |value| value.to_le_bytes()[place]));
        deflated_text(&planes.collect::<Vec<u8>>())
    };
    serializer.collect_seq(series.iter().map(|values| bytes(values)))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::io::Read;

    fn inflated(text: &str) -> Vec<u8> {
        let bytes = STANDARD.decode(text).unwrap();
        let mut decoded = Vec::new();
        flate2::read::DeflateDecoder::new(bytes.as_slice()).read_to_end(&mut decoded).unwrap();
        decoded
    }

    /// The values of an encoded series.
    pub fn decoded(series: &serde_json::Value) -> Vec<f64> {
        let bytes = inflated(series["deflated"].as_str().unwrap());
        let Some(power) = series["power"].as_f64() else {
            return bytes.chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap()).into()).collect();
        };
        let (mut values, mut last, mut slope) = (Vec::new(), 0_i64, 0_i64);
        let mut bytes = bytes.into_iter();
        while let Some(first) = bytes.next() {
            let (mut byte, mut shift) = (first, 7);
            let mut number = u64::from(byte & 0x7f);
            while byte >= 0x80 {
                byte = bytes.next().unwrap();
                number |= u64::from(byte & 0x7f) << shift;
                shift += 7;
            }
            slope += (number >> 1) as i64 ^ -((number & 1) as i64);
            last += slope;
            values.push(last as f64 * power.exp2());
        }
        values
    }

    fn through(values: &[f64]) -> (Vec<f64>, usize) {
        let series = serde_json::to_value(Series::looked_at(values)).unwrap();
        (decoded(&series), series["deflated"].as_str().unwrap().len())
    }

    #[test]
    fn a_smooth_series_keeps_six_digits_in_about_a_byte_a_sample() {
        let values: Vec<f64> = (0..10_000).map(|k| 1.3 + 0.2 * (0.013 * f64::from(k)).sin()).collect();
        let (found, length) = through(&values);
        assert!(found.iter().zip(&values).all(|(found, value)| (found - value).abs() <= 0.5e-6 * 1.5));
        assert!(length < 15_000, "{length}");
    }

    #[test]
    fn numbers_of_any_size_and_sign_come_through() {
        for size in [1e-300, 1e-9, 1.0, 1e9, 1e300] {
            let values: Vec<f64> = (0..100).map(|k| size * (f64::from(k * k % 17) - 8.0)).collect();
            let (found, _) = through(&values);
            assert!(found.iter().zip(&values).all(|(found, value)| (found - value).abs() <= 4e-6 * size), "{size}");
        }
        assert_eq!(through(&[0.0; 3]).0, [0.0; 3]);
    }

    #[test]
    fn times_are_a_nanosecond_s_and_those_of_a_calendar_a_microsecond_s() {
        for (first, error) in [(0.0, 1e-9), (1.7e9, 4e-6), (-1e10, 3e-5)] {
            let values: Vec<f64> = (0..1000).map(|k| first + 0.01 * f64::from(k)).collect();
            let found = decoded(&times(&values, serde_json::value::Serializer).unwrap());
            assert!(found.iter().zip(&values).all(|(found, value)| (found - value).abs() <= error), "{first}");
        }
    }

    #[test]
    fn exact_values_keep_every_bit() {
        let values = vec![0.1, -2.5e-310, f64::MAX, 9.80665, -0.0];
        let encoded = exact(&[values.clone(), vec![]], serde_json::value::Serializer).unwrap();
        let planes = inflated(encoded[0].as_str().unwrap());
        let value = |k: usize| f64::from_le_bytes(std::array::from_fn(|place| planes[place * values.len() + k]));
        assert!((0..values.len()).all(|k| value(k).to_bits() == values[k].to_bits()));
        assert!(inflated(encoded[1].as_str().unwrap()).is_empty());
    }

    #[test]
    fn gaps_stay_gaps() {
        let (found, _) = through(&[1.5, f64::NAN, f64::INFINITY]);
        assert!(found[0] == 1.5 && found[1].is_nan() && found[2] == f64::INFINITY);
    }
}
