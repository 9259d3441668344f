//! Linking for macOS on other systems, without Apple's development kit. The linker needs only the
//! list of names in the system's library, which zig contains.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{Error, Platform, tools, workspace};

/// Makes a directory that replaces the development kit: it lists the names in the system's library.
///
/// # Errors
/// There is no zig, or its list cannot be read, or a file cannot be written.
pub fn development_kit(platform: Platform) -> Result<PathBuf, Error> {
    let list = tools::zig_library(platform)?.join("libc/darwin/libSystem.tbd");
    let text = fs::read_to_string(&list).map_err(|reason| Error::Read { file: list, reason })?;
    let stub = stub_text(&listed_names(&text));
    let kit = workspace::target_directory().join("apple-names");
    // The names that rustc asks for; on a Mac all three are the same library.
    for library in ["System", "c", "m"] {
        write_stub(&kit.join(format!("usr/lib/lib{library}.tbd")), &stub)?;
    }
    Ok(kit)
}

/// The names in all documents of a text-based stub file: whatever is listed under `symbols` of any
/// kind.
///
/// The system's library is an umbrella over many, each with its own document and processors. A
/// linker does not distinguish them.
fn listed_names(text: &str) -> BTreeSet<&str> {
    let lists = text.split("symbols:").skip(1).filter_map(|rest| rest.split_once('[')?.1.split_once(']'));
    lists.flat_map(|(list, _)| list.split(',')).map(str::trim).filter(|name| !name.is_empty()).collect()
}

/// A stub file for the system's library with these names.
fn stub_text(names: &BTreeSet<&str>) -> String {
    let names = names.iter().copied().collect::<Vec<_>>().join(", ");
    format!(
        "--- !tapi-tbd\ntbd-version: 4\ntargets: [ x86_64-macos, arm64-macos ]\n\
         install-name: '/usr/lib/libSystem.B.dylib'\nexports:\n  - targets: [ x86_64-macos, arm64-macos ]\n    \
         symbols: [ {names} ]\n...\n"
    )
}

fn write_stub(file: &Path, text: &str) -> Result<(), Error> {
    let directory = file.parent().unwrap_or(Path::new("."));
    let written = fs::create_dir_all(directory).and_then(|()| fs::write(file, text));
    written.map_err(|reason| Error::Write { file: file.to_owned(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_every_document() {
        let text = "--- !tapi-tbd\ninstall-name: '/usr/lib/libSystem.B.dylib'\nexports:\n  - targets: [ x86_64-macos ]\n    \
                    symbols: [ _malloc, 'R8289209$_close',\n  _free ]\n    weak-symbols: [ _weak ]\n--- !tapi-tbd\n\
                    exports:\n  - targets: [ arm64-macos ]\n    symbols: [ _free, __tlv_bootstrap ]\n...\n";
        let expected = ["'R8289209$_close'", "__tlv_bootstrap", "_free", "_malloc", "_weak"];
        assert_eq!(listed_names(text), BTreeSet::from(expected));
        assert_eq!(listed_names(&stub_text(&listed_names(text))), BTreeSet::from(expected));
    }
}
