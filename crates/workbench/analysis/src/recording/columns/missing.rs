//! Columns that a header lacks.

use moris_setup::nearest;

use super::{Header, Quantity, Term};
use crate::message::{Message, given};
use crate::recording::conventions::{Conventions, Format, Missing};
use crate::recording::message::quoted;
use crate::texts::text;

impl Header {
    /// True if all required columns exist.
    pub fn has_needed_columns(&self, conventions: &Conventions) -> bool {
        self.needed(conventions).all(|(_, found)| found != Ok(None))
    }

    /// True if the columns of a logger's format exist.
    fn is_of(&self, format: Format) -> bool {
        format.options().load().is_ok_and(|conventions| {
            // Each of several files has a time.
            self.needed(&conventions).all(|(quantity, found)| match found {
                Ok(found) => found.is_some(),
                Err(_) => quantity == Quantity::Time,
            })
        })
    }

    /// The quantities that a recording needs, with their columns.
    fn needed(
        &self,
        conventions: &Conventions,
    ) -> impl Iterator<Item = (Quantity, Result<Option<Vec<Term>>, Message>)> {
        let is_geographic = self.is_geographic(conventions);
        let needed = Quantity::all().filter(move |&quantity| {
            conventions.needs(quantity) && !(is_geographic && matches!(quantity, Quantity::Position(_)))
        });
        needed.map(|quantity| (quantity, self.terms(conventions.column(quantity))))
    }

    /// The reason for a refusal where quantities have no column.
    pub(super) fn missing(&self, missing: &[Quantity], conventions: &Conventions) -> Message {
        let names: Vec<&str> = missing.iter().map(|&quantity| conventions.column(quantity)).collect();
        if let Some(&format) = Format::ALL.iter().find(|&&format| self.is_of(format)) {
            let names = names.into_iter().map(quoted).collect::<Vec<_>>().join(", ");
            let (title, remedy) = (format.title(), given("format", format.word()));
            return text!["other-format", title, remedy, names];
        }
        // Formats have optional channels: others may have measured the same.
        let likely = |quantity: &Quantity| {
            let place = conventions.format.and_then(|_| self.likely(*quantity, &[]).first().copied());
            place.map(|place| format!("{}={}", quantity.key(), self.name(place)))
        };
        let found: Vec<String> = missing.iter().filter_map(likely).collect();
        let keys = missing.iter().map(|quantity| format!("{}=NAME", quantity.key()));
        let keys: Vec<String> = if found.is_empty() {
            keys.collect()
        } else {
            found.into_iter().map(|pair| format!("\"{pair}\"")).collect()
        };
        let has = |is_it: fn(&str) -> bool| self.titles.iter().any(|title| is_it(&title.name.to_lowercase()));
        let is_long = has(|name| ["name", "sensor", "signal"].iter().any(|end| name.ends_with(end)))
            && has(|name| name == "x" || name.ends_with("value"));
        if is_long && missing.len() >= 6 {
            return text!["line-for-each-value", listed = self.listed()];
        }
        let may_rest = |quantity: &Quantity| matches!(quantity, Quantity::Force(1..) | Quantity::Rate(_));
        let no = if names.len() == 1 { "is no column" } else { "are no columns" };
        let (names, listed) = (self.with_nearest(&names), self.listed());
        let columns = given("columns", keys.join(","));
        let or_else = if missing == [Quantity::Time] {
            text!["or-equal-steps"]
        } else if conventions.missing == Missing::Rest {
            text!["turned-is-not-known"]
        } else if missing.iter().all(may_rest) || keys.len() < missing.len() {
            text!["or-rest"]
        } else {
            Message::default()
        };
        text!["no-columns", no, names, listed, columns, or_else]
    }

    /// Names, each with the one that is nearest to it in the header.
    fn with_nearest(&self, names: &[&str]) -> String {
        let present = || self.titles.iter().map(|title| title.name.as_str());
        let like = |&name: &&str| match nearest(name, present()).first() {
            Some(like) => format!("{} (is it {}?)", quoted(name), quoted(like)),
            None => quoted(name),
        };
        names.iter().map(like).collect::<Vec<_>>().join(", ")
    }

    /// The columns that there are.
    fn listed(&self) -> String {
        // Most columns that a message lists.
        const MOST_LISTED: usize = 30;
        let mut listed: Vec<String> = (0..self.width()).take(MOST_LISTED).map(|place| self.shown(place)).collect();
        if self.width() > MOST_LISTED {
            listed.push(format!("{} more", self.width() - MOST_LISTED));
        }
        listed.join(", ")
    }
}
