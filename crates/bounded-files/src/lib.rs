//! Files and archives that others made, read up to a bound.
//!
//! A device without an end, a sparse file and a small archive that unpacks to many gigabytes are
//! refused with the reason, before they fill the memory or the disk.

#![forbid(unsafe_code)]

mod archive;
mod read;
mod size;

pub use archive::{ArchiveError, check_unpacked, open_archive, unpack};
pub use read::{TEXT, bytes, text};
