//! Rides on which earlier passes are no forecast.

use std::f64::consts::TAU;

use moris_laps::{Laps, Sample};

use crate::track::{STEP, mirrored};

/// Samples in so many seconds.
fn count(seconds: f64) -> usize {
    (seconds / STEP).round() as usize
}

/// A ride of these samples of another one.
fn of(samples: &[Sample], numbers: impl Iterator<Item = usize>) -> Vec<Sample> {
    numbers.take(samples.len()).map(|k| samples[k % samples.len()]).collect()
}

/// The places of one ride, with the forces of another.
fn with_forces(samples: &[Sample], forces: impl Fn(usize) -> [f64; 2]) -> Vec<Sample> {
    samples.iter().enumerate().map(|(k, sample)| Sample { force: forces(k), ..*sample }).collect()
}

/// Forces in stretches in another order, at the same places.
fn shuffled(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    let stretch = count(seconds);
    let stretches = samples.len() / stretch;
    with_forces(samples, |k| samples[(k / stretch * 7 % stretches * stretch + k % stretch) % samples.len()].force)
}

/// Forces of so many seconds before, at the same places.
fn late(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    with_forces(samples, |k| samples[(k + samples.len() - count(seconds)) % samples.len()].force)
}

/// The mirrored track after so many seconds.
fn mirrored_from(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    let from = count(seconds);
    samples.iter().enumerate().map(|(k, sample)| if k < from { *sample } else { mirrored(*sample) }).collect()
}

/// Forces whose sign changes each time after so many seconds.
fn alternating(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    let sign = |k: usize| if (k / count(seconds)).is_multiple_of(2) { 1.0 } else { -1.0 };
    with_forces(samples, |k| samples[k].force.map(|force| sign(k) * force))
}

/// Forces times another factor after each time of so many seconds.
fn with_factors(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    const FACTORS: [f64; 8] = [1.0, -0.5, 1.0, 0.3, 1.5, -1.0, 0.0, 1.0];
    with_forces(samples, |k| samples[k].force.map(|force| FACTORS[k / count(seconds) % 8] * force))
}

/// Forces whose sign changes each time once a memory has given its preview for so many seconds.
pub fn betrayed(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    let mut memory = Laps::new();
    let (mut sign, mut given) = (1.0, 0);
    let betray = |sample: &Sample| {
        given = if memory.preview().count > 0 { given + 1 } else { 0 };
        if given > count(seconds) {
            (sign, given) = (-sign, 0);
        }
        let sample = Sample { force: sample.force.map(|force| sign * force), ..*sample };
        memory.step(&sample);
        sample
    };
    samples.iter().map(betray).collect()
}

/// A line beside the track for 23 s every 70 s, with its forces in the other order.
fn on_another_line(samples: &[Sample], aside: f64) -> Vec<Sample> {
    let line = |(k, sample): (usize, &Sample)| {
        let since = (k as f64 * STEP) % 70.0 - 40.0;
        let Some(next) = samples.get(k + 1).filter(|_| (0.0..23.0).contains(&since)) else { return *sample };
        let [dx, dy] = [0, 1].map(|axis| next.position[axis] - sample.position[axis]);
        let left = aside * (0.5 * since).min(0.5 * (23.0 - since)).min(1.0) / dx.hypot(dy).max(1e-6);
        let [x, y, z] = sample.position;
        let force = samples[(k + count(23.0 - 2.0 * since)).min(samples.len() - 1)].force;
        Sample { position: [x - left * dy, y + left * dx, z], force, ..*sample }
    };
    samples.iter().enumerate().map(line).collect()
}

/// Strong sines first, and then a fifth of the forces: for so many seconds each.
fn strong_and_weak(samples: &[Sample], seconds: f64, amplitude: f64) -> Vec<Sample> {
    with_forces(samples, |k| {
        let wave = |frequency: f64| amplitude * (TAU * frequency * k as f64 * STEP).sin();
        let [surge, sway] = samples[k].force;
        if (k / count(seconds)).is_multiple_of(2) {
            [surge + wave(0.31), sway + wave(0.23)]
        } else {
            [0.2 * surge, 0.2 * sway]
        }
    })
}

