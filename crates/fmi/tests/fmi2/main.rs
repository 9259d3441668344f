//! The C functions, tested as a host sees them: the shared library of a small model whose behaviour
//! is known in closed form is loaded and called.

mod calling_sequence;
mod creation;
mod derivatives;
mod fixture;
mod hostile_pointers;
mod initialization;
mod library;
#[path = "../../examples/first_order/model.rs"]
mod model;
mod panics;
mod standard;
mod states;
mod status;
mod steps;
mod threads;
mod variables;
