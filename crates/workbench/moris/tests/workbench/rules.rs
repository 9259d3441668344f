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
    /// A vehicle that speeds up and slows down in bends over hills of a size, at a sample of 50 a
    /// second. Its channels follow from speed and angles: the velocity is along x.
    fn of_ride(k: usize, hills: f64) -> Self {
        let time = 0.02 * k as f64;
        let (w, phase) = ([0.21, 0.13, 0.08].map(|hertz| TAU * hertz), TAU / 15.0 * time);
        let (speed, change) = (9.0 - 5.0 * phase.cos(), 5.0 * TAU / 15.0 * phase.sin());
        let (roll, roll_rate) = (0.05 * hills * (w[0] * time).sin(), 0.05 * hills * w[0] * (w[0] * time).cos());
        let (pitch, pitch_rate) = (-0.07 * hills * (w[1] * time).sin(), -0.07 * hills * w[1] * (w[1] * time).cos());
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
    let ride: Vec<Sample> = (0..1501).map(|k| Sample::of_ride(k, 1.0)).collect();
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
    /// Parts of what is said, and with ! of what is not; nothing is said where there are none.
    said: &'static [&'static str],
    /// The remedy in TOML, with which nothing more is said; none where it is empty.
    remedy: &'static str,
}

macro_rules! rows {
    ($( $header:expr, $options:literal, $change:expr => $said:tt, $remedy:literal; )+) => {
        &[$( Row { header: $header, options: $options, change: $change, said: &$said, remedy: $remedy }, )+]
    };
}

/// A number that looks like noise.
fn noise(k: usize) -> f64 {
    (12.9898 * k as f64).sin() * 43_758.545_3 % 1.0
}

/// The ride on a level road.
fn flat(k: usize) -> Sample {
    Sample::of_ride(k, 0.0)
}

/// A sample along axes that point to the right, with the sign of the vertical force.
fn right_down(sample: Sample, up: f64) -> Sample {
    let Sample { force, rate, .. } = sample;
    Sample {
        force: Vector3::new(force.x, -force.y, up * force.z),
        rate: Vector3::new(rate.x, -rate.y, -rate.z),
        ..sample
    }
}

/// The ride in axes of which y points to the right, with rotations by the left hand.
fn left_handed(sample: Sample) -> Sample {
    let turned = |v: Vector3<f64>| Vector3::new(-v.x, v.y, -v.z);
    let force = Vector3::new(sample.force.x, -sample.force.y, sample.force.z);
    Sample { force, rate: turned(sample.rate), angle: turned(sample.angle), ..sample }
}

/// What a sensor reads that is turned and has no gyroscope.
fn other_sensor(sample: Sample) -> Sample {
    Sample { force: Vector3::new(sample.force.y, sample.force.x, GRAVITY), rate: Vector3::zeros(), ..sample }
}

/// A steady circle, whose heading is in a unit.
fn circle(k: usize, unit: f64) -> Sample {
    let angle = Vector3::new(0.0, 0.0, (0.01 * k as f64 / unit) % (TAU / unit));
    Sample { force: Vector3::new(0.0, 5.0, GRAVITY), rate: 0.5 * Vector3::z(), speed: 10.0, angle, ..flat(k) }
}

/// The ride on a level road without gravity, with forces in a unit.
fn in_unit(k: usize, unit: f64) -> Sample {
    Sample { force: (flat(k).force - GRAVITY * Vector3::z()) / unit, ..flat(k) }
}

/// A vehicle with small forces along x, which lasts, and y, in bends at 14 m/s, without gravity.
fn quiet(k: usize, [surge, sway]: [f64; 2]) -> Sample {
    let sway = sway * (0.3 * flat(k).time).sin();
    Sample { force: Vector3::new(surge, sway, 0.0), rate: sway / 14.0 * Vector3::z(), ..flat(k) }
}

