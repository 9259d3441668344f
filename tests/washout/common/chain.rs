//! One chain out of the three that run side by side.

use moris_washout::filter::chain::{Chains, Denominator};
use nalgebra::Vector3;

/// The middle one of three chains, whose neighbours are of another kind and are fed something else:
/// they must not matter.
#[derive(Clone, Copy)]
pub struct Chain(Chains);

/// Which of the three.
const MIDDLE: usize = 1;

impl Chain {
    pub fn new(denominator: Denominator) -> Self {
        let neighbours = [Denominator::new(4, 3.0, 0.9, 0.7, 1.2), Denominator::new(2, 5.0, 0.4, 1.0, 1.0)];
        Chain(Chains::new([neighbours[0], denominator, neighbours[1]], 0.001))
    }

    pub fn advance(&mut self, start: f64, end: f64, step: f64) {
        self.0.advance(beside_others(start), beside_others(end), step);
    }

    pub fn low_pass(&self) -> f64 {
        self.0.low_pass()[MIDDLE]
    }

    pub fn high_pass(&self, input: f64) -> f64 {
        self.0.high_pass(beside_others(input))[MIDDLE]
    }

    pub fn first_integral(&self) -> f64 {
        self.0.first_integral()[MIDDLE]
    }

    pub fn second_integral(&self) -> f64 {
        self.0.second_integral()[MIDDLE]
    }
}

fn beside_others(input: f64) -> Vector3<f64> {
    Vector3::new(1.0 - input, input, -7.0 * input)
}
