//! Files without an end, files that are too large, and arguments that are no text.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output};

use moris_build_fmu::archive::pack;

const RIDE: &str = "time,ax,ay,az,wx,wy,wz\n0,0,0,9.8,0,0,0\n1,0,0,9.8,0,0,0\n2,0,0,9.8,0,0,0\n";

fn moris(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moris")).args(arguments).current_dir(directory).output().unwrap()
}

/// The error of a command that fails.
fn error(directory: &Path, arguments: &[&str]) -> String {
    let output = moris(directory, arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.len() < 5000, "{arguments:?}: {} bytes", text.len());
    text
}

/// Each command with a file that a person writes.
fn commands(file: &str) -> Vec<Vec<&str>> {
    vec![
        vec!["rig", "check", file],
        vec!["simulate", "ride.csv", "--rig", file],
        vec!["simulate", "ride.csv", "--parameters", file],
        vec!["simulate", "ride.csv", "--conventions", file],
    ]
}

#[test]
fn a_file_without_an_end_is_refused_by_every_command() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("ride.csv"), RIDE).unwrap();
    File::create(directory.path().join("sparse.toml")).unwrap().set_len(1 << 40).unwrap();
    for command in commands("sparse.toml") {
        let error = error(directory.path(), &command);
        assert!(error.contains("sparse.toml") && error.contains("it has zero bytes"), "{command:?}: {error}");
    }
}

#[test]
fn a_text_that_nobody_writes_is_refused_by_its_size() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("ride.csv"), RIDE).unwrap();
    fs::write(directory.path().join("large.toml"), "# a\n".repeat(4_000_001)).unwrap();
    for command in commands("large.toml") {
        let error = error(directory.path(), &command);
        assert!(error.contains("it is larger than 16 MB"), "{command:?}: {error}");
    }
}

/// One line of 15 MB, which an error would quote.
#[test]
fn an_error_quotes_no_long_line() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("line.toml"), "y".repeat(15_000_000)).unwrap();
    let error = error(directory.path(), &["rig", "check", "line.toml"]);
    assert!(error.contains("yyyyyy") && error.contains("a rig file is TOML"), "{error}");
}

/// An archive whose only file declares a size of 2 GB.
fn bomb() -> Vec<u8> {
    let mut archive = pack(&BTreeMap::from([("modelDescription.xml".to_owned(), b"<a/>".to_vec())])).unwrap();
    let entry = archive.windows(4).rposition(|bytes| bytes == b"PK\x01\x02").unwrap();
    archive[entry + 24..entry + 28].copy_from_slice(&2_000_000_000_u32.to_le_bytes());
    archive
}

#[test]
fn an_archive_that_unpacks_to_more_than_its_bound_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("bomb.fmu"), bomb()).unwrap();
    let error_of = |base: &str| error(directory.path(), &["build-fmu", "--base", base]);
    let error = error_of("bomb.fmu");
    let expected = "unpack to 2 GB or more, but at most 256 MB are unpacked";
    assert!(error.contains("bomb.fmu") && error.contains(expected), "{error}");
    File::create(directory.path().join("sparse.fmu")).unwrap().set_len(1 << 40).unwrap();
    let error = error_of("sparse.fmu");
    assert!(error.contains("it is larger than 256 MB"), "{error}");
}

#[test]
fn an_error_is_said_once() {
    let directory = tempfile::tempdir().unwrap();
    let rig = "name = \"a\"\nneutralHeight = 1\n";
    fs::write(directory.path().join("rig.toml"), rig).unwrap();
    fs::write(directory.path().join("bomb.fmu"), bomb()).unwrap();
    for (command, once) in [
        (["rig", "check", "rig.toml"].as_slice(), "TOML parse error"),
        (&["build-fmu", "--base", "none.fmu"], "No such file"),
        (&["build-fmu", "--base", "bomb.fmu"], "which unpack to"),
    ] {
        let error = error(directory.path(), command);
        assert_eq!(error.matches(once).count(), 1, "{command:?}: {error}");
    }
}

#[cfg(unix)]
#[test]
fn an_argument_that_is_no_text_is_an_error() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let directory = tempfile::tempdir().unwrap();
    let odd = OsStr::from_bytes(b"\xff\xfe");
    for command in [
        ["rig", "check"].as_slice(),
        &["simulate"],
        &["simulate", "--columns"],
        &["parameters", "--parameters"],
        &["build-fmu", "--base"],
        &["completions"],
        &[],
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_moris"))
            .args(command)
            .arg(odd)
            .current_dir(directory.path())
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(1 | 2)), "{command:?}: {text}");
        assert!(text.contains("error:") && !text.contains("panicked"), "{command:?}: {text}");
    }
}
