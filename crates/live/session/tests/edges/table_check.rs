//! Units, axes and gravity of right and of wrong tables.

use std::f64::consts::TAU;

use moris_live::signs::{Check, Signs, Verdict};
use moris_live::table_check::TableCheck;
use moris_live::{Event, Motion, Refusal, Sample, Session, Settings, State};
use moris_washout::Parameters;
use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY as G};
use moris_washout::motion::orientation::Orientation;
use nalgebra::Vector3;

const DEGREE: f64 = TAU / 360.0;

fn slope(f: impl Fn(f64) -> f64, t: f64) -> f64 {
    (f(t + 1e-4) - f(t - 1e-4)) / 2e-4
}

/// A car that accelerates, brakes and turns on a road with small slopes.
fn car(t: f64) -> Sample {
    let speed = |t: f64| 12.0 + 5.0 * (0.5 * t).sin();
    let yaw_rate = 0.15 * (0.7 * t).sin();
    let [roll, pitch] = [|t: f64| 0.03 * (0.9 * t).sin(), |t: f64| 0.03 * (0.6 * t + 1.0).sin()];
    let yaw = -0.15 / 0.7 * ((0.7 * t).cos() - 1.0);
    let (r, p) = (roll(t), pitch(t));
    let force =
        Vector3::new(slope(speed, t) - G * p.sin(), speed(t) * yaw_rate + G * r.sin() * p.cos(), G * r.cos() * p.cos());
    let rates = Vector3::new(slope(roll, t), slope(pitch, t), yaw_rate);
    let motion = Motion::new(force, rates, RollPitchYaw::new(r, p, yaw), speed(t));
    Sample { time: Some(t), motion, has_angles: true, ..Sample::default() }
}

/// A motorcycle that leans into its bends until nothing pushes to the side.
fn motorcycle(t: f64) -> Sample {
    let speed = 15.0 + 4.0 * (0.3 * t).sin();
    let lean = |t: f64| 0.7 * (0.6 * t).sin();
    let yaw_rate = -G * lean(t).tan() / speed;
    let (roll, surge) = (lean(t), 1.2 * (0.3 * t).cos());
    let rates = Vector3::new(slope(lean, t), yaw_rate * roll.sin(), yaw_rate * roll.cos());
    let force = Vector3::new(surge, 0.3 * (9.0 * t).sin(), G / roll.cos());
    let motion = Motion::new(force, rates, RollPitchYaw::new(roll, 0.0, 0.0), speed);
    Sample { time: Some(t), motion, has_angles: true, ..Sample::default() }
}

/// An aeroplane that begins to loop at constant speed, with an engine that makes up for gravity.
/// Its angles jump by half a turn at the vertical.
fn aeroplane(t: f64) -> Sample {
    let rate = if t > 2.0 { 0.6 } else { 0.0 };
    let angle = rate * (t - 2.0);
    let turn = if angle.cos() < 0.0 { 0.5 * TAU } else { 0.0 };
    let force = Vector3::new(0.0, 0.0, G * angle.cos() + 60.0 * rate);
    let orientation = RollPitchYaw::new(turn, -angle.sin().asin(), turn);
    let motion = Motion::new(force, Vector3::new(0.0, -rate, 0.0), orientation, 60.0);
    Sample { time: Some(t), motion, has_angles: true, ..Sample::default() }
}

/// The first fault within a minute at 100 Hz, and its time.
fn found(ride: impl Fn(f64) -> Sample) -> Option<(f64, String)> {
    let mut check = TableCheck::default();
    let mut times = (0..6000).map(|k| f64::from(k) * 0.01);
    times.find_map(|t| {
        check.take(t, &ride(t));
        Some((t, check.fault()?.to_string()))
    })
}

type Change = fn(&mut Sample);

fn with(change: Change) -> impl Fn(f64) -> Sample {
    move |t| {
        let mut sample = car(t);
        change(&mut sample);
        sample
    }
}

fn scale(sample: &mut Sample, channels: std::ops::Range<usize>, factor: f64) {
    channels.for_each(|k| sample.motion.0[k] *= factor);
}

fn without_angles(sample: &mut Sample) {
    scale(sample, 6..9, 0.0);
    sample.has_angles = false;
}

#[test]
fn right_tables_are_not_objected_to() {
    assert_eq!(found(car), None);
    assert_eq!(found(motorcycle), None);
    assert_eq!(found(aeroplane), None);
    let changes: [(&str, Change); 7] = [
        ("no angles", without_angles),
        ("no speed", |sample| sample.motion.0[9] = 0.0),
        ("no rates", |sample| scale(sample, 3..6, 0.0)),
        ("no angles, no speed", |sample| {
            without_angles(sample);
            sample.motion.0[9] = 0.0;
        }),
        ("only surge and sway", |sample| {
            without_angles(sample);
            scale(sample, 3..6, 0.0);
            sample.motion.0[2] = G;
        }),
        ("angles from 0 to 360 degrees", |sample| {
            sample.motion.0.iter_mut().skip(6).take(3).for_each(|angle| *angle = angle.rem_euclid(TAU));
        }),
        ("vibration", |sample| {
            let t = sample.time.unwrap();
            (0..3).for_each(|k| sample.motion.0[k] += 6.0 * (31.0 * t + k as f64).sin());
        }),
    ];
    for (name, change) in changes {
        assert_eq!(found(with(change)), None, "{name}");
    }
    let leaning = |t: f64| Sample { has_angles: false, ..motorcycle(t) };
    assert_eq!(found(leaning), None);
    assert_eq!(found(|_| Sample::default()), None);
}

