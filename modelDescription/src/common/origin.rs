//! Origin of an FMU, the same in every description.

/// Maker of the file.
pub const AUTHOR: &str = "MORIS washout contributors";
pub const COPYRIGHT: &str = "Copyright (c) MORIS washout contributors";
pub const LICENSE: &str = "MIT OR Apache-2.0";
/// The tool, and its version.
pub const GENERATION_TOOL: &str = concat!("MORIS washout model-description ", env!("CARGO_PKG_VERSION"));

/// The date of the interface, not of the build: the same sources give the same file.
pub const GENERATION_DATE_AND_TIME: &str = "2026-01-01T00:00:00Z";

/// Form of the variables' names: with dots and indices.
pub(crate) const VARIABLE_NAMING_CONVENTION: &str = "structured";
