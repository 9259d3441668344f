//! The interface of a model as FMI describes it: `modelDescription.xml`, and the
//! documentation's table of variables.
//!
//! [`fmi2`] and [`fmi3`] each have the schema of that version, as far as these co-simulation FMUs
//! use it, one module a part of the file; `describe` fills it in from a model's table of variables.
//! [`to_xml`] writes either. [`common`] holds the parts that are the same in both.
//!
//! The directories named as a model beside this crate's sources have its `modelDescription.xml` and
//! `modelDescription.fmi3.xml`, generated and checked in, so that every change of an interface
//! shows in a diff. `cargo describe-models` writes them anew.

pub mod common;
pub mod fmi2;
pub mod fmi3;

pub use common::xml::to_xml;
