//! Tunable parameters changed in the middle of a ride, engaging and disengaging: nothing jumps.

use moris_interface::{Causality, Kind, Model, SlotModel, Variability};
use moris_washout::interface::{Compensation, RollPitchYaw};
use moris_washout::{Input, Output, Parameters, Washout, presets};
use nalgebra::Vector3;

use crate::common::limits::Watch;
use crate::common::manoeuvres::accelerate_and_brake;
use crate::common::{G, accelerating, displacement, ride};

const STEP: f64 = 0.001;

/// The start values with the classical strategy, whose parameters are most of all, and with these
/// variables changed.
fn parameters(changed: &[(&str, f64)]) -> Parameters {
    presets::with(presets::CLASSICAL, changed)
}

/// A washout with these variables changed.
fn washout(changed: &[(&str, f64)]) -> Washout {
    Washout::new(&parameters(changed)).unwrap()
}

/// A ride in which everything moves.
fn moving(t: f64) -> Input {
    let wave = |amplitude: f64, omega: f64, phase: f64| amplitude * (omega * t + phase).sin();
    Input {
        specific_force: Vector3::new(1.0 + wave(0.8, 0.9, 0.0), wave(1.0, 0.7, 1.0), G + wave(0.8, 3.0, 2.0)),
        angular_velocity: Vector3::new(wave(0.2, 1.5, 0.0), wave(0.15, 1.1, 1.0), wave(0.3, 0.9, 2.0)),
        orientation: RollPitchYaw::new(wave(0.13, 1.5, 1.6), wave(0.13, 1.1, 2.6), wave(0.3, 0.9, 3.6)),
        lean: 0.1,
        ..Input::default()
    }
}

/// Slots of the model with the start values and the classical strategy.
fn start_slots() -> Vec<f64> {
    let mut slots = vec![0.0; Washout::IDENTITY.slots.len()];
    Washout::start_slots(&mut slots);
    slots[Washout::IDENTITY.slot("strategy").unwrap()] = 1.0;
    slots
}

/// Every tunable variable with the values to change it to.
fn changes() -> Vec<(usize, Vec<f64>)> {
    let identity = Washout::IDENTITY;
    let start = start_slots();
    (0..identity.slots.len())
        .filter(|&slot| {
            let row = identity.row(slot);
            row.causality == Causality::Parameter && row.variability == Variability::Tunable
        })
        .map(|slot| {
            let values = match identity.row(slot).kind {
                Kind::Enumeration(enumeration) => (1..=enumeration.items.len()).map(|item| item as f64).collect(),
                _ if ["input.cutoff", "input.rateCutoff"].contains(&identity.variable_name(slot).as_str()) => {
                    vec![1.0, 20.0]
                }
                _ => {
                    let (min, max) = identity.row(slot).range.unwrap();
                    [0.1, 0.5, 1.5, 2.5].map(|factor| (factor * start[slot]).clamp(min, max)).to_vec()
                }
            };
            (slot, values)
        })
        .collect()
}

/// Largest difference of two outputs one step apart, or of two washouts: the effect of
/// accelerations in a step.
fn assert_no_jump(a: &Output, b: &Output, what: &str) {
    const LINEAR: f64 = 10.0;
    const ANGULAR: f64 = 10.0;
    let close = |a: f64, b: f64, bound: f64, quantity: &str| {
        assert!((a - b).abs() <= bound, "{what}: {quantity} jumps from {a} to {b}");
    };
    for k in 0..3 {
        close(a.position[k], b.position[k], LINEAR * STEP * STEP, "position");
        close(a.velocity[k], b.velocity[k], LINEAR * STEP * 1.001, "velocity");
        close(a.orientation.to_vector()[k], b.orientation.to_vector()[k], ANGULAR * STEP * STEP, "angle");
        close(a.angular_velocity[k], b.angular_velocity[k], ANGULAR * STEP, "angular velocity");
    }
    for i in 0..6 {
        close(a.length[i], b.length[i], 15.0 * STEP * STEP, "length");
        close(a.leg_velocity[i], b.leg_velocity[i], 15.0 * STEP * 1.001, "leg's velocity");
    }
}

