//! From the start values to the first step.

use moris_fmu_host::{Instance, Status};

use crate::fixture::*;

#[test]
fn an_experiment_that_cannot_be_is_refused() {
    let mut instance = instantiated();
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let cases = [(nan, None), (inf, None), (-inf, None), (0.0, Some(nan)), (0.0, Some(-inf)), (1.0, Some(0.5))];
    for (start, stop) in cases {
        let status = instance.setup_experiment(start, stop);
        assert_call_error(&instance, status, Status::Error, &["fmi2SetupExperiment", "time"]);
    }
    let (c, api) = (instance.component(), instance.api());
    for tolerance in [-1e-6, nan, inf] {
        // SAFETY: the component is alive.
        let status = unsafe { (api.setup_experiment)(c, 1, tolerance, 0.0, 0, nan) };
        assert_call_error(&instance, status.into(), Status::Error, &["tolerance"]);
    }
    // SAFETY: the component is alive. What is not defined does not matter.
    assert_eq!(unsafe { (api.setup_experiment)(c, 0, nan, 0.0, 0, nan) }, 0);
    // SAFETY: the component is alive.
    assert_eq!(unsafe { (api.setup_experiment)(c, 1, 1e-6, 2.0, 1, 2.0) }, 0);
    assert_eq!(instance.enter_initialization_mode(), Status::Ok);
    assert_eq!(instance.get("time").unwrap(), 2.0);
}

#[test]
fn a_host_without_stop_time_or_tolerance_may_say_so_in_numbers() {
    let mut instance = instantiated();
    let (c, api) = (instance.component(), instance.api());
    // SAFETY: the component is alive.
    assert_eq!(unsafe { (api.setup_experiment)(c, 1, 0.0, 0.0, 1, f64::INFINITY) }, 0);
    assert_eq!(instance.enter_initialization_mode(), Status::Ok);
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
    instance.steps(100, 1.0).unwrap();
}

#[test]
fn outputs_during_initialization_are_those_after_it() {
    let mut instance = initializing();
    assert_eq!(instance.get("y").unwrap(), 0.0);
    instance.set("y0", 3.0).unwrap();
    assert_eq!(instance.get("y").unwrap(), 3.0);
    instance.set("y0", 4.0).unwrap();
    assert_eq!(instance.get("y").unwrap(), 4.0);
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
    assert_eq!(instance.get("y").unwrap(), 4.0);
}

#[test]
fn values_set_before_initialization_count() {
    let mut instance = instantiated();
    for (name, value) in [("y0", 3.0), ("u", 2.0), ("gain", 5.0)] {
        instance.set(name, value).unwrap();
    }
    instance.initialize(&[], None).unwrap();
    assert_eq!(["y", "u", "gain"].map(|name| instance.get(name).unwrap()), [3.0, 2.0, 5.0]);
}

#[test]
fn a_refused_parameter_can_be_set_again() {
    let mut instance = initializing();
    instance.set("y0", 3.0).unwrap();
    assert_eq!(instance.get("y").unwrap(), 3.0);
    instance.set("tau", 0.0).unwrap();
    instance.set("y0", 5.0).unwrap();
    assert_eq!(instance.get("y").unwrap(), 3.0, "outputs stay while a parameter is refused");
    for _ in 0..2 {
        let status = instance.exit_initialization_mode();
        let parts = ["fmi2ExitInitializationMode", "tau: must be positive", "try again"];
        assert_call_error(&instance, status, Status::Error, &parts);
    }
    instance.set("tau", 1.0).unwrap();
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
    assert_eq!(instance.get("y").unwrap(), 5.0);
}

/// All that can be got, after a run of a few steps.
fn run(instance: &mut Instance) -> Vec<f64> {
    instance.initialize(&[("tau", 0.3)], Some(1.0)).unwrap();
    instance.set("u", 1.0).unwrap();
    instance.steps(3, 0.1).unwrap();
    (0..IDENTITY.slots.len()).map(|slot| instance.get(&IDENTITY.variable_name(slot)).unwrap()).collect()
}

#[test]
fn reset_makes_an_instance_as_new() {
    let mut instance = instantiated();
    let fresh = bytes(&mut instance);
    let first = run(&mut instance);
    assert_ne!(bytes(&mut instance), fresh);
    assert_eq!(instance.reset(), Status::Ok);
    assert_eq!(bytes(&mut instance), fresh);
    assert_eq!(run(&mut instance), first);
}

#[test]
fn a_doubt_about_parameters_is_a_warning_and_no_failure() {
    for (tau, count) in [(1000.0, 0), (1001.0, 1)] {
        let mut instance = initializing();
        instance.set("tau", tau).unwrap();
        assert_eq!(instance.exit_initialization_mode(), Status::Ok);
        let messages = instance.messages();
        let warnings: Vec<_> = messages.iter().filter(|message| message.category == "logStatusWarning").collect();
        assert_eq!(warnings.len(), count, "{messages:?}");
        assert!(warnings.iter().all(|message| message.text.contains("tau is above 1000 s")));
    }
}

/// The texts of the warnings so far.
fn warnings(instance: &Instance) -> Vec<String> {
    let messages = instance.messages().into_iter().filter(|message| message.category == "logStatusWarning");
    messages.map(|message| message.text).collect()
}

#[test]
fn the_second_steps_input_is_checked_and_no_other_one() {
    let mut instance = initializing();
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
    instance.set("u", 13.0).unwrap();
    assert!(warnings(&instance).is_empty());
    instance.steps(3, 0.1).unwrap();
    assert_eq!(warnings(&instance), ["fmi2DoStep: u is 13 at first"]);
    // Hosts that connect inputs after the first step, and inputs that change later.
    let mut instance = stepping(&[("u", 13.0)]);
    for (k, u) in [13.0, 1.0, 13.0, 13.0].into_iter().enumerate() {
        instance.set("u", u).unwrap();
        instance.step(0.1 * k as f64, 0.1).unwrap();
    }
    assert!(warnings(&instance).is_empty());
}

#[test]
fn a_parameter_changed_between_steps_is_warned_of_once() {
    let mut instance = stepping(&[]);
    for gain in [2.0, 2e3, 2e3, 3e3] {
        instance.set("gain", gain).unwrap();
        instance.steps(1, 0.1).ok();
    }
    assert_eq!(warnings(&instance), ["fmi2SetReal: gain is 2000, but the usual range is 0.1 to 1000"]);
    // Hosts write all parameters again: what is there already is no change.
    let mut instance = stepping(&[("gain", 2e3)]);
    instance.set("gain", 2e3).unwrap();
    assert!(warnings(&instance).is_empty());
}
