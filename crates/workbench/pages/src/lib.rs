//! Pages: HTML with their scripts and data, and what their WebAssembly is made of.
//!
//! - [`report`] is the page about a recording.
//! - `ride` is a ride in the browser: the page, and motorcycle and washout behind it.
//! - `live` is the page of a live session. Both take the feature `ride`.
//! - [`memory`] is shared by a page's script and its WebAssembly. The modules themselves stand in
//!   `modules/`, each an example of this package: a library of its own with functions for one page.

#![deny(unsafe_code)]

mod bundle;
#[cfg(feature = "ride")]
pub mod live;
#[allow(unsafe_code)]
pub mod memory;
pub mod report;
#[cfg(feature = "ride")]
pub mod ride;

/// Version, and the commit where it is known.
pub const PACKAGE_VERSION: &str = env!("MORIS_VERSION");
