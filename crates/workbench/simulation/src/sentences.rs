//! Sentences with values in their places, out of `sentences.txt`.

use std::fmt::Display;
use std::sync::LazyLock;

/// Each sentence with its name. A line that is indented goes on with the one before.
static SENTENCES: LazyLock<Vec<(&str, String)>> = LazyLock::new(|| {
    let mut sentences: Vec<(&str, String)> = Vec::new();
    for line in include_str!("sentences.txt").lines() {
        if let (Some(more), Some((_, text))) = (line.strip_prefix("    "), sentences.last_mut()) {
            *text += &format!(" {more}");
        } else if let Some((name, text)) = line.split_once(": ") {
            sentences.push((name, text.to_owned()));
        }
    }
    sentences
});

/// The pieces of a sentence in its order: text, and what stands in braces behind it for a value.
pub fn pieces(sentence: &str) -> impl Iterator<Item = (&str, Option<&str>)> {
    sentence.split('}').map(|part| part.split_once('{').map_or((part, None), |(text, place)| (text, Some(place))))
}

/// A sentence with its values: `{ratio:.1}` is one with a decimal.
///
/// # Panics
/// Never: a test looks up each sentence that is named.
pub fn filled(name: &str, values: &[(&str, &dyn Display)]) -> String {
    let (_, text) = SENTENCES.iter().find(|(other, _)| *other == name).expect("a test looks up each sentence");
    let mut sentence = String::new();
    for (text, place) in pieces(text) {
        sentence += &text.replace("\\n", "\n");
        let Some(place) = place else { continue };
        let (key, decimals) = place.split_once(":.").unwrap_or((place, ""));
        let value = values.iter().find(|(other, _)| *other == key).map_or(&place as &dyn Display, |(_, value)| *value);
        sentence += &decimals.parse().map_or_else(|_| value.to_string(), |count: usize| format!("{value:.count$}"));
    }
    sentence
}

/// A sentence by its name, with values: `name = value`, or `name` for the variable that is called
/// so.
macro_rules! sentence {
    (@value $key:ident) => { $key };
    (@value $key:ident $value:expr) => { $value };
    ($name:literal $(, $key:ident $(= $value:expr)?)* $(,)?) => {
        $crate::sentences::filled($name, &[$(
            (stringify!($key), &$crate::sentences::sentence!(@value $key $($value)?) as &dyn std::fmt::Display)
        ),*])
    };
}
pub(crate) use sentence;

#[cfg(test)]
#[path = "../../../../tests/cases/calls.rs"]
mod calls;

#[cfg(test)]
mod tests {
    use super::calls::calls;
    use super::*;

    #[test]
    fn every_sentence_is_named_with_its_values_and_every_named_one_exists() {
        let calls = calls("sentence", concat!(env!("CARGO_MANIFEST_DIR"), "/src"));
        for (name, given) in &calls {
            let (_, text) = SENTENCES.iter().find(|(other, _)| other == name).unwrap_or_else(|| panic!("{name}"));
            for place in pieces(text).filter_map(|(_, place)| place) {
                let key = place.split(':').next().unwrap();
                assert!(given.split(']').next().unwrap().contains(key), "{name} has no value {key}");
            }
        }
        let mut named: Vec<&str> = calls.iter().map(|(name, _)| name.as_str()).collect();
        named.sort_unstable();
        named.dedup();
        let mut written: Vec<&str> = SENTENCES.iter().map(|(name, _)| *name).collect();
        written.sort_unstable();
        assert_eq!(named, written);
    }

    #[test]
    fn values_stand_in_their_places() {
        let (values, end) = (["a", "b"].join(", "), 2.345);
        assert_eq!(
            filled("felt-shakes", &[("name", &values), ("value", &end), ("time", &1)]).split(" (").next(),
            Some("Felt a, b shakes by 2.35 m/s²")
        );
        assert!(!filled("regular", &[]).contains('\\') && filled("regular", &[]).ends_with('\n'));
    }
}
