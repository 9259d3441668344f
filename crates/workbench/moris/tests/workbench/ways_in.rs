//! Recordings that are not plain CSV at equal steps. Each is read, or refused with the option that
//! helps.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

use moris::recording::conventions::{AngleUnit, Axes, EmptyFields, Format, Gravity, Missing, Mounting, Quantity};
use moris::recording::{ConventionOptions, Recording};
use moris::words;
use moris_washout::Input;
use moris_washout::motion::orientation::Orientation;
use moris_washout::nalgebra::{UnitQuaternion, Vector3};

const GRAVITY: f64 = 9.80665;
const HEADER: &str = "time,ax,ay,az,wx,wy,wz";

/// Forces and yaw rate of a car in bends at a time, and its speed.
fn car(t: f64) -> [f64; 4] {
    let yaw_rate = 0.1 * (TAU * 0.1 * t).sin();
    let speed = 15.0 - 4.0 * (TAU * 0.05 * t).cos();
    [4.0 * TAU * 0.05 * (TAU * 0.05 * t).sin(), speed * yaw_rate, yaw_rate, speed]
}

/// A file of so many seconds at 100 Hz, whose times are written by a function.
fn drive(seconds: usize, time: &dyn Fn(usize) -> String) -> String {
    let mut text = format!("{HEADER}\n");
    for k in 0..=100 * seconds {
        let [surge, sway, yaw_rate, _] = car(0.01 * k as f64);
        writeln!(text, "{},{surge},{sway},{GRAVITY},0,0,{yaw_rate}", time(k)).unwrap();
    }
    text
}

fn plain(k: usize) -> String {
    format!("{:.2}", 0.01 * k as f64)
}

fn read_as(name: &str, text: &str, options: &ConventionOptions) -> Result<Recording, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join(name);
    fs::write(&file, text).unwrap();
    let recording = Recording::read(&file, &options.load().unwrap());
    recording.map_err(|error| words::error(&error).replace(&format!("{}/", directory.path().display()), ""))
}

fn read(text: &str, options: &ConventionOptions) -> Result<Recording, String> {
    read_as("drive.csv", text, options)
}

fn assert_is_the_car(recording: &Recording, tolerance: f64) {
    assert!(recording.manoeuvre.duration() > 9.9, "{}", recording.manoeuvre.duration());
    for (time, input) in recording.times().zip(recording.inputs()) {
        let [surge, sway, yaw_rate, _] = car(time);
        assert!((input.specific_force.x - surge).abs() < tolerance, "{time}: {}", input.specific_force);
        assert!((input.specific_force.y - sway).abs() < tolerance, "{time}: {}", input.specific_force);
        assert!((input.specific_force.z - GRAVITY).abs() < tolerance, "{time}: {}", input.specific_force);
        assert!((input.angular_velocity.z - yaw_rate).abs() < tolerance, "{time}: {}", input.angular_velocity);
    }
}

/// In the manner of a logger with an inertial unit, and of one with a satellite receiver alone.
fn vbo(has_unit: bool, time: &dyn Fn(usize) -> String) -> String {
    let mut text =
        "File created on 01/05/2026 at 12:30:00\r\n\r\n[header]\r\nsatellites\r\ntime\r\nlatitude\r\nlongitude\r\n\
        velocity kmh\r\nheading\r\nheight\r\nLong accel g\r\nLat accel g\r\n"
            .to_owned();
    text += if has_unit {
        "YawRate\r\nX_Accel\r\nY_Accel\r\nZ_Accel\r\n\r\n[channel units]\r\nDegrees/s\r\ng\r\ng\r\ng\r\n"
    } else {
        "\r\n[channel units]\r\n"
    };
    text += "\r\n[comments]\r\n(c) 2001 2003 Racelogic\r\n";
    (0..150).for_each(|k| writeln!(text, "Line {k} of a long preamble\r").unwrap());
    text += "\r\n[laptiming]\r\nStart +5773.465840 +1832.282700 +5773.468800 +1832.204030\r\n\r\n[column names]\r\n\
        sats time lat long velocity heading height Longacc Latacc";
    text += if has_unit { " YawRate X_Accel Y_Accel Z_Accel" } else { "" };
    text += "\r\n\r\n[data]\r\n";
    for k in 0..=1000 {
        let [surge, sway, yaw_rate, speed] = car(0.01 * k as f64);
        let (surge, sway) = (surge / GRAVITY, sway / GRAVITY);
        let receiver = if has_unit { [0.0, 0.0] } else { [surge, sway] };
        write!(
            text,
            "137 {} +03119.09973 -00058.49277 {:07.4} 321.85 +00152.58 {:+.6} {:+.6}",
            time(k),
            3.6 * speed,
            receiver[0],
            receiver[1]
        )
        .unwrap();
        if has_unit {
            write!(text, " {:E} {surge:E} {sway:E} 1.0E+00", yaw_rate.to_degrees()).unwrap();
        }
        text += "\r\n";
    }
    text
}

