//! Recordings as loggers write them: units in headers, decimal commas, compressed, and
//! files that are no CSV.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use flate2::Compression;
use flate2::write::GzEncoder;
use moris::recording::conventions::{ForceUnit, Quantity, RateUnit};
use moris::recording::{ConventionOptions, Recording};
use moris::words;

const GRAVITY: f64 = 9.80665;

/// A car at 20 m/s in gentle bends, at 50 Hz: time, specific force \[m/s2\],
/// angular velocity \[rad/s\].
fn car(duration: f64) -> Vec<[f64; 7]> {
    let sample = |k: usize| {
        let t = 0.02 * k as f64;
        let yaw_rate = 0.15 * (TAU * 0.1 * t).sin();
        let lateral = 20.0 * yaw_rate;
        // A body rolls by some 4 degrees per g, outwards.
        let roll_rate = (4f64.to_radians() / GRAVITY) * 20.0 * 0.15 * TAU * 0.1 * (TAU * 0.1 * t).cos();
        [t, 0.5 * (TAU * 0.05 * t).sin(), lateral, GRAVITY + 0.2 * (TAU * 1.3 * t).sin(), roll_rate, 0.0, yaw_rate]
    };
    (0..=(50.0 * duration) as usize).map(sample).collect()
}

fn csv(header: &str, samples: &[[f64; 7]], factors: [f64; 7]) -> String {
    let mut text = format!("{header}\n");
    for sample in samples {
        let fields: Vec<String> =
            sample.iter().zip(factors).map(|(value, factor)| (value * factor).to_string()).collect();
        writeln!(text, "{}", fields.join(",")).unwrap();
    }
    text
}

const SI: [f64; 7] = [1.0; 7];

/// Factors of a file with ms, g and deg/s.
fn ms_g_degrees() -> [f64; 7] {
    let degrees = 1f64.to_degrees();
    [1e3, 1.0 / GRAVITY, 1.0 / GRAVITY, 1.0 / GRAVITY, degrees, degrees, degrees]
}

fn read_bytes(name: &str, bytes: &[u8], options: &ConventionOptions) -> Result<Recording, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join(name);
    fs::write(&file, bytes).unwrap();
    let recording = Recording::read(&file, &options.load().unwrap());
    recording.map_err(|error| words::error(&error).replace(&format!("{}/", directory.path().display()), ""))
}

fn read(text: &str) -> Result<Recording, String> {
    read_bytes("drive.csv", text.as_bytes(), &ConventionOptions::default())
}

fn assert_is_the_car(recording: &Recording) {
    assert!(!recording.inputs().is_empty());
    for (sample, input) in car(20.0).iter().zip(recording.inputs()) {
        let found: Vec<f64> = input.specific_force.iter().chain(input.angular_velocity.iter()).copied().collect();
        for (found, expected) in found.iter().zip(&sample[1..]) {
            assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
        }
    }
}

#[test]
fn units_in_the_header_are_read() {
    let samples = car(20.0);
    for header in [
        "time [ms],ax [g],ay [g],az [g],wx [deg/s],wy [deg/s],wz [deg/s]",
        "Time (ms),AX (G),AY (G),AZ (G),WX (°/s),WY (dps),WZ (deg·s⁻¹)",
        "time[msec],ax (raw) [g],ay [g0],az [g],wx [deg/sec],wy [degrees/s],wz [º/s]",
        // Units in a line of their own.
        "time,ax,ay,az,wx,wy,wz\nms,g,g,g,deg/s,deg/s,deg/s",
        "time,ax,ay,az,wx,wy,wz\n[ms],[g],[g],[g],(°/s),(°/s),(°/s)",
    ] {
        let recording =
            read(&csv(header, &samples, ms_g_degrees())).unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_is_the_car(&recording);
    }
    // Latin-1, as loggers on Windows write it.
    let text = csv("time [ms],ax [g],ay [g],az [g],wx [°/s],wy [°/s],wz [°/s]", &samples, ms_g_degrees());
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    assert_is_the_car(&read_bytes("drive.csv", &latin, &ConventionOptions::default()).unwrap());
    // Speed, too.
    let speed = "time,ax,ay,az,wx,wy,wz,speed [km/h]\n0,0,0,9.81,0,0,0,36\n0.01,0,0,9.81,0,0,0,72\n";
    let speeds: Vec<f64> = read(speed).unwrap().inputs().iter().map(|input| input.speed).collect();
    assert!((speeds[0] - 10.0).abs() < 1e-12 && (speeds[1] - 20.0).abs() < 1e-12, "{speeds:?}");
}

