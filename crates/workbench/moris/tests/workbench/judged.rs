//! Motion of another washout, judged beside ours.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

use moris::recording::felt::FeltTable;
use moris::recording::{Conventions, Recording};
use moris::simulate::{Outcome, Simulation};
use moris_setup::Setup;
use moris_simulation::foreign::ForeignMotion;
use moris_washout::Output;

/// A ride of 12 s with smooth surge and sway, `rate` samples a second.
fn write_ride(file: &Path, rate: u32) {
    let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for k in 0..=12 * rate {
        let t = f64::from(k) / f64::from(rate);
        let fade = (0.25 * t).min(1.0);
        let (surge, sway) = (0.6 * fade * (0.7 * t).sin(), 0.5 * fade * (0.9 * t + 1.0).cos());
        writeln!(text, "{t},{surge},{sway},9.80665,{},0,{}", 0.04 * fade * (0.6 * t).cos(), 0.1 * (0.3 * t).sin())
            .unwrap();
    }
    fs::write(file, text).unwrap();
}

fn recording(directory: &Path, rate: u32) -> Recording {
    let file = directory.join("ride.csv");
    write_ride(&file, rate);
    Recording::read(&file, &Conventions { fade_in: 1.0, ..Conventions::default() }).unwrap()
}

/// Every digit of columns of the outputs, with the times.
fn write_columns<const N: usize>(
    file: &Path,
    names: [&str; N],
    simulation: &Simulation,
    values: impl Fn(&Output) -> [f64; N],
) {
    let mut text = format!("time,{}\n", names.join(","));
    for (time, output) in simulation.times().iter().zip(&simulation.outputs) {
        let fields = values(output).map(|value| format!("{value:?}")).join(",");
        writeln!(text, "{time:?},{fields}").unwrap();
    }
    fs::write(file, text).unwrap();
}

fn judged(recording: &Recording, setup: &Setup, file: &Path) -> Outcome {
    let (motion, notes) = FeltTable::read(file).unwrap().motion(recording).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    Outcome::foreign(recording, setup, "other", &motion, notes).unwrap()
}

/// The largest difference of the measures, each relative to its size where that is above 1.
/// Measures that only the washout itself knows are left out.
fn difference(own: &Outcome, other: &Outcome) -> f64 {
    let (own, other) = (own.evaluated().rows(), other.evaluated().rows());
    assert_eq!(own.len(), other.len());
    let pairs = own.iter().zip(&other).filter(|(_, other)| other.value.is_some() || other.subject != "platform");
    pairs
        .map(|(own, other)| match (own.value, other.value) {
            (Some(own), Some(other)) => (own - other).abs() / own.abs().max(1.0),
            (own, other) => f64::from(own != other) * f64::INFINITY.min(1e9),
        })
        .fold(0.0, f64::max)
}

#[test]
fn a_felt_force_as_csv_has_the_measures_of_the_simulation_it_came_from() {
    let directory = tempfile::tempdir().unwrap();
    let recording = recording(directory.path(), 1000);
    let setup = Setup::load(None, &[]).unwrap();
    let own = Outcome::of(&recording, &setup, None, || ()).unwrap();
    let file = directory.path().join("felt.csv");
    let names = ["ax [g]", "ay [g]", "az [g]", "wx [deg/s]", "wy [deg/s]", "wz [deg/s]"];
    write_columns(&file, names, &own.simulation, |output| {
        let [force, rate] = [output.felt_specific_force / 9.80665, output.felt_angular_velocity.map(f64::to_degrees)];
        [force.x, force.y, force.z, rate.x, rate.y, rate.z]
    });
    let other = judged(&recording, &setup, &file);
    let found = difference(&own, &other);
    assert!(found < 1e-9, "{found}");
    assert!(other.evaluated().findings()[0].text.starts_with("The rig's limits are not judged"));
}

