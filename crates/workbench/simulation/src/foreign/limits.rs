//! The actuators' limits, judged on the legs of a foreign motion.

use moris_washout::platform::reach::clearance_of_lengths;
use moris_washout::{Output, Rig};

use super::differences::mean_derivatives;

/// The greatest excess of one of the actuators' limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excess {
    /// Name of the limit.
    pub limit: Limit,
    /// The leg, from 0.
    pub leg: usize,
    /// The value, in SI units.
    pub value: f64,
    /// Value of the limit.
    pub allowed: f64,
    /// Time of the value \[s\].
    pub time: f64,
}

/// A limit of an actuator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Shortest length.
    Shortest,
    /// Longest length.
    Longest,
    /// Largest speed.
    Speed,
    /// Largest acceleration.
    Acceleration,
}

/// Writes lengths and clearances of the recording's samples, and whether a limit was exceeded since
/// the sample before. Returns the greatest excess of each limit.
///
/// Speed and acceleration are central differences over three samples.
pub fn judge(legs: &[[f64; 6]], step: f64, rig: &Rig, outputs: &mut [Output]) -> Vec<Excess> {
    // Excesses up to these count as none: of a length [m], and relative of speed and acceleration.
    const LENGTH_TOLERANCE: f64 = 1e-6;
    const LIMIT_TOLERANCE: f64 = 1e-3;
    let (tolerance, [start, end]) = (1.0 + LIMIT_TOLERANCE, rig.stroke());
    let (speed_limit, acceleration_limit) = (rig.velocity_limit, rig.acceleration_limit);
    let parts = (legs.len() - 1) / (outputs.len() - 1);
    let step = step / parts as f64;
    let mut exceeds = vec![false; legs.len()];
    let mut worst: Vec<(f64, Excess)> = Vec::new();
    for leg in 0..6 {
        let lengths: Vec<f64> = legs.iter().map(|lengths| lengths[leg]).collect();
        let rates = mean_derivatives(&lengths, step);
        for (k, (&length, rates)) in lengths.iter().zip(rates).enumerate() {
            let [speed, acceleration] = rates.map(f64::abs);
            let beyond = [
                (Limit::Shortest, length, start, start - length - LENGTH_TOLERANCE),
                (Limit::Longest, length, end, length - end - LENGTH_TOLERANCE),
                (Limit::Speed, speed, speed_limit, speed - tolerance * speed_limit),
                (Limit::Acceleration, acceleration, acceleration_limit, acceleration - tolerance * acceleration_limit),
            ];
            for (limit, value, allowed, beyond) in beyond.into_iter().filter(|(.., beyond)| *beyond > 0.0) {
                exceeds[k] = true;
                let excess = Excess { limit, leg, value, allowed, time: k as f64 * step };
                match worst.iter_mut().find(|(_, other)| other.limit == limit) {
                    Some((least, _)) if *least >= beyond => (),
                    Some(entry) => *entry = (beyond, excess),
                    None => worst.push((beyond, excess)),
                }
            }
        }
    }
    for (k, output) in outputs.iter_mut().enumerate() {
        let at = k * parts;
        output.length = legs[at];
        if rig.has_cranks() {
            output.angle = legs[at].map(|arc| arc / rig.crank_arm);
        }
        output.stroke_margin = clearance_of_lengths(rig, &legs[at]);
        let since = if k == 0 { 0 } else { at - parts + 1 };
        output.actuator_limited = exceeds[since..=at].iter().any(|exceeds| *exceeds);
    }
    worst.sort_by_key(|(_, excess)| excess.limit as usize);
    worst.into_iter().map(|(_, excess)| excess).collect()
}
