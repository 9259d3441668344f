//! Derivatives of sampled series by finite differences.

/// Weights of the first and the second derivative over five samples, at each of them, in twelfths.
/// The middle row is the central difference, the others are for the ends of a series.
const FIRST_DERIVATIVE_WEIGHTS: [[f64; 5]; 5] = [
    [-25.0, 48.0, -36.0, 16.0, -3.0],
    [-3.0, -10.0, 18.0, -6.0, 1.0],
    [1.0, -8.0, 0.0, 8.0, -1.0],
    [-1.0, 6.0, -18.0, 10.0, 3.0],
    [3.0, -16.0, 36.0, -48.0, 25.0],
];
const SECOND_DERIVATIVE_WEIGHTS: [[f64; 5]; 5] = [
    [35.0, -104.0, 114.0, -56.0, 11.0],
    [11.0, -20.0, 6.0, 4.0, -1.0],
    [-1.0, 16.0, -30.0, 16.0, -1.0],
    [-1.0, 4.0, 6.0, -20.0, 11.0],
    [11.0, -56.0, 114.0, -104.0, 35.0],
];
/// Samples of a difference.
const DIFFERENCE_SAMPLES: usize = 5;

/// RMS of the second derivative's error if values are rounded to multiples of a quantum. The errors
/// of rounding are uniform within the quantum, and add by the weights' squares.
pub fn rounding_error(quantum: f64, step: f64) -> f64 {
    let weights = SECOND_DERIVATIVE_WEIGHTS[DIFFERENCE_SAMPLES / 2]
        .iter()
        .map(|weight| (weight / 12.0).powi(2))
        .sum::<f64>()
        .sqrt();
    weights * quantum / 12f64.sqrt() / (step * step)
}

/// Fewest samples of which derivatives are taken.
pub const MIN_DERIVATIVE_SAMPLES: usize = DIFFERENCE_SAMPLES;

/// First and second derivative of a series of at least [`MIN_DERIVATIVE_SAMPLES`] samples: central
/// differences of fourth order, and one-sided ones over five samples at the ends.
pub fn derivatives(values: &[f64], step: f64) -> Vec<[f64; 2]> {
    let last = values.len() - DIFFERENCE_SAMPLES;
    let at = |k: usize| {
        let begin = k.saturating_sub(DIFFERENCE_SAMPLES / 2).min(last);
        let window = &values[begin..begin + DIFFERENCE_SAMPLES];
        // Relative to the sample itself, so that an offset costs no digits.
        let sum = |weights: &[f64; 5]| {
            weights.iter().zip(window).map(|(weight, value)| weight * (value - values[k])).sum::<f64>() / 12.0
        };
        [sum(&FIRST_DERIVATIVE_WEIGHTS[k - begin]) / step, sum(&SECOND_DERIVATIVE_WEIGHTS[k - begin]) / (step * step)]
    };
    (0..values.len()).map(at).collect()
}

/// Velocity and acceleration by central differences over three samples. Both are means over the
/// neighbouring steps, and exceed no limit that the motion itself keeps.
pub fn mean_derivatives(values: &[f64], step: f64) -> Vec<[f64; 2]> {
    let last = values.len() - 2;
    let at = |k: usize| {
        let middle = k.clamp(1, last);
        let [before, now, after] = [values[middle - 1], values[middle], values[middle + 1]];
        [(after - before) / (2.0 * step), ((after - now) - (now - before)) / (step * step)]
    };
    (0..values.len()).map(at).collect()
}

/// Angles without the turns between samples.
pub fn unwrapped(angles: &[f64]) -> Vec<f64> {
    use std::f64::consts::{PI, TAU};
    let mut turns = 0.0;
    let mut last = angles.first().copied().unwrap_or(0.0);
    let unwrap = |&angle: &f64| {
        let jump = angle - last;
        if jump.abs() > PI {
            turns -= (jump / TAU).round();
        }
        last = angle;
        angle + TAU * turns
    };
    angles.iter().map(unwrap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_a_polynomial_of_fourth_degree_are_exact_inside() {
        let value = |t: f64| 3.0 + 2.0 * t - t * t + 0.5 * t.powi(3) - 0.25 * t.powi(4);
        let (step, count) = (0.1, 12);
        let time = |k: usize| step * k as f64;
        let values: Vec<f64> = (0..count).map(|k| value(time(k))).collect();
        for (k, [first, second]) in derivatives(&values, step).into_iter().enumerate() {
            let t = time(k);
            assert!((first - (2.0 - 2.0 * t + 1.5 * t * t - t.powi(3))).abs() < 1e-12, "{k}: {first}");
            // One-sided second differences over five samples are exact to the third power.
            let is_inside = (2..count - 2).contains(&k);
            let tolerance = if is_inside { 1e-10 } else { 0.1 };
            assert!((second - (-2.0 + 3.0 * t - 3.0 * t * t)).abs() < tolerance, "{k}: {second}");
        }
    }

    #[test]
    fn a_smooth_motion_has_its_acceleration_to_the_fourth_order() {
        let error = |step: f64| {
            let values: Vec<f64> = (0..400).map(|k| (4.0 * step * f64::from(k)).sin()).collect();
            let derivatives = derivatives(&values, step);
            let off = |k: usize| (derivatives[k][1] + 16.0 * values[k]).abs();
            (2..398).map(off).fold(0.0, f64::max)
        };
        let ratio = error(0.01) / error(0.005);
        assert!(error(0.01) < 1e-6 * 16.0 && (14.0..18.0).contains(&ratio), "{} {ratio}", error(0.01));
    }

    #[test]
    fn means_exceed_no_limit_of_a_motion_with_jumps() {
        // An acceleration that jumps between the limits every seventh sample.
        let (step, limit) = (0.01, 5.0);
        let (mut position, mut velocity, mut values) = (0.0, 0.0, vec![0.0]);
        for k in 0..100 {
            let acceleration = if (k / 7) % 2 == 0 { limit } else { -limit };
            position += step * (velocity + 0.5 * step * acceleration);
            velocity += step * acceleration;
            values.push(position);
        }
        assert!(
            mean_derivatives(&values, step).iter().all(|[_, acceleration]| acceleration.abs() <= limit * (1.0 + 1e-9))
        );
        let sharp = derivatives(&values, step).iter().map(|found| found[1].abs()).fold(0.0, f64::max);
        assert!(sharp > limit, "{sharp}");
    }

    #[test]
    fn angles_go_on_beyond_half_a_turn() {
        let angles: Vec<f64> = (0..50).map(|k| 0.3 * f64::from(k)).collect();
        let wrapped: Vec<f64> = angles.iter().map(|angle: &f64| angle.sin().atan2(angle.cos())).collect();
        let found = unwrapped(&wrapped);
        assert!(found.iter().zip(&angles).all(|(found, angle)| (found - angle).abs() < 1e-12), "{found:?}");
    }
}