#[test]
fn poses_and_legs_have_the_felt_forces_and_the_limits() {
    let directory = tempfile::tempdir().unwrap();
    let recording = recording(directory.path(), 1000);
    // A plan's acceleration bends 50 times a second, where differences are off.
    let setup = Setup::load(None, &["classical".to_owned()]).unwrap();
    let own = Outcome::of(&recording, &setup, None, || ()).unwrap();
    let file = directory.path().join("pose.csv");
    let names = ["x [mm]", "y [mm]", "z [mm]", "roll [deg]", "pitch [deg]", "yaw [deg]"];
    write_columns(&file, names, &own.simulation, |output| {
        let [p, a] = [1000.0 * output.position, output.orientation.to_vector().map(f64::to_degrees)];
        [p.x, p.y, p.z, a.x, a.y, a.z]
    });
    let of_pose = judged(&recording, &setup, &file);
    let names = ["leg1", "leg2", "leg3", "leg4", "leg5", "leg6"];
    write_columns(&file, names, &own.simulation, |output| output.length);
    let of_legs = judged(&recording, &setup, &file);
    for other in [of_pose, of_legs] {
        // Differences over 1 ms; where the ride's force changes its slope, at 4 s, four samples are off.
        let outputs = own.simulation.outputs.iter().zip(&other.simulation.outputs);
        let off = outputs.map(|(own, other)| (own.felt_specific_force - other.felt_specific_force).amax());
        assert!(off.fold(0.0, f64::max) < 1e-4);
        for (own, other) in [(&own.measures.force, &other.measures.force), (&own.measures.rate, &other.measures.rate)] {
            for (own, other) in own.iter().zip(other).filter_map(|(own, other)| own.as_ref().zip(other.as_ref())) {
                assert!((own.rms_error - other.rms_error).abs() < 1e-6, "{} {}", own.rms_error, other.rms_error);
            }
        }
        let [own, other] = [&own, &other].map(|outcome| outcome.measures.effort);
        assert!((own.stroke_used - other.stroke_used).abs() < 1e-6 && other.limited.actuator == 0.0, "{other:?}");
    }
}

#[test]
fn finer_poses_are_judged_within_steps_and_beyond_the_rig() {
    let directory = tempfile::tempdir().unwrap();
    let recording = recording(directory.path(), 100);
    let setup = Setup::load(None, &[]).unwrap();
    let samples = recording.inputs().len();
    // A heave of 0.4 m with 0.2 Hz: its acceleration and its legs follow by hand.
    let (size, omega) = (0.4, 1.2566);
    let pose = |k: usize| [0.0, 0.0, 1.091 + size * (omega * 0.002 * k as f64).sin(), 0.0, 0.0, 0.0];
    let motion =
        ForeignMotion { pose: Some((0..5 * (samples - 1) + 1).map(pose).collect()), ..ForeignMotion::default() };
    let outcome = Outcome::foreign(&recording, &setup, "heave", &motion, Vec::new()).unwrap();
    for (k, output) in outcome.simulation.outputs.iter().enumerate() {
        let expected = 9.80665 - size * omega * omega * (omega * 0.01 * k as f64).sin();
        assert!((output.felt_specific_force.z - expected).abs() < 1e-8, "{k}");
    }
    assert_eq!(outcome.simulation.felt_within_steps.len(), 5 * (samples - 1) + 1);
    let finding = &outcome.evaluated().findings()[0].text;
    assert!(finding.starts_with("The motion exceeds the rig for") && finding.contains("long at"), "{finding}");
    assert!(outcome.measures.effort.limited.actuator > 0.1 && outcome.measures.effort.smallest_margin < 0.0);
}

