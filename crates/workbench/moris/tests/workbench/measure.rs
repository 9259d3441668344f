//! `moris measure`: its figures against the crate, stepped here, and what it says of targets.

use std::fmt::Write;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output};

use flate2::Compression;
use flate2::write::GzEncoder;
use moris_washout::interface::AngularVelocityFrame;
use moris_washout::{Input, InputCourse, Parameters, Washout};

const STEP: f64 = 0.01;
const G: f64 = 9.80665;

/// Three seconds from rest, smooth: surge, sway and a roll rate.
fn inputs() -> Vec<Input> {
    (0..=300)
        .map(|k| {
            let t = STEP * f64::from(k);
            let mut input = Input::default();
            input.specific_force.x = 1.5 * (1.3 * t).sin().powi(2);
            input.specific_force.y = 0.8 * (2.1 * t).sin().powi(3);
            input.angular_velocity.x = 0.2 * (2.5 * t).sin().powi(3);
            input
        })
        .collect()
}

fn write_recording(file: &Path) {
    let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for (k, input) in inputs().iter().enumerate() {
        let (f, w) = (input.specific_force, input.angular_velocity);
        writeln!(text, "{},{},{},{},{},{},{}", k as f64 * STEP, f.x, f.y, f.z, w.x, w.y, w.z).unwrap();
    }
    fs::write(file, text).unwrap();
}

fn measure(directory: &Path, arguments: &[&str]) -> (Output, String) {
    let mut all = vec!["measure"];
    all.extend(arguments);
    let output = Command::new(env!("CARGO_BIN_EXE_moris")).args(all).current_dir(directory).output().unwrap();
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    (output, text)
}

/// The cells of the channel's row.
fn cells<'a>(text: &'a str, channel: &str) -> Vec<&'a str> {
    let line = text.lines().find(|line| line.contains(channel)).unwrap_or_else(|| panic!("{channel} in {text}"));
    line[line.find(channel).unwrap() + channel.len()..].split_whitespace().collect()
}

/// RMS errors of surge and sway of a host that advances the washout itself: at each sample, those
/// of the outputs there.
fn errors(advance: impl Fn(&mut Washout, &Input, &Input)) -> [f64; 2] {
    let mut parameters = Parameters::default();
    parameters.conditioning.angular_velocity_frame = AngularVelocityFrame::Body;
    let mut washout = Washout::new(&parameters).unwrap();
    let inputs = inputs();
    let mut squares = [0.0; 2];
    for pair in inputs.windows(2) {
        advance(&mut washout, &pair[0], &pair[1]);
        for (axis, square) in squares.iter_mut().enumerate() {
            let error = washout.output().felt_specific_force[axis] - pair[1].specific_force[axis];
            *square += error * error;
        }
    }
    squares.map(|square| (square / inputs.len() as f64).sqrt())
}

#[test]
fn errors_are_those_of_the_washout_in_the_host_s_steps() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(&directory.path().join("ride.csv"));
    let slopes = errors(|washout, from, to| washout.step_between(from, to, STEP));
    let values = errors(|washout, from, _| washout.step(from, STEP));
    let fine = errors(|washout, from, to| {
        (0..10).for_each(|k| washout.step(&from.towards(to, f64::from(k) / 10.0), 0.1 * STEP));
    });
    assert!((values[1] - slopes[1]).abs() > 1.5e-3, "the hosts can be told apart: {values:?} {slopes:?}");
    let options: [(&[&str], [f64; 2]); 3] =
        [(&[], slopes), (&["--inputs", "values"], values), (&["--inputs", "values", "--step", "0.001"], fine)];
    for (options, expected) in options {
        let arguments = [&["ride.csv", "--fade-in", "0"], options].concat();
        let (output, text) = measure(directory.path(), &arguments);
        assert!(output.status.success(), "{text}");
        for (channel, expected) in ["surge", "sway"].into_iter().zip(expected) {
            let cells = cells(&text, channel);
            assert_eq!(cells[0], "m/s²");
            assert!((cells[3].parse::<f64>().unwrap() - expected).abs() <= 5.1e-4, "{options:?} {channel}: {text}");
        }
        let rest = inputs().iter().map(|input| input.specific_force.x.powi(2)).sum::<f64>() / inputs().len() as f64;
        assert!((cells(&text, "surge")[1].parse::<f64>().unwrap() - rest.sqrt()).abs() <= 5.1e-4, "{text}");
        let mean = (expected[0] * expected[1]).sqrt();
        assert!(text.contains(&format!("2 channels: {mean:.3} m/s²")), "{mean} {text}");
    }
}

