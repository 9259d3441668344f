//! Ways to end: the last that the device sees is a platform at rest.

use std::io::Read;
use std::process::Command;
use std::thread;
use std::time::Duration;

use crate::rig::{Live, free_port, lengths};

#[test]
fn a_recording_that_cannot_go_on_is_said_and_the_platform_parks_as_ever() {
    let directory = tempfile::tempdir().unwrap();
    let pipe = directory.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    // Takes the beginning, and closes: what is written after it fails, as on a full disk.
    let reader = thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::File::open(pipe).unwrap().read_exact(&mut [0; 1000]).unwrap()
    });
    let from = format!("udp:{}", free_port());
    let mut live = Live::start(directory.path(), &from, &["--format", "csv", "--record", "pipe"]);
    live.wait_for("commands: start, engage, disengage, park, stop, clear; Ctrl-C parks and ends");
    reader.join().unwrap();
    live.command("start");
    live.wait_for("homing");
    // Entries are written in blocks: refused commands are entries, too.
    for _ in 0..1000 {
        live.command("engage");
        thread::sleep(Duration::from_millis(1));
    }
    live.after("the recording has ended: ");
    live.interrupt();
    live.wait_for("off");
    let (status, printed, frames) = live.end();
    assert!(!status.success() && printed.contains("late by more than one"), "{printed}");
    assert_eq!(frames[frames.len() - 2..], ["park\n", "stop\n"]);
    let last = &frames[frames.len() - 4..frames.len() - 2];
    // Slower than 10 mm/s.
    let moved = lengths(&last[0]).into_iter().zip(lengths(&last[1])).map(|(one, other)| (one - other).abs());
    assert!(moved.fold(0.0, f64::max) < 1e-4, "{last:?}");
}

#[test]
fn a_full_disk_is_said_before_anything_moves() {
    if !std::path::Path::new("/dev/full").exists() {
        return;
    }
    let output = Command::new(env!("CARGO_BIN_EXE_moris-live"))
        .args(["--from", &format!("udp:{}", free_port()), "--format", "csv", "--dry", "--engage"])
        .args(["--record", "/dev/full"])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && said.contains("cannot record the session"), "{said}");
    assert!(output.stdout.is_empty());
}
