//! A computed track with a crossing, driven with another line and pace in each lap.

use moris_laps::Sample;

/// Time between samples \[s\].
pub const STEP: f64 = 0.02;
/// Mean duration of a lap \[s\].
pub const LAP: f64 = 80.0;

/// Samples of so many laps of a figure of eight. Line and pace vary by sums of sines that do not
/// repeat with the lap; `variation` is their factor.
pub fn laps(count: f64, variation: f64) -> Vec<Sample> {
    let samples = (count * LAP / STEP) as usize;
    let mut angle = 0.0;
    let mut positions = Vec::with_capacity(samples + 4);
    for k in 0..samples + 4 {
        let time = k as f64 * STEP;
        let wander = |a: f64, b: f64| (a * time).sin() + 0.6 * (b * time + 1.0).sin();
        positions.push(at(angle, variation * wander(0.173, 0.419)));
        angle += std::f64::consts::TAU * STEP / LAP * (1.0 + 0.04 * variation * wander(0.111, 0.317));
    }
    (0..samples).map(|k| sample(&positions[k..k + 4])).collect()
}

/// The same with the force of kerbs, chicanes and brakes: short pulses that belong to places.
pub fn laps_with_pulses(count: f64) -> Vec<Sample> {
    let pulses = |sample: Sample| {
        let [x, y, _] = sample.position;
        let place = (x / 31.0).sin() + (y / 23.0).cos();
        let beside = (x / 19.0 + y / 41.0).sin();
        Sample { force: [2.0 * (3.0 * place).tanh(), 2.0 * (4.0 * beside).tanh()], ..sample }
    };
    laps(count, 1.0).into_iter().map(pulses).collect()
}

/// The same with vibrations.
pub fn busy_laps(count: f64) -> Vec<Sample> {
    let mut samples = laps_with_pulses(count);
    let mut way = 0.0;
    for (k, sample) in samples.iter_mut().enumerate() {
        way += 0.3;
        sample.force[0] += 0.3 * (0.9 * way + k as f64).sin();
        sample.force[1] += 0.3 * (0.7 * way).sin();
    }
    samples
}

/// The place at an angle of the figure, so far beside it \[m\].
fn at(angle: f64, beside: f64) -> [f64; 2] {
    let along = [200.0 * angle.cos(), 240.0 * (2.0 * angle).cos()];
    let length = along[0].hypot(along[1]);
    [200.0 * angle.sin() - beside * along[1] / length, 120.0 * (2.0 * angle).sin() + beside * along[0] / length]
}

/// Speed and force by the differences of positions.
fn sample(positions: &[[f64; 2]]) -> Sample {
    let difference = |k: usize| [0, 1].map(|axis| (positions[k + 1][axis] - positions[k][axis]) / STEP);
    let [before, velocity, after] = [0, 1, 2].map(difference);
    let speed = velocity[0].hypot(velocity[1]);
    let acceleration = [0, 1].map(|axis| (after[axis] - before[axis]) / (2.0 * STEP));
    let forward = velocity.map(|component| component / speed);
    Sample {
        step: STEP,
        position: [positions[1][0], positions[1][1], 0.0],
        speed: Some(speed),
        force: [
            forward[0] * acceleration[0] + forward[1] * acceleration[1],
            forward[0] * acceleration[1] - forward[1] * acceleration[0],
        ],
    }
}

/// The track seen in a mirror.
pub fn mirrored(mut sample: Sample) -> Sample {
    sample.position[1] = -sample.position[1];
    sample.force[1] = -sample.force[1];
    sample
}
