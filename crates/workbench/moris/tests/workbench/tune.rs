//! Tuning: the cost against what it must be in cases that are known, the search, and the command.

use std::fmt::Write;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output};

use moris::recording::Recording;
use moris::simulate::Simulation;
use moris::tune::cost::{Aim, COMFORT_BOUNDS, Cost, Objective};
use moris::tune::search::{Budget, evaluate_here, search};
use moris::tune::space::Space;
use moris::words;
use moris_setup::Setup;
use moris_simulation::Manoeuvre;
use moris_washout::interface::{AngularVelocityFrame, TuningGroup};
use moris_washout::nalgebra::Vector3;
use moris_washout::{Input, Parameters, presets};
use rayon::prelude::*;

/// The classical strategy, which is quick to search with.
fn classical() -> Parameters {
    presets::parameters(presets::CLASSICAL)
}

const STEP: f64 = 0.01;
const EQUAL: [f64; 6] = [1.0; 6];
const NO_RESERVE: f64 = 0.0;
const DEFAULT: [TuningGroup; 3] = [TuningGroup::Splitter, TuningGroup::Angular, TuningGroup::Scale];

fn recording(name: &str, duration: f64, input: impl Fn(f64, &mut Input)) -> Recording {
    let sampled = |time| {
        let mut sample = Input::default();
        input(time, &mut sample);
        sample
    };
    Recording {
        name: name.to_owned(),
        manoeuvre: Manoeuvre::sampled(STEP, duration, sampled),
        start: 0.0,
        angular_velocity_frame: AngularVelocityFrame::Body,
        has_orientation: false,
        road: None,
        warnings: Vec::new(),
    }
}

/// Surge and some roll, from rest.
fn weaving() -> Recording {
    recording("weaving", 12.0, |t, input| {
        input.specific_force.x = 1.2 * (0.9 * t).sin() * (t / 3.0).min(1.0);
        input.specific_force.y = 0.5 * (2.1 * t).sin() * (t / 3.0).min(1.0);
        input.angular_velocity.x = 0.1 * (2.1 * t).sin() * (t / 3.0).min(1.0);
    })
}

fn objective(recording: Recording, stroke_reserve: f64) -> Objective {
    Objective::new(recording, &classical(), &EQUAL, stroke_reserve).unwrap()
}

fn simulation(objective: &Objective, parameters: &Parameters) -> Simulation {
    Simulation::of(&objective.recording().replay(), &objective.recording().parameters(parameters), || ()).unwrap()
}

#[test]
fn a_platform_at_rest_scores_1() {
    let objective = objective(weaving(), NO_RESERVE);
    let mut still = classical();
    still.conditioning.force_scale *= 0.0;
    still.conditioning.rate_scale *= 0.0;
    let cost = objective.cost(&simulation(&objective, &still)).unwrap();
    assert!((cost.error - 1.0).abs() < 1e-12, "{cost:?}");
    assert!(cost.channels.iter().zip(objective.desired_rms()).all(|(error, desired)| (error - desired).abs() < 1e-12));
    assert!(cost.is_feasible());
}

#[test]
fn what_is_felt_as_it_is_desired_scores_0_and_half_of_it_half_of_the_parts_for_size() {
    let by_shape = objective(weaving(), NO_RESERVE);
    let by_error = objective(weaving(), NO_RESERVE).with_aim(Aim::Error);
    let mut perfect = simulation(&by_shape, &classical());
    for share in [1.0, 0.5] {
        for (input, output) in perfect.inputs.iter().zip(&mut perfect.outputs) {
            let rest = Input::default().specific_force;
            output.felt_specific_force = rest + share * (input.specific_force - rest);
            output.felt_angular_velocity = share * input.angular_velocity;
        }
        assert!((by_error.cost(&perfect).unwrap().error - (1.0 - share)).abs() < 1e-12);
        assert!((by_shape.cost(&perfect).unwrap().error - 0.5 * (1.0 - share)).abs() < 1e-12);
    }
}

