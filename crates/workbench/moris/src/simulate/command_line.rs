//! The command to simulate a recording once more.

use std::path::Path;

use clap::{Args, Command};

use super::Options;

/// The program's command line for one recording, with `--parameters` at its end for another file.
pub fn with_other_parameters(recording: &Path) -> String {
    // The program and its subcommand come first.
    let arguments = std::env::args_os().skip(2).map(|argument| argument.to_string_lossy().into_owned());
    command_line_of(arguments, &recording.display().to_string())
}

fn command_line_of(mut arguments: impl Iterator<Item = String>, recording: &str) -> String {
    // Options about parameters, which the file takes the place of.
    const OF_PARAMETERS: [&str; 6] = ["--parameters", "--strategy", "--compare", "--against", "--preview", "--learn"];
    let command = Options::augment_args(Command::new("simulate"));
    let is_flag = |name: &str| {
        let option = command.get_arguments().find(|option| option.get_long() == name.strip_prefix("--"));
        option.is_some_and(|option| !option.get_action().takes_values() || option.is_require_equals_set())
    };
    let mut words = vec!["cargo moris simulate".to_owned(), shell_quoted(recording)];
    while let Some(argument) = arguments.next() {
        let (name, value) = match argument.split_once('=') {
            _ if !argument.starts_with("--") => continue,
            Some((name, value)) => (name.to_owned(), Some(value.to_owned())),
            None if is_flag(&argument) => (argument, None),
            None => (argument, arguments.next()),
        };
        if !OF_PARAMETERS.contains(&name.as_str()) {
            words.push(name);
            words.extend(value.as_deref().map(shell_quoted));
        }
    }
    words.push("--parameters".to_owned());
    words.join(" ")
}

/// A word for a shell.
fn shell_quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "-_./,:=+%@".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_options_but_those_of_parameters_stay() {
        let words =
            "a.csv b.csv --rig r.toml --parameters=car --strategy robust --no-bound --mounting -3,0,1 --compare x";
        let command = command_line_of(words.split(' ').map(str::to_owned), "my ride's.csv");
        let expected =
            "cargo moris simulate 'my ride'\\''s.csv' --rig r.toml --no-bound --mounting -3,0,1 --parameters";
        assert_eq!(command, expected);
        let command = command_line_of(
            "--repair a.csv --learn=kart.laps --json --learn --rig r.toml".split(' ').map(str::to_owned),
            "a.csv",
        );
        assert_eq!(command, "cargo moris simulate a.csv --repair --json --rig r.toml --parameters");
    }
}
