//! Samples that no vehicle causes are named with their times, and repaired when that is asked for.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::process::Command;

use moris::recording::{ConventionOptions, Recording};
use moris::words;

const GRAVITY: f64 = 9.80665;
const SAMPLES: usize = 2000;

/// Twenty seconds of gentle bends with the vibration of an engine: time, forces, rates.
fn drive() -> Vec<[f64; 7]> {
    let sample = |k: usize| {
        let t = 0.01 * k as f64;
        let bend = (TAU * 0.1 * t).sin();
        let shake = |f: f64| 0.3 * (TAU * f * t).sin() * (TAU * 0.37 * f * t).cos();
        [t, shake(17.3), 2.0 * bend + shake(13.1), GRAVITY + shake(19.7), 0.0, 0.01 * shake(11.0), 0.1 * bend]
    };
    (0..SAMPLES).map(sample).collect()
}

fn csv(samples: &[[f64; 7]]) -> String {
    let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for sample in samples {
        writeln!(text, "{}", sample.map(|value| value.to_string()).join(",")).unwrap();
    }
    text
}

fn read(samples: &[[f64; 7]], repair: bool) -> Result<Recording, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("drive.csv");
    fs::write(&file, csv(samples)).unwrap();
    let options = ConventionOptions { repair, ..ConventionOptions::default() };
    let recording = Recording::read(&file, &options.load().unwrap());
    recording.map_err(|error| words::error(&error).replace(&format!("{}/", directory.path().display()), ""))
}

/// The drive with other values of a column at some samples.
fn with(column: usize, values: impl Iterator<Item = (usize, f64)>) -> Vec<[f64; 7]> {
    let mut samples = drive();
    values.for_each(|(sample, value)| samples[sample][column] = value);
    samples
}

#[test]
fn a_drive_without_outliers_is_not_accused() {
    let plain = read(&drive(), false).unwrap();
    assert!(words::warnings(&plain).is_empty(), "{:?}", words::warnings(&plain));
    assert_eq!(read(&drive(), true).unwrap().inputs(), plain.inputs());
    // Rounded to few digits, as loggers write.
    let rounded: Vec<[f64; 7]> = drive().iter().map(|s| s.map(|value| (value * 100.0).round() / 100.0)).collect();
    assert!(words::warnings(&read(&rounded, false).unwrap()).is_empty());
    // Three samples are a blow, and a step is none.
    let blow = with(2, (500..503).map(|k| (k, 30.0)));
    assert!(words::warnings(&read(&blow, false).unwrap()).is_empty());
    let step = with(1, (1000..SAMPLES).map(|k| (k, drive()[k][1] + 6.0 * f64::from(u8::from(k < 1200)))));
    assert!(!words::warnings(&read(&step, false).unwrap()).iter().any(|warning| warning.contains("spike")));
}

#[test]
fn error_values_are_refused_and_repaired_on_request() {
    for (value, count) in [(-9999.0, 1), (32_767.0, 1), (65_535.0, 30), (1e6, 2)] {
        let samples = with(2, (700..700 + count).map(|k| (k, value)));
        let message = read(&samples, false).unwrap_err();
        assert!(message.starts_with(&format!("drive.csv, line 702, column ay: is {value}")), "{message}");
        assert!(message.contains("at 7.00 s (line 702)") && message.contains("use --repair"), "{message}");
        let repaired = read(&samples, true).unwrap();
        let plain = drive();
        for (k, input) in repaired.inputs().iter().enumerate() {
            let off = (input.specific_force.y - plain[k][2]).abs();
            let tolerance = if (700..700 + count).contains(&k) { 1.0 } else { 1e-12 };
            assert!(off < tolerance, "{k}: {}", input.specific_force.y);
        }
        let said =
            format!("{} of column ay", if count == 1 { "a sample".to_owned() } else { format!("{count} samples") });
        assert!(
            words::warnings(&repaired).iter().any(|warning| warning.contains(&said)),
            "{:?}",
            words::warnings(&repaired)
        );
    }
    // At either end, the nearest value holds.
    for sample in [0, SAMPLES - 1] {
        let repaired = read(&with(4, [(sample, -9999.0)].into_iter()), true).unwrap();
        assert_eq!(repaired.inputs()[sample].angular_velocity.x, 0.0);
    }
}

