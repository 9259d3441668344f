//! The vestibular model: response of the semicircular canals to angular velocity, and of the
//! otoliths to specific force.
//!
//! Both are linear and of second order, with the parameters of Telban and Cardullo (2005):
//!
//! - otoliths, from specific force to sensed specific force: 0.4 (1 + 10 s) /
//!   ((1 + 5 s)(1 + 0.016 s));
//! - semicircular canals, from angular velocity to sensed angular velocity: 5.73 * 80 s^2 /
//!   ((1 + 80 s)(1 + 5.73 s)).
//!
//! The otoliths respond to a sustained force with a gain of 0.4, and to a quick one with a gain of
//! 0.8. The canals respond to quick turning with a gain of 1. Their response to a sustained rate
//! decays within some ten seconds.
//!
//! Each is discretised by the matrix exponential, exactly for a signal that is linear between its
//! samples (first-order hold).

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

/// Response of a sensor to a signal that is sampled every `step` seconds and was at `rest` before
/// its first sample. The response to `rest` itself is omitted: the result is the deviation from it.
pub fn sensed(sensor: &SensorModel, signal: &[f64], rest: f64, step: f64) -> Vec<f64> {
    let [b0, b1, b2] = sensor.numerator;
    let [a1, a2] = sensor.denominator;
    let transition = exact_transition(sensor, step);
    // a2 response'' + a1 response' + response = u; the sensed value is b2 response'' + b1 response' + b0 response.
    let (mut response, mut rate) = (0.0, 0.0);
    let mut before = None;
    signal
        .iter()
        .map(|value| {
            let end = value - rest;
            if let Some(start) = before {
                let slope = (end - start) / step;
                let next = |row: [f64; 4]| row[0] * response + row[1] * rate + row[2] * start + row[3] * slope;
                (response, rate) = (next(transition[0]), next(transition[1]));
            }
            before = Some(end);
            let acceleration = (end - a1 * rate - response) / a2;
            b2 * acceleration + b1 * rate + b0 * response
        })
        .collect()
}

/// The exact step of the response and its rate for an input that is linear in time. Each row holds
/// the coefficients of the response, its rate, the input and the input's slope.
fn exact_transition(sensor: &SensorModel, step: f64) -> [[f64; 4]; 2] {
    let [a1, a2] = sensor.denominator;
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
        for (sensor, slow, quick) in [(&OTOLITHS, 5.0, 0.016), (&CANALS, 80.0, 5.73)] {
            for omega in [0.05, 0.5, 5.0] {
                let periods = (600.0 * omega / (2.0 * PI)).floor();
                let length = (periods * 2.0 * PI / omega / STEP).round() as usize;
                let signal: Vec<f64> = (0..4 * length).map(|k| (omega * k as f64 * STEP).sin()).collect();
                let settled = &sensed(sensor, &signal, 0.0, STEP)[3 * length..];
                let rms = (settled.iter().map(|y| y * y).sum::<f64>() / length as f64).sqrt();
                let [b0, b1, b2] = sensor.numerator;
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
