//! One manoeuvre, many parameter sets, all cores.
//!
//! [`rides`] makes a parallel iterator of parameter sets into one of what came of each. Nothing is kept of a ride but
//! what its observer keeps, and nothing of a batch but what the iterator's consumer keeps: a sweep of 100,000 sets needs
//! no more memory than one of ten.
//!
//! ```
//! use moris_washout::{Input, Parameters};
//! use rayon::prelude::*;
//! use moris_batch::{Fit, Manoeuvre, rides};
//!
//! let accelerate = Manoeuvre::sampled(0.01, 20.0, |time| {
//!     let mut input = Input::default();
//!     input.specific_force.x = (0.2 * time).min(1.0);
//!     input
//! });
//! let frequencies = (1..=8).into_par_iter().map(|k| {
//!     let mut parameters = Parameters::default();
//!     parameters.splitter.omega1.x = 0.5 * f64::from(k);
//!     parameters
//! });
//! let best = rides(&accelerate, frequencies, Fit::default)
//!     .filter_map(|ride| ride.result.ok().map(|fit| (fit.rms_error().x, ride.parameters)))
//!     .min_by(|a, b| a.0.total_cmp(&b.0))
//!     .expect("one set at least can be used");
//! assert!(best.0 < 0.1);
//! ```

mod fit;
mod manoeuvre;

pub use fit::Fit;
pub use manoeuvre::Manoeuvre;

use moris_washout::{Input, Output, Parameters, Refusal, Washout};
use rayon::prelude::*;

/// Watches a ride step by step and keeps what matters of it.
pub trait Observer {
    /// Sees one step: the input at its end, and the output there.
    fn observe(&mut self, input: &Input, output: &Output);
}

/// A parameter set and what came of it.
#[derive(Clone, Debug)]
pub struct Ride<O> {
    /// The parameters ridden with.
    pub parameters: Parameters,
    /// The observer after the ride, or why the parameters cannot be used.
    pub result: Result<O, Refusal>,
}

/// Rides the manoeuvre once with these parameters.
///
/// # Errors
/// The parameters cannot be used: which, and why.
pub fn ride<O: Observer>(manoeuvre: &Manoeuvre, parameters: &Parameters, mut observer: O) -> Result<O, Refusal> {
    let mut washout = Washout::new(parameters)?;
    for pair in manoeuvre.inputs().windows(2) {
        washout.step_between(&pair[0], &pair[1], manoeuvre.step());
        observer.observe(&pair[1], &washout.output());
    }
    Ok(observer)
}

/// Rides the manoeuvre with each of the parameter sets, on as many cores as rayon's pool has, each with a fresh observer.
pub fn rides<O, P>(
    manoeuvre: &Manoeuvre,
    sets: P,
    observer: impl Fn() -> O + Sync + Send,
) -> impl ParallelIterator<Item = Ride<O>>
where
    O: Observer + Send,
    P: ParallelIterator<Item = Parameters>,
{
    sets.map(move |parameters| Ride { parameters, result: ride(manoeuvre, &parameters, observer()) })
}