/// A speed by satellite begins with the first fix. What a recording needs bounds
/// it, and nothing else.
#[test]
fn an_optional_column_that_begins_late_leaves_the_ride_as_long_as_it_is() {
    let options = ConventionOptions { empty_fields: Some(EmptyFields::Interpolate), ..ConventionOptions::default() };
    let ride = |force: std::ops::Range<usize>, speed: std::ops::Range<usize>| {
        let mut text = format!("{HEADER},speed\n");
        for k in 0..=1000 {
            let [surge, sway, yaw_rate, v] = car(0.01 * k as f64);
            let surge = if force.contains(&k) { surge.to_string() } else { String::new() };
            let v = if speed.contains(&k) { v.to_string() } else { String::new() };
            writeln!(text, "{},{surge},{sway},{GRAVITY},0,0,{yaw_rate},{v}", plain(k)).unwrap();
        }
        read(&text, &options).unwrap()
    };
    let late = ride(0..2000, 400..801);
    assert_is_the_car(&late, 1e-9);
    let speeds = [0, 300, 600, 1000].map(|k| late.inputs()[k].speed);
    assert_eq!(speeds, [4.0, 4.0, 6.0, 8.0].map(|time| car(time)[3]));
    let said = words::warnings(&late);
    let held = "Column speed begins at 4.00 s and ends at 8.00 s; its first and last values are used beyond.";
    let of_speed =
        |said: &[String]| said.iter().filter(|line| line.contains("Column speed")).cloned().collect::<Vec<_>>();
    assert_eq!(of_speed(&said), [held], "and the channels agree where all are measured");
    assert_eq!(of_speed(&words::warnings(&ride(0..2000, 0..2000))), [""; 0]);
    let bounded = ride(100..1001, 0..2000);
    assert!((bounded.manoeuvre.duration() - 9.0).abs() < 1e-9 && (bounded.start - 1.0).abs() < 1e-9);
}

#[test]
fn angles_of_a_whole_turn_are_those_about_zero() {
    let roll = |t: f64| 0.06 * (TAU * 0.1 * t).sin();
    let text: String = format!("{HEADER},roll,pitch,yaw\n")
        + &(0..=1000).fold(String::new(), |text, k| {
            let t = 0.01 * f64::from(k);
            let (force, rate) = (GRAVITY * roll(t).sin(), 0.06 * TAU * 0.1 * (TAU * 0.1 * t).cos());
            let degrees = roll(t).to_degrees().rem_euclid(360.0);
            text + &format!("{t:.2},0,{force},{},{rate},0,0,{degrees},0,0\n", GRAVITY * roll(t).cos())
        });
    let options = ConventionOptions { angle_unit: Some(AngleUnit::Degree), ..ConventionOptions::default() };
    let recording = read(&text, &options).unwrap();
    for (time, input) in recording.times().zip(recording.inputs()).skip(100) {
        assert!((input.orientation.roll - roll(time)).abs() < 1e-9, "{time}: {}", input.orientation.roll);
    }
}

