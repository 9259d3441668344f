//! Checks of a recording: outliers, wrong units and axes, and contradictions.

pub mod consistency;
pub mod outliers;
pub mod plausibility;
