//! Files without an end, files that are too large, and arguments that are no text.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

use moris_build_fmu::archive::pack;

const MAP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../examples/motorcycle-map.toml");

/// The error of a command that fails.
fn error(directory: &Path, arguments: &[&str]) -> String {
    let command = Command::new(env!("CARGO_BIN_EXE_moris-live")).args(arguments).current_dir(directory).output();
    let output = command.unwrap();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.len() < 5000, "{arguments:?}: {} bytes", text.len());
    text
}

/// The command with each file that the operator writes.
fn commands(file: &str) -> [Vec<&str>; 4] {
    [
        vec!["--replay", file],
        vec!["--from", "udp:0", "--dry", "--format", file],
        vec!["--from", "udp:0", "--format", "csv", "--to", "udp:127.0.0.1:9", "--frames", file],
        vec!["--from", "fmu:vehicle.fmu", "--map", file, "--dry"],
    ]
}

#[test]
fn a_file_without_an_end_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    File::create(directory.path().join("sparse.toml")).unwrap().set_len(1 << 40).unwrap();
    for command in commands("sparse.toml") {
        let error = error(directory.path(), &command);
        assert!(error.contains("sparse.toml") && error.contains("it has zero bytes"), "{command:?}: {error}");
    }
}

#[test]
fn a_text_that_nobody_writes_is_refused_by_its_size() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("large.toml"), "# a\n".repeat(4_000_001)).unwrap();
    for command in commands("large.toml").into_iter().filter(|command| command[0] != "--replay") {
        let error = error(directory.path(), &command);
        assert!(error.contains("it is larger than 16 MB"), "{command:?}: {error}");
    }
}

/// An archive whose only file declares a size of 2 GB.
fn bomb() -> Vec<u8> {
    let mut archive = pack(&BTreeMap::from([("modelDescription.xml".to_owned(), b"<a/>".to_vec())])).unwrap();
    let entry = archive.windows(4).rposition(|bytes| bytes == b"PK\x01\x02").unwrap();
    archive[entry + 24..entry + 28].copy_from_slice(&2_000_000_000_u32.to_le_bytes());
    archive
}

#[test]
fn an_error_is_said_once() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("map.toml"), "a = 1\n").unwrap();
    fs::write(directory.path().join("bomb.fmu"), bomb()).unwrap();
    for (fmu, map, once) in [
        ("bomb.fmu", "map.toml", "TOML parse error"),
        ("bomb.fmu", MAP, "which unpack to 2 GB or more, but at most 1 GB are unpacked"),
        ("none.fmu", MAP, "No such file"),
    ] {
        let error = error(directory.path(), &["--from", &format!("fmu:{fmu}"), "--map", map, "--dry"]);
        assert_eq!(error.matches(once).count(), 1, "{fmu}: {error}");
    }
}

#[test]
fn an_argument_that_is_no_text_is_an_error() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let directory = tempfile::tempdir().unwrap();
    for command in [["--from"].as_slice(), &["--dry", "--from"], &[]] {
        let mut live = Command::new(env!("CARGO_BIN_EXE_moris-live"));
        let output = live.args(command).arg(OsStr::from_bytes(b"\xff\xfe")).current_dir(directory.path()).output();
        let output = output.unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(1 | 2)), "{command:?}: {text}");
        assert!(text.contains("error:") && !text.contains("panicked"), "{command:?}: {text}");
    }
}
