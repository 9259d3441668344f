//! Encoding of series in the page: numbers as base64 of their little-endian bytes, which is a
//! quarter of their digits and keeps what is not a number.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Serializer;

/// Series that are only looked at: seven digits.
pub mod f32_series {
    use serde::Serializer;
    use serde::ser::SerializeSeq;

    /// # Errors
    /// The serializer's.
    pub fn one<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&encoded(values))
    }

    /// # Errors
    /// The serializer's.
    pub fn many<S: Serializer>(series: &[Vec<f64>], serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(Some(series.len()))?;
        for values in series {
            list.serialize_element(&encoded(values))?;
        }
        list.end()
    }

    fn encoded(values: &[f64]) -> String {
        super::base64(values.iter().flat_map(|&value| (value as f32).to_le_bytes()))
    }
}

/// Times, whose differences matter as well.
pub mod f64_series {
    use serde::Serializer;

    /// # Errors
    /// The serializer's.
    pub fn one<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&super::base64(values.iter().flat_map(|value| value.to_le_bytes())))
    }
}

/// Flags, one byte each.
///
/// # Errors
/// The serializer's.
pub fn flags<S: Serializer>(values: &[bool], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&base64(values.iter().map(|&value| u8::from(value))))
}

fn base64(bytes: impl Iterator<Item = u8>) -> String {
    STANDARD.encode(bytes.collect::<Vec<u8>>())
}
