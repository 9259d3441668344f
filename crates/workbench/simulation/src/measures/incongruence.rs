//! Incongruence: how wrong the platform's forces feel at the worst moment, relative
//! to a platform at rest.
//!
//! Continuous ratings of car drivers follow a low-pass of the mismatch of lateral and longitudinal
//! force, weighted 66 and 34 % (Kolff and others, on 60 drivers and three cueing algorithms). The
//! maximum of the rating goes with what a driver says of a manoeuvre. The time constant is not
//! published. [`incongruence`] takes 3 s, and 1 and 6 s for the range. Only ratios mean something.

/// The largest rating relative to that of a platform at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incongruence {
    /// With the usual time constant.
    pub value: f64,
    /// The smallest and the largest of all time constants.
    pub range: [f64; 2],
}

/// Incongruence of the felt and the desired specific force \[m/s2\], sampled every `step` seconds.
/// `None` where nothing is desired along x and y.
pub fn incongruence(desired: &[[f64; 3]], felt: &[[f64; 3]], step: f64) -> Option<Incongruence> {
    // Time constants of the rating [s]: the usual one first.
    const TIME_CONSTANTS: [f64; 3] = [3.0, 1.0, 6.0];
    let rest = [0.0; 3];
    let ratio = |time_constant: f64| {
        let largest = |felt: &mut dyn Iterator<Item = &[f64; 3]>| {
            let smoothing = 1.0 - (-step / time_constant).exp();
            let mismatches = desired.iter().zip(felt).map(|(desired, felt)| force_mismatch(desired, felt));
            let mut rating = 0.0;
            mismatches.fold(0.0, |most: f64, mismatch| {
                rating += smoothing * (mismatch - rating);
                most.max(rating)
            })
        };
        largest(&mut felt.iter()) / largest(&mut std::iter::repeat(&rest))
    };
    let [value, short, long] = TIME_CONSTANTS.map(ratio);
    value.is_finite().then(|| Incongruence { value, range: [value.min(short).min(long), value.max(short).max(long)] })
}

fn force_mismatch(desired: &[f64; 3], felt: &[f64; 3]) -> f64 {
    // Weights of the longitudinal and the lateral mismatch.
    const MISMATCH_WEIGHTS: [f64; 2] = [0.34, 0.66];
    (0..2).map(|k| MISMATCH_WEIGHTS[k] * (felt[k] - desired[k]).abs()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_force_is_half_of_the_incongruence_whatever_the_time_constant() {
        let desired: Vec<[f64; 3]> = (0..2000).map(|k| [(0.02 * f64::from(k)).sin(), 0.3, 9.8]).collect();
        let felt: Vec<[f64; 3]> = desired.iter().map(|[x, y, z]| [0.5 * x, 0.5 * y, *z]).collect();
        let Incongruence { value, range } = incongruence(&desired, &felt, 0.01).unwrap();
        for found in [value, range[0], range[1]] {
            assert!((found - 0.5).abs() < 1e-12, "{found}");
        }
    }

    /// A step of lateral force that the platform gives after a second: its rating rises to
    /// 1 - exp(-1/T) of the one at rest.
    #[test]
    fn a_late_force_is_rated_by_its_time() {
        let desired = vec![[0.0, 1.0, 9.8]; 90_000];
        let felt: Vec<[f64; 3]> = (0..90_000).map(|k| [0.0, f64::from(k >= 1000), 9.8]).collect();
        let Incongruence { value, range } = incongruence(&desired, &felt, 0.001).unwrap();
        let expected = |time_constant: f64| 1.0 - (-1.0 / time_constant).exp();
        for (found, time_constant) in [(value, 3.0), (range[0], 6.0), (range[1], 1.0)] {
            assert!((found - expected(time_constant)).abs() < 1e-3, "{found} at {time_constant} s");
        }
    }

    #[test]
    fn without_a_desired_force_there_is_none() {
        assert_eq!(incongruence(&[[0.0, 0.0, 9.8]; 10], &[[0.0; 3]; 10], 0.01), None);
    }
}
