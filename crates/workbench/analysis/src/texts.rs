//! The sentences of messages, with values in their places.

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
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;

    fn sources(folder: &Path) -> Vec<String> {
        let of = |path: &Path| match path.is_dir() {
            true => sources(path),
            false => path
                .extension()
                .is_some_and(|end| end == "rs")
                .then(|| fs::read_to_string(path).unwrap())
                .into_iter()
                .collect(),
        };
        fs::read_dir(folder).unwrap().flat_map(|entry| of(&entry.unwrap().path())).collect()
    }

    #[test]
    fn every_sentence_is_named_and_every_named_one_exists() {
        let folders = ["src", "../moris/src", "../python/src"];
        let sources: Vec<String> =
            folders.iter().flat_map(|folder| sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder))).collect();
        let calls = sources.iter().flat_map(|text| text.split(concat!("text", "![")).skip(1));
        let mut named: Vec<&str> = calls
            .filter_map(|call| call.trim_start().strip_prefix('"')?.split('"').next())
            .chain(["text-of-a-test"])
            .collect();
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
