//! `moris-live` between an emulated vehicle and an emulated device, in real time.

#![cfg(unix)]

mod bounds;
#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod devices;
mod driving;
mod exits;
mod moog;
mod page;
mod place;
mod rig;
mod road;
mod serial;
mod sources;

use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use rig::{APART, Live, free_port, lengths, vehicle};

#[test]
fn from_telemetry_to_frames_and_back_to_rest() {
    let directory = tempfile::tempdir().unwrap();
    let port = free_port();
    let runs = AtomicBool::new(true);
    let arguments = ["--format", "csv", "--engage", "--record", "session.csv"];
    let mut live = Live::start(directory.path(), &format!("udp:{port}"), &arguments);
    thread::scope(|scope| {
        scope.spawn(|| vehicle(port, &runs));
        live.wait_for("engaged");
        runs.store(false, Ordering::Relaxed);
    });
    // The source is killed: the platform comes to neutral by itself.
    for state in ["frozen", "disengaging", "neutral"] {
        live.wait_for(state);
    }
    live.interrupt();
    for state in ["parking", "settled", "off"] {
        live.wait_for(state);
    }
    let (status, printed, frames) = live.end();
    assert!(status.success(), "{printed}");
    assert!(printed.contains("late by more than one") && printed.contains("0 of another format"), "{printed}");
    assert_eq!(frames.first().unwrap(), "start\n");
    assert_eq!(frames[frames.len() - 2..], ["park\n", "stop\n"]);
    // In the default rig's stroke at all times, and at rest at its lowest at the end.
    let moves: Vec<Vec<f64>> = frames[1..frames.len() - 2].iter().map(|frame| lengths(frame)).collect();
    assert!(moves.iter().flatten().all(|length| (1.0..=1.6).contains(length)));
    assert!(moves.last().unwrap().iter().all(|length| (1.0..1.02).contains(length)), "{:?}", moves.last());
    let highest = moves.iter().map(|lengths| lengths[0]).fold(0.0, f64::max);
    assert!(highest > 1.25, "{highest} m");
    let surges =
        frames[1..frames.len() - 2].iter().map(|frame| frame.split(',').nth(19).unwrap().parse::<f64>().unwrap());
    assert!(surges.map(f64::abs).fold(0.0, f64::max) > 0.1, "no cue");

    // The recorded session gives the same commands to the bit.
    let replay = |file: &str| {
        Command::new(env!("CARGO_BIN_EXE_moris-live"))
            .args(["--replay", file])
            .current_dir(directory.path())
            .output()
            .unwrap()
    };
    let replayed = replay("session.csv");
    let text = String::from_utf8(replayed.stdout).unwrap();
    assert!(replayed.status.success() && text.contains("engaged\n") && text.contains("to the bit"), "{text}");
    // A full disk cuts it in a line: it is repeated up to there.
    let whole = std::fs::read(directory.path().join("session.csv")).unwrap();
    std::fs::write(directory.path().join("cut.csv"), &whole[..whole.len() * 2 / 3]).unwrap();
    let cut = replay("cut.csv");
    let said = String::from_utf8(cut.stdout).unwrap();
    assert!(cut.status.success() && said.contains("engaging\n") && said.contains("no end to compare with"), "{said}");
    // With another sample it does not.
    let recorded = std::fs::read_to_string(directory.path().join("session.csv")).unwrap();
    let samples: Vec<_> = recorded.lines().enumerate().filter(|(_, line)| line.contains(",sample,")).collect();
    // Of the last ones: while the platform was engaged.
    let (place, line) = samples[samples.len() * 3 / 4];
    let mut lines: Vec<String> = recorded.lines().map(str::to_owned).collect();
    lines[place] = line.replacen(",0.3,", ",0.4,", 1);
    assert_ne!(lines[place], line);
    std::fs::write(directory.path().join("other.csv"), lines.join("\n") + "\n").unwrap();
    let other = replay("other.csv");
    assert!(!other.status.success(), "{}{:?}", String::from_utf8_lossy(&other.stdout), lines[place]);
}

