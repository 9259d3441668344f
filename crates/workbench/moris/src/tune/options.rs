//! Options of `moris tune`.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use moris_washout::interface::{StrategyKind, TuningGroup};

use super::cost::{Aim, Channels};
use super::space::group_named;
use crate::option_values::{number_in, numbers};
use crate::recording::ConventionOptions;
use crate::setup_options::SetupOptions;

/// Search for parameters with a better shape of the felt force on a rig
///
/// Searches for break frequencies, dampings and scales with which surge and sway are felt at the
/// right time and with the right sign. The second aim is their size. The error of a
/// recording is half of 1 - shape + 2 inverted, a quarter of 1 - size, and a quarter of the sensed
/// error. 0 is perfect; a platform at rest scores 1. No safety unit and no actuator limit may be
/// active at any time. Shake, jolt and peak of the felt force may not exceed --comfort.
///
/// The sensed error is the vestibular model's response to felt minus desired. The response
/// counts as the RMS over time in perception thresholds, added in quadrature over specific force
/// and angular velocity along x, y, z. The same quantity of the desired motion divides it.
///
/// Recordings fade in from rest over 1 s; --fade-in changes it. The search starts from the given
/// parameters. Ctrl-C ends it and keeps the best result so far, a second Ctrl-C does so at once.
/// The same seed gives the same result on any number of cores.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Recordings (CSV) to tune on; see `moris simulate --help` for their columns
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,

    /// Rig file, or shipped rig (hobby150, ...) [default: the default rig]
    #[arg(long, value_name = "FILE|NAME")]
    pub rig: Option<PathBuf>,

    /// Parameter file or preset, as for `moris simulate`. May be given several times: later ones
    /// override earlier ones
    #[arg(long, value_name = "FILE|NAME")]
    pub parameters: Vec<String>,

    /// Strategy to tune, in place of the parameters'. With `all` each is tuned, and a table names
    /// the best
    #[arg(long, value_parser = strategy_choices())]
    pub strategy: Option<Choice>,

    /// What to search for: the shape, or the sensed error alone
    #[arg(long, value_enum, default_value_t)]
    pub objective: Aim,

    /// Recordings on which the result is only tested. --folds applies to the other recordings
    #[arg(long, value_name = "RECORDING", num_args = 1..)]
    pub hold_out: Vec<PathBuf>,

    /// Number of groups of recordings to leave out in turn, in place of one recording at a time.
    /// With 0 none is left out, and the result is the best parameters for the recordings tuned on
    #[arg(long, value_name = "NUMBER")]
    pub folds: Option<usize>,

    /// Parameters to tune, separated by commas
    #[arg(long, value_name = "GROUPS", value_delimiter = ',', value_parser = tuning_groups(), default_values = ["splitter", "angular", "scale", "strategy"])]
    pub tune: Vec<TuningGroup>,

    /// Weights of the sensed errors of specific force x, y, z and angular velocity x, y, z. The
    /// first two weigh the shapes of surge and sway, too
    #[arg(long, value_name = "WEIGHTS", value_parser = parse_weights, default_value = "1,1,1,1,1,1")]
    pub weights: Channels<f64>,

    /// Stroke reserve of every actuator at either end, in m
    #[arg(long, value_name = "METRES", value_parser = parse_reserve, default_value = "0.01")]
    pub stroke_reserve: f64,

    /// Bounds of shake, jolt and peak of the felt force on every axis, in m/s²; inf for none. Where
    /// they are exceeded before, the value before is the bound
    #[arg(long, value_name = "BOUNDS", value_parser = parse_comfort, default_value = "0.2,4,4")]
    pub comfort: [f64; 3],

    /// Parameter sets evaluated by each search after its coarse scan
    #[arg(long, value_name = "NUMBER", default_value_t = 3000)]
    pub evaluations: usize,

    /// Seed of the random numbers
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,

    /// The tuned parameters. With --strategy all those of each strategy are beside it, as in
    /// tuned.robust.toml
    #[arg(long, value_name = "FILE", default_value = "tuned.toml")]
    pub output: PathBuf,

    /// Directory for the reports: tune.md and a page for each recording
    #[arg(long, value_name = "DIRECTORY", default_value = crate::REPORT_DIRECTORY)]
    pub report: PathBuf,

    #[command(flatten)]
    pub conventions: ConventionOptions,
}

