//! `moris worst-case`: the loop of washout and platform, and the table.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::cases::cases;
use moris::recording::{Conventions, Recording};
use moris_analysis::worst_case::commands::{Commands, LONGEST_STEP};
use moris_analysis::worst_case::figures::{Desired, Measure, over_rides};
use moris_analysis::worst_case::machine::real_motion;
use moris_analysis::worst_case::points::{Point, points};
use moris_analysis::worst_case::study::Study;
use moris_simulation::measures::comfort::comfort;
use moris_stewart_platform::{Input, Model, Parameters as Platform, StewartPlatform};
use moris_washout::Parameters;
use moris_washout::interface::StrategyKind;
use moris_washout::nalgebra::Vector3;

const SAMPLE: f64 = 0.01;
const G: f64 = 9.80665;
const HEADER: &str = "time,ax,ay,az,wx,wy,wz,lean";

/// Eight seconds from rest, smooth: surge, sway, heave, a roll rate and the rider's lean.
fn ride() -> String {
    let mut text = format!("{HEADER}\n");
    for k in 0..=800 {
        let t = SAMPLE * f64::from(k);
        let [x, y, z] = [1.5 * (1.3 * t).sin().powi(3), 0.8 * (2.1 * t).sin().powi(3), 0.5 * (1.7 * t).sin().powi(3)];
        let [roll, lean] = [0.2 * (2.5 * t).sin().powi(3), 0.1 * (1.9 * t).sin().powi(3)];
        writeln!(text, "{t},{x},{y},{},{roll},0,0,{lean}", G + z).unwrap();
    }
    text
}

fn recording() -> Recording {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("ride.csv");
    fs::write(&file, ride()).unwrap();
    Recording::read(&file, &Conventions::default()).unwrap()
}

/// Drives of this natural frequency without dead time.
fn drives(bandwidth: f64) -> Platform {
    let mut platform = Platform::default();
    platform.actuators.bandwidth = bandwidth;
    platform.actuators.dead_time = 0.0;
    platform
}

fn largest_difference<'a>(pairs: impl Iterator<Item = (&'a Vector3<f64>, &'a Vector3<f64>)>) -> f64 {
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

fn figures(desired: &Desired, felt: &[Vector3<f64>]) -> [f64; 3] {
    over_rides([desired.compared_with(felt)].iter()).unwrap()
}

/// Fast drives follow a ramp 2 z/w late, and are otherwise the command.
#[test]
fn fast_drives_without_dead_time_reproduce_what_the_washout_says_is_felt() {
    let (recording, step) = (recording(), 0.0002);
    for strategy in StrategyKind::ALL {
        let mut parameters = Parameters::default();
        parameters.structure.strategy = *strategy;
        let commands = Commands::of(&recording, &parameters, step).unwrap();
        // A lag of 2 ms: ten steps.
        let samples = 10;
        let mut platform = drives(0.0);
        platform.actuators.bandwidth = 2.0 * platform.actuators.damping / (f64::from(samples) * step);
        let real = real_motion(&commands, &platform).unwrap();
        assert!(!real.drive_limited && !real.force_limited);

        let error = largest_difference(real.felt.iter().zip(&commands.felt));
        assert!(error < 0.05, "{}: {error}", strategy.name());
        let error = largest_difference(real.felt[samples as usize..].iter().zip(&commands.felt));
        assert!(error < 0.02, "{} beside its lag: {error}", strategy.name());

        let desired = Desired::of(&recording, &commands);
        let [commanded, real] = [&commands.felt, &real.felt].map(|felt| figures(&desired, felt));
        for (measure, tolerance) in [(Measure::Error, 0.002), (Measure::Shake, 0.001), (Measure::Jolt, 0.01)] {
            let error = (real[measure as usize] - commanded[measure as usize]).abs();
            assert!(error < tolerance, "{} {measure:?}: {real:?}, not {commanded:?}", strategy.name());
        }
    }
}

