//! The commands, as a user runs them.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use moris_washout::nalgebra::Vector3;
use moris_washout::{Input, Parameters, Washout};

fn moris(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moris")).args(arguments).current_dir(directory).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn rigs() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../examples/rigs"))
}

/// The rig file of similar hexagons: the platform can turn about its axis freely.
fn singular_rig(directory: &Path) -> String {
    let text = fs::read_to_string(rigs().join("default.toml")).unwrap();
    let text = text.replace("[-52, 52, 68, 172, 188, 292]", "[-8, 8, 112, 128, 232, 248]").replace("1.091", "1.29");
    let file = directory.join("singular.toml");
    fs::write(&file, text).unwrap();
    file.display().to_string()
}

#[test]
fn published_rigs_with_cranks_are_sound_and_rods_have_a_thickness_of_their_own() {
    let directory = tempfile::tempdir().unwrap();
    for rig in ["crank-servo", "crank-hobby20", "crank-hobby25", "crank-stepper50", "crank-person"] {
        let output = moris(directory.path(), &["rig", "check", rig, "--samples", "1000"]);
        assert!(output.status.success(), "{rig}: {}", text(&output.stdout));
    }
    // 3 % of a rod of 155 mm.
    let file = fs::read_to_string(rigs().join("crank-hobby25.toml")).unwrap().replace("diameter = 0.004", "");
    fs::write(directory.path().join("mine.toml"), file).unwrap();
    let printed = text(&moris(directory.path(), &["rig", "check", "mine.toml", "--samples", "1000"]).stdout);
    assert!(printed.contains("rods are taken as 0.005 m thick (assumed; crank.diameter"), "{printed}");
}

/// A ride of 4 s: accelerate gently, with some roll.
fn recording() -> Vec<Input> {
    (0..=400)
        .map(|k| {
            let t = 0.01 * f64::from(k);
            let mut input = Input::default();
            input.specific_force += Vector3::new(0.2 * t, 0.0, 0.0);
            input.angular_velocity = Vector3::new(0.05 * t.sin(), 0.0, 0.0);
            input
        })
        .collect()
}

fn write_recording(directory: &Path, name: &str) {
    let mut text = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for (k, input) in recording().iter().enumerate() {
        let (f, w) = (input.specific_force, input.angular_velocity);
        writeln!(text, "{},{},{},{},{},{},{}", k as f64 / 100.0, f.x, f.y, f.z, w.x, w.y, w.z).unwrap();
    }
    fs::write(directory.join(name), text).unwrap();
}

#[test]
fn every_example_rig_passes_the_check_and_is_drawn() {
    let directory = tempfile::tempdir().unwrap();
    for name in ["default", "compact", "long-stroke", "narrow"] {
        let file = rigs().join(format!("{name}.toml")).display().to_string();
        let output = moris(directory.path(), &["rig", "check", &file, "--samples", "20000", "--report", "out"]);
        assert!(output.status.success(), "{name}: {}", text(&output.stderr));
        assert!(text(&output.stdout).contains("free of singularities"));
        let picture = fs::read_to_string(directory.path().join(format!("out/{name}.svg"))).unwrap();
        assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
    }
}

