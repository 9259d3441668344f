//! The sign of a speed that loggers give without one.

use moris_washout::Input;

use super::consistency::{LEAST_CHANGE, WINDOW, changes};
use crate::recording::signal::{centred, integral, regression, root_mean_square};

/// Speed below which a vehicle stands \[m/s\].
const STANDS: f64 = 0.3;

/// The speeds with the sign of the direction, and a warning where the vehicle reverses.
///
/// Between two stops it reverses where the force along x is against the changes of the speed, while
/// both go together between others.
pub fn signed_speeds(inputs: &[Input], step: f64) -> (Vec<f64>, Option<String>) {
    let mut speeds: Vec<f64> = inputs.iter().map(|input| input.speed).collect();
    if speeds.iter().any(|speed| *speed < -STANDS) {
        return (speeds, None);
    }
    let drives = drives(&speeds, ((WINDOW / step) as usize).max(2));
    let forces: Vec<f64> = inputs.iter().map(|input| input.specific_force.x).collect();
    let direction = |drive: &(usize, usize)| {
        let part = drive.0..drive.1;
        let found = centred(changes(&speeds[part.clone()], step).into_iter());
        let expected = centred(changes(&integral(forces[part].iter().copied(), step), step).into_iter());
        let is_small = root_mean_square(&found) < LEAST_CHANGE || root_mean_square(&expected) < LEAST_CHANGE;
        if is_small { None } else { regression(&expected, &found) }
    };
    let directions: Vec<Option<f64>> = drives.iter().map(direction).collect();
    let is_against = |ratio: &Option<f64>| ratio.is_some_and(|ratio| ratio < 0.0);
    let goes_forward = directions.iter().any(|ratio| ratio.is_some_and(|ratio| ratio > 0.0));
    if !goes_forward || !directions.iter().any(is_against) {
        return (speeds, None);
    }
    let mut times = Vec::new();
    for ((first, last), _) in drives.iter().zip(&directions).filter(|(_, ratio)| is_against(ratio)) {
        speeds[*first..*last].iter_mut().for_each(|speed| *speed = -*speed);
        times.push(format!("{:.1} s to {:.1} s", *first as f64 * step, *last as f64 * step));
    }
    let times = times.join(", ");
    (
        speeds,
        Some(format!("The vehicle seems to reverse from {times}, where the speed has no sign: write it negative.")),
    )
}

/// The samples of each drive between two stops, from its first to behind its last, with a second or
/// more.
fn drives(speeds: &[f64], least: usize) -> Vec<(usize, usize)> {
    let mut start = 0;
    let parts = speeds.chunk_by(|a, b| (*a < STANDS) == (*b < STANDS)).map(|part| {
        start += part.len();
        (start - part.len(), start, part[0] < STANDS)
    });
    parts
        .filter(|(first, last, stands)| !stands && last - first > least)
        .map(|(first, last, _)| (first, last))
        .collect()
}
