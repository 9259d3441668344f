//! `moris rig`: looks at a platform, by [`moris_analysis::rig`].

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
pub use moris_analysis::rig::{picture, survey, workspace};
use moris_setup::load_rig;

use survey::Survey;

/// Check a rig
#[derive(Clone, Debug, clap::Subcommand)]
pub enum Command {
    /// Reach and singularities of a rig
    ///
    /// Prints reach, speed and acceleration along each axis alone, the size of the workspace, the
    /// closest approach of the legs, and the condition number over all leg lengths. Draws the rig.
    /// The exit status is 1 for a rig that is singular or whose legs collide.
    Check(CheckOptions),
}

/// The rig to check.
#[derive(Clone, Debug, clap::Args)]
pub struct CheckOptions {
    /// Rig file; examples/rigs has examples, of which default.toml explains each value
    rig: PathBuf,

    /// Directory for the picture
    #[arg(long, value_name = "DIRECTORY", default_value = crate::REPORT_DIRECTORY)]
    report: PathBuf,

    /// Number of points for the workspace's volume
    #[arg(long, value_name = "COUNT", default_value_t = 5_000_000, value_parser = clap::value_parser!(u32).range(1000..=1_000_000_000))]
    samples: u32,
}

/// Runs the command.
///
/// # Errors
/// The rig file cannot be used, or the picture cannot be written.
pub fn main(command: &Command, out: &mut dyn Write) -> Result<ExitCode> {
    let Command::Check(options) = command;
    check_rig(options, out)
}

/// Surveys a rig, prints the result and draws it.
fn check_rig(options: &CheckOptions, out: &mut dyn Write) -> Result<ExitCode> {
    let file = load_rig(&options.rig)?;
    let survey = Survey::of(&file, options.samples).with_context(|| options.rig.display().to_string())?;
    write!(out, "{survey}")?;

    fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
    let stem = options.rig.file_stem().map_or_else(|| "rig".into(), |stem| stem.to_string_lossy());
    let picture = options.report.join(format!("{stem}.svg"));
    fs::write(&picture, picture::svg(&survey)).with_context(|| format!("cannot write {}", picture.display()))?;
    writeln!(out, "\nwrote {}", picture.display())?;
    Ok(if survey.capabilities.is_sound() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
