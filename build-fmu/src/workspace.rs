//! Directories and tools of the machine that builds.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::{env, fs};

use crate::Error;

/// The root of the workspace: that of the package which cargo runs or tests, or around
/// the working directory or the program; else the working directory.
///
/// The present directory, not that of the compilation: cargo takes the program for fresh in a
/// copy of the sources, too. A released program shows no directory of the machine that made it.
pub fn root() -> &'static Path {
    // A file that only the sources of this project have, seen from their root.
    const MARKER_FILE: &str = "build-fmu/Cargo.toml";
    static ROOT: OnceLock<PathBuf> = OnceLock::new();
    ROOT.get_or_init(|| {
        let package = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
        let starts = [package, env::current_dir().ok(), env::current_exe().ok()];
        let around = |start: &PathBuf| {
            let manifest =
                start.ancestors().map(|directory| directory.join(MARKER_FILE)).find(|file| file.is_file())?;
            // A directory may be a link into the sources.
            fs::canonicalize(manifest).ok()?.ancestors().nth(2).map(Path::to_owned)
        };
        starts.iter().flatten().find_map(around).unwrap_or_else(|| PathBuf::from("."))
    })
}

/// Directory of FMUs by default: the environment's `MORIS_FMUS`, or `fmu` in the directory in which
/// cargo compiles.
pub fn default_output() -> PathBuf {
    env::var_os("MORIS_FMUS").map_or_else(|| target_directory().join("fmu"), PathBuf::from)
}

/// Directory in which cargo compiles: the environment's `CARGO_TARGET_DIR`, or `target` in the
/// workspace.
pub fn target_directory() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |directory| root().join(directory))
}

/// Directories of this machine that must not show in a library, and the names that
/// replace them. The directories are the workspace's, those of cargo's sources of the dependencies,
/// and rustc's own sources.
///
/// # Errors
/// rustc cannot be asked.
pub fn private_paths() -> Result<Vec<(PathBuf, &'static str)>, Error> {
    let mut paths = vec![(root().to_owned(), "workspace"), (sysroot()?.join("lib/rustlib/src/rust"), "rust")];
    let home = env::home_dir().map(|home| home.join(".cargo"));
    paths.extend(env::var_os("CARGO_HOME").map(PathBuf::from).or(home).map(|cargo| (cargo, "cargo")));
    Ok(paths)
}

/// Directory of the compiler and of its targets' standard libraries.
///
/// # Errors
/// rustc cannot be asked.
pub fn sysroot() -> Result<PathBuf, Error> {
    let asked = Command::new(rustc_path()).args(["--print", "sysroot"]).output();
    let answer = asked.map_err(|reason| Error::Run { program: "rustc".to_owned(), reason })?;
    Ok(PathBuf::from(String::from_utf8_lossy(&answer.stdout).trim()))
}

/// The rustc that cargo uses.
fn rustc_path() -> std::ffi::OsString {
    env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())
}
