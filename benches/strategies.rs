//! Times of a step with each strategy, on a brisk ride with vibration.
//!
//! `cargo bench --bench strategies`. The ride is repeated, and each step counts with the least of
//! its times, so that other work on the machine does not count. A step's time is that of one call
//! with a step of 1 ms, in which the predictive strategy does a part of the work on its next plan.

use std::hint::black_box;
use std::time::{Duration, Instant};

use moris_washout::{Input, ParameterError, Parameters, Washout, presets};

#[path = "common/ride.rs"]
#[allow(dead_code)] // Other benchmarks use the rest of it.
mod ride;

use ride::brisk;

const STEP: f64 = 0.001;
const REPEATS: usize = 9;

fn main() -> Result<(), ParameterError> {
    let ride = brisk();
    println!("strategy     mean   median     99 %  99.99 %  slowest  [µs]");
    let sets: [(&str, &str); 5] = [
        ("classical", presets::CLASSICAL),
        ("adaptive", presets::ADAPTIVE),
        ("optimal", presets::OPTIMAL),
        ("robust", presets::ROBUST),
        ("predictive", ""),
    ];
    for (name, set) in sets {
        let times = least_times(&presets::parameters(set), &ride)?;
        let micros = |time: Duration| 1e6 * time.as_secs_f64();
        let part = |fraction: f64| micros(times[((times.len() - 1) as f64 * fraction).round() as usize]);
        let mean = times.iter().map(|&time| micros(time)).sum::<f64>() / times.len() as f64;
        let row = [mean, part(0.5), part(0.99), part(0.9999), part(1.0)].map(|value| format!("{value:7.2}"));
        println!("{name:10}  {}", row.join("  "));
    }
    Ok(())
}

/// The least time of each step over several repetitions, in ascending order.
fn least_times(parameters: &Parameters, ride: &[Input]) -> Result<Vec<Duration>, ParameterError> {
    let mut least = vec![Duration::MAX; ride.len()];
    for _ in 0..REPEATS {
        let mut washout = Washout::new(parameters)?;
        for (input, least) in ride.iter().zip(&mut least) {
            let start = Instant::now();
            washout.step(black_box(input), STEP);
            *least = start.elapsed().min(*least);
            black_box(washout.output());
        }
    }
    least.sort();
    Ok(least)
}
