//! Derivatives of inputs and outputs.

use moris_fmu_host::Status;

use crate::fixture::*;

/// A ramp u = t gives y = t - tau + tau exp(-t / tau), exactly, if the slope is known.
#[test]
fn an_input_s_derivative_holds_for_one_step() {
    let tau = 0.5;
    let mut instance = stepping(&[]);
    let u = [reference("u")];
    for step in 0..10 {
        let time = f64::from(step) * 0.1;
        assert_eq!(instance.set_real(&u, &[time]), Status::Ok);
        assert_eq!(instance.set_real_input_derivatives(&u, &[1.0]), Status::Ok);
        instance.step(time, 0.1).unwrap();
        let end = time + 0.1;
        let expected = end - tau + tau * (-end / tau).exp();
        assert!((instance.get("y").unwrap() - expected).abs() < 1e-14);
        let mut derivative = [0.0];
        assert_eq!(instance.get_real_output_derivatives(&[reference("y")], &mut derivative), Status::Ok);
        assert!((derivative[0] - (1.0 - (-end / tau).exp())).abs() < 1e-13);
    }
    // Without a derivative, the input is held.
    let y = instance.get("y").unwrap();
    assert_eq!(instance.set_real(&u, &[1.0]), Status::Ok);
    instance.step(1.0, 0.1).unwrap();
    let expected = 1.0 + (y - 1.0) * (-0.1f64 / tau).exp();
    assert!((instance.get("y").unwrap() - expected).abs() < 1e-14);
}

#[test]
fn derivatives_can_be_given_before_the_first_step() {
    let mut instance = initializing();
    assert_eq!(instance.set_real_input_derivatives(&[reference("u")], &[2.0]), Status::Ok);
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
    instance.step(0.0, 1.0).unwrap();
    let expected = 2.0 * (1.0 - 0.5 + 0.5 * (-2.0f64).exp());
    assert!((instance.get("y").unwrap() - expected).abs() < 1e-14);
}

#[test]
fn only_what_exists_has_derivatives() {
    let mut instance = stepping(&[]);
    let before = bytes(&mut instance);
    let u = reference("u");
    for name in ["time", "offset", "frozen", "y", "gain", "tau"] {
        let status = instance.set_real_input_derivatives(&[u, reference(name)], &[1.0, 1.0]);
        assert_call_error(&instance, status, Status::Error, &["fmi2SetRealInputDerivatives", &format!("'{name}'")]);
    }
    for name in ["time", "u", "count", "rising", "methodUsed", "gain"] {
        let mut values = [-1.0, -1.0];
        let status = instance.get_real_output_derivatives(&[reference("y"), reference(name)], &mut values);
        assert_call_error(&instance, status, Status::Error, &["fmi2GetRealOutputDerivatives", &format!("'{name}'")]);
        assert_eq!(values, [-1.0, -1.0]);
    }
    assert_eq!(instance.set_real_input_derivatives(&[u, 999], &[1.0, 1.0]), Status::Error);
    for value in [f64::NAN, f64::INFINITY] {
        let status = instance.set_real_input_derivatives(&[u, u], &[1.0, value]);
        assert_call_error(&instance, status, Status::Discard, &["'u'"]);
    }
    for order in [0, 2, -1] {
        // SAFETY: the component is alive, and the pointers lead to one element.
        let (set, get) = unsafe {
            let (c, api) = (instance.component(), instance.api());
            let set = (api.set_real_input_derivatives)(c, &u, 1, &order, &1.0);
            (set, (api.get_real_output_derivatives)(c, &reference("y"), 1, &order, &mut 0.0))
        };
        assert_eq!((set, get), (3, 3));
        assert!(last_message(&instance).text.contains("order"));
    }
    assert_eq!(bytes(&mut instance), before);
}
