//! A search for anything that makes the washout break a limit.
//!
//! The search draws random [machines](machine) and [episodes](scenario), and runs the episodes on
//! a [target]. A target is the washout, called through the crate or through the C functions of
//! its shared library. The [oracle] judges a target by its outputs alone. An episode that breaks
//! a limit is [shrunk](shrink) to a short one. The short episode is saved to a file, and
//! `--replay` repeats it.
//!
//! | module | content |
//! |---|---|
//! | [`episode`], [`signal`], [`preview`], [`attacker`] | a case of the search as data |
//! | [`machine`], [`scenario`] | random cases |
//! | [`target`] | what is driven |
//! | [`reach`] | how near a sample is to its limits |
//! | [`oracle`] | what is promised, and how it is judged |
//! | [`run`], [`shrink`], [`search`] | one episode, its shortest form, many episodes |

pub mod attacker;
pub mod episode;
pub mod machine;
pub mod oracle;
pub mod preview;
mod random;
pub mod reach;
pub mod run;
pub mod scenario;
pub mod search;
pub mod shrink;
pub mod signal;
pub mod target;
pub mod variables;
