//! Zip archives, as FMUs are.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Cursor, Read, Seek, sink};
use std::path::Path;

use zip::ZipArchive;
use zip::result::ZipError;

use super::read::refused;
use super::size::shown;

/// Most files of an archive.
const MOST_FILES: usize = 20_000;

/// Errors of unpacking an archive.
#[derive(Debug, thiserror::Error)]
pub enum ArchiveError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] io::Error),
    /// The file is no archive, or a damaged one.
    #[error(transparent)]
    Zip(#[from] ZipError),
    /// Small files can unpack to more than a disk holds.
    #[error("it has {}, which unpack to {} or more, but at most {} are unpacked", shown(*.packed), shown(*.unpacked), shown(*.largest))]
    TooLarge { packed: u64, unpacked: u64, largest: u64 },
    /// Each file costs time, however small it is.
    #[error("it has {0} files, but at most {MOST_FILES} are unpacked")]
    TooMany(usize),
}

/// Opens the archive in a file of at most `largest` bytes.
///
/// # Errors
/// The file cannot be read, is larger, or is no archive.
pub fn open_archive(file: &Path, largest: u64) -> Result<ZipArchive<File>, ArchiveError> {
    let file = File::open(file)?;
    if file.metadata()?.len() > largest {
        return Err(refused(&format!("it is larger than {}", shown(largest))).into());
    }
    Ok(ZipArchive::new(file)?)
}

/// Checks that an archive has no more files than are unpacked, and at most `largest` bytes. The
/// sizes that it declares are checked first, then the true ones, which can differ.
///
/// # Errors
/// The archive unpacks to more, or is damaged.
pub fn check_unpacked<R: Read + Seek>(archive: &mut ZipArchive<R>, largest: u64) -> Result<(), ArchiveError> {
    if archive.len() > MOST_FILES {
        return Err(ArchiveError::TooMany(archive.len()));
    }
    let (mut packed, mut declared) = (0_u64, 0_u64);
    for index in 0..archive.len() {
        let file = archive.by_index_raw(index)?;
        packed = packed.saturating_add(file.compressed_size());
        declared = declared.saturating_add(file.size());
    }
    if declared > largest {
        return Err(ArchiveError::TooLarge { packed, unpacked: declared, largest });
    }
    let mut unpacked = 0;
    for index in 0..archive.len() {
        unpacked += io::copy(&mut archive.by_index(index)?.take(largest - unpacked + 1), &mut sink())?;
        if unpacked > largest {
            return Err(ArchiveError::TooLarge { packed, unpacked, largest });
        }
    }
    Ok(())
}

/// The files of an archive by their names, at most `largest` bytes together.
///
/// # Errors
/// As [`check_unpacked`].
pub fn unpack(archive: &[u8], largest: u64) -> Result<BTreeMap<String, Vec<u8>>, ArchiveError> {
    let mut archive = ZipArchive::new(Cursor::new(archive))?;
    check_unpacked(&mut archive, largest)?;
    let mut files = BTreeMap::new();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        files.insert(file.name().to_owned(), bytes);
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Write;

    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::*;

    /// An archive of files of zeros of these sizes.
    fn zeros(sizes: &[usize]) -> Vec<u8> {
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        for (place, size) in sizes.iter().enumerate() {
            writer.start_file(format!("{place}.bin"), SimpleFileOptions::default()).unwrap();
            writer.write_all(&vec![0; *size]).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    #[test]
    fn files_together_are_within_the_bound() {
        let files = unpack(&zeros(&[600_000, 400_000]), 1_000_000).unwrap();
        assert_eq!(files.values().map(Vec::len).collect::<Vec<_>>(), [600_000, 400_000]);
        let refused = unpack(&zeros(&[600_000, 400_001]), 1_000_000).unwrap_err().to_string();
        assert!(refused.ends_with("which unpack to 1 MB or more, but at most 1 MB are unpacked"), "{refused}");
        assert!(refused.starts_with("it has 1"), "{refused}");
        assert!(unpack(b"no archive", 1_000_000).is_err());
    }

    #[test]
    fn an_archive_of_very_many_files_is_refused() {
        let most = vec![0; MOST_FILES];
        assert_eq!(unpack(&zeros(&most), 1_000).unwrap().len(), MOST_FILES);
        let refused = unpack(&zeros(&vec![0; MOST_FILES + 1]), 1_000).unwrap_err().to_string();
        assert_eq!(refused, "it has 20001 files, but at most 20000 are unpacked");
    }

    /// The size stands twice, before the file and in the list at the end.
    #[test]
    fn a_declared_size_is_not_believed() {
        let mut archive = zeros(&[3_000_000]);
        let declared = 3_000_000_u32.to_le_bytes();
        let mut places = 0;
        for at in 0..archive.len() - 4 {
            if archive[at..at + 4] == declared {
                archive[at..at + 4].copy_from_slice(&10_u32.to_le_bytes());
                places += 1;
            }
        }
        assert_eq!(places, 2);
        let refused = unpack(&archive, 1_000_000).unwrap_err();
        assert!(matches!(refused, ArchiveError::TooLarge { unpacked: 1_000_001, .. }), "{refused:?}");
    }

    #[test]
    fn a_file_beyond_the_bound_is_not_opened() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("a.zip");
        fs::write(&file, zeros(&[100])).unwrap();
        assert!(open_archive(&file, 1000).is_ok());
        File::options().write(true).open(&file).unwrap().set_len(1 << 40).unwrap();
        assert_eq!(open_archive(&file, 1000).unwrap_err().to_string(), "it is larger than 1 kB");
    }
}
