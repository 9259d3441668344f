//! Washouts compared on fixed drives and rigs.
//!
//! - [`drives`] has the drives.
//! - [`columns`] are the measures, in their order.
//! - [`run`] has the rigs, and computes the rows of a drive on a rig.

pub mod columns;
pub mod drives;
pub mod run;

/// Version of the bench: of its drives, rigs and columns. Rows of different
/// versions do not compare.
pub const BENCH_VERSION: u32 = 3;
