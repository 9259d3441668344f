//! The search for a broken limit through the C functions, and what it once found.

use std::fs;
use std::path::Path;

use moris_fmu_tests::hunter::episode::Episode;
use moris_fmu_tests::hunter::oracle::Sample;
use moris_fmu_tests::hunter::run::Runner;
use moris_fmu_tests::hunter::search::{Plan, search};
use moris_fmu_tests::hunter::target::{CrateTarget, FmuTarget, Target};
use moris_fmu_tests::hunter::variables::Variables;

use crate::fixture::library;

fn target() -> FmuTarget {
    FmuTarget::open(&library(), &Variables::new()).unwrap()
}

#[test]
fn a_search_through_the_functions_breaks_no_limit() {
    let steps = crate::cases::cases(500_000, 100_000);
    let plan = Plan { seed: 2, first_machine: 0, steps, machines: u64::MAX, breaches: 1, threads: 2, shrink: true };
    let summary = search(&plan, || Ok(target()), |_| {}).unwrap();
    assert!(
        summary.found.is_empty(),
        "{:?}: {}",
        summary.found[0].failure,
        summary.found[0].episode.to_toml().unwrap()
    );
    assert!(summary.steps >= plan.steps && summary.machines > crate::cases::cases(5, 3), "{summary:?}");
}

/// The last sample of an episode on a target. The episode has this preview and this attacker.
fn last_sample(preview: &str, attacker: &str, mut target: impl Target) -> Sample {
    let text = format!(
        r#"
        count = 300
        steps = {{ form = "even", length = 0.01 }}
        parameters = {{ strategy = 4.0 }}
        inputs."vehicle.specificForce.x" = {{ form = "sine", amplitude = 2.0, frequency = 3.0, phase = 0.0 }}
        inputs."engaged" = {{ form = "flips", amplitude = 1.0, held = 40, seed = 5 }}
        {preview}
        {attacker}
        "#
    );
    let (runner, episode) = (Runner::new().unwrap(), Episode::from_toml(&text).unwrap());
    runner.make(&episode.parameters, &mut target).unwrap();
    assert_eq!(runner.run(&episode, &mut target).unwrap().breach, None);
    target.sample(0.0)
}

#[test]
fn previews_and_attackers_work_as_they_do_on_the_crate() {
    let attacker = r#"attacker = { aim = "stop", every = 10, ahead = 10, tries = 3, seed = 1,
                                   amplitudes = { "vehicle.specificForce.y" = 6.0 } }"#;
    let attacker = attacker.replace('\n', "");
    let preview = |forces: &str| {
        format!(
            "preview = {{ forces = \"{forces}\", amplitude = 4.0, count = [0, 20], step = [0.01, 3.0], held = 3, seed = 2 }}"
        )
    };
    let mut ends = vec![];
    for (preview, attacker) in [
        (String::new(), ""),
        (String::new(), attacker.as_str()),
        (preview("ahead"), ""),
        (preview("contrary"), ""),
        (preview("noise"), attacker.as_str()),
        (preview("jump"), ""),
    ] {
        let through_functions = last_sample(&preview, attacker, target());
        assert_eq!(
            through_functions.length,
            last_sample(&preview, attacker, CrateTarget::default()).length,
            "{preview}"
        );
        // Each makes a difference.
        assert!(!ends.contains(&through_functions.length), "{preview} {attacker}");
        ends.push(through_functions.length);
    }
    // What is no number is refused, and the preview before it holds.
    last_sample(&preview("non-finite"), "", target());
}

#[test]
fn no_known_episode_breaks_a_limit() {
    let (runner, mut target) = (Runner::new().unwrap(), target());
    let episodes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../tests/fmu-tests/episodes");
    let mut count = 0;
    for file in fs::read_dir(episodes).unwrap() {
        let file = file.unwrap().path();
        let episode = Episode::from_toml(&fs::read_to_string(&file).unwrap()).unwrap();
        runner.make(&episode.parameters, &mut target).unwrap();
        let outcome = runner.run(&episode, &mut target).unwrap();
        assert_eq!(outcome.breach, None, "{}", file.display());
        assert!(outcome.steps >= episode.count, "{}", file.display());
        count += 1;
    }
    assert!(count >= 5, "{count}");
}
