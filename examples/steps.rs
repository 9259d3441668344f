//! Steps the washout a given number of times, for profilers and instruction counters.
//!
//! - Default: a smooth ride on all axes, with the default parameters.
//! - `classical`, `paper`: the smooth ride with the parameters of that name.
//! - `jumps`: inputs that jump, with the classical strategy on slow actuators, so that the actuator
//!   guard limits the motion.
//!
//! The number of steps comes first:
//!
//!     cargo run --release --example steps 1000000
//!     cargo run --release --example steps 1000000 jumps
//!     cargo run --release --example steps 1000000 paper

use std::hint::black_box;

use moris_washout::{Input, ParameterError, Parameters, Washout, presets};

#[path = "../tests/washout/common/random.rs"]
#[allow(dead_code)] // The tests use the rest of it.
mod random;
#[path = "../benches/common/ride.rs"]
mod ride;

use random::Random;
use ride::smooth;

fn main() -> Result<(), ParameterError> {
    let argument = |place: usize| std::env::args_os().nth(place).and_then(|text| text.into_string().ok());
    let count: usize = argument(1).and_then(|count| count.parse().ok()).unwrap_or(1_000_000);
    let (parameters, ride) = match argument(2).as_deref() {
        Some("jumps") => {
            let mut parameters = presets::parameters(presets::CLASSICAL);
            (parameters.rig.velocity_limit, parameters.rig.acceleration_limit) = (0.3, 5.0);
            (parameters, jumps(count.div_ceil(STEPS_PER_JUMP)))
        }
        Some("classical") => (presets::parameters(presets::CLASSICAL), smooth()),
        Some("paper") => (presets::parameters(presets::PAPER), smooth()),
        _ => (Parameters::default(), smooth()),
    };
    let mut washout = Washout::new(&parameters)?;
    let mut limited = 0;
    for input in ride.iter().cycle().take(count) {
        washout.step(black_box(input), 0.001);
        limited += usize::from(black_box(washout.output()).actuator_limited);
    }
    println!("{count} steps, {limited} limited, legs {:.6?} m", washout.output().length);
    Ok(())
}

/// Steps for which an input is held before it jumps.
const STEPS_PER_JUMP: usize = 500;

/// Inputs that are independent of those before.
fn jumps(count: usize) -> Vec<Input> {
    let mut random = Random::new(1);
    let jump = |_| {
        let mut input = Input::default();
        input.specific_force.apply(|force| *force += random.between(-12.0, 12.0));
        input.angular_velocity.apply(|rate| *rate = random.between(-1.0, 1.0));
        input
    };
    (0..count).map(jump).flat_map(|input| std::iter::repeat_n(input, STEPS_PER_JUMP)).collect()
}
