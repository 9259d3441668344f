//! Sets of FMU parameters that the runs are made with.

use moris_washout::interface::StrategyKind;
use moris_washout::presets;

/// A name and the parameters that differ from their start values.
#[derive(Clone, Copy, Debug)]
pub struct ParameterSet {
    /// The name in tables and figures.
    pub name: &'static str,
    /// The FMU's variables and their values, in the FMU's units.
    pub values: &'static [(&'static str, f64)],
}

/// The set of the paper's runs.
pub const PAPER: ParameterSet = ParameterSet { name: "paper", values: presets::PAPER };

/// For small quick motion, as in run b.
pub const SMALL_MOTIONS: ParameterSet = ParameterSet { name: "small-motions", values: presets::SMALL_MOTIONS };

/// The set of the paper's runs, and ahead of a stop.
pub const PREACTION: ParameterSet = ParameterSet { name: "paper + preaction", values: &PAPER_WITH_PREACTION };

/// The start values, with the strategy that feels best.
pub const RIDE: ParameterSet =
    ParameterSet { name: "predictive", values: &[("strategy", StrategyKind::Predictive as i32 as f64 + 1.0)] };

/// The five strategies, each with its own preset.
pub const STRATEGIES: [ParameterSet; 5] = [
    ParameterSet { name: "classical", values: &[] },
    ParameterSet { name: "adaptive", values: presets::ADAPTIVE },
    ParameterSet { name: "optimal", values: presets::OPTIMAL },
    ParameterSet { name: "robust", values: presets::ROBUST },
    ParameterSet { name: "predictive", values: presets::PREDICTIVE },
];

/// Of the stroke, ahead of the stop, as much as the paper's rig has.
const STROKE_OF_THE_PAPER: &[(&str, f64)] = &[("safety.x.positionLimit", 0.45), presets::PREACTION[0]];

const PAPER_WITH_PREACTION: [(&str, f64); presets::PAPER.len() + STROKE_OF_THE_PAPER.len()] =
    presets::joined(presets::PAPER, STROKE_OF_THE_PAPER);
