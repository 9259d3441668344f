//! Messages with remedies in them. A remedy is data, and each face words it: the command as an
//! option, Python as an argument.

use std::fmt::{self, Display};

/// An option that helps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remedy {
    /// Name of the option, as in a file of conventions: `force-unit`.
    pub option: &'static str,
    /// Value to give; none where the option is named alone.
    pub value: Option<String>,
}

/// Words of a face for a remedy.
pub type Words = fn(&Remedy) -> String;

/// Text with remedies in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Message(Vec<Part>);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Text(String),
    Remedy(Remedy),
}

impl Message {
    /// The text, with its remedies in a face's words.
    pub fn worded(&self, words: Words) -> String {
        let part = |part: &Part| match part {
            Part::Text(text) => text.clone(),
            Part::Remedy(remedy) => words(remedy),
        };
        self.0.iter().map(part).collect()
    }

    /// The text without the full stop at its end.
    pub fn without_full_stop(mut self) -> Self {
        if let Some(Part::Text(text)) = self.0.last_mut() {
            text.truncate(text.trim_end_matches('.').len());
        }
        self
    }

    /// Appends text, a remedy or another message.
    pub fn push(&mut self, more: impl Into<Message>) {
        self.0.extend(more.into().0);
    }
}

/// The words of no face: `force-unit g`.
impl Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.worded(|Remedy { option, value }| match value {
            Some(value) => format!("{option} {value}"),
            None => (*option).to_owned(),
        }))
    }
}

impl std::error::Error for Message {}

impl From<String> for Message {
    fn from(text: String) -> Self {
        Message(vec![Part::Text(text)])
    }
}

impl From<&str> for Message {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl From<Remedy> for Message {
    fn from(remedy: Remedy) -> Self {
        Message(vec![Part::Remedy(remedy)])
    }
}

/// An option in a message.
pub fn named(option: &'static str) -> Remedy {
    Remedy { option, value: None }
}

/// An option with its value in a message.
pub fn given(option: &'static str, value: impl Display) -> Remedy {
    Remedy { option, value: Some(value.to_string()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_keeps_its_remedies_as_data() {
        let mut message = Message::from("there are 2 laps; ");
        message.push("use ");
        message.push(given("lap", 1));
        message.push(", or ");
        message.push(named("columns"));
        message.push(" alone".to_owned());
        assert_eq!(message.to_string(), "there are 2 laps; use lap 1, or columns alone");
        assert_eq!(
            message.worded(|remedy| format!("[{}]", remedy.option)),
            "there are 2 laps; use [lap], or [columns] alone"
        );
    }
}
