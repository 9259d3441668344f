//! An opened FMU.

use std::collections::HashMap;
use std::ffi::CString;
use std::path::Path;
use std::sync::Arc;

use libloading::Library;
use tempfile::TempDir;

use crate::description::Description;
use crate::{Api, HostError, Instance, Variable, archive};

/// An opened FMU: its shared library, and its variables by name.
#[derive(Clone)]
pub struct Fmu {
    pub(crate) loaded: Arc<Loaded>,
}

/// Data shared by the instances of an FMU, which live as long as any of them. Fields are dropped in
/// this order.
pub(crate) struct Loaded {
    pub api: Api,
    _library: Library,
    pub guid: CString,
    /// A `file:` address, where the FMU has resources.
    pub resources: Option<CString>,
    pub variables: HashMap<String, Variable>,
    _directory: Option<TempDir>,
}

impl Fmu {
    /// Opens an FMU's archive.
    ///
    /// # Errors
    /// The file is not an FMU for co-simulation, or has no shared library for this platform.
    pub fn open(path: &Path) -> Result<Fmu, HostError> {
        let directory = archive::unpack(path)?;
        let description = Description::parse(&archive::read(&directory.path().join("modelDescription.xml"))?)?;
        let library = archive::library_path(directory.path(), &description.model_identifier)?;
        let resources = format!("file://{}", directory.path().join("resources").display());
        let resources = CString::new(resources).map_err(|error| HostError::Description(error.to_string()))?;
        Self::load(&library, &description.guid, Some(resources), description.variables, Some(directory))
    }

    /// Opens an FMU's shared library alone. An FMU without its description has no variables by
    /// name, see [`Fmu::with_variables`].
    ///
    /// # Errors
    /// The library cannot be loaded, or lacks a function of FMI 2.0.
    pub fn from_library(library: &Path, guid: &str) -> Result<Fmu, HostError> {
        Self::load(library, guid, None, HashMap::new(), None)
    }

    /// The library with these variables by name, for an FMU without an archive.
    ///
    /// # Errors
    /// As [`Fmu::from_library`].
    pub fn with_variables(library: &Path, guid: &str, variables: HashMap<String, Variable>) -> Result<Fmu, HostError> {
        Self::load(library, guid, None, variables, None)
    }

    fn load(
        path: &Path,
        guid: &str,
        resources: Option<CString>,
        variables: HashMap<String, Variable>,
        directory: Option<TempDir>,
    ) -> Result<Fmu, HostError> {
        let library_error = |source| HostError::Library { path: path.into(), source };
        // SAFETY: what loading the library runs is the FMU's; to open an FMU is to trust it.
        let library = unsafe { Library::new(path) }.map_err(library_error)?;
        let api = Api::load(&library).map_err(library_error)?;
        let guid = CString::new(guid).map_err(|error| HostError::Description(error.to_string()))?;
        Ok(Fmu {
            loaded: Arc::new(Loaded { api, _library: library, guid, resources, variables, _directory: directory }),
        })
    }

    /// Makes an instance, with logging on.
    ///
    /// # Errors
    /// The FMU returns no instance; the error has its message.
    pub fn instantiate(&self, instance_name: &str) -> Result<Instance, HostError> {
        Instance::new(self, instance_name)
    }

    /// The variable of this name.
    pub fn variable(&self, name: &str) -> Option<Variable> {
        self.loaded.variables.get(name).copied()
    }

    /// The FMU's functions, for callers that want to do wrong.
    pub fn api(&self) -> &Api {
        &self.loaded.api
    }
}
