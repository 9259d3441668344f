//! Whatever the washout is fed, the platform and the legs stay within their limits and
//! come back to neutral.

use moris_washout::interface::RollPitchYaw;
use moris_washout::{Input, Washout, presets};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::limits::Watch;
use crate::common::random::Random;
use crate::common::{cases, displacement, parameters};

/// Kinds of input that no vehicle gives.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Noise,
    Held,
    Jolts,
    SignFlip,
    Huge,
    NotNumbers,
    SmallNoise,
    Mixed,
}
const KINDS: [Kind; 8] =
    [Kind::Noise, Kind::Held, Kind::Jolts, Kind::SignFlip, Kind::Huge, Kind::NotNumbers, Kind::SmallNoise, Kind::Mixed];

/// An input of this kind, number `k` of an episode.
fn hostile(kind: Kind, random: &mut Random, k: usize, last: &Input) -> Input {
    let amplitude = match kind {
        Kind::Held if !k.is_multiple_of(700) => return *last,
        Kind::Jolts if !k.is_multiple_of(300) => return *last,
        Kind::Mixed => return hostile(KINDS[random.below(7) as usize], random, k, last),
        Kind::Huge => 1e6,
        Kind::Jolts => 12.0,
        Kind::SmallNoise => 0.05,
        _ => 30.0,
    };
    let mut value = |share: f64| match kind {
        Kind::SignFlip => amplitude * share * if k.is_multiple_of(2) { 1.0 } else { -1.0 },
        Kind::NotNumbers => [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 5.0][random.below(5) as usize],
        _ => random.between(-amplitude, amplitude) * share,
    };
    let mut vector = |share: f64| Vector3::new(value(share), value(share), value(share));
    Input {
        specific_force: vector(1.0),
        angular_velocity: vector(0.3),
        orientation: RollPitchYaw::from_vector(vector(0.1)),
        lean: vector(0.03).x,
        speed: f64::NAN,
        engaged: random.below(500) != 0,
    }
}

/// Choice of the communication steps of an episode \[s\].
#[derive(Clone, Copy, Debug)]
enum Steps {
    Even(f64),
    Irregular(f64),
}

/// Variations of the start values: long travel, strong cues, steps so long that limits act
/// coarsely, a slow machine, tight safety limits; and the paper's sets.
const SETS: [(&str, &[(&str, f64)]); 11] = [
    (presets::CLASSICAL, &[]),
    ("", &[("strategy", 1.0), ("splitter.x.omega1", 0.3), ("splitter.y.omega2", 0.3), ("splitter.z.omega1", 0.3)]),
    ("", &[("limit.specificForce.x", 1e6), ("limit.specificForce.y", 1e6), ("limit.angularVelocity.y", 100.0)]),
    ("", &[("solver.maxStep", 0.02)]),
    ("", &[("actuator.velocityLimit", 0.3), ("actuator.accelerationLimit", 3.0)]),
    (
        "",
        &[
            ("strategy", 1.0),
            ("safety.x.velocityLimit", 0.2),
            ("safety.y.accelerationLimit", 2.0),
            ("safety.z.positionLimit", 0.1),
        ],
    ),
    (presets::PAPER, &[]),
    (include_str!("../../examples/paper-runs/small-motions.toml"), &[]),
    ("", &[("strategy", 2.0), ("adaptive.gain1", 5.0), ("adaptive.gain2", 5.0)]),
    ("", &[("strategy", 3.0), ("limit.specificForce.x", 1e6)]),
    ("", &[]),
];

