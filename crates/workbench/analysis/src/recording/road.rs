//! The vehicle's way, and what is learned of it.

use std::f64::consts::TAU;

use moris_laps::{Laps, Preview, Sample};
use moris_washout::Input;
use serde::{Deserialize, Serialize};

use super::columns::Quantity;
use super::table::Table;

/// Half axes of the earth along the equator and to the poles \[m\] (WGS 84).
const EARTH: [f64; 2] = [6_378_137.0, 6_356_752.314_245];

/// Position and speed at each sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Road {
    /// Positions of the vehicle \[m\].
    positions: Vec<[f64; 2]>,
    /// Speeds, where the recording has them \[m/s\].
    speeds: Option<Vec<f64>>,
}

impl Road {
    /// The road of a table; none if it has no position. Latitude and longitude become metres in the
    /// tangent plane of the first sample, x to the east and y to the north.
    pub fn of(table: &Table) -> Option<Self> {
        let pair = |of: fn(usize) -> Quantity| -> Option<Vec<[f64; 2]>> {
            let [one, other] = [0, 1].map(|axis| table.columns.get(&of(axis)));
            Some(one?.iter().zip(other?).map(|(one, other)| [*one, *other]).collect())
        };
        let positions = pair(Quantity::Position).or_else(|| Some(in_tangent_plane(&pair(Quantity::Geographic)?)))?;
        Some(Road { positions, speeds: table.columns.get(&Quantity::Speed).cloned() })
    }

    /// The position at a sample \[m\].
    pub fn position(&self, number: usize) -> Option<[f64; 3]> {
        self.positions.get(number).map(|[x, y]| [*x, *y, 0.0])
    }

    /// The previews that are learned on it, as of each sample, with these laps known.
    pub fn learned(&self, inputs: &[Input], step: f64, laps: &mut Laps) -> Vec<Preview> {
        laps.interrupt();
        let preview = |(k, (input, [x, y])): (usize, (&Input, &[f64; 2]))| {
            laps.step(&Sample {
                step,
                position: [*x, *y, 0.0],
                speed: self.speeds.as_ref().map(|speeds| speeds[k]),
                force: [input.specific_force.x, input.specific_force.y],
            });
            laps.preview()
        };
        inputs.iter().zip(&self.positions).enumerate().map(preview).collect()
    }
}

/// Places by latitude and longitude \[rad\], in metres to the east and to the north of the first.
fn in_tangent_plane(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let Some([latitude, longitude]) = places.first().copied() else { return Vec::new() };
    let [equator, pole] = EARTH;
    let (sin, cos) = latitude.sin_cos();
    // Radii of curvature at the first place.
    let across = equator * equator / (equator * cos).hypot(pole * sin);
    let along = across.powi(3) * (pole / (equator * equator)).powi(2);
    let turned = |angle: f64| angle - TAU * (angle / TAU).round();
    let place = |[north, east]: &[f64; 2]| [across * cos * turned(east - longitude), along * (north - latitude)];
    places.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_metres_of_the_ellipsoid() {
        // A second of arc; the lengths of a degree at 0, 45 and 60 degrees are those of tables.
        for (latitude, north, east) in
            [(0.0, 110_574.0, 111_320.0), (45.0, 111_132.0, 78_847.0), (60.0, 111_412.0, 55_800.0)]
        {
            let first = [f64::to_radians(latitude), f64::to_radians(179.9999)];
            let second = f64::to_radians(1.0 / 3600.0);
            let places = [first, [first[0] + second, first[1]], [first[0], first[1] + second - TAU]];
            let [zero, up, right] = in_tangent_plane(&places)[..] else { panic!() };
            assert_eq!(zero, [0.0; 2]);
            assert!(up[0] == 0.0 && (3600.0 * up[1] - north).abs() < 2.0, "{up:?}");
            assert!(right[1] == 0.0 && (3600.0 * right[0] - east).abs() < 2.0, "{right:?}");
        }
    }
}
