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
fn the_longest_step_is_the_most_internal_steps() {
    let mut parameters = presets::parameters("");
    parameters.structure.max_step = 0.004;
    let model = <Washout as Model>::new(&parameters, &Inputs::default()).unwrap();
    assert_eq!(model.longest_step(), MOST_INTERNAL_STEPS * 0.004);
}

#[test]
fn each_row_that_is_tuned_is_in_a_group_and_has_a_usual_range_above_zero() {
    let is_of = |group: &str| TuningGroup::ALL.iter().any(|known| known.name() == group);
    assert!(Parameters::ROWS.iter().filter_map(|row| row.group).all(is_of));
    for group in TuningGroup::ALL {
        let in_group = || Parameters::ROWS.iter().filter(|row| row.group == Some(group.name()));
        let ranges = in_group().filter_map(|row| row.usual);
        assert!(*group == TuningGroup::Order || ranges.clone().count() > 0, "{group:?}");
        assert!(in_group().count() > 0 && ranges.into_iter().all(|(least, _)| least > 0.0), "{group:?}");
    }
}

/// Hosts that set every input to zero are told why nothing moves, or why everything sinks.
#[test]
fn inputs_of_zeros_are_warned_of_with_the_remedy() {
    let of = |engaged: f64, upward: f64, removal: f64| {
        let mut slots = vec![0.0; Washout::IDENTITY.slots.len()];
        Washout::start_slots(&mut slots);
        for (name, value) in [("engaged", engaged), ("vehicle.specificForce.z", upward), ("gravityRemoval", removal)] {
            slots[Washout::IDENTITY.slot(name).unwrap()] = value;
        }
        Washout::warnings_in(&slots)
    };
    // The start value.
    let removal = 1.0;
    assert!(of(1.0, 9.8, removal).is_empty());
    let both = of(0.0, 0.0, removal);
    assert_eq!(both.len(), 2, "{both:?}");
    assert!(both[0].starts_with("engaged is false: the platform stays at rest; set it to true"), "{both:?}");
    assert!(both[1].contains("as in free fall") && both[1].contains("add gravity, or set gravityRemoval"), "{both:?}");
    // Accelerations without gravity are 0 at rest.
    assert!(of(1.0, 0.0, 3.0).is_empty());
}
