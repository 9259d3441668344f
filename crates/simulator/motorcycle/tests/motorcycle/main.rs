//! The motorcycle against what others published, closed forms, differences and balances.

#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod common;
mod hostile;
mod interface;
mod lateral;
mod longitudinal;
mod parameters;
mod path;
mod pose;
mod retuning;
mod ride;
mod rider;
mod steps;
mod turns;
mod washout;
mod whipple;
