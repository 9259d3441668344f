//! Motion sickness: what share of people a ride would make sick, by the conflict between the sensed
//! and the expected vertical, and the dose of ISO 2631-1.
//!
//! The first is the model "6DoF-SVC (IN1)" of Inoue, Liu and Wada (SAE Technical Paper
//! 2023-01-0176) with its parameters. With f the specific force at the head, gravity's reaction
//! included, and w its angular velocity:
//!
//! - sensed angular velocity: w_s = (1/td + 1/ta) x' + x/(td ta) + w, where x'' = -(1/td + 1/ta) x'
//!   \- x/(td ta) - w;
//! - sensed vertical: v_s' = (f - v_s)/tau - w_s x v_s;
//! - expected force: f^ = (Ka (f - g) + Kvc xvc + Kac (f - v_s + v^))/(1 + Kac), with g' = -w x g;
//! - expected angular velocity: w^ = (xc + Kw w + Kwc w_s)/(1 + Kwc);
//! - expected vertical: v^' = (f^ - v^)/tau - w^ x v^;
//! - corrections: xc' = -(xc + Kw w + Kwc (w_s - w^))/td, xvc' = v_s - v^;
//! - conflict: H = h/(1 + h), h = |v_s - v^|²/b².
//!
//! The share of people who are sick follows tau_I² M'' = -2 tau_I M' - M + P H from M = 0. With
//! tau_I of twelve minutes a ride of one or two minutes says little. So [`share_sick`] repeats the
//! ride for half an hour, with its mean H.
//!
//! The model has no vision, and its data are of passengers.

use moris_washout::interface::STANDARD_GRAVITY;
use nalgebra::{SMatrix, SVector, Vector3};

const KVC: f64 = 5.0;

/// Share of people who are sick after half an hour of such motion \[%\].
///
/// `force` is the specific force at the head, gravity's reaction included \[m/s2\], `rate` the
/// angular velocity \[rad/s\], `step` the time between samples \[s\]. The motion begins at rest and
/// upright.
pub fn share_sick(force: &[[f64; 3]], rate: &[[f64; 3]], step: f64) -> f64 {
    // Time for which `share_sick` has the ride repeated [s].
    const EXPOSURE: f64 = 1800.0;
    share_after(EXPOSURE, mean_conflict(force, rate, step))
}

/// The response of M after this time to a constant H.
fn share_after(time: f64, conflict: f64) -> f64 {
    // Largest share of people [%], and the time constant of its growth [s].
    const MAX_SICK_SHARE: f64 = 85.0;
    const SICKNESS_GROWTH_TIME: f64 = 720.0;
    let times = time / SICKNESS_GROWTH_TIME;
    MAX_SICK_SHARE * conflict * (1.0 - (1.0 + times) * (-times).exp())
}

/// The mean of H over the motion.
fn mean_conflict(force: &[[f64; 3]], rate: &[[f64; 3]], step: f64) -> f64 {
    let (force, block) = block_means(force, step);
    let (rate, _) = block_means(rate, step);
    let mut state = at_rest();
    let mut sum = 0.0;
    for (force, rate) in force.windows(2).zip(rate.windows(2)) {
        let before = vertical_conflict(&state);
        state = runge_kutta(state, block, |state, fraction| {
            state_derivative(state, force[0].lerp(&force[1], fraction), rate[0].lerp(&rate[1], fraction))
        });
        sum += 0.5 * (before + vertical_conflict(&state));
    }
    sum / (force.len() - 1).max(1) as f64
}

/// x, x', v_s, v^, xc, xvc and g, a column each.
type State = SMatrix<f64, 3, 7>;

fn at_rest() -> State {
    // Gravity in the model [m/s2].
    const MODEL_GRAVITY: f64 = 9.81;
    let (up, none) = (Vector3::z() * MODEL_GRAVITY, Vector3::zeros());
    State::from_columns(&[none, none, up, up, none, up / KVC, up])
}