/// A small force with the right sign is better than a large one with the wrong sign for a third of
/// the time, though its sensed error is larger.
#[test]
fn sign_and_time_count_before_size() {
    let by_shape = objective(weaving(), NO_RESERVE);
    let by_error = objective(weaving(), NO_RESERVE).with_aim(Aim::Error);
    let mut felt = simulation(&by_shape, &classical());
    let inputs = felt.inputs.clone();
    let mut errors = |share: f64, late: usize| {
        for (sample, output) in felt.outputs.iter_mut().enumerate() {
            let rest = Input::default().specific_force;
            let earlier = &inputs[sample.saturating_sub(late)];
            output.felt_specific_force = rest + share * (earlier.specific_force - rest);
            output.felt_angular_velocity = inputs[sample].angular_velocity;
        }
        [&by_shape, &by_error].map(|objective| objective.cost(&felt).unwrap())
    };
    let [small, small_sensed] = errors(0.2, 0);
    let [late, late_sensed] = errors(0.8, 60);
    assert!(late.shape.most_inverted_axis().unwrap().1 > 0.15 && small.shape.least_shape().unwrap() > 0.999);
    assert!(late_sensed.error < small_sensed.error, "{} {}", late_sensed.error, small_sensed.error);
    assert!(small.error < 0.9 * late.error, "{} {}", small.error, late.error);
}

/// An axis that is hardly felt any more is not made up for by the other.
#[test]
fn the_size_is_the_geometric_mean_of_surge_and_sway() {
    let objective = objective(weaving(), NO_RESERVE);
    let mut felt = simulation(&objective, &classical());
    let mut error = |surge: f64, sway: f64| {
        for (input, output) in felt.inputs.iter().zip(&mut felt.outputs) {
            output.felt_specific_force = input.specific_force.component_mul(&Vector3::new(surge, sway, 1.0));
            output.felt_angular_velocity = input.angular_velocity;
        }
        objective.cost(&felt).unwrap().error
    };
    assert!(error(0.4, 0.4) < error(0.05, 0.95) - 0.02);
}

/// Heave alone has no shape of surge and sway.
#[test]
fn without_surge_and_sway_the_sensed_error_counts() {
    let heave = recording("heave", 5.0, |t, input| input.specific_force.z += (3.0 * t).sin() * t.min(1.0));
    let by_shape = objective(heave.clone(), NO_RESERVE);
    let by_error = objective(heave, NO_RESERVE).with_aim(Aim::Error);
    let cost = by_shape.coarse_cost(&classical()).unwrap();
    assert_eq!(cost.error, by_error.coarse_cost(&classical()).unwrap().error);
    assert_eq!(cost.shape.axes, [None, None]);
}

/// A slalom that demands more than the rig has is felt backwards with the start values.
#[test]
fn a_search_rights_what_is_felt_the_wrong_way_round() {
    let slalom = recording("slalom", 30.0, |t, input| {
        input.specific_force.y = 4.0 * (1.6 * t).sin() * (t / 3.0).min(1.0);
    });
    let objective = objective(slalom, NO_RESERVE);
    let space = Space::new(&classical(), &DEFAULT);
    let budget = Budget { evaluations: 150, seed: 1 };
    let best = search(&[&objective], &evaluate_here, &space, budget, |_, _| true).unwrap().best[0].parameters;
    let shape = |parameters: &Parameters| {
        let sway = objective.cost(&simulation(&objective, parameters)).unwrap().shape.axes[1].unwrap();
        (sway.shape, sway.inverted, sway.size)
    };
    let (before, after) = (shape(&classical()), shape(&best));
    assert!(before.0 < 0.6 && before.1 > 0.15, "{before:?}");
    assert!(after.0 > 0.85 && after.1 < 0.02 && after.2 > 0.1, "{after:?}");
}

