//! The limit of tilt coordination that acts, axis by axis and sample by sample.
//!
//! Tilt coordination lags behind its target whenever the target moves faster than a limit allows.
//! Noise of the recording alone makes it lag by thousandths of a degree in nearly every step. A
//! limit therefore counts only where the tilt itself is at it.

use crate::Limits;

/// A limit of tilt coordination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TiltLimit {
    Rate,
    Acceleration,
    Angle,
}

impl TiltLimit {
    /// In the order in which one of several is named.
    pub const ALL: [TiltLimit; 3] = [TiltLimit::Rate, TiltLimit::Acceleration, TiltLimit::Angle];

    /// The limit with its value.
    pub fn text(self, limits: &Limits) -> String {
        match self {
            TiltLimit::Rate => format!("rate limit of {:.1}°/s", limits.tilt_rate.to_degrees()),
            TiltLimit::Acceleration => {
                format!("acceleration limit of {:.1}°/s²", limits.tilt_acceleration.to_degrees())
            }
            TiltLimit::Angle => format!("angle limit of {:.1}°", limits.tilt_angle.to_degrees()),
        }
    }
}

/// Flags of roll and pitch for each of [`TiltLimit::ALL`].
pub type TiltFlags = [[Vec<bool>; 3]; 2];

/// The limits that act, from samples of the tilt of roll and pitch \[rad\] and its rates \[rad/s\].
/// `lags` is true where the tilt lagged behind its target in the step before the sample.
pub fn tilt_limits(times: &[f64], lags: &[bool], tilt: [&[f64]; 2], rate: [&[f64]; 2], limits: &Limits) -> TiltFlags {
    // An angle or rate counts as at its limit from this fraction of it on.
    const REACHED_FRACTION: f64 = 0.98;
    // The same of the acceleration between two samples, of which the limit may act on a part only.
    const REACHED_ACCELERATION: f64 = 0.9;
    [0, 1].map(|axis| {
        let is_accelerated = sustained_changes(times, rate[axis], REACHED_ACCELERATION * limits.tilt_acceleration);
        let acting = |k: usize| {
            let at = |value: f64, limit: f64| limit > 0.0 && value.abs() >= REACHED_FRACTION * limit;
            if !lags[k] {
                None
            } else if at(rate[axis][k], limits.tilt_rate) {
                Some(TiltLimit::Rate)
            } else if is_accelerated[k] {
                Some(TiltLimit::Acceleration)
            } else {
                at(tilt[axis][k], limits.tilt_angle).then_some(TiltLimit::Angle)
            }
        };
        let acting: Vec<Option<TiltLimit>> = (0..times.len()).map(acting).collect();
        TiltLimit::ALL.map(|limit| acting.iter().map(|one| *one == Some(limit)).collect())
    })
}

/// Samples before which the rate has changed by at least `least` \[rad/s2\] in
/// one direction for long.
fn sustained_changes(times: &[f64], rate: &[f64], least: f64) -> Vec<bool> {
    // An acceleration limit that acts in one direction for a shorter time only smooths noise [s].
    const MIN_SUSTAINED_TIME: f64 = 0.1;
    let sign = |k: usize| {
        let acceleration = (rate[k] - rate[k - 1]) / (times[k] - times[k - 1]);
        if least > 0.0 && acceleration.abs() >= least { acceleration.signum() } else { 0.0 }
    };
    let mut flags = vec![false; times.len()];
    let mut first = 1;
    while first < times.len() {
        let (sign_here, mut next) = (sign(first), first + 1);
        while next < times.len() && sign(next) == sign_here {
            next += 1;
        }
        let duration = times[next - 1] - times[first - 1];
        if sign_here != 0.0 && duration >= MIN_SUSTAINED_TIME * (1.0 - 1e-9) {
            flags[first..next].fill(true);
        }
        first = next;
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        tilt_angle: 0.2,
        tilt_rate: 0.05,
        tilt_acceleration: 0.4,
        safety_position: [0.0; 3],
        safety_velocity: [0.0; 3],
        safety_acceleration: [0.0; 3],
        actuator_velocity: 0.0,
        actuator_acceleration: 0.0,
    };

    /// Counts of roll's flags by limit: rate, acceleration, angle.
    fn counts(tilt: &[f64], rate: &[f64], lags: bool) -> [usize; 3] {
        let times: Vec<f64> = (0..tilt.len()).map(|k| 0.01 * k as f64).collect();
        let rest = vec![0.0; tilt.len()];
        let flags = tilt_limits(&times, &vec![lags; tilt.len()], [tilt, &rest], [rate, &rest], &LIMITS);
        assert!(flags[1].iter().flatten().all(|flag| !flag));
        flags[0].each_ref().map(|flags| flags.iter().filter(|flag| **flag).count())
    }

    #[test]
    fn the_limit_that_the_tilt_is_at_is_named_interval_by_interval() {
        // Twelve steps of acceleration up to the rate limit, thirty at it, twenty at rest at the angle limit.
        let rate: Vec<f64> = (0..=62)
            .map(|k| {
                if k <= 12 {
                    0.004 * f64::from(k)
                } else if k <= 42 {
                    0.05
                } else {
                    0.0
                }
            })
            .collect();
        let tilt: Vec<f64> = (0..=62).map(|k| if k > 42 { 0.2 } else { 0.0 }).collect();
        assert_eq!(counts(&tilt, &rate, true), [30, 12, 20]);
        assert_eq!(counts(&tilt, &rate, false), [0; 3], "no lag, no limit");
    }

    #[test]
    fn an_acceleration_limit_that_turns_to_and_fro_counts_for_nothing() {
        let rate: Vec<f64> = (0..1000)
            .map(|k| if k % 10 < 5 { 0.004 * f64::from(k % 5) } else { 0.02 - 0.004 * f64::from(k % 5) })
            .collect();
        assert_eq!(counts(&vec![0.0; 1000], &rate, true), [0; 3]);
    }

    #[test]
    fn limits_that_are_not_known_do_not_act() {
        let unknown = Limits::default();
        let (times, values) = ([0.0, 0.5, 1.0], [0.0, 1.0, 2.0]);
        let flags = tilt_limits(&times, &[true; 3], [&values; 2], [&values; 2], &unknown);
        assert!(flags.iter().flatten().flatten().all(|flag| !flag));
    }
}