/// The state's derivative in a motion of the head.
fn state_derivative(state: &State, force: Vector3<f64>, rate: Vector3<f64>) -> State {
    const KA: f64 = 0.1;
    const KW: f64 = 0.1;
    const KWC: f64 = 10.0;
    const KAC: f64 = 0.5;
    // Time constants of the canals [s].
    const CANAL_TIME_CONSTANTS: [f64; 2] = [7.0, 190.0];
    // Time constant of the sensed vertical [s].
    const VERTICAL_TIME_CONSTANT: f64 = 2.0;
    let [x, x_rate, sensed, expected, correction, vertical_correction, gravity] =
        std::array::from_fn(|k| state.column(k).into_owned());
    let canals = x_rate * (1.0 / CANAL_TIME_CONSTANTS[0] + 1.0 / CANAL_TIME_CONSTANTS[1])
        + x / (CANAL_TIME_CONSTANTS[0] * CANAL_TIME_CONSTANTS[1]);
    let sensed_rate = canals + rate;
    let expected_force =
        ((force - gravity) * KA + vertical_correction * KVC + (force - sensed + expected) * KAC) / (1.0 + KAC);
    let expected_rate = (correction + rate * KW + sensed_rate * KWC) / (1.0 + KWC);
    State::from_columns(&[
        x_rate,
        -canals - rate,
        (force - sensed) / VERTICAL_TIME_CONSTANT - sensed_rate.cross(&sensed),
        (expected_force - expected) / VERTICAL_TIME_CONSTANT - expected_rate.cross(&expected),
        -(correction + rate * KW + (sensed_rate - expected_rate) * KWC) / CANAL_TIME_CONSTANTS[0],
        sensed - expected,
        -rate.cross(&gravity),
    ])
}

/// Hill function H of the conflict between sensed and expected vertical.
fn vertical_conflict(state: &State) -> f64 {
    // Conflict at which H is one half [m/s2].
    const HALF_CONFLICT: f64 = 0.5;
    let square = (state.column(2) - state.column(3)).norm_squared() / (HALF_CONFLICT * HALF_CONFLICT);
    square / (1.0 + square)
}

/// Numerator and denominator of the filter Wf of ISO 2631-1 in falling powers of s, a fit of the
/// fifth order.
const WF: ([f64; 5], [f64; 5]) = ([0.1457, 0.2331, 13.75, 1.705, 0.3596], [7.757, 19.06, 28.37, 18.52, 7.230]);

/// Motion sickness dose value of ISO 2631-1 \[m/s^1.5\]: the root of the integral of the square of
/// the vertical acceleration, weighted by Wf.
pub fn dose(force: &[[f64; 3]], step: f64) -> f64 {
    let (force, block) = block_means(force, step);
    let (numerator, denominator) = (SVector::from(WF.0), SVector::from(WF.1));
    let mut state = SVector::<f64, 5>::zeros();
    let mut integral = 0.0;
    for pair in force.windows(2) {
        let before = numerator.dot(&state);
        state = runge_kutta(state, block, |state, fraction| {
            let acceleration = pair[0].lerp(&pair[1], fraction).z - STANDARD_GRAVITY;
            let mut slope = SVector::<f64, 5>::zeros();
            slope[0] = acceleration - denominator.dot(state);
            slope.fixed_rows_mut::<4>(1).copy_from(&state.fixed_rows::<4>(0));
            slope
        });
        let after = numerator.dot(&state);
        // The square of a line's integral.
        integral += block * (before * before + before * after + after * after) / 3.0;
    }
    integral.sqrt()
}

/// Means over blocks of samples, and a block's length \[s\].
fn block_means(series: &[[f64; 3]], step: f64) -> (Vec<Vector3<f64>>, f64) {
    // Longest step of the integration [s]; samples within it count as their mean.
    const LONGEST_STEP: f64 = 0.05;
    let count = (LONGEST_STEP / step).floor().max(1.0) as usize;
    let mean = |block: &[[f64; 3]]| block.iter().copied().map(Vector3::from).sum::<Vector3<f64>>() / block.len() as f64;
    (series.chunks(count).map(mean).collect(), count as f64 * step)
}