#[test]
fn only_channels_with_weight_count() {
    let mut weights = [0.0; 6];
    weights[1] = 2.0;
    let objective = Objective::new(weaving(), &classical(), &weights, NO_RESERVE).unwrap();
    let cost = objective.cost(&simulation(&objective, &classical())).unwrap();
    let sway = cost.shape.axes[1].unwrap();
    let sensed = cost.channels[1] / objective.desired_rms()[1];
    let error = 0.5 * (1.0 - sway.shape + 2.0 * sway.inverted) + 0.25 * (1.0 - sway.size) + 0.25 * sensed;
    assert!((cost.error - error).abs() < 1e-12, "{} {error}", cost.error);
    let objective = objective.with_aim(Aim::Error);
    let cost = objective.cost(&simulation(&objective, &classical())).unwrap();
    assert!((cost.error - cost.channels[1] / objective.desired_rms()[1]).abs() < 1e-12);
}

#[test]
fn the_search_s_short_way_comes_to_what_a_recording_comes_to() {
    let objective = objective(weaving(), NO_RESERVE);
    let mut parameters = classical();
    parameters.structure.max_step = STEP;
    parameters.splitter.omega1.x = 1.3;
    parameters.angular.zeta2.roll = 0.6;
    parameters.conditioning.rate_scale.x = 0.4;
    assert_eq!(objective.coarse_cost(&parameters), objective.cost(&simulation(&objective, &parameters)));
}

#[test]
fn limits_that_act_and_a_reserve_that_is_touched_are_violations() {
    let wild = recording("wild", 3.0, |t, input| input.specific_force.z += 7.0 * (8.0 * t).sin() * t.min(1.0));
    let tight = objective(wild.clone(), 0.29);
    let loose = objective(wild, NO_RESERVE);
    let simulation = simulation(&loose, &classical());
    let acted = simulation.outputs.iter().filter(|output| output.safety_active || output.actuator_limited).count();
    assert_eq!(loose.cost(&simulation).unwrap().violated, acted as f64 / simulation.outputs.len() as f64);
    assert!(tight.cost(&simulation).unwrap().violated > loose.cost(&simulation).unwrap().violated);
}

#[test]
fn comfort_is_bounded_by_the_greater_of_bound_and_start() {
    let wild = recording("wild", 3.0, |t, input| input.specific_force.z += 7.0 * (8.0 * t).sin() * t.min(1.0));
    let mut calm = classical();
    calm.conditioning.force_scale *= 0.1;
    let from = |start: &Parameters, bounds| {
        Objective::new(wild.clone(), start, &EQUAL, NO_RESERVE).unwrap().with_comfort_bounds(bounds)
    };
    let rough = classical();
    let tight = from(&calm, [1e-3; 3]);
    let cost = tight.cost(&simulation(&tight, &rough)).unwrap();
    assert!(cost.excess > 1.0 && cost.comfort[1] > 0.1, "{cost:?}");
    assert!(!Cost { violated: 0.0, ..cost }.is_feasible());
    assert!(tight.coarse_cost(&rough).unwrap().excess > 1.0);
    for (start, bounds) in [(&rough, [1e-3; 3]), (&calm, cost.comfort), (&calm, [f64::INFINITY; 3])] {
        let objective = from(start, bounds);
        assert_eq!(objective.cost(&simulation(&objective, &rough)).unwrap().excess, 0.0);
    }
    for objective in [&tight, &from(&rough, [1e-3; 3])] {
        assert_eq!(objective.coarse_cost(objective.start()).unwrap().excess, 0.0);
    }
}

