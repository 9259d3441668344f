//! The promise to the person: a smooth input is felt smoothly, and the hard limits are not needed.

use std::f64::consts::{PI, TAU};

use moris_washout::interface::StrategyKind;
use moris_washout::platform::reach::{Axis, horizontal_reach, single_axis_range};
use moris_washout::{Input, Output, Parameters, Rig, Washout, presets};
use nalgebra::Vector3;

use crate::common::crank_rigs::person;
use crate::common::random::Random;
use crate::common::{G, accelerating, ride_between};

/// The sets.
const SETS: [(&str, &str); 5] = [
    ("classical", presets::CLASSICAL),
    ("adaptive", presets::ADAPTIVE),
    ("optimal", presets::OPTIMAL),
    ("robust", presets::ROBUST),
    ("predictive", ""),
];

/// Goes from 0 to 1 without a kink in `duration` from `start` on.
fn smooth(t: f64, start: f64, duration: f64) -> f64 {
    let u = ((t - start) / duration).clamp(0.0, 1.0);
    u * u * (3.0 - 2.0 * u)
}

type Force = fn(f64) -> [f64; 3];

fn brake(t: f64) -> [f64; 3] {
    let surge = 3.0 * (smooth(t, 3.0, 0.8) - smooth(t, 8.0, 0.8)) - 5.0 * (smooth(t, 14.0, 0.8) - smooth(t, 19.0, 0.8));
    [surge, 3.0 * (smooth(t, 24.0, 1.0) - smooth(t, 30.0, 1.0)), 0.0]
}

fn drive(t: f64) -> [f64; 3] {
    let surge = 1.5 * (0.9 * t).sin() + 0.8 * (2.3 * t).sin();
    [surge * smooth(t, 0.0, 2.0), 0.8 * (1.3 * t).sin() * smooth(t, 0.0, 2.0), 0.0]
}

fn heave(t: f64) -> [f64; 3] {
    [smooth(t, 1.0, 1.0), 0.5 * smooth(t, 1.0, 1.0), 2.0 * (3.0 * t).sin() * smooth(t, 2.0, 2.0)]
}

fn lateral(t: f64) -> [f64; 3] {
    let sway = smooth(t, 4.0, 1.0) - smooth(t, 9.0, 1.0) - smooth(t, 16.0, 1.0) + smooth(t, 21.0, 1.0);
    [0.0, 8.0 * sway, 0.0]
}

const DRIVES: [(&str, Force); 4] = [("brake", brake), ("drive", drive), ("heave", heave), ("lateral", lateral)];

/// The felt and the desired force every millisecond, and the last outputs of every step.
fn felt(parameters: &Parameters, force: Force) -> (Vec<[Vector3<f64>; 2]>, Vec<Output>) {
    let mut washout = Washout::new(parameters).unwrap();
    let (mut forces, mut outputs) = (Vec::new(), Vec::new());
    let input = |t: f64| accelerating(force(t)[0], force(t)[1], force(t)[2]);
    ride_between(&mut washout, 40.0, 0.001, input, |t, output| {
        forces.push([output.felt_specific_force, input(t).specific_force]);
        outputs.push(*output);
    });
    (forces, outputs)
}

/// Largest change within 20 ms beyond that of the desired force within 60 ms around it, and largest
/// magnitude beyond the desired one's.
fn jolt_and_peak(forces: &[[Vector3<f64>; 2]], axis: usize) -> (f64, f64) {
    let change = |k: usize, which: usize| (forces[k + 20][which][axis] - forces[k][which][axis]).abs();
    let mut jolt = 0.0_f64;
    for k in (0..forces.len() - 20).step_by(5) {
        let around = k.saturating_sub(20)..=(k + 20).min(forces.len() - 21);
        let desired = around.step_by(5).map(|k| change(k, 1)).fold(0.0, f64::max);
        jolt = jolt.max(change(k, 0) - desired);
    }
    let still = if axis == 2 { G } else { 0.0 };
    let largest = |which: usize| forces.iter().map(|pair| (pair[which][axis] - still).abs()).fold(0.0, f64::max);
    (jolt, largest(0) - largest(1))
}