/// Rides through `count` steps of hostile input, then rests until the platform is neutral,
/// within limits all the time.
fn survive((set, changed): (&str, &[(&str, f64)]), kind: Kind, steps: Steps, held: bool, seed: u64, count: usize) {
    let parameters = presets::with(set, changed);
    let mut washout = Washout::new(&parameters).unwrap();
    let mut watch = Watch::new(&parameters, &washout.output());
    let mut random = Random::new(seed);
    let mut last = Input::default();
    for k in 0..count {
        let step = match steps {
            Steps::Even(step) => step,
            Steps::Irregular(longest) => random.between(0.02 * longest, longest),
        };
        let input = hostile(kind, &mut random, k, &last);
        if held {
            washout.step(&input, step);
        } else {
            washout.step_between(&last, &input, step);
        }
        last = input;
        watch.check(&washout.output(), step);
    }
    // Long, for the sets of low break frequencies: their filters have run far beyond what the safety units let through.
    const LONGEST_REST: usize = 40_000;
    for _ in 0..LONGEST_REST {
        if displacement(&washout.output()) < 1e-6 {
            return;
        }
        washout.step(&Input::default(), 0.01);
        watch.check(&washout.output(), 0.01);
    }
    panic!("not neutral after {LONGEST_REST} steps of rest: {:?}", washout.output());
}

#[test]
fn limits_hold_at_1_khz() {
    for (seed, set) in SETS.iter().enumerate() {
        for kind in KINDS {
            // Few cases: the inputs of every second set are held.
            for held in [true, false].into_iter().filter(|held| crate::cases::cases(true, *held == (seed % 2 == 0))) {
                survive(*set, kind, Steps::Even(0.001), held, seed as u64, crate::cases::cases(10_000, 2_000));
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn limits_hold_for_any_steps(
        set in 0..SETS.len(), kind in 0..KINDS.len(), longest in 0.0005..0.04, even: bool, held: bool, seed: u64,
    ) {
        let steps = if even { Steps::Even(longest) } else { Steps::Irregular(longest) };
        survive(SETS[set], KINDS[kind], steps, held, seed, 2000);
    }
}

#[test]
fn a_single_blow_of_any_kind_passes() {
    for blow in [1e6, -1e6, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let mut washout = Washout::new(&parameters(&[])).unwrap();
        let mut watch = Watch::new(&parameters(&[]), &washout.output());
        let input = Input {
            specific_force: Vector3::repeat(blow),
            angular_velocity: Vector3::repeat(blow),
            orientation: RollPitchYaw::new(blow, blow, blow),
            lean: blow,
            speed: blow,
            engaged: true,
        };
        washout.step(&input, 0.001);
        watch.check(&washout.output(), 0.001);
        for _ in 0..40_000 {
            washout.step(&Input::default(), 0.001);
            watch.check(&washout.output(), 0.001);
        }
        assert!(displacement(&washout.output()) < 1e-6, "{blow}");
    }
}

#[test]
fn steps_of_no_length_do_nothing() {
    let mut washout = Washout::new(&parameters(&[])).unwrap();
    let before = washout.clone();
    let input = Input { specific_force: Vector3::repeat(5.0), ..Input::default() };
    for step in [0.0, -0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        washout.step(&input, step);
        assert_eq!(washout, before);
    }
}

#[test]
fn the_shortest_steps_poison_nothing() {
    for step in [1e-9, 1e-12, 1e-100, 1e-300, 1e-310, f64::MIN_POSITIVE, 5e-324] {
        let parameters = parameters(&[]);
        let mut washout = Washout::new(&parameters).unwrap();
        for k in 0..20 {
            let value = if k % 2 == 0 { 1e6 } else { -1e6 };
            let input = Input {
                specific_force: Vector3::repeat(value),
                angular_velocity: Vector3::repeat(value),
                lean: 0.3,
                ..Input::default()
            };
            washout.step(&input, step);
            washout.step_between(&Input::default(), &input, step);
        }
        let mut watch = Watch::new(&parameters, &washout.output());
        for _ in 0..30_000 {
            washout.step(&Input::default(), 0.001);
            watch.check(&washout.output(), 0.001);
        }
        assert!(displacement(&washout.output()) < 1e-6, "after steps of {step} s: {:?}", washout.output());
    }
}
