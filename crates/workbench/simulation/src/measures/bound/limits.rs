//! Limits of values in an interior-point method: slacks, multipliers, and how far a step may go.
//!
//! A value x between min and max has the slacks x - min and max - x, each with a multiplier. A step
//! aims at products of slack and multiplier. Pairs are of lower and of upper limits.

use std::array::from_fn;

use nalgebra::SVector;

/// Change of a slack with its value.
const SIDE_SIGNS: [f64; 2] = [1.0, -1.0];

/// Slacks and multipliers of an interval's limits, all above 0.
pub struct Limits<const R: usize> {
    pub slacks: [SVector<f64, R>; 2],
    pub multipliers: [SVector<f64, R>; 2],
}

impl<const R: usize> Limits<R> {
    /// Sum of the products of slack and multiplier.
    pub fn products(&self) -> f64 {
        self.slacks.iter().zip(&self.multipliers).map(|(slacks, multipliers)| slacks.dot(multipliers)).sum()
    }

    /// Terms that the limits add to the diagonal of the Hessian.
    pub fn weights(&self) -> SVector<f64, R> {
        let [lower, upper] = from_fn(|side| self.multipliers[side].component_div(&self.slacks[side]));
        lower + upper
    }

    /// Terms that the limits add to the gradient of a step that aims at these products.
    pub fn gradient(&self, aims: &[SVector<f64, R>; 2]) -> SVector<f64, R> {
        let [lower, upper] = from_fn(|side| aims[side].component_div(&self.slacks[side]));
        upper - lower
    }

    /// Step of the multipliers with this change of the values.
    pub fn multiplier_steps(&self, change: &SVector<f64, R>, aims: &[SVector<f64, R>; 2]) -> [SVector<f64, R>; 2] {
        from_fn(|side| {
            let (slacks, multipliers) = (&self.slacks[side], &self.multipliers[side]);
            (aims[side] - SIDE_SIGNS[side] * multipliers.component_mul(change)).component_div(slacks) - multipliers
        })
    }

    /// Products of the steps of slack and multiplier where they aim at products of 0.
    pub fn uncentred_products(&self, change: &SVector<f64, R>) -> [SVector<f64, R>; 2] {
        let steps = self.multiplier_steps(change, &[SVector::zeros(); 2]);
        from_fn(|side| SIDE_SIGNS[side] * steps[side].component_mul(change))
    }

    /// Largest decrease of a slack or a multiplier in a step, as a fraction of it.
    pub fn largest_decrease(&self, change: &SVector<f64, R>, aims: &[SVector<f64, R>; 2]) -> f64 {
        let steps = self.multiplier_steps(change, aims);
        let [lower, upper] = from_fn(|side| {
            let slacks = (-SIDE_SIGNS[side] * change).component_div(&self.slacks[side]);
            slacks.max().max((-steps[side]).component_div(&self.multipliers[side]).max())
        });
        lower.max(upper)
    }
}
