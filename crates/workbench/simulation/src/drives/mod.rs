//! Drives that the project computes itself.
//!
//! - [`runs`] has the paper's runs and a drive through town, in closed form.
//! - [`car`] is a single-track car, with a driver's steering and pedals in closed form.

pub mod car;
pub mod runs;
pub mod smooth;
