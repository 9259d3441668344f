//! The C functions of FMI 3.0, tested as a host sees them: the shared library of a small model with
//! vectors, whose behaviour is known in closed form, is loaded and called.
//!
//! What all versions of FMI share is tested through the functions of FMI 2.0, in `tests/fmi2`.

mod calling_sequence;
mod creation;
mod fixture;
mod hostile_pointers;
mod initialization;
mod library;
#[path = "../../examples/lags/model.rs"]
mod model;
mod random_calls;
mod scalars;
mod standard;
mod states;
mod steps;
mod variables;
