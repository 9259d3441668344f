//! Smooth drives on rigs of 100 mm to 1.25 m of stroke, with each strategy.

use moris_setup::load_rig;
use moris_washout::interface::StrategyKind;
use moris_washout::nalgebra::Vector3;
use moris_washout::{Input, Parameters, Washout};

use crate::rig_files::{RIGS, example};

const STEP: f64 = 0.001;
const GRAVITY: f64 = 9.80665;

/// Goes from 0 to 1 without a kink in `duration` from `start` on.
fn smooth(t: f64, start: f64, duration: f64) -> f64 {
    let u = ((t - start) / duration).clamp(0.0, 1.0);
    u * u * (3.0 - 2.0 * u)
}

/// Surge and sway of two stops and a bend.
fn stops(t: f64) -> [f64; 2] {
    let surge = 3.0 * (smooth(t, 3.0, 0.8) - smooth(t, 8.0, 0.8)) - 5.0 * (smooth(t, 14.0, 0.8) - smooth(t, 19.0, 0.8));
    [surge, 3.0 * (smooth(t, 24.0, 1.0) - smooth(t, 30.0, 1.0))]
}

/// Surge and sway that swing slowly.
fn swinging(t: f64) -> [f64; 2] {
    let fade = smooth(t, 0.0, 2.0);
    [(1.5 * (0.9 * t).sin() + 0.8 * (2.3 * t).sin()) * fade, 0.8 * (1.3 * t).sin() * fade]
}

/// Error of the felt force relative to that of a platform at rest. Largest change within 20 ms
/// beyond that of the desired force, and largest magnitude beyond the desired one's \[m/s2\].
struct Felt {
    error: f64,
    jolt: f64,
    peak: f64,
}

fn felt(parameters: &Parameters, scale: f64, drive: fn(f64) -> [f64; 2]) -> Felt {
    let mut washout = Washout::new(parameters).unwrap();
    let input = |t: f64| {
        let [surge, sway] = drive(t).map(|force| scale * force);
        Input { specific_force: Vector3::new(surge, sway, GRAVITY), ..Input::default() }
    };
    let pairs: Vec<[Vector3<f64>; 2]> = (0..40_000)
        .map(|k| {
            let t = f64::from(k) * STEP;
            washout.step_between(&input(t), &input(t + STEP), STEP);
            [washout.output().felt_specific_force, input(t + STEP).specific_force]
        })
        .collect();
    let energy = |of: fn(&[Vector3<f64>; 2]) -> f64| pairs.iter().map(of).sum::<f64>();
    let error = (energy(|[felt, desired]| (felt - desired).xy().norm_squared())
        / energy(|[_, desired]| desired.xy().norm_squared()))
    .sqrt();
    let (mut jolt, mut peak) = (0.0_f64, f64::MIN);
    for axis in 0..2 {
        let change = |k: usize, which: usize| (pairs[k + 20][which][axis] - pairs[k][which][axis]).abs();
        for k in (20..pairs.len() - 40).step_by(5) {
            let around = (k - 20..=k + 20).step_by(5).map(|k| change(k, 1)).fold(0.0, f64::max);
            jolt = jolt.max(change(k, 0) - around);
        }
        let largest = |which: usize| pairs.iter().map(|pair| pair[which][axis].abs()).fold(0.0, f64::max);
        peak = peak.max(largest(0) - largest(1));
    }
    Felt { error, jolt, peak }
}

/// Each rig with each strategy.
fn setups() -> impl Iterator<Item = (String, StrategyKind, Parameters)> {
    RIGS.iter().flat_map(|name| {
        let parameters = load_rig(&example(&format!("{name}.toml"))).unwrap().parameters();
        StrategyKind::ALL.iter().map(move |&strategy| {
            let mut parameters = parameters;
            parameters.structure.strategy = strategy;
            (format!("{name}, {}", strategy.name()), strategy, parameters)
        })
    })
}

#[test]
fn a_smooth_drive_jolts_on_no_rig() {
    for (name, strategy, parameters) in setups() {
        for drive in [stops, swinging] {
            let Felt { error, jolt, peak } = felt(&parameters, 1.0, drive);
            assert!(jolt < 0.55 && peak < 0.7, "{name}: jolt of {jolt}, peak of {peak} m/s2");
            if strategy == StrategyKind::Predictive {
                assert!(jolt < 0.2 && error < 0.85, "{name}: jolt of {jolt} m/s2, error {error} of that at rest");
            }
        }
    }
}

#[test]
fn at_a_scale_that_fits_no_strategy_is_worse_than_a_platform_at_rest() {
    for (name, strategy, parameters) in setups() {
        for drive in [stops, swinging] {
            let Felt { error, jolt, peak } = felt(&parameters, 0.2, drive);
            assert!(error < 0.7, "{name}: error {error} of that at rest");
            // The classical filters overshoot by themselves, on every rig.
            let overshoot = if strategy == StrategyKind::Classical { 0.6 } else { 0.32 };
            assert!(jolt < 0.2 && peak < overshoot, "{name}: jolt of {jolt}, peak of {peak} m/s2");
        }
    }
}