#[test]
fn spikes_are_named_and_repaired_on_request() {
    // Twenty spreads, two samples side by side, and 10 g among vibration.
    for (column, name, spikes) in
        [(1, "ax", vec![(300, 12.0)]), (6, "wz", vec![(300, 2.0), (301, 2.1)]), (3, "az", vec![(300, -120.0)])]
    {
        let samples = with(column, spikes.iter().copied());
        let warnings = words::warnings(&read(&samples, false).unwrap()).join(" ");
        assert!(warnings.contains(&format!("Column {name} has isolated spikes")), "{warnings}");
        assert!(warnings.contains("at 3.00 s (line 302)") && warnings.contains("use --repair"), "{warnings}");
        let repaired = read(&samples, true).unwrap();
        assert!(words::warnings(&repaired).join(" ").contains("Repaired: "), "{:?}", words::warnings(&repaired));
        let input = &repaired.inputs()[300];
        let found = [input.specific_force.as_slice(), input.angular_velocity.as_slice()].concat()[column - 1];
        assert!((found - drive()[300][column]).abs() < 0.5, "{name}: {found}");
    }
}

/// 10 g is a spike whatever the vibration around it; less is not.
#[test]
fn spikes_stand_out_of_vibration() {
    let rough = |spike: f64| {
        let mut samples = drive();
        samples.iter_mut().enumerate().for_each(|(k, s)| s[3] += 30.0 * (2.3 * k as f64).sin());
        samples[300][3] = spike;
        words::warnings(&read(&samples, false).unwrap()).join(" ")
    };
    assert!(rough(120.0).contains("Column az has isolated spikes"));
    assert!(!rough(80.0).contains("spikes"));
}

/// A rough second has many blows, of which none is isolated.
#[test]
fn rough_roads_are_not_accused() {
    let mut samples = drive();
    (1000..1100).for_each(|k| samples[k][3] += 25.0 * (2.3 * k as f64).sin() * (0.41 * k as f64).sin().powi(8));
    let warnings = words::warnings(&read(&samples, false).unwrap());
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn flat_tops_are_named() {
    let clipped: Vec<[f64; 7]> =
        drive().into_iter().map(|s| [s[0], s[1], s[2].clamp(-1.5, 1.2), s[3], s[4], s[5], s[6]]).collect();
    let warnings = words::warnings(&read(&clipped, true).unwrap());
    let tops: Vec<&String> =
        warnings.iter().filter(|warning| warning.contains("Column ay stays at its extreme")).collect();
    assert_eq!(tops.len(), 2, "{warnings:?}");
    assert!(tops[0].contains("extreme -1.5") && tops[1].contains("extreme 1.2"), "{warnings:?}");
    assert!(tops[1].contains("at 1.00 s (line 102)") && tops[1].contains("cannot be repaired"), "{warnings:?}");
    // Neither is a computed ride with bends to one side, that stands still before and after them.
    let left: Vec<[f64; 7]> = drive()
        .into_iter()
        .map(|s| [s[0], 0.0, 0.0, GRAVITY, 0.0, 0.0, 0.1 * (TAU * 0.05 * (s[0] - 5.0).clamp(0.0, 10.0)).sin()])
        .collect();
    assert!(words::warnings(&read(&left, false).unwrap()).is_empty());
    // A computed manoeuvre that brakes steadily from rest is none.
    let steady: Vec<[f64; 7]> = drive()
        .into_iter()
        .map(|s| {
            [s[0], if (5.0..7.0).contains(&s[0]) { -3.0 } else { 0.0 }, 0.001 * s[0].sin(), GRAVITY, 0.0, 0.0, 0.0]
        })
        .map(|s| {
            [s[0], s[1] + ((s[0] - 4.0).clamp(0.0, 1.0) - (s[0] - 7.0).clamp(0.0, 1.0)), s[2], s[3], s[4], s[5], s[6]]
        })
        .collect();
    assert!(!words::warnings(&read(&steady, false).unwrap()).iter().any(|warning| warning.contains("extreme")));
}

/// The page tells what was repaired.
#[test]
fn the_report_tells_of_repairs() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("drive.csv");
    fs::write(&file, csv(&with(2, [(700, -9999.0)].into_iter()))).unwrap();
    let run = |repair: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_moris"));
        command.arg("simulate").arg(&file).args(["--no-bound", "--report"]).arg(directory.path()).args(repair);
        command.output().unwrap()
    };
    let refused = run(&[]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("use --repair"));
    assert!(String::from_utf8_lossy(&run(&["--repair"]).stdout).contains("Repaired: a sample of column ay"));
    let page = fs::read_to_string(directory.path().join("drive.html")).unwrap();
    assert!(page.contains("Repaired: a sample of column ay is interpolated over, at 7.00 s"));
}