/// The model moved here, with its own head.
#[test]
fn the_felt_force_is_that_of_the_platform_s_own_head() {
    let recording = recording();
    let commands = Commands::of(&recording, &Parameters::default(), LONGEST_STEP).unwrap();
    let real = real_motion(&commands, &Platform::default()).unwrap();
    let mut parameters = Platform::default();
    parameters.setting.max_step = commands.step;
    let mut platform = StewartPlatform::new(&parameters, &Input::default()).unwrap();
    let input = |k: usize| Input { length: commands.lengths[k], lean: commands.leans[k], ..Input::default() };
    assert_eq!(commands.lengths.len(), 4001);
    for k in 0..4000 {
        platform.step_between(&input(k), &input(k + 1), commands.step);
        let error = (platform.output().felt_specific_force - real.felt[k + 1]).norm();
        assert!(error < 1e-9, "{error} at {k}");
    }
    // A platform at rest feels none of this.
    assert!(real.felt.iter().any(|felt| felt.x > 0.5) && commands.leans.iter().any(|lean| *lean > 0.09));
}

#[test]
fn a_dead_time_shifts_what_is_felt_by_exactly_that() {
    let mut recording = recording();
    // The lean moves the head without delay.
    let upright = recording.inputs().iter().map(|input| moris_washout::Input { lean: 0.0, ..*input }).collect();
    recording.manoeuvre = moris_simulation::Manoeuvre::new(SAMPLE, upright);
    let commands = Commands::of(&recording, &Parameters::default(), LONGEST_STEP).unwrap();
    let felt = |dead_time: f64| {
        let platform = Platform::default();
        let point = Point { dead_time, ..Point::nominal(&platform) };
        real_motion(&commands, &point.parameters(&platform)).unwrap().felt
    };
    let at_once = felt(0.0);
    for samples in [1, 2, 10, 25] {
        let late = felt(commands.step * samples as f64);
        let error = largest_difference(late[samples..].iter().zip(&at_once));
        assert!(error < 1e-8, "{error} with {samples} samples");
        let rest = Vector3::new(0.0, 0.0, G);
        assert!(late[..samples].iter().all(|felt| (felt - rest).norm() < 1e-9));
    }
    let moved = largest_difference(at_once[25..].iter().zip(&at_once));
    assert!(moved > 0.02, "a shift can be seen: {moved}");
}

/// Drives follow their commands whatever the load, until they lack the force.
#[test]
fn a_load_counts_where_drives_lack_the_force_for_it() {
    let recording = recording();
    let commands = Commands::of(&recording, &Parameters::default(), LONGEST_STEP).unwrap();
    let felt = |force_limit: f64, load: f64| {
        let mut platform = Platform::default();
        platform.actuators.force_limit = force_limit;
        let point = Point { load, ..Point::nominal(&platform) };
        real_motion(&commands, &point.parameters(&platform)).unwrap()
    };
    let (strong, heavy) = (felt(4000.0, 1.0), felt(4000.0, 1.5));
    assert!(!heavy.force_limited && largest_difference(strong.felt.iter().zip(&heavy.felt)) < 1e-8);
    let weak = felt(1000.0, 1.5);
    assert!(weak.force_limited && largest_difference(strong.felt.iter().zip(&weak.felt)) > 0.05);
}

#[test]
fn figures_are_those_of_the_definitions() {
    let recording = recording();
    let commands = Commands::of(&recording, &Parameters::default(), LONGEST_STEP).unwrap();
    let real = real_motion(&commands, &Platform::default()).unwrap();
    let [error, shake, jolt] = figures(&Desired::of(&recording, &commands), &real.felt);
    let (mut product, mut largest) = (1.0, [0.0f64; 2]);
    for axis in 0..2 {
        let desired: Vec<f64> = recording.inputs().iter().map(|input| input.specific_force[axis]).collect();
        let felt: Vec<f64> = real.felt.iter().map(|felt| felt[axis]).collect();
        let squares: f64 = desired.iter().enumerate().map(|(k, desired)| (felt[5 * k] - desired).powi(2)).sum();
        product *= (squares / desired.len() as f64).sqrt();
        let values = comfort(&desired, &felt, 0.0, SAMPLE).values();
        largest = [largest[0].max(values[0]), largest[1].max(values[1])];
    }
    assert!((error - f64::sqrt(product)).abs() < 1e-12 && [shake, jolt] == largest);
    assert!(error > 0.03 && jolt > 0.0);
}

