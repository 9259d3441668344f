//! The hunter: one binary for all topics, which is linked once.

mod attacks;
mod command;
mod oracle;
mod search;