#[test]
fn a_unit_that_contradicts_an_option_is_an_error() {
    let text = csv("time [ms],ax [g],ay [g],az [g],wx [deg/s],wy [deg/s],wz [deg/s]", &car(20.0), ms_g_degrees());
    let with = |options| read_bytes("drive.csv", text.as_bytes(), &options);
    assert_eq!(
        with(ConventionOptions { rate_unit: Some(RateUnit::RadianPerSecond), ..ConventionOptions::default() })
            .unwrap_err(),
        "drive.csv: column wx [deg/s] is in deg/s by its header, but --rate-unit gives rad/s; leave --rate-unit out, or \
         correct the header"
    );
    let same = ConventionOptions {
        rate_unit: Some(RateUnit::DegreePerSecond),
        force_unit: Some(ForceUnit::Gravity),
        ..ConventionOptions::default()
    };
    assert_is_the_car(&with(same).unwrap());
}

#[test]
fn a_unit_that_cannot_be_is_an_error() {
    let refused = |header: &str| read(&csv(header, &car(1.0), SI)).unwrap_err();
    let unknown = refused("time,ax [counts],ay,az,wx,wy,wz");
    assert!(
        unknown.contains("column ax [counts] has the unit counts, which is not known; known are m/s2, g, mg"),
        "{unknown}"
    );
    let other = refused("time,ax,ay,az,wx [m/s2],wy,wz");
    assert!(
        other.contains("column wx [m/s2] is in m/s2 by its header, which is no unit of angular velocity"),
        "{other}"
    );
    // One axis in deg/s leaves open in which unit the others are.
    let open = refused("time,ax,ay,az,wx [deg/s],wy,wz");
    assert!(open.contains("column wx [deg/s] is in deg/s by its header, but wy, wz are without a unit"), "{open}");
    // An unknown unit gives way to an option.
    let options =
        ConventionOptions { force_unit: Some(ForceUnit::MetrePerSecondSquared), ..ConventionOptions::default() };
    let text = csv("time,ax [SI],ay [SI],az [SI],wx,wy,wz", &car(20.0), SI);
    assert_is_the_car(&read_bytes("drive.csv", text.as_bytes(), &options).unwrap());
}

/// A quiet car's rates in deg/s stay below 10: only their consistency shows the unit.
#[test]
fn rates_that_are_plausible_only_in_degrees_are_rejected() {
    let header = "time,ax,ay,az,wx,wy,wz";
    let degrees = 1f64.to_degrees();
    let in_degrees = [1.0, 1.0, 1.0, 1.0, degrees, degrees, degrees];
    let samples = car(60.0);
    assert!(samples.iter().all(|s| s[4..].iter().all(|rate| (rate * degrees).abs() < 10.0)));
    let text = csv(header, &samples, in_degrees);
    let message = read(&text).unwrap_err();
    assert!(message.contains("these are degrees a second, not radians; use --rate-unit deg/s"), "{message}");
    // Each test on its own: turns without roll, roll without turns, and the derivative of roll.
    let only = |kept: &[usize]| {
        let keep =
            |s: &[f64; 7]| std::array::from_fn(|i| if i == 0 || i == 3 || kept.contains(&i) { s[i] } else { 0.0 });
        samples.iter().map(keep).collect::<Vec<[f64; 7]>>()
    };
    let turns = read(&csv(header, &only(&[2, 6]), in_degrees)).unwrap_err();
    assert!(turns.contains("a radius of 0.0"), "{turns}");
    let slalom: Vec<[f64; 7]> =
        car(60.0).iter().map(|s| [s[0], 0.0, 0.0, GRAVITY, 0.15 * (TAU * 0.2 * s[0]).sin(), 0.0, 0.0]).collect();
    let swing = read(&csv(header, &slalom, in_degrees)).unwrap_err();
    assert!(swing.contains("roll would swing by"), "{swing}");
    let mut with_roll = format!("{header},roll,pitch\n");
    for s in only(&[4]) {
        let roll = 0.02 * (TAU * 0.1 * s[0]).sin();
        let rate = degrees * 0.02 * TAU * 0.1 * (TAU * 0.1 * s[0]).cos();
        writeln!(with_roll, "{},0,0,{},{rate},0,0,{roll},0", s[0], s[3]).unwrap();
    }
    let derivative = read(&with_roll).unwrap_err();
    assert!(derivative.contains("57 times the derivative of roll"), "{derivative}");

    // In rad/s the same is accepted; rad/s that are given are not doubted.
    assert!(words::warnings(&read(&csv(header, &samples, SI)).unwrap()).is_empty());
    for rad in [
        read(&csv("time,ax,ay,az,wx [rad/s],wy [rad/s],wz [rad/s]", &samples, in_degrees)),
        read_bytes(
            "drive.csv",
            text.as_bytes(),
            &ConventionOptions { rate_unit: Some(RateUnit::RadianPerSecond), ..ConventionOptions::default() },
        ),
    ] {
        assert!(rad.is_ok(), "{rad:?}");
    }
}

