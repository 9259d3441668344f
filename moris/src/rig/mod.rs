//! `moris rig`: looks at a platform.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;

/// Look at a rig
#[derive(Clone, Debug, clap::Subcommand)]
pub enum Command {
    /// What a rig reaches, and whether it is free of singularities
    Check(CheckOptions),
}

/// Which rig to check.
#[derive(Clone, Debug, clap::Args)]
pub struct CheckOptions {
    /// Rig file
    rig: PathBuf,
}

/// Does what the command says.
///
/// # Errors
/// The rig file cannot be used.
pub fn main(command: &Command, out: &mut dyn Write) -> Result<ExitCode> {
    let Command::Check(options) = command;
    let rig = washout_setup::load_rig(&options.rig)?;
    rig.refusal()?;
    writeln!(out, "{}: free of singularities", rig.name)?;
    Ok(ExitCode::SUCCESS)
}