/// On the default rig, and on a machine with cranks that carries a person.
#[test]
fn a_smooth_drive_is_felt_without_jolts_and_peaks() {
    for (rig, largest_peak) in [(Rig::default(), 0.65), (person(), 1.0)] {
        for (set, changed) in SETS {
            let parameters = Parameters { rig, ..presets::parameters(changed) };
            for (drive, force) in DRIVES {
                let (forces, outputs) = felt(&parameters, force);
                let name = format!("{set}, {drive}, arms of {} m", rig.crank_arm);
                for axis in 0..3 {
                    let (jolt, peak) = jolt_and_peak(&forces, axis);
                    assert!(jolt < 0.5, "{name}, axis {axis}: jolt of {jolt} m/s2");
                    assert!(peak < largest_peak, "{name}, axis {axis}: peak of {peak} m/s2");
                }
                let hard = outputs.iter().filter(|output| output.safety_active || output.actuator_limited).count();
                assert_eq!(hard, 0, "{name}: steps at a hard limit");
            }
        }
    }
}

/// A ramp up from 2 s to 4 s and down from 8 s to 9 s, with corners; of 1 m/s2.
fn ramps(t: f64) -> f64 {
    ((t - 2.0) / 2.0).clamp(0.0, 1.0) - (t - 8.0).clamp(0.0, 1.0)
}

/// Time of a corner \[ms\], and the sign of the force's change there.
type Corner = (usize, f64);

/// A tilt that begins kicks the head above it back, unless travel takes this away.
#[test]
fn a_ramps_corner_is_felt_without_a_kick_back() {
    // At 8 s the classical strategy's demand is beyond a limit of the legs, which 2 m/s2 reach.
    let drives: [(Force, &[Corner], f64); 4] = [
        (|t| [2.0 * ramps(t), 2.0 * ramps(t), 0.0], &[(2000, 1.0)], 0.02),
        (|t| [0.7 * ramps(t), 0.7 * ramps(t), 0.0], &[(2000, 1.0), (8000, -1.0)], 0.02),
        (|t| [2.0 * ramps(t), 0.0, 0.0], &[(2000, 1.0), (8000, -1.0)], 0.02),
        (|t| [2.0 * ramps(t), 2.0 * ramps(t), 0.0], &[(8000, -1.0)], 0.17),
    ];
    for (set, changed) in SETS {
        for (force, corners, bound) in drives {
            let (forces, _) = felt(&presets::parameters(changed), force);
            for (axis, &(from, direction)) in (0..2).flat_map(|axis| corners.iter().map(move |corner| (axis, corner))) {
                let before = forces[from][0][axis];
                let back = (from..from + 300).map(|k| direction * (before - forces[k][0][axis])).fold(0.0, f64::max);
                assert!(back < bound, "{set}, axis {axis}, after {from} ms: {back} m/s2 the wrong way");
            }
        }
    }
}

/// Largest change of the felt force per second, of surge and sway, while a steady force is engaged
/// and disengaged at these times in turn, on the way too.
fn largest_jerk(parameters: &Parameters, [surge, sway]: [f64; 2], toggles: &[f64]) -> f64 {
    const STEP: f64 = 0.001;
    let engaged = |t: f64| toggles.iter().filter(|toggle| **toggle <= t).count() % 2 == 1;
    let input = |t: f64| Input { engaged: engaged(t), ..accelerating(surge, sway, 0.0) };
    let mut washout = Washout::new(parameters).unwrap().starting_with(&input(0.0));
    let (mut before, mut largest) = (washout.output().felt_specific_force, 0.0_f64);
    for k in 0..50_000 {
        washout.step(&input(f64::from(k) * STEP), STEP);
        let felt = washout.output().felt_specific_force;
        largest = largest.max((felt - before).xy().amax() / STEP);
        before = felt;
    }
    largest
}