#[test]
fn legs_that_cross_or_are_too_thick_fail_the_check_and_are_drawn() {
    let directory = tempfile::tempdir().unwrap();
    let default = fs::read_to_string(rigs().join("default.toml")).unwrap();
    let changed = |from: &str, to: &str| {
        assert!(default.contains(from));
        fs::write(directory.path().join("mine.toml"), default.replace(from, to)).unwrap();
        let output = moris(directory.path(), &["rig", "check", "mine.toml", "--samples", "2000"]);
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let (code, printed, _) = changed("[-52, 52, 68,", "[52, -52, 68,");
    assert_eq!(code, Some(1), "{printed}");
    assert!(printed.contains("LEGS COLLIDE") && printed.contains("legs 1 and 2 come within 0.00"), "{printed}");
    assert!(printed.contains("free of singularities"), "{printed}");
    let picture = fs::read_to_string(directory.path().join("moris-report/mine.svg")).unwrap();
    assert!(picture.contains("LEGS COLLIDE") && picture.contains("Legs 1 and 2 where they are closest"), "{picture}");

    let (code, printed, _) = changed("accelerationLimit = 15.0", "accelerationLimit = 15.0\ndiameter = 0.12");
    assert_eq!(code, Some(0), "{printed}");
    assert!(printed.contains("no legs touch") && printed.contains("taken as 0.120 m thick\n"), "{printed}");
    let (code, printed, _) = changed("accelerationLimit = 15.0", "accelerationLimit = 15.0\ndiameter = 0.3");
    assert_eq!(code, Some(1), "{printed}");
    let (code, _, error) = changed("accelerationLimit = 15.0", "accelerationLimit = 15.0\ndiameter = 120");
    assert_eq!(code, Some(1));
    assert!(error.contains("actuator.diameter") && error.contains("is 120 m"), "{error}");
}

/// A note, as real machines may be so.
#[test]
fn exchanged_circles_and_an_acceleration_in_g_are_asked_for_by_the_check() {
    let directory = tempfile::tempdir().unwrap();
    let default = fs::read_to_string(rigs().join("default.toml")).unwrap();
    for (changes, expected) in [
        (
            &[("radius = 1.0 ", "radius = 0.5 "), ("radius = 0.85", "radius = 1.0")][..],
            "are [base] and [platform] exchanged?",
        ),
        (&[("accelerationLimit = 15.0", "accelerationLimit = 0.5")], "if the limit is in g, give 4.9 m/s2"),
    ] {
        let rig = changes.iter().fold(default.clone(), |rig, (from, to)| rig.replacen(from, to, 1));
        fs::write(directory.path().join("mine.toml"), rig).unwrap();
        let output = moris(directory.path(), &["rig", "check", "mine.toml", "--samples", "2000"]);
        let printed = text(&output.stdout);
        assert!(printed.contains(expected), "{printed}{}", text(&output.stderr));
    }
}

#[test]
fn a_safety_limit_beyond_the_reach_is_told_by_check_and_simulation_in_the_same_words() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    let default = fs::read_to_string(rigs().join("default.toml")).unwrap();
    fs::write(directory.path().join("mine.toml"), default.replace("0.37, 0.33]", "0.37, 0.4]")).unwrap();
    let doubt = "safety.z.positionLimit is 0.4 m, but in heave the rig reaches only 0.344 m from neutral";
    let check = moris(directory.path(), &["rig", "check", "mine.toml", "--samples", "2000"]);
    assert!(check.status.success() && text(&check.stdout).contains(doubt), "{}", text(&check.stdout));
    let ride = moris(directory.path(), &["simulate", "ride.csv", "--rig", "mine.toml", "--no-bound"]);
    assert!(ride.status.success() && text(&ride.stdout).contains(doubt), "{}", text(&ride.stdout));
}

#[test]
fn a_singular_rig_fails_the_check_with_its_leg_lengths_and_is_drawn_all_the_same() {
    let directory = tempfile::tempdir().unwrap();
    let file = singular_rig(directory.path());
    let output = moris(directory.path(), &["rig", "check", &file, "--samples", "20000"]);
    assert!(!output.status.success());
    let printed = text(&output.stdout);
    let lengths = printed.split("lengths of\n").nth(1).unwrap().lines().next().unwrap();
    let lengths: Vec<f64> = lengths.trim().trim_end_matches(" m").split(", ").map(|l| l.parse().unwrap()).collect();
    assert!(lengths.len() == 6 && lengths.iter().all(|length| (1.0..=1.6).contains(length)), "{printed}");
    assert!(directory.path().join("moris-report/singular.svg").exists());
    // Legs that do not hold the yaw set it no speed.
    let yaw = printed.lines().find(|line| line.trim_start().starts_with("yaw")).unwrap();
    assert_eq!(yaw.matches("singular").count(), 2, "{printed}");
    let digits = |word: &str| word.chars().filter(char::is_ascii_digit).count();
    assert!(printed.split_whitespace().all(|word| digits(word) < 8), "{printed}");
}

