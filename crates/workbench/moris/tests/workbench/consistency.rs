//! Channels that contradict each other are warnings with the option that helps.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use moris::recording::conventions::{Mounting, Quantity, SpeedUnit};
use moris::recording::{ConventionOptions, Recording};
use moris::words;

/// A car that speeds up and slows down in bends: time, ax, ay, yaw rate, yaw, speed in m/s.
fn car() -> Vec<[f64; 6]> {
    let sample = |k: usize| {
        let t = 0.02 * k as f64;
        let speed = 12.0 - 6.0 * (TAU * 0.05 * t).cos();
        let (yaw_rate, yaw) = (0.1 * (TAU * 0.08 * t).sin(), -0.1 / (TAU * 0.08) * (TAU * 0.08 * t).cos());
        [t, 6.0 * TAU * 0.05 * (TAU * 0.05 * t).sin(), speed * yaw_rate, yaw_rate, 3.1 + yaw, speed]
    };
    (0..2000).map(sample).collect()
}

/// Warnings about the car, each column by a factor.
fn warnings(speed_title: &str, [ax, ay, wz, speed]: [f64; 4], options: &ConventionOptions) -> String {
    let mut text = format!("time,ax,ay,az,wx,wy,wz,yaw,{speed_title}\n");
    for [t, force, sway, rate, yaw, v] in car() {
        // Yaw jumps by a turn.
        let yaw = yaw.sin().atan2(yaw.cos());
        writeln!(text, "{t},{},{},9.81,0,0,{},{yaw},{}", ax * force, ay * sway, wz * rate, speed * v).unwrap();
    }
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("drive.csv");
    fs::write(&file, text).unwrap();
    words::warnings(&Recording::read(&file, &options.load().unwrap()).unwrap()).join(" ")
}

const PLAIN: [f64; 4] = [1.0; 4];

#[test]
fn consistent_channels_are_not_accused() {
    let plain = ConventionOptions::default();
    assert_eq!(warnings("speed", PLAIN, &plain), "");
    assert_eq!(warnings("speed [km/h]", [1.0, 1.0, 1.0, 3.6], &plain), "");
    // On slopes, or with a scale of its own.
    assert_eq!(warnings("speed", [1.3, 1.0, 1.0, 1.0], &plain), "");
    // A two-wheeler has hardly any lateral force, of either sign.
    assert_eq!(warnings("speed", [1.0, -0.2, 1.0, 1.0], &plain), "");
}

#[test]
fn a_speed_in_another_unit_is_told() {
    let plain = ConventionOptions::default();
    for (factor, word) in [(3.6, "km/h"), (1.0 / 0.44704, "mph")] {
        let found = warnings("speed", [1.0, 0.0, 1.0, factor], &plain);
        assert!(found.contains(&format!("{factor:.1} times as much as the integral")), "{found}");
        assert!(found.contains(&format!("it seems to be in {word}, not in m/s: use --speed-unit {word}.")), "{found}");
        // In bends at constant speed as well.
        let found = warnings("speed", [0.0, 1.0, 1.0, factor], &plain);
        assert!(found.contains(&format!("its speed is in {word}, not in m/s: use --speed-unit {word}.")), "{found}");
    }
    let given = ConventionOptions { speed_unit: Some(SpeedUnit::KilometrePerHour), ..plain.clone() };
    assert_eq!(warnings("speed", [1.0, 1.0, 1.0, 3.6], &given), "");
    let found = warnings("speed", PLAIN, &given);
    assert!(found.contains("it seems to be in m/s, not in km/h: use --speed-unit m/s."), "{found}");
    let found = warnings("speed [km/h]", PLAIN, &plain);
    assert!(found.contains("correct the header, which gives km/h"), "{found}");
    assert!(warnings("speed", [1.0, 1.0, 1.0, 7.0], &plain).contains("check --speed-unit."));
}

#[test]
fn a_wrong_sign_is_told() {
    let plain = ConventionOptions::default();
    let found = warnings("speed", [1.0, 1.0, -1.0, 1.0], &plain);
    assert!(found.contains("lateral force is -1.0 times speed by yaw rate"), "{found}");
    assert!(found.contains("use --columns wz=-wz where") && found.contains("use --columns ay=-ay where"), "{found}");
    assert!(found.contains("wz is -1.0 times the derivative of yaw"), "{found}");
    // The option helps.
    let columns = vec![(Quantity::Rate(2), "-wz".to_owned())];
    let options = ConventionOptions { columns, ..plain.clone() };
    assert_eq!(warnings("speed", [1.0, 1.0, -1.0, 1.0], &options), "");
    let found = warnings("speed", PLAIN, &options);
    assert!(found.contains("use --columns wz=wz where"), "{found}");

    let found = warnings("speed", [-1.0, 1.0, 1.0, 1.0], &plain);
    assert!(found.contains("If the axis does, use --columns ax=-ax."), "{found}");
    let mounting = Some(Mounting::parse("0,0,180").unwrap());
    let found = warnings("speed", PLAIN, &ConventionOptions { mounting, ..plain });
    assert!(found.contains("If the axis does, check --mounting."), "{found}");
}
