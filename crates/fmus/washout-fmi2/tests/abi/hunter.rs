//! The search for a broken limit through the C functions, and what it once found.

use std::fs;
use std::path::Path;

use moris_hunter::episode::Episode;
use moris_hunter::run::Runner;
use moris_hunter::search::{Plan, search};
use moris_hunter::target::FmuTarget;
use moris_hunter::variables::Variables;

use crate::fixture::library;

fn target() -> FmuTarget {
    FmuTarget::open(&library(), &Variables::new()).unwrap()
}

#[test]
fn half_a_million_steps_break_no_limit() {
    let plan =
        Plan { seed: 2, first_machine: 0, steps: 500_000, machines: u64::MAX, breaches: 1, threads: 2, shrink: true };
    let summary = search(&plan, || Ok(target()), |_| {}).unwrap();
    assert!(
        summary.found.is_empty(),
        "{:?}: {}",
        summary.found[0].failure,
        summary.found[0].episode.to_toml().unwrap()
    );
    assert!(summary.steps >= plan.steps && summary.machines > 5, "{summary:?}");
}

#[test]
fn no_known_episode_breaks_a_limit() {
    let (runner, mut target) = (Runner::new().unwrap(), target());
    let episodes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../hunter/episodes");
    let mut count = 0;
    for file in fs::read_dir(episodes).unwrap() {
        let file = file.unwrap().path();
        let episode = Episode::from_toml(&fs::read_to_string(&file).unwrap()).unwrap();
        runner.make(&episode.parameters, &mut target).unwrap();
        let outcome = runner.run(&episode, &mut target).unwrap();
        assert_eq!((outcome.breach, outcome.steps), (None, episode.count), "{}", file.display());
        count += 1;
    }
    assert!(count >= 5, "{count}");
}
