//! A step allocates no memory, whatever happens in it.

use moris_washout::interface::{AutomaticScale, RollPitchYaw, StrategyKind};
use moris_washout::{Input, Parameters, Washout};
use nalgebra::Vector3;

/// Motion that makes tilt, safety units and actuator guard act.
fn input(k: usize) -> Input {
    let t = k as f64 * 0.001;
    let blow = if k % 500 < 250 { 12.0 } else { -12.0 };
    Input {
        specific_force: Vector3::new(blow, 8.0 * t.sin(), 9.8 + blow),
        angular_velocity: Vector3::new(t.cos(), 0.1 * blow, f64::NAN),
        orientation: RollPitchYaw::new(t.sin(), 0.1, t),
        lean: 0.3 * t.sin(),
        engaged: k % 1000 < 900,
        ..Input::default()
    }
}

fn allocations(f: impl FnMut()) -> u64 {
    allocation_counter::measure(f).count_total
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1.0; 100]))), 1);
}

#[test]
fn a_step_allocates_nothing() {
    for &strategy in StrategyKind::ALL {
        for pace in [0.0, 5.0] {
            let mut parameters = with_strategy(strategy);
            parameters.soft_limit.pace = pace;
            parameters.automatic_scale.automatic = if pace > 0.0 { AutomaticScale::Off } else { AutomaticScale::On };
            assert_eq!(allocations_of_a_ride(&parameters), 0, "{strategy:?} at a pace of {pace}");
        }
    }
}

fn allocations_of_a_ride(parameters: &Parameters) -> u64 {
    let mut washout = Washout::new(parameters).unwrap();
    let (mut soft, mut safety, mut actuator) = (false, false, false);
    let count = allocations(|| {
        for k in 0..5000 {
            washout.step(&input(k), 0.001);
            washout.step_between(&input(k), &input(k + 1), 0.0007 + 1e-7 * k as f64);
            let output = washout.output();
            let _ = std::hint::black_box(washout.output_derivative());
            soft |= output.soft_limited;
            safety |= output.safety_active;
            actuator |= output.actuator_limited;
        }
    });
    let hard = safety && actuator;
    assert!(if parameters.soft_limit.pace > 0.0 { soft } else { hard }, "the ride must be rough enough");
    count
}

fn with_strategy(strategy: StrategyKind) -> Parameters {
    let mut parameters = Parameters::default();
    parameters.structure.strategy = strategy;
    parameters
}

#[test]
fn retuning_with_the_default_rig_allocates_nothing() {
    for &strategy in StrategyKind::ALL {
        let mut parameters = with_strategy(strategy);
        let mut washout = Washout::new(&parameters).unwrap();
        parameters.splitter.omega1.x = 1.7;
        parameters.adaptive.omega = 1.0;
        parameters.optimal.weight_position = 0.3;
        parameters.predictive.weight_position = 1e-3;
        parameters.automatic_scale.automatic = AutomaticScale::On;
        assert_eq!(allocations(|| washout.retune(&parameters).unwrap()), 0, "{strategy:?}");
    }
}
