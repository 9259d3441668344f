//! The washout as a model: what a host of the model calls is the washout itself.

use moris_interface::{Group, MOST_INTERNAL_STEPS, Model, SlotModel};
use moris_washout::interface::{Inputs, TuningGroup};
use moris_washout::{Input, Parameters, Preview, Washout, presets};

use crate::common::random::Random;

const STEP: f64 = 0.01;

/// A force with a preview of what is to come, at random.
fn inputs(random: &mut Random) -> Inputs {
    let mut vehicle = Input { lean: random.between(-0.3, 0.3), ..Input::default() };
    vehicle.specific_force.x = random.between(-3.0, 3.0);
    let surge = std::array::from_fn(|_| random.between(-3.0, 3.0));
    Inputs { vehicle, preview: Preview { count: 10, surge, ..Preview::default() } }
}

#[test]
fn each_function_of_the_model_is_the_washouts() {
    let mut parameters = presets::parameters(presets::PREVIEW);
    let mut random = Random::new(1);
    let first = inputs(&mut random);
    let mut washout = Washout::new(&parameters).unwrap().starting_with(&first.vehicle);
    let mut model = <Washout as Model>::new(&parameters, &first).unwrap();
    assert_eq!(Model::output(&model), washout.output());
    assert_ne!(Model::output(&model), Washout::new(&parameters).unwrap().output(), "the head leans");
    for k in 0..300 {
        let (start, end) = (inputs(&mut random), inputs(&mut random));
        washout.preview(&start.preview);
        if k % 2 == 0 {
            Model::step_between(&mut model, &start, &end, STEP);
            washout.step_between(&start.vehicle, &end.vehicle, STEP);
        } else {
            Model::step(&mut model, &start, STEP);
            washout.step(&start.vehicle, STEP);
        }
        if k == 150 {
            parameters.tilt.rate_limit *= 0.5;
            Model::retune(&mut model, &parameters).unwrap();
            washout.retune(&parameters).unwrap();
        }
        assert_eq!(Model::output(&model), washout.output(), "step {k}");
        assert_eq!(Model::output_derivative(&model), washout.output_derivative(), "step {k}");
    }
    assert!(washout.output().position.x.abs() > 1e-3, "the platform moved");
}

#[test]
fn the_longest_communication_step_is_the_most_internal_steps() {
    let mut parameters = presets::parameters("");
    parameters.structure.max_step = 0.004;
    let model = <Washout as Model>::new(&parameters, &Inputs::default()).unwrap();
    assert_eq!(model.max_communication_step(), MOST_INTERNAL_STEPS * 0.004);
}

#[test]
fn each_row_that_is_tuned_is_in_a_group_and_has_a_usual_range_above_zero() {
    let is_of = |group: &str| TuningGroup::ALL.iter().any(|known| known.name() == group);
    assert!(Parameters::ROWS.iter().filter_map(|row| row.tuning_group).all(is_of));
    for group in TuningGroup::ALL {
        let in_group = || Parameters::ROWS.iter().filter(|row| row.tuning_group == Some(group.name()));
        let ranges = in_group().filter_map(|row| row.usual);
        assert!(*group == TuningGroup::Order || ranges.clone().count() > 0, "{group:?}");
        assert!(in_group().count() > 0 && ranges.into_iter().all(|(least, _)| least > 0.0), "{group:?}");
    }
}

/// Doubts about the first input with these variables set, after `gravityRemoval` as a number.
fn doubts(values: &[(&str, f64)]) -> Vec<String> {
    let mut slots = vec![0.0; Washout::IDENTITY.slots.len()];
    Washout::start_slots(&mut slots);
    for (name, value) in values {
        slots[Washout::IDENTITY.slot(name).unwrap()] = *value;
    }
    Washout::input_warnings_in(&slots)
}

/// Hosts that set every input to zero are told why nothing moves, or why everything sinks.
#[test]
fn inputs_of_zeros_are_warned_of_with_the_remedy() {
    let both = doubts(&[("engaged", 0.0), ("vehicle.specificForce.z", 0.0)]);
    assert_eq!(both.len(), 2, "{both:?}");
    assert!(both[0].starts_with("engaged is false: the platform stays at rest; set it to true"), "{both:?}");
    assert!(both[1].contains("as in free fall") && both[1].contains("add gravity, or set gravityRemoval"), "{both:?}");
}

/// Gravity that is missing, doubled, reversed, in g or not removed; angles and rates in degrees.
#[test]
fn mistakes_of_the_first_input_are_warned_of_with_the_remedy() {
    let (up, removal) = ("vehicle.specificForce.z", "gravityRemoval");
    let (roll, pitch, yaw) = ("vehicle.orientation.roll", "vehicle.orientation.pitch", "vehicle.orientation.yaw");
    let rate = "vehicle.angularVelocity.z";
    let cases: [(&[(&str, f64)], &str); 8] = [
        (
            &[(up, 19.6133)],
            "is 19.6133 m/s2, but at rest on level ground it is 9.80665; gravity may have been added twice",
        ),
        (
            &[(up, -9.80665)],
            "is -9.8067 m/s2, but at rest on level ground it is 9.80665; z points up, so correct its sign",
        ),
        (&[(up, 1.0)], "is 1 m/s2, but at rest on level ground it is 9.80665; give m/s2 instead of g"),
        (&[(up, 0.4)], "is 0.4 m/s2, but at rest on level ground it is 9.80665; add gravity"),
        (&[(up, 9.81), (removal, 3.0)], "leaves in: take gravity out, or set gravityRemoval to head_vertical (1)"),
        (
            &[(roll, -30.0)],
            "vehicle.orientation.roll is -30 rad, more than a vehicle has; if it is in degrees, give -0.5236 rad",
        ),
        (&[(pitch, 5.0)], "vehicle.orientation.pitch is 5 rad"),
        (
            &[(rate, 8.6)],
            "vehicle.angularVelocity.z is 8.6 rad/s, more than a vehicle has; if it is in degrees, give 0.1501 rad/s",
        ),
    ];
    for (values, part) in cases {
        let [doubt] = doubts(values).try_into().unwrap();
        assert!(doubt.contains(part), "{doubt}");
    }
    // At rest; without gravity; in a hard bend, over a bump, on a slope; after many turns.
    let right: [&[(&str, f64)]; 6] = [
        &[],
        &[(up, 0.0), (removal, 3.0)],
        &[(up, 15.0), (roll, 0.9)],
        &[(up, 4.0), (rate, -3.0)],
        &[(up, 9.2), (pitch, 0.35)],
        &[(yaw, 40.0)],
    ];
    for values in right {
        assert!(doubts(values).is_empty(), "{values:?}");
    }
}

#[test]
fn a_wrong_name_gets_the_nearest_one() {
    let mut parameters = Parameters::default();
    let mut of = |name: &str| parameters.set(name, 1.0).unwrap_err().to_string();
    for (name, near) in [
        ("spliter.x.omega1", "splitter.x.omega1"),
        ("rig.base[7].x", "rig.base[1].x"),
        ("scale.specificForce", "scale.specificForce.x"),
        ("TILT.RATELIMIT", "tilt.rateLimit"),
    ] {
        assert_eq!(of(name), format!("{name}: is no variable here; did you mean {near}?"));
    }
    // An input is none of the parameters.
    assert_eq!(of("vehicle.speed"), "vehicle.speed: is no variable here; the names are those of the FMU's table");
}
