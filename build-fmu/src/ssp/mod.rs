//! System structure packages (SSP 1.0): several FMUs, how they are connected, and the parameters they start with.
//!
//! `cargo build-ssp` is the command; [`build`] is the same for a program. Which systems there are is in [`system`], what
//! is written of one in [`describe`](mod@describe) and [`parameter_set`], in the terms of [`schema`].

pub mod describe;
pub mod parameter_set;
pub mod schema;
pub mod system;

use std::path::Path;

pub use system::{MOTORCYCLE_SIMULATOR, System};

use crate::archive::{self, Contents};
use crate::contents::LICENCES;
use crate::{Built, Error, FmiVersion, Platform, fmu, write_whole};

/// Where a package has its FMUs and parameters.
const RESOURCES: &str = "resources";

/// Builds a system's package into the directory `output`, which is made where it does not exist, and says through
/// `report` what it does, a line at a time.
///
/// Without platforms the FMUs are for this machine. They are of FMI 2.0, which is what SSP 1.0 knows.
///
/// # Errors
/// An FMU cannot be built, the system's parameters name what there is not, or the package cannot be written.
pub fn build(
    system: &System,
    platforms: &[Platform],
    output: &Path,
    mut report: impl FnMut(&str),
) -> Result<Built, Error> {
    let mut contents = description(system)?;
    for component in system.components {
        let model = component.model;
        contents.insert(fmu_path(component), fmu(model, FmiVersion::Fmi2, platforms, &mut report)?);
    }
    let package = archive::pack(&contents)?;
    let file = output.join(format!("{}.ssp", system.name));
    write_whole(&file, &package)?;
    Ok(Built { file, size: package.len() })
}

/// The files of a package without its FMUs.
///
/// # Errors
/// The system's parameters name what there is not.
pub fn description(system: &System) -> Result<Contents, Error> {
    let parameters = parameter_set::parameter_set(system)?;
    Ok(Contents::from([
        ("SystemStructure.ssd".to_owned(), describe::to_xml(&describe::describe(system))),
        (parameters_path(system), describe::to_xml(&parameters)),
        ("documentation/licenses/license.txt".to_owned(), LICENCES.as_bytes().to_vec()),
    ]))
}

fn fmu_path(component: &system::Component) -> String {
    format!("{RESOURCES}/{}", FmiVersion::Fmi2.fmu_file(component.model.name))
}

fn parameters_path(system: &System) -> String {
    format!("{RESOURCES}/{}.ssv", system.name)
}
