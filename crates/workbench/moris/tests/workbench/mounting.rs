//! The mounting of a sensor, found from recordings of vehicles made for it.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use moris::recording::conventions::{Format, Mounting};
use moris::recording::{ConventionOptions, Recording};
use moris::words;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::{Matrix3, Vector3};

const GRAVITY: f64 = 9.80665;
const DURATION: f64 = 40.0;
/// A phone upright in a holder.
const PHONE: [f64; 3] = [90.0, 0.0, -90.0];

/// A vehicle, by its speed \[m/s\] and yaw rate \[rad/s\].
struct Vehicle<S, Y> {
    speed: S,
    yaw_rate: Y,
    /// True for a two-wheeler, which leans until its lateral force is zero.
    leans: bool,
    /// Amplitude of vibration \[m/s2\].
    vibration: f64,
}

impl<S: Fn(f64) -> f64, Y: Fn(f64) -> f64> Vehicle<S, Y> {
    /// Specific force and angular velocity in the vehicle's axes.
    fn motion(&self, t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let h = 1e-4;
        let surge = ((self.speed)(t + h) - (self.speed)(t - h)) / (2.0 * h);
        let yaw_rate = (self.yaw_rate)(t);
        let sway = (self.speed)(t) * yaw_rate;
        let shake = |f: f64| self.vibration * (TAU * f * t).sin();
        let shaken = Vector3::new(shake(3.1), shake(2.3), shake(2.7));
        if !self.leans {
            return (Vector3::new(surge, sway, GRAVITY) + shaken, Vector3::new(0.0, 0.0, yaw_rate));
        }
        // Into the bend; to the left is negative.
        let lean = |t: f64| -((self.speed)(t) * (self.yaw_rate)(t) / GRAVITY).atan();
        let (roll, roll_rate) = (lean(t), (lean(t + h) - lean(t - h)) / (2.0 * h));
        let force = Vector3::new(surge, 0.0, GRAVITY.hypot(sway));
        (force + shaken, Vector3::new(roll_rate, yaw_rate * roll.sin(), yaw_rate * roll.cos()))
    }

    /// The file of a sensor mounted in it, with columns of its own behind.
    fn file(&self, degrees: [f64; 3], more: &[(&str, &dyn Fn(f64) -> f64)]) -> String {
        let names: String = more.iter().map(|(name, _)| format!(",{name}")).collect();
        let mut text = format!("time,ax,ay,az,wx,wy,wz{names}\n");
        let turned = mounting(degrees).transpose();
        for k in 0..=(100.0 * DURATION) as usize {
            let t = 0.01 * k as f64;
            let (force, rate) = self.motion(t);
            let (f, w) = (turned * force, turned * rate);
            write!(text, "{t},{},{},{},{},{},{}", f.x, f.y, f.z, w.x, w.y, w.z).unwrap();
            more.iter().for_each(|(_, value)| write!(text, ",{}", value(t)).unwrap());
            text.push('\n');
        }
        text
    }

    /// Checks that the mounting is found, and returns the warnings.
    fn assert_found(&self, degrees: [f64; 3], more: &[(&str, &dyn Fn(f64) -> f64)]) -> String {
        let recording = read(&self.file(degrees, more)).unwrap_or_else(|error| panic!("{degrees:?}: {error}"));
        for (time, input) in recording.times().zip(recording.inputs()).step_by(37) {
            let (force, rate) = self.motion(time);
            let off = (input.specific_force - force).norm() / force.norm();
            assert!(off < 0.02, "{degrees:?}, {time}: {} is not {force}", input.specific_force);
            assert!((input.angular_velocity - rate).norm() < 0.02, "{time}: {}", input.angular_velocity);
        }
        words::warnings(&recording).join(" ")
    }

    /// The same with a gyroscope that is off by so much about each axis \[rad/s\].
    fn biased(&self, bias: f64) -> Result<Recording, String> {
        let biased = |(k, line): (usize, &str)| {
            let fields = line.split(',').enumerate();
            let fields: Vec<String> = fields
                .map(|(column, field)| match field.parse::<f64>() {
                    Ok(value) if column >= 4 && k > 0 => (value + bias).to_string(),
                    _ => field.to_owned(),
                })
                .collect();
            fields.join(",") + "\n"
        };
        read(&self.file(PHONE, &[]).lines().enumerate().map(biased).collect::<String>())
    }

    fn refusal(&self, more: &[(&str, &dyn Fn(f64) -> f64)]) -> String {
        read(&self.file(PHONE, more)).map(|recording| words::warnings(&recording)).expect_err("forward must be unknown")
    }
}

fn mounting(degrees: [f64; 3]) -> Matrix3<f64> {
    Orientation::new(RollPitchYaw::from_vector(Vector3::from(degrees).map(f64::to_radians))).rotation
}

fn read(text: &str) -> Result<Recording, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("drive.csv");
    fs::write(&file, text).unwrap();
    let options = ConventionOptions { mounting: Some(Mounting::Auto), ..ConventionOptions::default() };
    Recording::read(&file, &options.load().unwrap()).map_err(|error| words::error(&error))
}

