//! Single channels: a sensor that stops, values that are repeated, and values of few digits.

use std::ops::Range;

use moris_interface::shown;
use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;

use super::channels::{BEND_SPEED, Channels, MIN_BEND_FORCE, MIN_SPEED_CHANGE};
use crate::message::{Message, given};
use crate::recording::conventions::Quantity;
use crate::recording::signal::{integral, is_constant, median, root_mean_square, runs, smooth, sorted};
use crate::texts::text;

/// Time from which a value that stays is looked at \[s\].
const MIN_STOP_TIME: f64 = 2.0;
/// Times that each value is repeated, from which the steps are felt.
const MIN_REPETITIONS: usize = 3;
/// Least number of steps that are looked at.
const MIN_STEPS: usize = 20;

/// Lines that are repeated for seconds, after which several channels jump. Computed rides that are
/// steady end so smoothly.
pub fn repeated_lines(channels: &Channels, _: Quantity) -> Option<Message> {
    // Changes of a channel in its usual ones, and the number of channels, from which they jump.
    const JUMP_SIZE: f64 = 5.0;
    const MIN_JUMPING: usize = 2;
    // Most times that a logger repeats its last line for seconds.
    const MAX_REPEATED_LINES: usize = 10;
    let Channels { table, step, .. } = channels;
    let measured = table.columns.iter().filter(|(quantity, _)| channels.is_measured(**quantity));
    let moving: Vec<&Vec<f64>> = measured.map(|(_, values)| values).filter(|values| !is_constant(values)).collect();
    let changes = (1..table.time.len()).map(|k| f64::from(moving.iter().any(|values| values[k] != values[k - 1])));
    let changes: Vec<f64> = changes.collect();
    let jumps = |end: usize| {
        let jumps = |values: &&&Vec<f64>| {
            let usual: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
            (values[end] - values[end - 1]).abs() > JUMP_SIZE * root_mean_square(&usual)
        };
        moving.iter().filter(jumps).count() >= MIN_JUMPING
    };
    let least = (MIN_STOP_TIME / step) as usize;
    let is_stop = |run: &Range<usize>| changes[run.start] == 0.0 && run.len() > least && run.end < changes.len();
    let stops: Vec<Range<usize>> = runs(&changes, |a, b| a == b).filter(is_stop).collect();
    // A receiver of less than a value a second stands still between all of them.
    let stop = stops.iter().find(|stop| stops.len() <= MAX_REPEATED_LINES && jumps(stop.end + 1))?;
    Some(text!["repeated-lines", from = channels.time(stop.start), to = channels.time(stop.end)])
}

/// A force or yaw rate that stays at one value for seconds, while the speed changes otherwise or
/// the vehicle drives bends.
pub fn stop(channels: &Channels, quantity: Quantity) -> Option<Message> {
    // Largest part of a recording in which a sensor has stopped: one that never moves was never
    // there.
    const MAX_STOP_FRACTION: f64 = 0.95;
    let Channels { table, inputs, speeds, step, .. } = channels;
    let (is_of_force, contradiction) = match quantity {
        Quantity::Force(_) => (true, "the speed changes otherwise"),
        _ => (false, "the lateral force is that of bends"),
    };
    let is_contradicted = |part: &Range<usize>| {
        if is_of_force {
            // On a slope the force holds the vehicle without a change of its speed.
            let along = |input: &Input| input.specific_force.x + STANDARD_GRAVITY * input.orientation.pitch.sin();
            let driven = integral(inputs[part.clone()].iter().map(along), *step);
            let changes = channels.changes(&speeds[part.clone()]).into_iter().zip(channels.changes(&driven));
            let left: Vec<f64> = changes.map(|(change, driven)| change - driven).collect();
            return root_mean_square(&left) >= MIN_SPEED_CHANGE;
        }
        let lateral = || smooth(inputs[part.clone()].iter().map(|input| input.specific_force.y), *step);
        median(speeds[part.clone()].iter().map(|speed| speed.abs())) > BEND_SPEED
            && root_mean_square(&lateral()) >= MIN_BEND_FORCE
    };
    let values = table.columns.get(&quantity).filter(|values| !is_constant(values))?;
    let least = ((MIN_STOP_TIME / step) as usize).max(MIN_REPETITIONS);
    // One that stays throughout is not measured at all.
    let stays = |run: &Range<usize>| run.len() > least && (run.len() as f64) < MAX_STOP_FRACTION * values.len() as f64;
    let stop = runs(values, |a, b| a == b).filter(stays).find(is_contradicted)?;
    let [from, to] = [stop.start, stop.end].map(|sample| channels.time(sample));
    Some(text!["stopped", name = quantity.key(), from, to, contradiction])
}

