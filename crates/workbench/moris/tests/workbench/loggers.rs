//! Recordings of public loggers: their formats by name, several files of one ride, times
//! of day, turned sensors.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use moris::recording::conventions::{EmptyFields, Format, Mounting, Quantity};
use moris::recording::{ConventionOptions, Recording};
use moris::words;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::{Matrix3, Vector3};

const GRAVITY: f64 = 9.80665;

/// A car that stands for 2 s, pulls away, and then drives gentle bends: specific force \[m/s2\] and
/// angular velocity \[rad/s\] of the vehicle at a time.
fn car(t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let pull = if (2.0..6.0).contains(&t) { 1.5 * (TAU * (t - 2.0) / 8.0).sin().max(0.0) } else { 0.0 };
    let yaw_rate = if t > 8.0 { 0.15 * (TAU * 0.1 * (t - 8.0)).sin() } else { 0.0 };
    let heave = if t > 2.0 { 0.2 * (TAU * 1.3 * (t - 2.0)).sin() } else { 0.0 };
    let roll_rate = if t > 8.0 { 0.02 * (TAU * 0.1 * (t - 8.0)).cos() } else { 0.0 };
    (Vector3::new(pull, 12.0 * yaw_rate, GRAVITY + heave), Vector3::new(roll_rate, 0.0, yaw_rate))
}

/// The speed that [`car`]'s force gives \[m/s\].
fn speed(t: f64) -> f64 {
    let phase = |t: f64| 1.5 * 8.0 / TAU * (1.0 - (TAU * (t - 2.0) / 8.0).cos());
    phase(t.clamp(2.0, 6.0))
}

fn times(rate: f64, from: f64, to: f64) -> Vec<f64> {
    (0..=((to - from) * rate) as usize).map(|k| from + k as f64 / rate).collect()
}

/// The sensor's axes in the vehicle, by roll, pitch and yaw in degrees.
fn mounting(degrees: [f64; 3]) -> Matrix3<f64> {
    Orientation::new(RollPitchYaw::from_vector(Vector3::from(degrees).map(f64::to_radians))).rotation
}

/// Checks that a recording is the car's from a time on.
fn assert_is_the_car(recording: &Recording, from: f64, tolerance: f64) {
    assert!(recording.manoeuvre.duration() > 15.0, "{}", recording.manoeuvre.duration());
    for (time, input) in recording.times().zip(recording.inputs()) {
        let (force, rate) = car(from + time);
        assert!((input.specific_force - force).norm() < tolerance, "{time}: {} is not {force}", input.specific_force);
        assert!((input.angular_velocity - rate).norm() < tolerance, "{time}: {}", input.angular_velocity);
    }
}

fn with_format(format: Format) -> ConventionOptions {
    ConventionOptions { format: Some(format), ..ConventionOptions::default() }
}

fn read(path: &Path, options: &ConventionOptions) -> Result<Recording, String> {
    Recording::read(path, &options.load().map_err(|error| words::error(&error))?).map_err(|error| words::error(&error))
}

fn read_text(text: &str, options: &ConventionOptions) -> Result<Recording, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("drive.csv");
    fs::write(&file, text).unwrap();
    read(&file, options).map_err(|error| error.replace(&format!("{}/", directory.path().display()), ""))
}

/// A file with a line a sample: `fields` gives those of a time.
fn sheet(header: &str, times: &[f64], fields: impl Fn(f64) -> Vec<f64>) -> String {
    let mut text = format!("{header}\n");
    for &time in times {
        let fields: Vec<String> = fields(time).iter().map(f64::to_string).collect();
        writeln!(text, "{}", fields.join(",")).unwrap();
    }
    text
}

