//! The interface of a model as FMI describes it: `modelDescription.xml`, and the
//! documentation's tables of variables.
//!
//! | item | contents |
//! |---|---|
//! | `describe` in [`fmi2`], [`fmi3`] | makes the root [`Element`] of that version's file from a model's table of variables |
//! | [`to_xml`] | writes either |
//! | [`common`] | the parts that are the same in both |
//!
//! The descriptions have the parts of the standards' schemas that these co-simulation FMUs use.
//!
//! Beside this crate's sources, each model has a directory of its name. The directory holds
//! `modelDescription.xml` and `modelDescription.fmi3.xml`, written by `cargo describe-models`. Both
//! are checked in, so that every change of an interface shows in a diff.

pub mod common;
pub mod fmi2;
pub mod fmi3;

pub use common::xml::{Element, to_xml};