/// Two-wheelers lean by 50 degrees and have no lateral force in turns; a walk's turns are tight.
/// Neither is a mistake.
#[test]
fn a_motorcycle_and_a_parking_car_are_plausible_in_radians() {
    let motorcycle: Vec<[f64; 7]> = (0..3000)
        .map(|k| {
            let t = 0.02 * f64::from(k);
            let (phase, omega) = (TAU * 0.4 * t, TAU * 0.4);
            let lean = 0.9 * phase.sin();
            let yaw_rate = -GRAVITY * lean.tan() / 15.0;
            // The head is above the centre of gravity: f = -h times the roll acceleration.
            [
                t,
                0.0,
                0.5 * 0.9 * omega * omega * phase.sin(),
                GRAVITY / lean.cos(),
                0.9 * omega * phase.cos(),
                0.0,
                yaw_rate,
            ]
        })
        .collect();
    assert!(read(&csv("time,ax,ay,az,wx,wy,wz", &motorcycle, SI)).is_ok());
    let parking: Vec<[f64; 7]> = (0..3000)
        .map(|k| {
            let t = 0.02 * f64::from(k);
            // A circle of 4.5 m at 1.5 m/s, there and back.
            let yaw_rate = 1.5 / 4.5 * (TAU * 0.05 * t).sin().signum();
            [t, 0.0, 1.5 * yaw_rate, GRAVITY, 0.0, 0.0, yaw_rate]
        })
        .collect();
    assert!(read(&csv("time,ax,ay,az,wx,wy,wz", &parking, SI)).is_ok());
}

#[test]
fn names_are_found_in_any_case_and_each_once() {
    let samples = car(20.0);
    let recording = read(&csv("TIME,Ax,aY,AZ,Wx,WY,wZ", &samples, SI)).unwrap();
    assert_is_the_car(&recording);
    let text = csv("T,Acc X,Acc Y,Acc Z,Gyro X,Gyro Y,Gyro Z", &samples, SI);
    let message = read(&text).unwrap_err();
    for name in ["time", "ax", "ay", "az", "wx", "wy", "wz"] {
        assert!(message.contains(&format!("{name}=NAME")), "{message}");
    }
    assert!(message.contains("there are T, Acc X, Acc Y"), "{message}");
    let twice = read(&csv("time,ax,ay,az,wx,wy,wz,ax", &samples, SI).replace('\n', ",0\n").replacen(",0\n", "\n", 1))
        .unwrap_err();
    assert!(twice.contains("two columns are called ax: ax (column 2) and ax (column 8)"), "{twice}");
    let units = read("time,ax [g],ax [m/s2],ay,az,wx,wy,wz\n0,0,0,0,1,0,0,0\n").unwrap_err();
    assert!(units.contains("two columns are called ax: ax [g] (column 2) and ax [m/s2] (column 3)"), "{units}");
    // The whole name tells them apart.
    let columns = vec![(Quantity::Force(0), "ax [m/s2]".to_owned())];
    let both = "time,ax [g],ax [m/s2],ay,az,wx,wy,wz\n0,0.1,0.980665,0,9.81,0,0,0\n0.01,0.1,0.980665,0,9.81,0,0,0\n";
    let options = ConventionOptions { columns, ..ConventionOptions::default() };
    assert_eq!(read_bytes("drive.csv", both.as_bytes(), &options).unwrap().inputs()[0].specific_force.x, 0.980665);
    let columns = vec![(Quantity::Force(0), "ay".to_owned())];
    let options = ConventionOptions { columns, ..ConventionOptions::default() };
    let shared = read_bytes("drive.csv", csv("time,ax,ay,az,wx,wy,wz", &samples, SI).as_bytes(), &options).unwrap_err();
    assert!(shared.contains("column ay is given for both ax and ay"), "{shared}");
}

