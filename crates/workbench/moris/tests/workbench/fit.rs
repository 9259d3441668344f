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
    assert!(
        before.contains("Felt the wrong way round for") && before.contains("Scale force and rates by 0."),
        "{before}"
    );
    // So does what the verdict recommends.
    let (_, advised) =
        moris(directory, &["simulate", "a.csv", "--no-bound", "--report", "out", "--parameters", "out/a.advice.toml"]);
    assert!(advised.contains("  Felt the right way round, at "), "{advised}");
    let with = ["simulate", "a.csv", "--no-bound", "--report", "out", "--parameters", "out/a.fit.toml"];
    let (_, after) = moris(directory, &with);
    assert!(!after.contains("wrong way round"), "{after}");
}

#[test]
fn the_files_run_alike_over_any_set_and_hold_nothing_of_the_rig() {
    let directory = tempfile::tempdir().unwrap();
    let directory = directory.path();
    fs::write(directory.join("a.csv"), slalom(1.0)).unwrap();
    // The same, half as hard.
    fs::write(directory.join("b.csv"), slalom(2.0).replace("4.903325,", "9.80665,")).unwrap();
    let rig = format!("{}/../../../examples/rigs/hobby150.toml", env!("CARGO_MANIFEST_DIR"));
    let fitted = |recordings: &[&str], report: &str| {
        let arguments =
            [&["fit", "--rig", &rig, "--strategy", "predictive", "--json", "--report", report], recordings].concat();
        let (output, text) = moris(directory, &arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_str::<serde_json::Value>(&text).unwrap()
    };
    let results = fitted(&["a.csv", "b.csv"], "out");
    let read = |name: &str| fs::read_to_string(directory.join("out").join(name)).unwrap();
    for (file, recordings) in [("a.fit.toml", "a"), ("b.fit.toml", "b"), ("fit.toml", "a, b")] {
        let text = read(file);
        let heading = text.lines().next().unwrap();
        assert!(
            heading.starts_with(&format!("# Fitted by moris to {recordings} on ")) && heading.contains("scale 0."),
            "{heading}"
        );
        assert!(text.contains("\"strategy\" = \"predictive\"") && text.contains("\"scale.angularVelocity.z\" = "));
        for of_rig in ["head.", "safety.", "actuator.", "rig."] {
            assert!(!text.contains(&format!("\"{of_rig}")), "{text}");
        }
    }
    // What fits the harder one fits the other.
    let scale = |result: usize| match &results[result]["fits"][0]["scale"] {
        serde_json::Value::Null => results[result]["scale"].as_f64().unwrap(),
        scale => scale.as_f64().unwrap(),
    };
    assert!(scale(0) < scale(1) && scale(2) <= scale(0) && results[2]["fitting"] == 2, "{results}");
    // Over a classical set, too, the file chooses its strategy.
    for recording in ["a", "b"] {
        let csv = format!("{recording}.csv");
        let arguments = [
            "simulate",
            &csv,
            "--no-bound",
            "--rig",
            &rig,
            "--report",
            "out",
            "--parameters",
            "classical",
            "--parameters",
            "out/fit.toml",
        ];
        let (_, after) = moris(directory, &arguments);
        assert!(!after.contains("wrong way round"), "{after}");
    }
}

#[test]
fn without_a_recording_there_is_nothing_to_fit() {
    let directory = tempfile::tempdir().unwrap();
    let (output, _) = moris(directory.path(), &["fit"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("<RECORDING[@CONVENTIONS]>"));
}
