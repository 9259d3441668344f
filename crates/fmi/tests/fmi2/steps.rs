//! Communication steps.

use moris_fmu_host::Status;

use crate::fixture::*;

/// The standard step response 1 - exp(-t / tau), with tau 0.5.
fn response(time: f64) -> f64 {
    1.0 - (-time / 0.5).exp()
}

#[test]
fn the_model_s_closed_form_comes_out() {
    let mut instance = stepping(&[]);
    instance.set("u", 1.0).unwrap();
    for step in 0..100 {
        instance.step(f64::from(step) * 0.01, 0.01).unwrap();
        let expected = response(f64::from(step + 1) * 0.01);
        assert!((instance.get("y").unwrap() - expected).abs() < 1e-14);
        assert_eq!(instance.get("count").unwrap(), f64::from(step + 1));
        assert_eq!(instance.get("rising").unwrap(), 1.0);
    }
    instance.set("method", 2.0).unwrap();
    instance.step(1.0, 0.1).unwrap();
    let expected = response(1.0) + 0.1 * (1.0 - response(1.0)) / 0.5;
    assert!((instance.get("y").unwrap() - expected).abs() < 1e-14);
    assert_eq!(instance.get("methodUsed").unwrap(), 2.0);
}

#[test]
fn wrong_steps_are_refused_and_nothing_is_lost() {
    let mut instance = instantiated();
    instance.initialize(&[], Some(10.0)).unwrap();
    instance.set("u", 1.0).unwrap();
    instance.step(0.0, 0.25).unwrap();
    assert_eq!(instance.set_real_input_derivatives(&[reference("u")], &[1.0]), Status::Ok);
    let before = bytes(&mut instance);
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let cases: [(f64, f64, &str); 14] = [
        (0.25, 0.0, "step size 0"),
        (0.25, -0.0, "step size -0"),
        (0.25, -0.1, "step size -0.1"),
        (0.25, nan, "step size NaN"),
        (0.25, inf, "step size inf"),
        (0.25, 1.01, "longest"),
        (nan, 0.1, "communication point NaN"),
        (inf, 0.1, "communication point inf"),
        (-inf, 0.1, "communication point -inf"),
        (0.0, 0.1, "present"),
        (0.35, 0.1, "present"),
        (0.25 + 1e-6, 0.1, "present"),
        (-0.25, 0.1, "present"),
        (9.5, 0.6, "stop time 10"),
    ];
    for (time, step, part) in cases {
        let status = instance.do_step(time, step);
        assert_call_error(&instance, status, Status::Error, &["fmi2DoStep", part]);
        assert_eq!(bytes(&mut instance), before, "{time} {step}");
    }
    instance.step(0.25, 0.1).unwrap();
}

#[test]
fn the_stop_time_is_reached_and_not_passed() {
    let mut instance = instantiated();
    instance.initialize(&[], Some(1.0)).unwrap();
    // Sums of 0.1 end a unit in the last place beside 1.
    let mut time = 0.0;
    for _ in 0..10 {
        instance.step(time, 0.1).unwrap();
        time += 0.1;
    }
    let status = instance.do_step(time, 1e-6);
    assert_call_error(&instance, status, Status::Error, &["stop time 1"]);
}

#[test]
fn time_is_the_host_s_however_it_reckons() {
    let h = 1e-3;
    let mut by_product = stepping(&[]);
    let mut by_sum = stepping(&[]);
    let sum = (0..100_000).fold(0.0, |time, _| {
        by_sum.step(time, h).unwrap();
        time + h
    });
    by_product.steps(100_000, h).unwrap();
    assert_eq!(by_product.get("time").unwrap(), 99_999.0 * h + h);
    assert_eq!(by_sum.get("time").unwrap(), sum);
}

#[test]
fn steps_may_vary() {
    let mut instance = stepping(&[]);
    instance.set("u", 1.0).unwrap();
    let mut time = 0.0;
    for step in [1e-9, 0.3, 1.0, 1e-4, 0.5] {
        instance.step(time, step).unwrap();
        time += step;
        assert!((instance.get("y").unwrap() - response(time)).abs() < 1e-12);
    }
}

/// Times of a host in single precision: by product and by sum.
fn single_times(start: f32, step: f32, count: usize) -> [Vec<f64>; 2] {
    let product = (0..count).map(|k| f64::from(start + k as f32 * step)).collect();
    let sum = std::iter::successors(Some(start), |time| Some(time + step)).take(count).map(f64::from).collect();
    [product, sum]
}

#[test]
fn a_host_in_single_precision_steps_for_as_long_as_its_times_differ() {
    for (start, step) in [(0.0, 0.01), (0.0, 1.0 / 60.0), (1000.0, 0.001), (50_000.0, 0.01), (100_000.0, 1.0 / 60.0)] {
        for times in single_times(start, step, 3000) {
            let mut instance = instantiated();
            assert_eq!(instance.setup_experiment(f64::from(start), None), Status::Ok);
            assert_eq!(instance.enter_initialization_mode(), Status::Ok);
            assert_eq!(instance.exit_initialization_mode(), Status::Ok);
            for &time in &times {
                instance.step(time, f64::from(step)).unwrap();
            }
        }
    }
}

#[test]
fn the_stop_time_in_single_precision_is_reached() {
    let (stop, step) = (10.0f32, 0.01f32);
    let [product, _] = single_times(0.0, step, 1000);
    let mut instance = instantiated();
    instance.initialize(&[], Some(f64::from(stop))).unwrap();
    for time in product {
        instance.step(time, f64::from(step)).unwrap();
    }
}

#[test]
fn a_repeated_or_omitted_step_is_refused_at_any_time_of_single_precision() {
    // The last is a calendar's time, a multiple of the 128 s between numbers of single precision.
    for (start, step) in [(0.0, 0.01), (20_000.0, 0.01), (1_700_000_000.0 - 1_700_000_000.0 % 128.0, 0.01)] {
        let mut instance = instantiated();
        assert_eq!(instance.setup_experiment(start, None), Status::Ok);
        assert_eq!(instance.enter_initialization_mode(), Status::Ok);
        assert_eq!(instance.exit_initialization_mode(), Status::Ok);
        instance.step(start, step).unwrap();
        for wrong in [start, start + 2.0 * step] {
            let status = instance.do_step(wrong, step);
            assert_call_error(&instance, status, Status::Error, &["fmi2DoStep", "present"]);
        }
        instance.step(start + step, step).unwrap();
    }
}
