//! The archive: the same contents give the same bytes.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::Error;

/// Contents of an archive: the path of each file, with forward slashes and no leading one, and its
/// bytes.
pub type Contents = BTreeMap<String, Vec<u8>>;

/// Packs files in the order of their paths, all with the same date and permissions.
///
/// # Errors
/// The archive would be too large.
pub fn pack(contents: &Contents) -> Result<Vec<u8>, Error> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, bytes) in contents {
        // Loaders map libraries as programs.
        let permissions = if path.starts_with("binaries/") { 0o755 } else { 0o644 };
        writer.start_file(path.as_str(), options.unix_permissions(permissions))?;
        writer.write_all(bytes).map_err(zip::result::ZipError::Io)?;
    }
    Ok(writer.finish()?.into_inner())
}