#[test]
fn parameters_beyond_the_bounds_of_comfort_never_win() {
    let objective = objective(weaving(), NO_RESERVE);
    let start = classical();
    let space = Space::new(&start, &[TuningGroup::Splitter]);
    let budget = Budget { evaluations: 150, seed: 1 };
    let bound = 1.2 * start.splitter.omega1.x;
    // The error falls with the frequency.
    let best = |excess: f64| {
        let evaluate = move |_: &[&Objective], parameters: &Parameters| {
            let omega = parameters.splitter.omega1.x;
            let excess = if omega > bound { excess } else { 0.0 };
            Ok(vec![Cost { error: 1.0 / omega, excess, ..Cost::default() }])
        };
        search(&[&objective], &evaluate, &space, budget, |_, _| true).unwrap().best
    };
    assert!(best(0.0)[0].parameters.splitter.omega1.x > 2.0 * bound);
    for excess in [1e-9, 1.0] {
        let best = best(excess);
        assert!(!best.is_empty() && best.iter().all(|found| found.parameters.splitter.omega1.x <= bound));
    }
}

fn searched(threads: usize, seed: u64) -> Parameters {
    let (first, second) = (objective(weaving(), NO_RESERVE), objective(brisk(), NO_RESERVE));
    let space = Space::new(&classical(), &DEFAULT);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let budget = Budget { evaluations: crate::cases::cases(120, 30), seed };
    pool.install(|| search(&[&first, &second], &evaluate_here, &space, budget, |_, _| true).unwrap().best[0].parameters)
}

fn brisk() -> Recording {
    recording("brisk", 10.0, |t, input| input.specific_force.x = 1.5 * ((t - 1.0) / 0.5).clamp(0.0, 1.0))
}

#[test]
fn the_search_finds_the_same_however_many_threads_there_are_and_another_for_another_seed() {
    let alone = searched(1, 1);
    assert_eq!(alone, searched(4, 1));
    assert_ne!(alone, searched(4, 2));
}

/// A quarter of the stack that a thread usually has: code that is not optimised takes as much more.
#[test]
fn recordings_and_their_search_fit_on_a_small_stack() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(8).stack_size(512 << 10).build().unwrap();
    let made = |recording: Recording| objective(recording, NO_RESERVE).with_comfort_bounds(COMFORT_BOUNDS);
    let best = pool.install(|| {
        let objectives: Vec<Objective> = [weaving(), brisk(), weaving()].into_par_iter().map(made).collect();
        let space = Space::new(&classical(), &DEFAULT);
        let objectives: Vec<&Objective> = objectives.iter().collect();
        search(&objectives, &evaluate_here, &space, Budget { evaluations: 20, seed: 1 }, |_, _| true).unwrap().best
    });
    assert!(!best.is_empty());
}

#[test]
fn the_search_finds_something_better_that_keeps_the_limits() {
    let objective = objective(weaving(), NO_RESERVE);
    let start = classical();
    let space = Space::new(&start, &DEFAULT);
    let mut tried = Vec::new();
    let budget = Budget { evaluations: 600, seed: 3 };
    let searched = search(&[&objective], &evaluate_here, &space, budget, |count, best| {
        tried.push((count, best.map(|best| best.error)));
        true
    });
    let best = &searched.unwrap().best;
    let cost = |parameters: &Parameters| objective.cost(&simulation(&objective, parameters)).unwrap();
    let (before, after) = (cost(&start), cost(&best[0].parameters));
    assert!(after.is_feasible() && after.error < 0.9 * before.error, "{} {}", before.error, after.error);
    // The scan tells its best before the search counts.
    let scanned = tried.iter().take_while(|(count, _)| *count == 0).count();
    assert!(scanned == 7 && tried[0].1.is_some());
    let errors: Vec<f64> = tried[scanned - 1..].iter().map(|(_, error)| error.unwrap()).collect();
    assert!(tried[scanned - 1..].windows(2).all(|pair| pair[0].0 < pair[1].0), "progress goes on");
    assert!(errors.windows(2).all(|pair| pair[1] <= pair[0] + 0.01), "and down");
    assert!(best[1..].windows(2).all(|pair| pair[0].error <= pair[1].error + 0.01));
}