/// A vehicle on the level road that rolls by an angle of its yaw rate and speed.
fn rolling(k: usize, roll: impl Fn(&Sample) -> f64) -> Sample {
    let [sample, next] = [flat(k), flat(k + 1)];
    let (angle, turn) = (roll(&sample), sample.rate.z);
    let rate = Vector3::new((roll(&next) - angle) / 0.02, turn * angle.sin(), turn * angle.cos());
    let lateral = sample.speed * turn;
    let along_y = lateral * angle.cos() + GRAVITY * angle.sin();
    let along_z = GRAVITY * angle.cos() - lateral * angle.sin();
    let angle = Vector3::new(angle, 0.0, sample.angle.z);
    Sample { force: Vector3::new(sample.force.x, along_y, along_z), rate, angle, ..sample }
}

/// A motorcycle in balanced bends, whose roll and its rate are given with a sign (-1 is right),
/// with so much gravity taken out of its forces.
fn leaning(k: usize, sign: f64, removed: f64) -> Sample {
    let mut sample = rolling(k, |sample| -(sample.speed * sample.rate.z / GRAVITY).atan());
    let roll = sample.angle.x;
    sample.force -= removed * Vector3::new(0.0, roll.sin(), roll.cos());
    sample.angle.x *= -sign;
    sample.rate.x *= -sign;
    sample
}

/// A car that rolls to the outside of bends by 5 degrees a g, whose speed is so many times as
/// large.
fn car(k: usize, times: f64) -> Sample {
    let mut sample = rolling(k, |sample| 0.087 * sample.speed * sample.rate.z / GRAVITY);
    sample.speed *= times;
    sample
}

/// The rotation `other` in place of the one that a row changes.
fn with_quaternion(sample: Sample, other: fn([f64; 4]) -> [f64; 4]) -> Sample {
    Sample { quaternion: other(sample.quaternion), ..sample }
}

