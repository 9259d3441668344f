//! Each attack reaches the state at which it aims.

use std::collections::BTreeMap;

use anyhow::Result;
use moris_fmu_tests::hunter::attacker::{Aim, Attacker};
use moris_fmu_tests::hunter::episode::{Episode, Rest, Scope, Steps, Values};
use moris_fmu_tests::hunter::oracle::{MachineLimits, Quantity, Safety, Sample};
use moris_fmu_tests::hunter::preview::{Forces, Previews};
use moris_fmu_tests::hunter::reach::Reach;
use moris_fmu_tests::hunter::run::{Outcome, Runner};
use moris_fmu_tests::hunter::signal::Signal;
use moris_fmu_tests::hunter::target::{CrateTarget, Inputs, Target};
use moris_washout::Preview;

/// The washout with a record of what it is given and what it answers.
#[derive(Default)]
struct Recorder {
    inner: CrateTarget,
    previews: Vec<Preview>,
    /// Inputs of each step, and the sample after it; trials are taken back.
    steps: Vec<(Inputs, Sample)>,
    inputs: Option<Inputs>,
    /// Number of steps when a trial began.
    kept: usize,
    trials: usize,
}

impl Target for Recorder {
    fn make(&mut self, slots: &[f64]) -> Result<()> {
        self.inner.make(slots)
    }

    fn rewind(&mut self) {
        self.inner.rewind();
        self.steps.clear();
        self.inputs = None;
    }

    fn set(&mut self, slots: &[f64], changed: &[usize]) -> bool {
        self.inner.set(slots, changed)
    }

    fn preview(&mut self, preview: &Preview) {
        self.previews.push(*preview);
        self.inner.preview(preview);
    }

    fn step(&mut self, start: &Inputs, end: Option<&Inputs>, step: f64) -> Result<()> {
        self.inputs = Some(*start);
        self.inner.step(start, end, step)
    }

    fn sample(&mut self, neutral_height: f64) -> Sample {
        let sample = self.inner.sample(neutral_height);
        if let Some(inputs) = self.inputs.take() {
            self.steps.push((inputs, sample));
        }
        sample
    }

    fn save(&mut self, scope: Scope) -> Result<()> {
        if scope == Scope::Trial {
            self.kept = self.steps.len();
        }
        self.inner.save(scope)
    }

    fn restore(&mut self, scope: Scope) -> Result<()> {
        if scope == Scope::Trial {
            self.steps.truncate(self.kept);
            self.trials += 1;
        }
        self.inner.restore(scope)
    }
}

/// Runs an episode, which must break no limit.
fn record(episode: &Episode) -> (Recorder, Outcome) {
    let (runner, mut target) = (Runner::new().unwrap(), Recorder::default());
    runner.make(&episode.parameters, &mut target).unwrap();
    let outcome = runner.run(episode, &mut target).unwrap();
    assert_eq!(outcome.breach, None);
    (target, outcome)
}

fn episode(count: usize, inputs: &[(&str, Signal)]) -> Episode {
    Episode {
        origin: None,
        count,
        linear: false,
        steps: Steps::Even { length: 0.005 },
        parameters: Values::from([("solver.maxStep".to_owned(), 0.005)]),
        inputs: inputs.iter().map(|(name, signal)| ((*name).to_owned(), *signal)).collect(),
        preview: None,
        attacker: None,
        rest: None,
        events: vec![],
    }
}

/// The limits of the default machine.
const MACHINE: MachineLimits =
    MachineLimits { stroke: [1.0, 1.6], velocity: 1.0, acceleration: 15.0, radius: 0.85, size: 3.0, max_step: 0.005 };
const SAFETY: Safety = Safety { position: [0.37, 0.37, 0.33], velocity: [1.0; 3], acceleration: [10.0; 3] };

const SURGE: &str = "vehicle.specificForce.x";
const SWAY: &str = "vehicle.specificForce.y";
const HEAVE: &str = "vehicle.specificForce.z";
const ROLL: &str = "vehicle.angularVelocity.x";
const PITCH: &str = "vehicle.angularVelocity.y";

