//! The platform: one binary for all topics, which is linked once.

mod allocation;
#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod cranks;
mod hostile;
mod lean;
mod refusals;
mod retuning;
