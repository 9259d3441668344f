//! The quantities that a recording may hold.

use super::units::Dimension;

/// A quantity that a recording may hold, by the key under which its column is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    Time,
    Force(usize),
    Rate(usize),
    Angle(usize),
    Speed,
    Lean,
}

impl Quantity {
    /// Every quantity with its key, which is also its column's name unless another is given.
    pub const ALL: [(Quantity, &'static str); 12] = [
        (Quantity::Time, "time"),
        (Quantity::Force(0), "ax"),
        (Quantity::Force(1), "ay"),
        (Quantity::Force(2), "az"),
        (Quantity::Rate(0), "wx"),
        (Quantity::Rate(1), "wy"),
        (Quantity::Rate(2), "wz"),
        (Quantity::Angle(0), "roll"),
        (Quantity::Angle(1), "pitch"),
        (Quantity::Angle(2), "yaw"),
        (Quantity::Speed, "speed"),
        (Quantity::Lean, "lean"),
    ];

    /// True for time, specific force and rates, which every recording must have.
    pub fn is_required(self) -> bool {
        matches!(self, Quantity::Time | Quantity::Force(_) | Quantity::Rate(_))
    }

    /// The dimension of its units.
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::Time => Dimension::Time,
            Quantity::Force(_) => Dimension::Force,
            Quantity::Rate(_) => Dimension::Rate,
            Quantity::Angle(_) | Quantity::Lean => Dimension::Angle,
            Quantity::Speed => Dimension::Speed,
        }
    }

    /// The quantity's key.
    pub fn key(self) -> &'static str {
        let found = Self::ALL.iter().find(|(quantity, _)| *quantity == self);
        found.map_or("", |(_, key)| key)
    }

    /// The quantity of a key.
    ///
    /// # Errors
    /// The key is unknown. The message lists the known ones.
    pub fn of_key(key: &str) -> Result<Self, String> {
        let found = Self::ALL.iter().find(|(_, known)| *known == key);
        let keys = || Self::ALL.map(|(_, key)| key).join(", ");
        found.map(|(quantity, _)| *quantity).ok_or_else(|| format!("there is no key {key}; there are {}", keys()))
    }
}