/// Each wrong table, with the words that name its line, within the time in which a platform
/// comes up and its cue in.
#[test]
fn a_wrong_table_is_named_by_its_line() {
    let changes: [(&str, Change); 33] = [
        ("wx, wy and wz are 57 times as large", |sample| scale(sample, 3..6, 1.0 / DEGREE)),
        ("in their lines set unit = \"deg/s\"", |sample| {
            without_angles(sample);
            scale(sample, 3..6, 1.0 / DEGREE);
        }),
        ("in their lines set unit = \"deg/s\"", |sample| {
            without_angles(sample);
            scale(sample, 3..6, 1.0 / DEGREE);
            sample.motion.0[9] = 0.0;
        }),
        ("wx, wy and wz are 57 times as small as the angles say", |sample| scale(sample, 3..6, DEGREE)),
        ("in the lines of roll, pitch and yaw set unit = \"deg\"", |sample| scale(sample, 6..9, 1.0 / DEGREE)),
        ("in the lines of ax, ay and az set unit = \"g\"", |sample| scale(sample, 0..3, 1.0 / G)),
        ("the vertical force is -0.0 m/s2 in the mean and not 9.8", |sample| sample.motion.0[2] -= G),
        ("set gravity = \"removed\"", |sample| scale(sample, 0..3, 0.0)),
        ("set gravity = \"included\"", |sample| sample.motion.0[2] += G),
        ("z points down", |sample| scale(sample, 2..3, -1.0)),
        ("gravity is in ax: exchange `at` of ax and az", |sample| sample.motion.0.swap_rows(0, 2)),
        ("multiply scale by 0.30", |sample| scale(sample, 0..3, 1.0 / 0.3048)),
        ("ax is 0.10 times the change of speed: in the lines of ax, ay and az set unit = \"g\"", |sample| {
            // Without gravity in the packets: live has put it back.
            without_angles(sample);
            let t = sample.time.unwrap();
            sample.motion.0[0] = 2.5 * (0.5 * t).cos() / G;
            sample.motion.0[1] = sample.motion.0[9] * sample.motion.0[5] / G;
        }),
        ("in the line of speed set unit = \"km/h\"", |sample| scale(sample, 9..10, 3.6)),
        ("in the line of speed set unit = \"mph\"", |sample| scale(sample, 9..10, 1.0 / 0.44704)),
        ("in the line of speed set unit = \"m/s\"", |sample| scale(sample, 9..10, 1.0 / 3.6)),
        ("wx is the rate of yaw, and wz is not: exchange `at` of wx and wz", |sample| sample.motion.0.swap_rows(3, 5)),
        ("wx is the rate of yaw, and wz is not", |sample| {
            without_angles(sample);
            sample.motion.0.swap_rows(3, 5);
        }),
        ("the lateral force of bends is missing", |sample| {
            sample.motion.0[1] -= sample.motion.0[9] * sample.motion.0[5];
        }),
        ("set unit = \"deg/s\"", |sample| scale(sample, 3..9, 1.0 / DEGREE)),
        ("in the lines of roll, pitch and yaw set unit = \"deg\"", |sample| scale(sample, 8..9, 1.0 / DEGREE)),
        ("wx is the rate of pitch, and wy is not", |sample| sample.motion.0.swap_rows(3, 4)),
        ("wx is the rate of yaw, and wz is not", |sample| {
            without_angles(sample);
            sample.motion.0.swap_rows(3, 5);
            sample.motion.0[9] = 0.0;
        }),
        ("exchange `at` of ax and ay", |sample| sample.motion.0.swap_rows(0, 1)),
        ("exchange `at` of ax and ay", |sample| {
            without_angles(sample);
            sample.motion.0.swap_rows(0, 1);
        }),
        ("exchange `at` of ax and ay", |sample| {
            without_angles(sample);
            sample.motion.0.swap_rows(0, 1);
            sample.motion.0[9] = 0.0;
        }),
        ("set force-axes = \"world\"", |sample| {
            sample.motion.0[8] += 2.1;
            let force = Orientation::new(sample.motion.angles()).rotation * sample.motion.force();
            sample.motion.0.fixed_rows_mut::<3>(0).copy_from(&force);
        }),
        ("set force-axes = \"world\"", |sample| {
            // Without gravity in the packets: live has put it back.
            sample.motion.0[8] += 2.1;
            let rotation = Orientation::new(sample.motion.angles()).rotation;
            let up = rotation.transpose() * Vector3::z() * G;
            let force = rotation * (sample.motion.force() - up) + up;
            sample.motion.0.fixed_rows_mut::<3>(0).copy_from(&force);
        }),
        ("gravity pulls as with the opposite pitch", |sample| {
            scale(sample, 4..5, -1.0);
            scale(sample, 7..8, -1.0);
        }),
        ("gravity pulls as with the opposite roll", |sample| {
            scale(sample, 3..4, -1.0);
            scale(sample, 6..7, -1.0);
        }),
        ("roll and pitch turn the vehicle upside down", |sample| sample.motion.0[6] += 0.5 * TAU),
        ("ax is nothing while the speed changes", |sample| scale(sample, 0..1, 0.0)),
        ("wz is nothing while yaw changes", |sample| scale(sample, 5..6, 0.0)),
    ];
    for (words, change) in changes {
        let (time, text) = found(with(change)).unwrap_or_else(|| panic!("nothing is found: {words}"));
        assert!(text.contains(words), "{words}: {text}");
        assert!(time < 20.0, "{words}: after {time} s");
    }
}

