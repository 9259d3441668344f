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
/// Speed below which a vehicle stands \[m/s\].
const STANDING_SPEED: f64 = 0.3;
/// Times that each value is repeated, from which the steps are felt.
const MIN_REPETITIONS: usize = 3;
/// Least number of steps that are looked at.
const MIN_STEPS: usize = 20;

/// Channels of a sensor, or all, that stand still for seconds and then jump together. Computed
/// rides that are steady end so smoothly.
pub fn repeated_lines(channels: &Channels, sensor: Quantity) -> Option<Message> {
    // Time for which several channels stand still [s].
    const MIN_REPEATED_TIME: f64 = 1.4;
    // Changes of a channel in its usual ones, and the number of channels, from which they jump.
    const JUMP_SIZE: f64 = 5.0;
    const MIN_JUMPING: usize = 2;
    // Part of the recording from which on a receiver of less than a value a second causes it.
    const SLOW_FRACTION: f64 = 0.8;
    let Channels { table, step, .. } = channels;
    let is_of_sensor = |quantity: &Quantity| {
        sensor == Quantity::Time || std::mem::discriminant(quantity) == std::mem::discriminant(&sensor)
    };
    let measured = table.columns.iter().filter(|(quantity, _)| channels.is_measured(**quantity));
    let moving = measured.filter(|(quantity, values)| is_of_sensor(quantity) && !is_constant(values));
    let (quantities, moving): (Vec<&Quantity>, Vec<&Vec<f64>>) = moving.unzip();
    let changes = (1..table.time.len()).map(|k| f64::from(moving.iter().any(|values| values[k] != values[k - 1])));
    let changes: Vec<f64> = changes.collect();
    let jumps = |end: usize| {
        let jumps = |values: &&&Vec<f64>| {
            let usual: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
            (values[end] - values[end - 1]).abs() > JUMP_SIZE * root_mean_square(&usual)
        };
        moving.iter().filter(jumps).count() >= MIN_JUMPING
    };
    let least = (MIN_REPEATED_TIME / step) as usize;
    let is_stop = |run: &Range<usize>| changes[run.start] == 0.0 && run.len() > least && run.end < changes.len();
    let stops: Vec<Range<usize>> = runs(&changes, |a, b| a == b).filter(is_stop).collect();
    let stopped: usize = stops.iter().map(Range::len).sum();
    let stop = stops.iter().find(|stop| jumps(stop.end + 1))?;
    let is_slow = stopped as f64 > SLOW_FRACTION * changes.len() as f64;
    // A stop of all channels is reported once.
    if is_slow || sensor != Quantity::Time && repeated_lines(channels, Quantity::Time).is_some() {
        return None;
    }
    let [from, to] = [stop.start, stop.end].map(|sample| channels.time(sample));
    if sensor == Quantity::Time {
        return Some(text!["repeated-lines", from, to]);
    }
    let names: Vec<&str> = quantities.iter().map(|quantity| quantity.key()).collect();
    Some(text!["stopped-together", names = names.join(", "), from, to])
}

/// A speed that stays at one value for seconds and then jumps, as of a receiver without a fix.
pub fn stopped_speed(channels: &Channels, quantity: Quantity) -> Option<Message> {
    // Acceleration that no vehicle has [m/s2], and a change of speed that is none of a collision
    // [m/s].
    const MAX_ACCELERATION: f64 = 15.0;
    const MIN_SPEED_JUMP: f64 = 4.0;
    let values = channels.table.columns.get(&quantity)?;
    let is_same = |a: &f64, b: &f64| a == b;
    // A receiver of 1 Hz changes once a second.
    let usual = median(runs(values, is_same).map(|run| run.len() as f64));
    let most = MIN_SPEED_JUMP.max(MAX_ACCELERATION * usual * channels.step);
    let least = (MIN_STOP_TIME / channels.step) as usize;
    let jumps =
        |sample: usize| sample > 0 && sample < values.len() && (values[sample] - values[sample - 1]).abs() > most;
    let stop = runs(values, is_same).find(|run| run.len() > least && (jumps(run.start) || jumps(run.end)))?;
    let [from, to] = [stop.start, stop.end].map(|sample| channels.time(sample));
    Some(text!["stopped-speed", name = channels.conventions.column(quantity), from, to])
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
            // A force that stays while the vehicle stands is a bias, or of another axis.
            if speeds[part.clone()].iter().all(|speed| speed.abs() < STANDING_SPEED) {
                return false;
            }
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
