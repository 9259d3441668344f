//! The least-squares fit of one target: recursive sums with forgetting, and a prior.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// Number of features that are forces: the reference and its five low-passes of the fit.
pub const FORCES: usize = 6;
/// Number of features: the forces and three angular velocities.
pub const FEATURES: usize = FORCES + 3;
pub type Features = SVector<f64, FEATURES>;
pub type Covariance = SMatrix<f64, FEATURES, FEATURES>;

/// Weighted sums of x x', in the lower triangle, and x y over the past, for features x and a target
/// y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Regression {
    pub(super) squares: Covariance,
    pub(super) products: Features,
}

impl Regression {
    /// Sums of features of this covariance that the coefficients fit without an error.
    pub fn new(covariance: Covariance, coefficients: &Features) -> Self {
        Regression { squares: covariance, products: covariance * coefficients }
    }

    /// Forgets a part of the past in favour of the prior, and adds a sample.
    pub fn add(&mut self, forgetting_factor: f64, prior: &Regression, x: &Features, y: f64) {
        let forgotten = 1.0 - forgetting_factor;
        for column in 0..FEATURES {
            for row in column..FEATURES {
                let at = (row, column);
                self.squares[at] =
                    forgetting_factor * self.squares[at] + forgotten * prior.squares[at] + x[row] * x[column];
            }
            self.products[column] =
                forgetting_factor * self.products[column] + forgotten * prior.products[column] + x[column] * y;
        }
    }

    /// The coefficients with the least squared error; none where rounding makes the sums
    /// indefinite.
    pub fn coefficients(&self) -> Option<Features> {
        self.squares.cholesky().map(|factor| factor.solve(&self.products))
    }
}
