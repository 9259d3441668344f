//! The strategies beside the classical one: what they promise on the paper's runs,
//! and what holds for each.

use moris_washout::cueing::strategy::regulator::{AxisModel, Regulator, Weights, dynamics};
use moris_washout::interface::RollPitchYaw;
use moris_washout::{Input, Output, Parameters, Washout};
use nalgebra::{Complex, SMatrix, SVector, Vector3};

use crate::common::limits::Watch;
use crate::common::manoeuvres::*;
use crate::common::random::Random;
use crate::common::{G, accelerating, displacement, from_neutral, parameters, rms_difference, washout};

const CLASSICAL: f64 = 1.0;
const ADAPTIVE: f64 = 2.0;
const OPTIMAL: f64 = 3.0;
const PREDICTIVE: f64 = 4.0;
const ROBUST: f64 = 5.0;
/// All strategies but the classical one.
const COORDINATED: [f64; 4] = [ADAPTIVE, OPTIMAL, ROBUST, PREDICTIVE];

/// RMS error of the felt force along x and y on a run \[m/s2\], without the vehicle's rates.
fn errors(strategy: f64, duration: f64, input: impl Fn(f64) -> Input) -> [f64; 2] {
    const STEP: f64 = 0.01;
    let mut washout = washout(&[
        ("strategy", strategy),
        ("safety.x.positionLimit", 0.45),
        ("safety.y.positionLimit", 0.45),
        ("scale.angularVelocity.x", 0.0),
        ("scale.angularVelocity.y", 0.0),
        ("scale.angularVelocity.z", 0.0),
    ]);
    let (mut felt, mut desired) = ([vec![], vec![]], [vec![], vec![]]);
    for k in 0..(duration / STEP).round() as usize {
        let (start, end) = (input(k as f64 * STEP), input((k + 1) as f64 * STEP));
        washout.step_between(&start, &end, STEP);
        let output = washout.output();
        for axis in 0..2 {
            felt[axis].push(output.felt_specific_force[axis]);
            desired[axis].push(end.specific_force[axis]);
        }
    }
    [0, 1].map(|axis| rms_difference(&felt[axis], &desired[axis]))
}

#[test]
fn the_predictive_strategy_tracks_the_papers_runs_better_than_the_classical_one() {
    let [run_a, _] = errors(PREDICTIVE, ACCELERATE_AND_BRAKE_TIME, surging(accelerate_and_brake));
    assert!(run_a <= 0.05, "run a: {run_a}");
    let [brisk, _] = errors(PREDICTIVE, ACCELERATE_AND_BRAKE_TIME, surging(accelerate_and_brake_briskly));
    assert!(brisk <= 0.58, "run a, brisk: {brisk}");
    let [run_c, _] = errors(PREDICTIVE, BRUSQUE_STOP_TIME, surging(brusque_stop));
    assert!(run_c <= 0.82, "run c: {run_c}");
    let (x, y) = (0, 1);
    let predictive = errors(PREDICTIVE, WAKE_TIME, wake);
    assert!(predictive[x] <= 0.23 && predictive[y] <= 0.30, "run b: {predictive:?}");
    let classical = errors(CLASSICAL, WAKE_TIME, wake);
    for strategy in COORDINATED {
        let error = errors(strategy, WAKE_TIME, wake);
        assert!(error[x] < 0.6 * classical[x] && error[y] < 0.6 * classical[y], "{strategy}: {error:?}, {classical:?}");
    }
}

/// RMS error of the felt force along x on run c with preaction, the vehicle's speed given \[m/s2\].
fn error_at_the_stop(strategy: f64) -> f64 {
    const STEP: f64 = 0.01;
    let mut washout = washout(&[("strategy", strategy), ("preaction", 2.0)]);
    let (mut felt, mut desired, mut speed) = (vec![], vec![], 0.0);
    let mut start = Input::default();
    for k in 1..=(BRUSQUE_STOP_TIME / STEP).round() as usize {
        let mut end = surging(brusque_stop)(k as f64 * STEP);
        speed += 0.5 * STEP * (start.specific_force.x + end.specific_force.x);
        end.speed = f64::max(speed, 0.0);
        washout.step_between(&start, &end, STEP);
        felt.push(washout.output().felt_specific_force.x);
        desired.push(end.specific_force.x);
        start = end;
    }
    rms_difference(&felt, &desired)
}

