//! One instance in the hostile host's hands.

use std::ffi::{CString, c_int};
use std::ptr::{null, null_mut};
use std::sync::LazyLock;

use moris_fmu_host::Api;
use moris_fmu_host::api::{Callbacks, Component, FmuState};
use moris_washout::Washout;

use super::expected::{ERROR, Expected, IDENTITY, OK, Type, is_set_by_host, slot, type_of};
use super::logger::{Log, log};

/// An instance, what it said, and what it has to be.
pub struct Player {
    pub component: Component,
    pub expected: Expected,
    /// `None` for an instance that was made without a logger.
    log: Option<Box<Log>>,
    /// True if stages of the instance's life are logged.
    pub events: bool,
}

/// The references of all variables of a type.
static REFERENCES: LazyLock<[Vec<u32>; 3]> = LazyLock::new(|| {
    let of = |wanted| (0..IDENTITY.slots.len() as u32).filter(|&slot| type_of(slot as usize) == wanted).collect();
    [Type::Real, Type::Integer, Type::Boolean].map(of)
});

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

impl Player {
    /// Makes an instance with arguments that are right.
    pub fn new(api: &Api, name: &str, with_logger: bool, events: bool) -> Self {
        let mut log = with_logger.then(|| Box::new(Log { name: name.into(), ..Log::default() }));
        let callbacks = callbacks(log.as_deref_mut());
        let (name, guid) = (c_string(name), c_string(&moris_interface::guid::<Washout>()));
        // SAFETY: strings and callbacks live during the call, the log as long as the instance.
        let component =
            unsafe { (api.instantiate)(name.as_ptr(), 1, guid.as_ptr(), null(), &callbacks, 0, c_int::from(events)) };
        assert!(!component.is_null());
        let mut player = Player { component, expected: Expected::fresh(), log, events };
        player.accept("fmi2Instantiate", OK, &[OK]);
        player
    }

    /// Checks that the call ended in one of these ways, and that the instance said
    /// about it what it should.
    pub fn accept(&mut self, function: &str, status: c_int, right: &[c_int]) {
        let said = self.log.as_mut().map(|log| std::mem::take(&mut log.said));
        assert!(right.contains(&status), "{function}: {status}, not one of {right:?}; {said:?}; {:?}", self.expected);
        let Some(said) = said else { return };
        if status == OK {
            let quiet = said.iter().all(|said| self.events && said.status == OK && said.category == "logEvents");
            assert!(quiet, "{function}: {said:?}");
            return;
        }
        let [said] = &said[..] else { panic!("{function}: {status}, {said:?}") };
        let category = if status == ERROR { "logStatusError" } else { "logStatusDiscard" };
        assert_eq!((said.status, said.category.as_str()), (status, category), "{said:?}");
        assert!(said.text.starts_with(&format!("{function}: ")) && !said.text.ends_with('\n'), "{said:?}");
        assert!(!said.text.contains("internal error"), "{said:?}; {:?}", self.expected);
    }

    /// Checks everything that the instance shows, if it shows anything now.
    pub fn inspect(&mut self, api: &Api) {
        if self.expected.state == 'I' {
            return;
        }
        let values = self.values(api);
        self.check_settings(&values);
        self.check_outputs(&values);
        if "CT".contains(self.expected.state) {
            self.check_legs(&values);
        }
    }

    /// The value of every variable.
    fn values(&mut self, api: &Api) -> Vec<f64> {
        let [reals, integers, booleans] = &*REFERENCES;
        let mut values = vec![0.0; IDENTITY.slots.len()];
        let mut real = vec![f64::NAN; reals.len()];
        let mut whole = [vec![c_int::MIN; integers.len()], vec![c_int::MIN; booleans.len()]];
        // SAFETY: the instance is alive, and the arrays have the lengths given.
        let statuses = unsafe {
            let c = self.component;
            [
                (api.get_real)(c, reals.as_ptr(), reals.len(), real.as_mut_ptr()),
                (api.get_integer)(c, integers.as_ptr(), integers.len(), whole[0].as_mut_ptr()),
                (api.get_boolean)(c, booleans.as_ptr(), booleans.len(), whole[1].as_mut_ptr()),
            ]
        };
        for (function, status) in ["fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean"].iter().zip(statuses) {
            self.accept(function, status, &[OK]);
        }
        let whole = whole.iter().flatten().map(|&value| f64::from(value));
        for (&reference, value) in reals.iter().chain(integers).chain(booleans).zip(real.into_iter().chain(whole)) {
            values[reference as usize] = value;
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
    pub fn check_travel(&mut self, api: &Api, step: f64) {
        let Some((length, velocity)) = self.expected.legs else { return };
        let values = self.values(api);
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
    pub fn bytes(&mut self, api: &Api) -> Vec<u8> {
        let mut state: FmuState = null_mut();
        let mut size = 0;
        // SAFETY: the instance is alive, and the pointers lead to what the functions want.
        unsafe {
            assert_eq!((api.get_fmu_state)(self.component, &mut state), OK);
            assert_eq!((api.serialized_fmu_state_size)(self.component, state, &mut size), OK);
            let mut bytes = vec![0; size];
            assert_eq!((api.serialize_fmu_state)(self.component, state, bytes.as_mut_ptr(), size), OK);
            assert_eq!((api.free_fmu_state)(self.component, &mut state), OK);
            bytes
        }
    }

    /// Frees the instance.
    pub fn free(self, api: &Api) {
        // SAFETY: the instance is alive, and nobody uses it from here on.
        unsafe { (api.free_instance)(self.component) };
        let said = self.log.map(|log| log.said);
        assert!(said.is_none_or(|said| said.is_empty()));
    }
}

/// The host's functions, with this log or without a logger.
pub fn callbacks(log_of_instance: Option<&mut Log>) -> Callbacks {
    let logger = log_of_instance.is_some().then_some(log as moris_fmu_host::api::Logger);
    let environment = log_of_instance.map_or(null_mut(), |log| (&raw mut *log).cast());
    Callbacks { logger, allocate_memory: None, free_memory: None, step_finished: None, environment }
}

pub fn c_string(text: &str) -> CString {
    CString::new(text).expect("no zero in it")
}
