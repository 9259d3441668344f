//! The vestibular model: what the semicircular canals and the otoliths make of angular
//! velocity and specific force.
//!
//! Both are linear and of second order, with the parameters of Telban and Cardullo (2005):
//!
//! - otoliths, from specific force to sensed specific force: 0.4 (1 + 10 s) /
//!   ((1 + 5 s)(1 + 0.016 s));
//! - semicircular canals, from angular velocity to sensed angular velocity: 5.73 * 80 s^2 /
//!   ((1 + 80 s)(1 + 5.73 s)).
//!
//! The otoliths sense a force that lasts at 0.4 of its size and a quick one at 0.8; the canals
//! sense quick turning at its size and forget a rate that lasts within some ten seconds.
//!
//! Each is discretised exactly for a signal that goes linearly from sample to sample (first-order
//! hold), by the matrix exponential.

use nalgebra::SMatrix;

/// A transfer function (b2 s^2 + b1 s + b0) / (a2 s^2 + a1 s + 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorModel {
    /// b0, b1 \[s\], b2 \[s2\].
    pub numerator: [f64; 3],
    /// a1 \[s\], a2 \[s2\].
    pub denominator: [f64; 2],
}

impl SensorModel {
    /// With the denominator (1 + slow s)(1 + quick s); time constants in s.
    const fn new(numerator: [f64; 3], slow: f64, quick: f64) -> Self {
        SensorModel { numerator, denominator: [slow + quick, slow * quick] }
    }
}

/// The otoliths: specific force to sensed specific force.
pub const OTOLITHS: SensorModel = SensorModel::new([0.4, 0.4 * 10.0, 0.0], 5.0, 0.016);

/// The semicircular canals: angular velocity to sensed angular velocity.
pub const CANALS: SensorModel = SensorModel::new([0.0, 0.0, 5.73 * 80.0], 80.0, 5.73);

/// Response of an organ to a signal that is sampled every `step` seconds, having been at `rest`
/// for ever before its first sample. The organ's answer to `rest` itself is left out: what is
/// sensed is the change from it.
pub fn sensed(organ: &SensorModel, signal: &[f64], rest: f64, step: f64) -> Vec<f64> {
    let [b0, b1, b2] = organ.numerator;
    let [a1, a2] = organ.denominator;
    let transition = transition(organ, step);
    // a2 answer'' + a1 answer' + answer = u; what is sensed is b2 answer'' + b1 answer' + b0 answer.
    let (mut answer, mut rate) = (0.0, 0.0);
    let mut before = None;
    signal
        .iter()
        .map(|value| {
            let end = value - rest;
            if let Some(start) = before {
                let slope = (end - start) / step;
                let next = |row: [f64; 4]| row[0] * answer + row[1] * rate + row[2] * start + row[3] * slope;
                (answer, rate) = (next(transition[0]), next(transition[1]));
            }
            before = Some(end);
            let acceleration = (end - a1 * rate - answer) / a2;
            b2 * acceleration + b1 * rate + b0 * answer
        })
        .collect()
}

/// The exact step of the answer and its rate for an input that is linear in time: what each of
/// answer, rate, the input and its slope adds.
fn transition(organ: &SensorModel, step: f64) -> [[f64; 4]; 2] {
    let [a1, a2] = organ.denominator;
    #[rustfmt::skip]
    let matrix = SMatrix::<f64, 4, 4>::new(
        0.0,       1.0,      0.0,      0.0,
        -1.0 / a2, -a1 / a2, 1.0 / a2, 0.0,
        0.0,       0.0,      0.0,      1.0,
        0.0,       0.0,      0.0,      0.0,
    );
    let exponential = (matrix * step).exp();
    [0, 1].map(|row| std::array::from_fn(|column| exponential[(row, column)]))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const STEP: f64 = 0.01;

    fn sampled(seconds: f64, signal: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..=(seconds / STEP).round() as usize).map(|k| signal(k as f64 * STEP)).collect()
    }

    #[test]
    fn a_force_that_sets_in_is_sensed_as_the_closed_form_says() {
        // The ramp response of 0.4 (1 + 10 s)/((1 + 5 s)(1 + 0.016 s)), by partial fractions: for u = t,
        // y = 0.4 [t + 10 - 5 - 0.016 + c1 exp(-t/5) + c2 exp(-t/0.016)].
        let (t1, t2) = (5.0, 0.016);
        let c1 = t1 * (t1 - 10.0) / (t1 - t2);
        let c2 = t2 * (t2 - 10.0) / (t2 - t1);
        let ramp = |t: f64| 0.4 * (t + 10.0 - t1 - t2 + c1 * (-t / t1).exp() + c2 * (-t / t2).exp());
        let found = sensed(&OTOLITHS, &sampled(30.0, |t| 9.80665 + t), 9.80665, STEP);
        for (k, value) in found.iter().enumerate() {
            let t = k as f64 * STEP;
            assert!((value - ramp(t)).abs() < 1e-9, "{value} is not {} at {t} s", ramp(t));
        }
    }

    #[test]
    fn a_rate_that_sets_in_is_sensed_and_forgotten_as_the_closed_form_says() {
        // The ramp response of 5.73 * 80 s^2/((1 + 80 s)(1 + 5.73 s)) is 5.73 * 80/(80 - 5.73) (exp(-t/80) - exp(-t/5.73)).
        let ramp = |t: f64| 5.73 * 80.0 / (80.0 - 5.73) * ((-t / 80.0).exp() - (-t / 5.73).exp());
        let found = sensed(&CANALS, &sampled(300.0, |t| t), 0.0, STEP);
        for (k, value) in found.iter().enumerate() {
            let t = k as f64 * STEP;
            assert!((value - ramp(t)).abs() < 1e-9, "{value} is not {} at {t} s", ramp(t));
        }
    }

    #[test]
    fn a_vibration_is_sensed_with_the_transfer_function_s_modulus() {
        for (organ, slow, quick) in [(&OTOLITHS, 5.0, 0.016), (&CANALS, 80.0, 5.73)] {
            for omega in [0.05, 0.5, 5.0] {
                let periods = (600.0 * omega / (2.0 * PI)).floor();
                let length = (periods * 2.0 * PI / omega / STEP).round() as usize;
                let signal: Vec<f64> = (0..4 * length).map(|k| (omega * k as f64 * STEP).sin()).collect();
                let settled = &sensed(organ, &signal, 0.0, STEP)[3 * length..];
                let rms = (settled.iter().map(|y| y * y).sum::<f64>() / length as f64).sqrt();
                let [b0, b1, b2] = organ.numerator;
                let numerator = (b0 - b2 * omega * omega).hypot(b1 * omega);
                let modulus = numerator / (1.0_f64.hypot(slow * omega) * 1.0_f64.hypot(quick * omega));
                assert!((rms * 2.0_f64.sqrt() - modulus).abs() < 1e-3 * modulus, "{rms} {modulus} at {omega} rad/s");
            }
        }
    }

    #[test]
    fn rest_is_not_sensed() {
        assert!(sensed(&OTOLITHS, &[9.80665; 100], 9.80665, STEP).iter().all(|&y| y == 0.0));
        assert!(sensed(&CANALS, &[0.0; 100], 0.0, STEP).iter().all(|&y| y == 0.0));
    }
}
