//! Wrong units of roll and pitch, by their size.

use moris_washout::Input;

use super::remedy;
use crate::recording::conventions::{AngleUnit, Quantity};
use crate::recording::table::Table;

/// Roll or pitch that no vehicle exceeds \[rad\].
const STEEPEST: f64 = 3.2;

/// Rejects angles that no vehicle reaches.
pub fn check(table: &Table, inputs: &[Input]) -> Result<(), String> {
    let angles = inputs.iter().map(|input| input.orientation.roll.abs().max(input.orientation.pitch.abs()));
    let steepest = angles.fold(0.0, f64::max);
    if steepest <= STEEPEST {
        return Ok(());
    }
    Err(if table.unit(Quantity::Angle(0)).0 == AngleUnit::Radian.unit() {
        let remedy = remedy(table, Quantity::Angle(0), AngleUnit::Degree.word());
        format!("roll or pitch reaches {steepest:.0}: these are degrees, not radians; {remedy}")
    } else {
        format!("roll or pitch reaches {:.0} degrees, which no vehicle does", steepest.to_degrees())
    })
}
