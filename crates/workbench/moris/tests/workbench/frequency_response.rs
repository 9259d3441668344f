//! Small-signal response of the washout, compared with its closed form in HP =
//! s^4/D and LP = 1 - HP.
//!
//! Symbols: u is the force, w the rate, h the head's height.
//!
//! - A force u demands the tilt theta = -LP u/g. Full compensation subtracts h theta'' from the
//!   platform's acceleration before the high-pass. So felt = HP (u - h theta'') + h theta'' + LP
//!   u = (1 - (h/g) s^2 LP^2) u, and the pitch rate is -s LP u/g.
//! - A rate w rotates the platform by s^3/D w, and the felt rate is s^4/D w. Gravity, compensated
//!   like a tilt, adds -(g - h s^2 LP) s^3/D w along surge. Along sway the sign is opposite: a roll
//!   to the right feels like a force to the left.

use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};

use moris::frequency_response::{Measured, picture, table};
use moris_analysis::frequency_response::limits::Limit;
use moris_analysis::frequency_response::platform::NominalPlatform;
use moris_simulation::frequency_response::channel::Channel::{self, Heave, Pitch, Roll, Surge, Sway, Yaw};
use moris_simulation::frequency_response::channel::{CROSS_CHANNELS, direct};
use moris_simulation::frequency_response::excitation::{Amplitudes, frequencies};
use moris_simulation::frequency_response::{Response, response, response_on};
use moris_stewart_platform::Parameters as StewartParameters;
use moris_washout::nalgebra::Complex;
use moris_washout::{Input, Output, Parameters, Washout, presets};

const GRAVITY: f64 = 9.80665;
const HEAD: f64 = 1.2;
const SMALL: f64 = 1e-3;
/// Relative error at 15.8 rad/s with steps of a millisecond, as it appears in the tilt, which is
/// felt through its acceleration: (w h)^2/2, with h the step.
const TOLERANCE: f64 = 1.3e-4;

/// 1 - s^4/D with D = (s^2 + 2 zeta omega s + omega^2)^2.
fn low_pass(s: Complex<f64>, omega: f64, zeta: f64) -> Complex<f64> {
    1.0 - high_pass(s, omega, zeta)
}

fn high_pass(s: Complex<f64>, omega: f64, zeta: f64) -> Complex<f64> {
    let pair = s * s + 2.0 * zeta * omega * s + omega * omega;
    (s * s / pair).powi(2)
}

/// The paper's set, measured as a whole, and the number of reports of progress.
static MEASURED: LazyLock<(Measured, u64)> = LazyLock::new(|| {
    let parameters = presets::parameters(presets::PAPER);
    let count = AtomicU64::new(0);
    let progress = || {
        count.fetch_add(1, Ordering::Relaxed);
    };
    let measured = Measured::of(&parameters, Amplitudes::default(), false, false, progress).unwrap();
    (measured, count.into_inner())
});

/// The paper's set's response to a small signal.
fn small_signal(channel: Channel, frequency: f64) -> &'static Response {
    let is_it = |one: &&Response| one.input == channel && one.frequency == frequency;
    MEASURED.0.small.iter().find(is_it).unwrap()
}

#[track_caller]
fn assert_near(response: &Response, output: Channel, expected: Complex<f64>) {
    let found = response.ratios[output as usize];
    let error = (found - expected).norm();
    let w = response.frequency;
    assert!(error <= TOLERANCE * expected.norm() + 1e-6, "{output:?} at {w}: {found} is not {expected}");
}

#[test]
fn heave_and_the_rates_are_high_passes() {
    for frequency in frequencies() {
        let s = Complex::new(0.0, frequency);
        assert_near(small_signal(Heave, frequency), Heave, high_pass(s, 2.5, 1.0));
        for channel in [Roll, Pitch, Yaw] {
            assert_near(small_signal(channel, frequency), channel, high_pass(s, 1.0, 1.0));
        }
    }
}

#[test]
fn surge_and_sway_add_up_to_themselves_and_the_tilt_s_jolt() {
    for frequency in frequencies() {
        let s = Complex::new(0.0, frequency);
        let low = low_pass(s, 2.5, 1.0);
        let force = 1.0 - HEAD / GRAVITY * s * s * low * low;
        let rate = s * low / GRAVITY;
        for (channel, turn, sign) in [(Surge, Pitch, -1.0), (Sway, Roll, 1.0)] {
            let found = small_signal(channel, frequency);
            assert_near(found, channel, force);
            assert_near(found, turn, sign * rate);
            assert_eq!(found.limited[1..], [0.0, 0.0]);
        }
    }
}