#[test]
fn the_search_takes_the_order_that_serves_best() {
    let objective = objective(weaving(), NO_RESERVE).with_aim(Aim::Error);
    let budget = Budget { evaluations: 120, seed: 1 };
    let best = |order: i32, groups: &[TuningGroup]| {
        let mut start = classical();
        start.structure.splitter_order = order;
        // Short of travel, at high break frequencies.
        (start.splitter.omega1, start.splitter.omega2) = ([3.0, 2.2, 5.0].into(), [2.0, 1.0, 0.3].into());
        start.splitter.zeta1 = [1.3, 1.6, 1.0].into();
        // A slow tilt, which leaves it to travel what a higher order takes.
        (start.tilt.rate_limit, start.tilt.acceleration_limit) = (0.045, 0.11);
        let space = Space::new(&start, groups);
        search(&[&objective], &evaluate_here, &space, budget, |_, _| true).unwrap().best[0].clone()
    };
    let errors = [2, 3, 4].map(|order| best(order, &[TuningGroup::Scale]).error);
    assert!(errors[0] > errors[1] + 0.005 && errors[1] > errors[2] + 0.005, "{errors:?}");
    let free = best(2, &[TuningGroup::Scale, TuningGroup::Order]);
    assert_eq!(free.parameters.structure.splitter_order, 4);
    assert!((free.error - errors[2]).abs() < 0.005, "{} {errors:?}", free.error);
}

#[test]
fn groups_without_a_number_to_search_are_an_error_with_a_remedy() {
    let objective = objective(weaving(), NO_RESERVE);
    for group in [TuningGroup::Order, TuningGroup::Strategy] {
        let space = Space::new(&classical(), &[group]);
        let budget = Budget { evaluations: 10, seed: 1 };
        let error = search(&[&objective], &evaluate_here, &space, budget, |_, _| true).unwrap_err();
        assert!(words::error(&error).contains("--tune"), "{error}");
    }
}

#[test]
fn a_search_that_is_broken_off_keeps_what_it_has() {
    let objective = objective(weaving(), NO_RESERVE);
    let space = Space::new(&classical(), &DEFAULT);
    let mut generations = 0;
    let budget = Budget { evaluations: 100_000, seed: 1 };
    let searched = search(&[&objective], &evaluate_here, &space, budget, |_, _| {
        generations += 1;
        generations < 3
    });
    assert_eq!(generations, 3);
    assert!(!searched.unwrap().best.is_empty());
}

#[test]
fn what_the_rides_have_nothing_to_say_about_stays_as_it_was() {
    let objective = objective(brisk(), NO_RESERVE);
    let start = classical();
    let space = Space::new(&start, &DEFAULT);
    let best =
        search(&[&objective], &evaluate_here, &space, Budget { evaluations: 300, seed: 1 }, |_, _| true).unwrap().best;
    let tuned = best[0].parameters;
    assert_eq!(tuned.splitter.omega1.y, start.splitter.omega1.y);
    assert_eq!(tuned.angular.omega1.yaw, start.angular.omega1.yaw);
    assert_eq!(tuned.conditioning.rate_scale, start.conditioning.rate_scale);
    assert_ne!(tuned.splitter, start.splitter);
}

fn moris(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moris")).args(arguments).current_dir(directory).output().unwrap()
}

fn write_recording(directory: &Path, recording: &Recording) {
    let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for (time, input) in recording.times().zip(recording.inputs()) {
        let (f, w) = (input.specific_force, input.angular_velocity);
        writeln!(text, "{time},{},{},{},{},{},{}", f.x, f.y, f.z, w.x, w.y, w.z).unwrap();
    }
    fs::write(directory.join(format!("{}.csv", recording.name)), text).unwrap();
}

