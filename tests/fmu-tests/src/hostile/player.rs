//! One instance in the hostile host's hands.

use std::ffi::{CString, c_int, c_void};
use std::ptr::{null, null_mut};
use std::sync::LazyLock;

use moris_fmu_host::api::{CO_SIMULATION, Callbacks, Component, FmuState};
use moris_fmu_host::fmi3::LogMessage;
use moris_interface::guid;
use moris_washout::Washout;

use super::expected::{DISCARD, ERROR, Expected, IDENTITY, OK, is_set_by_host, slot};
use super::functions::{Access, Answer, Functions, Variables, Version};
use super::logger::{Log, log2, log3};
use super::states::bytes_of;

/// An instance, what it said, and what it has to be.
pub struct Player {
    pub component: Component,
    pub expected: Expected,
    /// `None` for an instance that was made without a logger.
    log: Option<Box<Log>>,
    pub logged: Logged,
}

/// Categories of messages that an instance sends.
#[derive(Clone, Copy, Debug)]
pub struct Logged {
    pub events: bool,
    pub warnings: bool,
    pub discards: bool,
    pub errors: bool,
}

impl Logged {
    /// Categories after instantiation with logging on or off: an instance always warns, and one of
    /// FMI 2.0 always says why it discards.
    fn after_instantiation(functions: &Functions, on: bool) -> Self {
        let of_fmi2 = matches!(functions.version, Version::Fmi2(_));
        Logged { events: on, warnings: true, discards: on || of_fmi2, errors: true }
    }
}

/// The slots that the checks after each call look at.
struct Slots {
    time: usize,
    length: [usize; 6],
    velocity: [usize; 6],
    min_length: usize,
    max_length: usize,
    velocity_limit: usize,
    acceleration_limit: usize,
    stroke_margin: usize,
}

static SLOTS: LazyLock<Slots> = LazyLock::new(|| Slots {
    time: slot("time"),
    length: std::array::from_fn(|i| slot(&format!("actuator[{}].length", i + 1))),
    velocity: std::array::from_fn(|i| slot(&format!("actuator[{}].velocity", i + 1))),
    min_length: slot("actuator.minLength"),
    max_length: slot("actuator.maxLength"),
    velocity_limit: slot("actuator.velocityLimit"),
    acceleration_limit: slot("actuator.accelerationLimit"),
    stroke_margin: slot("status.strokeMargin"),
});

/// Tolerance of rounding beyond a limit, relative, and absolute \[m\].
const ROUNDING: f64 = 1e-9;
const ROUNDING_LENGTH: f64 = 1e-12;

/// Status of a warning's message; the call itself is right.
const WARNING: c_int = 1;

impl Player {
    /// Makes an instance with arguments that are right.
    pub fn new(functions: &Functions, name: &str, with_logger: bool, logging_on: bool) -> Self {
        let mut log = with_logger.then(|| Box::new(Log { name: name.into(), ..Log::default() }));
        let name = c_string(name);
        let (function, component) = match &functions.version {
            Version::Fmi2(api) => {
                let (callbacks, guid) = (callbacks(log.as_deref_mut()), c_string(&guid::<Washout>()));
                let (name, guid, logging_on) = (name.as_ptr(), guid.as_ptr(), c_int::from(logging_on));
                // SAFETY: strings and callbacks live during the call, the log as long as the instance.
                let component =
                    unsafe { (api.instantiate)(name, CO_SIMULATION, guid, null(), &callbacks, 0, logging_on) };
                ("fmi2Instantiate", component)
            }
            Version::Fmi3(api, layout) => {
                let (callback, environment) = fmi3_callback(log.as_deref_mut());
                let token = c_string(&layout.token(&guid::<Washout>()));
                let (name, token, logging_on) = (name.as_ptr(), token.as_ptr(), u8::from(logging_on));
                // SAFETY: the strings live during the call, the log as long as the instance.
                let component = unsafe {
                    let instantiate = api.instantiate_co_simulation;
                    instantiate(name, token, null(), 0, logging_on, 0, 0, null(), 0, environment, callback, None)
                };
                ("fmi3InstantiateCoSimulation", component)
            }
        };
        assert!(!component.is_null());
        let logged = Logged::after_instantiation(functions, logging_on);
        let mut player = Player { component, expected: Expected::fresh(), log, logged };
        player.accept((function, OK), &[OK]);
        player
    }

    /// Checks that the call ended in one of these ways, and that the instance said
    /// about it what it should.
    pub fn accept(&mut self, (function, status): Answer, right: &[c_int]) {
        let messages = self.log.as_mut().map(|log| std::mem::take(&mut log.messages));
        assert!(
            right.contains(&status),
            "{function}: {status}, not one of {right:?}; {messages:?}; {:?}",
            self.expected
        );
        let Some(messages) = messages else { return };
        if status == OK {
            let expected = messages.iter().all(|message| match (message.status, message.category.as_str()) {
                (OK, "logEvents") => self.logged.events,
                (WARNING, "logStatusWarning") => self.logged.warnings,
                _ => false,
            });
            assert!(expected, "{function}: {messages:?}");
            return;
        }
        if status == ERROR && !self.logged.errors || status == DISCARD && !self.logged.discards {
            assert!(messages.is_empty(), "{function}: {messages:?}");
            return;
        }
        let [message] = &messages[..] else { panic!("{function}: {status}, {messages:?}") };
        let category = if status == ERROR { "logStatusError" } else { "logStatusDiscard" };
        assert_eq!((message.status, message.category.as_str()), (status, category), "{message:?}");
        assert!(message.text.starts_with(&format!("{function}: ")) && !message.text.ends_with('\n'), "{message:?}");
        assert!(!message.text.contains("internal error"), "{message:?}; {:?}", self.expected);
    }