#[test]
fn a_run_leaves_the_crate_s_outputs_and_a_page() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    let output = moris(directory.path(), &["simulate", "ride.csv", "--report", "out", "--fade-in", "0"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    assert!(printed.contains("The recording fits the rig") && printed.contains("force x"), "{printed}");

    // The table against the crate, stepped here.
    let mut parameters = Parameters::default();
    parameters.conditioning.angular_velocity_frame = moris_washout::interface::AngularVelocityFrame::Body;
    let mut washout = Washout::new(&parameters).unwrap();
    let inputs = recording();
    let mut table = csv::Reader::from_path(directory.path().join("out/ride.outputs.csv")).unwrap();
    let column = |name: &str, table: &mut csv::Reader<fs::File>| {
        table.headers().unwrap().iter().position(|header| header == name).unwrap_or_else(|| panic!("{name}"))
    };
    let (time, leg, felt, flag) = (
        column("time", &mut table),
        column("actuator[4].length", &mut table),
        column("rider.specificForce.x", &mut table),
        column("status.safetyActive", &mut table),
    );
    for (k, record) in table.records().enumerate() {
        let record = record.unwrap();
        if k > 0 {
            washout.step_between(&inputs[k - 1], &inputs[k], 0.01);
        }
        let expected = washout.output();
        let number = |place: usize| record[place].parse::<f64>().unwrap();
        assert!((number(time) - 0.01 * k as f64).abs() < 1e-6);
        assert!((number(leg) - expected.length[3]).abs() < 1e-6, "sample {k}");
        assert!((number(felt) - expected.felt_specific_force.x).abs() < 1e-6, "sample {k}");
        assert_eq!(&record[flag], "0");
    }
    let page = fs::read_to_string(directory.path().join("out/ride.html")).unwrap();
    assert!(page.to_lowercase().starts_with("<!doctype html>") && page.contains("</script>"));
}

#[test]
fn runs_with_other_parameters_stand_beside_the_first() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    let narrow = rigs().join("narrow.toml").display().to_string();
    let output = moris(directory.path(), &["simulate", "ride.csv", "--rig", &narrow, "--compare", "paper"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    assert!(
        printed.contains("Narrow mock-up, 0.45 m stroke, parameters default:") && printed.contains("parameters paper:"),
        "{printed}"
    );
    assert!(text(&output.stderr).contains("ride: reading\nride: simulating\n"), "{}", text(&output.stderr));
    for file in ["ride.outputs.csv", "ride.paper.outputs.csv", "ride.html"] {
        assert!(directory.path().join("moris-report").join(file).exists(), "{file}");
    }
}

#[test]
fn a_recording_in_the_report_s_directory_is_left_as_it_is() {
    let directory = tempfile::tempdir().unwrap();
    fs::create_dir(directory.path().join("moris-report")).unwrap();
    write_recording(directory.path(), "moris-report/ride.csv");
    let before = fs::read(directory.path().join("moris-report/ride.csv")).unwrap();
    let output = moris(directory.path(), &["simulate", "moris-report/ride.csv", "--no-bound"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(fs::read(directory.path().join("moris-report/ride.csv")).unwrap(), before);
}

#[test]
fn what_would_be_written_into_one_file_is_refused_before_anything_is_ridden() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::create_dir(here.join("other")).unwrap();
    for name in ["ride.csv", "other/ride.csv", "ride.outputs.csv"] {
        write_recording(here, name);
    }
    for arguments in [
        &["simulate", "ride.csv", "other/ride.csv"][..],
        &["simulate", "ride.csv", "--compare", "paper", "--compare", "paper"],
        &["simulate", "ride.csv", "ride.outputs.csv"],
    ] {
        let output = moris(here, arguments);
        assert!(!output.status.success(), "{arguments:?}");
        let printed = text(&output.stderr);
        assert!(printed.contains("outputs.csv") && printed.contains("rename"), "{printed}");
        assert!(!here.join("moris-report").exists());
    }
}

#[test]
fn errors_say_what_to_do_and_fail() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    let failure = |arguments: &[&str]| {
        let output = moris(directory.path(), arguments);
        assert!(!output.status.success(), "{arguments:?}");
        text(&output.stderr)
    };
    assert!(failure(&["simulate", "ride.csv", "--parameters", "papr"]).contains("did you mean paper?"));
    assert!(failure(&["simulate", "missing.csv"]).contains("cannot read missing.csv"));
    assert!(failure(&["simulate", "ride.csv", "--columns", "ax=acc"]).contains("--columns ax=NAME"));
    assert!(failure(&["simulate", "ride.csv", "--columns", "bx=acc"]).contains("there is no key bx"));
    assert!(
        failure(&["simulate", "ride.csv", "--resample", "0"]).contains("resample is 0, but must be from 1 to 10000")
    );
    let singular = singular_rig(directory.path());
    assert!(failure(&["simulate", "ride.csv", "--rig", &singular]).contains("singular inside the stroke"));
}

#[test]
fn parameters_print_a_file_that_reads_back() {
    let directory = tempfile::tempdir().unwrap();
    let output = moris(directory.path(), &["parameters", "--parameters", "paper"]);
    assert!(output.status.success());
    fs::write(directory.path().join("all.toml"), &output.stdout).unwrap();
    let changed = |set: &str| {
        let output = moris(directory.path(), &["parameters", "--changed", "--parameters", set]);
        text(&output.stdout).lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n")
    };
    assert!(changed("paper").contains("\"splitter.x.omega1\" = 2.5"));
    assert_eq!(changed("all.toml"), changed("paper"));
}

#[test]
fn the_names_of_version_0_1_are_hidden_aliases() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    let printed = |arguments: &[&str]| {
        let output = moris(directory.path(), arguments);
        assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
        text(&output.stdout)
    };
    let new = printed(&["simulate", "ride.csv", "--no-bound", "--compare", "robust"]);
    assert_eq!(printed(&["run", "ride.csv", "--no-bound", "--against", "robust"]), new);
    let help = printed(&["--help"]);
    assert!(help.contains("simulate") && help.contains("frequency-response"), "{help}");
    assert!(!help.contains("  run") && !help.contains("  respond"), "{help}");
    assert_eq!(printed(&["respond", "--help"]), printed(&["frequency-response", "--help"]));
}

#[test]
fn one_recording_that_cannot_be_read_does_not_end_the_others() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    fs::write(directory.path().join("broken.csv"), "time,ax\n0,1\n").unwrap();
    let recordings = ["missing.csv", "broken.csv", "ride.csv"];
    let options = ["--no-bound", "--strategy", "predictive", "--preview", "1"];
    let output = moris(directory.path(), &[&["simulate"], &recordings[..], &options].concat());
    assert_eq!(output.status.code(), Some(1));
    let printed = text(&output.stderr);
    let errors: Vec<&str> = printed.lines().filter(|line| line.starts_with("error")).collect();
    assert_eq!(errors.len(), 2, "{printed}");
    assert!(errors[0].contains("cannot read missing.csv") && errors[1].matches("broken.csv").count() == 1, "{printed}");
    assert!(text(&output.stdout).contains("The recording fits the rig"));
    // The list has all of them: failures with their reason, and a row for each set of the others.
    let index = fs::read_to_string(directory.path().join("moris-report/index.html")).unwrap();
    assert!(index.contains("<title>3 recordings, the worst first</title>"), "{index}");
    assert!(index.contains("missing</th><td class=\"verdict\">cannot read missing.csv"), "{index}");
    assert!(index.contains("ride, predictive</a></th><td class=\"verdict\">Felt the right way round, at "), "{index}");
    assert!(index.contains("ride, &quot;predictive, preview of 1 s&quot;</a>"), "{index}");
    assert_eq!(index.matches("href=\"./ride.html\"").count(), 2);
}

