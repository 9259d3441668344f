//! Builds a model's shared library for each platform and packs it into an FMU.
//!
//! `cargo build-fmu` is the command; [`build`] is the same for a program.
//!
//! | module | contents |
//! |---|---|
//! | [`contents`] | the files of an FMU |
//! | [`Base`] | an FMU whose libraries are packed again with other start values |
//! | [`model`] | the models |
//! | [`platform`] | the platforms |
//! | [`fmi_version`] | the versions of FMI |
//! | [`ssp`] | packages of connected FMUs: `cargo build-ssp` |
//! | [`tables`] | tables of the pages in `docs/` that follow from the models |

pub mod archive;
mod base;
mod code_signature;
pub mod compile;
pub mod contents;
pub mod documentation;
mod error;
pub mod fmi_version;
mod fmu;
mod form_options;
pub mod library;
mod macos_stub;
pub mod model;
mod own_fmu;
pub mod platform;
pub mod reference;
mod sources;
pub mod ssp;
mod start_options;
mod start_values;
pub mod tables;
pub mod terminals;
mod tools;
pub mod workspace;

pub use base::Base;
pub use error::Error;
pub use fmi_version::FmiVersion;
pub use fmu::{Built, build, compile_together, fmu, write_whole};
pub use form_options::FormOptions;
pub use model::{FMU_MODELS, FmuModel};
pub use own_fmu::OwnFmu;
pub use platform::Platform;
pub use sources::Sources;
pub use start_options::StartOptions;
pub use start_values::Start;
