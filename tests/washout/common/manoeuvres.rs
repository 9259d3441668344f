//! The paper's three runs, as accelerations at the head; their amplitudes and times are a choice,
//! the paper prints none.

use moris_washout::Input;
use nalgebra::Vector3;

use super::{G, accelerating};

/// A step from 0 to 1 that begins at `start` and takes `duration`, without a corner.
pub fn smooth_step(t: f64, start: f64, duration: f64) -> f64 {
    let x = ((t - start) / duration).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Run 1: accelerate, then brake, straight. The acceleration along x at `t`.
pub fn accelerate_and_brake(t: f64) -> f64 {
    2.0 * (smooth_step(t, 3.0, 6.0) - smooth_step(t, 15.0, 6.0))
        - 2.5 * (smooth_step(t, 24.0, 7.5) - smooth_step(t, 33.6, 7.5))
}

/// Run 1 with faster ramps.
pub fn accelerate_and_brake_briskly(t: f64) -> f64 {
    2.0 * (smooth_step(t, 3.0, 2.0) - smooth_step(t, 15.0, 2.0))
        - 2.5 * (smooth_step(t, 24.0, 2.0) - smooth_step(t, 33.6, 2.0))
}

/// Run 1's duration \[s\].
pub const ACCELERATE_AND_BRAKE_TIME: f64 = 55.0;

/// Run 3: accelerate, brake, and stand at once.
pub fn brusque_stop(t: f64) -> f64 {
    if t >= STOP {
        return 0.0;
    }
    2.2 * (smooth_step(t, 1.0, 6.6) - smooth_step(t, 12.0, 6.6)) - 3.5 * smooth_step(t, 22.0, 10.5)
}

/// When run 3's vehicle stands \[s\].
pub const STOP: f64 = 34.164_285_714;
/// Run 3's duration \[s\].
pub const BRUSQUE_STOP_TIME: f64 = 50.0;

/// Run 2: in a truck's wake. The specific force is that at the head, in its
/// axes; the vehicle rolls.
pub fn wake(t: f64) -> Input {
    let window = smooth_step(t, 0.5, 1.5) - smooth_step(t, 8.0, 1.5);
    let wave =
        |amplitude: f64, frequency: f64, phase: f64| amplitude * (std::f64::consts::TAU * frequency * t + phase).sin();
    let force = Vector3::new(
        window * (wave(0.60, 0.35, 0.0) + wave(0.35, 1.1, 0.7) + wave(0.15, 2.0, 1.9)),
        window * (wave(0.80, 0.5, 0.4) + wave(0.40, 1.3, 2.1) + wave(0.20, 2.0, 0.3)),
        window * (wave(0.30, 1.8, 1.0) + wave(0.15, 3.1, 2.2)) + G,
    );
    Input { specific_force: force, ..Input::default() }
}

/// Run 2 with the vehicle's roll rate. The force at the head already holds the lean, so no
/// orientation is given.
pub fn wake_with_roll(t: f64) -> Input {
    let roll = |t: f64| {
        let window = smooth_step(t, 0.5, 1.5) - smooth_step(t, 8.0, 1.5);
        let wave = |frequency: f64, phase: f64| (std::f64::consts::TAU * frequency * t + phase).sin();
        window * (3.0 * wave(0.5, 2.0) + wave(1.3, 0.6)).to_radians()
    };
    const H: f64 = 1e-5;
    let rate = (roll(t + H) - roll(t - H)) / (2.0 * H);
    Input { angular_velocity: Vector3::new(rate, 0.0, 0.0), ..wake(t) }
}

/// Run 2's duration \[s\].
pub const WAKE_TIME: f64 = 10.0;

/// A straight run's input.
pub fn surging(acceleration: impl Fn(f64) -> f64) -> impl Fn(f64) -> Input {
    move |t| accelerating(acceleration(t), 0.0, 0.0)
}
