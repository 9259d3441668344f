//! Helpers of the tests: inputs, manoeuvres, an integrator, rotations in plain
//! arrays, and random numbers.

pub mod chain;
pub mod crank_rigs;
pub mod limits;
pub mod manoeuvres;
pub mod random;
pub mod rotation;

use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::{Input, Output, Parameters, Washout, presets};
use nalgebra::Vector3;
use proptest::test_runner::{Config as ProptestConfig, RngSeed};

pub const G: f64 = STANDARD_GRAVITY;

/// The paper's set with these variables changed: what it computes has closed forms.
pub fn parameters(changed: &[(&str, f64)]) -> Parameters {
    presets::with(presets::PAPER, changed)
}

/// A washout with these variables changed from the paper's set.
pub fn washout(changed: &[(&str, f64)]) -> Washout {
    Washout::new(&parameters(changed)).expect("the parameters can be used")
}

/// A vehicle upright and level, with this acceleration \[m/s2\] at the head.
pub fn accelerating(x: f64, y: f64, z: f64) -> Input {
    Input { specific_force: Vector3::new(x, y, z + G), ..Input::default() }
}

/// Steps through `duration` seconds with the input of each step's beginning held, and
/// looks at every output.
pub fn ride(
    washout: &mut Washout,
    duration: f64,
    step: f64,
    input: impl Fn(f64) -> Input,
    mut check: impl FnMut(f64, &Output),
) {
    for k in 0..(duration / step).round() as usize {
        washout.step(&input(k as f64 * step), step);
        check((k + 1) as f64 * step, &washout.output());
    }
}

/// As [`ride`], with the input going linearly from step to step.
pub fn ride_between(
    washout: &mut Washout,
    duration: f64,
    step: f64,
    input: impl Fn(f64) -> Input,
    mut check: impl FnMut(f64, &Output),
) {
    for k in 0..(duration / step).round() as usize {
        let (start, end) = (k as f64 * step, (k + 1) as f64 * step);
        washout.step_between(&input(start), &input(end), step);
        check(end, &washout.output());
    }
}

/// Position relative to the default rig's neutral.
pub fn from_neutral(output: &Output) -> Vector3<f64> {
    output.position - Vector3::new(0.0, 0.0, Parameters::default().rig.neutral_height)
}

/// Distance of the platform from neutral: the largest of its coordinates \[m, rad\].
pub fn displacement(output: &Output) -> f64 {
    from_neutral(output).amax().max(output.orientation.to_vector().amax())
}

/// One step of the classical Runge-Kutta method for x' = f(t, x).
pub fn rk4<const N: usize>(t: f64, x: [f64; N], h: f64, f: impl Fn(f64, &[f64; N]) -> [f64; N]) -> [f64; N] {
    let along = |k: &[f64; N], share: f64| std::array::from_fn(|i| x[i] + share * h * k[i]);
    let k1 = f(t, &x);
    let k2 = f(t + 0.5 * h, &along(&k1, 0.5));
    let k3 = f(t + 0.5 * h, &along(&k2, 0.5));
    let k4 = f(t + h, &along(&k3, 1.0));
    std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// Correlation coefficient of two series.
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |s: &[f64]| s.iter().sum::<f64>() / s.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(x, y)| f(x - ma, y - mb)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// Root mean square of the difference of two series.
pub fn rms_difference(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>() / a.len() as f64).sqrt()
}

/// A search over this many cases, the same ones every time; by default a tenth of them, at least
/// ten.
pub fn cases(all: u32) -> ProptestConfig {
    let count = crate::cases::cases(all, (all / 10).max(10));
    ProptestConfig {
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        max_shrink_iters: 30,
        ..ProptestConfig::with_cases(count)
    }
}
