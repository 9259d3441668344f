//! The list of the laws, one for each strategy but the classical.

use std::ops::{Deref, DerefMut};

use serde::{Deserialize, Serialize};

use super::adaptive::Adaptive;
use super::law::{Law, Unsolvable};
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
        }

        impl Deref for AnyLaw {
            type Target = dyn Law;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(AnyLaw::$item(law) => law),+
                }
            }
        }

        impl DerefMut for AnyLaw {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $(AnyLaw::$item(law) => law),+
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
