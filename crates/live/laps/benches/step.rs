//! Benchmarks of the memory: a sample and the preview after it, while six passes are followed, and
//! the slowest step with a tick.
//!
//! `cargo bench -p moris-laps`

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use moris_laps::{Laps, Sample};

/// Duration of a lap \[s\].
const LAP: f64 = 50.0;

/// Samples of a lap with bends at its places, so many seconds apart.
fn lap(step: f64) -> Vec<Sample> {
    let sample = |k: usize| {
        let angle = TAU * k as f64 * step / LAP;
        let radius = 150.0 + 40.0 * (3.0 * angle).sin();
        Sample {
            step,
            position: [radius * angle.cos(), radius * angle.sin(), 0.0],
            speed: Some(radius * TAU / LAP),
            force: [3.0 * (5.0 * angle).sin(), 6.0 * (8.0 * angle).cos()],
        }
    };
    (0..(LAP / step).round() as usize).map(sample).collect()
}

fn step(c: &mut Criterion) {
    let mut bench = |name: &str, step: f64| {
        let lap = lap(step);
        let mut memory = Laps::new();
        lap.iter().cycle().take(8 * lap.len()).for_each(|sample| memory.step(sample));
        assert_eq!((memory.passes(), memory.preview().count), (6, 20));
        let mut samples = lap.iter().cycle();
        c.bench_function(name, |b| {
            b.iter(|| {
                if let Some(sample) = samples.next() {
                    memory.step(black_box(sample));
                }
                memory.preview()
            });
        });
    };
    bench("a sample each 1 ms", 0.001);
    bench("a sample each 20 ms", 0.02);
    bench("a sample each 50 ms: a tick in each step", 0.05);
}

/// The slowest step of a lap after so many, each the fastest of equal ones. With a break the passes
/// are found again.
fn slowest_step(_: &mut Criterion) {
    for (laps, breaks) in [(8, false), (8, true), (32, false), (32, true)] {
        let lap = lap(0.05);
        let mut memory = Laps::new();
        lap.iter().cycle().take(laps * lap.len()).for_each(|sample| memory.step(sample));
        let mut fastest = vec![Duration::MAX; lap.len()];
        for _ in 0..50 {
            let mut memory = memory.clone();
            if breaks {
                memory.interrupt();
            }
            for (sample, fastest) in lap.iter().zip(&mut fastest) {
                let begin = Instant::now();
                memory.step(black_box(sample));
                black_box(memory.preview());
                *fastest = begin.elapsed().min(*fastest);
            }
        }
        let slowest = fastest.iter().max().unwrap_or(&Duration::ZERO);
        let after = if breaks { " and a break" } else { "" };
        println!("slowest step with a tick after {laps} laps{after}: {:.2} us", 1e6 * slowest.as_secs_f64());
    }
}

criterion_group!(benches, step, slowest_step);
criterion_main!(benches);
