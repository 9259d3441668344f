//! Time of a step in a run \[ns\], for `benches/python.py`.
//!
//! ```sh
//! cargo run --release -p moris-simulation --example one_run -- 5000
//! ```

use std::hint::black_box;
use std::time::Instant;

use moris_simulation::{Manoeuvre, Replay};
use moris_washout::{Input, Parameters, Washout};

fn main() {
    // Runs; the least time of them is that without interruptions by other programs.
    const RUNS: usize = 200;
    let steps = std::env::args_os().nth(1).and_then(|steps| steps.to_str()?.parse().ok()).unwrap_or(5_000);
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
        let mut washout = Washout::new(&Parameters::default()).expect("the default parameters can be used");
        let mut outputs = Vec::with_capacity(steps);
        Replay::new(&manoeuvre).run(&mut washout, |_, output| outputs.push(*output));
        let time = begin.elapsed();
        1e9 * time.as_secs_f64() / black_box(&outputs).len() as f64
    };
    println!("{}", (0..RUNS).map(run).fold(f64::INFINITY, f64::min));
}
