//! Recordings: units, axes and formats are converted, and errors name their place in the file.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use moris::recording::conventions::{
    AngleUnit, Axes, Dimension, ForceUnit, Frame, Gravity, Quantity, RateUnit, TimeUnit,
};
use moris::recording::{ConventionOptions, Conventions, Recording};
use moris::words;
use moris_washout::Parameters;
use moris_washout::cueing::conditioning::cue;
use moris_washout::interface::{AngularVelocityFrame, GravityRemoval};
use moris_washout::nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use tempfile::TempDir;

const GRAVITY: f64 = 9.80665;

/// A sample of an artificial recording: time, specific force, body rates, roll, pitch, yaw,
/// all in SI units, z up.
type Sample = [f64; 10];

/// Three seconds at 100 Hz of everything at once, smooth and slow enough for a vehicle.
fn samples() -> Vec<Sample> {
    (0..=300)
        .map(|k| {
            let t = 0.01 * f64::from(k);
            let (s1, s2) = ((TAU * 0.4 * t).sin(), (TAU * 0.7 * t).sin());
            [t, s1, 0.8 * s2, GRAVITY + 0.5 * s1, 0.3 * s2, 0.1 * s1, 0.2 * s2, 0.2 * s1, 0.05 * s2, 0.3 * s1]
        })
        .collect()
}

/// Content of a file: names of columns, and each sample's numbers.
fn csv(header: &str, samples: &[Sample], numbers: impl Fn(&Sample) -> Vec<f64>) -> String {
    let mut text = format!("{header}\n");
    for sample in samples {
        let fields: Vec<String> = numbers(sample).iter().map(f64::to_string).collect();
        writeln!(text, "{}", fields.join(",")).unwrap();
    }
    text
}

const PLAIN: &str = "time,ax,ay,az,wx,wy,wz";

fn plain() -> String {
    csv(PLAIN, &samples(), |s| s[..7].to_vec())
}

/// A directory with a file `recording.csv` of this text.
fn file(text: &str) -> (TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("ride.csv");
    fs::write(&file, text).unwrap();
    (directory, file)
}

