//! Exit statuses beyond success and failure, the same in every command. 2 is
//! clap's, for unknown options.

/// A recording does not fit the rig.
pub const DOES_NOT_FIT: u8 = 3;
/// A result is worse than it should be: tuned parameters than those before, a measure than its
/// target, or a response than its bounds.
pub const WORSE_RESULT: u8 = 4;
