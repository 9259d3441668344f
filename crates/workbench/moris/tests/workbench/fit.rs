//! `moris fit`: its parameter file reaches the aims when it is simulated, and conventions stand
//! beside each recording.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn moris(directory: &Path, arguments: &[&str]) -> (Output, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_moris")).args(arguments).current_dir(directory).output().unwrap();
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    (output, text)
}

/// A slalom of 30 s with 5 m/s2 at 0.2 Hz, in this unit.
fn slalom(unit: f64) -> String {
    let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for k in 0..=3000 {
        let t = 0.01 * f64::from(k);
        let sway = 5.0 * (t / 3.0).min(1.0) * (std::f64::consts::TAU * 0.2 * t).sin();
        writeln!(text, "{t},0,{},{},0,0,0", sway / unit, 9.80665 / unit).unwrap();
    }
    text
}

#[test]
fn the_parameter_file_has_the_right_sign_where_the_set_has_not() {
    let directory = tempfile::tempdir().unwrap();
    let directory = directory.path();
    fs::write(directory.join("a.csv"), slalom(1.0)).unwrap();
    fs::write(directory.join("b.csv"), slalom(9.80665)).unwrap();
    fs::write(directory.join("g.toml"), "force-unit = \"g\"\n").unwrap();
    let arguments = [
        "fit",
        "a.csv",
        "b.csv@g.toml",
        "--strategy",
        "predictive",
        "--strategy",
        "classical",
        "--report",
        "out",
        "--json",
    ];
    let (output, text) = moris(directory, &arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let results: serde_json::Value = serde_json::from_str(&text).unwrap();
    let fit = |recording: usize| &results[recording]["fits"][0];
    assert!(fit(0)["scale"].as_f64().unwrap() < 1.0 && fit(0)["fits"] == true);
    assert!(fit(0)["shapeError"].as_f64().unwrap() <= 50.0);
    // The same ride in other units.
    let scales = [fit(0), fit(1)].map(|fit| fit["scale"].as_f64().unwrap());
    assert!((scales[0] / scales[1] - 1.0).abs() < 1e-6, "{scales:?}");
    assert!(fs::read_to_string(directory.join("out/fit.svg")).unwrap().contains("<polyline"));
    // The file is what `simulate` takes, and it reaches the aims.
    let (_, before) = moris(directory, &["simulate", "a.csv", "--no-bound", "--report", "out"]);
    assert!(before.contains("Felt the wrong way round for"), "{before}");
    let with = ["simulate", "a.csv", "--no-bound", "--report", "out", "--parameters", "out/a.fit.toml"];
    let (_, after) = moris(directory, &with);
    assert!(!after.contains("wrong way round"), "{after}");
}

#[test]
fn without_a_recording_a_vehicle_or_its_accelerations_are_driven() {
    let directory = tempfile::tempdir().unwrap();
    let of = |arguments: &[&str]| {
        let all = [&["fit", "--strategy", "predictive", "--report", "out"], arguments].concat();
        moris(directory.path(), &all)
    };
    let (output, text) = of(&["--usual", "2 g sideways, 1 g braking"]);
    assert!(output.status.code().is_some_and(|code| code == 0 || code == 3), "{text}");
    assert!(
        text.contains("usual accelerations: predictive, scale 0.") && text.contains("With a tilt of 6 °/s"),
        "{text}"
    );
    let (_, text) = of(&["--vehicle", "town-car"]);
    assert!(text.contains("town-car: predictive, scale"), "{text}");
    let (output, _) = of(&[]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("--usual \"2 g sideways, 1 g braking\""));
}