    /// Checks everything that the instance shows, if it shows anything now.
    pub fn inspect(&mut self, functions: &Functions) {
        if self.expected.state == 'I' {
            return;
        }
        let values = self.values(functions);
        self.check_settings(&values);
        self.check_outputs(&values);
        if "CT".contains(self.expected.state) {
            self.check_legs(&values);
        }
    }

    /// The value of every slot.
    fn values(&mut self, functions: &Functions) -> Vec<f64> {
        let mut values = vec![f64::NAN; IDENTITY.slots.len()];
        for Variables { kind, references, slots } in &functions.variables {
            let mut read = vec![f64::NAN; slots.len()];
            let access = Access {
                kind: *kind,
                references: references.as_ptr(),
                count: references.len(),
                value_count: read.len(),
                values: Some(&mut read),
            };
            // SAFETY: the instance is alive, and the arrays have the lengths given.
            let answer = unsafe { functions.get(self.component, access) };
            self.accept(answer, &[OK]);
            slots.iter().zip(read).for_each(|(&slot, value)| values[slot] = value);
        }
        values
    }

    /// Every value reads as it was set, to the bit.
    fn check_settings(&self, values: &[f64]) {
        assert_eq!(values[SLOTS.time].to_bits(), self.expected.time.to_bits(), "time");
        for (slot, (shown, expected)) in values.iter().zip(&self.expected.values).enumerate() {
            if is_set_by_host(slot) {
                let name = || IDENTITY.variable_name(slot);
                assert_eq!(shown.to_bits(), expected.to_bits(), "{}: {shown}, not {expected}", name());
            }
        }
    }

    /// No output is ever anything but a number.
    fn check_outputs(&self, values: &[f64]) {
        for (slot, value) in values.iter().enumerate() {
            assert!(value.is_finite(), "{} = {value}; {:?}", IDENTITY.variable_name(slot), self.expected);
        }
    }

    /// The legs are within stroke and speed, and, from step to step, within acceleration.
    fn check_legs(&mut self, values: &[f64]) {
        let value = |slot: usize| values[slot];
        let (min, max) = (value(SLOTS.min_length), value(SLOTS.max_length));
        let fastest = value(SLOTS.velocity_limit) * (1.0 + ROUNDING);
        let (length, velocity) = (SLOTS.length.map(value), SLOTS.velocity.map(value));
        assert!(length.iter().all(|length| (min..=max).contains(length)), "{length:?}; {:?}", self.expected);
        assert!(velocity.iter().all(|velocity| velocity.abs() <= fastest), "{velocity:?}; {:?}", self.expected);
        assert!(value(SLOTS.stroke_margin) >= 0.0);
        self.expected.legs = Some((length, velocity));
    }

    /// Checks that a step of `step` seconds has taken the legs no farther and made them no
    /// faster than they can go.
    pub fn check_travel(&mut self, functions: &Functions, step: f64) {
        let Some((length, velocity)) = self.expected.legs else { return };
        let values = self.values(functions);
        let limits = [SLOTS.velocity_limit, SLOTS.acceleration_limit].map(|slot| values[slot]);
        let [way, change] = limits.map(|limit| limit * step * (1.0 + ROUNDING));
        for i in 0..6 {
            let travelled = (values[SLOTS.length[i]] - length[i]).abs();
            let faster = (values[SLOTS.velocity[i]] - velocity[i]).abs();
            assert!(travelled <= way + ROUNDING_LENGTH, "leg {i}: {travelled} m in {step} s; {:?}", self.expected);
            assert!(faster <= change + ROUNDING, "leg {i}: {faster} m/s in {step} s; {:?}", self.expected);
        }
    }

    /// Everything about the instance, as bytes.
    pub fn bytes(&mut self, functions: &Functions) -> Vec<u8> {
        let mut state: FmuState = null_mut();
        // SAFETY: the instance is alive, and the pointer leads to a state.
        unsafe {
            assert_eq!(functions.get_fmu_state(self.component, &mut state).1, OK);
            let bytes = bytes_of(self, functions, state);
            assert_eq!(functions.free_fmu_state(self.component, &mut state).1, OK);
            bytes
        }
    }

    /// Frees the instance; returns the function's name.
    pub fn free(self, functions: &Functions) -> &'static str {
        // SAFETY: the instance is alive, and nobody uses it from here on.
        let (function, ()) = unsafe { functions.free_instance(self.component) };
        let messages = self.log.map(|log| log.messages);
        assert!(messages.is_none_or(|messages| messages.is_empty()));
        function
    }
}

/// FMI 2.0's functions of the host, with this log or without a logger.
pub fn callbacks(log: Option<&mut Log>) -> Callbacks {
    let logger = log.is_some().then_some(log2 as moris_fmu_host::api::Logger);
    let environment = log.map_or(null_mut(), |log| (&raw mut *log).cast());
    Callbacks { logger, allocate_memory: None, free_memory: None, step_finished: None, environment }
}

/// FMI 3.0's function for messages with its environment, with this log or without a logger.
pub fn fmi3_callback(log: Option<&mut Log>) -> (Option<LogMessage>, *mut c_void) {
    let callback = log.is_some().then_some(log3 as LogMessage);
    (callback, log.map_or(null_mut(), |log| (&raw mut *log).cast()))
}

pub fn c_string(text: &str) -> CString {
    CString::new(text).expect("no zero in it")
}
