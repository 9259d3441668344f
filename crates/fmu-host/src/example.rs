//! The shared libraries that a package's examples are.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::PathBuf;

/// The shared library that is the example of this name, which `cargo test` has put beside the test
/// that asks.
///
/// # Panics
/// If the library is missing: cargo builds examples unless one target is chosen.
pub fn example_library(example: &str) -> PathBuf {
    let test = std::env::current_exe().expect("a test has a file");
    let target = test.parent().and_then(|deps| deps.parent()).expect("a test stands in deps/");
    let path = target.join("examples").join(format!("{DLL_PREFIX}{example}{DLL_SUFFIX}"));
    assert!(
        path.is_file(),
        "{} is missing: run `cargo test` without choosing a target, or `cargo build --examples`",
        path.display()
    );
    path
}
