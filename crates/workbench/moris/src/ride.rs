//! `moris ride`: writes the page in which the motorcycle is ridden.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use moris_pages::ride::page::{Page, RIDE_MODULE, html};

use crate::setup_options::SetupOptions;
use crate::simulate::simulator::parameters;

/// Write a page in which you ride the motorcycle, with the platform beside it
///
/// The page is one file and needs no network. Motorcycle, washout and platform run in it, 1000
/// steps a second. Ride with the arrow keys, a gamepad or by tilting a phone; each lap gets its
/// time and its measures. The page saves the ride as a recording for `moris simulate`.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    setup: SetupOptions,

    /// The page
    #[arg(long, value_name = "FILE", default_value = "ride.html")]
    output: PathBuf,
}

/// Writes the page.
///
/// # Errors
/// The module was not compiled, the rig or the parameters cannot be used, or the file cannot be
/// written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    if RIDE_MODULE.is_empty() {
        bail!("moris was built without the ride; build it again after `rustup target add wasm32-unknown-unknown`");
    }
    let setup = options.setup.load_to_drive()?;
    let page = html(&Page {
        subtitle: format!("{}, parameters: {}", setup.rig_name, setup.parameters_name),
        module: RIDE_MODULE.to_vec(),
        rig: (&setup.parameters).into(),
        parameters: parameters(&setup.parameters, &setup.rig_alone),
        half_width: moris_pages::ride::HALF_WIDTH,
    });
    let file = &options.output;
    fs::write(file, page).with_context(|| format!("cannot write {}", file.display()))?;
    writeln!(out, "open {} in a browser and ride", file.display())?;
    Ok(ExitCode::SUCCESS)
}
