//! The account of the preview's gains and losses, which bounds what wrong passes can cost.
//!
//! A gain is the squared error without memory less that of the forecast, over the mean squared
//! force: a rate that is at most 1. Its integral is a time. Two numbers are kept:
//!
//! - the debt, what forecasts that were given have lost more than gained since it was last zero;
//! - the proof, the sum of all gains and losses, from 0 to what is needed.
//!
//! The proof that is needed doubles with each 4 s of debt: P 2^(debt / D), P = 1.5 s and D = 4 s. A
//! preview begins once the proof is as large, and ends where it is less than half of that.
//!
//! **The bound.** The proof grows by at most 1 s in a second. When a preview begins after a time T,
//! P 2^(debt / D) is the proof, and so at most T. The debt is then at most D log2(T / P). While the
//! preview is given the debt grows by less than D, since with D more the needed proof has doubled.
//! Losses of forecasts that were made before the end come in the 2 s after it. The debt is never
//! less than the net loss of any stretch up to now. So no input, whatever it does, makes the
//! preview lose more than D (1 + log2(T / P)), and what 2 s can lose. In an hour this amounts to 49
//! s of the mean squared force: 1.4 % of it.

use serde::{Deserialize, Serialize};

use crate::ticks::TICK;

/// Proof that is needed without a debt \[s\].
const BASE_PROOF_TIME: f64 = 1.5;
/// Debt that doubles the proof needed \[s\].
const DEBT_DOUBLING_TIME: f64 = 4.0;
/// Squared force added to its mean \[(m/s2)^2\].
const FORCE_FLOOR: f64 = 0.05;

/// Squared errors without memory less those of the forecasts \[(m/s2)^2\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// Of forecasts that were given.
    pub given: f64,
    /// Of those that were made alone.
    pub made: f64,
}

/// Gains and losses so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Sum of the squared forces of the last minute, and of their weights.
    squares: f64,
    weights: f64,
    /// Proof and debt \[s\].
    proof: f64,
    debt: f64,
}

impl Account {
    /// Takes the force of a tick, and the gains of both axes in it.
    pub fn tick(&mut self, force: [f64; 2], gains: [Gain; 2]) {
        // Time constant of the mean squared force [s].
        const MEAN_TIME: f64 = 60.0;
        let forgetting_factor = 1.0 - TICK / MEAN_TIME;
        self.squares = forgetting_factor * self.squares + force[0] * force[0] + force[1] * force[1];
        self.weights = forgetting_factor * self.weights + 1.0;
        let square = self.squares / self.weights + FORCE_FLOOR;
        let time = |gain: f64| TICK * (gain / square).min(1.0);
        let given = time(gains[0].given + gains[1].given);
        self.debt = (self.debt - given).max(0.0);
        let made = time(gains[0].made + gains[1].made);
        self.proof = (self.proof + (given + made).min(TICK)).clamp(0.0, self.needed());
    }

    /// Proof that is needed \[s\].
    fn needed(&self) -> f64 {
        BASE_PROOF_TIME * libm::exp2(self.debt / DEBT_DOUBLING_TIME)
    }

    /// True where the proof is enough for a preview to begin, or to stay.
    pub fn allows(&self, is_given: bool) -> bool {
        // Part of the proof needed below which a preview ends.
        const KEEPING_FRACTION: f64 = 0.5;
        self.proof >= if is_given { KEEPING_FRACTION } else { 1.0 } * self.needed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest debt within an hour, and the net loss. A preview would gain `earned` of the
    /// squared force a second while it is not given. With it, it loses `lost` after `patience` s.
    fn worst_debt(earned: f64, lost: f64, patience: f64) -> (f64, f64) {
        let mut account = Account::default();
        let (mut is_given, mut since) = (false, 0.0);
        let (mut worst, mut net, mut least): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for _ in 0..(3600.0 / TICK) as usize {
            since = if is_given { since + TICK } else { 0.0 };
            let part = if is_given && since > patience { -lost } else { earned };
            let gain = part * (4.0 + FORCE_FLOOR);
            let gain = if is_given { Gain { given: gain, made: 0.0 } } else { Gain { given: 0.0, made: gain } };
            net += if is_given { TICK * part.min(1.0) } else { 0.0 };
            account.tick([2.0, 0.0], [gain, Gain::default()]);
            is_given = account.allows(is_given);
            worst = worst.max(account.debt);
            least = least.min(net);
        }
        (worst, -least)
    }

    #[test]
    fn the_loss_of_an_hour_is_bounded_whatever_the_preview_meets() {
        let bound = DEBT_DOUBLING_TIME * (1.0 + f64::log2(3600.0 / BASE_PROOF_TIME));
        for earned in [0.02, 0.3, 1.0, 30.0] {
            for lost in [0.01, 0.5, 4.0] {
                for patience in [0.0, 1.0, 60.0] {
                    let (debt, net) = worst_debt(earned, lost, patience);
                    // The last tick's loss comes before the preview ends.
                    let bound = bound + lost * TICK;
                    assert!(debt <= bound && net <= debt + 1e-9, "{earned} {lost} {patience}: {debt} {net} {bound}");
                }
            }
        }
        // Without the doubling it would lose 4 s of each 6.
        let (debt, _) = worst_debt(1.0, 4.0, 0.0);
        assert!(debt > 20.0, "{debt}");
    }

    #[test]
    fn gains_pay_the_debt() {
        let mut account = Account::default();
        let mut ticks = |seconds: f64, given: f64, made: f64| {
            let gain = Gain { given: given * (1.0 + FORCE_FLOOR), made: made * (1.0 + FORCE_FLOOR) };
            (0..(seconds / TICK).round() as usize).for_each(|_| account.tick([1.0, 0.0], [gain, Gain::default()]));
            (account.debt, account.allows(false))
        };
        assert!(!ticks(BASE_PROOF_TIME - 0.1, 0.0, 1.0).1);
        assert!(ticks(0.15, 0.0, 1.0).1);
        let (debt, is_allowed) = ticks(2.0, -4.0, 0.0);
        assert!((debt - 8.0).abs() < 1e-9 && !is_allowed);
        assert!(!ticks(4.0 * BASE_PROOF_TIME - 0.1, 0.0, 1.0).1, "two doublings");
        assert!(ticks(0.15, 0.0, 1.0).1);
        assert!((ticks(5.0, 1.0, 0.0).0 - 3.0).abs() < 1e-9);
        assert_eq!(ticks(5.0, 1.0, 0.0), (0.0, true));
    }
}
