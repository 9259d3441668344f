//! The list of the laws, one for each strategy but the classical.

use serde::{Deserialize, Serialize};

use super::adaptive::Adaptive;
use super::law::{Decision, Law, PlanStatus, Previewed, Situation, Unsolvable};
use super::optimal::Optimal;
use super::predictive::Predictive;
use super::regulator::AxisModel;
use super::robust::Robust;
use crate::interface::{Parameters, StrategyKind};

/// Makes [`AnyLaw`] of the laws, each with the item of [`StrategyKind`] that chooses it.
macro_rules! laws {
    ($($item:ident: $law:ty),+ $(,)?) => {
        /// The law of the strategy in use.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum AnyLaw {
            $($item($law)),+
        }

        impl AnyLaw {
            /// The law that the parameters choose, at rest. None for the classical strategy, which
            /// has none.
            ///
            /// # Errors
            /// The weights cannot be used.
            pub fn of(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Option<Self>, Unsolvable> {
                Ok(match parameters.structure.strategy {
                    StrategyKind::Classical => None,
                    $(StrategyKind::$item => Some(AnyLaw::$item(Law::at_rest(models, parameters)?))),+
                })
            }

            /// As [`Law::set_parameters`].
            pub fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable> {
                match self {
                    $(AnyLaw::$item(law) => law.set_parameters(models, parameters)),+
                }
            }

            /// As [`Law::decisions`].
            pub fn decisions(&mut self, situation: &Situation, step: f64) -> Option<[Decision; 2]> {
                match self {
                    $(AnyLaw::$item(law) => law.decisions(situation, step)),+
                }
            }

            /// As [`Law::largest_heave`].
            pub fn largest_heave(&self) -> f64 {
                match self {
                    $(AnyLaw::$item(law) => law.largest_heave()),+
                }
            }

            /// As [`Law::plan`].
            pub fn plan(&self) -> Option<PlanStatus> {
                match self {
                    $(AnyLaw::$item(law) => law.plan()),+
                }
            }

            /// As [`Law::previewed`].
            pub fn previewed(&mut self) -> Option<&mut dyn Previewed> {
                match self {
                    $(AnyLaw::$item(law) => law.previewed()),+
                }
            }
        }
    };
}

laws! {
    Adaptive: Adaptive,
    Optimal: Optimal,
    Robust: Robust,
    Predictive: Box<Predictive>,
}
