//! The washout through its C functions, against the same washout in Rust.

use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;

use fmu_host::{Api, Fmu, Instance, Status, Variable, VariableKind};
use model_interface::{Identity, Kind, Model};
use moris_washout::interface::RollPitchYaw;
use moris_washout::{Input, Parameters, Washout};
use object::Object;

const IDENTITY: Identity = Washout::IDENTITY;

/// The library, which `cargo test` has put beside the test.
fn library() -> PathBuf {
    let name = format!("{}shared_library{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let test = std::env::current_exe().unwrap();
    let path = test.parent().and_then(|deps| deps.parent()).unwrap().join("examples").join(name);
    assert!(
        path.is_file(),
        "{} is missing: run `cargo test` without choosing a target, or `cargo build --examples`",
        path.display()
    );
    path
}

fn open() -> Fmu {
    let variable = |slot: usize| {
        let kind = match IDENTITY.row(slot).kind {
            Kind::Real(_) => VariableKind::Real,
            Kind::Integer => VariableKind::Integer,
            Kind::Boolean => VariableKind::Boolean,
            Kind::Enumeration(_) => VariableKind::Enumeration,
        };
        (IDENTITY.variable_name(slot), Variable { value_reference: slot as u32, kind })
    };
    let variables: HashMap<_, _> = (0..IDENTITY.slots.len()).map(variable).collect();
    Fmu::with_variables(&library(), &model_interface::guid::<Washout>(), variables).unwrap()
}

fn initialized(parameters: &[(&str, f64)]) -> Instance {
    let mut instance = open().instantiate("washout").unwrap();
    instance.initialize(parameters, None).unwrap();
    instance
}

/// Where the vehicle's inputs but `engaged` are: nine components, speed and lean.
fn real_inputs() -> Vec<u32> {
    let first = IDENTITY.slot("vehicle.specificForce.x").unwrap() as u32;
    (first..first + 11).collect()
}

/// A ride that shakes every axis.
fn input(time: f64) -> [f64; 11] {
    let mut input = std::array::from_fn(|k| (0.3 + 0.1 * k as f64) * ((1.0 + 0.7 * k as f64) * time).sin());
    input[2] += 9.80665;
    input
}

fn all_values(instance: &mut Instance) -> Vec<u64> {
    (0..IDENTITY.slots.len()).map(|slot| instance.get(&IDENTITY.variable_name(slot)).unwrap().to_bits()).collect()
}

#[test]
fn every_variable_can_be_read_and_has_its_start_value() {
    let mut start = vec![0.0; IDENTITY.slots.len()];
    Washout::start(&mut start);
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

        let rust_input = Input {
            specific_force: [u[0], u[1], u[2]].into(),
            angular_velocity: [u[3], u[4], u[5]].into(),
            orientation: RollPitchYaw::new(u[6], u[7], u[8]),
            speed: u[9],
            lean: u[10],
            engaged: true,
        };
        washout.step(&rust_input, 1e-3);
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
    let references = real_inputs();
    let ride = |instance: &mut Instance, from: u32| {
        for step in from..from + 500 {
            let time = f64::from(step) * 1e-3;
            assert_eq!(instance.set_real(&references, &input(time)), Status::Ok);
            instance.step(time, 1e-3).unwrap();
        }
        all_values(instance)
    };
    ride(&mut instance, 0);
    let state = instance.get_state().unwrap();
    let bytes = instance.serialize(&state).unwrap();
    let expected = ride(&mut instance, 500);
    assert_eq!(instance.set_state(&state), Status::Ok);
    assert_eq!(ride(&mut instance, 500), expected);

    let mut other = open().instantiate("other").unwrap();
    let read = other.deserialize(&bytes).unwrap();
    assert_eq!(other.set_state(&read), Status::Ok);
    assert_eq!(ride(&mut other, 500), expected);
    assert_eq!(other.free_state(read), Status::Ok);
    assert_eq!(instance.free_state(state), Status::Ok);
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
