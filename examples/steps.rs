//! Steps the washout as often as it is told, on a smooth ride on all axes: for profilers and instruction counters.
//!
//!     cargo run --release --example steps 1000000

use std::f64::consts::TAU;
use std::hint::black_box;

use moris_washout::{Input, Parameters, Refusal, Washout};

fn main() -> Result<(), Refusal> {
    let count = std::env::args().nth(1).and_then(|count| count.parse().ok()).unwrap_or(1_000_000);
    let ride: Vec<Input> = (0..8192)
        .map(|k| {
            let phase = TAU * f64::from(k) / 8192.0;
            let mut input = Input::default();
            input.specific_force.x = 0.5 * phase.sin();
            input.specific_force.y = 0.3 * (2.0 * phase).sin();
            input.specific_force.z += 0.2 * (3.0 * phase).sin();
            input.angular_velocity.x = 0.02 * (2.0 * phase).sin();
            input.orientation.roll = 0.1 * (2.0 * phase).sin();
            input.orientation.pitch = 0.02 * phase.sin();
            input
        })
        .collect();
    let mut washout = Washout::new(&Parameters::default())?;
    for input in ride.iter().cycle().take(count) {
        washout.step(black_box(input), 0.001);
        black_box(washout.output());
    }
    println!("{count} steps, legs {:.6?} m", washout.output().length);
    Ok(())
}