#[test]
fn with_preaction_the_predictive_strategy_plans_for_a_stop() {
    let error = error_at_the_stop(PREDICTIVE);
    assert!(error <= 0.30, "run c with the stop foreseen: {error}");
}

/// Dropped force over reference at the frequency omega: C (s I - A + B K)^-1 B_f + D, with the
/// reference split by a low-pass of time constant tau.
fn closed_loop(model: &AxisModel, weights: &Weights, tau: f64, omega: f64) -> Complex<f64> {
    let gains = Regulator::new(model, weights).unwrap().gains;
    let (a, b) = dynamics(model, weights);
    // States position, velocity, tilt, tilt rate, slow part; the fast part is the reference less the slow one.
    let feedback = SMatrix::<f64, 2, 5>::from_fn(|i, j| gains[(i, j)] - if j == 4 { gains[(i, 5)] } else { 0.0 });
    let feedthrough = SVector::<f64, 2>::new(gains[(0, 5)], gains[(1, 5)]);
    let inputs = SMatrix::<f64, 5, 2>::from_fn(|i, j| if i < 4 { b[(i, j)] } else { 0.0 });
    let mut matrix = SMatrix::<f64, 5, 5>::from_fn(|i, j| if i < 4 && j < 4 { a[(i, j)] } else { 0.0 });
    matrix[(4, 4)] = -1.0 / tau;
    let closed = matrix - inputs * feedback;
    let by_reference = SVector::<f64, 5>::new(0.0, 1.0, 0.0, 0.0, 1.0 / tau) - inputs * feedthrough;
    let s = Complex::new(0.0, omega);
    let system = SMatrix::<Complex<f64>, 5, 5>::from_fn(|i, j| {
        (if i == j { s } else { Complex::new(0.0, 0.0) }) - Complex::from(closed[(i, j)])
    });
    let state = system.lu().solve(&by_reference.map(Complex::from)).unwrap();
    let dropped = feedback.row(0).map(Complex::from) * state;
    -dropped[0] - feedthrough[0]
}

/// Felt over desired force at the frequency omega, measured on small sines with internal
/// steps of `step` seconds.
fn measured(axis: usize, omega: f64, step: f64) -> Complex<f64> {
    const AMPLITUDE: f64 = 1e-4;
    let mut washout = washout(&[("strategy", OPTIMAL), ("solver.maxStep", step)]);
    let input = |t: f64| {
        let mut force = [0.0; 2];
        force[axis] = AMPLITUDE * (omega * t).sin();
        accelerating(force[0], force[1], 0.0)
    };
    let period = std::f64::consts::TAU / omega;
    // The slowest closed-loop mode has faded by then.
    let begin = (60.0 / period).ceil() * period;
    let steps = (period / step).round() as usize;
    // The period in whole steps: the sine is sampled as it is, and projected on itself.
    let omega_step = std::f64::consts::TAU / steps as f64;
    let settle = (begin / step).round() as usize / steps * steps;
    let stepped = |k: usize| input(omega_step * k as f64 / omega);
    let (mut sine, mut cosine) = (0.0, 0.0);
    for k in 0..settle + steps {
        washout.step_between(&stepped(k), &stepped(k + 1), step);
        if k >= settle {
            let phase = omega_step * (k + 1) as f64;
            let felt = washout.output().felt_specific_force[axis];
            sine += 2.0 * felt * phase.sin() / steps as f64;
            cosine += 2.0 * felt * phase.cos() / steps as f64;
        }
    }
    Complex::new(sine, cosine) / AMPLITUDE
}

