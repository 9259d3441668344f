//! The vestibular model: what the semicircular canals and the otoliths make of angular velocity and specific force.
//!
//! Both are linear and of second order, with the parameters of Telban and Cardullo (2005):
//!
//! - otoliths, from specific force to sensed specific force: 0.4 (1 + 10 s) / ((1 + 5 s)(1 + 0.016 s));
//! - semicircular canals, from angular velocity to sensed angular velocity: 5.73 * 80 s^2 / ((1 + 80 s)(1 + 5.73 s)).
//!
//! The otoliths sense a force that lasts at 0.4 of its size and a quick one at 0.8; the canals sense quick turning at its
//! size and forget a rate that lasts within some ten seconds.
//!
//! Each is discretised exactly for a signal that goes linearly from sample to sample (first-order hold), by the matrix
//! exponential.

use nalgebra::SMatrix;

/// A transfer function (b2 s^2 + b1 s + b0) / (a2 s^2 + a1 s + 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Organ {
    /// b0, b1 \[s\], b2 \[s2\].
    pub numerator: [f64; 3],
    /// a1 \[s\], a2 \[s2\].
    pub denominator: [f64; 2],
}

impl Organ {
    /// With the denominator (1 + slow s)(1 + quick s); time constants in s.
    const fn new(numerator: [f64; 3], slow: f64, quick: f64) -> Self {
        Organ { numerator, denominator: [slow + quick, slow * quick] }
    }
}

/// The otoliths: specific force to sensed specific force.
pub const OTOLITHS: Organ = Organ::new([0.4, 0.4 * 10.0, 0.0], 5.0, 0.016);

/// The semicircular canals: angular velocity to sensed angular velocity.
pub const CANALS: Organ = Organ::new([0.0, 0.0, 5.73 * 80.0], 80.0, 5.73);

/// What an organ senses of a signal that is sampled every `step` seconds, having been at `rest` for ever before its first
/// sample. The organ's answer to `rest` itself is left out: what is sensed is the change from it.
pub fn sensed(organ: &Organ, signal: &[f64], rest: f64, step: f64) -> Vec<f64> {
    let [b0, b1, b2] = organ.numerator;
    let [a1, a2] = organ.denominator;
    let transition = transition(organ, step);
    // a2 xi'' + a1 xi' + xi = u; what is sensed is b2 xi'' + b1 xi' + b0 xi.
    let (mut xi, mut rate) = (0.0, 0.0);
    let mut before = None;
    signal
        .iter()
        .map(|value| {
            let end = value - rest;
            if let Some(start) = before {
                let slope = (end - start) / step;
                let next = |row: [f64; 4]| row[0] * xi + row[1] * rate + row[2] * start + row[3] * slope;
                (xi, rate) = (next(transition[0]), next(transition[1]));
            }
            before = Some(end);
            let acceleration = (end - a1 * rate - xi) / a2;
            b2 * acceleration + b1 * rate + b0 * xi
        })
        .collect()
}

/// The exact step of xi and xi' for an input that is linear in time: what each of xi, xi', the input and its slope adds.
fn transition(organ: &Organ, step: f64) -> [[f64; 4]; 2] {
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
