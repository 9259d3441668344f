//! The hunter: one binary for all topics, which is linked once.

mod attacks;
#[path = "../../../../tests/cases/mod.rs"]
mod cases;
mod command;
mod oracle;
mod search;
