//! Examination of a shared library before it is shipped: its exports, the libraries that it needs,
//! and paths of the build machine that it leaks.

use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;

use object::Object;
use object::elf::{DT_NEEDED, DT_RPATH, DT_RUNPATH};
use object::read::elf::{Dyn, ElfFile64};

/// Properties of the library that matter to its users.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LibraryInfo {
    /// The newest version of glibc of which it needs something; none where it is not for Linux.
    pub glibc: Option<Version>,
    /// The libraries that it needs.
    pub needs: BTreeSet<String>,
    /// Size \[bytes\].
    pub size: usize,
}

/// A version of glibc, such as 2.17: its numbers, the most important first.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version(pub Vec<u32>);

/// Why a library must not be shipped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LibraryError {
    /// Not a library for any platform that we know.
    #[error("it cannot be read as a library: {0}")]
    Unreadable(String),
    /// Functions of FMI that are not exported.
    #[error("it lacks {}", .0.join(", "))]
    Lacks(Vec<String>),
    /// Exported names that are not functions of FMI.
    #[error("it exports {}, which FMI does not define", .0.join(", "))]
    Exports(Vec<String>),
    /// A directory in which the system would search for libraries.
    #[error("it has a search path for libraries (RPATH)")]
    SearchPath,
    /// A directory of the machine that built it.
    #[error("it contains the path {} of this machine", .0.display())]
    PrivatePath(PathBuf),
}

/// Examines a library for Linux, Windows or macOS, which is to export these functions;
/// `private_paths` are directories that it must not mention.
///
/// # Errors
/// The first error found.
pub fn examine(
    library: &[u8],
    functions: &[&str],
    private_paths: &[(PathBuf, &str)],
) -> Result<LibraryInfo, LibraryError> {
    let file = object::File::parse(library)?;
    check_exports(&file, functions)?;
    check_paths(library, private_paths)?;
    let mut info = LibraryInfo { glibc: None, needs: BTreeSet::new(), size: library.len() };
    if let object::File::Elf64(elf) = &file {
        read_elf(elf, &mut info)?;
    } else {
        info.needs = file.imports()?.iter().map(|import| lossy_text(import.library())).collect();
    }
    Ok(info)
}

/// Exactly the functions of FMI, and every one of them.
fn check_exports(file: &object::File, functions: &[&str]) -> Result<(), LibraryError> {
    // On macOS every name of C has an underscore before it.
    let prefix = if matches!(file, object::File::MachO64(_)) { "_" } else { "" };
    let name = |bytes| {
        let name = lossy_text(bytes);
        name.strip_prefix(prefix).map(str::to_owned).unwrap_or(name)
    };
    let exported: BTreeSet<String> = file.exports()?.iter().map(|export| name(export.name())).collect();
    let expected: BTreeSet<String> = functions.iter().map(|&name| name.to_owned()).collect();
    let lacking: Vec<String> = expected.difference(&exported).cloned().collect();
    let unknown: Vec<String> = exported.difference(&expected).cloned().collect();
    match (lacking.is_empty(), unknown.is_empty()) {
        (true, true) => Ok(()),
        (false, _) => Err(LibraryError::Lacks(lacking)),
        (true, false) => Err(LibraryError::Exports(unknown)),
    }
}

/// Checks that a library mentions none of these directories.
///
/// # Errors
/// The first that it mentions.
pub fn check_paths(library: &[u8], private_paths: &[(PathBuf, &str)]) -> Result<(), LibraryError> {
    for (path, _) in private_paths {
        let needle = path.as_os_str().as_encoded_bytes();
        if library.windows(needle.len()).any(|window| window == needle) {
            return Err(LibraryError::PrivatePath(path.clone()));
        }
    }
    Ok(())
}

/// Properties of Linux libraries: versions of glibc's functions, and a search path, which must be
/// absent.
fn read_elf(elf: &ElfFile64, info: &mut LibraryInfo) -> Result<(), LibraryError> {
    let (endian, data, sections) = (elf.endian(), elf.data(), elf.elf_section_table());
    if let Some((entries, link)) = sections.dynamic(endian, data)? {
        let strings = sections.strings(endian, data, link)?;
        for entry in entries {
            match entry.tag32(endian) {
                Some(DT_RPATH | DT_RUNPATH) => return Err(LibraryError::SearchPath),
                Some(DT_NEEDED) => {
                    info.needs.insert(lossy_text(entry.string(endian, strings)?));
                }
                _ => {}
            }
        }
    }
    if let Some((mut files, link)) = sections.gnu_verneed(endian, data)? {
        let strings = sections.strings(endian, data, link)?;
        while let Some((_, mut versions)) = files.next()? {
            while let Some(version) = versions.next()? {
                info.glibc = info.glibc.take().max(Version::of_glibc(&lossy_text(version.name(endian, strings)?)));
            }
        }
    }
    Ok(())
}

fn lossy_text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

impl Version {
    /// Of a symbol's version such as `GLIBC_2.17`; none of another library's.
    fn of_glibc(name: &str) -> Option<Self> {
        let numbers = name.strip_prefix("GLIBC_")?.split('.').map(|number| number.parse().ok());
        numbers.collect::<Option<Vec<u32>>>().map(Version)
    }
}

impl From<object::Error> for LibraryError {
    fn from(error: object::Error) -> Self {
        LibraryError::Unreadable(error.to_string())
    }
}

impl fmt::Display for Version {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let numbers: Vec<String> = self.0.iter().map(u32::to_string).collect();
        formatter.write_str(&numbers.join("."))
    }
}

impl fmt::Display for LibraryInfo {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        if let Some(version) = &self.glibc {
            write!(formatter, "needs glibc {version} or newer, ")?;
        }
        let needs: Vec<&str> = self.needs.iter().map(String::as_str).collect();
        let needs = if needs.is_empty() { "no library".to_owned() } else { needs.join(", ") };
        write!(formatter, "{} kB, uses {needs}", self.size.div_ceil(1000))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_ordered_by_number() {
        let version = |name| Version::of_glibc(name);
        assert!(version("GLIBC_2.17") > version("GLIBC_2.2.5"));
        assert!(version("GLIBC_2.9") < version("GLIBC_2.17"));
        assert_eq!(version("GCC_3.0"), None);
        assert_eq!(version("GLIBC_PRIVATE"), None);
        assert_eq!(version("GLIBC_2.2.5").unwrap().to_string(), "2.2.5");
    }

    #[test]
    fn a_path_of_this_machine_is_found() {
        let paths = [(PathBuf::from("/home/someone"), "home")];
        assert_eq!(
            check_paths(b"..\0/home/someone/src/lib.rs\0..", &paths),
            Err(LibraryError::PrivatePath(paths[0].0.clone()))
        );
        assert_eq!(check_paths(b"..\0home/src/lib.rs\0..", &paths), Ok(()));
    }

    #[test]
    fn what_is_no_library_is_refused() {
        assert!(matches!(examine(b"#!/bin/sh", &[], &[]), Err(LibraryError::Unreadable(_))));
    }
}
