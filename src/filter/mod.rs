//! Linear filters: the chain in controllable canonical form, and bumpless transfer between coefficients.

pub(crate) mod bumpless;
pub mod chain;