#[test]
fn every_command_has_the_same_exit_statuses() {
    let directory = tempfile::tempdir().unwrap();
    let status = |arguments: &[&str]| moris(directory.path(), arguments).status.code();
    for command in ["simulate", "measure", "tune", "frequency-response", "parameters", "schema", "man"] {
        assert_eq!(status(&[command, "--no-such-option"]), Some(2), "{command}");
        assert_eq!(status(&[command, "--help"]), Some(0), "{command}");
    }
    for command in ["simulate", "measure", "tune"] {
        assert_eq!(status(&[command, "missing.csv"]), Some(1), "{command}");
    }
    for arguments in [&["rig", "check", "missing.toml"][..], &["frequency-response", "--rig", "missing.toml"]] {
        assert_eq!(status(arguments), Some(1), "{arguments:?}");
    }
    // What simulate alone can do names the other way.
    let refused = text(&moris(directory.path(), &["frequency-response", "--washout", "other.fmu"]).stderr);
    assert!(refused.contains("give these with --measured FILES"), "{refused}");
    let version = text(&moris(directory.path(), &["--version"]).stdout);
    assert!(version.starts_with(concat!("moris ", env!("CARGO_PKG_VERSION"))), "{version}");
}

#[test]
fn a_rig_with_numbers_that_cannot_be_fails_the_check_with_field_and_file() {
    let directory = tempfile::tempdir().unwrap();
    let rig = fs::read_to_string(rigs().join("default.toml")).unwrap();
    for (field, changed, expected) in [
        ("neutralHeight = 1.091", "neutralHeight = nan", "neutralHeight is NaN, but must be a finite number"),
        ("radius = 0.85", "radius = inf", "platform.radius is inf, but must be a finite number"),
        // Infinite legs reach neutral: the check must not go on to look for singularities.
        ("maxLength = 1.6", "maxLength = 1e308", "actuator.maxLength: is 1e308, but must be from 0.001 to 100"),
    ] {
        fs::write(directory.path().join("mine.toml"), rig.replace(field, changed)).unwrap();
        let output = moris(directory.path(), &["rig", "check", "mine.toml"]);
        let message = text(&output.stderr);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{changed}");
        assert!(message.contains("mine.toml: ") && message.contains(expected), "{changed}: {message}");
    }
}

