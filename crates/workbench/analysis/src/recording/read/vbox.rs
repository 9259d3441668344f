//! Racelogic's .vbo files, as the lines of a CSV file.
//!
//! A file has sections: `[header]` has a title for each channel, `[channel units]` the units of the
//! last ones, `[column names]` a line of names, and `[data]` numbers between spaces.
//! <https://developers.racelogic.co.uk/Portal/Tutorials/tutorialVBOfilestructure.html>

use crate::recording::columns::units::any_spelled;
use crate::recording::dialects::{Channel, DIALECTS};

/// The text as CSV with the same lines; none if it is no .vbo file.
pub fn as_csv(text: &str) -> Option<String> {
    let names = section_lines(text, "[column names]")?.find(|line| !line.trim().is_empty())?;
    section_lines(text, "[data]").is_some().then_some(())?;
    let titles = column_titles(text, &names.split_whitespace().collect::<Vec<_>>());
    let mut csv = String::new();
    let mut place = "";
    for line in text.lines() {
        if line.starts_with('[') {
            place = line.trim();
        } else if place.eq_ignore_ascii_case("[data]") {
            let fields = line.split_whitespace().zip(&titles);
            let fields: Vec<String> = fields
                .map(|(field, title)| if title == "time" { clock_with_colons(field) } else { field.to_owned() })
                .collect();
            csv += &fields.join(",");
        } else if line == names && place.eq_ignore_ascii_case("[column names]") {
            csv += &titles.join(",");
        }
        csv.push('\n');
    }
    Some(csv)
}

/// The lines of a section.
fn section_lines<'a>(text: &'a str, name: &str) -> Option<impl Iterator<Item = &'a str> + use<'a>> {
    let mut lines = text.lines();
    lines.find(|line| line.trim().eq_ignore_ascii_case(name))?;
    Some(lines.take_while(|line| !line.starts_with('[')))
}

/// The columns' names with their units in brackets.
fn column_titles(text: &str, names: &[&str]) -> Vec<String> {
    let lines = |name: &str| section_lines(text, name).map(|lines| lines.map(str::trim).collect()).unwrap_or_default();
    let mut headings: Vec<&str> = lines("[header]");
    headings.retain(|heading| !heading.is_empty());
    let mut units: Vec<&str> = lines("[channel units]");
    // A blank line ends a section.
    if units.last().is_some_and(|unit| unit.is_empty()) {
        units.pop();
    }
    let unit = |place: usize| {
        let own = (place + units.len()).checked_sub(names.len()).and_then(|k| units.get(k)).copied();
        let heading = headings.get(place).filter(|_| headings.len() == names.len());
        let last = heading.and_then(|heading| heading.split_whitespace().last());
        own.into_iter().chain(last).find(|unit| any_spelled(unit).is_some())
    };
    let plain: Vec<String> =
        names.iter().map(|name| name.to_lowercase().chars().filter(char::is_ascii_alphanumeric).collect()).collect();
    let called = |place: usize| {
        let is_spelled = |(_, channel): &(&String, &Channel)| {
            let mut spellings = channel.spellings.split(' ');
            spellings.find_map(|spelling| plain.iter().position(|name| name == spelling)) == Some(place)
        };
        let found = DIALECTS.vbox.iter().find(is_spelled);
        found.map_or((names[place], None), |(name, channel)| (name.as_str(), Some(channel.unit.as_str())))
    };
    let title = |place: usize| {
        let (name, usual) = called(place);
        let name = name.replace(',', " ");
        unit(place).or(usual).map_or_else(|| name.clone(), |unit| format!("{name} [{unit}]"))
    };
    (0..names.len()).map(title).collect()
}

/// A time of day `HHMMSS.SS` with colons.
fn clock_with_colons(field: &str) -> String {
    let whole = field.find('.').unwrap_or(field.len());
    match field[..whole].is_ascii() && whole >= 5 {
        true => format!("{}:{}:{}", &field[..whole - 4], &field[whole - 4..whole - 2], &field[whole - 2..]),
        false => field.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_that_is_no_time_stays_as_it_is() {
        assert_eq!(clock_with_colons("112642.64"), "11:26:42.64");
        for field in ["", "2.64", "11322ÿ2.64", "ÿÿÿ.1"] {
            assert_eq!(clock_with_colons(field), field);
        }
    }
}
