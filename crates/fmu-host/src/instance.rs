//! An instance of an FMU.

use std::ffi::{CString, c_int, c_void};
use std::sync::{Arc, PoisonError};

use crate::api::{Api, CO_SIMULATION, Callbacks, Component};
use crate::fmu::Loaded;
use crate::messages::{self, Messages, log};
use crate::{Fmu, HostError, Message, Status, VariableKind};

// The memory that an FMU takes from its host, by the functions of C.
unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

/// Declares the functions that set or get variables: a function's name, that of its C function, the
/// type of the values, and the function that gives their address.
macro_rules! access {
    ($($function:ident $name:literal ($values:ty) $address:ident;)+) => {
        $(
            #[doc = concat!("`", $name, "`; as many values as references.")]
            pub fn $function(&mut self, references: &[u32], values: $values) -> Status {
                assert_eq!(references.len(), values.len());
                let (pointer, count) = (references.as_ptr(), references.len());
                // SAFETY: the FMU's instance, and arrays of the length given.
                unsafe { (self.api().$function)(self.component, pointer, count, values.$address()) }.into()
            }
        )+
    };
}

/// An instance of an FMU, freed when it is dropped.
pub struct Instance {
    pub(crate) component: Component,
    /// Messages of the FMU; boxed, since the FMU keeps their address.
    messages: Box<Messages>,
    loaded: Arc<Loaded>,
}

// SAFETY: the standard has an instance used by any thread, one at a time; `&mut` sees to that.
unsafe impl Send for Instance {}

impl Instance {
    pub(crate) fn new(fmu: &Fmu, name: &str) -> Result<Self, HostError> {
        let loaded = fmu.loaded.clone();
        let messages = Box::new(Messages::default());
        let environment = (&raw const *messages).cast_mut().cast();
        let callbacks = Callbacks {
            logger: Some(log),
            allocate_memory: Some(calloc),
            free_memory: Some(free),
            step_finished: None,
            environment,
        };
        let name = CString::new(name).map_err(|error| HostError::Instantiate(error.to_string()))?;
        let resources = loaded.resources.as_ref().map_or(std::ptr::null(), |resources| resources.as_ptr());
        // SAFETY: strings and callbacks live during the call, the environment longer than the instance.
        let component = unsafe {
            (loaded.api.instantiate)(name.as_ptr(), CO_SIMULATION, loaded.guid.as_ptr(), resources, &callbacks, 0, 1)
        };
        let instance = Instance { component, messages, loaded };
        if component.is_null() {
            return Err(HostError::Instantiate(instance.last_messages()));
        }
        Ok(instance)
    }

    /// Initialises the instance at time 0, with parameters set by name.
    ///
    /// # Errors
    /// The FMU rejects a call, or there is no such variable.
    pub fn initialize(&mut self, parameters: &[(&str, f64)], stop_time: Option<f64>) -> Result<(), HostError> {
        let status = self.setup_experiment(0.0, stop_time);
        self.expect_ok("fmi2SetupExperiment", status)?;
        let status = self.enter_initialization_mode();
        self.expect_ok("fmi2EnterInitializationMode", status)?;
        for &(name, value) in parameters {
            self.set(name, value)?;
        }
        let status = self.exit_initialization_mode();
        self.expect_ok("fmi2ExitInitializationMode", status)
    }

    /// `fmi2SetupExperiment`, without a tolerance. Times in s.
    pub fn setup_experiment(&mut self, start_time: f64, stop_time: Option<f64>) -> Status {
        let (defined, stop_time) = (c_int::from(stop_time.is_some()), stop_time.unwrap_or(0.0));
        // SAFETY: the FMU's instance.
        unsafe { (self.api().setup_experiment)(self.component, 0, 0.0, start_time, defined, stop_time) }.into()
    }

    /// `fmi2EnterInitializationMode`
    pub fn enter_initialization_mode(&mut self) -> Status {
        // SAFETY: the FMU's instance.
        unsafe { (self.api().enter_initialization_mode)(self.component) }.into()
    }

    /// `fmi2ExitInitializationMode`
    pub fn exit_initialization_mode(&mut self) -> Status {
        // SAFETY: the FMU's instance.
        unsafe { (self.api().exit_initialization_mode)(self.component) }.into()
    }

