//! Remedies in the command's words: as its options.

use std::error::Error;

use moris_analysis::message::Remedy;

use moris_analysis::recording::Recording;

/// When to use which of the commands and parameters that fit a ride to a rig.
pub const WHICH_COMMAND: &str = "Where the vehicle knows its road, give a preview first. For rides that you have recorded, moris fit finds \
    the strategy\nand the scale, then moris tune the other parameters. For rides that nobody knows yet, set scale.automatic = on. \
    docs/scale.md says more.";

/// A remedy as an option: `--force-unit g`.
pub fn option(Remedy { option, value }: &Remedy) -> String {
    match value {
        // A value may begin with a minus.
        Some(value) if *option == "mounting" && is_numbers(value) => format!("--{option}={value}"),
        Some(value) if *option != "repair" => format!("--{option} {value}"),
        _ => format!("--{option}"),
    }
}

/// True for numbers, separated by commas if there are several.
fn is_numbers(value: &str) -> bool {
    value.split(',').all(|number| number.parse::<f64>().is_ok())
}

/// The warnings about a recording.
pub fn warnings(recording: &Recording) -> Vec<String> {
    recording.warnings.iter().map(|warning| warning.worded(option)).collect()
}

/// An error, without its causes.
pub fn error(error: &(dyn Error + 'static)) -> String {
    moris_analysis::error::worded(error, option)
}

/// An error with its causes.
pub fn with_causes(error: &anyhow::Error) -> String {
    error.chain().map(self::error).collect::<Vec<_>>().join(": ")
}

#[cfg(test)]
mod tests {
    use moris_analysis::message::{given, named};

    use super::*;

    #[test]
    fn remedies_are_options() {
        for (remedy, written) in [
            (named("time-unit"), "--time-unit"),
            (given("force-unit", "m/s2"), "--force-unit m/s2"),
            (given("columns", "ax=NAME,ay=-b c"), "--columns ax=NAME,ay=-b c"),
            (given("mounting", "auto"), "--mounting auto"),
            (given("mounting", "-1.5,0.0,90.0"), "--mounting=-1.5,0.0,90.0"),
            (given("mounting", "ROLL,PITCH,YAW"), "--mounting ROLL,PITCH,YAW"),
            (given("resample", 100), "--resample 100"),
            (given("repair", "True"), "--repair"),
        ] {
            assert_eq!(option(&remedy), written);
        }
    }
}
