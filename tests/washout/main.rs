//! The mathematics of the washout against closed forms, integrations, differences and identities.
//! All of these are computed here, with independent code.
//!
//! There is one binary for all topics: they share helpers, and are linked once.

mod attitudes;
mod automatic_scale;
mod braking_law;
#[path = "../cases/mod.rs"]
mod cases;
mod chain;
mod comfort;
mod common;
mod communication_steps;
mod compensation;
mod conditioning;
mod cranks;
mod default_set;
mod derivatives;
mod errata;
mod evaluator;
mod gravitational;
mod hanging;
mod hostile;
mod kinematics;
mod limits_in_flight;
mod model;
mod paper_runs;
mod preaction;
mod presets;
mod preview;
mod reconstruction;
mod refusals;
mod retuning;
mod rigs;
mod small_signals;
mod status;
mod steady_state;
mod strategies;
mod tilt_tracker;
