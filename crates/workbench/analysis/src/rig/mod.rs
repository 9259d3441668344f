//! A platform: its limits, its workspace, and its picture.
//!
//! - [`survey`] gathers what there is to know of a rig.
//! - [`workspace`] measures where it can go.
//! - [`picture`] draws it.

pub mod picture;
mod section;
pub mod survey;
mod svg;
mod view;
pub mod workspace;