#[test]
fn wrong_units_signs_and_rates_are_said() {
    let directory = tempfile::tempdir().unwrap();
    let recording = recording(directory.path(), 100);
    let setup = Setup::load(None, &[]).unwrap();
    let own = Outcome::of(&recording, &setup, None, || ()).unwrap();
    let forces = |change: fn([f64; 3]) -> [f64; 3]| {
        own.simulation.outputs.iter().map(|output| change(output.felt_specific_force.into())).collect::<Vec<_>>()
    };
    let findings = |force: Vec<[f64; 3]>| {
        let motion = ForeignMotion { force: Some(force), ..ForeignMotion::default() };
        let outcome = Outcome::foreign(&recording, &setup, "other", &motion, Vec::new()).unwrap();
        outcome.evaluated().findings().into_iter().map(|finding| finding.text).collect::<Vec<_>>().join("\n")
    };
    let said = |change: fn([f64; 3]) -> [f64; 3], text: &str| {
        let findings = findings(forces(change));
        assert!(findings.contains(text), "{findings}");
    };
    said(|force| force.map(|value| value / 9.80665), "9.8 times too small");
    said(|[x, y, z]| [x / 9.80665, y, z], "Surge is felt 9.8 times too small");
    said(|[x, y, z]| [x, y, z - 9.80665], "lacks gravity's reaction");
    said(|force| force.map(|value| -value), "The felt force has the wrong sign");
    said(|[x, y, z]| [x, -y, z], "Sway is felt with the wrong sign");
    // The desired force, so much later or earlier, beyond the 2 s within which delays are measured.
    let inputs = recording.inputs();
    for (shift, text) in [
        (-250, "Surge is felt 2.50 s later than desired"),
        (250, "Surge is felt 2.50 s earlier than desired"),
        (-150, "!later"),
    ] {
        let at = |k: usize| (k as isize + shift).clamp(0, inputs.len() as isize - 1) as usize;
        let late = findings((0..inputs.len()).map(|k| inputs[at(k)].specific_force.into()).collect());
        assert!(text.strip_prefix('!').map_or(late.contains(text), |text| !late.contains(text)), "{late}");
    }
    // The verdict asks for no other scale where the reading is in doubt.
    let headline = |change: fn([f64; 3]) -> [f64; 3]| {
        let motion = ForeignMotion { force: Some(forces(change)), ..ForeignMotion::default() };
        let outcome = Outcome::foreign(&recording, &setup, "other", &motion, Vec::new()).unwrap();
        outcome.evaluated().verdict().text
    };
    for change in [|[x, y, z]: [f64; 3]| [x / 9.80665, y / 9.80665, z / 9.80665], |[x, y, z]: [f64; 3]| [-x, -y, z]] {
        let text = headline(change);
        assert!(text.contains("may be wrong") && !text.contains("scale"), "{text}");
    }
    let right = findings(forces(|force| force));
    let is_said = |text: &&str| right.contains(text);
    assert!(!["wrong sign", "too small", "exchanged", "later"].iter().any(is_said), "{right}");

    let error = |motion: ForeignMotion| {
        let inputs = recording.inputs();
        motion.simulation(inputs, 0.01, &setup.parameters, Vec::new()).unwrap_err().to_string()
    };
    let none = ForeignMotion::default;
    assert_eq!(error(none()), "nothing to judge is given; give felt_force, pose or legs");
    let short = error(ForeignMotion { force: Some(forces(|force| force)[..500].to_vec()), ..none() });
    assert!(
        short.contains("felt_force has 500 rows, but the recording has 1201 samples") && short.contains("n · 1200 + 1")
    );
    let of_poses = |pose: [f64; 6]| error(ForeignMotion { pose: Some(vec![pose; 1201]), ..none() });
    assert!(of_poses([0.0, 0.0, 1091.0, 0.0, 0.0, 0.0]).contains("as in mm"));
    assert!(of_poses([0.0; 6]).contains("add 1.091"));
    assert!(of_poses([0.0, 0.0, 1.091, 0.0, 3.0, 0.0]).contains("as in degrees"));
    assert!(of_poses([0.0, 0.0, f64::NAN, 0.0, 0.0, 0.0]).contains("pose[0] holds NaN"));
    // Strokes from the retracted leg of 1 m, and from neutral, where the default rig's are 1.300 m long.
    for (legs, remedy) in [
        ([0.1, 0.5, 0.1, 0.1, 0.1, 0.1], "strokes from the retracted leg: add 1.000 m to each"),
        ([0.1, -0.2, 0.1, 0.1, 0.1, 0.1], "strokes from neutral: add 1.300 m to each"),
        ([1000.0, 1600.0, 1300.0, 1300.0, 1300.0, 1300.0], "check the unit (m)"),
    ] {
        let refused = error(ForeignMotion { legs: Some(vec![legs; 1201]), ..none() });
        assert!(refused.contains(remedy), "{refused}");
    }
    // Poses with four decimals, 100 a second.
    let pose = |k: usize| [1e-4 * (1000.0 * (0.01 * k as f64).sin()).round(), 0.0, 1.091, 0.0, 0.0, 0.0];
    let motion = ForeignMotion { pose: Some((0..1201).map(pose).collect()), ..none() };
    let outcome = Outcome::foreign(&recording, &setup, "other", &motion, Vec::new()).unwrap();
    assert!(outcome.evaluated().findings()[1].text.starts_with("The poses have 4 decimals"));
}

