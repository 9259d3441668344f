//! System structure packages (SSP 1.0): several FMUs, how they are connected, and the parameters
//! they start with.
//!
//! `cargo build-ssp` is the command; [`build`] is the same for a program. The systems are in
//! [`system`]. Their files are made by [`describe`](mod@describe) and [`parameter_set`].

pub mod describe;
pub mod parameter_set;
pub mod start_values;
pub mod system;

use std::path::Path;

use moris_build_fmu::archive::{self, Contents};
use moris_build_fmu::contents::LICENCES;
use moris_build_fmu::{Built, Error, FmiVersion, Platform, compile_together, fmu, write_whole};
use moris_model_description::to_xml;
pub use start_values::read as start_values;
use system::Place;
pub use system::{MOTORCYCLE_LAP, MOTORCYCLE_SIMULATOR, SYSTEMS, System};

/// Purpose of a package.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The system has connectors of its own and one parameter set: for FMPy and OMSimulator.
    Whole,
    /// The system has no connectors, and each component its own parameter set: for Ecos and
    /// libcosim.
    Flat,
}

/// Where a package has its FMUs and parameters.
const RESOURCES: &str = "resources";

/// Builds a system's package of this form into the directory `output`, which is created if it does
/// not exist. Progress goes to `report`, a line at a time.
///
/// Without platforms the FMUs are for this machine. They are of FMI 2.0, the version
/// that SSP 1.0 supports.
///
/// # Errors
/// An FMU cannot be built, the system's parameters name something that does not exist, or the
/// package cannot be written.
pub fn build(
    system: &System,
    form: Form,
    platforms: &[Platform],
    output: &Path,
    mut report: impl FnMut(&str),
) -> Result<Built, Error> {
    let mut contents = description(system, form)?;
    let starts = start_values::read(system)?;
    let own = system.components.iter().zip(&starts).filter(|(_, start)| start.is_own());
    let libraries: Vec<_> = own.map(|(component, _)| (component.model, FmiVersion::Fmi2)).collect();
    compile_together(&libraries, platforms)?;
    for (component, start) in system.components.iter().zip(&starts) {
        let bytes = fmu(component.model, start, FmiVersion::Fmi2, platforms, &mut report)?;
        contents.insert(fmu_path(component), bytes);
    }
    let package = archive::pack(&contents)?;
    let file = output.join(format!("{}{}.ssp", system.name, if form == Form::Flat { ".flat" } else { "" }));
    write_whole(&file, &package)?;
    Ok(Built { file, size: package.len() })
}

/// The files of a package without its FMUs.
///
/// # Errors
/// The system's parameters name something that does not exist.
pub fn description(system: &System, form: Form) -> Result<Contents, Error> {
    let parameters = match system.place {
        Place::Sets => parameter_set::read(system)?,
        Place::StartValues => Vec::new(),
    };
    let mut contents = Contents::from([
        ("SystemStructure.ssd".to_owned(), to_xml(&describe::describe(system, form, &parameters)).into_bytes()),
        ("documentation/licenses/license.txt".to_owned(), LICENCES.as_bytes().to_vec()),
    ]);
    match form {
        Form::Whole if parameters.is_empty() => {}
        Form::Whole => {
            let set = describe::parameter_set(system, parameter_set::of_all(&parameters));
            contents.insert(parameters_path(system.name), to_xml(&set).into_bytes());
        }
        Form::Flat => contents.extend(parameters.into_iter().map(|(component, parameters)| {
            (parameters_path(&component), to_xml(&describe::parameter_set(system, parameters)).into_bytes())
        })),
    }
    Ok(contents)
}

fn fmu_path(component: &system::Component) -> String {
    format!("{RESOURCES}/{}", FmiVersion::Fmi2.fmu_file(component.model.name))
}

/// Where the parameter set of a system or of a component is.
fn parameters_path(name: &str) -> String {
    format!("{RESOURCES}/{name}.ssv")
}
