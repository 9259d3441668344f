//! The builder of FMUs: one binary for all topics, which is linked once.

mod contents;
mod embedded_values;
mod library;
mod start_values;
mod tables;