/// The comfort of a force is that of the washout, stepped here; a rate has none.
#[test]
fn comfort_is_that_of_the_felt_force_within_the_steps() {
    let directory = tempfile::tempdir().unwrap();
    // A stop at once in surge: more than tilt and travel can follow.
    let stop = |k: usize| if (100..150).contains(&k) { 8.0 } else { 0.0 };
    let rows: String = (0..=400).map(|k| format!("{},{},0,{G},0,0.01,0\n", k as f64 * STEP, stop(k))).collect();
    fs::write(directory.path().join("stop.csv"), format!("time,ax,ay,az,wx,wy,wz\n{rows}")).unwrap();
    let (output, text) = measure(directory.path(), &["stop.csv", "--fade-in", "0"]);
    assert!(output.status.success(), "{text}");

    let mut parameters = Parameters::default();
    parameters.conditioning.angular_velocity_frame = AngularVelocityFrame::Body;
    let inputs: Vec<Input> = (0..=400)
        .map(|k| {
            let mut input = Input::default();
            input.specific_force.x = stop(k);
            input.angular_velocity.y = 0.01;
            input
        })
        .collect();
    let mut washout = Washout::new(&parameters).unwrap().starting_with(&inputs[0]);
    let mut felt = vec![washout.output().felt_specific_force.x];
    for pair in inputs.windows(2) {
        washout.follow(InputCourse::Between(&pair[0], &pair[1]), STEP, |force| felt.push(force.x));
    }
    let desired: Vec<f64> = inputs.iter().map(|input| input.specific_force.x).collect();
    let [shake, jolt, peak] = moris_simulation::measures::comfort::comfort(&desired, &felt, 0.0, STEP).values();
    let largest = felt.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
    assert!((peak - (largest - 8.0).max(0.0)).abs() < 1e-9 && jolt > 0.0);
    let expected = format!("{shake:.2}/{jolt:.1}/{peak:.1}");
    assert!(text.contains("shake/jolt/peak"), "{text}");
    assert_eq!(cells(&text, "surge").iter().rev().nth(3), Some(&expected.as_str()), "{text}");
    assert_eq!(cells(&text, "pitch rate").iter().rev().nth(3), Some(&"–"), "{text}");
}

#[test]
fn targets_that_are_missed_are_named_and_fail_a_check() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(&directory.path().join("ride.csv"));
    let loose = ["--geometric-mean", "9", "--ratio", "9", "--heave", "9", "--limited", "1", "--cues", "1"];
    let (output, text) = measure(directory.path(), &[&["ride.csv", "--check"], &loose[..]].concat());
    assert!(output.status.success() && text.ends_with("All targets are met.\n"), "{text}");

    let tight = ["--geometric-mean", "0.001", "--ratio", "0.001", "--heave", "0", "--cues", "-1"];
    let (output, text) = measure(directory.path(), &[&["ride.csv", "--check"], &tight[..]].concat());
    assert_eq!(output.status.code(), Some(4));
    // A recording that cannot be read is another failure.
    assert_eq!(measure(directory.path(), &["none.csv", "--check"]).0.status.code(), Some(1));
    for expected in ["geometric mean over 2 channels", "ride, surge: ", "ride, sway: ", "ride, heave: ", "Roll rate: "]
    {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    let (output, text) = measure(directory.path(), &[&["ride.csv", "--ratio-except", "ride"], &tight[..]].concat());
    assert!(output.status.success() && !text.contains("ride, surge: "), "without --check it only says so: {text}");
}

#[test]
fn a_folder_stands_for_its_recordings_and_the_bound_is_below_the_error() {
    let directory = tempfile::tempdir().unwrap();
    fs::create_dir(directory.path().join("rides")).unwrap();
    for name in ["b", "a"] {
        write_recording(&directory.path().join(format!("rides/{name}.csv")));
    }
    let (file, packed) = (directory.path().join("rides/b.csv"), directory.path().join("rides/b.csv.gz"));
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(&fs::read(&file).unwrap()).unwrap();
    fs::write(packed, encoder.finish().unwrap()).unwrap();
    fs::remove_file(file).unwrap();
    let (output, text) = measure(directory.path(), &["rides", "--bound"]);
    assert!(output.status.success(), "{text}");
    let first = |name: &str| text.lines().position(|line| line.trim_start().starts_with(name)).unwrap();
    assert!(first("a ") < first("b "), "by name: {text}");
    let cells = cells(&text, "surge");
    let [bound, error] = [cells[2], cells[3]].map(|cell| cell.parse::<f64>().unwrap());
    assert!(bound <= error, "{text}");
}

#[test]
fn steps_that_do_not_fit_and_empty_folders_are_errors_with_a_remedy() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(&directory.path().join("ride.csv"));
    fs::create_dir(directory.path().join("empty")).unwrap();
    for (arguments, expected) in [
        (&["ride.csv", "--step", "0.003"][..], "one must be a multiple of the other"),
        (&["ride.csv", "--step", "0"], "such as 0.001"),
        (&["empty"], "empty: is a directory without CSV files"),
    ] {
        let (output, _) = measure(directory.path(), arguments);
        let printed = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && printed.contains(expected), "{printed}");
    }
}

#[test]
fn gravity_is_no_cue() {
    let directory = tempfile::tempdir().unwrap();
    let rows: String = (0..=200).map(|k| format!("{},0,0,{G},0,0,0\n", f64::from(k) * STEP)).collect();
    fs::write(directory.path().join("rest.csv"), format!("time,ax,ay,az,wx,wy,wz\n{rows}")).unwrap();
    let (output, text) = measure(directory.path(), &["rest.csv"]);
    assert!(output.status.success() && text.contains("0 channels"), "{text}");
    assert!(!text.contains("surge  "), "nothing desired and nothing felt has no row: {text}");
}

#[test]
fn a_preview_of_the_recording_lowers_the_errors_of_the_predictive_strategy() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(&directory.path().join("ride.csv"));
    let error = |preview: &str| {
        let (output, text) = measure(directory.path(), &["ride.csv", "--parameters", "default", "--preview", preview]);
        assert!(output.status.success(), "{text}");
        assert_eq!(text.contains("preview of 2 s"), preview == "2", "{text}");
        cells(&text, "surge")[3].parse::<f64>().unwrap()
    };
    let (without, with) = (error("0"), error("2"));
    assert!(with < 0.7 * without, "{with}, {without}");
    let (output, _) = measure(directory.path(), &["ride.csv", "--preview", "5"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("a time from 0 to 4 s is needed"), "{message}");
}