fn read(text: &str, options: &ConventionOptions) -> Recording {
    let (_directory, file) = file(text);
    Recording::read(&file, &options.load().unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

/// The message with which a recording is refused, without the directory.
fn refusal(text: &str, options: &ConventionOptions) -> String {
    let (directory, file) = file(text);
    let error = Recording::read(&file, &options.load().unwrap()).expect_err("this recording must be refused");
    words::error(&error).replace(&format!("{}/", directory.path().display()), "")
}

fn assert_same(found: &Recording, expected: &Recording) {
    assert_eq!(found.inputs().len(), expected.inputs().len());
    assert!((found.step() - expected.step()).abs() < 1e-12);
    for (f, e) in found.inputs().iter().zip(expected.inputs()) {
        assert!((f.specific_force - e.specific_force).amax() < 1e-9, "{f:?} {e:?}");
        assert!((f.angular_velocity - e.angular_velocity).amax() < 1e-9, "{f:?} {e:?}");
        assert!((f.orientation.to_vector() - e.orientation.to_vector()).amax() < 1e-9, "{f:?} {e:?}");
    }
}

#[test]
fn a_plain_recording_is_what_it_says() {
    let recording = read(&plain(), &ConventionOptions::default());
    assert_eq!((recording.name.as_str(), recording.inputs().len(), recording.has_orientation), ("ride", 301, false));
    assert!((recording.step() - 0.01).abs() < 1e-12);
    assert_eq!(recording.angular_velocity_frame, AngularVelocityFrame::Body);
    let (sample, input) = (samples()[77], recording.inputs()[77]);
    assert_eq!(input.specific_force, Vector3::new(sample[1], sample[2], sample[3]));
    assert_eq!(input.angular_velocity, Vector3::new(sample[4], sample[5], sample[6]));
    assert_eq!(
        recording.parameters(&Parameters::default()).conditioning.angular_velocity_frame,
        AngularVelocityFrame::Body
    );
}

#[test]
fn other_units_axes_names_and_delimiters_make_the_same_ride() {
    let expected =
        read(&csv(&format!("{PLAIN},roll,pitch,yaw"), &samples(), |s| s.to_vec()), &ConventionOptions::default());
    assert!(expected.has_orientation);
    // Milliseconds, g, degrees; z down; columns in another order under other names, one with its unit; semicolons.
    let text = csv("Yaw;Pitch;Roll;t [ms];gx;gy;gz;fx;fy;fz (g);note", &samples(), |s| {
        let degrees = |value: f64| value.to_degrees();
        vec![
            -degrees(s[9]),
            -degrees(s[8]),
            degrees(s[7]),
            1000.0 * s[0] + 5e6,
            degrees(s[4]),
            -degrees(s[5]),
            -degrees(s[6]),
            s[1] / GRAVITY,
            -s[2] / GRAVITY,
            -s[3] / GRAVITY,
            0.0,
        ]
    })
    .replace(',', ";");
    let names = [
        (Quantity::Time, "t"),
        (Quantity::Force(0), "fx"),
        (Quantity::Force(1), "fy"),
        (Quantity::Force(2), "fz"),
        (Quantity::Rate(0), "gx"),
        (Quantity::Rate(1), "gy"),
        (Quantity::Rate(2), "gz"),
        (Quantity::Angle(0), "Roll"),
        (Quantity::Angle(1), "Pitch"),
        (Quantity::Angle(2), "Yaw"),
    ];
    let options = ConventionOptions {
        columns: names.map(|(quantity, name)| (quantity, name.to_owned())).to_vec(),
        time_unit: Some(TimeUnit::Millisecond),
        force_unit: Some(ForceUnit::Gravity),
        rate_unit: Some(RateUnit::DegreePerSecond),
        angle_unit: Some(AngleUnit::Degree),
        axes: Some(Axes::ForwardRightDown),
        ..ConventionOptions::default()
    };
    let found = read(&text, &options);
    assert!((found.start - 5e3).abs() < 1e-9);
    assert_same(&found, &expected);
}

/// Gravity is restored along the vertical, seen from a vehicle that is rolled and pitched.
#[test]
fn removed_gravity_is_put_back_by_the_orientation() {
    let expected =
        read(&csv(&format!("{PLAIN},roll,pitch,yaw"), &samples(), |s| s.to_vec()), &ConventionOptions::default());
    let without = csv(&format!("{PLAIN},roll,pitch,yaw"), &samples(), |s| {
        let up = Rotation3::from_euler_angles(s[7], s[8], s[9]).inverse() * Vector3::new(0.0, 0.0, GRAVITY);
        let mut sample = s.to_vec();
        (0..3).for_each(|axis| sample[1 + axis] -= up[axis]);
        sample
    });
    let options = ConventionOptions { gravity: Some(Gravity::Removed), ..ConventionOptions::default() };
    assert_same(&read(&without, &options), &expected);
}

/// Without orientation, gravity removal of either kind subtracts (0, 0, g). The cue is the
/// difference from rest.
#[test]
fn without_orientation_what_is_cued_is_what_differs_from_rest() {
    let recording = read(&plain(), &ConventionOptions::default());
    for removal in [GravityRemoval::HeadVertical, GravityRemoval::Full] {
        let mut parameters = recording.parameters(&Parameters::default());
        parameters.conditioning.gravity_removal = removal;
        parameters.conditioning.force_scale = Vector3::repeat(1.0);
        parameters.conditioning.rate_scale = Vector3::repeat(1.0);
        for input in recording.inputs() {
            let cue = cue(input, &parameters.conditioning, GRAVITY, 0.0);
            assert!((cue.force - (input.specific_force - Vector3::new(0.0, 0.0, GRAVITY))).amax() < 1e-12);
            assert!((cue.rates - input.angular_velocity).amax() < 1e-12);
        }
    }
}

#[test]
fn options_stand_over_the_file_of_conventions() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("phone.toml");
    fs::write(&file, "axes = \"forward-right-down\"\nforce-unit = \"g\"\n[columns]\nax = \"x\"\nay = \"y\"\n").unwrap();
    let options = ConventionOptions {
        conventions: Some(file.clone()),
        force_unit: Some(ForceUnit::MetrePerSecondSquared),
        columns: vec![(Quantity::Force(1), "lateral".to_owned())],
        ..ConventionOptions::default()
    };
    let given = options.load().unwrap();
    assert_eq!(given.axes, Axes::ForwardRightDown);
    assert_eq!(given.unit(Dimension::Force), Some(ForceUnit::MetrePerSecondSquared.unit()));
    assert_eq!(given.unit(Dimension::Rate), None);
    assert_eq!((given.column(Quantity::Force(0)), given.column(Quantity::Force(1))), ("x", "lateral"));
    assert_eq!(given.rate_frame, Frame::Body);
    let written = |columns: &str| {
        fs::write(&file, format!("columns = {columns}\n")).unwrap();
        ConventionOptions { conventions: Some(file.clone()), ..ConventionOptions::default() }.load()
    };
    let [text, table] = ["'ax=x * 9.80665, ay=-y'", "{ ax = 'x * 9.80665', ay = '-y' }"].map(written);
    assert_eq!(text.unwrap(), table.unwrap());
    for (columns, message) in [("5", "names by key, or a text such as"), ("'x'", "write KEY=NAME, as in ax=accel_x")] {
        let found = words::error(&written(columns).unwrap_err());
        assert!(found.contains(message), "{found}");
    }

    fs::write(&file, "force-units = \"g\"\n").unwrap();
    let message = words::error(&options.load().unwrap_err());
    assert!(message.contains("force-units") && message.contains("force-unit"), "{message}");
    fs::write(&file, "[columns]\naxx = \"x\"\n").unwrap();
    let message = words::error(&options.load().unwrap_err());
    assert!(message.contains("there is no key axx; there are time, ax"), "{message}");
}

/// A circuit with more bends to the right, at 2 g: its median is no tilt of the sensor.
#[test]
fn hard_bends_one_way_are_no_wrong_axes() {
    let sway = |time: f64| -5.0 + 18.0 * (0.9 * time).sin() * if (0.9 * time).sin() > 0.0 { 0.6 } else { 1.0 };
    let bends = csv(PLAIN, &samples(), |s| vec![s[0], s[1], s[2] + sway(s[0]), s[3] + 0.4, s[4], s[5], s[6]]);
    read(&bends, &ConventionOptions::default());
}

#[test]
fn wrong_units_and_axes_are_recognised() {
    let scaled = |factors: [f64; 7]| csv(PLAIN, &samples(), |s| (0..7).map(|i| factors[i] * s[i]).collect());
    let default = ConventionOptions::default();
    let g = 1.0 / GRAVITY;
    assert!(
        refusal(&scaled([1.0, g, g, g, 1.0, 1.0, 1.0]), &default)
            .contains("gravity in g, not in m/s2: use --force-unit g")
    );
    let degrees = 1f64.to_degrees();
    let fast = [1.0, 1.0, 1.0, 1.0, degrees, degrees, degrees];
    assert!(refusal(&scaled(fast), &default).contains("use --rate-unit deg/s"));
    let down = [1.0, 1.0, -1.0, -1.0, 1.0, -1.0, -1.0];
    assert!(refusal(&scaled(down), &default).contains("so z points down: use --axes forward-right-down"));
    let milliseconds = [1000.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
    assert!(refusal(&scaled(milliseconds), &default).contains("give it with --time-unit"));

    let without = csv(PLAIN, &samples(), |s| vec![s[0], s[1], s[2], s[3] - GRAVITY, s[4], s[5], s[6]]);
    assert!(refusal(&without, &default).contains("so gravity has been taken out: use --gravity removed"));
    let turned = csv(PLAIN, &samples(), |s| vec![s[0], s[3], s[2], s[1], s[4], s[5], s[6]]);
    assert!(refusal(&turned, &default).contains("x is nearest to the vertical"));
    let tilted = csv(PLAIN, &samples(), |s| vec![s[0], s[1], s[2] + 5.3, s[3] - 1.55, s[4], s[5], s[6]]);
    assert!(refusal(&tilted, &default).contains("z is nearest to the vertical"));

    // Given units and axes that are not the recording's are also refused.
    let given = |options: ConventionOptions| refusal(&plain(), &options);
    assert!(
        given(ConventionOptions { force_unit: Some(ForceUnit::Gravity), ..default.clone() })
            .contains("--force-unit m/s2")
    );
    assert!(
        given(ConventionOptions { gravity: Some(Gravity::Removed), ..default.clone() }).contains("--gravity included")
    );
    let axes = Some(Axes::ForwardRightDown);
    assert!(given(ConventionOptions { axes, ..default.clone() }).contains("--axes forward-left-up"));
    let angles = csv(&format!("{PLAIN},roll,pitch"), &samples(), |s| [&s[..7], &[20.0 * s[7], s[8]]].concat());
    assert!(refusal(&angles, &default).contains("use --angle-unit deg"));
}

#[test]
fn a_fault_is_told_with_its_line_and_column() {
    let default = ConventionOptions::default();
    let text = plain();
    let lines: Vec<&str> = text.lines().collect();
    let with = |line: usize, other: &str| {
        let mut lines = lines.clone();
        lines[line - 1] = other;
        lines.join("\n")
    };
    let fault = |line: usize, other: &str| refusal(&with(line, other), &default);
    assert_eq!(
        fault(12, "0.10,0,NaN,9.8,0,0,0"),
        "ride.csv, line 12, column ay: is NaN; cut this part off, fill the gap with plausible values, or use --empty-fields interpolate"
    );
    assert!(fault(12, "0.10,0,0,inf,0,0,0").starts_with("ride.csv, line 12, column az: is inf"));
    assert!(fault(12, "0.10,0,0,9.8,,0,0").starts_with("ride.csv, line 12, column wx: is empty"));
    assert!(fault(12, "0.10,0,0,9.8,zero,0,0").starts_with("ride.csv, line 12, column wx: is \"zero\", which is not"));
    assert!(fault(12, "0.10,0,0,9.8,0,0").starts_with("ride.csv, line 12, column wz: is missing"));
    assert_eq!(
        fault(12, "0.05,0,0,9.8,0,0,0"),
        "ride.csv, line 12, column time: time goes back: 0.05 s comes after 0.09 s; if the samples come at equal \
         steps, --rate HERTZ reads none of the times"
    );
    assert!(fault(12, "0.09,0,0,9.8,0,0,0").contains("time stands still"));
    // Numbers beyond all measures are shown as they are written, or in few digits.
    assert_eq!(
        fault(12, "0.10,0,0,9.8,0,-1e308,0"),
        "ride.csv, line 12, column wy: is -1e308, which no sensor measures; cut this part off"
    );
    assert!(fault(12, "1e-308,0,0,9.8,0,0,0").contains("time goes back: 1e-308 s comes after 0.09 s"));
}

#[test]
fn missing_columns_and_empty_files_are_told() {
    let default = ConventionOptions::default();
    let message = refusal(&plain().replacen("az", "a_z", 1), &default);
    assert!(
        message.contains("no column az") && message.contains("is it a_z?") && message.contains("--columns az=NAME"),
        "{message}"
    );
    assert!(refusal("", &default).contains("is empty"));
    assert!(refusal("0.0,1,2,3,4,5,6\n", &default).contains("begins with numbers"));
    assert!(refusal(&format!("{PLAIN}\n0,0,0,9.81,0,0,0\n"), &default).contains("fewer than two samples"));
    let missing = words::error(&Recording::read(&PathBuf::from("no/such.csv"), &Conventions::default()).unwrap_err());
    assert!(missing.contains("cannot read no/such.csv"), "{missing}");
}

#[test]
fn unequal_steps_are_refused_and_can_be_interpolated() {
    // Every seventh sample is lost; what is left goes in a straight line, which interpolation restores exactly.
    let kept: Vec<Sample> = (0..=300)
        .filter(|k| k % 7 != 3)
        .map(|k| {
            let t = 0.01 * f64::from(k);
            [t, 0.1 * t, -0.2 * t, GRAVITY, 0.01 * t, 0.0, 0.0, 0.0, 0.0, 0.0]
        })
        .collect();
    let text = csv(PLAIN, &kept, |s| s[..7].to_vec());
    let message = refusal(&text, &ConventionOptions::default());
    assert!(
        message.contains("line 5, column time: the samples do not come at equal steps: here 0.0200 s"),
        "{message}"
    );
    let options = ConventionOptions { resample: Some(200.0), ..ConventionOptions::default() };
    let recording = read(&text, &options);
    assert_eq!((recording.inputs().len(), recording.step()), (601, 0.005));
    for (time, input) in recording.times().zip(recording.inputs()) {
        assert!((input.specific_force - Vector3::new(0.1 * time, -0.2 * time, GRAVITY)).amax() < 1e-12);
    }
    // A long gap causes a warning.
    let gap: Vec<Sample> = kept.iter().copied().filter(|s| !(1.0..2.0).contains(&s[0])).collect();
    let recording = read(&csv(PLAIN, &gap, |s| s[..7].to_vec()), &options);
    assert!(
        words::warnings(&recording).iter().any(|warning| warning.contains("Nothing was recorded for")),
        "{:?}",
        words::warnings(&recording)
    );
}

/// A sample may be a fifth of a step from its time.
#[test]
fn steps_are_equal_up_to_a_fifth() {
    let with = |off: f64| {
        let times = (0..101).map(|k| 0.02 * f64::from(k) + if k == 40 { 0.02 * off } else { 0.0 });
        let samples: Vec<Sample> = times.map(|t| [t, 0.0, 0.0, GRAVITY, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).collect();
        csv(PLAIN, &samples, |s| s[..7].to_vec())
    };
    for off in [0.18, -0.18] {
        assert_eq!(read(&with(off), &ConventionOptions::default()).inputs().len(), 101);
    }
    for (off, step) in [(0.22, "0.0244"), (-0.22, "0.0156")] {
        let message = refusal(&with(off), &ConventionOptions::default());
        assert!(
            message.contains(&format!("line 42, column time: the samples do not come at equal steps: here {step} s")),
            "{message}"
        );
    }
}

/// The last sample is reached where the rate fits, also if the duration is rounded:
/// 0.3 - 0.1 is below 0.2.
#[test]
fn resampling_reaches_the_last_sample() {
    let samples: Vec<Sample> =
        [0.1, 0.15, 0.17, 0.24, 0.3].map(|t| [t, 2.0 * t, 0.0, GRAVITY, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).to_vec();
    let text = csv(PLAIN, &samples, |s| s[..7].to_vec());
    for (rate, count, last) in [(100.0, 21, 0.3), (30.0, 7, 0.3), (33.0, 7, 0.1 + 6.0 / 33.0)] {
        let options = ConventionOptions { resample: Some(rate), ..ConventionOptions::default() };
        let recording = read(&text, &options);
        assert_eq!(recording.inputs().len(), count, "{rate}");
        assert!((recording.inputs()[count - 1].specific_force.x - 2.0 * last).abs() < 1e-12, "{rate}");
    }
}

#[test]
fn clocks_with_few_digits_and_comments_are_no_fault() {
    // 64 Hz, written in milliseconds: 0.016, 0.031, 0.047, ...
    let samples: Vec<Sample> = (0..128)
        .map(|k| {
            let t = (f64::from(k) / 64.0 * 1000.0).round() / 1000.0;
            [t, 0.0, 0.0, GRAVITY, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        })
        .collect();
    let text = format!("\u{feff}{}", csv(PLAIN, &samples, |s| s[..7].to_vec()).replacen('\n', "\n# from a phone\n", 1));
    let recording = read(&text, &ConventionOptions::default());
    assert!((recording.step() - 1.0 / 64.0).abs() < 1e-5);
}

#[test]
fn a_recording_that_does_not_begin_at_rest_can_be_faded_in() {
    let samples: Vec<Sample> = samples()
        .into_iter()
        .map(|mut s| {
            s[1] += 2.0;
            s
        })
        .collect();
    let text = csv(PLAIN, &samples, |s| s[..7].to_vec());
    let recording = read(&text, &ConventionOptions::default());
    assert!(
        words::warnings(&recording).iter().any(|warning| warning.contains("does not begin at rest")),
        "{:?}",
        words::warnings(&recording)
    );
    assert!(
        words::warnings(&recording).iter().any(|warning| warning.contains("along x is 2.")),
        "{:?}",
        words::warnings(&recording)
    );
    let led = read(&text, &ConventionOptions { fade_in: Some(1.0), ..ConventionOptions::default() });
    assert!(
        !words::warnings(&led).iter().any(|warning| warning.contains("does not begin at rest")),
        "{:?}",
        words::warnings(&led)
    );
    assert_eq!(led.inputs()[0].specific_force, Vector3::new(0.0, 0.0, GRAVITY));
    // Half way through, half of it: 0.5^2 (3 - 2 * 0.5).
    let half = 0.5 * (recording.inputs()[50].specific_force + Vector3::new(0.0, 0.0, GRAVITY));
    assert!((led.inputs()[50].specific_force - half).amax() < 1e-12);
    assert_eq!(led.inputs()[100..], recording.inputs()[100..]);
}

/// Fields that are right, odd and wrong.
fn field() -> impl Strategy<Value = String> {
    prop_oneof![
        8 => (-20.0..20.0f64).prop_map(|value| value.to_string()),
        1 => any::<f64>().prop_map(|value| value.to_string()),
        1 => "[-0-9.eE,;\"#nainf ]{0,8}",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases::cases(300, 100)))]

    /// Any file gives a recording of finite numbers at equal steps, or an error that names the
    /// file.
    #[test]
    fn no_file_is_a_panic(
        steps in prop::collection::vec(prop_oneof![6 => Just(0.01), 1 => -1.0..1.0f64, 1 => any::<f64>()], 0..30),
        fields in prop::collection::vec(field(), 0..200),
        level in any::<bool>(),
        resample in prop::option::of(1.0..1e4f64),
    ) {
        let mut text = format!("{PLAIN},roll,pitch\n");
        let mut time = 0.0;
        let mut fields = fields.into_iter();
        for step in steps {
            time += step;
            let mut line = vec![time.to_string()];
            line.extend(fields.by_ref().take(8));
            if level && line.len() > 3 {
                line[1..4].clone_from_slice(&["0".to_owned(), "0".to_owned(), "9.81".to_owned()]);
            }
            writeln!(text, "{}", line.join(",")).unwrap();
        }
        let (_directory, file) = file(&text);
        let options = ConventionOptions { resample, ..ConventionOptions::default() };
        match Recording::read(&file, &options.load().unwrap()) {
            Ok(recording) => prop_assert!(recording.step() > 0.0 && recording.inputs().iter().all(|input| input.specific_force.x.is_finite())),
            Err(error) => prop_assert!(words::error(&error).contains("ride.csv")),
        }
    }
}

#[test]
fn a_command_s_own_time_to_lead_in_gives_way_to_any_that_is_said_also_to_none() {
    let fade_in = |given| ConventionOptions { fade_in: given, ..ConventionOptions::default() };
    let found = |given| fade_in(given).load_or_fade_in(1.0).unwrap().fade_in;
    assert_eq!((found(None), found(Some(0.0)), found(Some(2.0))), (1.0, 0.0, 2.0));
    assert_eq!(fade_in(None).load().unwrap().fade_in, 0.0);
}
