//! Simulated seconds a second and core, from one core to two and from one parameter set to 100,000.

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use moris_simulation::{Manoeuvre, Replay};
use moris_washout::{Input, Parameters, Washout, presets};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

fn manoeuvre(duration: f64) -> Manoeuvre {
    Manoeuvre::sampled(0.001, duration, |time| {
        let mut input = Input::default();
        input.specific_force.x = (0.8 * time).sin();
        input.specific_force.y = 0.5 * (1.1 * time).sin();
        input.angular_velocity.x = 0.02 * (1.3 * time).sin();
        input
    })
}

fn set(k: u32) -> Parameters {
    let mut parameters = presets::parameters(presets::CLASSICAL);
    parameters.splitter.omega1.x = 1.0 + 1e-5 * f64::from(k);
    parameters
}

/// The smallest error among `count` sets: results are reduced as they come.
fn smallest_error(manoeuvre: &Manoeuvre, count: u32) -> f64 {
    let error = |k: u32| {
        let mut washout = Washout::new(&set(k)).expect("these parameters can be used");
        let mut sum = 0.0;
        Replay::new(manoeuvre).run(&mut washout, |input, output| {
            sum += (output.felt_specific_force.x - input.specific_force.x).powi(2);
        });
        sum
    };
    (0..count).into_par_iter().map(error).reduce(|| f64::INFINITY, f64::min)
}

fn cores(c: &mut Criterion) {
    let manoeuvre = manoeuvre(10.0);
    let mut group = c.benchmark_group("64 sets of 10 simulated seconds");
    group.throughput(Throughput::Elements(640)); // simulated seconds
    for threads in [1, 2] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
        group.bench_function(BenchmarkId::new("cores", threads), |b| {
            b.iter(|| pool.install(|| smallest_error(&manoeuvre, 64)));
        });
    }
    group.finish();
}

/// One core and two in turn, so that a noisy machine is noisy for both.
fn scaling(_: &mut Criterion) {
    let manoeuvre = manoeuvre(10.0);
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
    let (one, two) = (pool(1), pool(2));
    let time = |pool: &rayon::ThreadPool| -> Duration {
        let begin = Instant::now();
        pool.install(|| smallest_error(&manoeuvre, 64));
        begin.elapsed()
    };
    let mut ratios: Vec<f64> = (0..9).map(|_| time(&one).as_secs_f64() / time(&two).as_secs_f64()).collect();
    ratios.sort_by(f64::total_cmp);
    println!(
        "two cores against one: {:.2} times as fast (median of 9 pairs, {:.2} to {:.2})",
        ratios[4], ratios[0], ratios[8]
    );
}

fn sets(c: &mut Criterion) {
    let manoeuvre = manoeuvre(0.1);
    let mut group = c.benchmark_group("sets of 0.1 simulated seconds");
    group.sample_size(10);
    for count in [1, 100, 10_000, 100_000] {
        group.throughput(Throughput::Elements(u64::from(count)));
        group.bench_function(BenchmarkId::from_parameter(count), |b| b.iter(|| smallest_error(&manoeuvre, count)));
        println!("largest memory so far: {}", peak_memory());
    }
    group.finish();
}

/// The process's largest resident memory, as Linux tells it.
fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    peak.map_or_else(|| "unknown".to_owned(), |peak| peak.trim().to_owned())
}

criterion_group!(benches, cores, scaling, sets);
criterion_main!(benches);
