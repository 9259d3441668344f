//! The sentences of the rules, with values in their places.

use std::collections::BTreeMap;
use std::sync::LazyLock;

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

/// A sentence with its values.
///
/// # Panics
/// Never: a test fills each sentence that the rules name.
pub fn filled(name: &str, values: &[(&str, Value)]) -> Message {
    let mut message = Message::default();
    let mut left = TEXTS[name].as_str();
    while let Some((before, behind)) = left.split_once('{') {
        let (place, behind) = behind.split_once('}').unwrap_or((behind, ""));
        message.push(before);
        left = behind;
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
    message.push(left);
    message
}

/// A sentence by its name, with values.
macro_rules! text {
    ($name:literal $(, $key:ident = $value:expr)* $(,)?) => {
        $crate::recording::rules::text::filled($name, &[$( (stringify!($key), $value.into()) ),*])
    };
}
pub(super) use text;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sentence_is_named_and_every_named_one_exists() {
        let rules = [
            include_str!("agreement.rs"),
            include_str!("channels.rs"),
            include_str!("mod.rs"),
            include_str!("motion.rs"),
            include_str!("units.rs"),
            include_str!("waveform.rs"),
        ];
        let calls = rules.into_iter().flat_map(|text| text.split("text![").skip(1));
        let mut named: Vec<&str> = calls.filter_map(|call| call.split('"').nth(1)).chain(["text-of-a-test"]).collect();
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
