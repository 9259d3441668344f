//! Columns that are likely to be a quantity's by their names.

use super::{Column, Header, Quantity};
use crate::recording::columns::units::any_spelled;
use crate::recording::dialects::DIALECTS;

impl Header {
    /// The columns that are likely to be a quantity's, of those that are not in
    /// use, by name and unit.
    pub fn likely(&self, quantity: Quantity, layout: &[Column]) -> Vec<usize> {
        let is_free = |place: usize| !layout.iter().flat_map(|column| &column.terms).any(|term| term.place == place);
        let is_likely = |place: &usize| {
            let title = &self.titles[*place];
            let plain: String = title.name.to_lowercase().chars().filter(char::is_ascii_alphanumeric).collect();
            let unit = title.unit.as_deref().and_then(any_spelled);
            DIALECTS.likely.get(quantity.key()).is_some_and(|parts| parts.split(' ').any(|part| plain.contains(part)))
                && unit.is_none_or(|(dimension, _)| dimension == quantity.dimension())
        };
        (0..self.width()).filter(|&place| is_free(place)).filter(is_likely).collect()
    }

    /// The name of a column, for an option.
    pub fn name(&self, place: usize) -> &str {
        &self.titles[place].name
    }
}