/// A channel whose values are so far apart that their steps are felt.
pub fn coarse(channels: &Channels, quantity: Quantity) -> Option<Message> {
    // Distance of a force's and of a rate's values from which its steps are felt [m/s2, rad/s].
    const COARSE_FORCE: f64 = 0.15;
    const COARSE_RATE: f64 = 0.05;
    // Number of values from which a signal is no test of a few steps.
    const MIN_LEVELS: usize = 4;
    let least = if let Quantity::Force(_) = quantity { COARSE_FORCE } else { COARSE_RATE };
    let values = channels.whole.columns.get(&quantity)?;
    let changes = values.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let mut levels = sorted(values.iter().copied());
    levels.dedup();
    let nearest = levels.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    if levels.len() < MIN_LEVELS || changes < MIN_STEPS || nearest < least {
        return None;
    }
    let unit = channels.table.unit(quantity).0;
    let (name, distance) = (channels.conventions.column(quantity), shown((nearest / unit.in_si * 1e6).round() / 1e6));
    Some(text!["coarse", name, distance, unit = unit.word])
}

/// Channels whose values come several times in a row: they were sampled at a lower rate than they
/// are written.
pub fn repeated(channels: &Channels, _: Quantity) -> Option<Message> {
    // Part of the samples that the steps must be.
    const REPEATED_FRACTION: f64 = 0.6;
    // Part of the steps that are as long as the usual one.
    const EVEN_FRACTION: f64 = 0.9;
    let table = channels.whole;
    let step = table.step();
    let times = |quantity: &Quantity| {
        let values = table.columns.get(quantity).filter(|values| !is_constant(values))?;
        // At rest a value may stay for long.
        let runs = values.chunk_by(|a, b| a == b).map(<[f64]>::len);
        let short: Vec<usize> = runs.filter(|run| (*run as f64) * step <= 1.0).collect();
        let repeated: usize = short.iter().filter(|run| **run >= MIN_REPETITIONS).sum();
        let is_held =
            short.len() >= MIN_STEPS && repeated as f64 > REPEATED_FRACTION * short.iter().sum::<usize>() as f64;
        let usual = sorted(short.iter().map(|run| *run as f64));
        let usual = usual.get(usual.len() / 2).copied().unwrap_or(0.0) as usize;
        // Signals of few digits stay for as long as they are slow, and not for a fixed time.
        let even = short.iter().filter(|run| run.abs_diff(usual) <= 1).count();
        let is_even = even as f64 >= EVEN_FRACTION * short.len() as f64;
        (is_held && usual >= MIN_REPETITIONS && is_even).then_some(usual)
    };
    let all = (0..3).map(Quantity::Force).chain((0..3).map(Quantity::Rate));
    let found: Vec<(Quantity, usize)> = all.filter_map(|quantity| Some((quantity, times(&quantity)?))).collect();
    let &(_, count) = found.iter().min_by_key(|(_, usual)| *usual)?;
    let names: Vec<&str> = found.iter().map(|(quantity, _)| channels.conventions.column(*quantity)).collect();
    let rate = 1.0 / (count as f64 * step);
    let resample = given("resample", format!("{rate:.1}"));
    Some(text!["repeated", names = names.join(", "), count = count as f64, rate, resample])
}
