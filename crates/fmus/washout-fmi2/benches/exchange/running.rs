//! An instance in the loop of a host that steps it at 1 kHz.

use std::ffi::c_int;
use std::hint::black_box;

use moris_fmu_host::api::Component;
use moris_fmu_host::{Api, Fmu, Instance};

const STEP: f64 = 0.001;
/// fmi2OK
const OK: c_int = 0;

pub type Inputs = [f64; 9];

/// An instance between two steps, with what the loop sets and gets.
pub struct Running {
    pub instance: Instance,
    api: Api,
    inputs: [u32; 9],
    outputs: [u32; 12],
    step: u64,
}

impl Running {
    fn new(fmu: &Fmu, parameters: &[(&str, f64)], inputs: [u32; 9], outputs: [u32; 12]) -> Self {
        let mut instance = fmu.instantiate("bench").expect("instantiated");
        instance.initialize(parameters, None).expect("initialised");
        let api = *instance.api();
        Running { instance, api, inputs, outputs, step: 0 }
    }

    /// A washout of the classical strategy with these parameters: set are the specific force, the
    /// angular velocity and the orientation, and got the lengths and what the rider feels.
    pub fn washout(fmu: &Fmu, parameters: &[(&str, f64)]) -> Self {
        let reference = |name: String| fmu.variable(&name).expect("a variable of the washout").value_reference;
        let axes = |vector: &str| ["x", "y", "z"].map(|axis| reference(format!("{vector}.{axis}")));
        let [fx, fy, fz] = axes("vehicle.specificForce");
        let [wx, wy, wz] = axes("vehicle.angularVelocity");
        let [roll, pitch, yaw] =
            ["roll", "pitch", "yaw"].map(|angle| reference(format!("vehicle.orientation.{angle}")));
        let [l1, l2, l3, l4, l5, l6] = [1, 2, 3, 4, 5, 6].map(|i| reference(format!("actuator[{i}].length")));
        let [ax, ay, az] = axes("rider.specificForce");
        let [rx, ry, rz] = axes("rider.angularVelocity");
        let inputs = [fx, fy, fz, wx, wy, wz, roll, pitch, yaw];
        let parameters = [&[("strategy", 1.0)], parameters].concat();
        Running::new(fmu, &parameters, inputs, [l1, l2, l3, l4, l5, l6, ax, ay, az, rx, ry, rz])
    }

    /// A model that does nothing, with as many variables.
    pub fn do_nothing(fmu: &Fmu) -> Self {
        // Value references are slots, and slot 0 is the time.
        Running::new(fmu, &[], std::array::from_fn(|k| 1 + k as u32), std::array::from_fn(|k| 10 + k as u32))
    }

    /// The loop alone: in place of the FMU's functions, it calls empty ones.
    pub fn without_functions(self) -> Self {
        let api = Api { set_real: empty::set_real, do_step: empty::do_step, get_real: empty::get_real, ..self.api };
        Running { api: black_box(api), ..self }
    }

    /// Sets the inputs, makes a step and gets the outputs, as a host in C does.
    pub fn exchange(&mut self, inputs: &Inputs) {
        let Running { api, inputs: set, outputs: get, .. } = self;
        let component = self.instance.component();
        let time = STEP * self.step as f64;
        let mut outputs = [0.0; 12];
        // SAFETY: the instance is there, and the arrays have as many elements as said.
        let done = unsafe {
            (api.set_real)(component, set.as_ptr(), set.len(), black_box(inputs).as_ptr()) == OK
                && (api.do_step)(component, time, STEP, 1) == OK
                && (api.get_real)(component, get.as_ptr(), get.len(), outputs.as_mut_ptr()) == OK
        };
        assert!(done);
        self.step += 1;
        black_box(&outputs);
    }

    /// The exchange on a smooth ride.
    pub fn ride(&mut self) {
        let phase = 1e-3 * self.step as f64;
        let wave = 0.3 * (phase - phase.floor() - 0.5).abs();
        let inputs = [wave, 0.5 * wave, 9.8 + 0.1 * wave, 0.01 * wave, 0.0, 0.0, 0.02 * wave, 0.01 * wave, 0.1];
        self.exchange(&inputs);
    }
}

/// Functions that do nothing at all.
mod empty {
    use super::{Component, OK, c_int};

    pub extern "C" fn set_real(_: Component, _: *const u32, _: usize, _: *const f64) -> c_int {
        OK
    }

    pub extern "C" fn do_step(_: Component, _: f64, _: f64, _: c_int) -> c_int {
        OK
    }

    pub extern "C" fn get_real(_: Component, _: *const u32, _: usize, _: *mut f64) -> c_int {
        OK
    }
}
