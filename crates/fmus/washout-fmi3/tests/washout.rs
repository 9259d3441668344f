//! The washout through the C functions of FMI 3.0, against the same washout in Rust.

use std::ffi::CString;
use std::path::PathBuf;
use std::ptr::{null, null_mut};

use moris_fmi::fmi3::Layout;
use moris_fmu_host::fmi3::{self, Api, Library};
use moris_fmu_tests::swing;
use moris_interface::{Identity, Kind, Model, SlotModel};
use moris_washout::{Parameters, Washout};

const IDENTITY: Identity = Washout::IDENTITY;

/// The library, which `cargo test` has put beside the test.
fn library() -> PathBuf {
    moris_fmu_host::example_library("shared_library_fmi3")
}

/// An instance of the washout, freed when it is dropped.
struct Instance {
    pointer: fmi3::Instance,
    library: Library,
}

impl Instance {
    /// An instance in initialization mode.
    fn new() -> Self {
        let library = Library::open(&library()).unwrap();
        let token = CString::new(Layout::Arrays.token(&moris_interface::guid::<Washout>())).unwrap();
        let instantiate = library.api().instantiate_co_simulation;
        let name = c"washout".as_ptr();
        // SAFETY: the strings live during the call.
        let pointer =
            unsafe { instantiate(name, token.as_ptr(), null(), 0, 0, 0, 0, null(), 0, null_mut(), None, None) };
        assert!(!pointer.is_null());
        // SAFETY: the instance is alive.
        assert_eq!(unsafe { (library.api().enter_initialization_mode)(pointer, 0, 0.0, 0.0, 0, 0.0) }, 0);
        Instance { pointer, library }
    }

    fn api(&self) -> &Api {
        self.library.api()
    }

    fn exit_initialization_mode(&self) {
        // SAFETY: the instance is alive.
        assert_eq!(unsafe { (self.api().exit_initialization_mode)(self.pointer) }, 0);
    }

    fn set(&self, references: &[u32], values: &[f64]) {
        let (count, size) = (references.len(), values.len());
        // SAFETY: the instance is alive, and the arrays are as long as said.
        let status =
            unsafe { (self.api().set_float64)(self.pointer, references.as_ptr(), count, values.as_ptr(), size) };
        assert_eq!(status, 0);
    }

    fn step(&self, time: f64, step: f64) {
        let (mut event, mut terminate, mut early, mut last) = (1, 1, 1, 0.0);
        // SAFETY: the instance is alive, and there is room for the answers.
        let status = unsafe {
            (self.api().do_step)(self.pointer, time, step, 1, &mut event, &mut terminate, &mut early, &mut last)
        };
        assert_eq!((status, event, terminate, early, last), (0, 0, 0, 0, time + step));
    }

    /// The values of every slot, each row got as one variable.
    fn all_values(&self) -> Vec<f64> {
        let firsts = (0..IDENTITY.slots.len()).filter(|&slot| IDENTITY.slots[slot].element == 0);
        firsts.flat_map(|slot| self.row(slot)).collect()
    }

    fn row(&self, slot: usize) -> Vec<f64> {
        let (c, api, reference) = (self.pointer, self.api(), slot as u32);
        let row = IDENTITY.row(slot);
        let size = row.slots();
        let (mut reals, mut integer, mut long, mut boolean) = (vec![f64::NAN; size], 0, 0, 0);
        // SAFETY: the instance is alive, and the arrays are as long as said.
        let status = unsafe {
            match row.kind {
                Kind::Real(_) => (api.get_float64)(c, &reference, 1, reals.as_mut_ptr(), size),
                Kind::Integer => (api.get_int32)(c, &reference, 1, &mut integer, size),
                Kind::Enumeration(_) => (api.get_int64)(c, &reference, 1, &mut long, size),
                Kind::Boolean => (api.get_boolean)(c, &reference, 1, &mut boolean, size),
            }
        };
        assert_eq!(status, 0, "{}", row.name);
        match row.kind {
            Kind::Real(_) => reals,
            Kind::Integer => vec![f64::from(integer)],
            Kind::Enumeration(_) => vec![long as f64],
            Kind::Boolean => vec![f64::from(boolean)],
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the instance is alive, and nobody uses it from here on.
        unsafe { (self.api().free_instance)(self.pointer) }
    }
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn every_variable_can_be_read_and_has_its_start_value() {
    let mut start = vec![0.0; IDENTITY.slots.len()];
    Washout::start_slots(&mut start);
    let instance = Instance::new();
    assert_eq!(bits(&instance.all_values()), bits(&start));
    instance.exit_initialization_mode();
    assert_eq!(bits(&instance.all_values()), bits(&start), "outputs during initialization are those after it");
}

#[test]
fn a_ride_is_the_same_bit_for_bit_as_in_rust() {
    let mut washout = Washout::new(&Parameters::default()).unwrap();
    let instance = Instance::new();
    instance.exit_initialization_mode();
    let variables = ["vehicle.specificForce.x", "vehicle.angularVelocity.x", "vehicle.orientation.roll"];
    let references: Vec<u32> = variables
        .iter()
        .chain(&["vehicle.speed", "rider.lean"])
        .map(|name| IDENTITY.slot(name).unwrap() as u32)
        .collect();
    for step in 0..3000 {
        let time = f64::from(step) * 1e-3;
        let u = swing::values(time);
        instance.set(&references, &u);
        instance.step(time, 1e-3);
        washout.step(&swing::input(&u), 1e-3);
    }
    let output = washout.output();
    let row = |name: &str| bits(&instance.row(IDENTITY.slot(name).unwrap()));
    assert_eq!(row("platform.position.x"), bits(output.position.as_slice()));
    assert_eq!(row("platform.angularVelocity.x"), bits(output.angular_velocity.as_slice()));
    assert_eq!(row("actuator[1].length"), bits(&output.length));
    assert_eq!(row("actuator[1].velocity"), bits(&output.leg_velocity));
    assert_eq!(row("rider.specificForce.x"), bits(output.felt_specific_force.as_slice()));
    assert_eq!(row("tilt.roll"), bits(&[output.tilt_roll]));
    assert_ne!(output.tilt_roll, 0.0);
}