#[test]
fn a_rate_is_felt_as_a_force_through_gravity() {
    for frequency in frequencies() {
        let s = Complex::new(0.0, frequency);
        let angle = high_pass(s, 1.0, 1.0) / s;
        let force = (GRAVITY - HEAD * s * s * low_pass(s, 2.5, 1.0)) * angle;
        assert_near(small_signal(Pitch, frequency), Surge, -force);
        assert_near(small_signal(Roll, frequency), Sway, force);
    }
}

#[test]
fn another_set_has_its_own_response() {
    let washout =
        Washout::new(&presets::parameters(include_str!("../../../../../examples/paper-runs/small-motions.toml")))
            .unwrap();
    for frequency in [0.1, 0.398_107_170_553_497_3, 1.0, 10.0] {
        let s = Complex::new(0.0, frequency);
        let [found, roll] = [Heave, Roll].map(|channel| {
            let amplitude = Amplitudes::default().scaled(SMALL).of(channel, frequency);
            response(&washout, channel, frequency, amplitude, false)
        });
        assert!(found.settled);
        assert_near(&found, Heave, high_pass(s, 0.35, 0.5));
        assert_near(&roll, Roll, 0.3 * high_pass(s, 1.0, 1.0));
    }
}

#[test]
fn a_linear_channel_is_not_distorted_and_a_limited_one_is() {
    let washout = Washout::new(&presets::parameters(presets::PAPER)).unwrap();
    let heave = response(&washout, Heave, 3.0, 1.0, false);
    assert!(heave.distortion[Heave as usize] < 1e-3, "{}", heave.distortion[Heave as usize]);
    // 1 m/s2 at 3 rad/s would ask for more than 17 degrees a second of a tilt that may turn by 3.
    let surge = response(&washout, Surge, 3.0, 1.0, false);
    assert!(surge.limited[0] > 0.5);
    assert!(surge.distortion[Pitch as usize] > 0.02, "{}", surge.distortion[Pitch as usize]);
}

/// A vehicle that pitches without accelerating has gravity along surge. If all of gravity is
/// removed, only the rate is cued.
#[test]
fn gravity_turns_with_the_vehicle_where_that_is_asked_for() {
    let mut parameters = presets::parameters(presets::PAPER);
    let at = |parameters: &Parameters, gravity_turns| {
        response(&Washout::new(parameters).unwrap(), Pitch, 0.251, 0.004, gravity_turns)
    };
    let alone = at(&parameters, false).ratios[Surge as usize];
    let turning = at(&parameters, true).ratios[Surge as usize];
    // What the head in the vehicle feels: -g sin(pitch), pitch = w/s, of which nearly all is cued at so low a frequency.
    let felt = -GRAVITY / Complex::new(0.0, 0.251);
    assert!((turning - alone - felt).norm() < 0.03 * felt.norm(), "{turning} less {alone} is not {felt}");
    parameters.conditioning.gravity_removal = moris_washout::interface::GravityRemoval::Full;
    let removed = at(&parameters, true).ratios[Surge as usize];
    assert!((removed - alone).norm() < 1e-3 * felt.norm(), "{removed} is not {alone}");
}

#[test]
fn everything_is_measured_once_and_in_order() {
    let (measured, count) = &*MEASURED;
    assert_eq!(*count, Measured::TESTS);
    for responses in [&measured.test, &measured.small] {
        let found: Vec<(Channel, f64)> = responses.iter().map(|one| (one.input, one.frequency)).collect();
        let wanted: Vec<(Channel, f64)> =
            [Surge, Sway, Heave, Roll, Pitch, Yaw].iter().flat_map(|&c| frequencies().map(|w| (c, w))).collect();
        assert_eq!(found, wanted);
    }
}

