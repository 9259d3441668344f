//! Panics of the model, which do not leave the library.

use std::process::Command;

use moris_fmu_host::{Instance, Status};

use crate::fixture::*;

/// Asserts that the model has panicked, and that the instance can still be read and reset.
fn assert_failed(instance: &mut Instance, status: Status, parts: &[&str]) {
    assert_call_error(instance, status, Status::Error, parts);
    let status = instance.do_step(0.0, 0.1);
    assert_call_error(instance, status, Status::Error, &["fmi2DoStep", "'error'"]);
    instance.get("y").unwrap();
    assert_eq!(instance.reset(), Status::Ok);
    instance.initialize(&[], None).unwrap();
    instance.step(0.0, 0.1).unwrap();
}

#[test]
fn a_panic_is_an_error_with_a_message_wherever_the_model_is_called() {
    let mut instance = initializing();
    instance.set("trap", 1.0).unwrap();
    let status = instance.exit_initialization_mode();
    assert_failed(&mut instance, status, &["fmi2ExitInitializationMode", "internal error", "trapped in new"]);

    let mut instance = initializing();
    instance.set("trap", 1.0).unwrap();
    let status = instance.get_real(&[reference("y")], &mut [0.0]);
    assert_failed(&mut instance, status, &["fmi2GetReal", "trapped in new"]);

    let mut instance = stepping(&[]);
    let status = instance.set_integer(&[reference("trap")], &[2]);
    assert_failed(&mut instance, status, &["fmi2SetInteger", "trapped in retune"]);

    let mut instance = stepping(&[("trap", 3.0)]);
    let status = instance.do_step(0.0, 0.1);
    assert_failed(&mut instance, status, &["fmi2DoStep", "trapped in step"]);
}

#[test]
fn a_state_from_before_the_panic_can_be_restored() {
    let mut instance = stepping(&[]);
    let state = instance.get_state().unwrap();
    instance.set("trap", 3.0).unwrap();
    assert_eq!(instance.do_step(0.0, 0.1), Status::Error);
    assert_eq!(instance.set_state(&state), Status::Ok);
    instance.step(0.0, 0.1).unwrap();
    assert_eq!(instance.free_state(state), Status::Ok);
}

/// Run in a separate process, whose output streams [`a_panic_prints_nothing`] reads.
#[test]
#[ignore = "a part of a_panic_prints_nothing, which runs it"]
fn panic_in_a_process_of_its_own() {
    failed();
}

#[test]
fn a_panic_prints_nothing() {
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "panics::panic_in_a_process_of_its_own", "--nocapture", "--test-threads=1"])
        .output()
        .unwrap();
    assert!(child.status.success());
    let output = String::from_utf8(child.stdout).unwrap();
    assert!(output.contains("1 passed"), "{output}");
    assert!(!output.contains("trapped"), "{output}");
    assert_eq!(String::from_utf8(child.stderr).unwrap(), "");
}

/// The library has a panic hook of its own. The hook of a host written in Rust, such as
/// this test, is unchanged.
#[test]
fn the_host_s_panics_are_still_its_own() {
    failed();
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "panics::panic_of_the_host", "--nocapture", "--test-threads=1"])
        .output()
        .unwrap();
    assert!(!child.status.success());
    assert!(String::from_utf8(child.stderr).unwrap().contains("the host's own"));
}

#[test]
#[ignore = "a part of the_host_s_panics_are_still_its_own, which runs it"]
fn panic_of_the_host() {
    failed();
    panic!("the host's own");
}