#[test]
fn no_tunable_parameter_makes_anything_jump() {
    let mut started = washout(&[]);
    ride(&mut started, 6.0, STEP, moving, |_, _| {});
    let changes = changes();
    assert!(changes.len() > 50, "{}", changes.len());
    for (slot, values) in changes {
        for value in values {
            let what = format!("{} = {value}", Washout::IDENTITY.variable_name(slot));
            let mut slots = start_slots();
            slots[slot] = value;
            let (mut changed, mut unchanged) = (started.clone(), started.clone());
            changed.retune_from(&slots).unwrap_or_else(|refusal| panic!("{refusal}"));
            let mut after = |changed: &mut Washout| {
                changed.step(&moving(6.0), STEP);
                unchanged.step(&moving(6.0), STEP);
                assert_no_jump(&changed.output(), &unchanged.output(), &what);
            };
            after(&mut changed);
            // The steps after that may not jump either, and the legs keep their limits.
            let mut watch = Watch::new(changed.parameters(), &changed.output());
            let mut last = changed.output();
            for k in 6001..9000 {
                changed.step(&moving(k as f64 * STEP), STEP);
                let now = changed.output();
                watch.check_machine(&now, STEP);
                let moved = now.position - last.position - 0.5 * STEP * (now.velocity + last.velocity);
                // Braking that ends within the step moves the platform by up to a/8 of the step's square.
                let rests = now.velocity == Vector3::zeros();
                let bound = if rests { 0.125 } else { 0.02 } * 15.0 * STEP * STEP;
                assert!(moved.amax() < bound, "{what} at {k}: {moved}");
                last = now;
            }
        }
    }
}

/// The linear channel's input changes with the compensation; the offset that fades cancels it.
#[test]
fn another_compensation_changes_the_acceleration_without_a_jump() {
    // Away from all limits, also the soft ones.
    let mut started = washout(&[("splitter.x.omega1", 3.0), ("splitter.x.omega2", 2.0), ("splitter.y.omega1", 2.2)]);
    ride(&mut started, 6.0, STEP, moving, |_, _| {});
    for compensation in [Compensation::None, Compensation::Centripetal, Compensation::Gravity] {
        let (mut changed, mut unchanged) = (started.clone(), started.clone());
        let mut parameters = *changed.parameters();
        parameters.conditioning.compensation = compensation;
        changed.retune(&parameters).unwrap();
        for washout in [&mut changed, &mut unchanged] {
            washout.step(&moving(6.0), STEP);
        }
        let jump = (changed.output().acceleration - unchanged.output().acceleration).amax();
        assert!(jump < 0.01, "{compensation:?}: {jump} m/s²");
    }
}

#[test]
fn retuning_with_the_same_parameters_changes_nothing() {
    let mut washout = washout(&[]);
    ride(&mut washout, 3.0, STEP, moving, |_, _| {});
    let mut retuned = washout.clone();
    retuned.retune(&parameters(&[])).unwrap();
    for k in 3000..6000 {
        washout.step(&moving(k as f64 * STEP), STEP);
        retuned.step(&moving(k as f64 * STEP), STEP);
    }
    let (a, b) = (washout.output(), retuned.output());
    assert!((a.position - b.position).amax() < 1e-12);
    assert!((a.orientation.to_vector() - b.orientation.to_vector()).amax() < 1e-12);
}

/// The rates that drive the angular channel are the low-passed ones. Retuning continues from those.
#[test]
fn a_change_elsewhere_leaves_the_angular_channel_as_it_is() {
    let mut changed = washout(&[]);
    let mut unchanged = changed.clone();
    for k in 0..4000 {
        // The rates change fastest here, and their low-pass is farthest behind.
        if k == 1047 {
            let mut parameters = *changed.parameters();
            parameters.adaptive.gain1 *= 2.0;
            changed.retune(&parameters).unwrap();
        }
        let input = moving(k as f64 * STEP);
        changed.step(&input, STEP);
        unchanged.step(&input, STEP);
        let [a, b] = [&changed, &unchanged].map(|washout| washout.motion().orientation.angles.to_vector());
        assert!((a - b).amax() < 1e-12, "{} rad after {k} steps", (a - b).amax());
    }
}

