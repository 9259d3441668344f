//! Packages of connected FMUs: one binary for both topics, which is linked once.

mod description;
mod lap;
mod vehicle;
