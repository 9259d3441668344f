//! A step allocates no memory, whatever happens in it.

use moris_stewart_platform::{Input, Model, Parameters, StewartPlatform};

/// Commands that make drives, forces and stops act.
fn input(k: usize) -> Input {
    let t = k as f64 * 0.001;
    let swing = |i: usize| 0.35 * (5.0 * t + i as f64).sin() + if k % 700 < 350 { 0.2 } else { -0.2 };
    Input {
        length: std::array::from_fn(|i| 1.3 + swing(i)),
        velocity: [f64::NAN; 6],
        lean: t.sin(),
        ..Input::default()
    }
}

#[test]
fn a_step_allocates_nothing() {
    let mut parameters = Parameters::default();
    parameters.actuators.force_limit = 800.0;
    let mut platform = StewartPlatform::new(&parameters, &Input::default()).unwrap();
    let (mut drive, mut force, mut stop) = (false, false, false);
    let count = allocation_counter::measure(|| {
        for k in 0..5000 {
            platform.step(&input(k), 0.001);
            platform.step_between(&input(k), &input(k + 1), 0.0007 + 1e-7 * k as f64);
            let output = platform.output();
            let _ = std::hint::black_box(platform.output_derivative());
            drive |= output.drive_limited;
            force |= output.force_limited;
            stop |= output.at_stop;
        }
    })
    .count_total;
    assert!(drive && force && stop, "the ride must be rough enough: {drive} {force} {stop}");
    assert_eq!(count, 0);
}
