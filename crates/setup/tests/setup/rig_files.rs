//! Rig files: the shipped examples, and what is wrong with others.

use std::path::{Path, PathBuf};

use moris_setup::rig_file::{SAFETY_FRACTION, read};
use moris_setup::{load_rig, overlaid};
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::reach::{Axis, single_axis_range};
use moris_washout::{Parameters, Rig};

/// The rigs of the kinds that people have.
pub const RIGS: [&str; 8] =
    ["hobby100", "hobby150", "hobby200", "diy283", "dim330", "moog-like450", "flight091", "flight125"];

pub fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/rigs").join(name)
}

/// The template without its comments, line by line.
fn default_text() -> String {
    let text = std::fs::read_to_string(example("default.toml")).unwrap();
    text.lines().map(|line| line.split('#').next().unwrap_or_default().trim_end().to_owned() + "\n").collect()
}

/// The message with which a text is refused.
fn refusal(text: &str) -> String {
    read(text, "my.toml").expect_err("this rig file must be refused").to_string()
}

#[test]
fn the_default_rig_s_file_is_the_default_rig() {
    let file = load_rig(&example("default.toml")).unwrap();
    let (found, expected) = (file.parameters(), Parameters::default());
    for i in 0..6 {
        assert!((found.rig.base[i] - expected.rig.base[i]).norm() < 1e-14);
        assert!((found.rig.platform[i] - expected.rig.platform[i]).norm() < 1e-14);
    }
    let joints_aside =
        Parameters { rig: Rig { base: expected.rig.base, platform: expected.rig.platform, ..found.rig }, ..found };
    assert_eq!(joints_aside, expected);
}

#[test]
fn every_example_is_a_rig_that_a_washout_runs_on() {
    for name in ["default", "compact", "long-stroke", "narrow"].into_iter().chain(RIGS) {
        let file = load_rig(&example(&format!("{name}.toml"))).unwrap();
        assert_eq!(file.check(), Ok(()), "{name}");
        // The examples are set up so that they reach about as far up as down.
        let heave = single_axis_range(&file.rig(), Axis::Heave);
        assert!((heave.max + heave.min).abs() < 0.15 * (heave.max - heave.min), "{name}: {heave:?}");
    }
}

#[test]
fn cranks_are_read_in_degrees_and_rates_of_their_arms() {
    for (name, arm, rod, headings, highest) in [
        ("crank-person", 0.184_15, 0.7239, [150.0, -90.0, 30.0, 150.0, -90.0, 30.0], 60.0),
        ("crank-servo", 0.015, 0.14, [-60.0, 120.0, 180.0, 0.0, 60.0, -120.0], 80.0),
        // 0.79 and 4.66 inches.
        ("crank-hobby20", 0.020_066, 0.118_364, [90.0, -90.0, -30.0, 150.0, -150.0, 30.0], 80.0),
        ("crank-hobby25", 0.025, 0.155, [-60.0, 120.0, 180.0, 0.0, 60.0, -120.0], 40.0),
        ("crank-stepper50", 0.05, 0.1675, [-90.0, 90.0, 30.0, -150.0, 150.0, -30.0], 45.0),
    ] {
        let file = load_rig(&example(&format!("{name}.toml"))).unwrap();
        assert_eq!(file.check(), Ok(()), "{name}");
        let rig = file.rig();
        assert!(rig.has_cranks() && (rig.crank_arm, rig.crank_rod) == (arm, rod));
        let degrees = rig.crank_heading.map(f64::to_degrees);
        assert!(degrees.iter().zip(headings).all(|(found, heading): (&f64, f64)| (found - heading).abs() < 1e-12));
        assert!((rig.crank_max_angle.to_degrees() - highest).abs() < 1e-12);
        assert!((rig.stroke()[1] - arm * highest.to_radians()).abs() < 1e-12);
        assert!((rig.velocity_limit - 6.0 * arm).abs() < 1e-12, "{name}");
        // With a rod across the axle's plane or not, joints are this far apart at neutral.
        let [shortest, longest] = [rig.min_length, rig.max_length];
        assert!((arm * arm + rod * rod - 0.5 * (shortest * shortest + longest * longest)).abs() < 1e-12);
    }
}

/// Text of a rig file with cranks.
fn crank_text() -> String {
    std::fs::read_to_string(example("crank-person.toml")).unwrap()
}

