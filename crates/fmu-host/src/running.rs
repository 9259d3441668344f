//! An FMU of FMI 2.0 or 3.0 that is stepped as a co-simulation, with its variables by name.

use std::ffi::{CString, c_int};
use std::path::Path;
use std::ptr::null;

use tempfile::TempDir;

use crate::description::{Causality, Declaration, Description, Element};
use crate::messages::{self, Messages, log3};
use crate::{Fmu, HostError, Instance, Status, Variable, VariableKind, archive, fmi3};

/// Name of the instance.
const INSTANCE_NAME: &str = "model";

/// A running FMU.
pub enum Running {
    Fmi2(Box<Running2>),
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
        let mut instance = Fmu::open(path)?.instantiate(INSTANCE_NAME)?;
        accept_warning(instance.initialize(values, None))?;
        Ok(Running::Fmi2(Box::new(Running2 { instance, description })))
    }

    /// Gets a variable by name; of a Boolean, 0 or 1.
    ///
    /// # Errors
    /// The FMU rejects the call, or there is no such variable.
    pub fn get(&mut self, name: &str) -> Result<f64, HostError> {
        match self {
            Running::Fmi2(running) => running.instance.get(name),
            Running::Fmi3(running) => running.get(name),
        }
    }

    /// Sets an input or a tunable parameter by name, rounded to the variable's kind.
    ///
    /// # Errors
    /// The FMU rejects the value, or there is no such variable.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), HostError> {
        match self {
            Running::Fmi2(running) => accept_warning(running.instance.set(name, value)),
            Running::Fmi3(running) => running.set(name, value),
        }
    }

    /// Sets the slope of a real input for the next step, of an FMU that
    /// [takes slopes](Running::takes_slopes).
    ///
    /// # Errors
    /// The FMU rejects the slope, or there is no such variable.
    pub fn set_slope(&mut self, name: &str, slope: f64) -> Result<(), HostError> {
        let variable = self.number(name).map(|(variable, ..)| variable);
        let variable = variable.filter(|variable| variable.kind == VariableKind::Real);
        let (Running::Fmi2(running), Some(variable)) = (self, variable) else {
            return Err(HostError::NoSuchVariable(name.into()));
        };
        let status = running.instance.set_real_input_derivatives(&[variable.value_reference], &[slope]);
        accept_warning(running.instance.expect_ok("fmi2SetRealInputDerivatives", status))
    }

    /// A step from `time` by `step` \[s\].
    ///
    /// # Errors
    /// The FMU does not make the step.
    pub fn step(&mut self, time: f64, step: f64) -> Result<(), HostError> {
        match self {
            Running::Fmi2(running) => accept_warning(running.instance.step(time, step)),
            Running::Fmi3(running) => running.step(time, step),
        }
    }

    /// True if the FMU takes slopes of its real inputs, as FMI 2.0 has them.
    pub fn takes_slopes(&self) -> bool {
        matches!(self, Running::Fmi2(running) if running.description.interpolates_inputs)
    }

    /// The declaration of a variable that can be got or set as a number, or of the array with this
    /// element.
    pub fn declaration(&self, name: &str) -> Option<&Declaration> {
        self.number(name).map(|(_, declaration, _)| declaration)
    }

    /// True if the name is that of a whole array, which is no number.
    pub fn is_array(&self, name: &str) -> bool {
        self.number(name).is_some_and(|(_, declaration, element)| declaration.is_array() && element.is_none())
    }

    /// Names of the variables of this role, sorted.
    pub fn names(&self, causality: Causality) -> Vec<&str> {
        let declarations = self.description().declarations.iter();
        let mut names: Vec<&str> =
            declarations.filter(|(_, found)| found.causality == causality).map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        names
    }

    fn number(&self, name: &str) -> Option<(Variable, &Declaration, Option<Element>)> {
        self.description().find(name).filter(|(variable, ..)| variable.kind != VariableKind::String)
    }

    fn description(&self) -> &Description {
        match self {
            Running::Fmi2(running) => &running.description,
            Running::Fmi3(running) => &running.description,
        }
    }
}

/// A call that ends with a warning is one that has been done.
fn accept_warning(result: Result<(), HostError>) -> Result<(), HostError> {
    match result {
        Err(HostError::Call { status: Status::Warning, .. }) => Ok(()),
        result => result,
    }
}

/// A running FMU of FMI 2.0.
pub struct Running2 {
    instance: Instance,
    description: Description,
}

