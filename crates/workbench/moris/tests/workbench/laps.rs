//! Previews that are learned by the position, over recordings.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use moris_simulation::measures::shape::below_cue_frequency;

/// Duration of a round \[s\].
const ROUND: f64 = 30.0;
const STEP: f64 = 0.02;

/// Rounds of a circle with brakes and bends at its places, and the position in columns of these
/// names.
fn write_rounds(file: &Path, rounds: f64, [x, y]: [&str; 2]) {
    let mut text = format!("time,ax,ay,az,wx,wy,wz,{x},{y},speed\n");
    for k in 0..(rounds * ROUND / STEP) as usize {
        let angle = std::f64::consts::TAU * k as f64 * STEP / ROUND;
        let (surge, sway) = (1.5 * (4.0 * (3.0 * angle).sin()).tanh(), 1.5 * (4.0 * (4.0 * angle).cos()).tanh());
        let (x, y, speed) = (80.0 * angle.cos(), 80.0 * angle.sin(), 80.0 * std::f64::consts::TAU / ROUND);
        writeln!(text, "{},{surge},{sway},9.80665,0,0,0,{x},{y},{speed}", k as f64 * STEP).unwrap();
    }
    fs::write(file, text).unwrap();
}

fn moris(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moris")).current_dir(directory).args(arguments).output().unwrap()
}

#[test]
fn rounds_are_simulated_with_a_learned_preview_beside_the_strategy_without_it() {
    let directory = tempfile::tempdir().unwrap();
    write_rounds(&directory.path().join("rounds.csv"), 3.0, ["x", "y"]);
    let learned = ["--strategy", "predictive", "--learn", "--no-bound", "--json"];
    let output = moris(directory.path(), &[&["simulate", "rounds.csv"], &learned[..]].concat());
    let message = String::from_utf8_lossy(&output.stderr);
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{message}"));
    let results = all[0]["results"].as_array().unwrap();
    let names: Vec<&str> = results.iter().map(|result| result["parameters"].as_str().unwrap()).collect();
    assert_eq!(names, ["predictive", "predictive, learned preview"]);

    // Error of the felt sway below 2 Hz in the first and the last round.
    let errors = |name: &str| {
        let file = directory.path().join("moris-report").join(name);
        let text = fs::read_to_string(file).unwrap();
        let mut lines = text.lines();
        let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
        let place = |name: &str| heads.iter().position(|head| *head == name).unwrap();
        let places = ["vehicle.specificForce.y", "rider.specificForce.y"].map(place);
        let rows: Vec<[f64; 2]> = lines
            .map(|line| {
                let fields: Vec<&str> = line.split(',').collect();
                places.map(|place| fields[place].parse().unwrap())
            })
            .collect();
        let [desired, felt] = [0, 1].map(|side| {
            let values: Vec<f64> = rows.iter().map(|row| row[side]).collect();
            below_cue_frequency(&values, STEP).unwrap()
        });
        let round = (ROUND / STEP) as usize;
        [0, 2].map(|number| {
            let range = number * round..(number + 1) * round;
            let squares = desired[range.clone()].iter().zip(&felt[range]).map(|(d, f)| (d - f).powi(2));
            (squares.sum::<f64>() / round as f64).sqrt()
        })
    };
    let plain = errors("rounds.outputs.csv");
    let learned = errors("rounds.predictive-learned-preview.outputs.csv");
    assert!((plain[0] - learned[0]).abs() < 1e-3, "nothing is known in the first round: {plain:?} {learned:?}");
    assert!(learned[1] < 0.85 * plain[1], "{learned:?} {plain:?}");
}