#[test]
fn the_optimal_strategy_responds_as_its_closed_loop_to_the_first_order_in_the_step() {
    let Parameters { optimal, tilt, safety, structure, .. } = parameters(&[]);
    let weights = Weights {
        position: optimal.weight_position,
        velocity: optimal.weight_velocity,
        tilt_rate: optimal.weight_tilt_rate,
        tilt_acceleration: optimal.weight_tilt_acceleration,
        slow_pole: optimal.slow_pole,
        fast_pole: optimal.fast_pole,
    };
    for axis in 0..2 {
        let model = AxisModel {
            head_height: structure.head_height,
            gravity: structure.gravity,
            position_limit: safety.position_limit[axis],
            velocity_limit: safety.velocity_limit[axis],
            angle_limit: tilt.angle_limit,
            rate_limit: tilt.rate_limit,
            acceleration_limit: tilt.acceleration_limit,
        };
        for omega in [0.3, 1.0, 3.0, 10.0] {
            let expected = Complex::from(1.0) + closed_loop(&model, &weights, optimal.split_time, omega);
            let [coarse, fine] = [4e-3, 1e-3].map(|step| (measured(axis, omega, step) - expected).norm());
            assert!(fine < 5e-3, "axis {axis}, {omega} rad/s: off by {fine}");
            assert!(fine < 0.3 * coarse + 1e-5, "axis {axis}, {omega} rad/s: {fine} at 1 ms, {coarse} at 4 ms");
        }
    }
}

/// A ride on which everything moves, hard enough for plans to run into limits.
fn moving(t: f64) -> Input {
    let wave = |amplitude: f64, omega: f64, phase: f64| amplitude * (omega * t + phase).sin();
    Input {
        specific_force: Vector3::new(1.0 + wave(2.5, 0.9, 0.0), wave(2.0, 1.7, 1.0), G + wave(0.8, 3.0, 2.0)),
        angular_velocity: Vector3::new(wave(0.1, 1.5, 0.0), wave(0.05, 1.1, 1.0), wave(0.1, 0.9, 2.0)),
        orientation: RollPitchYaw::new(wave(0.1, 1.5, 1.6), wave(0.05, 1.1, 2.6), 0.0),
        lean: 0.1,
        ..Input::default()
    }
}

/// Bits of all that a host can see.
fn bits(output: &Output) -> String {
    format!("{output:?}")
}

#[test]
fn an_input_changed_after_t_changes_nothing_up_to_t() {
    for strategy in COORDINATED {
        let mut random = Random::new(1);
        let mut one = washout(&[("strategy", strategy)]);
        for change_at in [3, 517, 2011] {
            for k in 0..change_at {
                one.step_between(&moving(k as f64 * 0.001), &moving((k + 1) as f64 * 0.001), 0.001);
            }
            let mut other = one.clone();
            let start = moving(change_at as f64 * 0.001);
            let mut changed = start;
            changed.specific_force.x += random.between(1.0, 3.0);
            assert_eq!(bits(&one.output()), bits(&other.output()));
            other.step_between(&start, &changed, 0.001);
            one.step_between(&start, &start, 0.001);
            assert_ne!(bits(&one.output()), bits(&other.output()), "{strategy}: the change must matter after t");
        }
    }
}

#[test]
fn a_copy_made_in_mid_plan_goes_on_bit_for_bit() {
    for strategy in COORDINATED {
        let mut washout = washout(&[("strategy", strategy)]);
        // Every instant of the 20 ms in which a plan is begun, made and carried out.
        for k in 0..2000 {
            washout.step(&moving(k as f64 * 0.001), 0.001);
        }
        for k in 2000..2020 {
            let mut copy = washout.clone();
            let mut original = washout.clone();
            for j in k..k + 100 {
                let input = moving(j as f64 * 0.001);
                copy.step(&input, 0.001);
                original.step(&input, 0.001);
            }
            assert_eq!(copy, original);
            washout.step(&moving(k as f64 * 0.001), 0.001);
        }
    }
}

#[test]
fn the_hosts_step_changes_no_bit() {
    // A power of two, so that the host's steps are divided without rounding.
    const STEP: f64 = 1.0 / 1024.0;
    for strategy in COORDINATED {
        let set = [("strategy", strategy), ("solver.maxStep", STEP)];
        let (mut fine, mut coarse) = (washout(&set), washout(&set));
        for k in 0..600 {
            let input = moving(k as f64 * 8.0 * STEP);
            for _ in 0..8 {
                fine.step(&input, STEP);
            }
            coarse.step(&input, 8.0 * STEP);
            let (a, b) = (fine.output(), coarse.output());
            assert_eq!((a.length, a.leg_velocity), (b.length, b.leg_velocity), "{strategy}: step {k}");
        }
    }
}

