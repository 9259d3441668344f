//! One manoeuvre, many parameter sets.
//!
//! A [`Replay`] takes a washout through a [`Manoeuvre`] and shows each output. Replays share
//! nothing that changes, so that rayon spreads parameter sets over all cores. Each here keeps a
//! sum, and the batch the least, so that the memory does not grow with the number of sets.
//!
//! ```
//! use moris_washout::{Input, ParameterError, Parameters, Washout};
//! use rayon::prelude::*;
//! use moris_batch::{Manoeuvre, Replay};
//!
//! let accelerate = Manoeuvre::sampled(0.01, 20.0, |time| {
//!     let mut input = Input::default();
//!     input.specific_force.x = (0.2 * time).min(1.0);
//!     input
//! });
//! let rms_error = |parameters: &Parameters| -> Result<f64, ParameterError> {
//!     let (mut sum, mut count) = (0.0, 0.0);
//!     Replay::new(&accelerate).run(&mut Washout::new(parameters)?, |input, output| {
//!         sum += (output.felt_specific_force.x - input.specific_force.x).powi(2);
//!         count += 1.0;
//!     });
//!     Ok(f64::sqrt(sum / count))
//! };
//! let frequencies = (1..=8).into_par_iter().map(|k| {
//!     let mut parameters = Parameters::default();
//!     parameters.splitter.omega1.x = 0.5 * f64::from(k);
//!     parameters
//! });
//! let best = frequencies
//!     .filter_map(|parameters| Some((rms_error(&parameters).ok()?, parameters)))
//!     .min_by(|a, b| a.0.total_cmp(&b.0))
//!     .expect("one set at least can be used");
//! assert!(best.0 < 0.1);
//! ```

mod manoeuvre;
mod replay;

pub use manoeuvre::Manoeuvre;
pub use replay::Replay;
