//! Better parameters for a set of recordings.
//!
//! - [`space`] defines the search variables, [`cost`] the objective.
//! - [`search`](mod@search) minimises the objective in long internal steps.
//! - [`tuner`] simulates the result with the internal steps that it will be used with.
//! - [`tested`] tests the result on recordings that it was not tuned on.
//! - [`summary`] summarises the result, and [`error`] has the reasons why there is none.

pub mod cost;
pub mod error;
pub mod folds;
pub mod search;
pub mod space;
pub mod summary;
pub mod tested;
pub mod tuner;
