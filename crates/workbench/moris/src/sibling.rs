//! Commands that are programs of their own, installed beside this one.

use std::env;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};

/// Runs a program of this program's directory in its place, with these arguments.
///
/// # Errors
/// The program is not there, or cannot be started.
pub fn run(name: &str, arguments: &[OsString]) -> Result<ExitCode> {
    let file = format!("{name}{}", env::consts::EXE_SUFFIX);
    let beside = env::current_exe().map_or_else(|_| PathBuf::from(&file), |program| program.with_file_name(&file));
    let mut command = Command::new(&beside);
    command.args(arguments);
    let failed = || format!("cannot start {}; in the repository, cargo live compiles and runs it", beside.display());
    // The same process, so that signals reach the program that answers them.
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        Err(command.exec()).with_context(failed)
    }
    #[cfg(not(unix))]
    {
        let status = command.status().with_context(failed)?;
        Ok(status.code().map_or(ExitCode::FAILURE, |code| ExitCode::from(code as u8)))
    }
}
