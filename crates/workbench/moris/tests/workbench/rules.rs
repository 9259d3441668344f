//! What is said of a ride whose channels are changed, a row each, and that the remedy is one.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use moris::recording::{ConventionOptions, Recording};
use moris::words;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::{Matrix3, UnitQuaternion, Vector3};

const GRAVITY: f64 = 9.80665;
const SIX: &str = "time,ax,ay,az,wx,wy,wz";
const SPEED: &str = "time,ax,ay,az,wx,wy,wz,speed";
const ANGLES: &str = "time,ax,ay,az,wx,wy,wz,speed,roll,pitch,yaw";
const QUATERNION: &str = "time,ax,ay,az,wx,wy,wz,speed,qw,qx,qy,qz";

/// A sample of a ride.
#[derive(Clone, Copy)]
struct Sample {
    time: f64,
    force: Vector3<f64>,
    rate: Vector3<f64>,
    speed: f64,
    angle: Vector3<f64>,
    quaternion: [f64; 4],
}

impl Sample {
    /// A vehicle that speeds up and slows down in bends over hills, at a sample of 50 a second. Its
    /// channels follow from speed and angles: the velocity is along x, and turns with it.
    fn of_hills(k: usize) -> Self {
        let time = 0.02 * k as f64;
        let (w, phase) = ([0.21, 0.13, 0.08].map(|hertz| TAU * hertz), TAU / 15.0 * time);
        let (speed, change) = (9.0 - 5.0 * phase.cos(), 5.0 * TAU / 15.0 * phase.sin());
        let (roll, roll_rate) = (0.05 * (w[0] * time).sin(), 0.05 * w[0] * (w[0] * time).cos());
        let (pitch, pitch_rate) = (-0.07 * (w[1] * time).sin(), -0.07 * w[1] * (w[1] * time).cos());
        let (yaw, yaw_rate) = (1.2 - 0.6 * (w[2] * time).cos(), 0.6 * w[2] * (w[2] * time).sin());
        let rate = Vector3::new(
            roll_rate - yaw_rate * pitch.sin(),
            pitch_rate * roll.cos() + yaw_rate * roll.sin() * pitch.cos(),
            -pitch_rate * roll.sin() + yaw_rate * roll.cos() * pitch.cos(),
        );
        let up = Vector3::new(-pitch.sin(), pitch.cos() * roll.sin(), pitch.cos() * roll.cos());
        let force = Vector3::new(change, speed * rate.z, -speed * rate.y) + GRAVITY * up;
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let quaternion = [turn.w, turn.i, turn.j, turn.k];
        Sample { time, force, rate, speed, angle: Vector3::new(roll, pitch, yaw), quaternion }
    }

    fn rotation(&self) -> Matrix3<f64> {
        Orientation::new(RollPitchYaw::from_vector(self.angle)).rotation
    }

    /// The value of a column, whose title may have a unit.
    fn value(&self, title: &str) -> f64 {
        let names =
            ["time", "ax", "ay", "az", "wx", "wy", "wz", "speed", "roll", "pitch", "yaw", "qw", "qx", "qy", "qz"];
        let values = [
            &[self.time],
            self.force.as_slice(),
            self.rate.as_slice(),
            &[self.speed],
            self.angle.as_slice(),
            &self.quaternion,
        ];
        let name = title.split(' ').next().unwrap();
        values.concat()[names.iter().position(|other| *other == name).unwrap()]
    }
}

/// The ride with each sample changed, by its number and the ride, read with options in TOML.
fn read(header: &str, options: &str, change: fn(usize, &[Sample]) -> Sample) -> Result<Recording, String> {
    let ride: Vec<Sample> = (0..1501).map(Sample::of_hills).collect();
    let mut text = format!("{header}\n");
    for k in 0..ride.len() {
        let sample = change(k, &ride);
        let fields: Vec<String> = header.split(',').map(|title| format!("{:.7}", sample.value(title))).collect();
        writeln!(text, "{}", fields.join(",")).unwrap();
    }
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("ride.csv");
    fs::write(&file, text).unwrap();
    let options: ConventionOptions = toml::from_str(options).unwrap();
    Recording::read(&file, &options.load().unwrap()).map_err(|error| words::error(&error))
}

/// A ride that is changed.
struct Row {
    header: &'static str,
    /// Options in TOML.
    options: &'static str,
    change: fn(usize, &[Sample]) -> Sample,
    /// Part of what is said; nothing is where it is empty.
    said: &'static str,
    /// The remedy in TOML, with which nothing more is said; none where it is empty.
    remedy: &'static str,
}

macro_rules! rows {
    ($( $header:expr, $options:literal, $change:expr => $said:literal, $remedy:literal; )+) => {
        &[$( Row { header: $header, options: $options, change: $change, said: $said, remedy: $remedy }, )+]
    };
}

