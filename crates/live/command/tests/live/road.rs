//! The road is learned, and kept in a file.

use std::path::Path;
use std::process::{Command, Output};

/// A recording of a straight road, with the vehicle's position.
fn recording(directory: &Path) {
    let mut text = "time,ax,ay,az,wx,wy,wz,roll,pitch,yaw,speed,x,y\n".to_owned();
    for k in 0..350 {
        let time = 0.02 * f64::from(k);
        text += &format!("{time:.2},{:.4},0,9.81,0,0,0,0,0,0,20,{:.3},5\n", (2.0 * time).sin(), 20.0 * time);
    }
    std::fs::write(directory.join("road.csv"), text).unwrap();
}

fn live(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moris-live")).args(arguments).current_dir(directory).output().unwrap()
}

const DRIVE: [&str; 8] =
    ["--from", "road.csv", "--strategy", "predictive", "--dry", "--engage", "--ignore-signs", "--for"];

/// Start value of `automaticScale.start`.
const START_SCALE: f64 = 0.55;

#[test]
fn a_road_is_kept_in_its_file_and_known_by_the_next_session() {
    let directory = tempfile::tempdir().unwrap();
    recording(directory.path());
    let drive = |options: &[&str]| live(directory.path(), &[&DRIVE[..], options].concat());
    let first = drive(&["20", "--learn=kart.laps", "--learn-scale", "kart.toml", "--record", "first.txt"]);
    let scale = std::fs::read_to_string(directory.path().join("kart.toml")).unwrap();
    let start: f64 = scale.trim().strip_prefix("automaticScale.start = ").unwrap().parse().unwrap();
    assert!(start > 0.1 && start != START_SCALE, "{scale}");
    assert!(first.status.success(), "{}", String::from_utf8_lossy(&first.stderr));
    let points = || {
        let text = std::fs::read_to_string(directory.path().join("kart.laps")).unwrap();
        assert!(text.starts_with("moris-laps,1\n"), "{text}");
        text.lines().count()
    };
    let before = points();
    assert!(before > 80, "{before}");
    let again = drive(&["20", "--learn=kart.laps", "--learn-scale", "kart.toml", "--record", "second.txt"]);
    assert!(again.status.success() && points() > before + 80);
    // Both sessions are repeated to the bit; the second one has the road and the scale of the first.
    for (record, known, start) in [("first.txt", 2, START_SCALE), ("second.txt", before, start)] {
        let text = std::fs::read_to_string(directory.path().join(record)).unwrap();
        assert!(text.contains(&format!("parameter,automaticScale.start,{start:?}\n")), "{text:.4000}");
        assert_eq!(text.lines().filter(|line| line.starts_with("road,")).count(), known);
        let replayed = live(directory.path(), &["--replay", record]);
        let said = String::from_utf8(replayed.stdout).unwrap();
        assert!(replayed.status.success() && said.contains("the same commands to the bit"), "{said}");
    }
}

#[test]
fn a_road_that_cannot_be_kept_is_said_after_the_platform_has_parked() {
    let directory = tempfile::tempdir().unwrap();
    recording(directory.path());
    let folder = directory.path().join("laps");
    std::fs::create_dir(&folder).unwrap();
    let output = std::thread::scope(|scope| {
        let driven = scope.spawn(|| live(directory.path(), &[&DRIVE[..], &["1", "--learn=laps/kart.laps"]].concat()));
        std::thread::sleep(std::time::Duration::from_millis(700));
        std::fs::remove_dir(&folder).unwrap();
        driven.join().unwrap()
    });
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && said.contains("cannot keep the road in laps/kart.laps"), "{said}");
    assert!(said.contains("parking") && String::from_utf8_lossy(&output.stdout).contains("late by more than one"));
}

#[test]
fn what_cannot_be_learned_is_refused_before_anything_moves() {
    let directory = tempfile::tempdir().unwrap();
    recording(directory.path());
    let refused = |arguments: &[&str], reason: &str| {
        let output = live(directory.path(), &[arguments, &["--dry", "--for", "1"]].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(reason), "{said}");
    };
    let predictive = ["--from", "road.csv", "--strategy", "predictive"];
    refused(
        &["--from", "road.csv", "--strategy", "classical", "--learn"],
        "--learn is for the predictive strategy alone",
    );
    let x_plane = ["--from", "udp:4443", "--format", "x-plane", "--strategy", "predictive", "--learn"];
    refused(&x_plane, "--learn needs the vehicle's position");
    refused(&[&predictive[..], &["--learn=none/kart.laps"]].concat(), "there is no folder none");
    refused(&[&predictive[..], &["--learn-scale", "none/kart.toml"]].concat(), "there is no folder none");
    std::fs::write(directory.path().join("other.csv"), "a,b\n1,2\n").unwrap();
    refused(&[&predictive[..], &["--learn=other.csv"]].concat(), "line 1 is none of a road that moris has learned");
    if Path::new("/dev/zero").exists() {
        // A name in a folder of one's own: who is not root may write no file beside the device.
        std::os::unix::fs::symlink("/dev/zero", directory.path().join("endless.laps")).unwrap();
        refused(&[&predictive[..], &["--learn=endless.laps"]].concat(), "it is no text: it has zero bytes");
    }
}