/// A washout retuned at rest moves as one that was made with the parameters.
///
/// There are two exceptions. Without removal of gravity, rest is itself a cue, which fades in
/// after a change. The adaptive strategy's gains start at their nominal values, but after a change
/// they only move there.
#[test]
fn after_retuning_at_rest_the_motion_is_the_new_parameters() {
    let strategy = Washout::IDENTITY.slot("strategy").unwrap();
    for kind in [1.0, 2.0, 3.0, 4.0, 5.0] {
        let mut start = start_slots();
        start[strategy] = kind;
        for (slot, values) in changes() {
            let name = Washout::IDENTITY.variable_name(slot);
            for &value in [&values[0], &values[values.len() - 1]] {
                if name.starts_with("adaptive.nominal") || name == "gravityRemoval" && value == 3.0 {
                    continue;
                }
                let mut slots = start.clone();
                slots[slot] = value;
                let mut washouts = [&start, &slots].map(|slots| Washout::from_slots(slots).unwrap());
                washouts[0].retune_from(&slots).unwrap();
                for washout in &mut washouts {
                    ride(washout, crate::cases::cases(2.0, 0.5), 0.01, moving, |_, _| {});
                }
                let [retuned, made] = washouts.map(|washout| *washout.motion());
                let what = format!("strategy {kind}, {name} = {value}");
                let difference = (retuned.position - made.position).amax();
                assert!(difference < 1e-9, "{what}: {difference} m");
            }
        }
    }
}

#[test]
fn after_retuning_the_steady_state_is_the_new_parameters() {
    let mut changed = washout(&[]);
    ride(&mut changed, 5.0, STEP, moving, |_, _| {});
    let others = parameters(&[
        ("scale.specificForce.x", 0.5),
        ("scale.specificForce.y", 1.0),
        ("splitter.x.omega1", 1.0),
        ("splitter.y.zeta2", 0.6),
    ]);
    changed.retune(&others).unwrap();
    let lasting = |_: f64| Input { specific_force: Vector3::new(2.0, 1.0, G), ..Input::default() };
    ride(&mut changed, 60.0, 0.01, lasting, |_, _| {});
    let output = changed.output();
    assert!((output.felt_specific_force.x - 1.0).abs() < 1e-4);
    assert!((output.felt_specific_force.y - 1.0).abs() < 1e-4);
}

#[test]
fn lowered_safety_limits_are_reached_and_then_kept() {
    let mut washout = washout(&[]);
    let pushed = |_: f64| Input { specific_force: Vector3::new(6.0, 0.0, G), ..Input::default() };
    ride(&mut washout, 0.4, STEP, pushed, |_, _| {});
    assert!(washout.output().position.x > 0.1);
    let lowered = parameters(&[("safety.x.positionLimit", 0.05), ("safety.x.velocityLimit", 0.2)]);
    washout.retune(&lowered).unwrap();
    ride(&mut washout, 5.0, STEP, pushed, |t, output| {
        if t > 1.5 {
            assert!(output.position.x.abs() <= 0.05 && output.velocity.x.abs() <= 0.2 + 1e-12, "at {t}");
        }
    });
}

#[test]
fn fixed_parameters_are_refused_by_name() {
    let mut washout = washout(&[]);
    let before = washout.clone();
    for (name, value) in [("head.height", 1.3), ("rig.base[2].y", 0.5), ("splitter.order", 2.0), ("gravity", 9.81)] {
        let refusal = washout.retune(&parameters(&[(name, value)])).unwrap_err();
        assert_eq!(refusal.variable, name, "{refusal}");
        assert_eq!(washout, before);
    }
}