#[test]
fn engaging_and_disengaging_are_felt_without_a_jerk() {
    for (set, changed) in SETS {
        let parameters = presets::parameters(changed);
        let forces = [[1.0, 0.5], [3.0, -2.0], [-4.0, 3.0], [-6.0, 4.0]];
        for force in forces.into_iter().step_by(crate::cases::cases(1, 3)) {
            let jerk = largest_jerk(&parameters, force, &[3.0, 13.0, 14.0, 15.0, 22.0, 24.0, 25.0, 40.0]);
            assert!(jerk < 10.0, "{set}, {force:?} m/s2: {jerk} m/s3");
        }
    }
}

#[test]
fn engaging_and_disengaging_at_random_are_felt_without_a_jerk() {
    let mut random = Random::new(1);
    for (set, changed) in SETS {
        let parameters = presets::parameters(changed);
        for _ in 0..crate::cases::cases(10, 2) {
            let force = [random.between(-6.0, 6.0), random.between(-4.0, 4.0)];
            let mut toggles = vec![1.0];
            while toggles[toggles.len() - 1] < 40.0 {
                toggles.push(toggles[toggles.len() - 1] + 0.05 + 6.0 * random.between(0.0, 1.0).powi(2));
            }
            let jerk = largest_jerk(&parameters, force, &toggles);
            assert!(jerk < 12.0, "{set}, {force:?} m/s2, {toggles:?} s: {jerk} m/s3");
        }
    }
}

/// Limits that are far away change nothing, to the bit.
#[test]
fn soft_limits_that_do_not_act_change_no_bit() {
    for strategy in [1.0, 2.0, 3.0, 4.0, 5.0] {
        let calm: Force = |t| [0.4 * (0.9 * t).sin(), 0.3 * (1.3 * t).sin(), 0.2 * (2.0 * t).sin()];
        let with = |pace| presets::with("", &[("strategy", strategy), ("softLimit.pace", pace)]);
        let (on, off) = (felt(&with(9.0), calm), felt(&with(0.0), calm));
        assert!(on.1.iter().all(|output| !output.soft_limited), "strategy {strategy}");
        assert_eq!(on.1, off.1, "strategy {strategy}");
    }
}

/// The same ride with and without soft limits: who acts.
#[test]
fn soft_limits_act_before_the_hard_ones() {
    let run = |pace| felt(&presets::with("", &[("strategy", 3.0), ("softLimit.pace", pace)]), lateral).1;
    let (on, off) = (run(5.0), run(0.0));
    assert!(on.iter().any(|output| output.soft_limited));
    assert!(off.iter().any(|output| output.safety_active || output.actuator_limited));
    assert!(off.iter().all(|output| !output.soft_limited));
}

/// Whatever is retuned in flight, the soft limits' own motion ends at neutral.
#[test]
fn after_soft_limits_the_platform_comes_back_to_neutral() {
    for (set, changed) in SETS {
        let mut washout = Washout::new(&presets::parameters(changed)).unwrap();
        let mut acted = false;
        for k in 0..70_000 {
            let t = f64::from(k) * 0.001;
            let swell = if t < 10.0 { 6.0 * (2.0 * t).sin() } else { 0.0 };
            washout.step(&accelerating(swell, 0.8 * swell, swell), 0.001);
            acted |= washout.output().soft_limited;
        }
        let output = washout.output();
        assert!(acted, "{set}");
        let away = (output.position - Vector3::new(0.0, 0.0, 1.091)).amax();
        let angles = output.orientation.to_vector().amax();
        assert!(away < 5e-3 && angles < 2e-3, "{set}: {away} m, {angles} rad");
    }
}

/// A smooth ride with all axes at once: sines that fade in over 5 s.
#[derive(Clone, Copy, Debug)]
struct Swell {
    size: f64,
    /// Frequencies of surge, of sway, and of heave, which surge shares \[Hz\].
    frequencies: [f64; 3],
    phase: f64,
}

impl Swell {
    /// Of 2 to 6 m/s2 and 0.05 to 1.2 Hz.
    fn random(random: &mut Random) -> Self {
        let frequencies = [random.between(0.05, 1.0), random.between(0.05, 0.6), random.between(0.3, 1.2)];
        Swell { size: random.between(2.0, 6.0), frequencies, phase: random.between(0.0, TAU) }
    }

