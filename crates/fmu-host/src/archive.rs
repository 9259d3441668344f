//! An FMU's files.

use std::path::{Path, PathBuf};

use crate::files::{ArchiveError, MAX_TEXT_SIZE, check_unpacked, open_archive};
use tempfile::TempDir;

use crate::HostError;

/// Unpacks an FMU into a new temporary directory.
pub(crate) fn unpack(path: &Path) -> Result<TempDir, HostError> {
    // Largest FMU, packed or unpacked [bytes].
    const MAX_ARCHIVE_SIZE: u64 = 1_000_000_000;
    let file_error = |source| HostError::File { path: path.into(), source };
    let archive_error = |source| match source {
        ArchiveError::Read(source) => file_error(source),
        source => HostError::Archive { path: path.into(), source },
    };
    let mut archive = open_archive(path, MAX_ARCHIVE_SIZE).map_err(archive_error)?;
    check_unpacked(&mut archive, MAX_ARCHIVE_SIZE).map_err(archive_error)?;
    let directory = TempDir::with_prefix("fmu-").map_err(file_error)?;
    archive.extract(&directory).map_err(|error| archive_error(error.into()))?;
    Ok(directory)
}

/// The text of a file.
pub(crate) fn read(path: &Path) -> Result<String, HostError> {
    crate::files::text(path, MAX_TEXT_SIZE).map_err(|source| HostError::File { path: path.into(), source })
}

/// Where the shared library for this platform lies in an unpacked FMU.
pub(crate) fn library_path(directory: &Path, model_identifier: &str) -> Result<PathBuf, HostError> {
    library_path_of(directory, &platform_directory(), model_identifier)
}

/// The same for a platform of this name.
pub(crate) fn library_path_of(directory: &Path, platform: &str, model_identifier: &str) -> Result<PathBuf, HostError> {
    let file = format!("{model_identifier}{}", std::env::consts::DLL_SUFFIX);
    let path = directory.join("binaries").join(platform).join(file);
    if path.is_file() { Ok(path) } else { Err(HostError::NoBinary(platform.to_owned())) }
}

/// The name of this platform's directory of binaries in FMI 3.0.
pub(crate) fn platform3() -> String {
    let system = if std::env::consts::OS == "macos" { "darwin" } else { std::env::consts::OS };
    format!("{}-{system}", std::env::consts::ARCH)
}

/// The name of this platform's directory of binaries.
fn platform_directory() -> String {
    let (system, bits) = match std::env::consts::OS {
        "windows" => ("win", usize::BITS),
        "macos" => ("darwin", usize::BITS),
        system => (system, usize::BITS),
    };
    match std::env::consts::ARCH {
        "x86" | "x86_64" => format!("{system}{bits}"),
        architecture => format!("{architecture}-{system}"),
    }
}