const ROWS: &[Row] = rows! {
    ANGLES, "", |k, ride| ride[k] => [], "";
    SPEED, "", |k, ride| ride[k] => [], "";
    SIX, "", |k, ride| ride[k] => [], "";
    QUATERNION, "", |k, ride| ride[k] => [], "";
    // Rates of two axes that are exchanged: by the angles, or by bends.
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(0, 1); s }
        => ["Roll follows the angular velocity wy, and pitch follows wx"], "columns = { wx = 'wy', wy = 'wx' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(0, 2); s }
        => ["Roll follows the angular velocity wz, and yaw follows wx"], "columns = { wx = 'wz', wz = 'wx' }";
    ANGLES, "", |k, ride| { let s = ride[k]; Sample { rate: Vector3::new(-s.rate.z, s.rate.y, s.rate.x), ..s } }
        => ["use --columns wx=wz,wz=-wx."], "columns = { wx = 'wz', wz = '-wx' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(1, 2); s }
        => ["Pitch follows the angular velocity wz, and yaw follows wy"], "columns = { wy = 'wz', wz = 'wy' }";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(0, 2); s }
        => ["is speed times the angular velocity wx, not times wz"], "columns = { wx = 'wz', wz = 'wx' }";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.rate.swap_rows(1, 2); s }
        => ["is speed times the angular velocity wy, not times wz"], "columns = { wy = 'wz', wz = 'wy' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.force.swap_rows(0, 1); s }
        => ["use --columns ax=ay,ay=ax"], "columns = { ax = 'ay', ay = 'ax' }";
    // The same without a speed.
    SIX, "", |k, _| { let mut s = flat(k); s.rate.swap_rows(0, 2); s }
        => ["is speed times the angular velocity wx, not times wz"], "columns = { wx = 'wz', wz = 'wx' }";
    SIX, "", |k, _| { let mut s = flat(k); s.force.swap_rows(0, 1); s }
        => ["The yaw rate follows the force along x, not that along y"], "columns = { ax = 'ay', ay = 'ax' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.swap_rows(0, 1); s.rate.swap_rows(0, 1); s }
        => ["The speed changes as if roll were the pitch", "use --columns roll=pitch,pitch=roll"],
        "columns = { roll = 'pitch', pitch = 'roll', wx = 'wy', wy = 'wx' }";
    // Channels that do not show what others do.
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.y -= s.speed * s.rate.z; s }
        => ["Column ay does not follow speed times yaw rate"], "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.x = 0.003 * noise(k); s }
        => ["Column ax is nearly constant while the speed changes"], "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.rate.z = 0.001 * noise(k); s }
        => ["Column wz is nearly constant while the lateral force is that of bends"], "";
    SPEED, "", |k, ride| Sample { speed: 9.0, ..ride[k] }
        => ["Column speed is constant, 9, while the force along x changes it"], "";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.force.y = -s.force.x; s }
        => ["Columns ax and ay hold the same values"], "";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.rate.x = s.rate.z; s }
        => ["Columns wx and wz hold the same values"], "";
    // A sensor that stops, and a logger that does.
    SPEED, "", |k, ride| { let held = ride[k.min(900)]; Sample { force: held.force, rate: held.rate, ..ride[k] } }
        => ["Column ax stays at one value from 18.0 s to 30.0 s, while the speed changes"], "";
    ANGLES, "", |k, ride| Sample { time: ride[k].time, ..ride[if (500..650).contains(&k) { 500 } else { k }] }
        => ["All channels stay at one value from 10.0 s to 13.0 s and then jump: the logger repeated its last line"],
        "";
    ANGLES, "", |k, ride| Sample { time: ride[k].time, ..ride[if (500..580).contains(&k) { 500 } else { k }] }
        => ["All channels stay at one value from 10.0 s to 11.6 s"], "";
    // One sensor of several, by what it measures.
    SIX, "", |k, ride| Sample { rate: ride[if (500..700).contains(&k) { 500 } else { k }].rate, ..ride[k] }
        => ["Columns wx, wy, wz stay at one value from 10.0 s to 14.0 s and then jump: the sensor has stopped"], "";
    ANGLES, "", |k, ride| Sample { angle: ride[if (600..800).contains(&k) { 600 } else { k }].angle, ..ride[k] }
        => ["Columns roll, pitch, yaw stay at one value from 12.0 s to 16.0 s and then jump", "!wx, wy"], "";
    // A receiver that has no fix yet.
    SPEED, "", |k, ride| Sample { speed: if k < 500 { 0.0 } else { ride[k].speed }, ..ride[k] }
        => ["Column speed stays at one value from 0.0 s to 10.0 s and jumps: it was not measured there", "!times as much"],
        "";
    // A receiver of 1 Hz, and a stop.
    SPEED, "", |k, ride| Sample { speed: ride[k / 50 * 50].speed, ..ride[k] } => ["!stays at one value"], "";
    // A wrong axis of a vehicle that stands is no sensor that has stopped.
    SPEED, "", |k, _| {
        let mut s = flat(k.saturating_sub(200));
        s.speed -= 4.0;
        s.force.y -= 4.0 * s.rate.z;
        s.force.swap_rows(0, 2);
        Sample { time: 0.02 * k as f64, ..s }
    }
        => ["so x is nearest to the vertical", "!stopped"], "";
    // Its last value may look like a wrong axis.
    SPEED, "", |k, ride| { let held = ride[k.min(200)]; Sample { force: held.force, rate: held.rate, ..ride[k] } }
        => ["from 4.0 s to 30.0 s, while the speed changes otherwise: the sensor has stopped. Cut this part off"], "";
    // The cause of a refusal is not hidden behind a sensor that has stopped.
    ANGLES, "", |k, ride| Sample { force: ride[k.min(900)].force, angle: 60.0 * ride[k].angle, ..ride[k] }
        => ["these are degrees, not radians"], "";
    SPEED, "", |k, ride| { let held = ride[k / 10 * 10]; Sample { force: held.force, rate: held.rate, ..ride[k] } }
        => ["Each value of ax, ay, az, wx, wy, wz comes 10 times: measured at about 5.0 Hz, it changes in steps",
            "--resample 5.0 takes each value once."], "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.y = (s.force.y / 0.5).round() * 0.5; s }
        => ["The values of ay are 0.5 m/s2 apart or more"], "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.y = (s.force.y / 0.1).round() * 0.1; s } => [], "";
    // Accelerometer and gyroscope exchanged; what the first advice would lead to is refused as well.
    SIX, "", |k, ride| Sample { force: ride[k].rate, rate: ride[k].force, ..ride[k] }
        => ["accelerometer and gyroscope seem to be exchanged"],
        "columns = { ax = 'wx', ay = 'wy', az = 'wz', wx = 'ax', wy = 'ay', wz = 'az' }";
    SIX, "", |k, ride| Sample { force: ride[k].rate, rate: ride[k].force / GRAVITY, ..ride[k] }
        => ["which is gravity in g", "and --force-unit g"],
        "force-unit = 'g'\ncolumns = { ax = 'wx', ay = 'wy', az = 'wz', wx = 'ax', wy = 'ay', wz = 'az' }";
    SIX, "gravity = 'removed'\nrate-unit = 'deg/s'",
        |k, ride| Sample { force: ride[k].rate, rate: ride[k].force, ..ride[k] }
        => ["accelerometer and gyroscope seem to be exchanged"], "";
    SIX, "gravity = 'removed'", |k, ride| Sample { force: ride[k].rate, rate: 1000.0 / GRAVITY * ride[k].force, ..ride[k] }
        => ["which is gravity in mg", "and --force-unit mg"], "";
    // Signs, frames and gravity.
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.y = -s.angle.y; s.rate.y = -s.rate.y; s }
        => ["the pitch has the wrong sign"], "columns = { pitch = '-pitch', wy = '-wy' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.y = -s.angle.y; s }
        => ["Use --columns pitch=-pitch."], "columns = { pitch = '-pitch' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.x = -s.angle.x; s.rate.x = -s.rate.x; s }
        => ["the roll has the wrong sign", "Use --columns roll=-roll,wx=-wx."],
        "columns = { roll = '-roll', wx = '-wx' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.x = -s.angle.x; s }
        => ["Use --columns roll=-roll."], "columns = { roll = '-roll' }";
    // A motorcycle leans to the inside of bends; a car rolls a little to their outside.
    ANGLES, "", |k, _| leaning(k, -1.0, 0.0) => [], "";
    ANGLES, "", |k, _| leaning(k, 1.0, 0.0)
        => ["the roll has the wrong sign", "Use --columns roll=-roll,wx=-wx."],
        "columns = { roll = '-roll', wx = '-wx' }";
    ANGLES, "gravity = 'removed'", |k, _| leaning(k, -1.0, GRAVITY) => [], "";
    ANGLES, "gravity = 'removed'", |k, _| leaning(k, 1.0, GRAVITY)
        => ["the roll has the wrong sign"], "columns = { roll = '-roll', wx = '-wx' }";
    ANGLES, "", |k, _| car(k, 1.0) => [], "";
    ANGLES, "", |k, _| car(k, 1.2) => [], "";
    ANGLES, "", |k, ride| Sample { force: ride[k].rotation() * ride[k].force, ..ride[k] }
        => ["Use --force-frame world."], "force-frame = 'world'";
    ANGLES, "gravity = 'removed'",
        |k, ride| Sample { force: ride[k].rotation() * ride[k].force - GRAVITY * Vector3::z(), ..ride[k] }
        => ["Use --force-frame world."], "force-frame = 'world'";
    "time,ax,ay,az,wx,wy,wz,roll,pitch,yaw", "", |k, ride| {
        let mut s = ride[k];
        s.angle.z += 0.9;
        Sample { force: s.rotation() * s.force, ..s }
    }
        => ["In bends the yaw rate follows the forces along fixed axes"], "force-frame = 'world'";
    ANGLES, "", |k, ride| Sample { rate: ride[k].rotation() * ride[k].rate, ..ride[k] }
        => ["Use --rate-frame world."], "rate-frame = 'world'";
    SIX, "force-frame = 'world'", |k, ride| ride[k] => ["--force-frame world needs roll, pitch and yaw"], "";
    // Quaternions of other conventions.
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [w, -x, -y, -z])
        => ["but of its inverse"], "columns = { qx = '-qx', qy = '-qy', qz = '-qz' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [x, y, z, w])
        => ["scalar part comes last"], "columns = { qw = 'qz', qx = 'qw', qy = 'qx', qz = 'qy' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [w, x, -y, -z])
        => ["axes that point to the right and down"], "columns = { qy = '-qy', qz = '-qz' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [-x, -y, -z, w])
        => ["but of an inverse whose scalar part comes last"], "columns = { qw = 'qz', qx = '-qw', qy = '-qx', qz = '-qy' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [w, -x, y, z])
        => ["but of an inverse of such axes"], "columns = { qx = '-qx' }";
    // Its heading, read as a roll, turns the vehicle upside down.
    QUATERNION, "", |k, ride| {
        let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 2.1) * UnitQuaternion::from_euler_angles(
            ride[k].angle.x, ride[k].angle.y, ride[k].angle.z);
        Sample { quaternion: [turned.i, turned.j, turned.k, turned.w], ..ride[k] }
    }
        => ["scalar part comes last", "!upside down"], "columns = { qw = 'qz', qx = 'qw', qy = 'qx', qz = 'qy' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |_| [0.0; 4]) => ["which is no rotation"], "columns = { qw = '', qx = '', qy = '', qz = '' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.x -= 0.5 * TAU; s }
        => ["roll and pitch turn the vehicle upside down"], "columns = { roll = '', pitch = '', yaw = '' }";
    // Half a turn about x from it.
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |[w, x, y, z]| [-x, w, -z, y])
        => ["turns the vehicle upside down"], "columns = { qw = '-qx', qx = 'qw', qy = '-qz', qz = 'qy' }";
    QUATERNION, "", |k, ride| with_quaternion(ride[k], |parts| parts.map(|part| (32_767.0 * part).round()))
        => ["\"qw=qw / 32767,"],
        "columns = { qw = 'qw / 32767', qx = 'qx / 32767', qy = 'qy / 32767', qz = 'qz / 32767' }";
    // A column that is left out.
    ANGLES, "columns = { roll = '', pitch = '', yaw = '' }", |k, ride| Sample { angle: 60.0 * ride[k].angle, ..ride[k] }
        => [], "";
    // Units.
    "time,ax [m/s2],ay [m/s2],az [m/s2],wx,wy,wz", "", |k, ride| Sample { force: ride[k].force / GRAVITY, ..ride[k] }
        => ["or use --columns \"ax=ax * 9.80665,ay=ay * 9.80665,az=az * 9.80665\""],
        "columns = { ax = 'ax * 9.80665', ay = 'ay * 9.80665', az = 'az * 9.80665' }";
    "time,ax,ay,az,wx [deg/s],wy [deg/s],wz [deg/s],speed", "", |k, ride| ride[k]
        => ["seem to be in rad/s, not in deg/s: correct the header"], "";
    SPEED, "", |k, ride| { let mut s = ride[k]; s.force.x /= GRAVITY; s.force.y /= GRAVITY; s }
        => ["--columns \"ax=ax * 9.80665,ay=ay * 9.80665\""], "columns = { ax = 'ax * 9.80665', ay = 'ay * 9.80665' }";
    SPEED, "", |k, ride| Sample { speed: 100.0 * ride[k].speed, ..ride[k] }
        => ["--columns \"speed=speed * 0.01\""], "columns = { speed = 'speed * 0.01' }";
    ANGLES, "", |k, ride| { let mut s = ride[k]; s.angle.x += TAU; s }
        => ["--angle-unit deg, or whole turns too many; write angles from -pi to pi"], "";
    // Units of the speed, by the force and in bends.
    "time,ax,ay,az,wx,wy,wz,speed [km/h]", "", |k, _| Sample { speed: 3.6 * flat(k).speed, ..flat(k) } => [], "";
    SPEED, "", |k, _| Sample { speed: 3.6 * flat(k).speed, ..flat(k) }
        => ["3.6 times as much as the integral", "it seems to be in km/h, not in m/s: use --speed-unit km/h."],
        "speed-unit = 'km/h'";
    SPEED, "", |k, _| Sample { speed: flat(k).speed / 0.44704, ..flat(k) }
        => ["2.2 times as much as the integral", "it seems to be in mph, not in m/s: use --speed-unit mph."],
        "speed-unit = 'mph'";
    SPEED, "", |k, _| { let mut s = flat(k); s.force.x = 0.0; s.speed *= 3.6; s }
        => ["its speed is in km/h, not in m/s: use --speed-unit km/h."], "";
    SPEED, "", |k, _| { let mut s = flat(k); s.force.x = 0.0; s.speed /= 0.44704; s }
        => ["its speed is in mph, not in m/s: use --speed-unit mph."], "";
    SPEED, "speed-unit = 'km/h'", |k, ride| ride[k]
        => ["it seems to be in m/s, not in km/h: use --speed-unit m/s."], "";
    "time,ax,ay,az,wx,wy,wz,speed [km/h]", "", |k, _| flat(k) => ["correct the header, which gives km/h"], "";
    SPEED, "", |k, _| Sample { speed: 7.0 * flat(k).speed, ..flat(k) } => ["check --speed-unit."], "";
    // Slopes, scales and two-wheelers are no contradictions.
    SPEED, "", |k, _| { let mut s = flat(k); s.force.x *= 1.3; s } => [], "";
    SPEED, "", |k, _| { let mut s = flat(k); s.force.y *= -0.2; s } => [], "";
    ANGLES, "", |k, _| { let mut s = flat(k); s.force = Vector3::new(s.force.x, 0.0, s.force.y.hypot(GRAVITY)); s }
        => [], "";
    ANGLES, "", |k, _| { let mut s = flat(k); s.force.y = 0.0; s }
        => ["Column ay is constant, 0, while the vehicle drives bends"], "";
    SPEED, "", |k, _| { let mut s = flat(k); s.force.y /= GRAVITY; s }
        => ["while the force along x fits the speed", "use --columns \"ay=ay * 9.80665\""],
        "columns = { ay = 'ay * 9.80665' }";
    "time,ax,ay,az,wx [deg/s],wy [deg/s],wz [deg/s]", "", |k, ride| ride[k]
        => ["the angular velocities seem to be in rad/s: correct the header"], "";
    // Signs.
    ANGLES, "", |k, _| { let mut s = flat(k); s.rate.z = -s.rate.z; s }
        => ["lateral force is -1.0 times speed by yaw rate", "use --columns wz=-wz where", "use --columns ay=-ay where",
            "wz is -1.0 times the derivative of yaw"], "columns = { wz = '-wz' }";
    ANGLES, "columns = { wz = '-wz' }", |k, _| flat(k) => ["use --columns wz=wz where"], "";
    SPEED, "", |k, _| { let mut s = flat(k); s.force.x = -s.force.x; s }
        => ["If the axis does, use --columns ax=-ax."], "columns = { ax = '-ax' }";
    SPEED, "mounting = [0.0, 0.0, 180.0]", |k, _| flat(k) => ["If the axis does, check --mounting."], "";
    // Forces of the opposite sign, as phones write gravity, look like axes that point down.
    SIX, "", |k, ride| Sample { force: -ride[k].force, ..ride[k] }
        => ["use --columns \"ax=-ax,ay=-ay,az=-az\""], "columns = { ax = '-ax', ay = '-ay', az = '-az' }";
    SIX, "", |k, ride| right_down(ride[k], -1.0) => ["use --axes forward-right-down"], "axes = 'forward-right-down'";
    SIX, "", |k, ride| right_down(ride[k], 1.0) => ["!wrong sign"], "";
    ANGLES, "axes = 'forward-right-up'", |k, ride| left_handed(ride[k]) => [], "";
    SIX, "", |k, ride| { let mut s = ride[k]; s.rate.z = -s.rate.z; s }
        => ["backward: one of them has the wrong sign", "wz=-wz"], "columns = { wz = '-wz' }";
    // Delays.
    SPEED, "", |k, _| Sample { speed: flat(k.saturating_sub(25)).speed, ..flat(k) }
        => ["Column speed comes 0.5 s after the force along x"], "";
    SPEED, "", |k, _| Sample { speed: flat(k + 15).speed, ..flat(k) }
        => ["Column speed comes 0.3 s before the force along x"], "";
    SPEED, "", |k, ride| Sample { speed: ride[k.saturating_sub(5)].speed, ..ride[k] } => ["!comes"], "";
    SPEED, "", |k, _| Sample { rate: flat(k.saturating_sub(25)).rate, ..flat(k) }
        => ["Column ay comes 0.5 s before speed times yaw rate"], "";
    ANGLES, "", |k, ride| Sample { angle: ride[k.saturating_sub(25)].angle, ..ride[k] }
        => ["Column yaw comes 0.5 s after the angular velocity"], "";
    ANGLES, "", |k, ride| Sample { angle: Sample::of_ride(k + 15, 1.0).angle, ..ride[k] }
        => ["Column yaw comes 0.3 s before the angular velocity"], "";
    ANGLES, "", |k, ride| Sample { angle: ride[k.saturating_sub(5)].angle, ..ride[k] } => ["!comes"], "";
    // Times.
    SIX, "", |k, ride| Sample { time: (k % 256) as f64, ..ride[k] }
        => ["time begins again every 256 samples", "--rate HERTZ"], "";
    SIX, "", |k, ride| Sample { time: ride[k].time + if k > 700 { 3600.0 } else { 0.0 }, ..ride[k] }
        => ["the clock has jumped", "!--resample"], "";
    SIX, "", |k, ride| Sample { time: (ride[k].time / 3600.0 * 1e5).floor() / 1e5, ..ride[k] }
        => ["give the unit of time with --time-unit", "!--resample"], "";
    SIX, "resample = 50.0", |k, ride| Sample { time: ride[k].time + if k > 700 { 86_400.0 } else { 0.0 }, ..ride[k] }
        => ["nothing was recorded for 86400 s", "the clock has jumped"], "";
    SIX, "", |k, ride| Sample { time: k as f64, ..ride[k] } => ["if it counts samples, use --rate"], "";
    ANGLES, "", |k, _| Sample { time: 0.5 * flat(k).time, ..flat(k) } => ["2.0 times too fast", "!--speed-unit"], "";
    ANGLES, "", |k, _| Sample { time: 3.0 * flat(k).time, ..flat(k) } => ["3.0 times too slow", "!--speed-unit"], "";
    ANGLES, "", |k, ride| {
        let rate = (Sample::of_ride(k + 1, 1.0).angle - ride[k].angle) / 0.02;
        Sample { time: 3.0 * ride[k].time, rate, speed: 0.0, ..ride[k] }
    }
        => ["times the derivatives of the angles: the time seems to run 3.0"], "";
    // A steady circle has a lasting lateral force and nothing else, also with its heading in degrees.
    ANGLES, "", |k, _| circle(k, 1.0) => ["!vertical", "!not measured"], "";
    ANGLES, "", |k, _| circle(k, 1f64.to_radians()) => ["these are degrees, not radians; use --angle-unit deg"], "";
    ANGLES, "angle-unit = 'deg'", |k, _| circle(k, 1f64.to_radians()) => ["!not measured", "!degrees, not"], "";
    SIX, "", |k, ride| if k % 2 == 1 { other_sensor(ride[k]) } else { ride[k] }
        => ["the samples are those of 2 sensors by turns"], "";
    // Nothing is suspected of this size, of a unit that is given, and of what the speed confirms.
    SIX, "gravity = 'removed'", |k, _| in_unit(k, GRAVITY)
        => ["if they are in g, use --force-unit g."], "force-unit = 'g'";
    SIX, "gravity = 'removed'", |k, _| in_unit(k, 1.0) => [], "";
    // Nothing of small forces either, where the bends are those of 14 m/s, and in g they would be those of 140 m/s.
    SIX, "gravity = 'removed'", |k, _| quiet(k, [0.0, 0.5]) => [], "";
    // And half a m/s2 that lasts: in g the vehicle would gain 147 m/s in 30 s.
    SIX, "gravity = 'removed'", |k, _| quiet(k, [0.5, 0.0]) => ["force along x is 0.50 m/s2", "!in g"], "";
    "time,ax [m/s2],ay [m/s2],az [m/s2],wx,wy,wz", "gravity = 'removed'", |k, _| in_unit(k, GRAVITY) => ["!in g"], "";
    SPEED, "gravity = 'removed'", |k, _| in_unit(k, GRAVITY) => ["--force-unit g"], "force-unit = 'g'";
    // Gravity of slopes that conversion has added does not hide the unit.
    ANGLES, "gravity = 'removed'", |k, ride| {
        let up = ride[k].rotation().transpose() * Vector3::z();
        Sample { force: ride[k].force / GRAVITY - up, ..ride[k] }
    }
        => ["the specific force seems to be in g", "--force-unit g"], "force-unit = 'g'";
};