#[test]
fn a_rig_has_either_legs_or_cranks() {
    let legs = "[actuator]\nminLength = 0.5\nmaxLength = 0.9\nvelocityLimit = 1.0\naccelerationLimit = 10.0\n";
    let neither = crank_text().split("[crank]").next().unwrap().to_owned();
    for text in [crank_text() + legs, neither] {
        let message = refusal(&text);
        assert!(message.contains("[actuator] for legs or a table [crank] for cranks"), "{message}");
    }
}

#[test]
fn cranks_in_other_units_are_named() {
    for (value, other, expected) in [
        ("arm = 0.18415", "arm = 184.15", "crank.arm is 184.15; is this in millimetres? Write m"),
        ("arm = 0.18415", "arm = 25", "crank.arm is 25; is this in millimetres? Write m"),
        ("rod = 0.7239", "rod = 723.9", "crank.rod is 723.9; is this in millimetres? Write m"),
        ("velocityLimit = 6.0", "velocityLimit = 340", "crank.velocityLimit is 340; is this in deg/s? Write rad/s"),
        ("headingDegrees", "headings", "did you mean"),
    ] {
        let message = refusal(&crank_text().replace(value, other));
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn every_example_is_shipped_under_its_name() {
    let files = std::fs::read_dir(example("default.toml").parent().unwrap()).unwrap();
    let stems = files.map(|file| file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned());
    let (mut files, mut shipped): (Vec<String>, Vec<String>) =
        (stems.collect(), moris_setup::SHIPPED_RIGS.iter().map(|(name, _)| (*name).to_owned()).collect());
    files.sort();
    shipped.sort();
    assert_eq!(files, shipped);
    for name in shipped {
        assert_eq!(load_rig(name.as_ref()).unwrap(), load_rig(&example(&format!("{name}.toml"))).unwrap());
    }
    let error = load_rig("hoby150".as_ref()).unwrap_err().to_string();
    assert!(error.contains("hoby150 is neither a file nor a rig that is shipped; did you mean hobby150"), "{error}");
}

#[test]
fn the_safety_units_follow_from_the_rig_where_the_file_does_not_say() {
    let text = default_text();
    let without = &text[..text.find("[safety]").unwrap()];
    let parameters = read(without, "my.toml").unwrap().parameters();
    let reach = [Axis::Surge, Axis::Sway, Axis::Heave].map(|axis| single_axis_range(&parameters.rig, axis).min_reach());
    assert_eq!(parameters.safety.position_limit, SAFETY_FRACTION * Vector3::from(reach));
    assert_eq!(parameters.safety.velocity_limit, Parameters::default().safety.velocity_limit);
}

#[test]
fn the_values_are_the_parameters_under_the_names_of_the_variables() {
    let file = load_rig(&example("narrow.toml")).unwrap();
    let values = file.values();
    assert!(values.contains(&("rig.neutralHeight".to_owned(), 1.02)));
    assert!(values.contains(&("rig.platform[2].y".to_owned(), 0.55)));
    assert!(values.iter().all(|(name, _)| !name.starts_with("splitter")), "what a rig does not change is not a rig's");
    assert_eq!(overlaid(&Parameters::default(), &values), file.parameters());
}

#[test]
fn a_misspelt_key_is_named_with_the_right_one() {
    let message = refusal(&default_text().replace("neutralHeight", "neutralHeigth"));
    assert_eq!(message, "my.toml: there is no key neutralHeigth; did you mean neutralHeight?");
    let message = refusal(&default_text().replace("minLength", "min_length"));
    assert!(message.contains("actuator.min_length") && message.contains("actuator.minLength"), "{message}");
}

#[test]
fn what_the_machine_is_made_of_has_to_be_there() {
    let message = refusal(&default_text().replace("velocityLimit = 1.0\naccelerationLimit = 15.0\n", ""));
    assert!(message.contains("velocityLimit") && message.contains("missing"), "{message}");
    let message = refusal(&default_text().replace("radius = 0.85\n", ""));
    assert!(message.contains("[platform]") && message.contains("radius and degrees, or joints"), "{message}");
}

#[test]
fn five_joints_and_words_for_numbers_are_refused_at_their_line() {
    let message = refusal(&default_text().replace("[-8, 8, 112, 128, 232, 248]", "[-8, 8, 112, 128, 232]"));
    assert!(message.contains("line 10") && message.contains("6"), "{message}");
    let message = refusal(&default_text().replace("= 1.091", "= \"high\""));
    assert!(message.contains("line 5") && message.contains("neutralHeight"), "{message}");
}

#[test]
fn millimetres_are_recognised() {
    let message = refusal(&default_text().replace("radius = 1.0", "radius = 1000"));
    assert!(message.contains("[base]") && message.contains("millimetres"), "{message}");
    for (key, from, to, unit) in [
        ("neutralHeight", "= 1.091", "= 1091", "m"),
        ("neutralHeight", "= 1.091", "= -1091", "m"),
        ("actuator.minLength", "minLength = 1.0", "minLength = 1000", "m"),
        ("actuator.maxLength", "maxLength = 1.6", "maxLength = 1600.0", "m"),
        ("actuator.velocityLimit", "velocityLimit = 1.0\naccel", "velocityLimit = 500\naccel", "m/s"),
        ("actuator.accelerationLimit", "accelerationLimit = 15.0", "accelerationLimit = 5000", "m/s2"),
    ] {
        let message = refusal(&default_text().replace(from, to));
        assert!(message.starts_with(&format!("my.toml: {key} is ")), "{message}");
        assert!(message.ends_with(&format!("Write {unit}")), "{message}");
    }
}

#[test]
fn radians_in_place_of_degrees_are_named() {
    let lists = ["[-8, 8, 112, 128, 232, 248]", "[-0.14, 0.14, 1.95, 2.23, 4.05, 4.33]"];
    let message = refusal(&default_text().replace(lists[0], lists[1]));
    let expected = "base.degrees is [-0.14, 0.14, 1.95, 2.23, 4.05, 4.33]; are these radians? Write degrees";
    assert!(message.ends_with(expected), "{message}");
    let mut table: toml::Table = crank_text().parse().unwrap();
    let crank = table["crank"].as_table_mut().unwrap();
    crank.insert("minAngleDegrees".to_owned(), toml::Value::Float(-0.7));
    crank.insert("maxAngleDegrees".to_owned(), toml::Value::Float(0.7));
    let message = refusal(&table.to_string());
    let expected = "minAngleDegrees, maxAngleDegrees is [-0.7, 0.7]; are these radians? Write degrees";
    assert!(message.ends_with(expected), "{message}");
}

#[test]
fn travel_in_place_of_lengths_is_named_with_the_lengths() {
    for (min, max, shortest, longest) in
        [("-0.3", "0.3", "1.000", "1.600"), ("0", "0.6", "1.000", "1.600"), ("0.1", "0.5", "1.100", "1.500")]
    {
        let text = default_text().replace("minLength = 1.0", &format!("minLength = {min}"));
        let message = refusal(&text.replace("maxLength = 1.6", &format!("maxLength = {max}")));
        assert!(message.starts_with("my.toml: actuator.minLength is "), "{message}");
        assert!(message.contains("from joint to joint, not travel"), "{message}");
        assert!(message.ends_with(&format!("minLength would be {shortest} and maxLength {longest}")), "{message}");
    }
}

#[test]
fn joints_at_one_point_are_refused() {
    for (section, radius) in [("[base]", "radius = 1.0"), ("[platform]", "radius = 0.85")] {
        let message = refusal(&default_text().replace(radius, "radius = 0"));
        assert!(message.contains(section) && message.contains("all its joints at one point"), "{message}");
    }
}

#[test]
fn rigs_of_other_kinds_are_named_as_such() {
    for text in [
        default_text() + "\n[servo]\narmLength = 0.13\n",
        default_text() + "\n[horn]\nlength = 0.13\n",
        default_text().replace("radius = 1.0", "radius = 1.0\ncrankRadius = 0.1"),
        default_text().replace("[-8, 8, 112, 128, 232, 248]", "[0, 120, 240]"),
    ] {
        let message = refusal(&text);
        assert!(
            message.contains("rigs with six legs in a table") && message.contains("docs/platforms.md"),
            "{message}"
        );
        assert!(!message.contains("did you mean"), "{message}");
    }
}

#[test]
fn lists_of_joints_that_go_opposite_ways_are_named() {
    let text = default_text().replace("[-52, 52, 68, 172, 188, 292]", "[52, -52, 292, 188, 172, 68]");
    let message = read(&text, "my.toml").unwrap().check().unwrap_err().to_string();
    assert!(message.contains("numbered one way round"), "{message}");
}

#[test]
fn a_platform_that_hangs_is_as_good_as_one_that_stands() {
    let hanging = default_text().replace("= 1.091", "= -1.091");
    read(&hanging, "my.toml").unwrap().check().unwrap();
    // A head that is lower than the default's torso is long.
    let low = hanging.replace("height = 1.2\ntorsoLength = 0.75", "height = 0.6");
    let file = read(&low, "my.toml").unwrap();
    file.check().unwrap();
    assert_eq!(file.parameters().structure.torso_length, 0.6);
}

#[test]
fn a_number_that_is_not_finite_is_named_with_its_field() {
    let table: toml::Table = default_text().parse().unwrap();
    let with = |value: &toml::Value, number: f64| match value {
        toml::Value::Array(items) => {
            let mut items = items.clone();
            items[1] = number.into();
            items.into()
        }
        _ => toml::Value::from(number),
    };
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let refused = |changed: toml::Table, name: &str| {
            let message = refusal(&changed.to_string());
            assert!(message.starts_with(&format!("my.toml: {name}")), "{name}: {message}");
            assert!(message.ends_with("must be a finite number"), "{name}: {message}");
        };
        let mut changed = table.clone();
        changed["neutralHeight"] = number.into();
        refused(changed, "neutralHeight is");
        for (section, keys) in table.iter().filter_map(|(name, value)| Some((name, value.as_table()?))) {
            for (key, value) in keys {
                let mut changed = table.clone();
                changed[section][key] = with(value, number);
                refused(changed, &format!("{section}.{key}{} is", if value.is_array() { "[2]" } else { "" }));
            }
        }
    }
}

#[test]
fn a_recording_in_place_of_a_rig_file_gets_the_remedy() {
    let message = read("time,ax,ay,az\n0,0,0,9.81\n", "ride.csv").unwrap_err().to_string();
    assert!(message.starts_with("ride.csv: TOML parse error at line 1"), "{message}");
    assert!(message.ends_with("a rig file is TOML; copy examples/rigs/default.toml"), "{message}");
}

#[test]
fn numbers_of_hundreds_of_digits_are_shown_in_few() {
    let message = refusal(&default_text().replace("radius = 1.0", "radius = 1e308"));
    assert!(message.len() < 120 && message.contains("e307"), "{message}");
    for value in ["1e308", "-1e308"] {
        let text = default_text().replace("neutralHeight = 1.091", &format!("neutralHeight = {value}"));
        let message = read(&text, "my.toml").unwrap().check().unwrap_err().to_string();
        assert_eq!(message, format!("rig.neutralHeight: is {value}, but must be from -100 to 100"));
    }
}

#[test]
fn similar_hexagons_are_read_but_do_not_pass() {
    let text =
        default_text().replace("[-52, 52, 68, 172, 188, 292]", "[-8, 8, 112, 128, 232, 248]").replace("1.091", "1.29");
    let refusal = read(&text, "my.toml").unwrap().check().unwrap_err();
    assert!(refusal.to_string().contains("singular"), "{refusal}");
}

#[test]
fn legs_that_do_not_reach_neutral_are_refused_by_number() {
    let text = default_text().replace("1.091", "2.0");
    let without_safety = &text[..text.find("[safety]").unwrap()];
    for text in [&text, without_safety] {
        let refusal = read(text, "my.toml").unwrap().check().unwrap_err();
        assert_eq!(refusal.variable, "rig.neutralHeight");
        assert!(refusal.to_string().contains("actuator 1"), "{refusal}");
    }
}

/// The published machine with a value changed: what is printed is accepted. The height and the rod
/// of level arms are those of the formula in docs/cranks.md.
#[test]
fn cranks_that_are_refused_get_values_with_which_they_are_accepted() {
    let published = std::fs::read_to_string(example("crank-hobby25.toml")).unwrap();
    for (from, to, expected) in [
        ("rod = 0.155", "rod = 0.12", "crank.rod = 0.1552"),
        ("neutralHeight = 0.148", "neutralHeight = 0.19", "neutralHeight = 0.1478"),
        ("leastTransmission = 0.3", "leastTransmission = 0.99", ""),
        ("40.0", "45.0", "crank.minAngleDegrees = -"),
        ("40.0", "75.0", "crank.minAngleDegrees = -"),
    ] {
        let text = published.replace(from, to);
        let refusal = read(&text, "my.toml").unwrap().check().unwrap_err().to_string();
        let Some((_, values)) = refusal.split_once(". Accepted is ") else {
            assert_eq!(expected, "", "{refusal}");
            continue;
        };
        assert!(!expected.is_empty() && values.contains(expected), "{refusal}");
        for alternative in values.split("; or ") {
            let mut table: toml::Table = text.parse().unwrap();
            for (name, value) in alternative.split(", ").map(|pair| pair.split_once(" = ").unwrap()) {
                let value = toml::Value::Float(value.parse().unwrap());
                match name.split_once('.') {
                    Some((section, key)) => table[section][key] = value,
                    None => table[name] = value,
                }
            }
            assert_eq!(read(&table.to_string(), "my.toml").unwrap().check(), Ok(()), "{refusal}");
        }
    }
}