/// Strategies to tune.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// A single one.
    One(StrategyKind),
    /// Each of them.
    All,
}

impl Options {
    /// The strategies to tune; none: that of the parameters.
    pub fn strategies(&self) -> Vec<Option<StrategyKind>> {
        match self.strategy {
            None => vec![None],
            Some(Choice::One(kind)) => vec![Some(kind)],
            Some(Choice::All) => StrategyKind::ALL.iter().copied().map(Some).collect(),
        }
    }

    /// Rig and parameters, with a strategy if one is chosen.
    pub fn setup(&self, strategy: Option<StrategyKind>) -> SetupOptions {
        SetupOptions { rig: self.rig.clone(), parameters: self.parameters.clone(), strategy }
    }
}

/// The strategies by name, and `all`.
fn strategy_choices() -> impl TypedValueParser<Value = Choice> {
    let named = |name: String| StrategyKind::ALL.iter().copied().find(|strategy| strategy.name() == name);
    PossibleValuesParser::new(StrategyKind::ALL.iter().map(|strategy| strategy.name()).chain(["all"]))
        .map(move |name| named(name).map_or(Choice::All, Choice::One))
}

/// The groups of parameters by name.
fn tuning_groups() -> impl TypedValueParser<Value = TuningGroup> {
    let named = |name: String| group_named(&name).expect("only names of groups are accepted");
    PossibleValuesParser::new(TuningGroup::ALL.iter().map(|group| PossibleValue::new(group.name()).help(group.text())))
        .map(named)
}

fn parse_weights(text: &str) -> Result<Channels<f64>, String> {
    let are_usable = |weights: &Channels<f64>| {
        weights.iter().all(|weight| (0.0..=1e6).contains(weight)) && weights.iter().sum::<f64>() > 0.0
    };
    numbers(text)
        .filter(are_usable)
        .ok_or_else(|| "six numbers are needed, none below 0 and not all 0, such as 1,1,1,0.5,0.5,0.5".to_owned())
}

/// Bounds of shake, jolt and peak \[m/s2\].
fn parse_comfort(text: &str) -> Result<[f64; 3], String> {
    numbers(text)
        .filter(|bounds| bounds.iter().all(|bound| *bound > 0.0))
        .ok_or_else(|| "three numbers above 0 are needed, such as 0.2,4,4 or inf,4,4".to_owned())
}

fn parse_reserve(text: &str) -> Result<f64, String> {
    number_in(text, 0.0..=f64::MAX, "a length in m is needed, not below 0")
}

#[cfg(test)]
mod tests {
    use clap::{Args, Command};

    use super::super::cost::COMFORT_BOUNDS;
    use super::*;

    #[test]
    fn weights_are_six_numbers_of_which_one_at_least_counts() {
        assert_eq!(parse_weights("1, 2,3,0,0,0.5"), Ok([1.0, 2.0, 3.0, 0.0, 0.0, 0.5]));
        for wrong in ["", "1,2,3", "1,1,1,1,1,-1", "0,0,0,0,0,0", "1,1,1,1,1,NaN", "a,b,c,d,e,f"] {
            assert!(parse_weights(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn bounds_of_comfort_are_three_positive_numbers() {
        assert_eq!(parse_comfort("0.1, 3,inf"), Ok([0.1, 3.0, f64::INFINITY]));
        let command = Options::augment_args(Command::new("tune"));
        let option = command.get_arguments().find(|option| option.get_id() == "comfort").unwrap();
        let default = option.get_default_values()[0].to_str().unwrap();
        assert_eq!(parse_comfort(default), Ok(COMFORT_BOUNDS));
        for wrong in ["", "0.2,4", "0.2,4,4,4", "0,4,4", "0.2,-4,4", "NaN,4,4", "a,b,c"] {
            assert!(parse_comfort(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_reserve_is_a_length() {
        assert_eq!(parse_reserve("0.02"), Ok(0.02));
        assert!(parse_reserve("-0.02").is_err() && parse_reserve("inf").is_err() && parse_reserve("much").is_err());
    }
}