/// Force and rate of a sensor that is mounted in the car, in units that the factors convert to.
fn sensed(mounting: &Matrix3<f64>, t: f64, force_unit: f64, rate_unit: f64) -> [f64; 6] {
    let (force, rate) = car(t);
    let (force, rate) = (mounting.transpose() * force / force_unit, mounting.transpose() * rate / rate_unit);
    [force.x, force.y, force.z, rate.x, rate.y, rate.z]
}

/// The phone upright in a holder: its x points right, y up, and z back.
fn phone() -> Matrix3<f64> {
    let columns = [Vector3::new(0.0, -1.0, 0.0), Vector3::z(), -Vector3::x()];
    Matrix3::from_columns(&columns)
}

#[test]
fn phyphox_is_a_directory_of_files() {
    let directory = tempfile::tempdir().unwrap();
    let folder = directory.path().join("2026-05-01 commute");
    fs::create_dir(&folder).unwrap();
    let force = |t: f64| sensed(&phone(), t, 1.0, 1.0)[..3].to_vec();
    let rate = |t: f64| sensed(&phone(), t, 1.0, 1.0)[3..].to_vec();
    let with_time = |t: f64, values: Vec<f64>| [vec![t], values].concat();
    let header = r#""Time (s)","Acceleration x (m/s^2)","Acceleration y (m/s^2)","Acceleration z (m/s^2)""#;
    let text = sheet(header, &times(200.0, 0.003, 20.0), |t| with_time(t, force(t)));
    fs::write(folder.join("Accelerometer.csv"), text).unwrap();
    let header = r#""Time (s)","Gyroscope x (rad/s)","Gyroscope y (rad/s)","Gyroscope z (rad/s)""#;
    let text = sheet(header, &times(170.0, 0.1, 20.5), |t| with_time(t, rate(t)));
    fs::write(folder.join("Gyroscope.csv"), text).unwrap();
    fs::create_dir(folder.join("meta")).unwrap();
    fs::write(folder.join("device.csv"), "\"property\",\"value\"\n\"version\",\"1.2.0\"\n").unwrap();

    let recording = read(&folder, &with_format(Format::Phyphox)).unwrap();
    assert_eq!(recording.name, "2026-05-01 commute");
    assert_eq!(recording.step(), 0.01);
    // From the first time that both files have, by linear interpolation.
    assert_is_the_car(&recording, recording.start, 0.01);
    assert!((0.1..0.106).contains(&recording.start), "{}", recording.start);
    assert!(
        words::warnings(&recording)
            .iter()
            .any(|warning| warning.contains("straight accelerations and the lateral force of bends")),
        "{:?}",
        words::warnings(&recording)
    );
    // The files by name are the same recording; a format's name is found out.
    let both = format!("{}+{}", folder.join("Accelerometer.csv").display(), folder.join("Gyroscope.csv").display());
    let joined = read(Path::new(&both), &with_format(Format::Phyphox)).unwrap();
    assert_eq!((joined.name.as_str(), joined.inputs()), ("Accelerometer+Gyroscope", recording.inputs()));
    let message = read(&folder, &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("use --format phyphox"), "{message}");
}

