//! Linear filters: the chain in controllable canonical form, a second-order low-pass, and bumpless
//! transfer between coefficients.

pub(crate) mod bumpless;
pub mod chain;
pub mod critically_damped;
pub(crate) mod crossfade;
