//! The vehicle's way, and what is learned of it.

use std::f64::consts::TAU;

use moris_laps::{Laps, Preview, Sample};
use moris_washout::Input;
use serde::{Deserialize, Serialize};

use super::columns::Quantity;
use super::table::Table;

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
        // A position that is repeated for longer is that of a vehicle at rest, or of no receiver
        // [s].
        const LONGEST_HOLD: f64 = 2.0;
        let pair = |of: fn(usize) -> Quantity| -> Option<Vec<[f64; 2]>> {
            let [one, other] = [0, 1].map(|axis| table.columns.get(&of(axis)));
            Some(one?.iter().zip(other?).map(|(one, other)| [*one, *other]).collect())
        };
        let mut positions =
            pair(Quantity::Position).or_else(|| Some(in_tangent_plane(&pair(Quantity::Geographic)?)))?;
        go_on(&mut positions, (LONGEST_HOLD / table.step()) as usize);
        Some(Road { positions, speeds: table.columns.get(&Quantity::Speed).cloned() })
    }

    /// The position at a sample \[m\].
    pub fn position(&self, number: usize) -> Option<[f64; 3]> {
        self.positions.get(number).map(|[x, y]| [*x, *y, 0.0])
    }

    /// False where the vehicle never changes its place, as where a logger has no receiver.
    pub fn leads_anywhere(&self) -> bool {
        self.positions.windows(2).any(|pair| pair[0] != pair[1])
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

/// Leads positions that a slow receiver repeats on to its next one, along a line. `most` is the
/// largest number of samples from one to the next.
fn go_on(positions: &mut [[f64; 2]], most: usize) {
    let mut from = 0;
    for to in 1..positions.len() {
        let [held, next] = [positions[from], positions[to]];
        if next == held {
            continue;
        }
        let count = to - from;
        for k in (1..count).filter(|_| count <= most) {
            let part = k as f64 / count as f64;
            positions[from + k] = [0, 1].map(|axis| held[axis] + part * (next[axis] - held[axis]));
        }
        from = to;
    }
}

/// Places by latitude and longitude \[rad\], in metres to the east and to the north of the first.
fn in_tangent_plane(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    // Half axes of the earth along the equator and to the poles [m] (WGS 84).
    const EARTH: [f64; 2] = [6_378_137.0, 6_356_752.314_245];
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
    fn positions_that_are_repeated_go_on_to_the_next_one() {
        let along = |xs: &[f64]| xs.iter().map(|x| [*x, 2.0 * x]).collect::<Vec<_>>();
        let mut positions = along(&[0.0, 0.0, 0.0, 0.0, 8.0, 9.0, 9.0, 11.0, 11.0, 11.0]);
        let mut slow = positions.clone();
        go_on(&mut positions, 4);
        assert_eq!(positions, along(&[0.0, 2.0, 4.0, 6.0, 8.0, 9.0, 10.0, 11.0, 11.0, 11.0]));
        go_on(&mut slow, 3);
        assert_eq!(slow, along(&[0.0, 0.0, 0.0, 0.0, 8.0, 9.0, 10.0, 11.0, 11.0, 11.0]), "held for too long");
    }

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
