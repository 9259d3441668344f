//! Resampling at equal steps. Measures and comparisons need them, the washout's filters do not.

use moris_interface::shown;

use super::Table;
use super::join::GAP;
use crate::recording::conventions::{Conventions, Quantity};
use crate::recording::median;
use crate::recording::message::{RecordingError, given, named};

/// Largest distance of a sample from its time at equal steps \[fractions of a step\]. It allows for
/// times written with few digits.
const JITTER: f64 = 0.2;
/// Coarsest step of a usable recording \[s\].
const COARSEST: f64 = 0.25;
/// Finest step: below it, time is in another unit \[s\].
const FINEST: f64 = 1e-5;
/// Largest number of samples: about a day at 100 Hz.
const MOST_SAMPLES: f64 = 1e7;

/// The recording at equal steps, with warnings. It is unchanged if its steps are equal, and
/// interpolated if an option asks for it.
///
/// # Errors
/// Time does not increase, the steps are unequal and interpolation is off, or the steps are too
/// coarse or too fine for the unit of time.
pub fn at_equal_steps(mut table: Table, conventions: &Conventions) -> Result<(Table, Vec<String>), RecordingError> {
    let spread = conventions.resample.and_then(|_| spread_equal_times(&mut table.time));
    table.warnings.extend(spread);
    check_order(&table)?;
    check_unit(&table)?;
    match conventions.resample {
        Some(rate) => resampled(&table, rate),
        None => check_equal(&table).map(|()| (table, Vec::new())),
    }
}

/// Spreads samples of equal times, as clocks with few digits write them, evenly up to the next
/// time. Returns a warning if there are any.
pub fn spread_equal_times(time: &mut [f64]) -> Option<String> {
    let mean = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let (mut first, mut spread) = (0, 0);
    while first < time.len() {
        let count = time[first..].iter().take_while(|&&t| t == time[first]).count();
        // The last times have none after them.
        let step = time.get(first + count).map_or(mean, |next| (next - time[first]) / count as f64);
        for k in 1..count {
            time[first + k] += k as f64 * step;
        }
        spread += count - 1;
        first += count;
    }
    (spread > 0)
        .then(|| format!("{spread} samples have the time of the one before; they are spread evenly up to the next."))
}

/// The remedy where a sample has the time of the one before.
pub fn remedy_for_equal_times(time: &[f64], sample: usize) -> String {
    let duration = time[time.len() - 1] - time[0];
    if time[sample] != time[sample - 1] || duration <= 0.0 {
        return String::new();
    }
    let rate = (time.len() - 1) as f64 / duration;
    format!("; if the times are rounded, {} spreads equal ones evenly", given("resample", format!("{rate:.0}")))
}

fn line_error(table: &Table, sample: usize, reason: String) -> RecordingError {
    let column = Some("time".to_owned());
    RecordingError::Line { file: table.file.clone(), line: table.lines[sample], column, reason }
}

fn check_order(table: &Table) -> Result<(), RecordingError> {
    for (k, pair) in table.time.windows(2).enumerate() {
        let [before, after] = [pair[0], pair[1]];
        if after <= before {
            let what = if after < before { "goes back" } else { "stands still" };
            return Err(line_error(
                table,
                k + 1,
                format!(
                    "time {what}: {} s comes after {} s{}",
                    shown(after),
                    shown(before),
                    remedy_for_equal_times(&table.time, k + 1)
                ),
            ));
        }
    }
    Ok(())
}

/// The median step \[s\], which is insensitive to missing samples and outliers.
fn usual_step(table: &Table) -> f64 {
    median(table.time.windows(2).map(|pair| pair[1] - pair[0]))
}

fn check_unit(table: &Table) -> Result<(), RecordingError> {
    let usual = usual_step(table);
    let unit = table.column(Quantity::Time).map_or("s", |column| column.unit.word);
    let reason = if usual > COARSEST {
        format!("too coarse for a washout; if time is in ms or another unit, give it with {}", named("time-unit"))
    } else if usual < FINEST {
        format!("finer than any recording; give the unit of time with {}", named("time-unit"))
    } else {
        return Ok(());
    };
    let reason = format!("samples come every {usual} s if time is in {unit}: {reason}");
    Err(RecordingError::Whole { file: table.file.clone(), reason })
}

fn check_equal(table: &Table) -> Result<(), RecordingError> {
    let (step, usual) = (table.step(), usual_step(table));
    let expected = |k: usize| table.time[0] + k as f64 * step;
    let Some(off) = (0..table.time.len()).find(|&k| (table.time[k] - expected(k)).abs() > JITTER * step) else {
        return Ok(());
    };
    // The sample that is farthest off rarely has the unusual step. So the first
    // unusual step is named.
    let step_to = |k: usize| table.time[k] - table.time[k - 1];
    let odd = (1..table.time.len()).find(|&k| (step_to(k) - usual).abs() > JITTER * usual).unwrap_or(off);
    let reason = format!(
        "the samples do not come at equal steps: here {:.4} s after the one before, otherwise {usual:.4} s; {} \
         interpolates them",
        step_to(odd),
        given("resample", format!("{:.0}", 1.0 / usual))
    );
    Err(line_error(table, odd, reason))
}

/// Linear interpolation at `rate` samples a second.
fn resampled(table: &Table, rate: f64) -> Result<(Table, Vec<String>), RecordingError> {
    let (first, last) = (table.time[0], table.time[table.time.len() - 1]);
    let steps = (last - first) * rate + 1e-6;
    if steps > MOST_SAMPLES {
        let reason = format!("{:.0} s at {rate} samples a second are too many; interpolate at fewer", last - first);
        return Err(RecordingError::Whole { file: table.file.clone(), reason });
    }
    let count = steps.floor() as usize + 1;
    let time: Vec<f64> = (0..count.max(2)).map(|k| first + k as f64 / rate).collect();
    let mut after = 1;
    let places: Vec<(usize, f64)> = time
        .iter()
        .map(|&t| {
            while after + 1 < table.time.len() && table.time[after] < t {
                after += 1;
            }
            let (t0, t1) = (table.time[after - 1], table.time[after]);
            (after, ((t - t0) / (t1 - t0)).clamp(0.0, 1.0))
        })
        .collect();
    let interpolated = |values: &Vec<f64>| {
        places.iter().map(|&(k, t)| values[k - 1] + t * (values[k] - values[k - 1])).collect::<Vec<f64>>()
    };
    let columns = table.columns.iter().map(|(&quantity, values)| (quantity, interpolated(values))).collect();
    let lines = places.iter().map(|&(k, _)| table.lines[k]).collect();
    let warnings = gaps(table);
    let Table { file, layout, warnings: earlier, .. } = table;
    let (file, layout, earlier) = (file.clone(), layout.clone(), earlier.clone());
    Ok((Table { file, time, columns, layout, lines, warnings: earlier }, warnings))
}

fn gaps(table: &Table) -> Vec<String> {
    let long = table.time.windows(2).zip(&table.lines).filter(|(pair, _)| pair[1] - pair[0] > GAP);
    long.map(|(pair, line)| {
        format!(
            "Nothing was recorded for {:.2} s after line {line}; the gap is interpolated linearly.",
            pair[1] - pair[0]
        )
    })
    .collect()
}

/// The quantities that a table at equal steps has at one sample; zero where it has no such column.
pub fn at(table: &Table, quantity: Quantity, sample: usize) -> f64 {
    table.columns.get(&quantity).map_or(0.0, |column| column[sample])
}
