//! From the start values to the first step.

use crate::fixture::*;

#[test]
fn an_experiment_that_cannot_be_is_refused() {
    let instance = Instance::new();
    let fresh = instance.bytes();
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for (start, stop) in [(nan, None), (inf, None), (0.0, Some(nan)), (0.0, Some(-inf)), (1.0, Some(0.5))] {
        let status = instance.enter_initialization_mode(start, stop);
        instance.assert_call_error(status, ERROR, &["fmi3EnterInitializationMode", "time"]);
    }
    for tolerance in [-1e-6, nan, inf] {
        // SAFETY: the instance is alive.
        let status = unsafe { (instance.api().enter_initialization_mode)(instance.pointer, 1, tolerance, 0.0, 0, nan) };
        instance.assert_call_error(status, ERROR, &["tolerance"]);
    }
    assert_eq!(instance.bytes(), fresh);
    assert_eq!(instance.enter_initialization_mode(2.0, Some(2.0)), OK);
    assert_eq!(instance.real("time"), [2.0]);
}

#[test]
fn a_host_without_stop_time_or_tolerance_may_say_so_in_numbers() {
    let instance = Instance::new();
    // SAFETY: the instance is alive.
    let status = unsafe { (instance.api().enter_initialization_mode)(instance.pointer, 1, 0.0, 0.0, 1, f64::INFINITY) };
    assert_eq!(status, OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(0.0, 0.1).0, OK);
}

#[test]
fn start_values_can_be_read_and_set_from_the_beginning() {
    let instance = Instance::new();
    assert_eq!(instance.real("gain"), [1.0; 3]);
    assert_eq!(instance.real::<18>("weight"), std::array::from_fn(|k| (k + 1) as f64), "row by row");
    instance.set_real("y0", &[1.0, 2.0, 3.0]);
    assert_eq!(instance.real("y"), [1.0, 2.0, 3.0]);
    assert_eq!(instance.enter_initialization_mode(0.0, None), OK);
    assert_eq!(instance.real("sum"), [14.0, 32.0, 50.0, 68.0, 86.0, 104.0]);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.real("y"), [1.0, 2.0, 3.0]);
}

#[test]
fn a_refused_parameter_can_be_set_again() {
    let instance = initializing();
    instance.set_real("tau", &[0.0]);
    let status = instance.exit_initialization_mode();
    instance.assert_call_error(status, ERROR, &["fmi3ExitInitializationMode", "tau: must be positive"]);
    instance.set_real("tau", &[1.0]);
    assert_eq!(instance.exit_initialization_mode(), OK);
}

#[test]
fn reset_makes_an_instance_as_new() {
    let instance = Instance::new();
    let fresh = instance.bytes();
    instance.set_real("u", &[1.0, 2.0, 3.0]);
    assert_eq!(instance.enter_initialization_mode(0.0, Some(1.0)), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(0.0, 0.5), (OK, 0.5));
    assert_ne!(instance.bytes(), fresh);
    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.bytes(), fresh);
}

#[test]
fn a_doubt_about_parameters_is_a_warning_and_no_failure() {
    for (tau, expected) in [(1000.0, 0), (1001.0, 1)] {
        let instance = initializing();
        instance.set_real("tau", &[tau]);
        assert_eq!(instance.exit_initialization_mode(), OK);
        let messages = instance.messages();
        let is_warning = |(status, category, text): &&Entry| {
            *status == WARNING && category == "logStatusWarning" && text.contains("tau is above 1000 s")
        };
        assert_eq!(messages.iter().filter(is_warning).count(), expected, "{messages:?}");
    }
}