/// Computed: the force along x is exactly 0 for seconds, and the speed stays, on
/// a slope that changes.
#[test]
fn a_computed_cruise_on_a_slope_is_no_sensor_that_has_stopped() {
    let mut text = format!("{HEADER},roll,pitch,yaw,speed\n");
    for k in 0..=2000 {
        let t = 0.01 * f64::from(k);
        let speed = 2.0 * t.min(5.0);
        let (pitch, rate) = (0.08 * (TAU * 0.06 * t).sin(), 0.08 * TAU * 0.06 * (TAU * 0.06 * t).cos());
        let force = if t < 5.0 { 2.0 } else { 0.0 };
        writeln!(text, "{t:.2},{force},0,0,0,{rate},0,0,{pitch},0,{speed}").unwrap();
    }
    let options = ConventionOptions { gravity: Some(Gravity::Removed), ..ConventionOptions::default() };
    let warnings = words::warnings(&read(&text, &options).unwrap()).join(" ");
    assert!(!warnings.contains("has stopped"), "{warnings}");
    // A force that stays although the vehicle brakes is another matter.
    let braking: String = text
        .lines()
        .map(|line| match line.rsplit_once(',') {
            Some((rest, speed)) if line.starts_with("15.") || line.starts_with("16.") => {
                let time: f64 = line.split(',').next().unwrap().parse().unwrap();
                format!("{rest},{}\n", speed.parse::<f64>().unwrap() - 2.0 * (time - 15.0))
            }
            _ => format!("{line}\n"),
        })
        .collect();
    let said = read(&braking, &options).map_or_else(|error| error, |recording| words::warnings(&recording).join(" "));
    assert!(said.contains("has stopped") || said.contains("stays at one value"), "{said}");
}

#[test]
fn lines_that_are_a_few_places_apart_are_to_be_sorted() {
    let text = drive(10, &plain);
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(101, 104);
    lines.swap(301, 303);
    let message = read(&(lines.join("\n") + "\n"), &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("time goes back") && message.contains("sort_values"), "{message}");
}

#[test]
fn vbox_files_are_read() {
    let format = ConventionOptions { format: Some(Format::Vbox), ..ConventionOptions::default() };
    // Past midnight, too.
    for hour in [12, 23] {
        let clock = |k: usize| {
            let t = 0.01 * k as f64 + 55.0 + 60.0 * 59.0 + 3600.0 * f64::from(hour);
            format!("{:02}{:02}{:05.2}", (t / 3600.0) as u32 % 24, (t / 60.0) as u32 % 60, t % 60.0)
        };
        let recording = read_as("drive.vbo", &vbo(true, &clock), &format).unwrap();
        assert_is_the_car(&recording, 1e-4);
        assert!((recording.inputs()[500].speed - car(5.0)[3]).abs() < 1e-4, "{}", recording.inputs()[500].speed);
        let missing = "The recording has no wx, wy: they are taken as at rest.";
        assert!(
            words::warnings(&recording).iter().any(|warning| warning == missing),
            "{:?}",
            words::warnings(&recording)
        );
        let receiver = read_as("drive.vbo", &vbo(false, &clock), &format).unwrap();
        for (time, input) in receiver.times().zip(receiver.inputs()) {
            assert!((input.specific_force.y - car(time)[1]).abs() < 1e-4);
            assert!(input.specific_force.z == GRAVITY && input.angular_velocity.norm() == 0.0);
        }
        let message = read_as("drive.vbo", &vbo(false, &clock), &ConventionOptions::default()).unwrap_err();
        assert!(message.contains("use --format vbox"), "{message}");
        // Lines are those of the file.
        let wrong = vbo(true, &clock).replacen(" 1.0E+00\r\n", " one\r\n", 1);
        let line = wrong.lines().position(|line| line.ends_with(" one")).unwrap() + 1;
        let message = read_as("drive.vbo", &wrong, &format).unwrap_err();
        assert!(
            message.starts_with(&format!("drive.vbo, line {line}, column vertical accel [g]: is \"one\"")),
            "{message}"
        );
    }
}

#[test]
fn a_recording_without_a_gyroscope_is_read_on_request() {
    let text: String =
        drive(10, &plain).lines().map(|line| line.split(',').take(4).collect::<Vec<_>>().join(",") + "\n").collect();
    let message = read(&text, &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("there are no columns wx, wy, wz") && message.contains("use --missing rest"), "{message}");
    let rest = ConventionOptions { missing: Some(Missing::Rest), ..ConventionOptions::default() };
    let recording = read(&text, &rest).unwrap();
    assert!(recording.inputs().iter().all(|input| input.angular_velocity.norm() == 0.0));
    assert!(words::warnings(&recording)[0].contains("has no wx, wy, wz"), "{:?}", words::warnings(&recording));
    // Forward is not found without a gyroscope, and a turned sensor's vertical is not known.
    let auto = ConventionOptions { mounting: Some(Mounting::Auto), ..rest.clone() };
    assert!(read(&text, &auto).unwrap_err().contains("there are no columns wx, wy, wz"));
    let message = read(&text.replacen("ax", "surge", 1), &rest).unwrap_err();
    assert!(message.contains("no column ax") && !message.contains("--missing"), "{message}");
}

