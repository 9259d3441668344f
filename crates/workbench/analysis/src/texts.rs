//! The sentences of messages, with values in their places.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use moris_simulation::sentences::pieces;

use crate::message::{Message, Remedy, given, named};

/// Sentences by name. `{ratio:.1}` is a value with one decimal, `{--gravity removed}` an option.
static TEXTS: LazyLock<BTreeMap<String, String>> =
    LazyLock::new(|| toml::from_str(include_str!("texts.toml")).expect("a test reads the sentences"));

/// A value in a sentence.
pub enum Value {
    Number(f64),
    Part(Message),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Value::Number(number)
    }
}

/// Types that become a part of a message.
macro_rules! parts {
    ($($kind:ty)*) => { $(
        impl From<$kind> for Value {
            fn from(part: $kind) -> Self {
                Value::Part(part.into())
            }
        }
    )* };
}
parts! { &str String Remedy Message }

/// Types that are written as text.
macro_rules! written {
    ($($kind:ty)*) => { $(
        impl From<$kind> for Value {
            fn from(value: $kind) -> Self {
                Value::Part(value.to_string().into())
            }
        }
    )* };
}
written! { &String usize u64 }

/// A sentence with its values.
///
/// # Panics
/// Never: a test looks up each sentence that is named.
pub fn filled(name: &str, values: &[(&str, Value)]) -> Message {
    let mut message = Message::default();
    for (text, place) in pieces(&TEXTS[name]) {
        message.push(text);
        let Some(place) = place else { continue };
        if let Some(option) = place.strip_prefix("--") {
            message.push(option.split_once(' ').map_or_else(|| named(option), |(option, value)| given(option, value)));
            continue;
        }
        let (key, decimals) = place.split_once(":.").unwrap_or((place, "0"));
        match values.iter().find(|(other, _)| *other == key) {
            Some((_, Value::Number(number))) => {
                message.push(format!("{number:.*}", decimals.parse::<usize>().unwrap_or(0)));
            }
            Some((_, Value::Part(part))) => message.push(part.clone()),
            None => message.push(format!("{{{place}}}")),
        }
    }
    message
}

/// A sentence by its name, with values: `name = value`, or `name` for the variable that is called
/// so.
#[macro_export]
macro_rules! text {
    (@value $key:ident) => { $key };
    (@value $key:ident $value:expr) => { $value };
    ($name:literal $(, $key:ident $(= $value:expr)?)* $(,)?) => {
        $crate::texts::filled($name, &[$( (stringify!($key), $crate::texts::text!(@value $key $($value)?).into()) ),*])
    };
}
pub use text;

#[cfg(test)]
#[path = "../../../../tests/cases/calls.rs"]
mod calls;

#[cfg(test)]
mod tests {
    use super::calls::calls;
    use super::*;

    #[test]
    fn every_sentence_is_named_and_every_named_one_exists() {
        let root = env!("CARGO_MANIFEST_DIR");
        let calls = ["src", "../moris/src", "../python/src"].map(|folder| calls("text", format!("{root}/{folder}")));
        let mut named: Vec<&str> =
            calls.iter().flatten().map(|(name, _)| name.as_str()).chain(["text-of-a-test"]).collect();
        named.sort_unstable();
        named.dedup();
        assert_eq!(named, TEXTS.keys().collect::<Vec<_>>());
    }

    #[test]
    fn values_and_options_stand_in_their_places() {
        let values = [("speed", Value::from(9.876)), ("quantity", "speed".into()), ("remedy", given("rate", 5).into())];
        let filled = filled("text-of-a-test", &values).to_string();
        assert_eq!(filled, "9.88 m/s, or 10, is speed: use rate 5 or gravity removed or columns");
    }
}
