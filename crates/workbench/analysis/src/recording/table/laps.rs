//! Laps in one file, of which each starts with the time of the first.

use super::Table;
use crate::message::given;
use crate::recording::conventions::{Conventions, Quantity};
use crate::recording::message::RecordingError;
use crate::texts::text;

/// Keeps the lap that the conventions choose.
///
/// # Errors
/// There are several laps and none is chosen, or there is no such lap.
pub fn choose(table: &mut Table, conventions: &Conventions) -> Result<(), RecordingError> {
    // Least step back in time with which a lap begins [s].
    const RESTART: f64 = 1.0;
    // Number of laps of equally many samples that are a counter's.
    const COUNTED: usize = 4;
    let restarts = (1..table.time.len()).filter(|&k| table.time[k] < table.time[k - 1] - RESTART);
    let starts: Vec<usize> = [0].into_iter().chain(restarts).collect();
    let laps = starts.len();
    let Some(lap) = conventions.lap else {
        let Some(&second) = starts.get(1) else { return Ok(()) };
        let is_counter = laps >= COUNTED && starts.windows(2).all(|pair| pair[1] - pair[0] == second);
        let last = given("lap", laps);
        let reason = match is_counter {
            true => text!["counter-begins-again", second, laps, last],
            false => text!["several-laps", laps, last],
        };
        return Err(table.refused_at(second, Quantity::Time, reason));
    };
    let end = starts.get(lap).copied().unwrap_or(table.time.len());
    let Some(range) = starts.get(lap - 1).map(|&start| start..end).filter(|range| range.len() > 1) else {
        return Err(table.refused(text!["no-such-lap", lap, laps]));
    };
    table.keep(range);
    Ok(())
}
