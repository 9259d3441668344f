//! Parameter files: every parameter by name, and what is wrong with a value.

use std::fs;

use moris_interface::{Group, Kind};
use moris_setup::parameter_file::{read, write};
use moris_setup::{NamedValues, PARAMETER_SETS, Setup, all, changed, load_set, overlaid};
use moris_washout::Parameters;
use moris_washout::interface::{GravityRemoval, LowPassKind};
use moris_washout::presets;

fn values(text: &str) -> NamedValues {
    read(text, "my.toml", Parameters::ROWS).unwrap_or_else(|error| panic!("{error}"))
}

/// The message with which a text is refused.
fn refusal(text: &str) -> String {
    read(text, "my.toml", Parameters::ROWS).expect_err("this parameter file must be refused").to_string()
}

/// Every parameter at a value that is not its default.
fn odd_parameters() -> Parameters {
    let mut odd = all(&Parameters::default());
    let rows = Parameters::ROWS.iter().flat_map(|row| std::iter::repeat_n(row, row.slots()));
    for (place, (row, (_, value))) in rows.zip(&mut odd).enumerate() {
        *value = match (row.kind, row.range) {
            (Kind::Integer, Some((min, _))) => min,
            (Kind::Enumeration(enumeration), _) => enumeration.items.len() as f64,
            // Digits that need all of a double's.
            _ => *value + 0.1 / (3.0 + place as f64),
        };
    }
    overlaid(&Parameters::default(), &odd)
}

#[test]
fn every_parameter_survives_being_written_and_read() {
    let parameters = odd_parameters();
    let text = write("Odd\nvalues", &all(&parameters), Parameters::ROWS);
    assert!(text.starts_with("# Odd\n# values\n"));
    assert_eq!(overlaid(&Parameters::default(), &values(&text)), parameters);
}

#[test]
fn only_what_has_changed_can_be_written() {
    assert!(changed(&Parameters::default()).is_empty());
    let small = presets::parameters(presets::PAPER);
    let text = write("", &changed(&small), Parameters::ROWS);
    // The set says its values in full, and some are the default's.
    let names = changed(&small);
    assert!(names.len() > 20 && names.len() < presets::values(presets::PAPER).len());
    assert_eq!(text.matches(" = ").count(), names.len());
    assert_eq!(overlaid(&Parameters::default(), &values(&text)), small);
}

#[test]
fn shipped_sets_are_parameter_files() {
    for (name, text) in PARAMETER_SETS {
        let shipped = load_set(name, Parameters::ROWS).unwrap();
        let sorted = |mut values: NamedValues| {
            values.sort_by(|a, b| a.0.cmp(&b.0));
            values
        };
        assert_eq!(sorted(values(text)), sorted(shipped), "{name}");
    }
}

#[test]
fn names_may_be_quoted_or_dotted_or_in_tables() {
    let text =
        "\"splitter.x.omega1\" = 2\nsplitter.x.omega2 = 3.5\n\"rig.base[1].x\" = 0.98\n[splitter.y]\nzeta1 = 0.7\n";
    let parameters = overlaid(&Parameters::default(), &values(text));
    assert_eq!((parameters.splitter.omega1.x, parameters.splitter.omega2.x), (2.0, 3.5));
    assert_eq!((parameters.splitter.zeta1.y, parameters.rig.base[0].x), (0.7, 0.98));
}

#[test]
fn enumerations_go_by_the_names_of_their_items() {
    let parameters = overlaid(
        &Parameters::default(),
        &values("gravityRemoval = \"full\"\nsplitter.lowPass = \"independent\"\nsplitter.order = 3"),
    );
    assert_eq!(parameters.conditioning.gravity_removal, GravityRemoval::Full);
    // Or by their numbers, as in the FMU.
    assert_eq!(
        overlaid(&Parameters::default(), &values("gravityRemoval = 2")),
        overlaid(&Parameters::default(), &values("gravityRemoval = \"full\""))
    );
    assert_eq!(parameters.structure.low_pass, LowPassKind::Independent);
    assert_eq!(parameters.structure.splitter_order, 3);
}

#[test]
fn wrong_names_are_answered_with_the_right_ones() {
    let message = refusal("tilt.ratelimit = 0.05");
    assert_eq!(message, "my.toml: there is no parameter tilt.ratelimit; did you mean tilt.rateLimit?");
    let message = refusal("[splitter.x]\nomega = 2.0");
    assert!(message.contains("splitter.x.omega;") && message.contains("splitter.x.omega1"), "{message}");
    // Outputs and inputs are variables, but no parameters.
    assert!(refusal("\"platform.position.x\" = 1.0").contains("no parameter platform.position.x"));
    assert!(refusal("flux = 1.0").contains("moris parameters"));
}

#[test]
fn wrong_values_are_answered_with_what_there_is() {
    let message = refusal("gravityRemoval = \"some\"");
    assert!(message.contains("gravityRemoval is \"some\", but must be one of head_vertical, full, none"), "{message}");
    assert!(refusal("gravityRemoval = 2.5").contains("one of head_vertical, full, none, in quotes, or its number"));
    assert!(refusal("gravityRemoval = 4").contains("is 4, but must be one of 1 (head_vertical), 2 (full), 3 (none)"));
    assert!(refusal("splitter.order = 5").contains("from 2 to 4"));
    assert!(refusal("splitter.order = 2.5").contains("a whole number"));
    assert!(refusal("tilt.rateLimit = \"3 deg/s\"").contains("a number, in rad/s"));
    assert!(refusal("tilt.rateLimit = nan").contains("finite"));
    assert!(refusal("tilt.rateLimit = ").contains("line 1"));
}

#[test]
fn sets_go_by_name_and_lie_over_one_another() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("mine.toml");
    fs::write(&file, "splitter.x.omega1 = 0.5").unwrap();
    let mine = file.display().to_string();
    let setup = Setup::load(None, &["paper".to_owned(), mine.clone()]).unwrap();
    assert_eq!((setup.parameters.splitter.omega1.x, setup.parameters.splitter.omega1.y), (0.5, 2.5));
    assert_eq!(setup.parameters_name, "paper + mine");
    let setup = Setup::load(None, &[mine, "paper".to_owned()]).unwrap();
    assert_eq!(setup.parameters.splitter.omega1.x, 2.5);
}

#[test]
fn neither_a_set_nor_a_file_is_told() {
    let message = load_set("papr", Parameters::ROWS).unwrap_err().to_string();
    assert!(message.contains("papr") && message.contains("did you mean paper?"), "{message}");
    let message = load_set("missing.toml", Parameters::ROWS).unwrap_err().to_string();
    assert!(message.contains("cannot read missing.toml"), "{message}");
}

#[test]
fn parameters_that_do_not_go_together_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("mine.toml");
    fs::write(&file, "actuator.minLength = 1.7").unwrap();
    let message = Setup::load(None, &[file.display().to_string()]).unwrap_err().to_string();
    assert!(message.contains("actuator.minLength: is 1.7 m; it must be below actuator.maxLength"), "{message}");
}