#[test]
fn equal_times_are_spread_on_request() {
    // 100 Hz, written with one digit.
    let rounded = |k: usize| format!("{:.1}", (k / 10) as f64 * 0.1);
    let message = read(&drive(10, &rounded), &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("time stands still") && message.contains("--resample 100 spreads"), "{message}");
    let resample = ConventionOptions { resample: Some(100.0), ..ConventionOptions::default() };
    let recording = read(&drive(10, &rounded), &resample).unwrap();
    assert_is_the_car(&recording, 1e-6);
    assert!(
        words::warnings(&recording).iter().any(|warning| warning.contains("spread evenly")),
        "{:?}",
        words::warnings(&recording)
    );
    // At the end, steps are the mean ones.
    let last = |k: usize| plain(k.min(999));
    let recording = read(&drive(10, &last), &resample).unwrap();
    assert!((recording.manoeuvre.duration() - 10.0).abs() < 0.011);
    // In several files as well.
    let directory = tempfile::tempdir().unwrap();
    let columns = |from: usize, to: usize| -> String {
        let line = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            format!("{},{}\n", fields[0], fields[from..to].join(","))
        };
        drive(10, &rounded).lines().map(line).collect()
    };
    fs::write(directory.path().join("force.csv"), columns(1, 4)).unwrap();
    fs::write(directory.path().join("rate.csv"), columns(4, 7)).unwrap();
    let read = |options: &ConventionOptions| Recording::read(directory.path(), &options.load().unwrap());
    assert_is_the_car(&read(&resample).unwrap(), 1e-6);
    let message = words::error(&read(&ConventionOptions::default()).unwrap_err());
    assert!(message.contains("--resample 100 spreads"), "{message}");
}

#[test]
fn a_last_line_that_is_cut_off_is_left_out() {
    let text = drive(10, &plain);
    let expected = read(&text, &ConventionOptions::default()).unwrap();
    for end in ["10.0", "10.01,0.3", "10.01,0.3,0.1,9.8,0,0,-"] {
        let recording = read(&format!("{text}{end}"), &ConventionOptions::default()).unwrap();
        assert_eq!(recording.inputs(), expected.inputs(), "{end}");
        assert_eq!(words::warnings(&recording)[..1], ["The last line, 1003, is cut off and left out."]);
    }
    // A line in the middle, and a whole last one, are errors.
    assert!(read(&text.replacen("\n0.05,", "\n0.05\n0.055,", 1), &ConventionOptions::default()).is_err());
    assert!(read(&format!("{text}10.01,0.3,0.1,9.8,0,0,-\n"), &ConventionOptions::default()).is_err());
}

#[test]
fn laps_are_read_one_by_one() {
    let lap = drive(10, &plain);
    let second = lap.replacen(&format!("{HEADER}\n"), "", 1);
    let text = format!("{lap}{second}{}", second.replace(&GRAVITY.to_string(), "9.9"));
    let message = read(&text, &ConventionOptions::default()).unwrap_err();
    assert!(
        message.contains("line 1003, column time: time starts again: there are 3 laps; use --lap 1 to --lap 3"),
        "{message}"
    );
    let with = |lap: f64| read(&text, &ConventionOptions { lap: Some(lap), ..ConventionOptions::default() });
    let laps = [1.0, 2.0, 3.0].map(|lap| with(lap).unwrap());
    assert_is_the_car(&laps[0], 1e-9);
    assert_eq!(laps[0].inputs(), laps[1].inputs());
    assert_eq!((laps[2].inputs().len(), laps[2].inputs()[7].specific_force.z), (1001, 9.9));
    assert!(with(4.0).unwrap_err().contains("has no samples of lap 4: time starts 3 times"));
    let fraction = ConventionOptions { lap: Some(1.7), ..ConventionOptions::default() }.load().unwrap_err();
    assert_eq!(fraction.to_string(), "lap is 1.7, but must be from 1 to 1000000 and whole");
}

