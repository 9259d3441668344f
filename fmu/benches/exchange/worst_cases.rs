//! Exchanges with the washout, each timed by itself: how rarely is one how slow?

use std::time::Instant;

use criterion::Criterion;

use crate::running::{Inputs, Running};

/// Ten million steps of a smooth ride.
pub fn smooth_ride(_: &mut Criterion) {
    let mut running = Running::washout(&crate::washout_fmu(), &[]);
    let nanoseconds = (0..10_000_000).map(|_| timed(|| running.ride())).collect();
    println!("10 million exchanges, one clock reading each: {}", distribution(nanoseconds));
}

/// A million steps of a ride in jumps, on actuators so slow that the guard has to hold them back all the time.
pub fn limited_ride(_: &mut Criterion) {
    const STEPS: usize = 1_000_000;
    let slow = [("actuator.velocityLimit", 0.3), ("actuator.accelerationLimit", 5.0)];
    let mut running = Running::washout(&crate::washout_fmu(), &slow);
    let (mut jumps, mut limited) = (Jumps { random: 1 }, 0.0);
    let mut inputs = [0.0; 9];
    let mut nanoseconds = Vec::with_capacity(STEPS);
    for step in 0..STEPS {
        if step % 500 == 0 {
            inputs = jumps.inputs();
        }
        nanoseconds.push(timed(|| running.exchange(&inputs)));
        limited += running.instance.get("status.actuatorLimited").expect("a Boolean output");
    }
    let share = 100.0 * limited / STEPS as f64;
    println!("1 million exchanges, actuators limited in {share:.1} % of them: {}", distribution(nanoseconds));
}

/// Inputs that have nothing to do with those before.
struct Jumps {
    random: u64,
}

impl Jumps {
    /// Specific forces within 12 m/s2 of those at rest, angular velocities within 1 rad/s, upright.
    fn inputs(&mut self) -> Inputs {
        let [fx, fy, fz] = [0.0, 0.0, 9.80665].map(|at_rest| at_rest + 12.0 * self.number());
        let [wx, wy, wz] = [(); 3].map(|()| self.number());
        [fx, fy, fz, wx, wy, wz, 0.0, 0.0, 0.0]
    }

    /// A number from -1 to 1, by Knuth's linear congruential generator.
    fn number(&mut self) -> f64 {
        self.random = self.random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from((self.random >> 32) as u32) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}

/// How long it takes \[ns\].
fn timed(exchange: impl FnOnce()) -> u32 {
    let begin = Instant::now();
    exchange();
    begin.elapsed().as_nanos() as u32
}

fn distribution(mut nanoseconds: Vec<u32>) -> String {
    nanoseconds.sort_unstable();
    let at = |share: f64| nanoseconds[((nanoseconds.len() - 1) as f64 * share) as usize];
    let (median, most, nearly_all, slowest) = (at(0.5), at(0.99), at(0.9999), at(1.0));
    format!("median {median} ns, 99 % {most} ns, 99.99 % {nearly_all} ns, slowest {slowest} ns")
}