/// From 0 to 1 and back to 0 between two times, with the slope of a sine's square.
fn bump(t: f64, from: f64, to: f64) -> f64 {
    if (from..to).contains(&t) { (0.5 * TAU * (t - from) / (to - from)).sin().powi(2) } else { 0.0 }
}

/// From 0 to 1 between two times.
fn ramp(t: f64, from: f64, to: f64) -> f64 {
    let x = ((t - from) / (to - from)).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// A gentle bend before the first braking, at constant speed before it.
#[test]
fn bends_before_the_first_acceleration_do_not_mislead() {
    for yaw_rate in [0.017, 0.03, 0.05, 0.1, 0.2, -0.03, -0.1] {
        for leans in [false, true] {
            let speed = |t: f64| 30.0 - 20.0 * ramp(t, 20.0, 26.0) + 10.0 * ramp(t, 32.0, 38.0);
            let yaw_rate = |t: f64| yaw_rate * bump(t, 5.0, 13.0);
            let vehicle = Vehicle { speed, yaw_rate, leans, vibration: 0.0 };
            for degrees in [PHONE, [90.0, 0.0, 90.0], [0.0, 0.0, 0.0], [3.0, -20.0, 180.0]] {
                if leans && (vehicle.yaw_rate)(9.0).abs() < 0.1 {
                    // Too little lean to tell forward from backward: that is said.
                    let found = read(&vehicle.file(degrees, &[]));
                    let said = found.map_or_else(|error| error, |recording| words::warnings(&recording).join(" "));
                    let words = ["forward is backward", "but only to", "apart; give"];
                    let is_said = words.iter().any(|word| said.contains(word));
                    assert!(is_said || vehicle.assert_found(degrees, &[]).contains("lean"), "{said}");
                    continue;
                }
                let warnings = vehicle.assert_found(degrees, &[("speed", &|_| 30.0)]);
                assert!(!warnings.contains("backward"), "{warnings}");
            }
        }
    }
}

#[test]
fn bends_alone_show_forward() {
    for leans in [false, true] {
        let yaw_rate = |t: f64| 0.3 * (TAU * 0.1 * t).sin();
        let vehicle = Vehicle { speed: |_| 15.0, yaw_rate, leans, vibration: 0.4 };
        let evidence = if leans { "the lean in bends" } else { "the lateral force of bends" };
        for degrees in [PHONE, [90.0, 0.0, 90.0]] {
            let warnings = vehicle.assert_found(degrees, &[]);
            assert!(warnings.contains(evidence), "{warnings}");
        }
    }
}

#[test]
fn standing_does_not_show_forward() {
    for vibration in [0.0, 0.2] {
        let message = Vehicle { speed: |_| 0.0, yaw_rate: |_| 0.0, leans: false, vibration }.refusal(&[]);
        assert!(message.contains("finds no acceleration straight ahead"), "{message}");
        assert!(message.contains("give --mounting ROLL,PITCH,YAW"), "{message}");
    }
}

/// Without bends and speed the first acceleration is taken as forward after a stop, and a braking
/// as backward before it.
#[test]
fn the_first_stop_shows_the_sign() {
    let to_a_stop = |t: f64| 20.0 - 20.0 * ramp(t, 8.0, 14.0);
    // In motion the vehicle vibrates, so that only the stop is rest.
    let read_with = |speed: &dyn Fn(f64) -> f64| {
        let moving = Vehicle { speed, yaw_rate: |_| 0.0, leans: false, vibration: 0.5 };
        let standing = Vehicle { speed, yaw_rate: |_| 0.0, leans: false, vibration: 0.0 };
        let text = moving.file(PHONE, &[]);
        let still = standing.file(PHONE, &[]);
        let lines = text.lines().zip(still.lines()).enumerate();
        let pick = |(k, (a, b)): (usize, (&str, &str))| {
            let stands = k > 0 && speed(0.01 * (k - 1) as f64) < 1e-6;
            format!("{}\n", if stands { b } else { a })
        };
        read(&lines.map(pick).collect::<String>()).unwrap()
    };
    let at = |recording: &Recording, t: f64| recording.inputs()[(100.0 * t) as usize].specific_force.x;
    let stop_and_go = read_with(&|t| to_a_stop(t) + 15.0 * ramp(t, 20.0, 28.0));
    assert!(at(&stop_and_go, 11.0) < -3.0 && at(&stop_and_go, 24.0) > 2.0);
    let stop = read_with(&to_a_stop);
    assert!(at(&stop, 11.0) < -3.0, "{}", at(&stop, 11.0));
    let warnings = words::warnings(&stop_and_go).join(" ");
    assert!(warnings.contains("the first acceleration, at 2"), "{warnings}");
    assert!(warnings.contains("forward is backward: use --mounting=90.0,-0.0,90.0."), "{warnings}");
}

#[test]
fn contradictions_and_doubts_are_refused() {
    let speed = |t: f64| 20.0 - 8.0 * ramp(t, 20.0, 26.0);
    let yaw_rate = |t: f64| 0.1 * bump(t, 5.0, 13.0);
    let car = Vehicle { speed, yaw_rate, leans: false, vibration: 0.0 };
    let message = car.refusal(&[("speed", &|t| 40.0 - speed(t))]);
    assert!(message.contains("180 degrees apart; give --mounting ROLL,PITCH,YAW"), "{message}");
    // Brakings in bends, with either sign, are no reliable source.
    let speed = |t: f64| 10.0 + 2.0 * (TAU * 0.15 * t).sin();
    let yaw_rate = |t: f64| 0.1 * (5.0 * (TAU * 0.1 * t).sin()).tanh();
    let message = Vehicle { speed, yaw_rate, leans: false, vibration: 0.0 }.refusal(&[]);
    assert!(message.contains("but only to ") && message.contains("or take --mounting="), "{message}");
}

/// Rest has neither changing forces nor rates: up is found from it alone.
#[test]
fn steady_bends_and_shaking_are_no_rest() {
    let bend = |t: f64| 0.25 * ramp(t, 6.0, 8.0);
    let speed = |t: f64| 10.0 * ramp(t, 3.0, 6.0);
    Vehicle { speed, yaw_rate: bend, leans: false, vibration: 0.0 }.assert_found(PHONE, &[]);
    // A force that changes by 1 m/s2 within a second, to one side of rest.
    let speed = |t: f64| {
        0.5 * (t - 3.0).clamp(0.0, 3.0).powi(2)
            + 3.0 * (t - 6.0).max(0.0)
            + 1.5 * (1.0 - (TAU * 0.3 * (t - 6.0).max(0.0)).cos())
    };
    Vehicle { speed, yaw_rate: |_| 0.0, leans: false, vibration: 0.0 }.assert_found(PHONE, &[]);
}

/// The bias of a gyroscope is that at rest. Taken as a yaw rate, it makes of every
/// acceleration one in a bend.
#[test]
fn a_biased_gyroscope_does_not_mislead() {
    let speed = |t: f64| 12.0 * ramp(t, 5.0, 12.0) - 8.0 * ramp(t, 25.0, 30.0);
    let yaw_rate = |t: f64| 0.1 * bump(t, 14.0, 20.0);
    let recording = Vehicle { speed, yaw_rate, leans: false, vibration: 0.0 }.biased(0.025).unwrap();
    assert!((recording.inputs()[850].specific_force - Vector3::new(18.0 / 7.0, 0.0, GRAVITY)).norm() < 0.02);
    let evidence = "straight accelerations and the lateral force of bends";
    assert!(
        words::warnings(&recording).iter().any(|warning| warning.contains(evidence)),
        "{:?}",
        words::warnings(&recording)
    );
}

/// phyphox writes the speed at 1 Hz into a file of its own, which begins late.
#[test]
fn the_speed_of_phyphox_is_used() {
    let directory = tempfile::tempdir().unwrap();
    let speed = |t: f64| 20.0 - 12.0 * ramp(t, 8.0, 16.0) + 8.0 * ramp(t, 20.0, 30.0);
    let car = Vehicle { speed, yaw_rate: |_| 0.0, leans: false, vibration: 0.3 };
    let lines: Vec<Vec<String>> =
        car.file(PHONE, &[]).lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect();
    let write = |name: &str, header: &str, columns: &[usize]| {
        let mut text = format!("{header}\n");
        for line in &lines {
            writeln!(text, "{}", columns.iter().map(|&c| line[c].as_str()).collect::<Vec<_>>().join(",")).unwrap();
        }
        fs::write(directory.path().join(name), text).unwrap();
    };
    let axes = |name: &str, unit: &str| ["x", "y", "z"].map(|axis| format!("\"{name} {axis} ({unit})\"")).join(",");
    write("Accelerometer.csv", &format!("\"Time (s)\",{}", axes("Acceleration", "m/s^2")), &[0, 1, 2, 3]);
    write("Gyroscope.csv", &format!("\"Time (s)\",{}", axes("Gyroscope", "rad/s")), &[0, 4, 5, 6]);
    let mut text = "\"Time (s)\",\"Latitude (°)\",\"Longitude (°)\",\"Height (m)\",\"Velocity (m/s)\"\n".to_owned();
    (5..36).for_each(|t| writeln!(text, "{t},50,6,200,{}", speed(f64::from(t))).unwrap());
    fs::write(directory.path().join("Location.csv"), text).unwrap();
    let options = ConventionOptions { format: Some(Format::Phyphox), ..ConventionOptions::default() };
    let recording = Recording::read(Path::new(directory.path()), &options.load().unwrap()).unwrap();
    assert!((recording.manoeuvre.duration() - DURATION).abs() < 1e-9, "{}", recording.manoeuvre.duration());
    assert!(recording.inputs()[1200].specific_force.x < -1.5, "the recording begins with a braking");
    assert!((recording.inputs()[1200].speed - speed(12.0)).abs() < 0.5);
    let warnings = words::warnings(&recording).join(" ");
    assert!(warnings.contains("straight accelerations and the change of speed"), "{warnings}");
    assert!(!warnings.contains("Location.csv has no samples"), "{warnings}");
}
