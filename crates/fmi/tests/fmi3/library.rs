//! The shared library as a file.

use std::collections::BTreeSet;

use object::Object;

use crate::fixture::*;

#[test]
fn exports_the_functions_of_the_standard_and_nothing_else() {
    let bytes = std::fs::read(library()).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    // On macOS, C functions have an underscore in front.
    let name = |name: &[u8]| String::from_utf8_lossy(name).trim_start_matches('_').to_string();
    let exported: BTreeSet<_> = file.exports().unwrap().iter().map(|export| name(export.name())).collect();
    let expected: BTreeSet<_> = moris_fmu_host::fmi3::Api::SYMBOLS.iter().map(ToString::to_string).collect();
    assert_eq!(exported, expected);
}

#[test]
fn the_version_is_the_standard_s() {
    // The string lives as long as the library is loaded.
    let library = open();
    // SAFETY: it takes no arguments.
    assert_eq!(text(unsafe { (library.api().get_version)() }), "3.0");
}