    /// Sets a variable by name. Of a Boolean, everything but 0 is true; integers and enumerations
    /// are rounded.
    ///
    /// # Errors
    /// The FMU rejects the value, or there is no such variable.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), HostError> {
        let (reference, kind) = self.find(name)?;
        let reference = [reference];
        let (function, status) = match kind {
            VariableKind::Real => ("fmi2SetReal", self.set_real(&reference, &[value])),
            VariableKind::Boolean => ("fmi2SetBoolean", self.set_boolean(&reference, &[c_int::from(value != 0.0)])),
            _ => ("fmi2SetInteger", self.set_integer(&reference, &[value.round() as c_int])),
        };
        self.expect_ok(function, status)
    }

    /// Gets a variable by name; of a Boolean, 0 or 1.
    ///
    /// # Errors
    /// The FMU rejects the call, or there is no such variable.
    pub fn get(&mut self, name: &str) -> Result<f64, HostError> {
        let (reference, kind) = self.find(name)?;
        let reference = [reference];
        let (mut real, mut integer) = ([0.0], [0]);
        let (function, status) = match kind {
            VariableKind::Real => ("fmi2GetReal", self.get_real(&reference, &mut real)),
            VariableKind::Boolean => ("fmi2GetBoolean", self.get_boolean(&reference, &mut integer)),
            _ => ("fmi2GetInteger", self.get_integer(&reference, &mut integer)),
        };
        self.expect_ok(function, status)?;
        Ok(if kind == VariableKind::Real { real[0] } else { f64::from(integer[0]) })
    }

    fn find(&self, name: &str) -> Result<(u32, VariableKind), HostError> {
        match self.loaded.variables.get(name) {
            Some(variable) if variable.kind != VariableKind::String => Ok((variable.value_reference, variable.kind)),
            _ => Err(HostError::NoSuchVariable(name.into())),
        }
    }

    access! {
        set_real "fmi2SetReal" (&[f64]) as_ptr;
        get_real "fmi2GetReal" (&mut [f64]) as_mut_ptr;
        set_integer "fmi2SetInteger" (&[c_int]) as_ptr;
        get_integer "fmi2GetInteger" (&mut [c_int]) as_mut_ptr;
        set_boolean "fmi2SetBoolean" (&[c_int]) as_ptr;
        get_boolean "fmi2GetBoolean" (&mut [c_int]) as_mut_ptr;
    }

    /// `fmi2SetRealInputDerivatives`, of first order; as many values as references.
    pub fn set_real_input_derivatives(&mut self, references: &[u32], values: &[f64]) -> Status {
        assert_eq!(references.len(), values.len());
        let orders = vec![1; references.len()];
        let (pointer, count) = (references.as_ptr(), references.len());
        let function = self.api().set_real_input_derivatives;
        // SAFETY: the FMU's instance, and arrays of the length given.
        unsafe { function(self.component, pointer, count, orders.as_ptr(), values.as_ptr()) }.into()
    }

    /// `fmi2GetRealOutputDerivatives`, of first order; as many values as references.
    pub fn get_real_output_derivatives(&mut self, references: &[u32], values: &mut [f64]) -> Status {
        assert_eq!(references.len(), values.len());
        let orders = vec![1; references.len()];
        let (pointer, count) = (references.as_ptr(), references.len());
        let function = self.api().get_real_output_derivatives;
        // SAFETY: the FMU's instance, and arrays of the length given.
        unsafe { function(self.component, pointer, count, orders.as_ptr(), values.as_mut_ptr()) }.into()
    }

    /// `fmi2DoStep`, from `time` by `step` \[s\].
    pub fn do_step(&mut self, time: f64, step: f64) -> Status {
        // SAFETY: the FMU's instance.
        unsafe { (self.api().do_step)(self.component, time, step, 1) }.into()
    }

    /// A step from `time` by `step` \[s\] that has to succeed.
    ///
    /// # Errors
    /// The FMU does not make the step.
    pub fn step(&mut self, time: f64, step: f64) -> Result<(), HostError> {
        let status = self.do_step(time, step);
        self.expect_ok("fmi2DoStep", status)
    }

    /// Steps of `step` seconds from time 0, each communication point a product: k times `step`.
    ///
    /// # Errors
    /// The FMU does not make a step.
    pub fn steps(&mut self, count: u32, step: f64) -> Result<(), HostError> {
        (0..count).try_for_each(|k| self.step(f64::from(k) * step, step))
    }

    /// `fmi2Terminate`
    pub fn terminate(&mut self) -> Status {
        // SAFETY: the FMU's instance.
        unsafe { (self.api().terminate)(self.component) }.into()
    }

    /// `fmi2Reset`
    pub fn reset(&mut self) -> Status {
        // SAFETY: the FMU's instance.
        unsafe { (self.api().reset)(self.component) }.into()
    }

    /// Messages of the FMU so far.
    pub fn messages(&self) -> Vec<Message> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Messages since the last call of this function; removes them.
    pub fn take_messages(&mut self) -> Vec<Message> {
        std::mem::take(&mut self.messages.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The FMU's functions, for callers that want to do wrong.
    #[inline]
    pub fn api(&self) -> &Api {
        &self.loaded.api
    }

    /// The FMU's own pointer to the instance, to use with [`Instance::api`].
    pub fn component(&self) -> Component {
        self.component
    }

    pub(crate) fn expect_ok(&self, function: &'static str, status: Status) -> Result<(), HostError> {
        if status == Status::Ok {
            return Ok(());
        }
        Err(HostError::Call { function, status, messages: self.last_messages() })
    }

    /// The last messages of the FMU.
    fn last_messages(&self) -> String {
        messages::last(&self.messages)
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the FMU's instance, which nobody uses from here on.
        unsafe { (self.loaded.api.free_instance)(self.component) }
    }
}