#[test]
fn dates_with_the_year_last_are_read() {
    for date in ["01/05/2026", "1.5.2026", "05-01-2026"] {
        let clock = |k: usize| {
            let t = 86_395.0 + 0.01 * k as f64;
            let day = if t < 86_400.0 { date.to_owned() } else { date.replacen('1', "2", 1) };
            format!("{day} {:02}:{:02}:{:05.2}", (t / 3600.0) as u32 % 24, (t / 60.0) as u32 % 60, t % 60.0)
        };
        assert_is_the_car(&read(&drive(10, &clock), &ConventionOptions::default()).unwrap(), 1e-6);
    }
}

#[test]
fn a_directory_of_rides_is_several_recordings() {
    let directory = tempfile::tempdir().unwrap();
    let rides = directory.path().join("rides");
    fs::create_dir(&rides).unwrap();
    let run = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_moris"));
        command.args(["simulate", "--no-bound", "--report"]).arg(directory.path().join("report")).arg(&rides);
        command.output().unwrap()
    };
    let exists = |name: &str| Path::new(&directory.path().join("report").join(name)).exists();
    fs::write(rides.join("morning.csv"), drive(10, &plain)).unwrap();
    fs::write(rides.join("notes.csv"), "time,text\n0,cold\n").unwrap();
    run();
    assert!(exists("rides.html"));
    fs::write(rides.join("evening.csv"), drive(10, &plain)).unwrap();
    let output = run();
    assert!(matches!(output.status.code(), Some(0 | 3)), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(exists("morning.html") && exists("evening.html") && exists("index.html") && !exists("notes.html"));
}

#[test]
fn a_quaternion_is_the_orientation() {
    let angles = |t: f64| [0.3 * (0.7 * t).sin(), 0.2 * (0.5 * t).cos(), 0.4 * t];
    let file = |header: &str, orientation: &dyn Fn([f64; 3]) -> Vec<f64>| {
        let mut text = format!("{HEADER},{header}\n");
        for k in 0..600 {
            let t = 0.01 * f64::from(k);
            let [surge, sway, yaw_rate, _] = car(t);
            let orientation: Vec<String> = orientation(angles(t)).iter().map(f64::to_string).collect();
            writeln!(text, "{t:.2},{surge},{sway},{GRAVITY},0,0,{yaw_rate},{}", orientation.join(",")).unwrap();
        }
        text
    };
    let quaternion = |scale: f64| {
        move |[roll, pitch, yaw]: [f64; 3]| {
            let q = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
            // Both signs are the same rotation.
            let scale = if (0.1 * yaw).fract() > 0.1 { -scale } else { scale };
            [q.i, q.j, q.k, q.w].map(|part| scale * part).to_vec()
        }
    };
    for axes in [Axes::ForwardLeftUp, Axes::ForwardRightDown, Axes::ForwardRightUp] {
        let sign = Axes::force_signs(axes)[2];
        let turned = |text: &str| text.replace(&format!(",{GRAVITY},"), &format!(",{},", sign * GRAVITY));
        let options = ConventionOptions { axes: Some(axes), ..ConventionOptions::default() };
        let read = |text: String| read(&turned(&text), &options);
        let expected = read(file("roll,pitch,yaw", &|angles| angles.to_vec())).unwrap();
        let found = read(file("qx,qy,qz,qw", &quaternion(1.0))).unwrap();
        assert!(found.has_orientation);
        for (found, expected) in found.inputs().iter().zip(expected.inputs()) {
            let rotation = |input: &Input| Orientation::new(input.orientation).rotation;
            assert!((rotation(found) - rotation(expected)).norm() < 1e-9);
        }
        let counts = read(file("qx,qy,qz,qw", &quaternion(16384.0))).unwrap_err();
        assert!(counts.contains("have the norm 16384.000") && counts.contains("\"qw=qw / 16384,"), "{counts}");
    }
}

#[test]
fn lines_in_reverse_and_lines_of_single_sensors_are_refused_with_the_way_to_turn_them() {
    let mut lines: Vec<String> = drive(10, &plain).lines().map(str::to_owned).collect();
    lines[1..].reverse();
    let reversed = read(&(lines.join("\n") + "\n"), &ConventionOptions::default()).unwrap_err();
    assert!(reversed.contains("the last line comes first") && reversed.contains("[::-1]"), "{reversed}");
    let mut long = "sensor,timestamp,x,y,z\n".to_owned();
    for k in 0..100 {
        writeln!(long, "ACC,{k},0,0,9.8\nGYR,{k},0,0,0").unwrap();
    }
    let long = read(&long, &ConventionOptions::default()).unwrap_err();
    assert!(long.contains("a line for each value of a channel"), "{long}");
}

