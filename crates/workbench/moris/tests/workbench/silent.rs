//! Recordings that would be simulated wrongly without a word: each is said, with the remedy.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use moris::recording::conventions::{AngleUnit, Gravity};
use moris::recording::{ConventionOptions, Recording};
use moris::words;

const GRAVITY: f64 = 9.80665;
const HEADER: &str = "time,ax,ay,az,wx,wy,wz,speed,roll,pitch,yaw";

/// Channels of a sample.
#[derive(Clone, Copy)]
struct Sample {
    t: f64,
    force: [f64; 3],
    rate: [f64; 3],
    speed: f64,
    angle: [f64; 3],
}

/// A car that speeds up and slows down in bends, at a sample of 50 a second.
fn car(k: usize) -> Sample {
    let t = 0.02 * k as f64;
    let wave = |frequency: f64, at: f64| (TAU * frequency * t + at).sin();
    let speed = 9.0 - 5.0 * (TAU / 15.0 * t).cos();
    let angle = [0.02 * wave(0.23, 0.0), 0.015 * wave(0.31, 1.0), -0.6 * wave(0.08, TAU / 4.0)];
    let rate = [
        0.02 * TAU * 0.23 * wave(0.23, TAU / 4.0),
        0.015 * TAU * 0.31 * wave(0.31, 1.0 + TAU / 4.0),
        0.6 * TAU * 0.08 * wave(0.08, 0.0),
    ];
    let force = [5.0 * TAU / 15.0 * wave(1.0 / 15.0, 0.0), speed * rate[2], GRAVITY + 0.3 * wave(1.3, 0.0)];
    Sample { t, force, rate, speed, angle }
}

/// What is said of the car's recording with each sample changed: its warnings, or the refusal.
fn said_of(header: &str, options: &ConventionOptions, change: impl Fn(usize, Sample) -> Sample) -> String {
    let width = header.split(',').count();
    let mut text = format!("{header}\n");
    for k in 0..1501 {
        let Sample { t, force, rate, speed, angle } = change(k, car(k));
        let fields = [&[t][..], &force, &rate, &[speed], &angle].concat();
        let fields: Vec<String> = fields.iter().take(width).map(|value| format!("{value:.7}")).collect();
        writeln!(text, "{}", fields.join(",")).unwrap();
    }
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("drive.csv");
    fs::write(&file, text).unwrap();
    match Recording::read(&file, &options.load().unwrap()) {
        Ok(recording) => words::warnings(&recording).join(" "),
        Err(error) => words::error(&error),
    }
}

fn said(change: impl Fn(usize, Sample) -> Sample) -> String {
    said_of(HEADER, &ConventionOptions::default(), change)
}

#[test]
fn a_right_ride_is_not_accused() {
    assert_eq!(said(|_, sample| sample), "");
}

/// A two-wheeler has no lateral force in bends, and what it has along z is that of its lean.
#[test]
fn a_vehicle_that_leans_needs_no_lateral_force() {
    let leaning = said(|_, mut sample| {
        let lateral = sample.speed * sample.rate[2];
        sample.force = [sample.force[0], 0.0, lateral.hypot(GRAVITY)];
        sample
    });
    assert_eq!(leaning, "");
    let upright = said(|_, mut sample| {
        sample.force[1] = 0.0;
        sample
    });
    assert!(upright.contains("Column ay is constant, 0, while the vehicle drives bends"), "{upright}");
}

#[test]
fn channels_that_come_too_late_or_too_early_are_named() {
    for (shift, expected) in [(25, "0.5 s after"), (-15, "0.3 s before"), (5, "")] {
        let other = |k: usize| car(k.saturating_add_signed(-shift));
        let speed = said(|k, sample| Sample { speed: other(k).speed, ..sample });
        let found = speed.contains(&format!("Column speed comes {expected} the force along x"));
        assert_eq!(found, !expected.is_empty(), "{speed}");
        let yaw = said(|k, sample| Sample { angle: other(k).angle, ..sample });
        let found = yaw.contains(&format!("Column yaw comes {expected} the angular velocity"));
        assert_eq!(found, !expected.is_empty(), "{yaw}");
    }
}

#[test]
fn times_that_cannot_be_meant_have_their_own_remedy() {
    let times = |change: &dyn Fn(usize) -> f64| said(|k, sample| Sample { t: change(k), ..sample });
    let counter = times(&|k| (k % 256) as f64);
    assert!(counter.contains("time begins again every 256 samples") && counter.contains("--rate HERTZ"), "{counter}");
    let jumped = times(&|k| 0.02 * k as f64 + if k > 700 { 3600.0 } else { 0.0 });
    assert!(jumped.contains("the clock has jumped") && !jumped.contains("--resample"), "{jumped}");
    let hours = times(&|k| (0.02 * k as f64 / 3600.0 * 1e5).floor() / 1e5);
    assert!(hours.contains("give the unit of time with --time-unit") && !hours.contains("--resample"), "{hours}");
}

