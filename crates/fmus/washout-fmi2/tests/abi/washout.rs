//! The washout through its C functions, against the same washout in Rust.

use std::collections::BTreeSet;

use moris_fmu_host::{Api, Status};
use moris_fmu_tests::swing;
use moris_interface::SlotModel;
use moris_washout::{Parameters, Washout, presets};
use object::Object;

use crate::fixture::*;

#[test]
fn every_variable_can_be_read_and_has_its_start_value() {
    let mut start = vec![0.0; IDENTITY.slots.len()];
    Washout::start_slots(&mut start);
    let mut instance = open().instantiate("washout").unwrap();
    assert_eq!(instance.setup_experiment(0.0, None), Status::Ok);
    assert_eq!(instance.enter_initialization_mode(), Status::Ok);
    let start: Vec<_> = start.iter().map(|value| value.to_bits()).collect();
    assert_eq!(all_values(&mut instance), start);
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
    assert_eq!(all_values(&mut instance), start, "outputs during initialization are those after it");
}

#[test]
fn a_ride_is_the_same_bit_for_bit_as_in_rust() {
    let mut washout = Washout::new(&Parameters::default()).unwrap();
    let mut instance = initialized(&[]);
    let references = real_inputs();
    for step in 0..3000 {
        let time = f64::from(step) * 1e-3;
        let u = input(time);
        assert_eq!(instance.set_real(&references, &u), Status::Ok);
        instance.step(time, 1e-3).unwrap();
        washout.step(&swing::input(&u), 1e-3);
    }
    let output = washout.output();
    let expected = [
        ("platform.position.x", output.position.x),
        ("platform.velocity.y", output.velocity.y),
        ("platform.orientation.pitch", output.orientation.pitch),
        ("actuator[1].length", output.length[0]),
        ("actuator[6].velocity", output.leg_velocity[5]),
        ("rider.specificForce.z", output.felt_specific_force.z),
        ("tilt.roll", output.tilt_roll),
    ];
    for (name, value) in expected {
        assert_eq!(instance.get(name).unwrap().to_bits(), value.to_bits(), "{name}");
        assert_ne!(value, 0.0, "{name}");
    }
}

#[test]
fn a_restored_state_repeats_bit_for_bit() {
    let mut instance = initialized(&[("splitter.x.omega1", 1.5)]);
    ride(&mut instance, 0, 500);
    let state = instance.get_state().unwrap();
    let bytes = instance.serialize(&state).unwrap();
    let expected = ride(&mut instance, 500, 500);
    assert_eq!(instance.set_state(&state), Status::Ok);
    assert_eq!(ride(&mut instance, 500, 500), expected);

    let mut other = open().instantiate("other").unwrap();
    let read = other.deserialize(&bytes).unwrap();
    assert_eq!(other.set_state(&read), Status::Ok);
    assert_eq!(ride(&mut other, 500, 500), expected);
    assert_eq!(other.free_state(read), Status::Ok);
    assert_eq!(instance.free_state(state), Status::Ok);
}

/// A new plan is begun every 50 ms and takes several steps.
#[test]
fn a_state_serialized_at_any_instant_of_a_plan_repeats_bit_for_bit() {
    const END: u32 = 640;
    for set in ["", presets::OPTIMAL, presets::ADAPTIVE] {
        let mut instance = initialized(&presets::values(set));
        ride(&mut instance, 0, 500);
        let states: Vec<_> = (500..560)
            .map(|step| {
                let state = bytes(&mut instance);
                ride(&mut instance, step, 1);
                (step, state)
            })
            .collect();
        let expected = ride(&mut instance, 560, END - 560);
        let mut other = open().instantiate("other").unwrap();
        for (step, bytes) in states {
            let state = other.deserialize(&bytes).unwrap();
            assert_eq!(other.set_state(&state), Status::Ok);
            assert_eq!(other.free_state(state), Status::Ok);
            assert_eq!(ride(&mut other, step, END - step), expected, "{set} from step {step}");
        }
    }
}

#[test]
fn a_rig_that_cannot_be_is_refused_and_can_be_set_right() {
    let mut instance = open().instantiate("washout").unwrap();
    assert!(instance.initialize(&[("actuator.minLength", 1.7)], None).is_err());
    let message = instance.messages().pop().unwrap();
    assert!(message.text.contains("actuator.minLength"), "{}", message.text);
    instance.set("actuator.minLength", 1.0).unwrap();
    assert_eq!(instance.exit_initialization_mode(), Status::Ok);
}

#[test]
fn a_tunable_parameter_that_cannot_be_is_discarded_during_the_ride() {
    let mut instance = initialized(&[]);
    let rate_limit = [IDENTITY.slot("tilt.rateLimit").unwrap() as u32];
    let before = instance.get("tilt.rateLimit").unwrap();
    assert_eq!(instance.set_real(&rate_limit, &[-1.0]), Status::Discard);
    assert!(instance.messages().pop().unwrap().text.contains("tilt.rateLimit"));
    assert_eq!(instance.get("tilt.rateLimit").unwrap(), before);
    assert_eq!(instance.set_real(&rate_limit, &[0.1]), Status::Ok);
    instance.step(0.0, 1e-3).unwrap();
}

#[test]
fn the_library_exports_the_standard_s_functions_and_nothing_else() {
    let bytes = std::fs::read(library()).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    let exports = file.exports().unwrap();
    let exported: BTreeSet<_> =
        exports.iter().map(|export| std::str::from_utf8(export.name()).unwrap().trim_start_matches('_')).collect();
    assert_eq!(exported, Api::SYMBOLS.iter().copied().collect());
}