#[test]
fn decimal_commas_are_read_and_not_mixed_with_points() {
    let plain = csv("time,ax,ay,az,wx,wy,wz", &car(20.0), SI);
    for delimiter in [";", "\t"] {
        let text = plain.replace(',', delimiter);
        assert_is_the_car(&read(&text.replace('.', ",")).unwrap());
        assert_is_the_car(&read(&text).unwrap());
    }
    let header = "time;ax;ay;az;wx;wy;wz\n";
    let mixed = read(&format!("{header}0,00;0;0;9,81;0;0;0\n0.01;0;0;9.81;0;0;0\n")).unwrap_err();
    assert_eq!(
        mixed,
        "drive.csv, line 3, column time: is 0.01, but numbers before it have a decimal comma; write all with the same"
    );
    let thousands = read(&format!("{header}0;1,000.5;0;9,81;0;0;0\n")).unwrap_err();
    assert!(thousands.contains("line 2, column ax: is \"1,000.5\", which is not a number"), "{thousands}");
    // Between commas, decimal commas double the fields, and must not be read as other columns.
    let commas = read("time,ax,ay,az,wx,wy,wz\n0,00,0,00,0,00,9,81,0,00,0,00,0,00\n").unwrap_err();
    assert!(
        commas.contains("line 2: has 14 fields below a header of 7; if its numbers have decimal commas"),
        "{commas}"
    );
}

#[test]
fn a_compressed_recording_is_read() {
    let text = csv("time,ax,ay,az,wx,wy,wz", &car(20.0), SI);
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(text.as_bytes()).unwrap();
    let packed = encoder.finish().unwrap();
    let recording = read_bytes("drive.csv.gz", &packed, &ConventionOptions::default()).unwrap();
    assert_eq!(recording.name, "drive");
    assert_is_the_car(&recording);
    let cut = read_bytes("drive.csv.gz", &packed[..packed.len() / 2], &ConventionOptions::default()).unwrap_err();
    assert!(cut.contains("cannot read drive.csv.gz"), "{cut}");
}

#[test]
fn standard_input_is_read() {
    let directory = tempfile::tempdir().unwrap();
    let run = |text: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_moris"));
        command.args(["simulate", "-", "--no-bound", "--report"]).arg(directory.path());
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        child.wait_with_output().unwrap()
    };
    let output = run(&csv("time,ax,ay,az,wx,wy,wz", &car(2.0), SI));
    // 3 m/s2 of sway are more than the default rig has room for, which is not what is tested here.
    assert!(matches!(output.status.code(), Some(0 | 3)), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(directory.path().join("stdin.html").exists());
    let output = run("time,ax\n");
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("standard input: there are no columns ay, az, wx, wy, wz"), "{message}");
}

#[test]
fn files_that_are_no_csv_are_recognised_and_never_printed() {
    let files: [(&str, Vec<u8>, &str); 18] = [
        (
            "a.xlsx",
            b"PK\x03\x04\x14\0\x06\0\x08\0[Content_Types].xml\x1b[31m".to_vec(),
            "Excel workbook; save the sheet as CSV",
        ),
        ("b.xlsx", b"PK\x03\x04\x14\0\0\0\x08\0docProps/app.xml".to_vec(), "Excel workbook"),
        ("a.ods", b"PK\x03\x04mimetypeapplication/vnd.oasis.opendocument.spreadsheet".to_vec(), "OpenDocument"),
        ("a.npz", b"PK\x03\x04\x14\0\0\0\x08\0time.npy\x93NUMPY".to_vec(), "NumPy archive (npz)"),
        ("a.npy", b"\x93NUMPY\x01\0v\0{'descr': '<f8'".to_vec(), "NumPy array"),
        ("a.bag", b"#ROSBAG V2.0\nE\0\0\0".to_vec(), "ROS bag"),
        ("a.ulg", b"ULog\x01\x12\x35\x01\0\0".to_vec(), "ULog of PX4; convert it to CSV with ulog2csv"),
        ("a.zip", b"PK\x03\x04\x14\0\0\0\x08\0Accelerometer.csv".to_vec(), "zip archive; unpack it"),
        ("a.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".to_vec(), "old Excel workbook"),
        ("a.parquet", b"PAR1\x15\x04\x15\x10".to_vec(), "Parquet file"),
        ("a.mat", b"MATLAB 5.0 MAT-file, Platform: GLNXA64".to_vec(), "MATLAB file"),
        ("a.h5", b"\x89HDF\r\n\x1a\n".to_vec(), "HDF5 file"),
        ("a.mf4", b"MDF     4.10    ".to_vec(), "MDF measurement (MF4)"),
        ("a.asc", b"date Fri May 1 12:30:00.000 2026\nbase hex  timestamps absolute\n".to_vec(), "CAN frames"),
        ("a.nmea", b"$GPRMC,123000.00,A,4500.00,N\n".to_vec(), "NMEA sentences"),
        ("a.ld", b"\x40\0\0\0\x88\x0d\x1b[2J\0".to_vec(), "no text but a binary file"),
        ("a.json", b"[{\"time\": 0}]".to_vec(), "JSON"),
        ("a.gpx", b"<?xml version=\"1.0\"?>".to_vec(), "XML"),
    ];
    for (name, bytes, expected) in files {
        let message = read_bytes(name, &bytes, &ConventionOptions::default()).unwrap_err();
        assert!(message.starts_with(&format!("{name}: is ")) && message.contains(expected), "{message}");
        assert!(!message.chars().any(char::is_control), "{message:?}");
    }
    // Escape sequences in text that messages quote are not for the terminal.
    for text in [
        "time,\x1b[31max,ay,az,wx,wy,wz\n0,0,0,9.81,0,0,0\n",
        "time,ax,ay,az,wx,wy,wz\n0,\x1b[2J,0,9.81,0,0,0\n",
        "time,ax [\x1b]0;title\x07],ay,az,wx,wy,wz\n0,0,0,9.81,0,0,0\n",
    ] {
        let message = read(text).unwrap_err();
        assert!(!message.chars().any(char::is_control), "{message:?}");
    }
    assert!(Recording::read(Path::new("no/such.csv"), &ConventionOptions::default().load().unwrap()).is_err());
}

