//! Distribution of the duration of single exchanges with the washout.

use std::time::Instant;

use criterion::Criterion;

use crate::random::Random;
use crate::running::{Inputs, Running};

/// Ten million steps of a smooth motion.
pub fn smooth_ride(_: &mut Criterion) {
    let mut running = Running::washout(&crate::washout_fmu(), &[]);
    let nanoseconds = (0..10_000_000).map(|_| timed(|| running.ride())).collect();
    println!("10 million exchanges, one clock reading each: {}", distribution(nanoseconds));
}

/// A million steps of random jumps, on slow actuators.
pub fn limited_ride(_: &mut Criterion) {
    const STEPS: usize = 1_000_000;
    let slow = [("actuator.velocityLimit", 0.3), ("actuator.accelerationLimit", 5.0)];
    let mut running = Running::washout(&crate::washout_fmu(), &slow);
    let (mut random, mut limited) = (Random::new(1), 0.0);
    let mut inputs = [0.0; 9];
    let mut nanoseconds = Vec::with_capacity(STEPS);
    for step in 0..STEPS {
        if step % 500 == 0 {
            inputs = jump(&mut random);
        }
        nanoseconds.push(timed(|| running.exchange(&inputs)));
        limited += running.instance.get("status.actuatorLimited").expect("a Boolean output");
    }
    let percent = 100.0 * limited / STEPS as f64;
    println!("1 million exchanges, actuators limited in {percent:.1} % of them: {}", distribution(nanoseconds));
}

/// Inputs independent of the previous ones: specific forces within 12 m/s2 of those at rest,
/// angular velocities within 1 rad/s, upright.
fn jump(random: &mut Random) -> Inputs {
    let [fx, fy, fz] = [0.0, 0.0, 9.80665].map(|at_rest| at_rest + random.between(-12.0, 12.0));
    let [wx, wy, wz] = [(); 3].map(|()| random.between(-1.0, 1.0));
    [fx, fy, fz, wx, wy, wz, 0.0, 0.0, 0.0]
}

/// Duration \[ns\].
fn timed(exchange: impl FnOnce()) -> u32 {
    let begin = Instant::now();
    exchange();
    begin.elapsed().as_nanos() as u32
}

fn distribution(mut nanoseconds: Vec<u32>) -> String {
    nanoseconds.sort_unstable();
    let at = |fraction: f64| nanoseconds[((nanoseconds.len() - 1) as f64 * fraction) as usize];
    let (median, most, nearly_all, slowest) = (at(0.5), at(0.99), at(0.9999), at(1.0));
    format!("median {median} ns, 99 % {most} ns, 99.99 % {nearly_all} ns, slowest {slowest} ns")
}
