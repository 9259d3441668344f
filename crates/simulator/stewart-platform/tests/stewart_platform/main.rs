//! The platform: one binary for all topics, which is linked once.

mod allocation;
#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod hostile;
mod lean;
mod refusals;
mod retuning;
