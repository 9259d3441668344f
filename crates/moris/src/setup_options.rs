//! The options by which every command is told of a rig and parameters.

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

    /// Parameter file, or a preset: default, motorcycle, car, paper, small-motions, preaction,
    /// adaptive, optimal, predictive. May be given several times: later ones override earlier ones
    #[arg(long, value_name = "FILE|NAME")]
    pub parameters: Vec<String>,

    /// Strategy that divides the cue between surge, sway and tilt; overrides the parameters'
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
        let mut setup = Setup::load(self.rig.as_deref(), &self.parameters)?;
        if let Some(strategy) = self.strategy {
            setup.parameters.structure.strategy = strategy.into();
            let name = strategy.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
            setup.parameters_name =
                if self.parameters.is_empty() { name } else { format!("{} + {name}", setup.parameters_name) };
        }
        Ok(setup)
    }
}