/// Two channels go together for a moment, whatever they are.
#[test]
fn signs_of_other_quantities_do_not_agree() {
    let verdict = |change: Change, check: Check| {
        let mut signs = Signs::default();
        let mut agrees = false;
        for k in 0..6000 {
            let t = f64::from(k) * 0.01;
            signs.take(t, &with(change)(t));
            agrees |= signs.verdict(check) == Verdict::Agrees;
        }
        agrees
    };
    assert!(verdict(|_| (), Check::LeftTurn) && verdict(|_| (), Check::Roll));
    assert!(!verdict(|sample| sample.motion.0[1] -= sample.motion.0[9] * sample.motion.0[5], Check::LeftTurn));
    for check in [Check::Roll, Check::Yaw] {
        assert!(!verdict(|sample| sample.motion.0.swap_rows(3, 5), check), "{check:?}");
        assert!(!verdict(|sample| scale(sample, 3..6, 1.0 / DEGREE), check), "{check:?}");
    }
}

/// A session with this source at 100 Hz that is to engage as soon as it can, after this time \[s\];
/// the last refusal, and when it first engaged.
fn session(ignore_signs: bool, seconds: u32, ride: impl Fn(f64) -> Sample) -> (Session, Option<Refusal>, Option<f64>) {
    let settings = Settings { ignore_signs, ..Settings::default() };
    let mut session = Session::new(&Parameters::default(), &settings).unwrap();
    session.handle(Event::Start).unwrap();
    let (mut refusal, mut engaged) = (None, None);
    for step in 0..1000 * seconds {
        if step % 10 == 0 {
            session.receive(session.time(), &ride(session.time()));
        }
        if session.state() == State::Neutral {
            refusal = session.handle(Event::Engage).err();
        }
        if session.state().is_engaged() {
            engaged = engaged.or(Some(session.time()));
        }
        session.step();
    }
    (session, refusal, engaged)
}

#[test]
fn a_session_engages_with_a_right_table_alone() {
    assert_eq!(session(false, 20, car).0.state(), State::Engaged);
    assert_eq!(session(false, 20, motorcycle).0.state(), State::Engaged);
    let in_degrees = |t: f64| with(|sample| scale(sample, 3..6, 1.0 / DEGREE))(t);
    let (refused, refusal, engaged) = session(false, 20, in_degrees);
    assert_eq!((refused.state(), engaged), (State::Neutral, None));
    let text = refusal.unwrap().to_string();
    assert!(text.contains("set unit = \"deg/s\"") && text.contains("--ignore-signs"), "{text}");
    assert_eq!(session(true, 20, in_degrees).0.state(), State::Engaged);
    // Time in milliseconds: it would be 100 teleports a second.
    let (refused, refusal, _) = session(false, 20, |t| Sample { time: Some(1000.0 * t), ..car(t) });
    assert_eq!(refused.state(), State::Neutral);
    assert!(refusal.unwrap().to_string().contains("in the line of time set unit = \"ms\""));
}

/// A small platform is at neutral after 2.2 s.
#[test]
fn rates_in_degrees_are_found_before_a_small_platform_is_at_neutral() {
    let changes: [Change; 2] = [
        |sample| scale(sample, 3..6, 1.0 / DEGREE),
        |sample| {
            without_angles(sample);
            scale(sample, 3..6, 1.0 / DEGREE);
        },
    ];
    for change in changes {
        let (time, text) = found(with(change)).unwrap();
        assert!(text.contains("deg/s") && time < 2.2, "{text}: {time} s");
    }
}

/// A vehicle that stood when the platform engaged drives off with rates in degrees.
#[test]
fn rates_in_degrees_are_found_within_a_second_of_driving() {
    for angles in [true, false] {
        let ride = |t: f64| {
            let mut sample = if t < 10.0 { Sample { has_angles: true, ..Sample::default() } } else { car(t) };
            sample.time = Some(t);
            scale(&mut sample, 3..6, 1.0 / DEGREE);
            if !angles {
                without_angles(&mut sample);
            }
            sample
        };
        let (time, text) = found(ride).unwrap();
        assert!(text.contains("deg/s") && time <= 11.25, "{text}: {time} s");
    }
}