/// Both systems of Sensor Logger: on iOS gravity and motion apart, with the opposite sign.
#[test]
fn sensor_logger_is_read_on_both_systems() {
    let directory = tempfile::tempdir().unwrap();
    let header = "time,seconds_elapsed,z,y,x";
    let write = |folder: &Path, name: &str, rate: f64, vector: &dyn Fn(f64) -> Vector3<f64>| {
        let row = |t: f64| {
            let v = vector(t);
            vec![1.7e18 + 1e9 * t, t, v.z, v.y, v.x]
        };
        fs::write(folder.join(name), sheet(header, &times(rate, 0.0, 20.0), row)).unwrap();
    };
    let turned = |vector: Vector3<f64>| phone().transpose() * vector;
    let gravity = turned(Vector3::new(0.0, 0.0, GRAVITY));
    for (name, format) in [("android", Format::SensorLogger), ("ios", Format::SensorLoggerIos)] {
        let folder = directory.path().join(name);
        fs::create_dir(&folder).unwrap();
        write(&folder, "Gyroscope.csv", 100.0, &|t| turned(car(t).1));
        let sign = if format == Format::SensorLoggerIos { -1.0 } else { 1.0 };
        write(&folder, "Accelerometer.csv", 100.0, &|t| sign * (turned(car(t).0) - gravity));
        write(&folder, "Gravity.csv", 100.0, &|_| sign * gravity);
        if format == Format::SensorLogger {
            write(&folder, "TotalAcceleration.csv", 100.0, &|t| turned(car(t).0));
        }
        fs::write(folder.join("Annotation.csv"), "time,seconds_elapsed,text\n1,2,start\n").unwrap();
        let recording = read(&folder, &with_format(format)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_is_the_car(&recording, 0.0, 1e-6);
    }
}

#[test]
fn single_files_of_loggers_are_read() {
    let degree = 1f64.to_radians();
    let rows = |force: f64, rate: f64, signs: [f64; 3]| {
        move |t: f64| {
            let sensed = sensed(&Matrix3::identity(), t, force, rate);
            (0..6).map(|i| sensed[i] * signs[i % 3]).collect::<Vec<f64>>()
        }
    };
    let at = |time: f64, values: Vec<f64>| [vec![time], values].concat();
    let plain = [1.0; 3];

    let quoted = |names: [&str; 7]| names.map(|name| format!("\"{name}\"")).join(",");
    let aim = format!(
        "\"Format\",\"AiM CSV File\"\n\"Session\",\"Test\"\n\"Sample Rate\",\"50\"\n\n{}\n{}\n\n",
        quoted(["Time", "InlineAcc", "LateralAcc", "VerticalAcc", "RollRate", "PitchRate", "YawRate"]),
        quoted(["s", "g", "g", "g", "deg/s", "deg/s", "deg/s"])
    );
    let motec = format!(
        "\"Format\",\"MoTeC CSV File\",,,\"Workbook\",\"\"\n\"Venue\",\"Nowhere\"\n\n{}\n{}\n\n",
        quoted([
            "Time",
            "G Force Long",
            "G Force Lat",
            "G Force Vert",
            "Gyro Roll Velocity",
            "Gyro Pitch Velocity",
            "Gyro Yaw Velocity"
        ]),
        quoted(["s", "G", "G", "G", "deg/s", "deg/s", "deg/s"])
    );
    for (format, header) in [(Format::Aim, aim), (Format::Motec, motec)] {
        let row = rows(GRAVITY, degree, plain);
        let text = sheet(header.trim_end(), &times(50.0, 0.0, 20.0), |t| at(t, row(t)));
        assert_is_the_car(&read_text(&text, &with_format(format)).unwrap(), 0.0, 1e-9);
    }

    let row = rows(1.0, 1.0, plain);
    let text =
        sheet("SessionTime,LongAccel,LatAccel,VertAccel,RollRate,PitchRate,YawRate", &times(60.0, 0.0, 20.0), |t| {
            at(t, row(t))
        });
    assert_is_the_car(&read_text(&text, &with_format(Format::IRacing)).unwrap(), 0.0, 1e-9);

    // x forward, y right, z down, in microseconds.
    let row = rows(1.0, 1.0, [1.0, -1.0, -1.0]);
    let header = "timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],gyro_integral_dt,accelerometer_timestamp_relative,\
                  accelerometer_m_s2[0],accelerometer_m_s2[1],accelerometer_m_s2[2]";
    let text = sheet(header, &times(200.0, 5.0, 25.0), |t| {
        let v = row(t - 5.0);
        vec![(1e6 * t).round(), v[3], v[4], v[5], 5000.0, 0.0, v[0], v[1], v[2]]
    });
    assert_is_the_car(&read_text(&text, &with_format(Format::Px4)).unwrap(), 0.0, 1e-6);

    let header = "ACCELEROMETER X (m/s²),ACCELEROMETER Y (m/s²),ACCELEROMETER Z (m/s²),GYROSCOPE X (rad/s),\
                  GYROSCOPE Y (rad/s),GYROSCOPE Z (rad/s),Time since start in ms ";
    let text = sheet(header, &times(100.0, 0.0, 20.0), |t| {
        let sensed = sensed(&phone(), t, 1.0, 1.0);
        [sensed.to_vec(), vec![1e3 * t]].concat()
    });
    assert_is_the_car(&read_text(&text, &with_format(Format::AndroSensor)).unwrap(), 0.0, 1e-6);

    let names =
        ["UserAcceleration", "Gravity"].map(|what| ["X", "Y", "Z"].map(|axis| format!("motion{what}{axis}(G)")));
    let rates = ["X", "Y", "Z"].map(|axis| format!("motionRotationRate{axis}(rad/s)"));
    let header = [vec!["motionTimestamp_sinceReboot(s)".to_owned()], rates.to_vec(), names.concat()].concat().join(",");
    let text = sheet(&header, &times(100.0, 0.0, 20.0), |t| {
        let sensed = sensed(&phone(), t, GRAVITY, 1.0);
        let up = phone().transpose() * Vector3::z();
        let user: Vec<f64> = (0..3).map(|axis| up[axis] - sensed[axis]).collect();
        [vec![t], sensed[3..].to_vec(), user, (-up).iter().copied().collect()].concat()
    });
    assert_is_the_car(&read_text(&text, &with_format(Format::SensorLog)).unwrap(), 0.0, 1e-6);
}

/// RaceChrono: a preamble, three header lines, names that stand twice, and lines in which only one
/// device has values.
#[test]
fn racechrono_is_read_with_its_gaps() {
    let text = || {
        let mut text = "This file is created using RaceChrono v9.1.3 ( http://racechrono.com/ ).\nFormat,3\n\
             Session title,\"Nowhere\"\nCreated,01/05/2026,12:00\n\n\
             timestamp,fragment_id,elapsed_time,speed,device_update_rate,speed,x_acc,y_acc,z_acc,device_update_rate,\
             x_rate_of_rotation,y_rate_of_rotation,z_rate_of_rotation\n\
             unix time,,s,m/s,Hz,m/s,G,G,G,Hz,deg/s,deg/s,deg/s\n\
             ,,,100: gps,100: gps,calc,101: acc,101: acc,101: acc,102: gyro,102: gyro,102: gyro,102: gyro\n"
            .to_owned();
        for (k, t) in times(75.0, 0.0, 20.0).into_iter().enumerate() {
            let sensed = sensed(&mounting([0.0, 0.0, 0.0]), t, GRAVITY, 1f64.to_radians());
            let [fx, fy, fz, wx, wy, wz] = sensed;
            let epoch = 1_777_636_800.0 + t;
            let fields = match k % 3 {
                0 => format!("{},25,{},,,,,,,", speed(t), speed(t)),
                1 => format!(",,,{fx},{fy},{fz},,,,"),
                _ => format!(",,,,,,25,{wx},{wy},{wz}"),
            };
            writeln!(text, "{epoch:.3},0,{t:.6},{fields}").unwrap();
        }
        text
    };
    let recording = read_text(&text(), &with_format(Format::RaceChrono)).unwrap();
    assert!((recording.step() - 0.02).abs() < 1e-9, "{}", recording.step());
    assert_is_the_car(&recording, recording.start - 1_777_636_800.0, 0.03);
    assert!(
        words::warnings(&recording).iter().any(|warning| warning.contains("the change of speed")),
        "{:?}",
        words::warnings(&recording)
    );
    // Without the format, it is recognised; without interpolation, the first gap is named.
    let message = read_text(&text(), &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("use --format racechrono"), "{message}");
    let strict = ConventionOptions { empty_fields: Some(EmptyFields::Error), ..with_format(Format::RaceChrono) };
    let message = read_text(&text(), &strict).unwrap_err();
    assert!(message.starts_with("drive.csv, line 9, column x_acc: is empty"), "{message}");
    assert!(message.contains("--empty-fields interpolate"), "{message}");
}

#[test]
fn times_of_day_and_dates_are_read() {
    let rows = |write: &dyn Fn(f64) -> String| {
        let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
        for t in times(50.0, 0.0, 20.0) {
            let sensed = sensed(&Matrix3::identity(), t, 1.0, 1.0).map(|value| value.to_string());
            writeln!(text, "{},{}", write(t), sensed.join(",")).unwrap();
        }
        text
    };
    let clock = |t: f64| format!("{:02}:{:02}:{:06.3}", (t / 3600.0) as u32 % 24, (t / 60.0) as u32 % 60, t % 60.0);
    // Past midnight.
    let recording = read_text(&rows(&|t| clock(86_395.0 + t)), &ConventionOptions::default()).unwrap();
    assert_is_the_car(&recording, 0.0, 1e-9);
    assert!((recording.step() - 0.02).abs() < 1e-12, "{}", recording.step());
    let recording = read_text(&rows(&|t| format!("2026-05-01T{}Z", clock(3600.0 + t))), &ConventionOptions::default());
    assert_is_the_car(&recording.unwrap(), 0.0, 1e-9);
    let with_unit = rows(&|t| clock(t)).replacen("time", "time [hh:mm:ss]", 1);
    assert_is_the_car(&read_text(&with_unit, &ConventionOptions::default()).unwrap(), 0.0, 1e-9);
    let wrong = rows(&|t| clock(t)).replacen("00:00:01.000", "one", 1);
    let message = read_text(&wrong, &ConventionOptions::default()).unwrap_err();
    assert!(message.starts_with("drive.csv, line 52, column time: is \"one\", which is no time"), "{message}");
}

#[test]
fn columns_are_turned_round_exchanged_and_added() {
    let columns = |pairs: &[(Quantity, &str)]| ConventionOptions {
        columns: pairs.iter().map(|(quantity, name)| (*quantity, (*name).to_owned())).collect(),
        ..ConventionOptions::default()
    };
    // x back, y right, z up.
    let text = sheet("time,ax,ay,az,wx,wy,wz", &times(50.0, 0.0, 20.0), |t| {
        let [fx, fy, fz, wx, wy, wz] = sensed(&Matrix3::identity(), t, 1.0, 1.0);
        vec![t, -fx, -fy, fz, -wx, -wy, wz]
    });
    let signs = [
        (Quantity::Force(0), "-ax"),
        (Quantity::Force(1), "-ay"),
        (Quantity::Rate(0), "-wx"),
        (Quantity::Rate(1), "-wy"),
    ];
    assert_is_the_car(&read_text(&text, &columns(&signs)).unwrap(), 0.0, 1e-12);
    // x left, y back.
    let text = sheet("time,acc_x,acc_y,acc_z,wx,wy,wz", &times(50.0, 0.0, 20.0), |t| {
        let [fx, fy, fz, wx, wy, wz] = sensed(&Matrix3::identity(), t, 1.0, 1.0);
        vec![t, fy, -fx, fz, wy, -wx, wz]
    });
    let exchanged = [
        (Quantity::Force(0), "-acc_y"),
        (Quantity::Force(1), "acc_x"),
        (Quantity::Force(2), "acc_z"),
        (Quantity::Rate(0), "-wy"),
        (Quantity::Rate(1), "wx"),
    ];
    assert_is_the_car(&read_text(&text, &columns(&exchanged)).unwrap(), 0.0, 1e-12);
    // Gravity apart, in units that differ.
    let text = |unit: &str| {
        let header = format!("time,lx [g],ly [g],lz [g],gx [{unit}],gy [{unit}],gz [{unit}],wx,wy,wz");
        sheet(&header, &times(50.0, 0.0, 20.0), |t| {
            let [fx, fy, fz, wx, wy, wz] = sensed(&Matrix3::identity(), t, 1.0, 1.0);
            vec![t, fx / GRAVITY, fy / GRAVITY, fz / GRAVITY - 1.0, 0.0, 0.0, 1.0, wx, wy, wz]
        })
    };
    let sums = [(Quantity::Force(0), "lx + gx"), (Quantity::Force(1), "ly + gy"), (Quantity::Force(2), "lz + gz")];
    assert_is_the_car(&read_text(&text("g"), &columns(&sums)).unwrap(), 0.0, 1e-9);
    let message = read_text(&text("m/s2"), &columns(&sums)).unwrap_err();
    assert!(message.contains("columns lx [g] and gx [m/s2] are added, but are in g and m/s2"), "{message}");
    let message = read_text(&text("g"), &columns(&[(Quantity::Force(0), "lx + hx")])).unwrap_err();
    assert!(message.contains("there are no columns lx + hx"), "{message}");
}

/// Results of vehicle simulations: accelerations of motion, without gravity, and angles.
#[test]
fn results_of_simulations_are_read() {
    let roll = |t: f64| 0.03 * (TAU * 0.1 * t).sin();
    let roll_rate = |t: f64| 0.03 * TAU * 0.1 * (TAU * 0.1 * t).cos();
    let acceleration = |t: f64| [car(t).0.x, car(t).0.y, car(t).0.z - GRAVITY];
    let heading = |t: f64| if t > 8.0 { 0.15 / (TAU * 0.1) * (1.0 - (TAU * 0.1 * (t - 8.0)).cos()) } else { 0.0 };
    let simulation = |t: f64, force_unit: f64, angle_unit: f64, speed_unit: f64| {
        let [ax, ay, az] = acceleration(t).map(|value| value / force_unit);
        let rates = [roll_rate(t), 0.0, car(t).1.z].map(|value| value / angle_unit);
        let angles = [roll(t), 0.0, heading(t)].map(|value| value / angle_unit);
        [&[t, ax, ay, az][..], &rates, &angles, &[speed(t) / speed_unit]].concat()
    };
    let degree = 1f64.to_radians();
    let columns = "Time,Ax,Ay,Az,AVx,AVy,AVz,Roll,Pitch,Yaw,Vx";
    let car_sim = sheet(columns, &times(40.0, 0.0, 20.0), |t| simulation(t, GRAVITY, degree, 1.0 / 3.6));
    let columns = "Time [s],Car.ax [m/s^2],Car.ay [m/s^2],Car.az [m/s^2],Car.RollVel [rad/s],Car.PitchVel [rad/s],\
                   Car.YawRate [rad/s],Car.Roll [rad],Car.Pitch [rad],Car.Yaw [rad],Car.v [m/s]";
    let car_maker = sheet(columns, &times(100.0, 0.0, 20.0), |t| simulation(t, 1.0, 1.0, 1.0));
    for (format, text) in [(Format::CarSim, car_sim), (Format::CarMaker, car_maker)] {
        let recording = read_text(&text, &with_format(format)).unwrap();
        for (time, input) in recording.times().zip(recording.inputs()) {
            let body = Orientation::new(RollPitchYaw::new(roll(time), 0.0, 0.0)).rotation.transpose();
            let force = Vector3::from(acceleration(time)) + body * Vector3::new(0.0, 0.0, GRAVITY);
            assert!((input.specific_force - force).norm() < 1e-9, "{time}: {} is not {force}", input.specific_force);
            assert!((input.angular_velocity.x - roll_rate(time)).abs() < 1e-9, "{time}");
            assert!((input.angular_velocity.z - car(time).1.z).abs() < 1e-9, "{time}");
            assert!((input.orientation.roll - roll(time)).abs() < 1e-9, "{time}");
            assert!((input.speed - speed(time)).abs() < 1e-9, "{time}");
        }
        // The format is found out, and its angles and speed may be missing.
        let message = read_text(&text, &ConventionOptions::default()).unwrap_err();
        assert!(message.contains(&format!("--format {}", format.word())), "{message}");
        let without_angles: String =
            text.lines().map(|line| line.split(',').take(7).collect::<Vec<_>>().join(",") + "\n").collect();
        let level = read_text(&without_angles, &with_format(format)).unwrap();
        assert_is_the_car_in(&level, 0.02);
    }
}

/// Checks the specific force alone.
fn assert_is_the_car_in(recording: &Recording, tolerance: f64) {
    for (time, input) in recording.times().zip(recording.inputs()) {
        assert!((input.specific_force - car(time).0).norm() < tolerance, "{time}: {}", input.specific_force);
    }
}

/// A name that a user gives beside a format is a name that must exist.
#[test]
fn a_name_beside_a_format_must_exist() {
    let text =
        sheet("SessionTime,LongAccel,LatAccel,VertAccel,RollRate,PitchRate,YawRate", &times(60.0, 0.0, 20.0), |t| {
            [vec![t], sensed(&Matrix3::identity(), t, 1.0, 1.0).to_vec()].concat()
        });
    for (quantity, name) in [(Quantity::Speed, "Sped"), (Quantity::Angle(0), "Rol")] {
        let options = ConventionOptions { columns: vec![(quantity, name.to_owned())], ..with_format(Format::IRacing) };
        let message = read_text(&text, &options).unwrap_err();
        assert!(message.contains(&format!("there is no column {name}")), "{message}");
    }
}

#[test]
fn a_turned_sensor_is_turned_back() {
    let text = |degrees: [f64; 3]| {
        let mounting = mounting(degrees);
        sheet("time,ax,ay,az,wx,wy,wz", &times(50.0, 0.0, 20.0), |t| {
            [vec![t], sensed(&mounting, t, 1.0, 1.0).to_vec()].concat()
        })
    };
    let with = |mounting| ConventionOptions { mounting: Some(mounting), ..ConventionOptions::default() };
    for degrees in [[0.0, 0.0, 90.0], [0.0, 25.0, 0.0], [90.0, 0.0, -90.0], [-170.0, 40.0, 130.0], [3.0, -2.0, 180.0]] {
        let angles = RollPitchYaw::from_vector(Vector3::from(degrees).map(f64::to_radians));
        let given = read_text(&text(degrees), &with(Mounting::Angles(angles))).unwrap();
        assert_is_the_car(&given, 0.0, 1e-9);
        let found = read_text(&text(degrees), &with(Mounting::Auto)).unwrap();
        assert_is_the_car(&found, 0.0, 1e-6);
        // What it says gives the same.
        let warnings = words::warnings(&found);
        let warning = warnings.iter().find_map(|warning| warning.split_once("--mounting=")).unwrap().1;
        let given = Mounting::parse(warning.split_whitespace().next().unwrap()).unwrap();
        assert_is_the_car(&read_text(&text(degrees), &with(given)).unwrap(), 0.0, 0.03);
    }
    // A sensor on its side, without an option: what to do is said.
    let message = read_text(&text([90.0, 0.0, 0.0]), &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("use --mounting auto"), "{message}");
    // A ride without an acceleration straight ahead shows no forward.
    let standing =
        sheet("time,ax,ay,az,wx,wy,wz", &times(50.0, 0.0, 20.0), |t| vec![t, 0.0, 0.0, GRAVITY, 0.0, 0.0, 0.0]);
    let message = read_text(&standing, &with(Mounting::Auto)).unwrap_err();
    assert!(message.contains("finds no acceleration straight ahead"), "{message}");
    let floating = sheet("time,ax,ay,az,wx,wy,wz", &times(50.0, 0.0, 20.0), |t| vec![t, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let message = read_text(&floating, &with(Mounting::Auto)).unwrap_err();
    assert!(message.contains("finds no gravity"), "{message}");
}

/// The orientation is the sensor's, too: with the mounting it is the vehicle's.
#[test]
fn orientation_is_turned_with_the_sensor() {
    let degrees = [20.0, -10.0, 90.0];
    let mounting = mounting(degrees);
    let vehicle = RollPitchYaw::new(0.1, -0.05, 0.4);
    let world = Orientation::new(vehicle).rotation;
    let sensor = world * mounting;
    let pitch = -sensor[(2, 0)].asin();
    let (roll, yaw) = (sensor[(2, 1)].atan2(sensor[(2, 2)]), sensor[(1, 0)].atan2(sensor[(0, 0)]));
    let force = sensor.transpose() * Vector3::new(0.0, 0.0, GRAVITY);
    let text = sheet("time,ax,ay,az,wx,wy,wz,roll,pitch,yaw", &times(50.0, 0.0, 1.0), |t| {
        vec![t, force.x, force.y, force.z, 0.0, 0.0, 0.0, roll, pitch, yaw]
    });
    let angles = RollPitchYaw::from_vector(Vector3::from(degrees).map(f64::to_radians));
    let options = ConventionOptions { mounting: Some(Mounting::Angles(angles)), ..ConventionOptions::default() };
    let recording = read_text(&text, &options).unwrap();
    let found = recording.inputs()[0].orientation;
    assert!((found.to_vector() - vehicle.to_vector()).norm() < 1e-9, "{found:?}");
}

#[test]
fn files_that_do_not_belong_together_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    let force = |from: f64| sheet("time,ax,ay,az", &times(50.0, from, from + 20.0), |t| vec![t, 0.0, 0.0, GRAVITY]);
    let rate = sheet("time,wx,wy,wz", &times(50.0, 0.0, 20.0), |t| vec![t, 0.0, 0.0, 0.0]);
    fs::write(path("force.csv"), force(0.0)).unwrap();
    fs::write(path("late.csv"), force(100.0)).unwrap();
    fs::write(path("rate.csv"), &rate).unwrap();
    fs::write(path("other.csv"), "time,rpm\n0,1\n1,2\n").unwrap();
    fs::write(path("back.csv"), rate.replacen("\n0.02,", "\n-0.02,", 1)).unwrap();
    let joined = |names: [&str; 2]| {
        let files = names.map(|name| path(name).display().to_string()).join("+");
        read(Path::new(&files), &ConventionOptions::default())
    };
    assert_eq!(joined(["force.csv", "rate.csv"]).unwrap().inputs().len(), 1001);
    let message = joined(["late.csv", "rate.csv"]).unwrap_err();
    assert!(message.contains("have no time in common") && message.contains("late.csv from 100.00 s"), "{message}");
    let files = ["force.csv", "rate.csv", "other.csv"].map(|name| path(name).display().to_string()).join("+");
    let message = read(Path::new(&files), &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("other.csv: holds no column of the recording"), "{message}");
    let message = joined(["force.csv", "back.csv"]).unwrap_err();
    assert!(message.contains("back.csv, line 3: time goes back"), "{message}");
    let message = joined(["force.csv", "none.csv"]).unwrap_err();
    assert!(message.contains("cannot read") && message.contains("none.csv"), "{message}");
    let files = ["force.csv", "late.csv", "rate.csv"].map(|name| path(name).display().to_string()).join("+");
    let message = read(Path::new(&files), &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("two columns are called ax: force.ax and late.ax; give the file's name"), "{message}");
    let empty = directory.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let message = read(&empty, &ConventionOptions::default()).unwrap_err();
    assert!(message.contains("is a directory without CSV files"), "{message}");
}
