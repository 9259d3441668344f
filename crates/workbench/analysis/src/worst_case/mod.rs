//! What the rider feels where the platform is not the nominal one.
//!
//! - [`points`] are the machines that are tried.
//! - [`commands`] are the washout's, for a ride.
//! - [`machine`] moves a platform by them.
//! - [`figures`] compares what is felt with what is desired.
//! - [`study`] does so for a strategy on all rides and machines.

pub mod commands;
pub mod figures;
pub mod machine;
pub mod points;
pub mod study;