fn attacker(aim: Aim, tries: usize, amplitude: f64) -> Attacker {
    let amplitudes = [SURGE, SWAY, HEAVE, ROLL, PITCH].map(|name| (name.to_owned(), amplitude));
    Attacker { aim, every: 20, ahead: 40, tries, seed: 3, amplitudes: BTreeMap::from(amplitudes) }
}

/// The furthest that an attacker comes with so many trials for a choice.
fn furthest(aim: Aim, tries: usize) -> f64 {
    let (target, _) = record(&Episode { attacker: Some(attacker(aim, tries, 8.0)), ..episode(1000, &[]) });
    assert_eq!(target.trials, tries * 50);
    let scores = target.steps.iter().map(|(_, sample)| aim.score(&Reach::of(sample, &MACHINE, &SAFETY)));
    scores.fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn an_attacker_that_looks_ahead_comes_nearer_to_its_aim() {
    // The first of several trials is the only one of a blind attacker.
    for aim in [Aim::Room, Aim::Speed, Aim::Stop] {
        let (blind, seeing) = (furthest(aim, 1), furthest(aim, 12));
        assert!(seeing > blind, "{aim:?}: {seeing} after {blind}");
    }
}

#[test]
fn trials_leave_no_trace() {
    let force = [(SWAY, Signal::Flips { amplitude: 5.0, held: 50, seed: 1 })];
    let mut with = episode(500, &force);
    let (alone, _) = record(&with);
    let mut blind = attacker(Aim::Room, 4, 0.0);
    blind.amplitudes.remove(SWAY);
    with.attacker = Some(blind);
    let (tried, _) = record(&with);
    assert!(tried.trials > 50 && alone.trials == 0);
    assert_eq!(alone.steps, tried.steps);
}

#[test]
fn the_washout_is_disengaged_at_an_end_and_at_speed() {
    let strong = (SURGE, Signal::Square { amplitude: 8.0, frequency: 2.0, phase: 0.0 });
    let is_hostile = |signal: Signal, condition: fn(&Reach) -> bool| {
        let (target, _) = record(&episode(4000, &[strong, ("engaged", signal)]));
        let mut toggles = 0;
        for pair in target.steps.windows(2) {
            let reach = Reach::of(&pair[0].1, &MACHINE, &SAFETY);
            assert_eq!(pair[1].0.engaged, !condition(&reach));
            toggles += usize::from(pair[0].0.engaged != pair[1].0.engaged);
        }
        toggles
    };
    let at_end = is_hostile(Signal::AtEnd { amplitude: -1.0, room: 0.5 }, |reach| reach.room < 0.5);
    let at_speed = is_hostile(Signal::AtSpeed { amplitude: -1.0, fraction: 0.4 }, |reach| reach.speed > 0.4);
    assert!(at_end >= 4 && at_speed >= 4, "{at_end} and {at_speed} times");
}

#[test]
fn previews_are_of_the_kind_that_they_are_said_to_be() {
    let given = |forces: Forces, held: usize| {
        let previews = Previews { forces, amplitude: 3.0, count: [-3, 30], step: [0.01, 10.0], held, seed: 4 };
        let sine = Signal::Sine { amplitude: 2.0, frequency: 1.0, phase: 0.0 };
        let (target, _) = record(&Episode { preview: Some(previews), ..episode(200, &[(SURGE, sine)]) });
        assert_eq!(target.previews.len(), 200);
        target.previews
    };
    // The first preview is given at time 0.
    for (forces, sign) in [(Forces::Ahead, 1.0), (Forces::Contrary, -1.0)] {
        let first = given(forces, 1)[0];
        for (k, force) in first.surge.iter().enumerate() {
            let expected = sign * 2.0 * ((k + 1) as f64 * first.step).sin();
            assert!((force - expected).abs() < 1e-12, "{force}, not {expected}");
        }
    }
    let noise = given(Forces::Noise, 1);
    let counts: Vec<i32> = noise.iter().map(|preview| preview.count).collect();
    assert!(counts.iter().min() < Some(&0) && counts.iter().max() > Some(&20));
    let steps: Vec<f64> = noise.iter().map(|preview| preview.step).collect();
    assert!(steps.iter().any(|step| *step < 0.05) && steps.iter().any(|step| *step > 5.0));
    let alternating = given(Forces::Alternating, 1);
    assert!(alternating.windows(2).all(|pair| pair[0].surge.map(|force| -force) == pair[1].surge));
    let held = given(Forces::Noise, 10);
    assert!(held.chunks(10).all(|same| same.iter().all(|preview| *preview == same[0])) && held[0] != held[10]);
    let jump = given(Forces::Jump, 1);
    assert!(jump.iter().all(|preview| preview.surge.windows(2).filter(|pair| pair[0] != pair[1]).count() <= 1));
    let non_finite = given(Forces::NonFinite, 1);
    assert!(non_finite.iter().any(|preview| preview.step.is_nan()));
    assert!(non_finite.iter().any(|preview| preview.surge.iter().any(|force| force.is_infinite())));
}

#[test]
fn a_small_machine_that_was_driven_to_its_ends_comes_home() {
    // About 17 mm of room at neutral, joints displaced, and a narrow sway.
    let parameters: Values = toml::from_str(include_str!("small-machine.toml")).unwrap();
    let stroke = ["actuator.minLength", "actuator.maxLength"].map(|name| parameters[name]);
    let is_at_both_ends = |sample: &Sample| {
        let leg = sample.length.iter().map(|length| (length - stroke[0]).min(stroke[1] - length)).fold(1.0, f64::min);
        let sway = parameters["safety.y.positionLimit"] - sample.position[1].abs();
        leg < 1e-3 && sway < 1e-3
    };
    let (mut at_both_ends, mut longest) = (0, 0.0);
    for seed in 0..crate::cases::cases(20, 8) {
        let mut attacker = Attacker { seed, ..attacker(Aim::Room, 6, 20.0) };
        attacker.amplitudes.remove(SWAY);
        let drive = Episode {
            parameters: parameters.clone(),
            attacker: Some(attacker),
            rest: Some(Rest { count: 12_000, step: 0.005, engaged: true, parameters: Values::new() }),
            ..episode(1000, &[(SWAY, Signal::Flips { amplitude: 8.0, held: 200, seed })])
        };
        // Within 60 s of rest, or this is a breach.
        let (target, outcome) = record(&drive);
        at_both_ends += usize::from(target.steps[..1000].iter().any(|(_, sample)| is_at_both_ends(sample)));
        longest = outcome.worst[Quantity::NotNeutral as usize].max(longest);
    }
    assert!(at_both_ends > 0);
    assert!(longest > 0.01, "at home after {longest} of the rest");
}

#[test]
fn a_platform_that_is_not_home_in_time_is_found() {
    let rest = Rest { count: 3000, step: 0.01, engaged: true, parameters: Values::new() };
    let mut drive = Episode { rest: Some(rest), ..episode(200, &[(SURGE, Signal::Held { value: 2.0 })]) };
    let (target, _) = record(&drive);
    let taken = target.steps.len() - 200;
    assert!((100..3000).contains(&taken), "{taken}");
    for (count, is_home) in [(taken, true), (taken - 1, false)] {
        drive.rest.as_mut().unwrap().count = count;
        let (runner, mut target) = (Runner::new().unwrap(), CrateTarget::default());
        runner.make(&drive.parameters, &mut target).unwrap();
        let breach = runner.run(&drive, &mut target).unwrap().breach;
        let expected = (!is_home).then_some((Quantity::NotNeutral, 200 + count - 1));
        assert_eq!(breach.map(|breach| (breach.quantity, breach.step)), expected);
    }
}
