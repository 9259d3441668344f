//! Sets of FMU parameters that the runs are made with.

use moris_washout::presets;

/// A name and the parameters that differ from their start values.
#[derive(Clone, Copy, Debug)]
pub struct ParameterSet {
    /// The name in tables and figures.
    pub name: &'static str,
    /// Texts of parameter files, each over those before it.
    texts: &'static [&'static str],
}

impl ParameterSet {
    /// The FMU's variables and their values, in the FMU's units.
    pub fn values(&self) -> Vec<(&'static str, f64)> {
        self.texts.iter().flat_map(|text| presets::values(text)).collect()
    }
}

/// The set of the paper's runs.
pub const PAPER_SET: ParameterSet = ParameterSet { name: "paper", texts: &[presets::PAPER] };

/// For small quick motion, as in run b.
pub const SMALL_MOTIONS: ParameterSet =
    ParameterSet { name: "small-motions", texts: &[include_str!("../small-motions.toml")] };

/// The set of the paper's runs, and ahead of a stop; of the stroke, as much as the paper's rig has.
pub const PREACTION_SET: ParameterSet = ParameterSet {
    name: "paper + preaction",
    texts: &[presets::PAPER, "\"safety.x.positionLimit\" = 0.45", "\"preaction\" = \"on\""],
};

/// The strategy that feels best.
pub const RIDE_SET: ParameterSet = ParameterSet { name: "predictive", texts: &[] };

/// The five strategies, each with its own preset.
pub const STRATEGY_SETS: [ParameterSet; 5] = [
    ParameterSet { name: "classical", texts: &[presets::CLASSICAL] },
    ParameterSet { name: "adaptive", texts: &[presets::ADAPTIVE] },
    ParameterSet { name: "optimal", texts: &[presets::OPTIMAL] },
    ParameterSet { name: "robust", texts: &[presets::ROBUST] },
    RIDE_SET,
];
