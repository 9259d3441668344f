//! Files and archives that others made, read up to a bound.
//!
//! Some files would fill the memory or the disk: devices without an end, sparse files, and small
//! archives that unpack to many gigabytes. Such files are refused with the reason.

mod archive;
mod read;
mod size;

pub use archive::{ArchiveError, check_unpacked, open_archive, unpack};
pub use read::{MAX_TEXT_SIZE, bytes, text};