#[test]
fn the_command_writes_parameters_and_reports_and_tries_each_ride_without_having_tuned_on_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    write_recording(here, &weaving());
    write_recording(here, &brisk());
    let evaluations = crate::cases::cases("100", "20");
    let command = ["tune", "weaving.csv", "brisk.csv", "--strategy", "classical", "--evaluations", evaluations];
    let output = moris(here, &[&command[..], &["--report", "out"]].concat());
    let printed = String::from_utf8(output.stdout).unwrap();
    // Two rides that have little in common: what is tuned on one may be worse on the other, and then it is said first.
    let first = printed.lines().next().unwrap();
    assert!(
        ["WORSE than before", "Better than before", "Not clearly better"].iter().any(|start| first.starts_with(start)),
        "{printed}"
    );
    let status = if first.starts_with("WORSE") { 4 } else { 0 };
    assert_eq!(output.status.code(), Some(status), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(fs::read_to_string(here.join("tuned.toml")).unwrap().starts_with(&format!("# {first}")));
    assert!(printed.contains("On recordings that it was not tuned on, the mean error goes from"), "{printed}");
    assert!(!printed.lines().any(|line| line.starts_with("| weaving") && line.contains('–')), "{printed}");
    let tuned = Setup::load(None, &[here.join("tuned.toml").display().to_string()]).unwrap();
    assert_ne!(tuned.parameters, classical());
    for file in ["out/tune.md", "out/weaving.tuned.html", "out/brisk.tuned.html"] {
        assert!(here.join(file).exists(), "{file}");
    }
    let again = moris(here, &[&command[..], &["--output", "again.toml"]].concat());
    assert_eq!(again.status.code(), Some(status));
    assert_eq!(fs::read(here.join("tuned.toml")).unwrap(), fs::read(here.join("again.toml")).unwrap());
}

#[test]
fn rides_that_are_held_out_are_not_tuned_on() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    write_recording(here, &weaving());
    write_recording(here, &brisk());
    let alone = moris(
        here,
        &["tune", "weaving.csv", "--strategy", "classical", "--evaluations", "60", "--output", "alone.toml"],
    );
    let printed = String::from_utf8(alone.stdout).unwrap();
    assert!(printed.contains("No recording was held out: nothing is known of other recordings."), "{printed}");
    let tried = moris(
        here,
        &[
            "tune",
            "weaving.csv",
            "--strategy",
            "classical",
            "--evaluations",
            "60",
            "--output",
            "tried.toml",
            "--hold-out",
            "brisk.csv",
        ],
    );
    let printed = String::from_utf8(tried.stdout).unwrap();
    assert!(printed.contains("On recordings that it was not tuned on"), "{printed}");
    let values = |file: &str| {
        let text = fs::read_to_string(here.join(file)).unwrap();
        text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(values("alone.toml"), values("tried.toml"));
}

#[test]
fn a_rig_s_values_are_not_written_into_the_parameter_file() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    write_recording(here, &brisk());
    let rig = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../examples/rigs/long-stroke.toml");
    let output = moris(here, &["tune", "brisk.csv", "--evaluations", "60", "--rig", rig, "--parameters", "paper"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(here.join("tuned.toml")).unwrap();
    assert!(!text.contains("rig.base") && !text.contains("actuator."), "{text}");
    assert!(text.contains("\"splitter.y.omega1\" = 2.5"), "the set that it started from is not the default: {text}");
}

#[test]
fn a_ride_that_cannot_be_kept_within_the_limits_is_named() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), &weaving());
    let output = moris(
        directory.path(),
        &["tune", "weaving.csv", "--strategy", "classical", "--evaluations", "40", "--stroke-reserve", "0.31"],
    );
    assert!(!output.status.success());
    let printed = String::from_utf8(output.stderr).unwrap();
    assert!(
        printed.contains("no parameters were found") && printed.contains("weaving for 100.00 % of its time"),
        "{printed}"
    );
    assert!(!directory.path().join("tuned.toml").exists());
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_best_so_far() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), &weaving());
    write_recording(directory.path(), &brisk());
    let mut child = Command::new(env!("CARGO_BIN_EXE_moris"))
        .args(["tune", "weaving.csv", "brisk.csv", "--strategy", "classical", "--evaluations", "10000000"])
        .current_dir(directory.path())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut reports = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    reports.read_line(&mut line).unwrap();
    assert!(line.contains("Ctrl-C"), "{line}");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{printed}");
    assert!(printed.contains("was interrupted") && printed.contains("No recording was held out"), "{printed}");
    assert!(directory.path().join("tuned.toml").exists());
}

