//! The tools that compiling for another platform needs: a check that they are
//! there, and how to get them.

use std::fs;
#[cfg(unix)]
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::{Error, Platform, workspace, write_whole};

/// cargo-zigbuild and zig, which link against the glibc of our choice and for other machines.
///
/// # Errors
/// The first that is missing.
pub fn zigbuild(platform: Platform) -> Result<(), Error> {
    if !program_runs("cargo-zigbuild", &["--version"]) {
        let install = "cargo install --locked cargo-zigbuild".to_owned();
        return Err(Error::Missing { platform, what: "cargo-zigbuild", install });
    }
    if !has_zig() {
        return Err(zig_is_missing(platform));
    }
    Ok(())
}

/// The directory of zig's libraries for the systems for which it compiles.
///
/// # Errors
/// zig is missing.
pub fn zig_library(platform: Platform) -> Result<PathBuf, Error> {
    zig_environment().and_then(|environment| library_directory(&environment)).ok_or_else(|| zig_is_missing(platform))
}

fn zig_is_missing(platform: Platform) -> Error {
    let install = "pip install ziglang (or from https://ziglang.org/download, with zig in the PATH)";
    Error::Missing { platform, what: "zig", install: install.to_owned() }
}

/// Output of `zig env`, in zig's own notation, or in JSON from older versions.
fn zig_environment() -> Option<String> {
    let programs = [("zig", &["env"][..]), ("python3", &["-m", "ziglang", "env"])];
    let output_of =
        |(program, arguments)| Command::new(program).args::<&[&str], _>(arguments).stderr(Stdio::null()).output();
    let done = programs.into_iter().filter_map(|program| output_of(program).ok()).find(|done| done.status.success())?;
    String::from_utf8(done.stdout).ok()
}

/// The value of `lib_dir`, which stands between the next quotation marks.
fn library_directory(environment: &str) -> Option<PathBuf> {
    let (_, rest) = environment.split_once("lib_dir")?;
    let (_, value) = rest.split_once(['=', ':'])?;
    value.split('"').nth(1).map(PathBuf::from)
}

/// The linker for Windows.
///
/// # Errors
/// The linker is missing.
pub fn mingw(platform: Platform) -> Result<(), Error> {
    if program_runs("x86_64-w64-mingw32-gcc", &["--version"]) {
        return Ok(());
    }
    let install = "apt-get install gcc-mingw-w64-x86-64 (Debian, Ubuntu), brew install mingw-w64 (macOS)".to_owned();
    Err(Error::Missing { platform, what: "x86_64-w64-mingw32-gcc", install })
}

/// A script in the target directory that calls GCC for Windows, so that its result does not depend
/// on the place of this directory.
///
/// # Errors
/// The script cannot be written.
pub fn mingw_linker() -> Result<PathBuf, Error> {
    let file = workspace::target_directory().join("mingw_linker.sh");
    let write = || {
        write_whole(&file, include_bytes!("mingw_linker.sh"))?;
        #[cfg(unix)]
        fs::set_permissions(&file, PermissionsExt::from_mode(0o755))
            .map_err(|reason| Error::Write { file: file.clone(), reason })?;
        Ok(file.clone())
    };
    // Another build may be running it.
    if fs::read(&file).is_ok_and(|script| script == include_bytes!("mingw_linker.sh")) { Ok(file) } else { write() }
}

/// Rust's standard library for the platform.
///
/// # Errors
/// The library is missing.
pub fn standard_library(platform: Platform) -> Result<(), Error> {
    if has_standard_library(platform.target())? {
        return Ok(());
    }
    let install = format!("rustup target add {}", platform.target());
    Err(Error::Missing { platform, what: "Rust's standard library for it", install })
}

fn has_standard_library(target: &str) -> Result<bool, Error> {
    let directory: PathBuf = workspace::sysroot()?.join("lib/rustlib").join(target).join("lib");
    Ok(directory.is_dir())
}

/// Rust's standard library for WebAssembly, and wasm2c of this version. Those of other versions
/// make code for another runtime.
///
/// # Errors
/// The first that is missing.
pub fn wasm2c(target: &str, version: &str) -> Result<(), Error> {
    if !has_standard_library(target)? {
        let install = format!("rustup target add {target}");
        return Err(Error::MissingForSources { what: "Rust's standard library for WebAssembly".to_owned(), install });
    }
    let asked = Command::new("wasm2c").arg("--version").stderr(Stdio::null()).output();
    if asked.is_ok_and(|answer| String::from_utf8_lossy(&answer.stdout).trim() == version) {
        return Ok(());
    }
    let install = "apt-get install wabt (Debian 12), or from https://github.com/WebAssembly/wabt/releases".to_owned();
    Err(Error::MissingForSources { what: format!("wasm2c {version} of WABT"), install })
}

/// Where cargo-zigbuild looks for zig.
fn has_zig() -> bool {
    std::env::var_os("CARGO_ZIGBUILD_ZIG_PATH").is_some()
        || program_runs("zig", &["version"])
        || program_runs("python3", &["-m", "ziglang", "version"])
}

fn program_runs(program: &str, arguments: &[&str]) -> bool {
    let status = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zig_tells_its_directory_in_both_forms() {
        let expected = Some(PathBuf::from("/opt/zig/lib"));
        assert_eq!(library_directory(".{\n    .zig_exe = \"/zig\",\n    .lib_dir = \"/opt/zig/lib\",\n}"), expected);
        assert_eq!(library_directory("{\n \"zig_exe\": \"/zig\",\n \"lib_dir\": \"/opt/zig/lib\"\n}"), expected);
        assert_eq!(library_directory("unknown command"), None);
    }
}