#[test]
fn each_change_of_a_ride_is_said_and_its_remedy_is_one() {
    let said = |row: &Row, options: &str| match read(row.header, options, row.change) {
        Ok(recording) => words::warnings(&recording).join(" "),
        Err(error) => error,
    };
    let mut failures = Vec::new();
    for (number, row) in ROWS.iter().enumerate() {
        let found = said(row, row.options);
        let is_said = |part: &&str| part.strip_prefix('!').map_or(found.contains(*part), |part| !found.contains(part));
        let missed: Vec<&str> = row.said.iter().copied().filter(|part| !is_said(part)).collect();
        if !missed.is_empty() || row.said.is_empty() && !found.is_empty() {
            failures.push(format!("row {number}, {missed:?}: {found}"));
        }
        if !row.remedy.is_empty() {
            let remedied = said(row, &format!("{}\n{}", row.options, row.remedy));
            failures.extend((!remedied.is_empty()).then(|| format!("row {number}, remedied: {remedied}")));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn gravity_that_only_the_vertical_force_lacks_is_put_back_along_z_alone() {
    let lacking = |k: usize, ride: &[Sample]| Sample { force: ride[k].force - GRAVITY * Vector3::z(), ..ride[k] };
    let recording = read(ANGLES, "gravity = 'removed'", lacking).unwrap();
    let said = words::warnings(&recording).join(" ");
    assert!(said.contains("Gravity has been taken out of az alone"), "{said}");
    for (k, input) in recording.inputs().iter().enumerate() {
        assert!((input.specific_force - Sample::of_ride(k, 1.0).force).amax() < 1e-6, "{k}: {}", input.specific_force);
    }
}