#[test]
fn time_at_another_pace_is_named_with_and_without_a_speed() {
    for (pace, expected) in [(0.5, "2.0 times too fast"), (3.0, "3.0 times too slow")] {
        let scaled = |header: &str| {
            said_of(header, &ConventionOptions::default(), |_, mut sample| {
                sample.t *= pace;
                sample
            })
        };
        let with_speed = scaled(HEADER);
        assert!(with_speed.contains(expected), "{with_speed}");
        assert!(!with_speed.contains("--speed-unit"), "{with_speed}");
    }
    let without_speed = said_of(HEADER, &ConventionOptions::default(), |_, mut sample| {
        sample.t *= 3.0;
        sample.speed = 0.0;
        sample
    });
    assert!(
        without_speed.contains("times the derivatives of the angles: the time seems to run 3.0"),
        "{without_speed}"
    );
}

/// A steady circle has a lasting lateral force and nothing else.
#[test]
fn a_steady_circle_is_no_wrong_axis() {
    let steady = |k: usize, mut sample: Sample| {
        let yaw = 0.5 * 0.02 * k as f64;
        sample = Sample { force: [0.0, 5.0, GRAVITY], rate: [0.0, 0.0, 0.5], speed: 10.0, ..sample };
        sample.angle = [0.0, 0.0, yaw];
        sample
    };
    let circle = said(steady);
    assert!(!circle.contains("vertical") && !circle.contains("not measured"), "{circle}");
    // Its heading in degrees.
    let degrees = |k: usize, sample: Sample| {
        let mut sample = steady(k, sample);
        sample.angle[2] = sample.angle[2].to_degrees() % 360.0;
        sample
    };
    let open = said(degrees);
    assert!(open.contains("these are degrees, not radians; use --angle-unit deg"), "{open}");
    let given = ConventionOptions { angle_unit: Some(AngleUnit::Degree), ..ConventionOptions::default() };
    let given = said_of(HEADER, &given, degrees);
    assert!(!given.contains("not measured") && !given.contains("degrees, not"), "{given}");
}

#[test]
fn a_clock_that_jumps_is_no_gap() {
    let options = ConventionOptions { resample: Some(50.0), ..ConventionOptions::default() };
    let jump = said_of(HEADER, &options, |k, mut sample| {
        sample.t += if k > 700 { 86_400.0 } else { 0.0 };
        sample
    });
    assert!(jump.contains("nothing was recorded for 86400 s") && jump.contains("the clock has jumped"), "{jump}");
    let count = said_of(HEADER, &ConventionOptions::default(), |k, mut sample| {
        sample.t = k as f64;
        sample
    });
    assert!(count.contains("if it counts samples, use --rate"), "{count}");
}

/// Forces of the opposite sign, as phones write gravity, look like axes that point down.
#[test]
fn wrong_signs_are_named_without_a_speed() {
    let header = "time,ax,ay,az,wx,wy,wz";
    let said = |change: &dyn Fn(usize, Sample) -> Sample| said_of(header, &ConventionOptions::default(), change);
    let opposite = said(&|_, sample| Sample { force: sample.force.map(|force| -force), ..sample });
    assert!(opposite.contains("use --columns \"ax=-ax,ay=-ay,az=-az\""), "{opposite}");
    let [down, left] = [-1.0, 1.0].map(|sign| {
        said(&|_, sample| {
            let ([fx, fy, fz], [wx, wy, wz]) = (sample.force, sample.rate);
            Sample { force: [fx, -fy, sign * fz], rate: [wx, -wy, -wz], ..sample }
        })
    });
    assert!(down.contains("use --axes forward-right-down"), "{down}");
    assert!(!left.contains("wrong sign"), "{left}");
    let turned = said(&|_, mut sample| {
        sample.rate[2] *= -1.0;
        sample
    });
    assert!(turned.contains("backward: one of them has the wrong sign") && turned.contains("wz=-wz"), "{turned}");
}

#[test]
fn samples_of_two_sensors_by_turns_are_refused() {
    let by_turns = said(|k, sample| {
        let other = Sample { force: [sample.force[1], sample.force[0], GRAVITY], rate: [0.0; 3], ..sample };
        if k % 2 == 1 { other } else { sample }
    });
    assert!(by_turns.contains("the samples are those of 2 sensors by turns"), "{by_turns}");
}

#[test]
fn accelerations_of_which_nothing_tells_the_unit_may_be_in_g() {
    let removed = ConventionOptions { gravity: Some(Gravity::Removed), ..ConventionOptions::default() };
    let in_unit = |header: &str, unit: f64| {
        said_of(header, &removed, |_, sample| Sample {
            force: [sample.force[0] / unit, sample.force[1] / unit, (sample.force[2] - GRAVITY) / unit],
            ..sample
        })
    };
    let bare = "time,ax,ay,az,wx,wy,wz";
    let found = in_unit(bare, GRAVITY);
    assert!(found.contains("if they are in g, use --force-unit g."), "{found}");
    // Nothing is suspected of this size, of a unit that is given, and of what the speed confirms.
    assert_eq!(in_unit(bare, 1.0), "");
    assert!(!in_unit("time,ax [m/s2],ay [m/s2],az [m/s2],wx,wy,wz", GRAVITY).contains("in g"));
    // With a speed the sizes tell it.
    let found = in_unit(HEADER, GRAVITY);
    assert!(found.contains("--force-unit g"), "{found}");
}
