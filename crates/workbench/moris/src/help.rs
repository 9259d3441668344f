//! `moris completions` and `moris man`: the commands for a shell and for man.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Command;
use clap_complete::Shell;

/// Print completions for a shell
///
/// For bash: moris completions bash > ~/.local/share/bash-completion/completions/moris
#[derive(Clone, Debug, clap::Args)]
pub struct CompletionOptions {
    /// The shell
    shell: Shell,
}

/// Write man pages of all commands
#[derive(Clone, Debug, clap::Args)]
pub struct ManOptions {
    /// Directory for the pages, such as ~/.local/share/man/man1
    directory: PathBuf,
}

/// Prints the completions of a command line.
///
/// # Errors
/// The completions cannot be written.
pub fn completions(options: &CompletionOptions, mut command: Command, out: &mut dyn Write) -> Result<ExitCode> {
    // The generator panics where it cannot write; a string always can.
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut command, "moris", &mut text);
    out.write_all(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes a man page of the command line and of each of its commands.
///
/// # Errors
/// A page cannot be written.
pub fn man_pages(options: &ManOptions, command: Command, out: &mut dyn Write) -> Result<ExitCode> {
    let directory = &options.directory;
    fs::create_dir_all(directory).with_context(|| format!("cannot make {}", directory.display()))?;
    clap_mangen::generate_to(command, directory)
        .with_context(|| format!("cannot write into {}", directory.display()))?;
    writeln!(out, "wrote the pages to {}", directory.display())?;
    Ok(ExitCode::SUCCESS)
}
