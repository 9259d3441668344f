//! `moris parameters`: the parameters as a file to start from.

use std::io::Write;
use std::process::ExitCode;

use anyhow::Result;
use moris_interface::Group;
use moris_setup::{all, changed, parameter_file};
use moris_washout::Parameters;

use crate::setup_options::SetupOptions;

/// Print parameters as a parameter file, each with unit and description
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    setup: SetupOptions,

    /// Only those that are not the default's
    #[arg(long)]
    changed: bool,
}

/// Prints the file.
///
/// # Errors
/// The rig or the parameters cannot be used.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let setup = options.setup.load_with_notes()?;
    let values = if options.changed { changed(&setup.parameters) } else { all(&setup.parameters) };
    let heading = format!("Parameters: {}\nRig: {}", setup.parameters_name, setup.rig_name);
    write!(out, "{}", parameter_file::write(&heading, &values, Parameters::ROWS))?;
    Ok(ExitCode::SUCCESS)
}
