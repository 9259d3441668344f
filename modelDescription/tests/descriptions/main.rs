//! Descriptions of models: one binary for all topics, which is linked once.

#[path = "../../../tests/cases/mod.rs"]
mod cases;
mod document;
mod fmi2_rules;
mod fmi3_rules;
mod small_model;
mod start_dependencies;
mod tables;
