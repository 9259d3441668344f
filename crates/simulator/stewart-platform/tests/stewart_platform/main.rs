//! The platform: one binary for all topics, which is linked once.

mod allocation;
mod hostile;
mod lean;
mod refusals;
mod retuning;
