//! The options by which every command takes a rig and parameters.

use std::path::PathBuf;

use clap::ValueEnum;
use moris_setup::{Error, Setup};
use moris_washout::interface::StrategyKind;

/// Options for rig and parameters.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct SetupOptions {
    /// Rig file [default: the default rig]
    #[arg(long, value_name = "FILE")]
    pub rig: Option<PathBuf>,

    /// Parameter file, or a preset: default, motorcycle, car, paper, small-motions,
    /// preaction, adaptive, optimal, predictive, preview. May be given several times: later
    /// ones override earlier ones
    #[arg(long, value_name = "FILE|NAME")]
    pub parameters: Vec<String>,

    /// Strategy that divides the cue between surge, sway and tilt, with the preset of its name
    /// below the parameters given; overrides their strategy
    #[arg(long, value_enum)]
    pub strategy: Option<Strategy>,
}

/// The washout's strategies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Strategy {
    Classical,
    Adaptive,
    Optimal,
    Predictive,
}

impl From<Strategy> for StrategyKind {
    fn from(strategy: Strategy) -> Self {
        match strategy {
            Strategy::Classical => StrategyKind::Classical,
            Strategy::Adaptive => StrategyKind::Adaptive,
            Strategy::Optimal => StrategyKind::Optimal,
            Strategy::Predictive => StrategyKind::Predictive,
        }
    }
}

impl SetupOptions {
    /// The combined and validated parameters.
    ///
    /// # Errors
    /// As [`Setup::load`].
    pub fn load(&self) -> Result<Setup, Error> {
        let Some(strategy) = self.strategy else { return Setup::load(self.rig.as_deref(), &self.parameters) };
        let name = strategy.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
        // The set of a strategy's name has the limits that the strategy is made for.
        let own = (strategy != Strategy::Classical).then(|| name.clone());
        let sets: Vec<String> = own.into_iter().chain(self.parameters.iter().cloned()).collect();
        let mut setup = Setup::load(self.rig.as_deref(), &sets)?;
        setup.parameters.structure.strategy = strategy.into();
        if !self.parameters.is_empty() {
            let given = Setup::load(self.rig.as_deref(), &self.parameters)?.parameters_name;
            setup.parameters_name = format!("{given} + {name}");
        } else {
            setup.parameters_name = name;
        }
        Ok(setup)
    }
}
