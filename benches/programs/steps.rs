//! Steps the washout a given number of times, for profilers and instruction counters.
//!
//! Words after the number of steps choose what is stepped:
//!
//! - `classical`, `adaptive`, `optimal`, `robust`, `paper`: the parameters of that name in the
//!   place of the default.
//! - `brisk`: a ride with stops, bends and vibration in the place of a smooth one.
//! - `jumps`: inputs that jump, on slow actuators, so that the actuator guard limits the motion.
//! - `cranks`: a simulator with cranks that carries a person, in the place of the default rig.
//!
//! For example:
//!
//!     cargo run --release --example steps 1000000
//!     cargo run --release --example steps 1000000 classical jumps
//!     cargo run --release --example steps 1000000 adaptive brisk cranks

use std::hint::black_box;

use moris_washout::{Input, ParameterError, Parameters, Washout, presets};

#[path = "../../tests/washout/common/crank_rigs.rs"]
#[allow(dead_code)]
mod crank_rigs;
#[path = "../../tests/washout/common/random.rs"]
#[allow(dead_code)] // The tests use the rest of it.
mod random;
#[path = "../common/ride.rs"]
mod ride;

use crank_rigs::{on, person};
use random::Random;
use ride::{brisk, smooth};

fn main() -> Result<(), ParameterError> {
    let words: Vec<String> = std::env::args_os().skip(1).filter_map(|word| word.into_string().ok()).collect();
    let has = |word: &str| words.iter().any(|given| given == word);
    let count: usize = words.first().and_then(|count| count.parse().ok()).unwrap_or(1_000_000);
    let sets = [
        ("classical", presets::CLASSICAL),
        ("adaptive", presets::ADAPTIVE),
        ("optimal", presets::OPTIMAL),
        ("robust", presets::ROBUST),
        ("paper", presets::PAPER),
    ];
    let mut parameters = presets::parameters(sets.iter().find(|(name, _)| has(name)).map_or("", |(_, set)| set));
    if has("cranks") {
        let Parameters { rig, safety, .. } = on(person());
        parameters = Parameters { rig, safety, ..parameters };
    }
    let ride = if has("jumps") {
        (parameters.rig.velocity_limit, parameters.rig.acceleration_limit) = (0.3, 5.0);
        jumps(count.div_ceil(STEPS_PER_JUMP))
    } else if has("brisk") {
        brisk()
    } else {
        smooth()
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