/// A number that looks like noise.
fn noise(k: usize) -> f64 {
    (12.9898 * k as f64).sin() * 43_758.545_3 % 1.0
}

/// The rotation `other` in place of the one that a row changes.
fn with_quaternion(sample: Sample, other: fn([f64; 4]) -> [f64; 4]) -> Sample {
    Sample { quaternion: other(sample.quaternion), ..sample }
}

const ROWS: &[Row] = rows! {
    ANGLES, "", |k, ride| ride[k] => "", "";
    SPEED, "", |k, ride| ride[k] => "", "";
    SIX, "", |k, ride| ride[k] => "", "";
    QUATERNION, "", |k, ride| ride[k] => "", "";
    // Rates of two axes that are exchanged: by the angles, or by bends.
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(0, 1); s }
        => "Roll goes with the angular velocity wy, and pitch with wx", "columns = { wx = 'wy', wy = 'wx' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(0, 2); s }
        => "Roll goes with the angular velocity wz, and yaw with wx", "columns = { wx = 'wz', wz = 'wx' }";
    ANGLES, "", |k, ride| { let s = ride[k]; Sample { rate: Vector3::new(-s.rate.z, s.rate.y, s.rate.x), ..s } }
        => "use --columns wx=wz,wz=-wx.", "columns = { wx = 'wz', wz = '-wx' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(1, 2); s }
        => "Pitch goes with the angular velocity wz, and yaw with wy", "columns = { wy = 'wz', wz = 'wy' }";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(0, 2); s }
        => "is speed by the angular velocity wx, and not by wz", "columns = { wx = 'wz', wz = 'wx' }";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(1, 2); s }
        => "is speed by the angular velocity wy, and not by wz", "columns = { wy = 'wz', wz = 'wy' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.force.swap_rows(0, 1); s }
        => "use --columns ax=ay,ay=ax", "columns = { ax = 'ay', ay = 'ax' }";
    // Channels that do not show what others do.
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.y -= s.speed * s.rate.z; s }
        => "Column ay does not go with speed by yaw rate", "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.x = 0.003 * noise(k); s }
        => "Column ax hardly changes while the speed changes", "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.rate.z = 0.001 * noise(k); s }
        => "Column wz hardly changes while the lateral force is that of bends", "";
    SPEED, "", |k, ride| Sample { speed: 9.0, ..ride[k] }
        => "Column speed is constant, 9, while the force along x changes it", "";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.force.y = -s.force.x; s } => "Columns ax and ay hold the same values", "";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.x = s.rate.z; s } => "Columns wx and wz hold the same values", "";
    // A sensor that stops, and a logger that does.
    SPEED, "", |k, ride| { let held = ride[k.min(900)]; Sample { force: held.force, rate: held.rate, ..ride[k] } }
        => "Column ax stays at one value from 18.0 s to 30.0 s, while the speed changes", "";
    ANGLES, "", |k, ride| Sample { time: ride[k].time, ..ride[if (500..650).contains(&k) { 500 } else { k }] }
        => "All channels stay at one value from 10.0 s to 13.0 s and then jump: the logger repeated its last line", "";
    // Its last value may look like a wrong axis.
    SPEED, "", |k, ride| { let held = ride[k.min(200)]; Sample { force: held.force, rate: held.rate, ..ride[k] } }
        => "from 4.0 s to 30.0 s, while the speed changes otherwise: the sensor has stopped. Cut this part off", "";
    // The cause of a refusal is not hidden behind a sensor that has stopped.
    ANGLES, "", |k, ride| Sample { force: ride[k.min(900)].force, angle: 60.0 * ride[k].angle, ..ride[k] }
        => "these are degrees, not radians", "";
    SPEED, "", |k, ride| { let held = ride[k / 10 * 10]; Sample { force: held.force, rate: held.rate, ..ride[k] } }
        => "Each value of ax, ay, az, wx, wy, wz comes 10 times: measured at about 5.0 Hz, it changes in steps, which are felt \
            as jolts. --resample 5.0 takes each value once.", "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.y = (s.force.y / 0.5).round() * 0.5; s }
        => "The values of ay are 0.5 m/s2 apart or more", "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.y = (s.force.y / 0.1).round() * 0.1; s } => "", "";
    // Accelerometer and gyroscope exchanged; what the first advice would lead to is refused as well.
    SIX, "", |k, ride| Sample { force: ride[k].rate, rate: ride[k].force, ..ride[k] }
        => "accelerometer and gyroscope seem to be exchanged",
        "columns = { ax = 'wx', ay = 'wy', az = 'wz', wx = 'ax', wy = 'ay', wz = 'az' }";
    SIX, "gravity = 'removed'\nrate-unit = 'deg/s'", |k, ride| Sample { force: ride[k].rate, rate: ride[k].force, ..ride[k] }
        => "accelerometer and gyroscope seem to be exchanged", "";
    // Signs, frames and gravity.
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.y = -s.angle.y; s.rate.y = -s.rate.y; s }
        => "the pitch has the wrong sign", "columns = { pitch = '-pitch', wy = '-wy' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.y = -s.angle.y; s }
        => "Use --columns pitch=-pitch.", "columns = { pitch = '-pitch' }";
    ANGLES, "", |k, ride| Sample { force: ride[k].rotation() * ride[k].force, ..ride[k] }
        => "Use --force-frame world.", "force-frame = 'world'";
    ANGLES, "gravity = 'removed'",
        |k, ride| Sample { force: ride[k].rotation() * ride[k].force - GRAVITY * Vector3::z(), ..ride[k] }
        => "Use --force-frame world.", "force-frame = 'world'";
    ANGLES, "", |k, ride| Sample { rate: ride[k].rotation() * ride[k].rate, ..ride[k] }
        => "Use --rate-frame world.", "rate-frame = 'world'";
    SIX, "force-frame = 'world'", |k, ride| ride[k] => "--force-frame world needs roll, pitch and yaw", "";
    // Quaternions of other conventions.
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [w, -x, -y, -z])
        => "but of its inverse", "columns = { qx = '-qx', qy = '-qy', qz = '-qz' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [x, y, z, w])
        => "scalar part comes last", "columns = { qw = 'qz', qx = 'qw', qy = 'qx', qz = 'qy' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [w, x, -y, -z])
        => "axes that point to the right and down", "columns = { qy = '-qy', qz = '-qz' }";
    // Half a turn about x from it.
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [-x, w, -z, y])
        => "turns the vehicle upside down", "columns = { qw = '-qx', qx = 'qw', qy = '-qz', qz = 'qy' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |parts| parts.map(|part| (32_767.0 * part).round()))
        => "\"qw=qw / 32767,", "columns = { qw = 'qw / 32767', qx = 'qx / 32767', qy = 'qy / 32767', qz = 'qz / 32767' }";
    // A column that is left out.
    ANGLES, "columns = { roll = '', pitch = '', yaw = '' }", |k, ride| Sample { angle: 60.0 * ride[k].angle, ..ride[k] }
        => "", "";
    // Units.
    "time,ax [m/s2],ay [m/s2],az [m/s2],wx,wy,wz", "", |k, ride| Sample { force: ride[k].force / GRAVITY, ..ride[k] }
        => "or use --columns \"ax=ax * 9.80665,ay=ay * 9.80665,az=az * 9.80665\"",
        "columns = { ax = 'ax * 9.80665', ay = 'ay * 9.80665', az = 'az * 9.80665' }";
    "time,ax,ay,az,wx [deg/s],wy [deg/s],wz [deg/s],speed", "", |k, ride| ride[k]
        => "seem to be in rad/s, not in deg/s: correct the header", "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.x /= GRAVITY; s.force.y /= GRAVITY; s }
        => "--columns \"ax=ax * 9.80665,ay=ay * 9.80665\"", "columns = { ax = 'ax * 9.80665', ay = 'ay * 9.80665' }";
    SPEED, "", |k, ride| Sample { speed: 100.0 * ride[k].speed, ..ride[k] }
        => "--columns \"speed=speed * 0.01\"", "columns = { speed = 'speed * 0.01' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.x += TAU; s }
        => "--angle-unit deg, or whole turns too many; write angles from -pi to pi", "";
};

