//! The workbench's commands and library: one binary for all topics, which is linked once.

mod advice;
mod bench;
mod bounds;
#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod commands;
mod fit;
mod forms;
mod frequency_response;
mod import;
mod judged;
mod laps;
mod loggers;
mod measure;
mod mounting;
mod outliers;
mod recordings;
mod rules;
mod tune;
mod ways_in;
