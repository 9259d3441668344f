//! Samples of several sensors that come by turns in one file.

use crate::message::Message;
use crate::recording::conventions::Quantity;
use crate::recording::signal::root_mean_square;
use crate::recording::table::Table;
use crate::texts::text;

/// The reason for a refusal where samples that lie a number apart are alike, and neighbours are
/// not, in several channels.
pub fn refusal(table: &Table) -> Option<Message> {
    // Most sensors that are looked for.
    const MOST: usize = 4;
    // Least samples of each.
    const LEAST_SAMPLES: usize = 50;
    // Largest change between samples of one sensor, as a part of that between neighbours.
    const ALIKE: f64 = 0.25;
    // Least of the measured channels that jump at every sample.
    const LEAST_CHANNELS: usize = 2;
    let measured = table.columns.iter().filter(|(quantity, _)| quantity.is_required());
    let channels: Vec<(&Quantity, &Vec<f64>)> = measured.collect();
    let change = |values: &[f64], apart: usize| {
        let changes: Vec<f64> = values.iter().skip(apart).zip(values).map(|(after, before)| after - before).collect();
        root_mean_square(&changes)
    };
    let is_usable = |count: &usize| table.time.len() >= count * LEAST_SAMPLES;
    let (count, jumping) = (2..=MOST).filter(is_usable).find_map(|count| {
        let jumps = |values: &[f64]| {
            let near = (1..count).map(|apart| change(values, apart)).fold(f64::INFINITY, f64::min);
            change(values, count) < ALIKE * near
        };
        let jumping: Vec<&str> =
            channels.iter().filter(|(_, values)| jumps(values)).map(|(quantity, _)| quantity.key()).collect();
        (jumping.len() >= LEAST_CHANNELS).then_some((count, jumping))
    })?;
    Some(text!["sensors-by-turns", count, names = jumping.join(", ")])
}
