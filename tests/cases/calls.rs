//! Calls of a macro in sources.

use std::fs;
use std::path::Path;

/// The name that each call `macro!["name", ...]` in the sources of a folder gives, and what
/// follows it.
pub fn calls(of: &str, folder: impl AsRef<Path>) -> Vec<(String, String)> {
    let start = format!("{of}![");
    let named = |call: &str| {
        let (name, behind) = call.trim_start().strip_prefix('"')?.split_once('"')?;
        Some((name.to_owned(), behind.to_owned()))
    };
    sources(folder.as_ref())
        .iter()
        .flat_map(|text| text.split(&start).skip(1).filter_map(named).collect::<Vec<_>>())
        .collect()
}

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