#[test]
fn a_second_interrupt_ends_at_once_and_lines_are_commands() {
    let directory = tempfile::tempdir().unwrap();
    let mut live = Live::start(directory.path(), &format!("udp:{}", free_port()), &["--format", "motionsim"]);
    live.command("engage");
    live.wait_for("refused: engage does nothing in the state off");
    live.command("start");
    live.wait_for("homing");
    // Parking from here takes longer than the time in which two interrupts are one.
    thread::sleep(Duration::from_secs(2));
    live.interrupt();
    live.wait_for("parking");
    thread::sleep(APART);
    live.interrupt();
    live.wait_for("off");
    let (status, _, frames) = live.end();
    assert!(status.success());
    assert_eq!(frames.last().unwrap(), "stop\n");
    assert!(!frames.contains(&"park\n".to_owned()));
}

#[test]
fn a_recording_is_played_and_the_platform_parks_after_it() {
    let directory = tempfile::tempdir().unwrap();
    let line = |k: i32| format!("{},{},0,9.80665,0,0,0\n", f64::from(k) * 0.01, (f64::from(k) * 0.02).sin());
    let text = "time,ax,ay,az,wx,wy,wz\n".to_owned() + &(0..600).map(line).collect::<String>();
    std::fs::write(directory.path().join("ride.csv"), text).unwrap();
    let mut live = Live::start(directory.path(), "ride.csv", &["--engage"]);
    for state in ["homing", "neutral", "engaging", "engaged", "parking", "settled", "off"] {
        live.wait_for(state);
    }
    let (status, printed, frames) = live.end();
    assert!(status.success() && printed.contains("telemetry: "), "{printed}");
    assert_eq!(frames.last().unwrap(), "stop\n");
}

#[test]
fn what_cannot_be_used_is_said() {
    let directory = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_moris-live")).args(arguments).current_dir(&directory).output();
        let output = output.unwrap();
        (output.status.success(), String::from_utf8([output.stdout, output.stderr].concat()).unwrap())
    };
    for (arguments, text) in [
        (&["formats"][..], "motionsim      BeamNG.drive"),
        (&["formats", "forza"], "[fields]"),
        (&["frames", "bff"], "leg1:hi"),
    ] {
        let (fine, printed) = run(arguments);
        assert!(fine && printed.contains(text), "{printed}");
    }
    for (arguments, text) in [
        (
            &["formats", "doom"][..],
            "--format is doom, but must be a file whose name ends with .toml, or one of json, csv",
        ),
        (
            &["--from", "udp:0x", "--format", "csv", "--dry"],
            "--from is udp:0x, but must be udp:PORT with a port from 1 to 65535",
        ),
        (&["--from", "udp:4444", "--dry"], "--format names the packets' format"),
        (&["--from", "udp:4444", "--format", "own.toml", "--dry"], "own.toml"),
        (&["--from", "udp:4444", "--format", "csv"], "--to"),
        (&["--from", "udp:4444", "--format", "csv", "--to", "tcp:x"], "--to is udp:HOST:PORT or serial:LINE:BAUD"),
        (&["--from", "nothing.csv", "--dry"], "--from is nothing.csv, but must be udp:PORT"),
        (
            &["--from", "udp:4444", "--format", "csv", "--to", "udp:127.0.0.1:9", "--frames", "bff", "--engage"],
            "nobody has said where its legs are: add --settled",
        ),
        (
            &["--from", "udp:4444", "--format", "csv", "--to", "udp:127.0.0.1:9", "--settled", "--slow-start"],
            "cannot be used with",
        ),
        (
            &["frames", "nothing"],
            "--frames is nothing, but must be a file whose name ends with .toml, or one of json, csv",
        ),
        (&["frames", "nothing"], "moog-6dof2000e"),
        (&["--from", "udp:4444", "--format", "csv", "--dry", "--for", "soon"], "a number of seconds"),
    ] {
        let (fine, printed) = run(arguments);
        assert!(!fine && printed.contains(text), "{arguments:?}: {printed}");
    }
}