#[test]
fn a_ride_that_ends_leads_back_to_neutral() {
    for strategy in COORDINATED {
        let mut washout = washout(&[("strategy", strategy)]);
        let mut largest = [0.0_f64; 3];
        let end = 20.0;
        for k in 0..9000 {
            let t = k as f64 * 0.01;
            let input = if t < end {
                accelerating(2.0 * (0.7 * t).sin(), 1.0 * (0.4 * t).sin(), 0.0)
            } else {
                Input::default()
            };
            washout.step(&input, 0.01);
            let output = washout.output();
            let position = from_neutral(&output).amax();
            let error = output.felt_specific_force.x.abs().max(output.felt_specific_force.y.abs());
            let since = t - end;
            if since > 25.0 {
                largest[0] = largest[0].max(position);
            }
            if since > 60.0 {
                largest[1] = largest[1].max(position);
            }
            if since > 20.0 {
                largest[2] = largest[2].max(error);
            }
        }
        let [after_25_s, after_60_s, felt] = largest;
        assert!(after_25_s < 0.05, "{strategy}: {after_25_s} m after 25 s");
        assert!(after_60_s < 0.002, "{strategy}: {after_60_s} m after 60 s");
        assert!(felt < 0.02, "{strategy}: {felt} m/s2 after 20 s");
    }
}

#[test]
fn after_a_long_push_the_predictive_strategy_comes_back_from_its_whole_travel() {
    let mut washout = washout(&[("strategy", PREDICTIVE)]);
    let positions: Vec<f64> = (0..4500)
        .map(|k| {
            let force = if k < 2000 { 4.0 } else { 0.0 };
            washout.step(&accelerating(force, 0.0, 0.0), 0.01);
            from_neutral(&washout.output()).amax()
        })
        .collect();
    assert!(positions[1999] > 0.3, "{} m at the end of the push", positions[1999]);
    assert!(positions[4499] < 0.015, "{} m after 25 s", positions[4499]);
}

#[test]
fn disengaged_the_platform_is_at_neutral_within_ten_seconds_and_stays() {
    for strategy in COORDINATED {
        let mut washout = washout(&[("strategy", strategy)]);
        for k in 0..12_000 {
            washout.step(&accelerating(2.5, 1.0, 0.0), 0.001);
            assert!(k < 11_999 || displacement(&washout.output()) > 0.05, "{strategy}: the ride must lead away");
        }
        for k in 0..20_000 {
            washout.step(&Input { engaged: false, ..accelerating(2.5, 1.0, 0.0) }, 0.001);
            let output = washout.output();
            if k >= 10_000 {
                let away = displacement(&output);
                assert!(away < 5e-3, "{strategy}: {away} at {k}");
            }
        }
        assert!(displacement(&washout.output()) < 1e-4);
    }
}

#[test]
fn parameters_changed_in_flight_break_no_limit() {
    for strategy in COORDINATED {
        let mut parameters = parameters(&[("strategy", strategy)]);
        let mut washout = Washout::new(&parameters).unwrap();
        let mut watch = Watch::new(&parameters, &washout.output());
        let mut random = Random::new(3);
        for k in 0..20_000 {
            if k % 37 == 0 {
                let mut factor = |value: &mut f64, start: f64| *value = start * random.between(-2.0, 2.0).exp();
                factor(&mut parameters.adaptive.weight_position, 10.6);
                factor(&mut parameters.adaptive.gain1, 0.18);
                factor(&mut parameters.adaptive.omega, 0.8);
                factor(&mut parameters.optimal.weight_position, 0.209);
                factor(&mut parameters.optimal.weight_tilt_acceleration, 0.0242);
                factor(&mut parameters.predictive.weight_velocity, 0.01);
                factor(&mut parameters.predictive.slow_pole, 0.0368);
                factor(&mut parameters.predictive.memory, 60.0);
                washout.retune(&parameters).unwrap();
            }
            washout.step(&moving(k as f64 * 0.001), 0.001);
            watch.check(&washout.output(), 0.001);
        }
    }
}