/// A running FMU of FMI 3.0, freed when it is dropped.
pub struct Running3 {
    instance: fmi3::Instance,
    library: fmi3::Library,
    description: Description,
    /// Messages of the FMU; boxed, since the FMU keeps their address.
    messages: Box<Messages>,
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

/// Types of FMI 3.0, each with its functions and Rust's type.
macro_rules! numbers {
    ($to:ident $($arguments:tt)*) => {
        $to! { $($arguments)*
            "Float32" get_float32 set_float32 f32;
            "Int8" get_int8 set_int8 i8;
            "UInt8" get_uint8 set_uint8 u8;
            "Int16" get_int16 set_int16 i16;
            "UInt16" get_uint16 set_uint16 u16;
            "Int32" get_int32 set_int32 i32;
            "UInt32" get_uint32 set_uint32 u32;
            "Int64" get_int64 set_int64 i64;
            "UInt64" get_uint64 set_uint64 u64;
            "Enumeration" get_int64 set_int64 i64;
        }
    };
}

impl Running3 {
    fn start(description: Description, directory: TempDir, values: &[(&str, f64)]) -> Result<Self, HostError> {
        let path = archive::library_path_of(directory.path(), &archive::platform3(), &description.model_identifier)?;
        let library = fmi3::Library::open(&path)?;
        let text = |text: &str| CString::new(text).map_err(|error| HostError::Description(error.to_string()));
        let (name, token) = (text(INSTANCE_NAME)?, text(&description.guid)?);
        let resources = text(&format!("{}/", directory.path().join("resources").display()))?;
        let messages = Box::new(Messages::default());
        let environment = (&raw const *messages).cast_mut().cast();
        // SAFETY: the texts live during the call, the environment longer than the instance.
        let instance = unsafe {
            let instantiate = library.api().instantiate_co_simulation;
            instantiate(
                name.as_ptr(),
                token.as_ptr(),
                resources.as_ptr(),
                0,
                1,
                0,
                0,
                null(),
                0,
                environment,
                Some(log3),
                None,
            )
        };
        let mut running = Running3 { instance, library, description, messages, _directory: directory };
        if instance.is_null() {
            return Err(HostError::Instantiate(messages::last(&running.messages)));
        }
        // SAFETY: the FMU's instance.
        let status = unsafe { (running.library.api().enter_initialization_mode)(instance, 0, 0.0, 0.0, 0, 0.0) };
        running.expect_ok("fmi3EnterInitializationMode", status)?;
        values.iter().try_for_each(|(name, value)| running.set(name, *value))?;
        // SAFETY: the FMU's instance.
        let status = unsafe { (running.library.api().exit_initialization_mode)(instance) };
        running.expect_ok("fmi3ExitInitializationMode", status)?;
        Ok(running)
    }

    fn expect_ok(&self, function: &'static str, status: c_int) -> Result<(), HostError> {
        match status.into() {
            Status::Ok | Status::Warning => Ok(()),
            status => Err(HostError::Call { function, status, messages: messages::last(&self.messages) }),
        }
    }

    /// Value reference, kind, the type's name, and the element of an array.
    fn find(&self, name: &str) -> Result<([u32; 1], VariableKind, &str, Element), HostError> {
        match self.description.find(name) {
            Some((variable, declaration, element))
                if variable.kind != VariableKind::String && (element.is_some() || !declaration.is_array()) =>
            {
                let element = element.unwrap_or(Element { index: 0, length: 1 });
                Ok(([variable.value_reference], variable.kind, &declaration.element, element))
            }
            _ => Err(HostError::NoSuchVariable(name.into())),
        }
    }

    /// Sets a variable. Of an array the other elements stay as they are.
    fn set(&mut self, name: &str, value: f64) -> Result<(), HostError> {
        let (reference, kind, element, Element { index, length }) = self.find(name)?;
        let (instance, api, reference) = (self.instance, self.library.api(), reference.as_ptr());
        let rounded = if kind == VariableKind::Real { value } else { value.round() };
        macro_rules! set {
            ($get:ident $set:ident $type:ty, $value:expr) => {{
                let mut values = vec![<$type>::default(); length];
                let got = if length > 1 { (api.$get)(instance, reference, 1, values.as_mut_ptr(), length) } else { 0 };
                values[index] = $value;
                let set = (api.$set)(instance, reference, 1, values.as_ptr(), length);
                (got, set)
            }};
        }
        macro_rules! setters {
            ($($element:literal $get:ident $set:ident $type:ty;)+) => {
                match element {
                    $( $element => set!($get $set $type, rounded as $type), )+
                    "Boolean" => set!(get_boolean set_boolean u8, u8::from(value != 0.0)),
                    _ => set!(get_float64 set_float64 f64, value),
                }
            };
        }
        // SAFETY: the FMU's instance, and as many values as the one reference has.
        let (got, set) = unsafe { numbers!(setters) };
        self.expect_ok("fmi3Get", got)?;
        self.expect_ok("fmi3Set", set)
    }

    fn get(&mut self, name: &str) -> Result<f64, HostError> {
        let (reference, _, element, Element { index, length }) = self.find(name)?;
        let (instance, api, reference) = (self.instance, self.library.api(), reference.as_ptr());
        macro_rules! get {
            ($get:ident $type:ty) => {{
                let mut values = vec![<$type>::default(); length];
                ((api.$get)(instance, reference, 1, values.as_mut_ptr(), length), values[index] as f64)
            }};
        }
        macro_rules! getters {
            ($($element:literal $get:ident $set:ident $type:ty;)+) => {
                match element {
                    $( $element => get!($get $type), )+
                    "Boolean" => get!(get_boolean u8),
                    _ => get!(get_float64 f64),
                }
            };
        }
        // SAFETY: the FMU's instance, and places for as many values as the one reference has.
        let (status, value) = unsafe { numbers!(getters) };
        self.expect_ok("fmi3Get", status)?;
        Ok(value)
    }

    fn step(&mut self, time: f64, step: f64) -> Result<(), HostError> {
        let (mut event, mut terminate, mut early, mut last) = (0, 0, 0, 0.0);
        // SAFETY: the FMU's instance, and places for what the call returns.
        let status = unsafe {
            let do_step = self.library.api().do_step;
            do_step(self.instance, time, step, 1, &raw mut event, &raw mut terminate, &raw mut early, &raw mut last)
        };
        self.expect_ok("fmi3DoStep", status)
    }
}