#[cfg(unix)]
#[test]
fn a_second_ctrl_c_writes_the_best_so_far_before_it_ends() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), &weaving());
    let mut child = Command::new(env!("CARGO_BIN_EXE_moris"))
        .args(["tune", "weaving.csv", "--strategy", "classical", "--evaluations", "10000000"])
        .current_dir(directory.path())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut reports = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("first result after") {
        line.clear();
        assert!(reports.read_line(&mut line).unwrap() > 0, "it ends before its first result");
    }
    // Two signals that are sent before the first is taken count once.
    let mut presses = 0;
    while child.try_wait().unwrap().is_none() {
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        presses += 1;
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let status = child.wait().unwrap();
    // The first press alone may have been enough: the check of so short a ride takes no time.
    assert!(presses >= 2 && (status.code() == Some(130) || status.success()), "{status} after {presses}");
    let text = fs::read_to_string(directory.path().join("tuned.toml")).unwrap();
    assert!(Setup::load(None, &[directory.path().join("tuned.toml").display().to_string()]).is_ok());
    let first = text.lines().next().unwrap();
    assert!(first.contains("the best so far") || first.contains("No recording was held out"), "{first}");
}

#[test]
fn each_strategy_is_tuned_and_a_table_has_the_winner() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    write_recording(here, &brisk());
    let output = moris(
        here,
        &["tune", "brisk.csv", "--strategy", "all", "--tune", "scale", "--evaluations", "10", "--output", "best.toml"],
    );
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{printed}{}", String::from_utf8_lossy(&output.stderr));
    let row = |name: &str| printed.lines().find(|line| line.starts_with(&format!("| {name} "))).map(str::to_owned);
    let tuned = |name: &str| row(name).unwrap().split('|').nth(3).unwrap().trim().parse::<f64>().unwrap();
    let winner = printed.lines().find_map(|line| line.strip_prefix("winner: ")).unwrap();
    for name in ["classical", "adaptive", "optimal", "predictive", "robust"] {
        assert!(tuned(winner) <= tuned(name), "{printed}");
        assert!(here.join(format!("best.{name}.toml")).exists(), "{name}");
        assert!(fs::read_to_string(here.join("moris-report/tune.md")).unwrap().contains(&format!("from {name} on")));
    }
    let files = [format!("best.{winner}.toml"), "best.toml".to_owned()].map(|file| fs::read(here.join(file)).unwrap());
    assert_eq!(files[0], files[1]);
    assert!(here.join("moris-report/brisk.tuned.html").exists());
}

/// Parameters for one ride are worse on another, and are written all the same.
#[test]
fn worse_parameters_have_an_exit_status_of_their_own() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    write_recording(here, &weaving());
    write_recording(here, &brisk());
    let arguments = [
        "tune",
        "weaving.csv",
        "--strategy",
        "classical",
        "--folds",
        "0",
        "--evaluations",
        "100",
        "--hold-out",
        "brisk.csv",
    ];
    let output = moris(here, &arguments);
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(
        printed.starts_with("WORSE than before on recordings that it was not tuned on: brisk (error "),
        "{printed}"
    );
    assert_eq!(output.status.code(), Some(4));
    assert!(here.join("tuned.toml").exists());
    // An unknown option is no result.
    assert_eq!(moris(here, &["tune", "weaving.csv", "--no-such-option"]).status.code(), Some(2));
}