/// In the manner of AiM, MoTeC and RaceChrono: facts about the session, the names, their units,
/// and what they come from.
#[test]
fn a_preamble_and_a_line_of_units_are_passed_over() {
    let header = "time,ax,ay,az,wx,wy,wz";
    let numbers = csv("", &car(20.0), ms_g_degrees());
    let numbers = numbers.trim_start();
    let preamble = "\"Format\",\"CSV File\"\n\"Venue\",\"Nowhere, 3 km\"\nSession,1,2,3\n\n";
    let text = format!("{preamble}{header}\nms,g,g,g,deg/s,deg/s,deg/s\nclock,imu,imu,imu,imu,imu,imu\n\n{numbers}");
    assert_is_the_car(&read(&text).unwrap());
    // Lines are counted from the file's beginning.
    let message = read(&text.replacen("\n\n0,", "\n\nx,", 1)).unwrap_err();
    assert!(message.starts_with("drive.csv, line 9, column time: is \"x\""), "{message}");
    // Where names are missing, those of the header are listed, not the preamble's.
    let message = read(&text.replacen("wz", "yaw rate", 1)).unwrap_err();
    assert!(message.contains("there is no column wz; there are time, ax, ay, az, wx, wy, yaw rate"), "{message}");
}

/// Columns in memory are read by the same rules as a file's.
#[test]
fn columns_in_memory_are_read_as_a_file() {
    let header = "time [ms],ax [g],ay [g],az [g],wx [deg/s],wy [deg/s],wz [deg/s],note";
    let text = csv(header, &car(20.0), ms_g_degrees()).replace('\n', ",0\n").replacen(",0\n", "\n", 1);
    let mut columns: Vec<(String, Vec<f64>)> = header.split(',').map(|title| (title.to_owned(), Vec::new())).collect();
    for line in text.lines().skip(1) {
        for (column, field) in columns.iter_mut().zip(line.split(',')) {
            column.1.push(field.parse().unwrap());
        }
    }
    let conventions = ConventionOptions::default().load().unwrap();
    let in_memory = |columns: &[(String, Vec<f64>)]| {
        Recording::of_columns("drive", columns, &conventions).map_err(|error| words::error(&error))
    };
    let (file, recording) = (read(&text).unwrap(), in_memory(&columns).unwrap());
    assert_eq!((recording.name.as_str(), recording.step(), recording.inputs()), ("drive", file.step(), file.inputs()));

    let mut gap = columns.clone();
    gap[2].1[7] = f64::NAN;
    let message = in_memory(&gap).unwrap_err();
    assert!(message.starts_with("drive, line 8, column ay [g]: is NaN"), "{message}");
    let mut short = columns.clone();
    short[3].1.pop();
    let message = in_memory(&short).unwrap_err();
    assert!(message.contains("column az [g] has") && message.contains("others have"), "{message}");
    let message = in_memory(&columns[..6]).unwrap_err();
    assert!(message.contains("there is no column wz"), "{message}");
}
