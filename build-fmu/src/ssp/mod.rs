//! System structure packages (SSP 1.0): the simulator's three FMUs, connected, and the parameters
//! they start with. The descriptions stand in `systems/`; a package is these and the FMUs.

mod vehicle;

use std::path::Path;

use moris_setup::{NamedValues, parameter_file};

use crate::archive::{self, Contents};
use crate::contents::LICENCE_TEXT;
use crate::model::{MOTORCYCLE, STEWART_PLATFORM, WASHOUT};
pub use vehicle::Vehicle;

use crate::{Built, Error, FmiVersion, FmuModel, Platform, Start, compile_together, fmu, write_whole};

/// Purpose of a package.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The system has connectors of its own and one parameter set: for FMPy and OMSimulator.
    Whole,
    /// The system has no connectors, and each component its own parameter set: for Ecos and
    /// libcosim.
    Flat,
}

/// A text of a package: its path there, and what it holds.
type Text = (&'static str, &'static str);

/// A motorcycle, the washout and the platform, connected.
pub struct System {
    /// The package's name.
    pub name: &'static str,
    /// Description and parameter set of a whole package.
    whole: &'static [Text],
    /// Description and parameter sets of a flat one.
    flat: &'static [Text],
    /// Parameter files with start values of the FMUs, by their model.
    start_values: &'static [(&'static str, &'static str)],
}

/// Path of the description in a package.
pub const DESCRIPTION_PATH: &str = "SystemStructure.ssd";

/// Components and their models, in the order in which data flow through them.
pub const COMPONENTS: [(&str, &FmuModel); 3] =
    [("motorcycle", &MOTORCYCLE), ("washout", &WASHOUT), ("platform", &STEWART_PLATFORM)];

macro_rules! file {
    ($name:literal) => {
        include_str!(concat!("../../systems/", $name))
    };
}

/// The whole simulator of the paper's Fig. 1.
pub const MOTORCYCLE_SIMULATOR: System = System {
    name: "MotorcycleSimulator",
    whole: &[
        (DESCRIPTION_PATH, file!("MotorcycleSimulator.ssd")),
        ("resources/MotorcycleSimulator.ssv", file!("MotorcycleSimulator.ssv")),
    ],
    flat: &[
        (DESCRIPTION_PATH, file!("MotorcycleSimulator.flat.ssd")),
        ("resources/washout.ssv", file!("MotorcycleSimulator.washout.ssv")),
    ],
    start_values: &[],
};

/// The simulator on a lap: the motorcycle follows the path by itself, and the washout has a
/// preview. Its parameters are start values, because not every tool takes items of enumerations
/// from a set.
pub const MOTORCYCLE_LAP: System = System {
    name: "MotorcycleLap",
    whole: &[(DESCRIPTION_PATH, file!("MotorcycleLap.ssd"))],
    flat: &[(DESCRIPTION_PATH, file!("MotorcycleLap.flat.ssd"))],
    start_values: &[
        ("motorcycle", file!("MotorcycleLap.motorcycle.toml")),
        ("washout", file!("MotorcycleLap.washout.toml")),
    ],
};

/// Every system; the first is built by default.
pub const SYSTEMS: [&System; 2] = [&MOTORCYCLE_SIMULATOR, &MOTORCYCLE_LAP];

impl System {
    /// The files of a package without its FMUs.
    pub fn texts(&self, form: Form) -> Contents {
        let texts = match form {
            Form::Whole => self.whole,
            Form::Flat => self.flat,
        };
        let licences = ("documentation/licenses/license.txt", LICENCE_TEXT);
        let bytes = |&(path, text): &Text| (path.to_owned(), text.as_bytes().to_vec());
        texts.iter().chain([&licences]).map(bytes).collect()
    }

    /// The start values of each component's FMU, in the components' order.
    ///
    /// # Errors
    /// A parameter or a value that does not exist.
    pub fn starts(&self) -> Result<Vec<Start>, Error> {
        let start = |(component, model): (&str, &FmuModel)| {
            let values = match self.start_values.iter().find(|(of, _)| *of == component) {
                Some((_, text)) => parameter_file::read(text, component, model.functions.identity.rows)?,
                None => NamedValues::new(),
            };
            Start::with(model, &values)
        };
        COMPONENTS.into_iter().map(start).collect()
    }

    /// Builds the package of this form into the directory `output`, which is created if it does not
    /// exist, and reports progress line by line.
    ///
    /// Without platforms the FMUs are for this machine. All are of FMI 2.0, the version that SSP
    /// 1.0 supports.
    ///
    /// # Errors
    /// An FMU cannot be built, or the package cannot be written.
    pub fn build(
        &self,
        form: Form,
        platforms: &[Platform],
        output: &Path,
        report: impl FnMut(&str),
    ) -> Result<Built, Error> {
        let contents = self.texts(form);
        let starts = self.starts()?;
        let ending = if form == Form::Flat { "flat.ssp" } else { "ssp" };
        let file = output.join(format!("{}.{ending}", self.name));
        Self::pack(contents, &COMPONENTS, &starts, platforms, &file, report)
    }

    /// Builds `OwnVehicle.ssp`: a vehicle's FMU, the washout and the platform with their start
    /// values. The package has the form [`Form::Flat`].
    ///
    /// # Errors
    /// As of [`System::build`].
    pub fn with_vehicle(
        vehicle: Vehicle,
        platforms: &[Platform],
        output: &Path,
        report: impl FnMut(&str),
    ) -> Result<Built, Error> {
        let mut contents = MOTORCYCLE_SIMULATOR.texts(Form::Flat);
        contents.retain(|path, _| !path.ends_with(".ssv"));
        contents.insert(DESCRIPTION_PATH.to_owned(), vehicle.description.into_bytes());
        contents.insert(vehicle::VEHICLE_FMU.to_owned(), vehicle.bytes);
        let components = &COMPONENTS[1..];
        let starts: Vec<Start> = components.iter().map(|(_, model)| Start::own(model)).collect();
        Self::pack(contents, components, &starts, platforms, &output.join("OwnVehicle.ssp"), report)
    }

    /// Adds the components' FMUs to a package, and writes it.
    fn pack(
        mut contents: Contents,
        components: &[(&str, &FmuModel)],
        starts: &[Start],
        platforms: &[Platform],
        file: &Path,
        mut report: impl FnMut(&str),
    ) -> Result<Built, Error> {
        let components = || components.iter().map(|&(_, model)| model).zip(starts);
        let own = components().filter(|(_, start)| start.is_own());
        compile_together(&own.map(|(model, _)| (model, FmiVersion::Fmi2)).collect::<Vec<_>>(), platforms)?;
        for (model, start) in components() {
            let bytes = fmu(model, start, FmiVersion::Fmi2, platforms, &mut report)?;
            contents.insert(format!("resources/{}", FmiVersion::Fmi2.fmu_file(model.name)), bytes);
        }
        let package = archive::pack(&contents)?;
        write_whole(file, &package)?;
        Ok(Built { file: file.to_owned(), size: package.len() })
    }
}
