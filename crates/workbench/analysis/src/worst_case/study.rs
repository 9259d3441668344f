//! A strategy on all rides and machines.

use moris_stewart_platform::Parameters as Platform;
use moris_washout::Parameters;
use moris_washout::interface::StrategyKind;
use rayon::prelude::*;

use super::commands::{Commands, LONGEST_STEP};
use super::figures::{Desired, Figures, Measure, RideFigures, over_rides};
use super::machine::real_motion;
use super::points::Point;
use crate::error::{About, Result};
use crate::message::Message;
use crate::recording::Recording;

/// Excess by which a value is larger than another, relative to it. Less is rounding: without active
/// limits the load has no effect, and a point nearer to the nominal one is named.
const ROUNDING: f64 = 1e-6;

/// A strategy's figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// The strategy.
    pub strategy: StrategyKind,
    /// On the commanded motion, without a machine.
    pub commanded: Figures,
    /// On each machine, in the order of the points; the first is nominal.
    pub machines: Vec<MachineFigures>,
}

/// A strategy's figures on a machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineFigures {
    /// Parameters of the machine.
    pub point: Point,
    /// Figures of the strategy on the machine.
    pub figures: Figures,
    /// True if a drive was limited by its force on any ride.
    pub force_limited: bool,
    /// True if a drive was limited by speed, acceleration or stroke on any ride.
    pub drive_limited: bool,
}

impl Study {
    /// Measures a strategy with these other parameters, on every ride and machine. `progress` is
    /// called after each ride on each machine.
    ///
    /// # Errors
    /// The parameters of the washout or of a machine cannot be used, or nothing is desired.
    pub fn of(
        strategy: StrategyKind,
        rides: &[Recording],
        parameters: &Parameters,
        platform: &Platform,
        points: &[Point],
        progress: &(dyn Fn() + Sync),
    ) -> Result<Self> {
        let mut parameters = *parameters;
        parameters.structure.strategy = strategy;
        let prepared: Vec<(Commands, Desired)> =
            rides.par_iter().map(|ride| prepare(ride, &parameters)).collect::<Result<_>>()?;
        let commanded: Vec<RideFigures> =
            prepared.iter().map(|(commands, desired)| desired.compared_with(&commands.felt)).collect();
        let machine = |point: &Point| {
            let on_ride = |(commands, desired): &(Commands, Desired)| {
                let real = real_motion(commands, &point.parameters(platform))
                    .about(|| format!("platform with {:.0} % of its load", 100.0 * point.load))?;
                progress();
                Ok((desired.compared_with(&real.felt), real.force_limited, real.drive_limited))
            };
            let rides: Vec<(RideFigures, bool, bool)> = prepared.par_iter().map(on_ride).collect::<Result<_>>()?;
            Ok(MachineFigures {
                point: *point,
                figures: figures(rides.iter().map(|(figures, ..)| figures))?,
                force_limited: rides.iter().any(|(_, limited, _)| *limited),
                drive_limited: rides.iter().any(|(.., limited)| *limited),
            })
        };
        Ok(Study {
            strategy,
            commanded: figures(commanded.iter())?,
            machines: points.par_iter().map(machine).collect::<Result<_>>()?,
        })
    }

    /// The machine with the largest value of a measure; of equal ones, the first.
    pub fn worst(&self, measure: Measure) -> &MachineFigures {
        let value = |machine: &MachineFigures| machine.figures[measure as usize];
        self.machines.iter().fold(&self.machines[0], |worst, next| {
            if value(next) > value(worst) * (1.0 + ROUNDING) { next } else { worst }
        })
    }
}

fn prepare(ride: &Recording, parameters: &Parameters) -> Result<(Commands, Desired)> {
    let commands = Commands::of(ride, parameters, LONGEST_STEP).about(|| ride.name.clone())?;
    let desired = Desired::of(ride, &commands);
    Ok((commands, desired))
}

fn figures<'a>(rides: impl Iterator<Item = &'a RideFigures> + Clone) -> Result<Figures> {
    let none = "no surge or sway of at least 0.03 m/s² (RMS) is desired on these recordings; take one with motion";
    over_rides(rides).ok_or_else(|| Message::from(none).into())
}