#[test]
fn disengaged_it_returns_to_neutral_and_stays_whatever_the_vehicle_does() {
    let parameters = Parameters::default();
    let mut washout = washout(&[]);
    let mut watch = Watch::new(&parameters, &washout.output());
    ride(&mut washout, 5.0, STEP, moving, |_, output| watch.check(output, STEP));
    assert!(displacement(&washout.output()) > 0.02);
    let disengaged = |t: f64| Input { engaged: false, ..moving(5.0 + t) };
    ride(&mut washout, 60.0, STEP, disengaged, |t, output| {
        watch.check(output, STEP);
        if t > 55.0 {
            assert!(displacement(output) < 1e-6, "{} at {t}", displacement(output));
        }
    });
    ride(&mut washout, 5.0, STEP, moving, |_, output| watch.check(output, STEP));
    assert!(displacement(&washout.output()) > 0.02, "engaged again it cues again");
}

#[test]
fn started_disengaged_it_stays_at_neutral() {
    let input = |t: f64| Input { engaged: false, ..moving(t) };
    let mut washout = washout(&[]).starting_with(&input(0.0));
    ride(&mut washout, 10.0, STEP, input, |t, output| assert!(displacement(output) < 1e-12, "at {t}"));
}

/// The ends to which a tunable variable is changed: those of its usual range, or a tenth and 2.5
/// times its start value. A cutoff is switched off, too.
fn ends(slot: usize) -> Vec<f64> {
    let identity = Washout::IDENTITY;
    let row = identity.row(slot);
    match (row.kind, row.usual) {
        (Kind::Enumeration(enumeration), _) => (1..=enumeration.items.len()).map(|item| item as f64).collect(),
        (_, Some((low, high))) if row.name.ends_with("utoff") => vec![0.0, low, high],
        (_, Some((low, high))) => vec![low, high],
        _ => {
            let (min, max) = row.range.unwrap();
            [0.1, 2.5].map(|factor| (factor * start_slots()[slot]).clamp(min, max)).to_vec()
        }
    }
}

/// Time for which a change is watched, and time within which a jolt happens \[ms\].
const WATCHED: usize = 2500;
const JOLT: usize = 20;

/// The felt force every millisecond from this one on, and whether a limit changes the motion.
fn felt_from(mut washout: Washout, from: usize, drive: fn(f64) -> Input) -> Vec<(Vector3<f64>, bool)> {
    let after = |k: usize| {
        washout.step_between(&drive(k as f64 * STEP), &drive((k + 1) as f64 * STEP), STEP);
        let output = washout.output();
        let is_limited = output.soft_limited || output.safety_active || output.actuator_limited;
        (output.felt_specific_force, is_limited)
    };
    (from..from + WATCHED).map(after).collect()
}

/// Largest change of the felt force within 20 ms beyond that of the undisturbed motion: while no
/// limit acts, and while one does.
fn jolts(felt: &[(Vector3<f64>, bool)], undisturbed: &[(Vector3<f64>, bool)]) -> [f64; 2] {
    let change = |felt: &[(Vector3<f64>, bool)], k: usize| (felt[k + JOLT].0 - felt[k].0).abs();
    let mut largest = [0.0_f64; 2];
    for k in 0..WATCHED - JOLT {
        let is_limited = felt[k.saturating_sub(JOLT)..=k + JOLT].iter().any(|(_, is_limited)| *is_limited);
        let beyond = (change(felt, k) - change(undisturbed, k)).max();
        largest[usize::from(is_limited)] = largest[usize::from(is_limited)].max(beyond);
    }
    largest
}

