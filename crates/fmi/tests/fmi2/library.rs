//! The shared library as a file.

use std::collections::BTreeSet;
use std::process::Command;

use object::{Object, ObjectSymbol};

use crate::fixture::*;

#[test]
fn exports_the_functions_of_the_standard_and_nothing_else() {
    let bytes = std::fs::read(library()).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    // On macOS, C functions have an underscore in front.
    let name = |name: &[u8]| String::from_utf8_lossy(name).trim_start_matches('_').to_string();
    let exported: BTreeSet<_> = file.exports().unwrap().iter().map(|export| name(export.name())).collect();
    let expected: BTreeSet<_> = moris_fmu_host::Api::SYMBOLS.iter().map(ToString::to_string).collect();
    assert_eq!(exported, expected);
    let defined = file.dynamic_symbols().filter(ObjectSymbol::is_definition).count();
    assert_eq!(defined, expected.len());
}

/// Run in a separate process, in which no other test has loaded the library, by
/// [`can_be_unloaded_and_loaded_again`].
#[test]
#[ignore = "a part of can_be_unloaded_and_loaded_again, which runs it"]
fn load_and_unload_alone() {
    for _ in 0..10 {
        let fmu = open();
        assert!(is_mapped() != Some(false));
        let mut instance = fmu.instantiate("again").unwrap();
        instance.initialize(&[("trap", 3.0)], None).unwrap();
        assert_eq!(instance.do_step(0.0, 0.1), moris_fmu_host::Status::Error, "the trap");
        drop(instance);
        drop(fmu);
        assert!(is_mapped() != Some(true));
    }
}

/// True if the library is in this process's memory; known on Linux only.
fn is_mapped() -> Option<bool> {
    let maps = std::fs::read_to_string("/proc/self/maps").ok()?;
    Some(maps.contains(library().file_name().unwrap().to_str().unwrap()))
}

#[test]
fn can_be_unloaded_and_loaded_again() {
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "library::load_and_unload_alone", "--test-threads=1"])
        .output()
        .unwrap();
    assert!(child.status.success(), "{}", String::from_utf8_lossy(&child.stdout));
}
