//! Time above the perception thresholds: false cues, which should not be sensed on the platform,
//! and missing cues, which should be.
//!
//! The thresholds apply to the vestibular model's response, as in Reid and Nahon (1985):
//!
//! - specific force: 0.17 m/s2 in surge and sway, 0.28 m/s2 in heave;
//! - angular velocity: 3.0 deg/s in roll, 3.6 deg/s in pitch, 2.6 deg/s in yaw.

/// Least sensed specific force that is perceived, by axis x, y, z \[m/s2\].
pub const FORCE_THRESHOLDS: [f64; 3] = [HORIZONTAL_FORCE_THRESHOLD, HORIZONTAL_FORCE_THRESHOLD, 0.28];

/// The same of surge and sway \[m/s2\].
pub const HORIZONTAL_FORCE_THRESHOLD: f64 = 0.17;

/// Least sensed angular velocity that is perceived, by axis x, y, z \[rad/s\].
pub const RATE_THRESHOLDS: [f64; 3] = [3.0_f64.to_radians(), 3.6_f64.to_radians(), 2.6_f64.to_radians()];

/// Fractions of the samples, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cues {
    /// Sensed in the vehicle.
    pub desired: f64,
    /// Sensed on the platform while nothing is sensed in the vehicle, or the opposite is.
    pub false_cues: f64,
    /// Sensed in the vehicle while nothing is sensed on the platform.
    pub missing_cues: f64,
}

/// Compares the signals sensed in the vehicle and on the platform.
pub fn cues(desired: &[f64], felt: &[f64], threshold: f64) -> Cues {
    let perceived = |value: f64| if value.abs() >= threshold { value.signum() } else { 0.0 };
    let fraction = |holds: fn(f64, f64) -> bool| {
        let held = desired.iter().zip(felt).filter(|&(&d, &f)| holds(perceived(d), perceived(f)));
        held.count() as f64 / desired.len().max(1) as f64
    };
    Cues {
        desired: fraction(|desired, _| desired != 0.0),
        false_cues: fraction(|desired, felt| felt != 0.0 && felt != desired),
        missing_cues: fraction(|desired, felt| desired != 0.0 && felt == 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cue_is_false_where_nothing_or_the_opposite_is_desired_and_missing_where_nothing_is_felt() {
        let desired = [0.0, 0.0, 0.1, 0.5, 0.5, 0.5, -0.5, -0.5];
        let felt = [0.0, 0.3, -0.3, 0.3, -0.3, 0.1, -0.2, 0.0];
        let found = cues(&desired, &felt, 0.2);
        assert_eq!(found, Cues { desired: 5.0 / 8.0, false_cues: 3.0 / 8.0, missing_cues: 2.0 / 8.0 });
    }

    #[test]
    fn the_same_motion_has_neither_false_nor_missing_cues() {
        let signal: Vec<f64> = (0..100).map(|k| (0.1 * f64::from(k)).sin()).collect();
        let found = cues(&signal, &signal, 0.17);
        assert!(found.desired > 0.5 && found.false_cues == 0.0 && found.missing_cues == 0.0);
    }
}
