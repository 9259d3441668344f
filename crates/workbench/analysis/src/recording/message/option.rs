//! Options of the reading in messages, as data: a message says which option helps, and what it is
//! given. The dialect of who reads the recording says how that is written.

use std::fmt::Display;

/// Notation of options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dialect {
    /// As the command's: `--force-unit g`.
    #[default]
    Command,
    /// As arguments in Python: `force_unit="g"`.
    Python,
}

/// An option stands between the first and the last in a message, its value after the second. These
/// are no characters: no text that is read has them.
const BEGIN: char = '\u{FDD0}';
const VALUE: char = '\u{FDD1}';
const END: char = '\u{FDD2}';

/// An option in a message.
pub fn named(option: &str) -> String {
    format!("{BEGIN}{option}{END}")
}

/// An option with its value in a message.
pub fn given(option: &str, value: impl Display) -> String {
    format!("{BEGIN}{option}{VALUE}{value}{END}")
}

impl Dialect {
    /// The message with its options written.
    pub fn written(self, message: &str) -> String {
        let mut written = String::new();
        let mut rest = message;
        while let Some((before, from)) = rest.split_once(BEGIN)
            && let Some((option, after)) = from.split_once(END)
        {
            written += before;
            written += &match option.split_once(VALUE) {
                Some((option, value)) => self.with_value(option, value),
                None => self.alone(option),
            };
            rest = after;
        }
        written + rest
    }

    fn alone(self, option: &str) -> String {
        match self {
            Dialect::Command => format!("--{option}"),
            Dialect::Python => option.replace('-', "_"),
        }
    }

    fn with_value(self, option: &str, value: &str) -> String {
        let name = self.alone(option);
        match (self, option) {
            // A value may begin with a minus.
            (Dialect::Command, "mounting") if is_numbers(value) => format!("{name}={value}"),
            (Dialect::Command, "repair") => name,
            (Dialect::Command, _) => format!("{name} {value}"),
            (Dialect::Python, "columns") => format!("{name}={}", dictionary(value)),
            (Dialect::Python, "mounting") if value.contains(',') => format!("{name}=[{value}]"),
            (Dialect::Python, "repair") => format!("{name}={value}"),
            (Dialect::Python, _) if is_numbers(value) => format!("{name}={value}"),
            (Dialect::Python, _) => format!("{name}=\"{value}\""),
        }
    }
}

/// True for numbers, separated by commas if there are several.
fn is_numbers(value: &str) -> bool {
    value.split(',').all(|number| number.parse::<f64>().is_ok())
}

/// `ax=NAME,ay=NAME` as Python's dictionary.
fn dictionary(columns: &str) -> String {
    let pairs = columns.split(',').filter_map(|pair| pair.split_once('='));
    let pairs: Vec<String> = pairs.map(|(key, name)| format!("\"{key}\": \"{name}\"")).collect();
    format!("{{{}}}", pairs.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_written_for_the_command_and_for_python() {
        for (option, value, command, python) in [
            ("force-unit", "m/s2", "--force-unit m/s2", "force_unit=\"m/s2\""),
            ("columns", "ax=NAME,ay=-b c", "--columns ax=NAME,ay=-b c", "columns={\"ax\": \"NAME\", \"ay\": \"-b c\"}"),
            ("mounting", "auto", "--mounting auto", "mounting=\"auto\""),
            ("mounting", "-1.5,0.0,90.0", "--mounting=-1.5,0.0,90.0", "mounting=[-1.5,0.0,90.0]"),
            ("mounting", "ROLL,PITCH,YAW", "--mounting ROLL,PITCH,YAW", "mounting=[ROLL,PITCH,YAW]"),
            ("resample", "100", "--resample 100", "resample=100"),
            ("repair", "True", "--repair", "repair=True"),
        ] {
            let message = format!("{}: use {}, or no {}.", named("time-unit"), given(option, value), named(option));
            let name = option.replace('-', "_");
            assert_eq!(
                [Dialect::Command, Dialect::Python].map(|dialect| dialect.written(&message)),
                [
                    format!("--time-unit: use {command}, or no --{option}."),
                    format!("time_unit: use {python}, or no {name}.")
                ]
            );
        }
        let plain = "no option, a stray \u{FDD0} and -- signs";
        assert_eq!(Dialect::Python.written(plain), plain);
    }
}
