//! The search against washouts that are known to be broken, and its files.

use std::fs;
use std::path::Path;

use crate::cases::cases;
use anyhow::Result;
use moris_fmu_tests::hunter::episode::{Episode, Scope};
use moris_fmu_tests::hunter::oracle::{Quantity, Sample};
use moris_fmu_tests::hunter::run::Runner;
use moris_fmu_tests::hunter::search::{Failure, Plan, search};
use moris_fmu_tests::hunter::target::{CrateTarget, Inputs, Target};
use moris_washout::Preview;

/// The washout with something added to its outputs.
struct Broken {
    inner: CrateTarget,
    breaks: fn(&mut Sample),
}

impl Target for Broken {
    fn make(&mut self, slots: &[f64]) -> Result<()> {
        self.inner.make(slots)
    }

    fn rewind(&mut self) {
        self.inner.rewind();
    }

    fn set(&mut self, slots: &[f64], changed: &[usize]) -> bool {
        self.inner.set(slots, changed)
    }

    fn preview(&mut self, preview: &Preview) {
        self.inner.preview(preview);
    }

    fn step(&mut self, start: &Inputs, end: Option<&Inputs>, step: f64) -> Result<()> {
        self.inner.step(start, end, step)
    }

    fn sample(&mut self, neutral_height: f64) -> Sample {
        let mut sample = self.inner.sample(neutral_height);
        (self.breaks)(&mut sample);
        sample
    }

    fn save(&mut self, scope: Scope) -> Result<()> {
        self.inner.save(scope)
    }

    fn restore(&mut self, scope: Scope) -> Result<()> {
        self.inner.restore(scope)
    }
}

/// Looks for a breach of a broken washout.
fn plan() -> Plan {
    Plan { seed: 3, first_machine: 0, steps: 300_000, machines: 1000, breaches: 1, threads: 1, shrink: true }
}

fn broken(breaks: fn(&mut Sample)) -> Broken {
    Broken { inner: CrateTarget::default(), breaks }
}

/// The quantity found with outputs changed in this way. The episode is short,
/// and its file repeats it.
fn is_found(breaks: fn(&mut Sample)) -> Quantity {
    let summary = search(&plan(), || Ok(broken(breaks)), |_| {}).unwrap();
    let [found] = &summary.found[..] else { panic!("{} found", summary.found.len()) };
    let Failure::Breach(breach) = found.failure else { panic!("{:?}", found.failure) };
    assert_eq!(breach.step + 1, found.episode.count);
    assert!(found.episode.count <= found.found_after);
    assert!(found.episode.events.is_empty() && found.episode.inputs.len() <= 3, "{:?}", found.episode);
    let repeated = Episode::from_toml(&found.episode.to_toml().unwrap()).unwrap();
    assert_eq!(repeated, found.episode);
    let (runner, mut target) = (Runner::new().unwrap(), broken(breaks));
    runner.make(&repeated.parameters, &mut target).unwrap();
    assert_eq!(runner.run(&repeated, &mut target).unwrap().breach, Some(breach));
    breach.quantity
}

#[test]
fn a_leg_beyond_its_stroke_is_found_and_shrunk() {
    // A leg that is taken to be a tenth longer than it is, where it is long.
    let quantity = is_found(|sample| {
        let length = &mut sample.length[2];
        *length += 0.1 * (*length - 1.45).max(0.0);
    });
    use Quantity::{LegLength, LegPositionAgainstVelocity, LegSecondDifference};
    assert!(matches!(quantity, LegLength | LegPositionAgainstVelocity | LegSecondDifference), "{quantity:?}");
}

#[test]
fn a_velocity_that_is_not_that_of_the_position_is_found_and_shrunk() {
    is_found(|sample| sample.velocity[1] *= 1.5);
}

#[test]
fn the_same_seed_finds_the_same() {
    let hunt = || search(&plan(), || Ok(broken(|sample| sample.velocity[1] *= 1.5)), |_| {}).unwrap();
    assert_eq!(hunt().found, hunt().found);
}

/// A target that refuses all machines.
struct Refusing;

impl Target for Refusing {
    fn make(&mut self, _: &[f64]) -> Result<()> {
        anyhow::bail!("of no use")
    }

    fn rewind(&mut self) {}

    fn set(&mut self, _: &[f64], _: &[usize]) -> bool {
        false
    }

    fn preview(&mut self, _: &Preview) {}

    fn step(&mut self, _: &Inputs, _: Option<&Inputs>, _: f64) -> Result<()> {
        Ok(())
    }

    fn sample(&mut self, _: f64) -> Sample {
        Sample::default()
    }

    fn save(&mut self, _: Scope) -> Result<()> {
        Ok(())
    }

    fn restore(&mut self, _: Scope) -> Result<()> {
        Ok(())
    }
}

#[test]
fn a_target_that_refuses_every_machine_ends_the_search_with_its_reason() {
    let error = search(&Plan { machines: u64::MAX, ..plan() }, || Ok(Refusing), |_| {}).unwrap_err();
    assert!(format!("{error:#}").contains("of no use"), "{error:#}");
}

/// Every episode that once broke a limit.
fn known_episodes() -> Vec<(String, Episode)> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("episodes");
    let files = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let mut episodes: Vec<_> = files
        .map(|file| (file.display().to_string(), Episode::from_toml(&fs::read_to_string(&file).unwrap()).unwrap()))
        .collect();
    episodes.sort_by(|a, b| a.0.cmp(&b.0));
    episodes
}

#[test]
fn no_known_episode_breaks_a_limit() {
    let (runner, mut target) = (Runner::new().unwrap(), CrateTarget::default());
    let episodes = known_episodes();
    assert!(episodes.len() >= 5, "{}", episodes.len());
    for (file, episode) in episodes {
        runner.make(&episode.parameters, &mut target).unwrap();
        let outcome = runner.run(&episode, &mut target).unwrap();
        assert_eq!(outcome.breach, None, "{file}");
        assert!(outcome.steps >= episode.count, "{file}");
    }
}

#[test]
fn a_search_of_millions_of_steps_breaks_no_limit() {
    let plan =
        Plan { steps: cases(1_000_000, 400_000), machines: u64::MAX, threads: 2, shrink: true, seed: 20, ..plan() };
    let summary = search(&plan, || Ok(CrateTarget::default()), |_| {}).unwrap();
    assert!(summary.found.is_empty(), "{}", summary.found[0].episode.to_toml().unwrap());
    assert!(summary.steps >= plan.steps && summary.machines > cases(25, 10), "{summary:?}");
    // The search drives the machines to their limits.
    for (quantity, worst) in &summary.worst {
        let reached = if quantity.contains("Position") && !quantity.contains("Against") || quantity == "LegLength" {
            true // An excess, which is none.
        } else {
            quantity == "NotFinite" || quantity == "NotNeutral" || *worst > 0.99
        };
        assert!(reached, "{quantity} gets to {worst} of its limit only");
    }
}