#[test]
fn bounds_of_one_s_own_are_held_or_named_with_the_value() {
    let (measured, _) = &*MEASURED;
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("bounds.csv");
    let read = |rows: &str| {
        let header = "channel,frequency,modulus_low,modulus_high,phase_low,phase_high\n";
        std::fs::write(&file, format!("{header}{rows}")).unwrap();
        Limit::read(&file)
    };
    // The response of heave is a high-pass, of which the closed form is known.
    let expected = high_pass(Complex::new(0.0, 10.0), 2.5, 1.0);
    let (modulus, phase) = (expected.norm(), expected.arg().to_degrees());
    let around = format!(
        "heave,10,{},{},{},{}\nheave,9.9,{},,,{}\n",
        modulus - 0.01,
        modulus + 0.01,
        phase - 1.0,
        phase + 1.0,
        modulus + 0.01,
        phase - 361.0
    );
    let limits = read(&around).unwrap();
    assert_eq!(limits[0].broken_by(measured), [""; 0]);
    let [below, above] = &limits[1].broken_by(measured)[..] else { panic!("two bounds are broken") };
    assert!(below.starts_with(&format!("modulus {modulus:.3} is below")), "{below}");
    assert!(above.starts_with("phase") && above.contains("is above"), "{above}");
    // A bound that the value misses by less than the digits shown: more are shown.
    let shown = below.split(' ').nth(1).unwrap();
    let missed = read(&format!("heave,10,{shown},{shown},,\n")).unwrap()[0].broken_by(measured);
    assert!(missed.len() == 1 && !missed[0].contains(&format!(" {shown} is")), "{missed:?}");
    let (are_held, text) = table::verdicts(&limits, measured);
    assert!(!are_held && text.starts_with("bounds: 1 of 2 held\n  not held: heave at 9.900 rad/s: modulus"), "{text}");
    assert_eq!(read("pitch rate to surge,0.2,,,,\n").unwrap()[0].broken_by(measured), ["was not measured"]);
    for (rows, reason) in [
        ("", "there are no bounds"),
        ("heaf,10,,,,\n", "line 2: there is no channel \"heaf\"; there are surge, sway"),
        ("surge to yaw rate,10,,,,\n", "there is no channel"),
        ("heave,-1,,,,\n", "frequency is \"-1\", but must be above 0 rad/s"),
        ("heave,10,x,,,\n", "modulus_low is \"x\", which is no number"),
    ] {
        let error = read(rows).unwrap_err();
        assert!(error.contains(reason), "{error}");
    }
    // Columns of bounds that are not needed may be left out, and come in any order.
    std::fs::write(&file, "phase_high,frequency,channel\n-30,10,heave\n").unwrap();
    let found = &Limit::read(&file).unwrap()[0];
    assert_eq!((found.modulus, found.phase), ([None, None], [None, Some(-30.0)]));
    for (header, reason) in [
        ("channel,frequency", "there is no column of bounds; the columns are channel, frequency, modulus_low"),
        ("frequency,modulus_low", "there is no column channel"),
        ("channel,frequency,modulus_least", "column modulus_least is no bound; the columns are channel"),
    ] {
        std::fs::write(&file, format!("{header}\n")).unwrap();
        let error = Limit::read(&file).unwrap_err();
        assert!(error.contains(reason), "{error}");
    }
    let picture = directory.path().join("direct.svg");
    picture::draw(&picture, measured, &limits, &direct(), 3).unwrap();
    let bars = std::fs::read_to_string(&picture).unwrap().matches("stroke-width=\"12\"").count();
    assert_eq!(bars, 4, "modulus and phase of two bounds");
}

/// The drives follow a command as a second-order low-pass behind a dead time: at a small amplitude
/// the platform's felt heave is that of the commanded motion times it.
#[test]
fn the_platform_adds_the_lag_of_its_drives() {
    let parameters = presets::parameters(presets::PAPER);
    let washout = Washout::new(&parameters).unwrap();
    let drives = StewartParameters::default().actuators;
    for frequency in [1.0, 6.309_573_444_801_93] {
        let amplitude = Amplitudes::default().scaled(SMALL).of(Heave, frequency);
        let commanded = response(&washout, Heave, frequency, amplitude, false).ratios[Heave as usize];
        let mut platform = NominalPlatform::new(&parameters).unwrap();
        let felt = |commanded: &Output, step| platform.felt(commanded, step);
        let moved = response_on(felt, &washout, Heave, frequency, amplitude, false).ratios[Heave as usize];
        let s = Complex::new(0.0, frequency / drives.bandwidth);
        let lag =
            (s * s + 2.0 * drives.damping * s + 1.0).inv() * Complex::from_polar(1.0, -frequency * drives.dead_time);
        let error = (moved / commanded - lag).norm();
        assert!(error < 2e-3, "{frequency}: {} is not {lag}", moved / commanded);
    }
}