#[test]
fn exchanged_axes_are_said_of_forces_and_of_poses() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("ride.csv");
    let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for k in 0..=2400 {
        let t = 0.01 * f64::from(k);
        let sines = |first: f64, second: f64| 0.3 * ((first * t).sin() + (second * t).sin());
        writeln!(text, "{t},{},{},9.80665,0,0,0", sines(2.3, 4.1), sines(3.1, 5.3)).unwrap();
    }
    fs::write(&file, text).unwrap();
    let recording = Recording::read(&file, &Conventions { fade_in: 1.0, ..Conventions::default() }).unwrap();
    let setup = Setup::load(None, &[]).unwrap();
    let own = Outcome::of(&recording, &setup, None, || ()).unwrap();
    let force = |of: fn([f64; 3]) -> [f64; 3]| {
        let felt = own.simulation.outputs.iter().map(|output| of(output.felt_specific_force.into()));
        ForeignMotion { force: Some(felt.collect()), ..ForeignMotion::default() }
    };
    let pose = |is_exchanged: bool| {
        let of = |output: &Output| {
            let (p, a) = (output.position, output.orientation);
            let [x, y] = if is_exchanged { [p.y, p.x] } else { [p.x, p.y] };
            [x, y, p.z, a.roll, a.pitch, a.yaw]
        };
        let pose = own.simulation.outputs.iter().map(of).collect();
        ForeignMotion { pose: Some(pose), ..ForeignMotion::default() }
    };
    for (motion, signal) in [
        (force(|[x, y, z]| [y, x, z]), "felt force"),
        (force(|[x, y, z]| [-y, x, z]), "felt force"),
        (pose(true), "platform's acceleration"),
        (force(|force| force), ""),
        (pose(false), ""),
    ] {
        let outcome = Outcome::foreign(&recording, &setup, "other", &motion, Vec::new()).unwrap();
        let text: String = outcome.evaluated().findings().into_iter().map(|finding| finding.text).collect();
        let said = format!("Surge and sway are exchanged: the {signal} along y goes with");
        assert!(if signal.is_empty() { !text.contains("exchanged") } else { text.contains(&said) }, "{signal}: {text}");
    }
}

#[test]
fn a_motion_stands_beside_our_strategies_in_one_report() {
    let directory = tempfile::tempdir().unwrap();
    write_ride(&directory.path().join("ride.csv"), 50);
    let moris = |arguments: &[&str]| {
        let output =
            Command::new(env!("CARGO_BIN_EXE_moris")).args(arguments).current_dir(directory.path()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, ..) = moris(&["simulate", "ride.csv", "--no-bound", "--report", "one"]);
    assert_eq!(code, Some(0));
    // The table of outputs is such a motion.
    fs::copy(directory.path().join("one/ride.outputs.csv"), directory.path().join("theirs.csv")).unwrap();
    let arguments =
        ["simulate", "ride.csv", "--no-bound", "--compare", "optimal", "--felt", "theirs.csv", "--report", "two"];
    let (code, printed, error) = moris(&arguments);
    assert_eq!(code, Some(0), "{error}");
    assert!(printed.contains("motion theirs:") && printed.contains("The motion stays within the rig"), "{printed}");
    let tables: Vec<&str> = printed.split("felt against desired").collect();
    // Six decimals: the same but for the comfort within steps, which samples do not have.
    let errors = |table: &str| {
        let rows = table.lines().skip(1).take_while(|line| line.starts_with("  "));
        rows.map(|line| line.split_whitespace().take(4).map(str::to_owned).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    assert_eq!((tables.len(), errors(tables[1]).len()), (4, 6), "{printed}");
    assert_eq!(errors(tables[1]), errors(tables[3]));
    let page = fs::read_to_string(directory.path().join("two/ride.html")).unwrap();
    assert!(page.contains("default, optimal, theirs"));

    fs::write(directory.path().join("bare.csv"), "time,a,b\n0,1,2\n1,1,2\n").unwrap();
    let (code, _, error) = moris(&["simulate", "ride.csv", "--no-bound", "--felt", "bare.csv"]);
    assert_eq!(code, Some(1));
    assert!(
        error.contains("bare.csv: there are no columns rider.specificForce.x to")
            && error.contains("there are time, a, b")
    );
    let (_, _, error) = moris(&["simulate", "ride.csv", "theirs.csv", "--no-bound", "--felt", "bare.csv"]);
    assert!(error.contains("--felt bare.csv is the motion for one recording"), "{error}");
    // A folder has a file for each recording.
    fs::create_dir(directory.path().join("mpc")).unwrap();
    for name in ["ride.csv", "theirs.csv"] {
        fs::copy(directory.path().join("one/ride.outputs.csv"), directory.path().join("mpc").join(name)).unwrap();
    }
    fs::copy(directory.path().join("ride.csv"), directory.path().join("theirs.csv")).unwrap();
    let arguments = ["simulate", "ride.csv", "theirs.csv", "--no-bound", "--felt", "mpc", "--report", "three"];
    let (code, printed, error) = moris(&arguments);
    assert!(code == Some(0) && printed.matches("motion mpc:").count() == 2, "{error} {printed}");
}