#[test]
fn a_negative_time_to_fade_in_has_the_range_as_its_error() {
    let directory = tempfile::tempdir().unwrap();
    let output = moris(directory.path(), &["simulate", "ride.csv", "--fade-in", "-1"]);
    let message = text(&output.stderr);
    assert!(message.contains("fade-in is -1, but must be from 0 to 1000 seconds"), "{message}");
}

#[cfg(unix)]
#[test]
fn a_source_that_is_no_recording_and_has_no_end_is_an_error() {
    let directory = tempfile::tempdir().unwrap();
    let output = moris(directory.path(), &["simulate", "/dev/zero"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("/dev/zero: is no text but a binary file"), "{}", text(&output.stderr));
}

/// A recording that the platform cannot follow: swings of 8 m/s2 in surge and heave. Without soft
/// limits, which `hard.toml` switches off, the actuator guard stops it at once.
fn write_rough_recording(directory: &Path) {
    let mut rough = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for k in 0..400 {
        let t = f64::from(k) / 100.0;
        writeln!(rough, "{t},{},0,{},0,0,0", 8.0 * (3.0 * t).sin(), 9.80665 + 8.0 * (5.0 * t).sin()).unwrap();
    }
    fs::write(directory.join("rough.csv"), rough).unwrap();
    fs::write(directory.join("hard.toml"), "softLimit.pace = 0.0\n").unwrap();
}

/// A smooth and a rough recording on a narrow rig without soft limits, as JSON.
fn simulate_smooth_and_rough(directory: &Path) -> Output {
    write_recording(directory, "ride.csv");
    write_rough_recording(directory);
    let narrow = rigs().join("narrow.toml").display().to_string();
    let arguments = ["simulate", "ride.csv", "rough.csv", "--rig", &narrow, "--parameters", "hard.toml"];
    moris(directory, &[&arguments[..], &["--no-bound", "--json"]].concat())
}

#[test]
fn a_felt_jolt_is_found_directly_after_the_limits() {
    let directory = tempfile::tempdir().unwrap();
    let output = simulate_smooth_and_rough(directory.path());
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let findings = |recording: &serde_json::Value| -> Vec<String> {
        let findings = recording["results"][0]["findings"].as_array().unwrap();
        findings.iter().map(|finding| finding.as_str().unwrap_or_else(|| panic!("{finding}")).to_owned()).collect()
    };
    let comfort = |text: &&String| [" shakes by ", " jolts by ", " peaks "].iter().any(|word| text.contains(word));
    let (smooth, rough) = (findings(&all[0]), findings(&all[1]));
    assert_eq!(smooth.iter().filter(comfort).count(), 0, "{smooth:?}");
    assert!(rough[0].starts_with("The recording does not fit the rig."), "{rough:?}");
    assert!(rough.iter().any(|text| text.contains(" jolts by ")), "{rough:?}");
    let count = rough.iter().filter(comfort).count();
    assert!(rough[1..=count].iter().all(|text| comfort(&text)), "{rough:?}");
}

/// The last finding has the shares of the measures, of which the vehicle's is large here.
#[test]
fn motion_sickness_is_the_last_finding() {
    let directory = tempfile::tempdir().unwrap();
    let output = simulate_smooth_and_rough(directory.path());
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rough = &all[1]["results"][0];
    let share = |name: &str| {
        let measures = rough["measures"].as_array().unwrap();
        measures.iter().find(|measure| measure["name"] == name).unwrap()["value"].as_f64().unwrap()
    };
    let [vehicle, platform] = ["sick in the vehicle", "sick on the platform"].map(share);
    assert!(vehicle > 10.0, "{vehicle}");
    let finding = rough["findings"].as_array().unwrap().last().unwrap().as_str().unwrap();
    for part in ["Motion sickness: ", &format!(" makes {vehicle:.0} % "), &format!(" motion {platform:.0} % ")] {
        assert!(finding.contains(part), "{finding}");
    }
}

/// Noise makes the tilt lag in nearly every step, and no limit of it matters.
#[test]
fn noise_does_not_count_as_limited_tilt() {
    let directory = tempfile::tempdir().unwrap();
    let mut noisy = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    let mut state = 1u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.02 * ((state >> 33) as f64 / 2f64.powi(31) - 0.5)
    };
    for k in 0..2000 {
        let [x, y, z] = [noise(), noise(), 9.80665 + noise()];
        writeln!(noisy, "{},{x},{y},{z},0,0,0", f64::from(k) / 100.0).unwrap();
    }
    fs::write(directory.path().join("noise.csv"), noisy).unwrap();
    let output = moris(directory.path(), &["simulate", "noise.csv", "--strategy", "classical", "--no-bound", "--json"]);
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let result = &all[0]["results"][0];
    assert_eq!(
        (result["findings"].as_array().unwrap().len(), &result["betterThanRest"]),
        (1, &true.into()),
        "{result}"
    );
    let limited = result["measures"].as_array().unwrap().iter().find(|one| one["name"] == "tilt limited").unwrap();
    assert!(limited["value"].as_f64().unwrap() < 1.0, "{limited}");
    let table = directory.path().join("moris-report/noise.outputs.csv");
    let mut table = csv::Reader::from_path(table).unwrap();
    let column = table.headers().unwrap().iter().position(|name| name == "status.tiltLimited").unwrap();
    let lags = table.records().filter(|row| &row.as_ref().unwrap()[column] == "1").count();
    assert!(lags > 1000, "{lags}");
}

