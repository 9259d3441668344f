//! A search for anything that makes the washout break a limit.
//!
//! The search draws [machines](machine), [episodes](scenario) on them and drives a [target]: the
//! washout through the crate or through the C functions of its shared library. The [oracle] judges
//! the outputs; it knows nothing of how they are made. An episode that breaks a limit is
//! [shrunk](shrink) to a short one, which a file holds and `--replay` repeats.
//!
//! | module | content |
//! |---|---|
//! | [`episode`], [`signal`] | a case of the search as data |
//! | [`machine`], [`scenario`] | random cases |
//! | [`target`] | what is driven |
//! | [`oracle`] | what is promised, and how it is judged |
//! | [`run`], [`shrink`], [`search`] | one episode, its shortest form, many episodes |

#![forbid(unsafe_code)]

pub mod episode;
pub mod machine;
pub mod oracle;
mod random;
pub mod run;
pub mod scenario;
pub mod search;
pub mod shrink;
pub mod signal;
pub mod target;
pub mod variables;
