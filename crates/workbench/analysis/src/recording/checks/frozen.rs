//! Sensors that stop in the middle of a recording, repeated values, and values of few digits.

use std::ops::Range;

use moris_interface::shown;
use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;

use super::Channels;
use super::channels::{LEAST_CHANGE, LEAST_SWAY};
use crate::message::{Message, given, message};
use crate::recording::conventions::{Conventions, Quantity};
use crate::recording::signal::{integral, is_constant, median, root_mean_square, runs, smooth, sorted};
use crate::recording::table::Table;

/// Time from which a value that stays is looked at \[s\].
const STAYS: f64 = 2.0;
/// Largest part of a recording in which a sensor has stopped: one that never moves was never there.
const MOST: f64 = 0.95;
/// Speed above which bends need a yaw rate \[m/s\].
const DRIVES: f64 = 3.0;
/// Times that each value is repeated, from which the steps are felt.
const REPEATED: usize = 3;
/// Least number of steps that are looked at, and the part of the samples that they must be.
const STEPS: usize = 20;
const MOSTLY: f64 = 0.6;
/// Part of the steps that are as long as the usual one.
const EVENLY: f64 = 0.9;

/// Distance of a force's and of a rate's values from which its steps are felt \[m/s2, rad/s\].
const COARSE: [f64; 2] = [0.15, 0.05];
/// Number of values from which a signal is no test of a few steps.
const LEVELS: usize = 4;

/// Warnings about forces and yaw rates that stay at one value for seconds, while the speed changes
/// or the vehicle drives bends.
pub fn stops(channels: &Channels) -> Vec<String> {
    if !channels.has(Quantity::Speed) {
        return Vec::new();
    }
    let Channels { table, inputs, speeds, step, .. } = channels;
    let of_force = |part: &Range<usize>| {
        // On a slope the force holds the vehicle without a change of its speed.
        let along = |input: &Input| input.specific_force.x + STANDARD_GRAVITY * input.orientation.pitch.sin();
        let driven = integral(inputs[part.clone()].iter().map(along), *step);
        let changes = channels.changes(&speeds[part.clone()]).into_iter().zip(channels.changes(&driven));
        let left: Vec<f64> = changes.map(|(change, driven)| change - driven).collect();
        root_mean_square(&left) >= LEAST_CHANGE
    };
    let of_rate = |part: &Range<usize>| {
        let lateral = || smooth(inputs[part.clone()].iter().map(|input| input.specific_force.y), *step);
        median(speeds[part.clone()].iter().map(|speed| speed.abs())) > DRIVES
            && root_mean_square(&lateral()) >= LEAST_SWAY
    };
    let found = |quantity: Quantity, contradicts: &dyn Fn(&Range<usize>) -> bool, fact: &str| {
        let values = table.columns.get(&quantity).filter(|values| !is_constant(values))?;
        let least = ((STAYS / step) as usize).max(REPEATED);
        // One that stays throughout is not measured at all.
        let stays = |run: &Range<usize>| run.len() > least && (run.len() as f64) < MOST * values.len() as f64;
        let stop = runs(values, |a, b| a == b).filter(stays).find(contradicts)?;
        let [from, to] = [stop.start, stop.end].map(|sample| channels.time(sample));
        Some(format!(
            "Column {} stays at one value from {from:.1} s to {to:.1} s, while {fact}: the sensor has stopped. Cut this \
             part off.",
            quantity.key()
        ))
    };
    [
        found(Quantity::Force(0), &of_force, "the speed changes otherwise"),
        found(Quantity::Rate(2), &of_rate, "the lateral force is that of bends"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Warnings about channels whose values are so far apart that their steps are felt.
pub fn coarse(table: &Table, conventions: &Conventions) -> Vec<Message> {
    let distance = |quantity: Quantity, least: f64| {
        let values = table.columns.get(&quantity)?;
        let changes = values.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let mut levels = sorted(values.iter().copied());
        levels.dedup();
        let nearest = levels.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        (levels.len() >= LEVELS && changes >= STEPS && nearest >= least).then(|| {
            let unit = table.unit(quantity).0;
            let (name, distance) = (conventions.column(quantity), shown((nearest / unit.in_si * 1e6).round() / 1e6));
            format!(
                "The values of {name} are {distance} {} apart or more: their steps are felt as jolts. Record or export it \
                 with more digits.",
                unit.word
            )
        })
    };
    let all = (0..3).flat_map(|axis| [(Quantity::Force(axis), COARSE[0]), (Quantity::Rate(axis), COARSE[1])]);
    all.filter_map(|(quantity, least)| distance(quantity, least)).map(Message::from).collect()
}

/// A warning about channels whose values come several times in a row: they were sampled at a lower
/// rate than they are written.
pub fn repeats(table: &Table, conventions: &Conventions) -> Option<Message> {
    let step = table.step();
    let times = |quantity: &Quantity| {
        let values = table.columns.get(quantity).filter(|values| !is_constant(values))?;
        // At rest a value may stay for long.
        let runs: Vec<usize> = values.chunk_by(|a, b| a == b).map(<[f64]>::len).collect();
        let short: Vec<usize> = runs.into_iter().filter(|run| (*run as f64) * step <= 1.0).collect();
        let repeated: usize = short.iter().filter(|run| **run >= REPEATED).sum();
        let is_held = short.len() >= STEPS && repeated as f64 > MOSTLY * short.iter().sum::<usize>() as f64;
        let usual = sorted(short.iter().map(|run| *run as f64));
        let usual = usual.get(usual.len() / 2).copied().unwrap_or(0.0) as usize;
        // Signals of few digits stay for as long as they are slow, and not for a fixed time.
        let even = short.iter().filter(|run| run.abs_diff(usual) <= 1).count();
        (is_held && usual >= REPEATED && even as f64 >= EVENLY * short.len() as f64).then_some(usual)
    };
    let all = (0..3).map(Quantity::Force).chain((0..3).map(Quantity::Rate));
    let found: Vec<(Quantity, usize)> = all.filter_map(|quantity| Some((quantity, times(&quantity)?))).collect();
    let &(_, usual) = found.iter().min_by_key(|(_, usual)| *usual)?;
    let names: Vec<&str> = found.iter().map(|(quantity, _)| conventions.column(*quantity)).collect();
    let rate = 1.0 / (usual as f64 * step);
    let names = names.join(", ");
    Some(message![
        "Each value of {names} comes {usual} times: measured at about {rate:.1} Hz, it changes in steps, which are felt as \
         jolts. ",
        given("resample", format!("{rate:.1}")),
        " takes each value once."
    ])
}
