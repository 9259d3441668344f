//! The tools that compiling for another platform needs: whether they are there, and how to get them.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::{Error, Platform, workspace};

/// cargo-zigbuild and zig, which link against the glibc of our choice and for other machines.
///
/// # Errors
/// The first that is missing.
pub fn zigbuild(platform: Platform) -> Result<(), Error> {
    if !runs("cargo-zigbuild", &["--version"]) {
        let install = "cargo install --locked cargo-zigbuild".to_owned();
        return Err(Error::Missing { platform, what: "cargo-zigbuild", install });
    }
    if !has_zig() {
        let install = "pip install ziglang (or from https://ziglang.org/download, with zig in the PATH)".to_owned();
        return Err(Error::Missing { platform, what: "zig", install });
    }
    Ok(())
}

/// The linker for Windows.
///
/// # Errors
/// It is missing.
pub fn mingw(platform: Platform) -> Result<(), Error> {
    if runs("x86_64-w64-mingw32-gcc", &["--version"]) {
        return Ok(());
    }
    let install = "apt-get install gcc-mingw-w64-x86-64 (Debian, Ubuntu), brew install mingw-w64 (macOS)".to_owned();
    Err(Error::Missing { platform, what: "x86_64-w64-mingw32-gcc", install })
}

/// Rust's standard library for the platform.
///
/// # Errors
/// It is missing.
pub fn standard_library(platform: Platform) -> Result<(), Error> {
    let directory: PathBuf = workspace::sysroot()?.join("lib/rustlib").join(platform.target()).join("lib");
    if directory.is_dir() {
        return Ok(());
    }
    let install = format!("rustup target add {}", platform.target());
    Err(Error::Missing { platform, what: "Rust's standard library for it", install })
}

/// Where cargo-zigbuild looks for zig.
fn has_zig() -> bool {
    std::env::var_os("CARGO_ZIGBUILD_ZIG_PATH").is_some()
        || runs("zig", &["version"])
        || runs("python3", &["-m", "ziglang", "version"])
}

fn runs(program: &str, arguments: &[&str]) -> bool {
    let status = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}
