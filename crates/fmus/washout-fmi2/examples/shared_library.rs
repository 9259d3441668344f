//! The shared library as an example. For a package's tests, Cargo builds its examples
//! but not its `cdylib`.

#[path = "../src/lib.rs"]
mod library;
