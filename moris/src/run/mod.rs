//! `moris run`: rides a recording on a rig.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;

use crate::ride::{ConventionOptions, Ride};
use crate::setup_options::SetupOptions;

/// Ride a recording on a rig and report how well it is felt
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Recordings (CSV)
    #[arg(required = true)]
    rides: Vec<PathBuf>,

    #[command(flatten)]
    setup: SetupOptions,

    /// Directory for the report and the tables of outputs
    #[arg(long, value_name = "DIRECTORY", default_value = "report")]
    report: PathBuf,

    #[command(flatten)]
    conventions: ConventionOptions,
}

/// Does what the command says.
///
/// # Errors
/// A ride, a rig or parameters that cannot be used, or a file that cannot be written.
pub fn main(options: &Options) -> Result<ExitCode> {
    let setup = options.setup.load()?;
    let conventions = options.conventions.load()?;
    for file in &options.rides {
        let ride = Ride::read(file, &conventions)?;
        println!("{}: {} s on {}", ride.name, ride.manoeuvre.duration(), setup.rig_name);
        ride.remarks.iter().for_each(|remark| println!("  {remark}"));
    }
    Ok(ExitCode::SUCCESS)
}
