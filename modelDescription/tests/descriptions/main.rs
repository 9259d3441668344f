//! Descriptions of models: one binary for all topics, which is linked once.

mod document;
mod fmi2_rules;
mod fmi3_rules;
mod small_model;
mod start_dependencies;
mod tables;
