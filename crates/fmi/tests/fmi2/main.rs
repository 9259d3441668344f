//! Tests of the C functions of FMI 2.0 from a host's side. The tests load the shared library of a
//! small model with a closed-form solution.

mod calling_sequence;
mod creation;
mod derivatives;
mod fixture;
mod hostile_pointers;
mod initialization;
mod library;
#[path = "../models/first_order/model.rs"]
mod model;
mod panics;
mod standard;
mod states;
mod status;
mod steps;
mod threads;
mod variables;
