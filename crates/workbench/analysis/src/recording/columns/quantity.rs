//! The quantities that a recording may hold.

use super::units::Dimension;

/// A quantity that a recording may hold, by the key under which its column is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    Time,
    Force(usize),
    Rate(usize),
    Angle(usize),
    /// w, x, y and z of the rotation from the recording's axes to fixed ones, in place of angles.
    Quaternion(usize),
    Speed,
    Lean,
    Position(usize),
    /// Latitude and longitude, in degrees unless the file says otherwise.
    Geographic(usize),
}

impl Quantity {
    /// Every quantity, in the order of columns.
    pub fn all() -> impl Iterator<Item = Quantity> {
        let axes: [fn(usize) -> Quantity; 3] = [Quantity::Force, Quantity::Rate, Quantity::Angle];
        let places: [fn(usize) -> Quantity; 2] = [Quantity::Position, Quantity::Geographic];
        let of = |count: usize| move |quantity: fn(usize) -> Quantity| (0..count).map(quantity);
        let alone = [Quantity::Speed, Quantity::Lean];
        let measured = axes.into_iter().flat_map(of(3)).chain(Quantity::QUATERNION).chain(alone);
        [Quantity::Time].into_iter().chain(measured).chain(places.into_iter().flat_map(of(2)))
    }

    /// Roll, pitch and yaw.
    pub const ANGLES: [Quantity; 3] = [Quantity::Angle(0), Quantity::Angle(1), Quantity::Angle(2)];

    /// The parts of a quaternion.
    pub const QUATERNION: [Quantity; 4] =
        [Quantity::Quaternion(0), Quantity::Quaternion(1), Quantity::Quaternion(2), Quantity::Quaternion(3)];

    /// True for angles, which are the same after a turn.
    pub fn is_angle(self) -> bool {
        matches!(self, Quantity::Angle(_) | Quantity::Lean | Quantity::Geographic(_))
    }

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
            Quantity::Angle(_) | Quantity::Quaternion(_) | Quantity::Lean | Quantity::Geographic(_) => Dimension::Angle,
            Quantity::Speed => Dimension::Speed,
            Quantity::Position(_) => Dimension::Length,
        }
    }

    /// The quantity's key, which is also its column's name unless another is given.
    pub fn key(self) -> &'static str {
        match self {
            Quantity::Time => "time",
            Quantity::Force(axis) => ["ax", "ay", "az"][axis],
            Quantity::Rate(axis) => ["wx", "wy", "wz"][axis],
            Quantity::Angle(axis) => ["roll", "pitch", "yaw"][axis],
            Quantity::Quaternion(part) => ["qw", "qx", "qy", "qz"][part],
            Quantity::Speed => "speed",
            Quantity::Lean => "lean",
            Quantity::Position(axis) => ["x", "y"][axis],
            Quantity::Geographic(axis) => ["latitude", "longitude"][axis],
        }
    }

    /// The quantity of a key.
    ///
    /// # Errors
    /// The key is unknown. The message lists the known ones.
    pub fn of_key(key: &str) -> Result<Self, String> {
        let keys = || Self::all().map(Self::key).collect::<Vec<_>>().join(", ");
        let found = Self::all().find(|quantity| quantity.key() == key);
        found.ok_or_else(|| format!("there is no key {key}; there are {}", keys()))
    }
}