#[test]
fn each_change_of_a_ride_is_said_and_its_remedy_is_one() {
    let said = |row: &Row, options: &str| match read(row.header, options, row.change) {
        Ok(recording) => words::warnings(&recording).join(" "),
        Err(error) => error,
    };
    for (number, row) in ROWS.iter().enumerate() {
        let found = said(row, row.options);
        assert_eq!(found.is_empty(), row.said.is_empty(), "row {number}: {found}");
        assert!(found.contains(row.said), "row {number}: {found}");
        if !row.remedy.is_empty() {
            let remedied = said(row, &format!("{}\n{}", row.options, row.remedy));
            assert_eq!(remedied, "", "row {number}, remedied");
        }
    }
}

#[test]
fn gravity_that_only_the_vertical_force_lacks_is_put_back_along_z_alone() {
    let lacking = |k: usize, ride: &[Sample]| Sample { force: ride[k].force - GRAVITY * Vector3::z(), ..ride[k] };
    let recording = read(ANGLES, "gravity = 'removed'", lacking).unwrap();
    let said = words::warnings(&recording).join(" ");
    assert!(said.contains("Gravity has been taken out of az alone"), "{said}");
    for (k, input) in recording.inputs().iter().enumerate() {
        assert!((input.specific_force - Sample::of_hills(k).force).amax() < 1e-6, "{k}: {}", input.specific_force);
    }
}
