//! The command as docs/safety.md prints it.

use std::fs;
use std::process::{Command, Output};

/// Runs the command in the repository's root.
fn hunter(arguments: &[&str]) -> Output {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    Command::new(env!("CARGO_BIN_EXE_hunter")).args(arguments).current_dir(root).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_search_ends_with_a_summary() {
    let summary = std::env::temp_dir().join(format!("hunter-{}.json", std::process::id()));
    let output = hunter(&["--steps", "2e4", "--seed", "7", "--summary", summary.to_str().unwrap()]);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{out}{err}");
    assert!(err.starts_with("hunting with seed 7: 20000 steps"), "{err}");
    assert!(out.contains("0 breaches") && out.contains("LegAcceleration"), "{out}");
    let summary = fs::read_to_string(summary).unwrap();
    assert!(summary.contains("\"seed\": 7") && summary.contains("\"found\": []"), "{summary}");
}

#[test]
fn a_file_is_repeated_with_a_table_of_outputs() {
    let table = std::env::temp_dir().join(format!("hunter-{}.csv", std::process::id()));
    let episode = "tests/fmu-tests/episodes/slow-machine-bang-bang.toml";
    let output = hunter(&["--replay", episode, "--trace", table.to_str().unwrap()]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout), "no breach in 4500 steps\n");
    let table = fs::read_to_string(table).unwrap();
    assert!(table.starts_with("step,position.x") && table.lines().count() == 1 + 4501, "{}", table.lines().count());
}

#[test]
fn what_cannot_be_read_is_named_with_status_2() {
    let output = hunter(&["--replay", "no-such-file.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("reading no-such-file.toml"), "{}", text(&output.stderr));
    assert_eq!(hunter(&["--steps", "1.5"]).status.code(), Some(2));
}
