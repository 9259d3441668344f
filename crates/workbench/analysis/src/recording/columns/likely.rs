//! Columns that are likely to be a quantity's by their names.

use super::{Column, Header, Quantity};
use crate::recording::columns::units::any_spelled;

/// Parts of names, without spaces and signs and in lower case.
fn parts(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Force(0) => "lonac longac longitudinalac inlineac accx xacc accelx accelerationx forcelon surge",
        Quantity::Force(1) => "latac lateralac accy yacc accely accelerationy forcelat sway",
        Quantity::Force(2) => "vertac verticalac accz zacc accelz accelerationz forcevert heave",
        Quantity::Rate(0) => "rollrate gyrox xrate ratex angularvelocityx rotationratex rollvelocity",
        Quantity::Rate(1) => "pitchrate gyroy yrate ratey angularvelocityy rotationratey pitchvelocity",
        Quantity::Rate(2) => "yawrate gyroz zrate ratez angularvelocityz rotationratez yawvelocity gpsgyro yawvel",
        Quantity::Speed => "speed velocity",
        _ => "",
    }
}

impl Header {
    /// The columns that are likely to be a quantity's, of those that are not in
    /// use, by name and unit.
    pub fn likely(&self, quantity: Quantity, layout: &[Column]) -> Vec<usize> {
        let is_free = |place: usize| !layout.iter().flat_map(|column| &column.terms).any(|term| term.place == place);
        let is_likely = |place: &usize| {
            let title = &self.titles[*place];
            let plain: String = title.name.to_lowercase().chars().filter(char::is_ascii_alphanumeric).collect();
            let unit = title.unit.as_deref().and_then(any_spelled);
            parts(quantity).split_whitespace().any(|part| plain.contains(part))
                && unit.is_none_or(|(dimension, _)| dimension == quantity.dimension())
        };
        (0..self.width()).filter(|&place| is_free(place)).filter(is_likely).collect()
    }

    /// The name of a column, for an option.
    pub fn name(&self, place: usize) -> &str {
        &self.titles[place].name
    }
}
