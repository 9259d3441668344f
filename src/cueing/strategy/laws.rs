//! The list of the laws, one for each strategy but the classical.

#[cfg(feature = "predictive")]
use alloc::boxed::Box;
use core::ops::{Deref, DerefMut};

use serde::{Deserialize, Serialize};

#[cfg(feature = "adaptive")]
use super::adaptive::Adaptive;
use super::law::{Law, Unsolvable};
#[cfg(feature = "optimal")]
use super::optimal::Optimal;
#[cfg(feature = "predictive")]
use super::predictive::Predictive;
use super::regulator::AxisModel;
#[cfg(feature = "robust")]
use super::robust::Robust;
use crate::interface::{Parameters, StrategyKind};

/// Makes [`AnyLaw`] of the laws, each with the item of [`StrategyKind`] that chooses it.
macro_rules! laws {
    ($($(#[$built:meta])* $item:ident: $law:ty),+ $(,)?) => {
        /// The law of the strategy in use.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum AnyLaw {
            $($(#[$built])* $item($law)),+
        }

        impl AnyLaw {
            /// The law that the parameters choose, at rest. None for the classical strategy, which
            /// has none.
            ///
            /// # Errors
            /// The weights cannot be used, or the strategy is not built in.
            pub fn of(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Option<Self>, Unsolvable> {
                let _ = models; // no law is built in with the classical strategy alone
                Ok(match parameters.structure.strategy {
                    StrategyKind::Classical => None,
                    $($(#[$built])* StrategyKind::$item => Some(AnyLaw::$item(Law::at_rest(models, parameters)?)),)+
                    #[allow(unreachable_patterns)] // with all strategies built in
                    _ => return Err(Unsolvable::NotBuiltIn),
                })
            }
        }

        impl Deref for AnyLaw {
            type Target = dyn Law;

            fn deref(&self) -> &Self::Target {
                match *self {
                    $($(#[$built])* AnyLaw::$item(ref law) => law),+
                }
            }
        }

        impl DerefMut for AnyLaw {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match *self {
                    $($(#[$built])* AnyLaw::$item(ref mut law) => law),+
                }
            }
        }
    };
}

laws! {
    #[cfg(feature = "adaptive")]
    Adaptive: Adaptive,
    #[cfg(feature = "optimal")]
    Optimal: Optimal,
    #[cfg(feature = "robust")]
    Robust: Robust,
    #[cfg(feature = "predictive")]
    Predictive: Box<Predictive>,
}
