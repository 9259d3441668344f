//! Benchmarks of the kernel without FMI: a step of the classical strategy, and its parts.
//!
//! `cargo bench --bench kernel`. Instruction counts, which do not depend on what else the machine
//! does, come from `benches/programs/steps.rs` under callgrind (see docs/performance.md).

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use moris_washout::platform::{
    Geometry, PlatformMotion, Pose, forward_kinematics, inverse_kinematics, leg_lengths, survey,
};
use moris_washout::{Input, Output, Parameters, Rig, Washout, presets};

#[path = "common/ride.rs"]
#[allow(dead_code)] // Other benchmarks use the rest of it.
mod ride;

use ride::smooth;

fn step(c: &mut Criterion) {
    let ride = smooth();
    let rest = [Input::default()];
    let mut bench = |name: &str, inputs: &[Input], warm_up: &[Input]| {
        let classical = presets::parameters(presets::CLASSICAL);
        let mut washout = Washout::new(&classical).expect("the set's parameters can be used");
        for input in warm_up {
            washout.step(input, 0.001);
        }
        let mut next = inputs.iter().cycle();
        c.bench_function(name, |b| {
            b.iter(|| -> Output {
                if let Some(input) = next.next() {
                    washout.step(black_box(input), 0.001);
                }
                washout.output()
            });
        });
    };
    bench("step of 1 ms, riding", &ride, &[]);
    // Ten simulated minutes after the ride: what decays must not have become denormal.
    let long_after: Vec<Input> = ride.iter().copied().chain(std::iter::repeat_n(rest[0], 600_000)).collect();
    bench("step of 1 ms, long after a ride", &rest, &long_after);
}

fn kinematics(c: &mut Criterion) {
    let rig = Rig::default();
    let geometry = Geometry::from(&rig);
    let mut washout = Washout::new(&Parameters::default()).expect("the default parameters can be used");
    for input in &smooth()[..3000] {
        washout.step(input, 0.001);
    }
    let motion: PlatformMotion = *washout.motion();
    c.bench_function("inverse kinematics with leg rates", |b| {
        b.iter(|| inverse_kinematics(black_box(&geometry), black_box(&motion)));
    });
    let lengths = leg_lengths(&geometry, &motion.pose());
    for input in &smooth()[3000..3010] {
        washout.step(input, 0.001);
    }
    let nearby = washout.motion().pose();
    c.bench_function("forward kinematics from a pose 10 ms away", |b| {
        b.iter(|| forward_kinematics(black_box(&geometry), black_box(&lengths), black_box(&nearby)));
    });
    let neutral = Pose::neutral(&rig);
    c.bench_function("forward kinematics from neutral", |b| {
        b.iter(|| forward_kinematics(black_box(&geometry), black_box(&lengths), black_box(&neutral)));
    });
}

fn beginnings(c: &mut Criterion) {
    let parameters = Parameters::default();
    c.bench_function("new washout, default rig", |b| b.iter(|| Washout::new(black_box(&parameters))));
    let mut group = c.benchmark_group("slow");
    group.sample_size(10);
    group.bench_function("survey of a rig", |b| b.iter(|| survey(black_box(&parameters.rig))));
    group.finish();
}

criterion_group!(benches, step, kinematics, beginnings);
criterion_main!(benches);