/// A spin of 4 s every 37 s.
fn spun(samples: &[Sample]) -> Vec<Sample> {
    let spin = |(k, sample): (usize, &Sample)| {
        let since = (k as f64 * STEP) % 37.0 - 30.0;
        if !(0.0..4.0).contains(&since) {
            return *sample;
        }
        let [x, y, z] = samples[k - count(since)].position;
        let (turned, turns) = (3.0 * since, 6.0 * since);
        Sample {
            position: [x + 2.0 * turned.sin(), y + 2.0 * turned.cos() - 2.0, z],
            speed: Some(2.0),
            force: [5.0 * turns.sin(), 5.0 * turns.cos()],
            ..*sample
        }
    };
    samples.iter().enumerate().map(spin).collect()
}

/// 10 s are driven again every 45 s.
fn rewound(samples: &[Sample]) -> Vec<Sample> {
    of(samples, (0..).map(|k| k - k / count(45.0) * count(10.0)))
}

/// Another place of the track every so many seconds, with its forces.
fn teleported(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    let stretch = count(seconds);
    of(samples, (0..samples.len()).map(|k| k / stretch * 7919 + k))
}

/// Another place of the track every so many seconds, without its forces.
fn misplaced(samples: &[Sample], seconds: f64) -> Vec<Sample> {
    teleported(samples, seconds)
        .iter()
        .zip(samples)
        .map(|(place, sample)| Sample { force: sample.force, ..*place })
        .collect()
}

/// A lane beside the track, with brakes, for 15 s every 61 s.
fn in_the_pit_lane(samples: &[Sample], aside: f64) -> Vec<Sample> {
    let lane = |(k, sample): (usize, &Sample)| {
        let part = ((k as f64 * STEP) % 61.0 - 40.0) / 15.0;
        let Some(next) = samples.get(k + 1).filter(|_| (0.0..1.0).contains(&part)) else { return *sample };
        let [dx, dy] = [0, 1].map(|axis| next.position[axis] - sample.position[axis]);
        let left = aside * (0.5 * TAU * part).sin() / dx.hypot(dy).max(1e-6);
        let [x, y, z] = sample.position;
        let [surge, sway] = sample.force;
        Sample {
            position: [x - left * dy, y + left * dx, z],
            force: [0.1 * surge - 2.0 * (TAU * part).sin(), 0.1 * sway],
            ..*sample
        }
    };
    samples.iter().enumerate().map(lane).collect()
}

/// From the middle on another vehicle: with another speed, and forces times a factor.
fn changed(samples: &[Sample], speed: f64, factor: f64) -> Vec<Sample> {
    let half = samples.len() / 2;
    let other = (0..half).map(|k| {
        let along = half as f64 + k as f64 * speed;
        let (from, t) = (along as usize, along.fract());
        let [a, b] = [from, from + 1].map(|k| samples[k % samples.len()]);
        let between = |a: f64, b: f64| a + t * (b - a);
        Sample {
            position: std::array::from_fn(|axis| between(a.position[axis], b.position[axis])),
            speed: a.speed.map(|a| speed * a),
            force: [0, 1].map(|axis| factor * between(a.force[axis], b.force[axis])),
            ..a
        }
    });
    samples[..half].iter().copied().chain(other).collect()
}

/// All of them by name; of laps of so many seconds.
pub fn all(samples: &[Sample], lap: f64) -> Vec<(&'static str, Vec<Sample>)> {
    let half = 0.5 * samples.len() as f64 * STEP;
    vec![
        ("shuffled", shuffled(samples, 24.0)),
        ("late", late(samples, 20.0)),
        ("mirrored", mirrored_from(samples, half)),
        ("alternating each 17 s", alternating(samples, 17.0)),
        ("alternating each 20 s", alternating(samples, 20.0)),
        ("alternating each 50 s", alternating(samples, 50.0)),
        ("alternating each 100 s", alternating(samples, 100.0)),
        ("with other factors", with_factors(samples, 30.0)),
        ("on another line", on_another_line(samples, 4.0)),
        ("strong first", strong_and_weak(samples, half, 5.0)),
        ("strong and weak", strong_and_weak(samples, lap, 10.0)),
        ("spun", spun(samples)),
        ("rewound", rewound(samples)),
        ("teleported each 20 s", teleported(samples, 20.0)),
        ("teleported each 5 s", teleported(samples, 5.0)),
        ("misplaced", misplaced(samples, 20.0)),
        ("in the pit lane", in_the_pit_lane(samples, 4.0)),
        ("slower", changed(samples, 0.6, 0.4)),
        ("faster, mirrored forces", changed(samples, 0.98, -0.7)),
    ]
}
