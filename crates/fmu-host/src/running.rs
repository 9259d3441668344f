//! An FMU of FMI 2.0 or 3.0 that is stepped as a co-simulation, with its variables by name.

use std::ffi::{CString, c_int};
use std::path::Path;
use std::ptr::{null, null_mut};

use tempfile::TempDir;

use crate::description::Description;
use crate::{Fmu, HostError, Instance, Status, VariableKind, archive, fmi3};

/// A running FMU.
pub enum Running {
    Fmi2(Box<Instance>),
    Fmi3(Box<Running3>),
}

impl Running {
    /// Opens an FMU and initialises it at time 0, with values set by name.
    ///
    /// # Errors
    /// The file is not an FMU for co-simulation on this platform, or rejects a value.
    pub fn start(path: &Path, values: &[(&str, f64)]) -> Result<Self, HostError> {
        let directory = archive::unpack(path)?;
        let description = Description::parse(&archive::read(&directory.path().join("modelDescription.xml"))?)?;
        if description.is_fmi3 {
            return Ok(Running::Fmi3(Box::new(Running3::start(description, directory, values)?)));
        }
        let mut instance = Fmu::open(path)?.instantiate("vehicle")?;
        instance.initialize(values, None)?;
        Ok(Running::Fmi2(Box::new(instance)))
    }

    /// Gets a variable by name; of a Boolean, 0 or 1.
    ///
    /// # Errors
    /// The FMU rejects the call, or there is no such variable.
    pub fn get(&mut self, name: &str) -> Result<f64, HostError> {
        match self {
            Running::Fmi2(instance) => instance.get(name),
            Running::Fmi3(running) => running.get(name),
        }
    }

    /// Sets an input or a tunable parameter by name, rounded to the variable's kind.
    ///
    /// # Errors
    /// The FMU rejects the value, or there is no such variable.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), HostError> {
        match self {
            Running::Fmi2(instance) => instance.set(name, value),
            Running::Fmi3(running) => running.set(name, value),
        }
    }

    /// A step from `time` by `step` \[s\].
    ///
    /// # Errors
    /// The FMU does not make the step.
    pub fn step(&mut self, time: f64, step: f64) -> Result<(), HostError> {
        match self {
            Running::Fmi2(instance) => instance.step(time, step),
            Running::Fmi3(running) => running.step(time, step),
        }
    }
}

/// A running FMU of FMI 3.0, freed when it is dropped.
pub struct Running3 {
    instance: fmi3::Instance,
    library: fmi3::Library,
    description: Description,
    _directory: TempDir,
}

// SAFETY: the standard has an instance used by any thread, one at a time; `&mut` sees to that.
unsafe impl Send for Running3 {}

impl Drop for Running3 {
    fn drop(&mut self) {
        if !self.instance.is_null() {
            // SAFETY: the FMU's instance, which nobody uses after this.
            unsafe { (self.library.api().free_instance)(self.instance) }
        }
    }
}

fn expect_ok(function: &'static str, status: c_int) -> Result<(), HostError> {
    match status.into() {
        Status::Ok | Status::Warning => Ok(()),
        status => Err(HostError::Call { function, status, messages: String::new() }),
    }
}

impl Running3 {
    fn start(description: Description, directory: TempDir, values: &[(&str, f64)]) -> Result<Self, HostError> {
        let path = archive::library_path_of(directory.path(), &archive::platform3(), &description.model_identifier)?;
        let library = fmi3::Library::open(&path)?;
        let text = |text: &str| CString::new(text).map_err(|error| HostError::Description(error.to_string()));
        let (name, token) = (text("vehicle")?, text(&description.guid)?);
        let resources = text(&format!("{}/", directory.path().join("resources").display()))?;
        // SAFETY: the texts live during the call; there are no callbacks.
        let instance = unsafe {
            let instantiate = library.api().instantiate_co_simulation;
            instantiate(
                name.as_ptr(),
                token.as_ptr(),
                resources.as_ptr(),
                0,
                0,
                0,
                0,
                null(),
                0,
                null_mut(),
                None,
                None,
            )
        };
        let mut running = Running3 { instance, library, description, _directory: directory };
        if instance.is_null() {
            return Err(HostError::Instantiate("it gives no instance".into()));
        }
        // SAFETY: the FMU's instance.
        let status = unsafe { (running.library.api().enter_initialization_mode)(instance, 0, 0.0, 0.0, 0, 0.0) };
        expect_ok("fmi3EnterInitializationMode", status)?;
        values.iter().try_for_each(|(name, value)| running.set(name, *value))?;
        // SAFETY: the FMU's instance.
        expect_ok("fmi3ExitInitializationMode", unsafe { (running.library.api().exit_initialization_mode)(instance) })?;
        Ok(running)
    }

    fn find(&self, name: &str) -> Result<([u32; 1], VariableKind), HostError> {
        match self.description.variables.get(name) {
            Some(variable) if variable.kind != VariableKind::String => Ok(([variable.value_reference], variable.kind)),
            _ => Err(HostError::NoSuchVariable(name.into())),
        }
    }

    fn set(&mut self, name: &str, value: f64) -> Result<(), HostError> {
        let (reference, kind) = self.find(name)?;
        let (instance, api, reference) = (self.instance, self.library.api(), reference.as_ptr());
        // SAFETY: the FMU's instance, and one value for one reference.
        let status = unsafe {
            match kind {
                VariableKind::Real => (api.set_float64)(instance, reference, 1, &raw const value, 1),
                VariableKind::Boolean => (api.set_boolean)(instance, reference, 1, &u8::from(value != 0.0), 1),
                VariableKind::Enumeration => (api.set_int64)(instance, reference, 1, &(value.round() as i64), 1),
                _ => (api.set_int32)(instance, reference, 1, &(value.round() as i32), 1),
            }
        };
        expect_ok("fmi3Set", status)
    }

    fn get(&mut self, name: &str) -> Result<f64, HostError> {
        let (reference, kind) = self.find(name)?;
        let (instance, api, reference) = (self.instance, self.library.api(), reference.as_ptr());
        let (mut real, mut boolean, mut long, mut int) = (0.0, 0_u8, 0_i64, 0_i32);
        // SAFETY: the FMU's instance, and one value for one reference.
        let (status, value) = unsafe {
            match kind {
                VariableKind::Real => ((api.get_float64)(instance, reference, 1, &raw mut real, 1), real),
                VariableKind::Boolean => {
                    ((api.get_boolean)(instance, reference, 1, &raw mut boolean, 1), f64::from(boolean))
                }
                VariableKind::Enumeration => ((api.get_int64)(instance, reference, 1, &raw mut long, 1), long as f64),
                _ => ((api.get_int32)(instance, reference, 1, &raw mut int, 1), f64::from(int)),
            }
        };
        expect_ok("fmi3Get", status)?;
        Ok(value)
    }

    fn step(&mut self, time: f64, step: f64) -> Result<(), HostError> {
        let (mut event, mut terminate, mut early, mut last) = (0, 0, 0, 0.0);
        // SAFETY: the FMU's instance, and places for what the call returns.
        let status = unsafe {
            let do_step = self.library.api().do_step;
            do_step(self.instance, time, step, 1, &raw mut event, &raw mut terminate, &raw mut early, &raw mut last)
        };
        expect_ok("fmi3DoStep", status)
    }
}