/// Soft limits keep the hard ones from acting. The finding's times are those of the table.
#[test]
fn soft_limits_are_named_with_their_times_and_their_cost() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    write_rough_recording(directory.path());
    let narrow = rigs().join("narrow.toml").display().to_string();
    let output =
        moris(directory.path(), &["simulate", "ride.csv", "rough.csv", "--rig", &narrow, "--no-bound", "--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let result = |recording: usize| &all[recording]["results"][0];
    assert_eq!((&result(0)["fits"], &result(1)["fits"]), (&true.into(), &true.into()));
    let smooth = result(0)["findings"][0].as_str().unwrap();
    assert!(smooth.starts_with("The recording fits the rig: ") && !smooth.contains("oft limits"), "{smooth}");

    let table = directory.path().join("moris-report/rough.outputs.csv");
    let mut table = csv::Reader::from_path(table).unwrap();
    let column = table.headers().unwrap().iter().position(|name| name == "status.softLimited").unwrap();
    let flags: Vec<bool> = table.records().map(|row| &row.unwrap()[column] == "1").collect();
    let (first, steps) = (flags.iter().position(|flag| *flag).unwrap(), flags.len() - 1);
    let count = flags.iter().filter(|flag| **flag).count();
    let fraction = 100.0 * count as f64 / steps as f64;
    assert!((1.0..99.0).contains(&fraction), "{fraction}");
    let rough = result(1)["findings"][0].as_str().unwrap();
    for part in [
        "The recording stays within the rig by its soft limits alone. ",
        &format!(" for {:.2} s in all ({fraction:.1} %), ", 0.01 * count as f64),
        &format!(" {:.2} ", 0.01 * (first - 1) as f64),
        "Meanwhile the platform gave up part of the cue to stay within its stroke, speed and acceleration.",
    ] {
        assert!(rough.contains(part), "{part}: {rough}");
    }
    let measures = result(1)["measures"].as_array().unwrap();
    let soft = measures.iter().find(|row| row["name"] == "soft limits active").unwrap();
    assert!((soft["value"].as_f64().unwrap() - fraction).abs() < 1e-9 && soft["unit"] == "%", "{soft}");
}

#[test]
fn the_exit_status_and_the_json_say_whether_a_recording_fits() {
    let directory = tempfile::tempdir().unwrap();
    let output = simulate_smooth_and_rough(directory.path());
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(all[0]["recording"], "ride");
    assert_eq!((&all[0]["results"][0]["fits"], &all[1]["results"][0]["fits"]), (&true.into(), &false.into()));
    let measures = all[1]["results"][0]["measures"].as_array().unwrap();
    let peak = measures.iter().find(|row| row["subject"] == "specific force x" && row["name"] == "peak error").unwrap();
    assert!(peak["value"].as_f64().unwrap() > 0.0 && peak["unit"] == "m/s²");
    // Outputs, the recommended parameters, and the report.
    let files = all[1]["files"].as_array().unwrap();
    assert!(files.len() == 3 && files[1].as_str().unwrap().ends_with("rough.advice.toml"), "{files:?}");
    // The list has the one that does not fit first.
    let list = fs::read_to_string(directory.path().join("moris-report/index.html")).unwrap();
    let place = |link: &str| list.find(link).unwrap_or_else(|| panic!("{link} is not in {list}"));
    assert!(place("href=\"./rough.html\"") < place("href=\"./ride.html\""));
    fs::remove_file(directory.path().join("moris-report/index.html")).unwrap();
    assert_eq!(moris(directory.path(), &["simulate", "ride.csv"]).status.code(), Some(0));
    assert!(!directory.path().join("moris-report/index.html").exists(), "one recording needs no list");
}

#[test]
fn a_preview_is_simulated_beside_the_strategy_without_it() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    let simulate = |more: &[&str]| moris(directory.path(), &[&["simulate", "ride.csv"], more].concat());
    let output = simulate(&["--strategy", "predictive", "--preview", "1", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let results = all[0]["results"].as_array().unwrap();
    let names: Vec<&str> = results.iter().map(|result| result["parameters"].as_str().unwrap()).collect();
    assert_eq!(names, ["predictive", "predictive, preview of 1 s"]);
    let error = |result: &serde_json::Value| {
        let measures = result["measures"].as_array().unwrap();
        let is_surge = |row: &&serde_json::Value| row["subject"] == "specific force x" && row["name"] == "RMS error";
        measures.iter().find(is_surge).unwrap()["value"].as_f64().unwrap()
    };
    assert_ne!(error(&results[0]), error(&results[1]), "the preview changes the plan");
    // The bound is the same, and holds for both.
    assert_eq!(results[0]["forceBounds"], results[1]["forceBounds"]);
    assert!(results[0]["forceBounds"][0].as_f64().unwrap() <= error(&results[1]));
    assert!(directory.path().join("moris-report/ride.predictive-preview-of-1-s.outputs.csv").exists());

    let refused = simulate(&["--strategy", "classical", "--preview", "1"]);
    assert!(text(&refused.stderr).contains("--preview is for the predictive strategy alone"), "{refused:?}");
}

#[test]
fn every_strategy_stands_beside_the_first() {
    let directory = tempfile::tempdir().unwrap();
    write_recording(directory.path(), "ride.csv");
    let arguments = ["simulate", "ride.csv", "--no-bound", "--json", "--strategy", "robust", "--compare", "strategies"];
    let output = moris(directory.path(), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    for name in ["classical", "adaptive", "optimal", "predictive"] {
        assert!(directory.path().join(format!("moris-report/ride.{name}.outputs.csv")).exists(), "{name}");
    }
    assert!(!directory.path().join("moris-report/ride.robust.outputs.csv").exists());
}

/// A ride at 1 kHz: two sets are shown with every sample, five with the extremes of intervals.
#[test]
fn the_page_of_a_long_recording_has_its_largest_size() {
    let directory = tempfile::tempdir().unwrap();
    let seconds: u32 = crate::cases::cases(60, 45);
    let mut long = "time,ax,ay,az,wx,wy,wz\n".to_owned();
    for k in 0..seconds * 1000 {
        let t = f64::from(k) / 1000.0;
        // All digits, so that the inputs do not fit beside the curves.
        let blow = if k == 21_234 { 3.0 } else { 0.0 };
        writeln!(long, "{t:.3},{},{},{},0,0,0", blow + (0.6 * t).sin(), 0.5 * (0.9 * t).sin(), 9.80665).unwrap();
    }
    fs::write(directory.path().join("long.csv"), long).unwrap();
    fn curves(page: &str) -> &str {
        page.split_once("\"simulator\":").unwrap().0
    }
    let page = |sets: &[&str]| {
        let compared = sets.iter().flat_map(|set| ["--compare", set]);
        let arguments: Vec<&str> =
            ["simulate", "long.csv", "--no-bound", "--strategy", "classical"].into_iter().chain(compared).collect();
        let output = moris(directory.path(), &arguments);
        assert!(matches!(output.status.code(), Some(0 | 3)), "{}", text(&output.stderr));
        let page = fs::read_to_string(directory.path().join("moris-report/long.html")).unwrap();
        assert!(curves(&page).len() < 3_000_000 && page.len() <= 4_200_000, "{} bytes", page.len());
        page
    };
    if crate::cases::cases(true, false) {
        assert!(page(&["paper"]).contains("[\"Curves\",\"every sample\"]"), "the resolution is stated");
    }
    let thinned = page(&["adaptive", "optimal", "robust", "paper"]);
    let resolution = thinned.split("\"Curves\",\"").nth(1).unwrap().split(";").next().unwrap();
    let interval = resolution.strip_prefix("least and greatest value of every ").unwrap().strip_suffix(" ms").unwrap();
    let per_minute = interval.parse::<f64>().unwrap() * 60.0 / f64::from(seconds);
    assert!((4.0..=12.0).contains(&per_minute), "as much as fits, not {interval} ms");
    assert!(curves(&thinned).len() > 2_000_000, "as much as fits, not {} bytes", curves(&thinned).len());
    // The simulation takes what the curves leave, where it is compiled.
    let only_shows = thinned.contains("\"simulator\":null");
    assert!(only_shows || thinned.len() > 3_900_000, "as much as fits, not {} bytes", curves(&thinned).len());
}

#[test]
fn completions_and_man_pages_name_every_command() {
    let directory = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let output = moris(directory.path(), &["completions", shell]);
        let script = text(&output.stdout);
        for word in ["simulate", "frequency-response", "mounting"] {
            assert!(output.status.success() && script.contains(word), "{shell}: {word}");
        }
    }
    assert!(moris(directory.path(), &["man", "man1"]).status.success());
    for page in ["moris.1", "moris-simulate.1", "moris-rig-check.1"] {
        let text = fs::read_to_string(directory.path().join("man1").join(page)).unwrap();
        assert!(text.contains(".TH"), "{page}");
    }
}

/// The schemas know every key of the shipped files, and the parameters' ranges.
#[test]
fn schemas_describe_the_files() {
    let directory = tempfile::tempdir().unwrap();
    let schema = |kind: &str| -> serde_json::Value {
        let output = moris(directory.path(), &["schema", kind]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let rig = schema("rig");
    // Tables are described apart.
    let described = |schema: &serde_json::Value, key: &str| -> serde_json::Value {
        let property = schema["properties"][key].clone();
        // A table that may be missing is one of two.
        let table = property["anyOf"][0]["$ref"].as_str().or(property["$ref"].as_str());
        let reference = table.map(|name| name.rsplit('/').next().unwrap().to_owned());
        reference.map_or(property, |name| rig["$defs"][name].clone())
    };
    for name in ["default", "compact", "long-stroke", "narrow"] {
        let file: toml::Table = fs::read_to_string(rigs().join(format!("{name}.toml"))).unwrap().parse().unwrap();
        for (key, value) in &file {
            let property = described(&rig, key);
            assert!(property.is_object(), "{name}: {key}");
            for inner in value.as_table().into_iter().flat_map(toml::Table::keys) {
                assert!(property["properties"][inner].is_object(), "{name}: {key}.{inner} in {property}");
            }
        }
    }
    let required: Vec<&str> = rig["required"].as_array().unwrap().iter().map(|key| key.as_str().unwrap()).collect();
    for key in ["name", "neutralHeight", "base", "platform"] {
        assert!(required.contains(&key), "{key}");
    }
    assert_eq!(rig["additionalProperties"], false);

    // The JSON of a simulation has the keys of its schema, and measures of the same units.
    write_recording(directory.path(), "ride.csv");
    let printed = moris(directory.path(), &["simulate", "ride.csv", "--no-bound", "--json"]).stdout;
    let simulated: serde_json::Value = serde_json::from_slice(&printed).unwrap();
    let schema_of_results = schema("simulation");
    let keys = |object: &serde_json::Value| -> Vec<String> { object.as_object().unwrap().keys().cloned().collect() };
    let definition = |name: &str| &schema_of_results["$defs"][name];
    for (name, object) in [("SimulatedRecording", &simulated[0]), ("SetResult", &simulated[0]["results"][0])] {
        assert_eq!(keys(&definition(name)["properties"]), keys(object));
        assert_eq!(definition(name)["required"].as_array().unwrap().len(), keys(object).len(), "{name}");
    }
    let measures = simulated[0]["results"][0]["measures"].as_array().unwrap();
    for measure in measures {
        assert_eq!(keys(&definition("Measure")["properties"]), keys(measure));
    }
    for name in ["shake", "jolt", "peak"] {
        let units = measures.iter().filter(|measure| measure["name"] == name).map(|measure| &measure["unit"]);
        assert!(units.clone().count() > 0 && units.into_iter().all(|unit| unit == "m/s²"), "{name}");
    }

    let conventions = schema("conventions");
    for key in ["format", "columns", "force-unit", "mounting", "empty-fields", "resample", "fade-in"] {
        assert!(conventions["properties"][key].is_object(), "{key}");
    }
    assert!(conventions.to_string().contains("\"forward-right-down\""));

    let parameters = schema("parameters");
    let file: toml::Table = text(&moris(directory.path(), &["parameters"]).stdout).parse().unwrap();
    assert_eq!(parameters["properties"].as_object().unwrap().len(), file.len());
    for (name, value) in &file {
        let property = &parameters["properties"][name];
        let number = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
        if let Some(number) = number {
            let above = property["minimum"].as_f64().is_none_or(|least| number >= least);
            assert!(above && property["maximum"].as_f64().is_none_or(|most| number <= most), "{name}: {property}");
        } else {
            let items = property["enum"].as_array();
            assert!(
                value.is_bool() || items.is_some_and(|items| items.iter().any(|item| item == value.as_str().unwrap()))
            );
        }
        assert!(!property["description"].as_str().unwrap().is_empty(), "{name}");
    }
}
