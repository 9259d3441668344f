//! Lamps of limits that act, or are near.

use moris_washout::Washout;

/// Names of the lamps.
pub const LAMP_NAMES: [&str; 6] = ["tilt", "soft", "safety", "stroke", "leg_speed", "leg_acceleration"];

/// The lamps that are lit now.
pub fn lit(washout: &Washout) -> [bool; LAMP_NAMES.len()] {
    // Fraction of a leg's stroke next to its ends, and fractions of its largest speed and
    // acceleration, from which on a lamp lights.
    const NEAR_END: f64 = 0.05;
    const NEAR_LIMIT: f64 = 0.9;
    let (now, rates) = (washout.output(), washout.output_derivative());
    let rig = &washout.parameters().rig;
    let any = |values: &[f64; 6], limit: f64| values.iter().any(|value| value.abs() > NEAR_LIMIT * limit);
    [
        now.tilt_limited,
        now.soft_limited,
        now.safety_active,
        now.stroke_margin < NEAR_END * rig.stroke_length(),
        any(&now.actuators(rig)[1], rig.velocity_limit),
        any(&rates.actuators(rig)[1], rig.acceleration_limit),
    ]
}