#[test]
fn forms_that_are_not_read_are_told_with_the_way_to_convert_them() {
    let table = |header: &str, line: &str| format!("{header}\n{}", format!("{line}\n").repeat(100));
    for (text, said) in [
        (table("time,acc,gyro", "0.01,\"[0.1, 0.2, 9.8]\",\"[0, 0, 0]\""), "fields hold lists of numbers"),
        (table(",acc,acc,acc,gyr,gyr,gyr\n,x,y,z,x,y,z", "0.01,0,0,9.8,0,0,0"), "the header has several lines"),
        (
            table("# Acc,time,x,y,z\n# Gyro,time,x,y,z", "Acc,0.01,0,0,9.8\nGyro,0.01,0,0,0"),
            "lines begin with their kind",
        ),
    ] {
        let refused = read(&text, &ConventionOptions::default()).unwrap_err();
        assert!(refused.contains(said), "{refused}");
    }
    let plain = read("time,acc_x,acc_y\n0,1,2\n", &ConventionOptions::default()).unwrap_err();
    assert!(!plain.contains("lists") && !plain.contains("header has") && !plain.contains("their kind"), "{plain}");
}

#[test]
fn accelerations_of_a_receiver_are_not_turned_with_the_sensor_that_it_lacks() {
    let mut text = "This file is created using RaceChrono v9.1.3\n\n\
         timestamp,elapsed_time,speed,speed,longitudinal_acc,lateral_acc\n\
         unix time,s,m/s,m/s,G,G\n,,100: gps,calc,calc,calc\n"
        .to_owned();
    for k in 0..=200 {
        let t = 0.05 * f64::from(k);
        let [surge, sway, _, speed] = car(t);
        let (surge, sway) = (surge / GRAVITY, sway / GRAVITY);
        writeln!(text, "{:.2},{t:.2},{speed},{speed},{surge:.6},{sway:.6}", 1_777_636_800.0 + t).unwrap();
    }
    let named = |of: Quantity, name: &str| (of, name.to_owned());
    let columns = vec![named(Quantity::Force(0), "longitudinal_acc"), named(Quantity::Force(1), "lateral_acc")];
    let format = Some(Format::RaceChrono);
    let options = ConventionOptions { format, columns, missing: Some(Missing::Rest), ..ConventionOptions::default() };
    let recording = read(&text, &options).unwrap();
    for (time, input) in recording.times().zip(recording.inputs()) {
        let [surge, sway, ..] = car(time);
        let expected = Vector3::new(surge, sway, GRAVITY);
        assert!((input.specific_force - expected).amax() < 0.01, "{time}: {}", input.specific_force);
    }
    // With a sensor that is turned, what is missing is not known: the remedy is not the one that is given.
    let turned = ConventionOptions { mounting: Some(Mounting::Auto), ..options };
    let refused = read(&text, &turned).unwrap_err();
    assert!(refused.contains("leave out --mounting") && !refused.contains("--missing rest"), "{refused}");
}

#[test]
fn titles_may_be_numbers_where_files_are_joined() {
    let directory = tempfile::tempdir().unwrap();
    let (mut forces, mut rates) =
        ("cts,accelerometer [m/s2],1,2\n".to_owned(), "cts,gyroscope [rad/s],1,2\n".to_owned());
    for k in 0..=1000 {
        let [surge, sway, yaw_rate, _] = car(0.01 * f64::from(k));
        writeln!(forces, "{},{GRAVITY},{surge},{sway}", 10 * k).unwrap();
        writeln!(rates, "{},{yaw_rate},0,0", 10 * k).unwrap();
    }
    fs::write(directory.path().join("accl.csv"), forces).unwrap();
    fs::write(directory.path().join("gyro.csv"), rates).unwrap();
    let options = "time-unit = 'ms'\n[columns]\ntime = 'cts'\naz = 'accelerometer'\nax = 'accl.1'\nay = 'accl.2'\n\
         wz = 'gyroscope'\nwx = 'gyro.1'\nwy = 'gyro.2'\n";
    let options: ConventionOptions = toml::from_str(options).unwrap();
    let recording = Recording::read(directory.path(), &options.load().unwrap()).unwrap();
    assert_is_the_car(&recording, 1e-9);
}
