//! The shared library once more: Cargo builds a package's examples for its tests,
//! but not its `cdylib`.

#[path = "../src/lib.rs"]
mod library;
