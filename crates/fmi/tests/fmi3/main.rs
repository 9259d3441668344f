//! Tests of the C functions of FMI 3.0 from a host's side. The tests load the shared library of a
//! small model with vectors and a closed-form solution.
//!
//! The parts common to all versions are tested through the functions of FMI 2.0, in `tests/fmi2`.

mod calling_sequence;
mod creation;
mod fixture;
mod hostile_pointers;
mod initialization;
mod library;
#[path = "../models/lags/model.rs"]
mod model;
mod random_calls;
mod scalars;
mod standard;
mod states;
mod steps;
mod variables;