    fn input(&self, t: f64) -> Input {
        let fade = if t < 5.0 { 0.5 - 0.5 * (PI * t / 5.0).cos() } else { 1.0 };
        let [surge, sway, heave] = self.frequencies;
        let size = fade * self.size;
        let swing = (TAU * heave * t).sin();
        let force = [(TAU * surge * t + self.phase).sin() + 0.3 * swing, 0.8 * (TAU * sway * t).sin(), 0.3 * swing];
        Input {
            angular_velocity: fade * Vector3::new(0.1 * (2.0 * t).sin(), 0.1 * t.cos(), 0.2 * (0.7 * t).sin()),
            ..accelerating(size * force[0], size * force[1], size * force[2])
        }
    }

    /// Largest change of felt surge or sway within 20 ms, less the largest one of the input's.
    fn jolt(&self, parameters: &Parameters) -> f64 {
        let mut washout = Washout::new(parameters).unwrap().starting_with(&self.input(0.0));
        let mut forces = Vec::new();
        ride_between(
            &mut washout,
            30.0,
            0.001,
            |t| self.input(t),
            |t, output| {
                forces.push([output.felt_specific_force, self.input(t).specific_force]);
            },
        );
        let largest = |which: usize, axis: usize| {
            let changes = forces.iter().zip(&forces[20..]).map(|(a, b)| (b[which][axis] - a[which][axis]).abs());
            changes.fold(0.0, f64::max)
        };
        [0, 1].map(|axis| largest(0, axis) - largest(1, axis)).into_iter().fold(f64::MIN, f64::max)
    }
}

/// Parameters on the default rig with this stroke: all of it in proportion, or the legs alone where
/// they become shorter. Speed is in proportion to the stroke.
fn on_stroke(stroke: f64, in_proportion: bool, strategy: StrategyKind) -> Parameters {
    let mut parameters = Parameters::default();
    let default = parameters.rig;
    let factor = stroke / (default.max_length - default.min_length);
    let size = if in_proportion || factor > 1.0 { factor } else { 1.0 };
    let middle = 1.3 * size;
    let rig = Rig {
        base: default.base.map(|joint| size * joint),
        platform: default.platform.map(|joint| size * joint),
        neutral_height: size * default.neutral_height,
        min_length: middle - 0.5 * stroke,
        max_length: middle + 0.5 * stroke,
        velocity_limit: factor.min(1.5) * default.velocity_limit,
        ..default
    };
    let [surge, sway] = horizontal_reach(&rig);
    let heave = single_axis_range(&rig, Axis::Heave).min_reach();
    parameters.safety.position_limit = 0.95 * Vector3::new(surge, sway, heave);
    parameters.structure.strategy = strategy;
    parameters.rig = rig;
    parameters
}

#[test]
fn smooth_rides_with_all_axes_at_once_do_not_jolt() {
    use StrategyKind::{Adaptive, Classical, Optimal, Predictive, Robust};
    let mut random = Random::new(58);
    // Rides at which the predictive plan once changed the force by up to 12 m/s2 within 20 ms.
    let hard = [(6.0, [0.46, 0.14, 0.38], 4.16), (4.4128, [0.4125, 0.206, 0.9075], 2.8689)]
        .map(|(size, frequencies, phase)| Swell { size, frequencies, phase });
    let rides = hard.into_iter().chain((0..).map(|_| Swell::random(&mut random)));
    let mut beyond = Vec::new();
    for (number, ride) in rides.take(crate::cases::searches(300, 25)).enumerate() {
        let strategy = [Predictive, Classical, Adaptive, Optimal, Robust][number % 5];
        // The default rig's stroke, and from 30 mm to 1.25 m in equal ratios.
        let stroke = match number % 4 {
            0 => 0.6,
            _ => 0.03 * (1.25_f64 / 0.03).powf((number * 7 % 41) as f64 / 40.0),
        };
        let jolt = ride.jolt(&on_stroke(stroke, number % 3 == 1, strategy));
        if jolt > 0.7 {
            beyond.push(format!("{jolt:.3} m/s2 on ride {number}, {strategy:?}, {stroke:.3} m, {ride:?}"));
        }
    }
    assert!(beyond.is_empty(), "{}", beyond.join("\n"));
}
