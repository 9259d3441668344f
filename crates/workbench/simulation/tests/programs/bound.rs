//! The bound on the surge of the default rig. The desired specific force is read from standard
//! input, one number a line:
//!
//!     cargo run --release --package moris-simulation --example bound -- <seconds between samples> <seconds an interval>

use std::error::Error;
use std::io::{Read, stdin};

use moris_simulation::measures::bound::{AxisLimits, TiltLimits, bound};

fn main() -> Result<(), Box<dyn Error>> {
    let numbers: Vec<f64> =
        std::env::args_os().skip(1).map(|number| number.to_string_lossy().parse()).collect::<Result<_, _>>()?;
    let [step, interval] = numbers[..] else { return Err("two numbers are needed: step and interval".into()) };
    let mut text = String::new();
    stdin().read_to_string(&mut text)?;
    let desired: Vec<f64> = text.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let limits = AxisLimits {
        min: -0.45,
        max: 0.45,
        velocity: 1.0,
        acceleration: 10.0,
        tilt: Some(TiltLimits {
            angle: 0.38,
            rate: 3.0_f64.to_radians(),
            acceleration: 0.2,
            head_height: 1.2,
            gravity: 9.80665,
        }),
    };
    let bound = bound(&desired, step, &limits, interval)?;
    println!("{} {}", bound.rms_error, bound.attained);
    Ok(())
}
