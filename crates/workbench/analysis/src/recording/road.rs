//! The vehicle's way, and what is learned of it.

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
    /// The road of a table; none if it has no position.
    pub fn of(table: &Table) -> Option<Self> {
        let [x, y] = [0, 1].map(|axis| table.columns.get(&Quantity::Position(axis)));
        let positions = x?.iter().zip(y?).map(|(x, y)| [*x, *y]).collect();
        Some(Road { positions, speeds: table.columns.get(&Quantity::Speed).cloned() })
    }

    /// The position at a sample \[m\].
    pub fn position(&self, number: usize) -> Option<[f64; 3]> {
        self.positions.get(number).map(|[x, y]| [*x, *y, 0.0])
    }

    /// The previews that are learned on it, as of each sample.
    pub fn learned(&self, inputs: &[Input], step: f64) -> Vec<Preview> {
        let mut laps = Laps::new();
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