/// A step of the classical Runge-Kutta method; `slope` gets the state and the fraction of the step.
pub fn runge_kutta<const R: usize, const C: usize>(
    state: SMatrix<f64, R, C>,
    step: f64,
    slope: impl Fn(&SMatrix<f64, R, C>, f64) -> SMatrix<f64, R, C>,
) -> SMatrix<f64, R, C> {
    let first = slope(&state, 0.0);
    let second = slope(&(state + first * (0.5 * step)), 0.5);
    let third = slope(&(state + second * (0.5 * step)), 0.5);
    let fourth = slope(&(state + third * step), 1.0);
    state + (first + (second + third) * 2.0 + fourth) * (step / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.01;

    fn series(duration: f64, of: impl Fn(f64) -> [f64; 3]) -> Vec<[f64; 3]> {
        (0..=(duration / STEP).round() as usize).map(|k| of(k as f64 * STEP)).collect()
    }

    fn heaving(duration: f64, rms: f64, frequency: f64) -> Vec<[f64; 3]> {
        let amplitude = rms * 2_f64.sqrt();
        series(duration, |t| [0.0, 0.0, 9.81 + amplitude * (std::f64::consts::TAU * frequency * t).sin()])
    }

    /// The case of the authors' own program: 0.234 g at 0.2 Hz along the vertical for two hours.
    /// scipy's DOP853 with tolerances of 1e-9 gives 70.324 %.
    #[test]
    fn two_hours_of_heave_make_as_many_sick_as_another_integration_says() {
        let force = heaving(7200.0, 0.234 * 9.81, 0.2);
        let found = share_after(7200.0, mean_conflict(&force, &vec![[0.0; 3]; force.len()], STEP));
        assert!((found - 70.324).abs() < 0.05, "{found} %");
    }

    /// By scipy's DOP853 with tolerances of 1e-9.
    #[test]
    fn the_mean_conflict_of_a_general_motion_is_that_of_another_integration() {
        let force = series(120.0, |t| {
            let sway = 0.8 * (0.5 * t).cos() - 0.8 * (-t).exp();
            [1.5 * (0.9 * t).sin(), sway, 9.81 + 0.7 * (1.3 * t).sin()]
        });
        let rate = series(120.0, |t| [0.1 * (0.7 * t).sin(), 0.05 * (0.4 * t).sin(), 0.2 * (0.3 * t).sin()]);
        let found = mean_conflict(&force, &rate, STEP);
        assert!((found - 0.501_684).abs() < 3e-4, "{found}");
    }

    #[test]
    fn at_rest_nobody_is_sick() {
        let force = vec![[0.0, 0.0, 9.81]; 5000];
        assert!(share_sick(&force, &vec![[0.0; 3]; 5000], STEP) < 1e-12);
        assert_eq!(dose(&vec![[0.0, 0.0, 9.80665]; 5000], STEP), 0.0);
    }

    /// A long sine's dose is its RMS times the filter's gain times the root of the time.
    #[test]
    fn the_dose_of_a_sine_is_the_filters_gain() {
        let (duration, rms) = (1000.0, 1.0);
        for frequency in [0.1, 0.2, 0.5] {
            let s = nalgebra::Complex::new(0.0, std::f64::consts::TAU * frequency);
            let polynomial = |sum, coefficients: &[f64]| coefficients.iter().fold(sum, |sum, c| sum * s + c);
            let none = nalgebra::Complex::new(0.0, 0.0);
            let gain = (polynomial(none, &WF.0) / polynomial(none + 1.0, &WF.1)).norm();
            let shift = |[x, y, z]: [f64; 3]| [x, y, z - 9.81 + 9.80665];
            let force: Vec<_> = heaving(duration, rms, frequency).into_iter().map(shift).collect();
            let (found, expected) = (dose(&force, STEP), rms * gain * duration.sqrt());
            assert!((found - expected).abs() < 0.01 * expected, "{frequency} Hz: {found} beside {expected}");
        }
    }
}
