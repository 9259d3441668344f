//! Communication steps and output derivatives.

use std::ffi::c_int;

use crate::fixture::*;

/// The standard step response 1 - exp(-t / tau), with tau 0.5.
fn response(time: f64) -> f64 {
    1.0 - (-time / 0.5).exp()
}

#[test]
fn the_model_s_closed_form_comes_out() {
    let instance = stepping();
    instance.set_real("u", &[1.0, -2.0, 0.0]);
    for step in 0..100 {
        let time = f64::from(step) * 0.01;
        assert_eq!(instance.do_step(time, 0.01), (OK, time + 0.01));
        let [x, y, z] = instance.real("y");
        let expected = response(time + 0.01);
        assert!((x - expected).abs() < 1e-14 && (y + 2.0 * expected).abs() < 1e-14 && z == 0.0);
        let sum: [f64; 6] = instance.real("sum");
        assert!((sum[5] - (16.0 * x + 17.0 * y)).abs() < 1e-13);
    }
}

#[test]
fn wrong_steps_are_refused_and_nothing_is_lost() {
    let instance = Instance::new();
    assert_eq!(instance.enter_initialization_mode(0.0, Some(10.0)), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(0.0, 0.25).0, OK);
    let before = instance.bytes();
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let cases = [
        (0.25, 0.0, "step size 0"),
        (0.25, -0.1, "step size -0.1"),
        (0.25, nan, "step size NaN"),
        (nan, 0.1, "communication point NaN"),
        (inf, 0.1, "communication point inf"),
        (0.0, 0.1, "present"),
        (0.25, 9.8, "stop time 10"),
    ];
    for (time, step, part) in cases {
        let (status, last) = instance.do_step(time, step);
        instance.assert_call_error(status, ERROR, &["fmi3DoStep", part]);
        assert_eq!(last, 0.25, "the time that was reached");
        assert_eq!(instance.bytes(), before);
    }
    assert_eq!(instance.do_step(0.25, 9.75), (OK, 10.0));
}

#[test]
fn a_panic_is_an_error_and_a_reset_helps() {
    let instance = failed();
    instance.assert_call_error(ERROR, ERROR, &["fmi3DoStep", "internal error", "trapped in step"]);
    instance.real::<3>("y");
    assert_eq!(instance.reset(), OK);
    assert_eq!(instance.enter_initialization_mode(0.0, None), OK);
    assert_eq!(instance.exit_initialization_mode(), OK);
    assert_eq!(instance.do_step(0.0, 0.1).0, OK);
}

fn output_derivatives(instance: &Instance, references: &[u32], orders: &[i32], values: &mut [f64]) -> c_int {
    assert_eq!(references.len(), orders.len());
    let (count, size) = (references.len(), values.len());
    let (references, orders) = (references.as_ptr(), orders.as_ptr());
    // SAFETY: the instance is alive, and the arrays are as long as said.
    unsafe {
        (instance.api().get_output_derivatives)(instance.pointer, references, count, orders, values.as_mut_ptr(), size)
    }
}

#[test]
fn output_derivatives_are_those_of_the_closed_form() {
    let instance = stepping();
    instance.set_real("u", &[1.0, -2.0, 0.0]);
    assert_eq!(instance.do_step(0.0, 0.3).0, OK);
    let [sum, y] = ["sum", "y"].map(reference);
    let mut values = [f64::NAN; 9];
    assert_eq!(output_derivatives(&instance, &[sum, y], &[1, 1], &mut values), OK);
    let slope = (-0.3f64 / 0.5).exp() / 0.5;
    let expected = [-3.0, -6.0, -9.0, -12.0, -15.0, -18.0, 1.0, -2.0, 0.0].map(|factor| factor * slope);
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-13, "{value} {expected}");
    }
}

#[test]
fn only_what_exists_has_derivatives() {
    let instance = stepping();
    let before = instance.bytes();
    let [y, u, count, gain] = ["y", "u", "count", "gain"].map(reference);
    for (wrong, length) in [(u, 3), (count, 1), (gain, 3)] {
        let mut values = vec![-1.0; 3 + length];
        let status = output_derivatives(&instance, &[y, wrong], &[1, 1], &mut values);
        instance.assert_call_error(status, ERROR, &["fmi3GetOutputDerivatives", "has no derivative"]);
        assert!(values.iter().all(|&value| value == -1.0));
    }
    for order in [0, 2, -1] {
        let status = output_derivatives(&instance, &[y], &[order], &mut [0.0; 3]);
        instance.assert_call_error(status, ERROR, &["'y[1]'", "order"]);
    }
    let status = output_derivatives(&instance, &[y], &[1], &mut [0.0; 2]);
    instance.assert_call_error(status, ERROR, &["'y'", "3 values"]);
    assert_eq!(instance.bytes(), before);
}
