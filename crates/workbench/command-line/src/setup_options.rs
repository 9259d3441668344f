//! The options by which every command takes a rig and parameters.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use moris_interface::Group;
use moris_setup::{Error, Setup, load_set};
use moris_washout::interface::{AutomaticScale, StrategyKind};
use moris_washout::{Parameters, warnings};

/// Options for rig and parameters.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct SetupOptions {
    /// Rig file, or shipped rig (hobby150, ...) [default: the default rig]
    #[arg(long, value_name = "FILE|NAME")]
    pub rig: Option<PathBuf>,

    /// Parameter file, or a preset: default, classical, paper, adaptive, optimal, robust, preview.
    /// May be given several times: later ones override earlier ones
    #[arg(long, value_name = "FILE|NAME")]
    pub parameters: Vec<String>,

    /// Strategy that divides the cue between surge, sway and tilt; overrides the parameters'
    /// [default: predictive]
    #[arg(long, value_parser = strategies())]
    pub strategy: Option<StrategyKind>,
}

/// The washout's strategies, by name or number.
pub fn strategies() -> impl TypedValueParser<Value = StrategyKind> {
    // Numbers of the strategies, as the FMU has them.
    const STRATEGY_NUMBERS: [&str; 5] = ["1", "2", "3", "4", "5"];
    let numbered = || StrategyKind::ALL.iter().copied().zip(STRATEGY_NUMBERS);
    let given = move |given: String| numbered().find(|(strategy, number)| [strategy.name(), number].contains(&&*given));
    PossibleValuesParser::new(numbered().map(|(strategy, number)| PossibleValue::new(strategy.name()).alias(number)))
        .map(move |name| given(name).map_or(StrategyKind::Predictive, |(strategy, _)| strategy))
}

impl SetupOptions {
    /// As [`SetupOptions::load`], with the automatic scale on unless a file says otherwise: nobody
    /// has chosen a scale for the drive that is to come.
    ///
    /// # Errors
    /// As [`Setup::load`].
    pub fn load_to_drive(&self) -> Result<Setup, Error> {
        // The parameter that is on in what drives at once.
        const AUTOMATIC_SCALE: &str = "scale.automatic";
        let mut setup = self.load_with_notes()?;
        for set in &self.parameters {
            if load_set(set, Parameters::ROWS)?.iter().any(|(name, _)| name == AUTOMATIC_SCALE) {
                return Ok(setup);
            }
        }
        setup.parameters.automatic_scale.automatic = AutomaticScale::On;
        Ok(setup)
    }

    /// As [`SetupOptions::load`]. What is doubtful about the parameters goes to standard error.
    ///
    /// # Errors
    /// As [`Setup::load`].
    pub fn load_with_notes(&self) -> Result<Setup, Error> {
        let setup = self.load()?;
        for warning in warnings(&setup.parameters) {
            eprintln!("note: {warning}");
        }
        Ok(setup)
    }

    /// The combined and validated parameters.
    ///
    /// # Errors
    /// As [`Setup::load`].
    pub fn load(&self) -> Result<Setup, Error> {
        let mut setup = Setup::load(self.rig.as_deref(), &self.parameters)?;
        let Some(strategy) = self.strategy else { return Ok(setup) };
        setup.parameters.structure.strategy = strategy;
        let name = strategy.name();
        setup.parameters_name =
            if self.parameters.is_empty() { name.to_owned() } else { format!("{} + {name}", setup.parameters_name) };
        Ok(setup)
    }
}
