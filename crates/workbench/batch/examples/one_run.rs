//! Time of a step in a run \[ns\], for `benches/python.py`.
//!
//! ```sh
//! cargo run --release -p moris-batch --example one_run -- 5000
//! ```

use std::hint::black_box;
use std::time::Instant;

use moris_batch::{Manoeuvre, Observer, simulate};
use moris_washout::{Input, Output, Parameters};

/// Keeps every output.
struct Outputs(Vec<Output>);

impl Observer for Outputs {
    fn observe(&mut self, _: &Input, output: &Output) {
        self.0.push(*output);
    }
}

/// Runs; the least time of them is that without interruptions by other programs.
const RUNS: usize = 200;

fn main() {
    let steps = std::env::args().nth(1).and_then(|steps| steps.parse().ok()).unwrap_or(5_000);
    let sample = |k: usize| {
        let time = 0.001 * k as f64;
        let mut input = Input::default();
        input.specific_force.x = time.sin();
        input.specific_force.y = 0.5 * time.cos();
        input.specific_force.z += 0.1 * (3.0 * time).sin();
        input.angular_velocity.x = 0.1 * time.cos();
        input.angular_velocity.z = 0.1 * time.sin();
        input
    };
    let manoeuvre = Manoeuvre::new(0.001, (0..=steps).map(sample).collect());
    let run = |_| {
        let begin = Instant::now();
        let outputs = simulate(&manoeuvre, &Parameters::default(), Outputs(Vec::with_capacity(steps)));
        let time = begin.elapsed();
        let outputs = outputs.expect("the default parameters can be used");
        1e9 * time.as_secs_f64() / black_box(&outputs.0).len() as f64
    };
    println!("{}", (0..RUNS).map(run).fold(f64::INFINITY, f64::min));
}
