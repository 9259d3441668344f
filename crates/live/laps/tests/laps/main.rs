//! Previews by earlier passes, through the washout and alone.

#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod felt;
mod memory;
mod motorcycle;
mod track;
mod trust;
mod wrong;
