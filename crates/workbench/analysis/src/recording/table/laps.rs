//! Laps in one file, of which each starts with the time of the first.

use super::Table;
use crate::message::{given, message, named};
use crate::recording::conventions::{Conventions, Quantity};
use crate::recording::message::RecordingError;

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
        let begins = match is_counter {
            true => message![
                "time begins again every {second} samples, as a counter does: ",
                given("rate", "HERTZ"),
                " reads none of the times; if these are {laps} laps, use "
            ],
            false => message!["time starts again: there are {laps} laps; use "],
        };
        let reason = message![begins, given("lap", 1), " to ", given("lap", laps), " to read one of them"];
        return Err(table.refused_at(second, Quantity::Time, reason));
    };
    let end = starts.get(lap).copied().unwrap_or(table.time.len());
    let Some(range) = starts.get(lap - 1).map(|&start| start..end).filter(|range| range.len() > 1) else {
        let reason = message!["has no samples of lap {lap}: time starts {laps} times; give another ", named("lap")];
        return Err(table.refused(reason));
    };
    table.keep(range);
    Ok(())
}
