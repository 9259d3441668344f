//! The actuators' limits, judged on the legs of a foreign motion.

use moris_washout::platform::reach::clearance_of_lengths;
use moris_washout::{Output, Rig};

use super::differences::mean_derivatives;
use crate::sentence;

/// Writes lengths and clearances of the recording's samples, and whether a limit was exceeded since
/// the sample before. Returns a clause for the greatest excess of each limit.
///
/// Speed and acceleration are central differences over three samples.
pub fn judge(legs: &[[f64; 6]], step: f64, rig: &Rig, outputs: &mut [Output]) -> Vec<String> {
    // Excesses up to these count as none: of a length [m], and relative of speed and acceleration.
    const LENGTH_TOLERANCE: f64 = 1e-6;
    const LIMIT_TOLERANCE: f64 = 1e-3;
    let (tolerance, [start, end]) = (1.0 + LIMIT_TOLERANCE, rig.stroke());
    let limits = [start, end, rig.velocity_limit, rig.acceleration_limit];
    let parts = (legs.len() - 1) / (outputs.len() - 1);
    let step = step / parts as f64;
    let mut exceeds = vec![false; legs.len()];
    // Of each limit: by how much it is exceeded at most, and the clause's leg, value and time.
    let mut worst = [(0.0, 0, 0.0, 0.0); 4];
    for leg in 0..6 {
        let lengths: Vec<f64> = legs.iter().map(|lengths| lengths[leg]).collect();
        let rates = mean_derivatives(&lengths, step);
        for (k, (&length, rates)) in lengths.iter().zip(rates).enumerate() {
            let [speed, acceleration] = rates.map(f64::abs);
            let values = [length, length, speed, acceleration];
            let beyond = [
                start - length - LENGTH_TOLERANCE,
                length - end - LENGTH_TOLERANCE,
                speed - tolerance * limits[2],
                acceleration - tolerance * limits[3],
            ];
            for ((worst, value), beyond) in worst.iter_mut().zip(values).zip(beyond) {
                exceeds[k] |= beyond > 0.0;
                if beyond > worst.0 {
                    *worst = (beyond, leg + 1, value, k as f64 * step);
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
    let clause = |(limit, (beyond, leg, value, time)): (usize, (f64, usize, f64, f64))| {
        let allowed = limits[limit];
        (beyond > 0.0).then(|| match limit {
            0 => sentence!["leg-short", leg, value, allowed, time],
            1 => sentence!["leg-long", leg, value, allowed, time],
            2 => sentence!["leg-fast", leg, value, allowed, time],
            _ => sentence!["leg-accelerated", leg, value, allowed, time],
        })
    };
    worst.into_iter().enumerate().filter_map(clause).collect()
}