/// Every tunable parameter, with every strategy, to both ends of its usual range. `--nocapture`
/// prints the largest jolts of each in the order of the strategies.
#[test]
fn no_tunable_parameter_is_felt_as_a_jolt() {
    /// The bounds \[m/s2\]. A limit that begins to act is felt as on any smooth drive.
    const BOUNDS: [f64; 2] = [0.1, 0.5];
    type Drive = (&'static str, fn(f64) -> Input, usize);
    let drives: [Drive; 4] = [
        ("steady", |_| accelerating(2.0, 0.0, 0.0), 20_000),
        ("run a", |t| accelerating(accelerate_and_brake(t), 0.0, 0.0), 29_000),
        ("run a's start", |t| accelerating(accelerate_and_brake(t), 0.0, 0.0), 6_000),
        ("all axes", moving, 6_000),
    ];
    let identity = Washout::IDENTITY;
    let kind = identity.slot("strategy").unwrap();
    let names = ["classical", "adaptive", "optimal", "predictive", "robust"];
    let rows = changes().into_iter().map(|(slot, _)| slot);
    let mut table: Vec<_> =
        rows.flat_map(|slot| ends(slot).into_iter().map(move |end| (slot, end, [[0.0_f64; 2]; 5]))).collect();
    for (strategy, (_, drive, at)) in
        (0..5).flat_map(|k| drives.iter().take(crate::cases::cases(4, 2)).map(move |d| (k, d)))
    {
        let mut start = start_slots();
        start[kind] = 1.0 + strategy as f64;
        let mut washout = Washout::from_slots(&start).unwrap();
        for k in 0..*at {
            washout.step_between(&drive(k as f64 * STEP), &drive((k + 1) as f64 * STEP), STEP);
        }
        let undisturbed = felt_from(washout.clone(), *at, *drive);
        for (slot, end, largest) in &mut table {
            let name = identity.variable_name(*slot);
            let of_other = |other: &&str| *other != names[strategy] && name.starts_with(&format!("{other}."));
            let mut slots = start.clone();
            slots[*slot] = *end;
            let mut changed = washout.clone();
            if names.iter().any(of_other) || slots == start || changed.retune_from(&slots).is_err() {
                continue;
            }
            let found = jolts(&felt_from(changed, *at, *drive), &undisturbed);
            largest[strategy] = [0, 1].map(|k: usize| largest[strategy][k].max(found[k]));
        }
    }
    let mut failed = Vec::new();
    for (slot, end, largest) in table {
        let name = identity.variable_name(slot);
        let texts = largest.map(|[free, limited]| format!("{free:.2}/{limited:.2}"));
        println!("{name} = {end}: {}", texts.join("  "));
        // The safety limits are in force at once, and the platform brakes for them.
        let exceeds = largest.iter().any(|found| found[0] > BOUNDS[0] || found[1] > BOUNDS[1]);
        if exceeds && !name.starts_with("safety.") {
            failed.push(format!("{name} = {end}: {texts:?}"));
        }
    }
    assert!(failed.is_empty(), "jolts of {}: free and at a limit [m/s2]\n{}", names.join(", "), failed.join("\n"));
}

/// Largest change of the felt force within 20 ms \[m/s2\], while a host writes these values every
/// 40 ms from the fourth second on.
fn jolt_with_writes(strategy: usize, write: impl Fn(&mut Vec<f64>, f64)) -> f64 {
    let mut slots = start_slots();
    slots[Washout::IDENTITY.slot("strategy").unwrap()] = 1.0 + strategy as f64;
    let mut washout = Washout::from_slots(&slots).unwrap();
    let drive = |t: f64| {
        let smooth = (t / 3.0).min(1.0).powi(2);
        accelerating(3.0 * smooth * (0.7 * t).sin(), 2.0 * smooth * (0.5 * t).sin(), 0.0)
    };
    let mut felt: Vec<Vector3<f64>> = Vec::new();
    for k in 0..12_000 {
        if k >= 3_000 && k % 40 == 0 {
            write(&mut slots, k as f64 * STEP);
            washout.retune_from(&slots).unwrap();
        }
        washout.step_between(&drive(k as f64 * STEP), &drive((k + 1) as f64 * STEP), STEP);
        felt.push(washout.output().felt_specific_force);
    }
    (JOLT..felt.len()).map(|k| (felt[k] - felt[k - JOLT]).amax()).fold(0.0, f64::max)
}

/// A tilt limit that is lowered onto a moving tilt: the tilt brakes beyond it. Stopped at once it
/// was felt as 27 m/s2.
#[test]
fn a_tilt_limit_written_on_and_on_is_no_blow() {
    let slot = Washout::IDENTITY.slot("tilt.angleLimit").unwrap();
    for strategy in 0..5 {
        for seed in 0..crate::cases::cases(8, 3) {
            let write = |slots: &mut Vec<f64>, t: f64| slots[slot] = 0.275 + 0.175 * (1e4 * (t + seed as f64)).sin();
            let jolt = jolt_with_writes(strategy, write);
            println!("strategy {strategy}, seed {seed}: {jolt:.3} m/s2");
            assert!(jolt < 1.0, "strategy {strategy}, seed {seed}: {jolt} m/s2 within 20 ms");
        }
    }
}

/// Each tunable parameter, written anew every 40 ms with a value anywhere in its usual range. A
/// fade that began before the last one's correction was over was felt as 12 m/s2.
#[test]
fn no_parameter_written_on_and_on_is_a_blow() {
    const BOUND: f64 = 0.5;
    // The tilt brakes for its limits, and the adaptive filter starts anew.
    const WIDER: [&str; 3] = ["tilt.rateLimit", "tilt.angleLimit", "adaptive.omega"];
    const WIDER_BOUND: f64 = 1.0;
    let identity = Washout::IDENTITY;
    let mut failed = Vec::new();
    for (slot, _) in changes() {
        let name = identity.variable_name(slot);
        let ends = ends(slot);
        let [low, high] = [ends[0], ends[ends.len() - 1]];
        if name.starts_with("safety.") || ends.len() < 2 {
            continue;
        }
        let bound = if WIDER.contains(&name.as_str()) { WIDER_BOUND } else { BOUND };
        for strategy in (0..5).skip(crate::cases::cases(0, slot % 5)).take(crate::cases::cases(5, 1)) {
            let write = |slots: &mut Vec<f64>, t: f64| {
                slots[slot] = 0.5 * (low + high) + 0.5 * (high - low) * (1e4 * (t + strategy as f64)).sin();
            };
            let jolt = jolt_with_writes(strategy, write);
            if jolt > bound {
                failed.push(format!("{name} from {low} to {high}, strategy {strategy}: {jolt:.2}"));
            }
        }
    }
    assert!(failed.is_empty(), "m/s2 within 20 ms:\n{}", failed.join("\n"));
}

/// Two sets, as for the ground and the air, blended by a signal over 2 s, there and back.
#[test]
fn two_sets_blended_by_a_signal_are_felt_smoothly() {
    let identity = Washout::IDENTITY;
    let other = [
        ("scale.specificForce.x", 0.4),
        ("scale.specificForce.y", 0.3),
        ("scale.angularVelocity.x", 0.2),
        ("limit.specificForce.x", 3.0),
        ("tilt.rateLimit", 0.1),
        ("tilt.angleLimit", 0.2),
        ("splitter.x.omega1", 1.0),
        ("splitter.z.omega1", 6.0),
        ("softLimit.pace", 5.0),
    ];
    for strategy in 0..5 {
        let start = start_slots();
        let write = |slots: &mut Vec<f64>, t: f64| {
            let signal = (0.5 * (t - 3.0)).min(1.0) - (0.5 * (t - 7.0)).clamp(0.0, 1.0);
            for (name, value) in other {
                let slot = identity.slot(name).unwrap();
                slots[slot] = start[slot] + signal * (value - start[slot]);
            }
        };
        let jolt = jolt_with_writes(strategy, write);
        println!("strategy {strategy}: {jolt:.3} m/s2");
        assert!(jolt < 0.5, "strategy {strategy}: {jolt} m/s2 within 20 ms");
    }
}