#[test]
fn positions_of_other_names_and_units_are_measured_and_missing_ones_named() {
    let directory = tempfile::tempdir().unwrap();
    write_rounds(&directory.path().join("rounds.csv"), 2.0, ["east [m]", "north [m]"]);
    let measure = |more: &[&str]| {
        let output = moris(directory.path(), &[&["measure", "rounds.csv", "--parameters", "default"], more].concat());
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat()
    };
    let named = measure(&["--learn", "--columns", "x=east,y=north"]);
    assert!(named.contains("learned preview"), "{named}");
    let rows = |text: &str| text.lines().filter(|line| line.contains("sway")).collect::<Vec<_>>().join("\n");
    assert_ne!(rows(&named), rows(&measure(&[])));
    let missing = measure(&["--learn"]);
    assert!(missing.contains("x, y") || missing.contains("x and y"), "{missing}");
    let refused = moris(directory.path(), &["simulate", "rounds.csv", "--strategy", "classical", "--learn"]);
    let message = String::from_utf8_lossy(&refused.stderr);
    assert!(message.contains("--learn is for the predictive strategy alone"), "{message}");
}

/// The row of the sway in what `measure` prints with these options.
fn sway(directory: &Path, file: &str, options: &[&str]) -> String {
    let output = moris(directory, &[&["measure", file, "--parameters", "default"], options].concat());
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let row = text.lines().find(|line| line.contains("sway")).map(str::to_owned);
    row.unwrap_or_else(|| panic!("{text}{}", String::from_utf8_lossy(&output.stderr)))
}

#[test]
fn latitude_and_longitude_are_a_position() {
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| directory.path().join(name);
    write_rounds(&file("metres.csv"), 2.0, ["x", "y"]);
    // The same places near 45 degrees north and 7 degrees west.
    let text = fs::read_to_string(file("metres.csv")).unwrap();
    let degrees = text.lines().enumerate().map(|(k, line)| {
        let fields: Vec<&str> = line.split(',').collect();
        if k == 0 {
            return "time,ax,ay,az,wx,wy,wz,Longitude,Latitude,speed\n".to_owned();
        }
        let [x, y] = [7, 8].map(|place: usize| fields[place].parse::<f64>().unwrap());
        let place = format!("{:.9},{:.9}", x / 78_847.0 - 7.0, y / 111_132.0 + 45.0);
        format!("{},{place},{}\n", fields[..7].join(","), fields[9])
    });
    fs::write(file("degrees.csv"), degrees.collect::<String>()).unwrap();
    let learned = ["metres.csv", "degrees.csv"].map(|name| sway(directory.path(), name, &["--learn"]));
    let numbers = learned.each_ref().map(|row| row.split_whitespace().skip(3).take(4).collect::<Vec<_>>());
    assert_eq!(numbers[0], numbers[1]);
    let plain = sway(directory.path(), "degrees.csv", &[]);
    assert_ne!(numbers[1], plain.split_whitespace().skip(3).take(4).collect::<Vec<_>>());
}

#[test]
fn a_road_in_a_file_is_known_by_the_next_recording() {
    let directory = tempfile::tempdir().unwrap();
    write_rounds(&directory.path().join("one.csv"), 1.0, ["x", "y"]);
    let row = |options: &[&str]| sway(directory.path(), "one.csv", options);
    let numbers = |row: String| row.split_whitespace().skip(3).map(str::to_owned).collect::<Vec<_>>();
    let (first, again) = (numbers(row(&["--learn=track.laps"])), numbers(row(&["--learn=track.laps"])));
    assert_eq!(first, numbers(row(&["--learn"])), "nothing is known in the first round");
    assert_ne!(first, again);
    let points = fs::read_to_string(directory.path().join("track.laps")).unwrap().lines().count();
    assert!((1150..1250).contains(&points), "{points}");
    let simulate = ["simulate", "one.csv", "--strategy", "predictive", "--learn=track.laps", "--no-bound"];
    assert!(moris(directory.path(), &simulate).status.success());
    let later = fs::read_to_string(directory.path().join("track.laps")).unwrap().lines().count();
    assert!(later > points + 550, "{later}");
    fs::write(directory.path().join("track.laps"), "a,b\n").unwrap();
    let refused = moris(directory.path(), &simulate);
    let message = String::from_utf8_lossy(&refused.stderr);
    assert!(message.contains("line 1 is none of a road"), "{message}");
}
