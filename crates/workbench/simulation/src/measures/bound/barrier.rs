//! Limits of values in an interior-point method: slacks, multipliers, and how far a step may go.
//!
//! A value x between min and max has the slacks x - min and max - x, each with a multiplier. A step
//! aims at the same product of slack and multiplier, the target, for all limits.

use super::program::Range;

/// Multipliers of lower and of upper limits, all above 0.
#[derive(Clone, Copy, Debug)]
pub struct Multipliers<const M: usize> {
    pub lower: [f64; M],
    pub upper: [f64; M],
}

/// Values with limits, their multipliers, and the step of the values without a target.
pub struct Bounded<'a, const M: usize> {
    pub range: &'a Range<M>,
    pub values: [f64; M],
    pub multipliers: &'a Multipliers<M>,
}

/// One limit: its slack, its multiplier, and 1 for a lower limit, -1 for an upper one.
struct Limit {
    slack: f64,
    multiplier: f64,
    sign: f64,
}

impl Limit {
    /// Product that the step aims at, with the product of the uncentred steps of slack and
    /// multiplier taken off (Mehrotra's corrector).
    fn target(&self, uncentred: f64, target: f64) -> f64 {
        target - self.uncentred_product(uncentred)
    }

    fn uncentred_product(&self, change: f64) -> f64 {
        let slack = self.sign * change;
        -self.multiplier * slack * (1.0 + slack / self.slack)
    }

    /// Step of the multiplier divided by the multiplier.
    fn relative_step(&self, change: f64, target: f64) -> f64 {
        (target / self.multiplier - self.sign * change) / self.slack - 1.0
    }
}

impl<const M: usize> Multipliers<M> {
    /// Those of values at 0 whose products with the slacks are all the same.
    pub fn at_rest(range: &Range<M>, product: f64) -> Self {
        Multipliers { lower: range.min.map(|min| product / -min), upper: range.max.map(|max| product / max) }
    }

    /// Upper less lower ones.
    pub fn net(&self) -> [f64; M] {
        std::array::from_fn(|k| self.upper[k] - self.lower[k])
    }
}

impl<const M: usize> Bounded<'_, M> {
    fn limits(&self, k: usize) -> [Limit; 2] {
        let Bounded { range, values, multipliers } = self;
        [
            Limit { slack: values[k] - range.min[k], multiplier: multipliers.lower[k], sign: 1.0 },
            Limit { slack: range.max[k] - values[k], multiplier: multipliers.upper[k], sign: -1.0 },
        ]
    }

    fn sum(&self, term: impl Fn(usize, &Limit) -> f64) -> f64 {
        (0..M).map(|k| self.limits(k).iter().map(|limit| term(k, limit)).sum::<f64>()).sum()
    }

    /// Sum of the products of slack and multiplier.
    pub fn products(&self) -> f64 {
        self.sum(|_, limit| limit.slack * limit.multiplier)
    }

    /// Sum of the products of the uncentred steps of slack and multiplier.
    pub fn uncentred_products(&self, change: &[f64; M]) -> f64 {
        self.sum(|k, limit| limit.uncentred_product(change[k]))
    }

    /// Terms that the limits add to the diagonal of the Hessian.
    pub fn weights(&self) -> [f64; M] {
        std::array::from_fn(|k| self.limits(k).iter().map(|limit| limit.multiplier / limit.slack).sum())
    }

    /// Terms that the limits add to the gradient.
    pub fn gradient(&self, uncentred: &[f64; M], target: f64) -> [f64; M] {
        let of = |k: usize, limit: &Limit| -limit.sign * limit.target(uncentred[k], target) / limit.slack;
        std::array::from_fn(|k| self.limits(k).iter().map(|limit| of(k, limit)).sum())
    }

    /// Largest decrease of a slack or a multiplier in the uncentred step, as a fraction of it.
    pub fn uncentred_decrease(&self, change: &[f64; M]) -> f64 {
        let of = |k: usize, limit: &Limit| {
            let slack = limit.sign * change[k] / limit.slack;
            f64::max(-slack, 1.0 + slack)
        };
        self.largest(of)
    }

    /// The same in the centred step.
    pub fn decrease(&self, change: &[f64; M], uncentred: &[f64; M], target: f64) -> f64 {
        let of = |k: usize, limit: &Limit| {
            let multiplier = limit.relative_step(change[k], limit.target(uncentred[k], target));
            f64::max(-limit.sign * change[k] / limit.slack, -multiplier)
        };
        self.largest(of)
    }

    fn largest(&self, of: impl Fn(usize, &Limit) -> f64) -> f64 {
        (0..M).flat_map(|k| self.limits(k).map(|limit| of(k, &limit))).fold(0.0, f64::max)
    }

    /// The multipliers after a part of the centred step.
    pub fn stepped(&self, part: f64, change: &[f64; M], uncentred: &[f64; M], target: f64) -> Multipliers<M> {
        let of = |k: usize, limit: &Limit| {
            let step = limit.relative_step(change[k], limit.target(uncentred[k], target));
            limit.multiplier * (1.0 + part * step)
        };
        Multipliers {
            lower: std::array::from_fn(|k| of(k, &self.limits(k)[0])),
            upper: std::array::from_fn(|k| of(k, &self.limits(k)[1])),
        }
    }
}
