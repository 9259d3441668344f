//! The washout's library, instances of it, and a simulation.

use std::path::{Path, PathBuf};

use moris_fmu_host::{Fmu, Instance, variables_of};
pub use moris_fmu_tests::swing::values as input;
use moris_interface::{Identity, Model};
use moris_washout::Washout;

pub const IDENTITY: Identity = Washout::IDENTITY;

/// The library, which `cargo test` has put beside the test.
pub fn library() -> PathBuf {
    moris_fmu_host::example_library("shared_library")
}

pub fn open() -> Fmu {
    open_library(&library())
}

pub fn open_library(path: &Path) -> Fmu {
    Fmu::with_variables(path, &moris_interface::guid::<Washout>(), variables_of(&IDENTITY)).unwrap()
}

pub fn initialized(parameters: &[(&str, f64)]) -> Instance {
    let mut instance = open().instantiate("washout").unwrap();
    instance.initialize(parameters, None).unwrap();
    instance
}

/// Where the vehicle's inputs but `engaged` are: nine components, speed and lean.
pub fn real_inputs() -> Vec<u32> {
    let first = IDENTITY.slot("vehicle.specificForce.x").unwrap() as u32;
    (first..first + 11).collect()
}

pub fn all_values(instance: &mut Instance) -> Vec<u64> {
    (0..IDENTITY.slots.len()).map(|slot| instance.get(&IDENTITY.variable_name(slot)).unwrap().to_bits()).collect()
}

/// The value reference of the variable of this name.
pub fn reference(name: &str) -> u32 {
    IDENTITY.slot(name).unwrap() as u32
}

/// Everything about an instance, as bytes.
pub fn bytes(instance: &mut Instance) -> Vec<u8> {
    let state = instance.get_state().unwrap();
    let bytes = instance.serialize(&state).unwrap();
    assert_eq!(instance.free_state(state), moris_fmu_host::Status::Ok);
    bytes
}

/// Simulates `count` steps of 1 ms from step number `from`. Returns the bits of
/// all values at the end.
pub fn ride(instance: &mut Instance, from: u32, count: u32) -> Vec<u64> {
    let references = real_inputs();
    for step in from..from + count {
        let time = f64::from(step) * 1e-3;
        assert_eq!(instance.set_real(&references, &input(time)), moris_fmu_host::Status::Ok);
        instance.step(time, 1e-3).unwrap();
    }
    all_values(instance)
}

#[cfg(target_os = "linux")]
/// Runs an ignored test in a process of its own, which has to succeed.
pub fn run_alone(test: &str) {
    let child = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", test, "--test-threads=1"])
        .output()
        .unwrap();
    let output = String::from_utf8_lossy(&child.stdout);
    assert!(child.status.success() && output.contains("1 passed"), "{output}");
}
