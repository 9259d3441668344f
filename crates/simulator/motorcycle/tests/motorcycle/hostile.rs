//! Whatever it is fed, the motorcycle stays upright and its numbers finite.

use moris_interface::{Group, Writer, slot_count};
use moris_motorcycle::{Input, Model, Output, Parameters};
use nalgebra::Vector3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::common::{at_speed, motorcycle};

/// Numbers of every size, and those that are none.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..2.0_f64,
        2 => -1e4..1e4_f64,
        1 => Just(0.0),
        1 => Just(1e300),
        1 => Just(-1e300),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
    ]
}

/// Factors on a parameter.
fn factor() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.5..2.0_f64, 2 => 0.01..100.0_f64, 1 => Just(1e-9), 1 => Just(1e9), 1 => Just(0.0)]
}

fn input() -> impl Strategy<Value = Input> {
    (number(), number(), number(), number(), [number(), number(), number()]).prop_map(
        |(throttle, brake, lean, rider_lean, wind)| Input {
            throttle,
            brake,
            lean,
            rider_lean,
            wind: Vector3::from(wind),
        },
    )
}

fn assert_sane(output: &Output) {
    let mut values = [0.0; slot_count(Output::ROWS)];
    output.write(&mut Writer::new(&mut values));
    assert!(values.iter().all(|value| value.is_finite()), "{output:?}");
    assert!(output.speed >= 0.0 && output.speed < 150.0, "{}", output.speed);
    assert!(output.orientation.roll.abs() < 1.5, "roll {}", output.orientation.roll);
    assert!(output.orientation.pitch.abs() < 1.0, "pitch {}", output.orientation.pitch);
    assert!(output.specific_force.norm() < 1e3, "{}", output.specific_force);
    assert!(output.front_load >= 0.0 && output.rear_load >= 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::cases::cases(128, 16), rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn no_input_makes_it_fall_or_fly(
        speed in 0.0..100.0_f64,
        inputs in prop::collection::vec((input(), 1_u32..1500), 1..30),
    ) {
        let mut vehicle = motorcycle(&at_speed(speed));
        for (input, steps) in inputs {
            for _ in 0..steps {
                vehicle.step(&input, 0.002);
                assert_sane(&vehicle.output());
            }
        }
        // Left alone, it comes to rest.
        for _ in 0..4000 {
            vehicle.step(&Input { brake: 0.5, ..Input::default() }, 0.005);
        }
        let output = vehicle.output();
        prop_assert_eq!(output.speed, 0.0);
        prop_assert!((output.specific_force - Vector3::new(0.0, 0.0, 9.80665)).norm() < 1e-3, "{:?}", output);
    }

    #[test]
    fn parameters_are_refused_or_ridden(
        changes in prop::collection::vec((0..slot_count(Parameters::ROWS), factor()), 1..4),
    ) {
        let mut values = [0.0; slot_count(Parameters::ROWS)];
        Parameters::default().write(&mut Writer::new(&mut values));
        for (place, factor) in changes {
            values[place] *= factor;
        }
        let parameters = Parameters::read(&mut moris_interface::Reader::new(&values));
        if let Ok(mut vehicle) = moris_motorcycle::Motorcycle::new(&parameters, &Input::default()) {
            for k in 0..6000 {
                let throttle = if k < 3000 { 0.5 } else { 0.0 };
                let brake = if k < 4000 { 0.0 } else { 0.5 };
                let lean = 0.3 * (0.002 * f64::from(k)).sin();
                vehicle.step(&Input { throttle, brake, lean, ..Input::default() }, 0.001);
                let output = vehicle.output();
                prop_assert!(output.specific_force.norm().is_finite() && output.orientation.roll.abs() < 1.5, "{:?}", output);
            }
        }
    }
}