/// The washout's own motion, recorded: the same table as by simulation.
#[test]
fn recordings_of_the_test_give_the_same_response() {
    let directory = tempfile::tempdir().unwrap();
    let parameters = presets::parameters(presets::PAPER);
    let (frequency, step, amplitude) = (frequencies()[7], 0.005, 1e-2);
    let mut washout = Washout::new(&parameters).unwrap();
    let mut text = "time,ax,ay,az,wx,wy,wz".to_owned();
    for name in ["specificForce", "angularVelocity"] {
        text += &["x", "y", "z"].map(|axis| format!(",rider.{name}.{axis}")).concat();
    }
    let mut before = Input::default();
    for k in 0..=8000 {
        let time = step * f64::from(k);
        let heave = amplitude * (time / 5.0).min(1.0) * (frequency * time).sin();
        let mut input = Input::default();
        input.specific_force.z += heave;
        if k > 0 {
            washout.step_between(&before, &input, step);
        }
        before = input;
        let felt = washout.output();
        let (force, rate) = (felt.felt_specific_force, felt.felt_angular_velocity);
        text += &format!("\n{time},0,0,{},0,0,0,{},{},{}", GRAVITY + heave, force.x, force.y, force.z);
        text += &format!(",{},{},{}", rate.x, rate.y, rate.z);
    }
    let file = directory.path().join("heave.csv");
    std::fs::write(&file, text + "\n").unwrap();
    let measured = Measured::recorded(&[&file]).unwrap();
    let [found] = &measured.test[..] else { panic!("one test") };
    assert_eq!((found.input, found.frequency, found.settled), (Heave, frequency, true));
    let expected = high_pass(Complex::new(0.0, frequency), 2.5, 1.0);
    let ratio = found.ratios[Heave as usize];
    assert!((ratio - expected).norm() < 2e-3, "{ratio} is not {expected}");
    let table = table::text(&measured);
    assert!(table.contains(&format!("{:.3}", expected.norm())), "{table}");
    std::fs::write(&file, "time,ax,ay,az,wx,wy,wz\n0,0,0,9.8,0,0,0\n0.1,0,0,9.8,0,0,0\n0.2,0,0,9.8,0,0,0\n").unwrap();
    let error = moris::words::error(&Measured::recorded(&[&file]).unwrap_err());
    assert!(error.contains("heave.csv") && error.contains("there are no columns"), "{error}");
}

#[test]
fn the_files_hold_what_was_measured() {
    let (measured, _) = &*MEASURED;
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| directory.path().join(name);
    table::write(&file("response.csv"), measured).unwrap();
    let mut rows = csv::Reader::from_path(file("response.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    assert_eq!(rows.len() as u64, Measured::TESTS * 6);
    let row = |signal: &str, input: &str, output: &str, frequency: &str| {
        let wanted = [signal, input, output];
        let found = rows.iter().find(|row| row.iter().take(3).eq(wanted) && &row[4] == frequency);
        found.unwrap_or_else(|| panic!("no row for {wanted:?} at {frequency}"))
    };
    let heave = row("small", "heave", "heave", "2.5119");
    let expected = high_pass(Complex::new(0.0, 2.511_886_431_509_58), 2.5, 1.0);
    assert!((heave[8].parse::<f64>().unwrap() - expected.norm()).abs() < 1e-3);
    assert!((heave[10].parse::<f64>().unwrap() - expected.arg().to_degrees()).abs() < 0.1);
    assert_eq!((&heave[3], &heave[6], &heave[7]), ("direct", "0.001000", "m/s²"));
    // Slowly enough, 1 m/s2 takes a pitch of 5.8 degrees, whose rate is 0.1 times that.
    let pitch = row("test", "surge", "pitch rate", "0.1000");
    assert!((pitch[8].parse::<f64>().unwrap() - 0.585).abs() < 0.002, "{pitch:?}");
    assert_eq!((&pitch[3], &pitch[9]), ("cross", "°/s per m/s²"));
    assert_eq!(&row("test", "yaw rate", "heave", "1.0000")[10], "", "what is not felt has no phase");

    for (name, titles) in
        [("direct.svg", ["Surge", "Yaw rate"]), ("cross.svg", ["Pitch rate to surge", "Sway to roll rate"])]
    {
        let pairs = if name == "direct.svg" { &direct()[..] } else { &CROSS_CHANNELS };
        picture::draw(&file(name), measured, &[], pairs, pairs.len() / 2).unwrap();
        let drawn = std::fs::read_to_string(file(name)).unwrap();
        assert!(titles.iter().all(|title| drawn.contains(title)), "{name}");
    }
    assert!(picture::draw(&file("no/such/direct.svg"), measured, &[], &direct(), 3).is_err());
}