#[test]
fn the_worst_is_the_largest_of_all_machines_and_never_below_the_nominal_one() {
    let (rides, platform) = ([recording()], Platform::default());
    let points = points(&platform, 4, 1).unwrap();
    let study = Study::of(StrategyKind::Classical, &rides, &Parameters::default(), &platform, &points, &|| ()).unwrap();
    assert_eq!(study.machines.len(), points.len());
    assert_eq!(study.machines[0].point, Point::nominal(&platform));
    for measure in Measure::ALL {
        let values: Vec<f64> = study.machines.iter().map(|machine| machine.figures[measure as usize]).collect();
        let worst = study.worst(measure).figures[measure as usize];
        let largest = values.iter().copied().fold(0.0, f64::max);
        assert!(worst >= values[0] && worst > largest * (1.0 - 2e-6) && worst <= largest, "{measure:?}: {values:?}");
        // The load has no effect, so that the nominal one is named.
        assert!(study.worst(measure).point.load == 1.0 || !points[..27].contains(&study.worst(measure).point));
    }
    // The points differ in what is felt.
    assert!(study.machines[0].figures != study.worst(Measure::Error).figures);
}

fn worst_case(directory: &Path, arguments: &[&str]) -> (Output, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_moris"))
        .arg("worst-case")
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    (output, text)
}

#[test]
fn the_same_seed_prints_the_same_table() {
    let directory = tempfile::tempdir().unwrap();
    fs::create_dir(directory.path().join("rides")).unwrap();
    fs::write(directory.path().join("rides/a.csv"), ride()).unwrap();
    let (points, machines) = cases(("6", 33), ("3", 30));
    let options = ["rides", "--strategy", "optimal,predictive", "--points", points, "--seed", "3"];
    let (output, text) = worst_case(directory.path(), &options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    if cases(true, false) {
        assert_eq!(text, worst_case(directory.path(), &options).1);
    }
    let begin = format!("default rig, parameters default, 1 recordings, {machines} machines\n");
    assert!(text.starts_with(&begin), "{text}");
    let rows = |word: &str| text.lines().filter(|line| line.contains(word)).count();
    assert_eq!([rows("optimal"), rows("predictive"), rows("classical"), rows("shake")], [2, 2, 0, 2], "{text}");

    // A machine of one's own, with drives of 1 Hz.
    fs::write(directory.path().join("slow.toml"), "actuator.bandwidth = 6.3\n").unwrap();
    let error = |text: &str| -> f64 {
        let line = text.lines().find(|line| line.contains("RMS error") && line.contains("predictive")).unwrap();
        line.split_whitespace().nth(4).unwrap().parse().unwrap()
    };
    let (_, slow) = worst_case(
        directory.path(),
        &[&["rides", "--strategy", "predictive"], &options[3..], &["--platform", "slow.toml"]].concat(),
    );
    assert!(error(&slow) > 1.1 * error(&text), "{slow}\n{text}");
}

#[test]
fn errors_name_a_remedy_and_fail() {
    let directory = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(directory.path().join(name), text).unwrap();
    fs::create_dir(directory.path().join("empty")).unwrap();
    write("ride.csv", &ride());
    let rest: String = (0..=200).map(|k| format!("{},0,0,{G},0,0,0,0\n", f64::from(k) * SAMPLE)).collect();
    write("rest.csv", &format!("{HEADER}\n{rest}"));
    write("weak.toml", "actuator.forceLimit = 800\n");
    write("late.toml", "actuator.deadTime = 0.5\n");
    write("wrong.toml", "actuator.bandwith = 60\n");
    for (arguments, expected) in [
        (&["empty"][..], "empty: is a directory without CSV files"),
        (&["rest.csv"], "take one with motion"),
        (&["ride.csv", "--platform", "weak.toml"], "raise the limit or lower the masses"),
        (&["ride.csv", "--platform", "late.toml"], "give a platform with at most 0.05 s"),
        (&["ride.csv", "--platform", "wrong.toml"], "actuator.bandwidth"),
        (&["ride.csv", "--platform", "none.toml"], "cannot read none.toml"),
        (&["ride.csv", "--strategy", "fast"], "predictive"),
        (&["ride.csv", "--points", "many"], "--points"),
    ] {
        let (output, text) = worst_case(directory.path(), arguments);
        let printed = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && text.is_empty() && printed.contains(expected), "{printed}");
    }
}
