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

/// A sentence with its values: `{ratio:.1}` is one with a decimal.
///
/// # Panics
/// Never: a test looks up each sentence that is named.
pub fn filled(name: &str, values: &[(&str, &dyn Display)]) -> String {
    let (_, text) = SENTENCES.iter().find(|(other, _)| *other == name).expect("a test looks up each sentence");
    let text = text.replace("\\n", "\n");
    let mut parts = text.split('{');
    let mut sentence = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (place, behind) = part.split_once('}').unwrap_or((part, ""));
        let (key, decimals) = place.split_once(":.").unwrap_or((place, ""));
        let value = values.iter().find(|(other, _)| *other == key).map_or(&place as &dyn Display, |(_, value)| *value);
        sentence += &decimals.parse().map_or_else(|_| value.to_string(), |count: usize| format!("{value:.count$}"));
        sentence += behind;
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
    fn every_sentence_is_named_with_its_values_and_every_named_one_exists() {
        let sources = sources(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")));
        let calls = sources.iter().flat_map(|text| text.split(concat!("sentence", "![")).skip(1));
        let mut named: Vec<&str> = Vec::new();
        for call in calls {
            let Some((name, given)) = call.trim_start().strip_prefix('"').and_then(|call| call.split_once('"')) else {
                continue;
            };
            let (_, text) = SENTENCES.iter().find(|(other, _)| *other == name).unwrap_or_else(|| panic!("{name}"));
            for place in text.split('{').skip(1) {
                let key = place.split([':', '}']).next().unwrap();
                assert!(given.split(']').next().unwrap().contains(key), "{name} has no value {key}");
            }
            named.push(name);
        }
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
