//! One manoeuvre, many parameter sets, all cores.
//!
//! [`simulations`] maps a parallel iterator of parameter sets to one of results. A simulation keeps
//! only its observer, and a batch only what the iterator's consumer keeps, so that the memory does
//! not grow with the number of sets.
//!
//! ```
//! use moris_washout::{Input, Parameters};
//! use rayon::prelude::*;
//! use moris_batch::{Fit, Manoeuvre, simulations};
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
//! let best = simulations(&accelerate, frequencies, Fit::default)
//!     .filter_map(|done| done.result.ok().map(|fit| (fit.rms_error().x, done.parameters)))
//!     .min_by(|a, b| a.0.total_cmp(&b.0))
//!     .expect("one set at least can be used");
//! assert!(best.0 < 0.1);
//! ```

mod fit;
mod manoeuvre;
mod replay;

pub use fit::Fit;
pub use manoeuvre::Manoeuvre;
pub use replay::Replay;

use std::cell::RefCell;

use moris_washout::{Input, Output, ParameterError, Parameters, Washout};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Observer of a simulation, step by step.
pub trait Observer {
    /// Receives the felt specific force before the first step and after each internal step
    /// \[m/s2\].
    fn feel(&mut self, _felt: &Vector3<f64>) {}

    /// Receives one step: the input and the output at its end.
    fn observe(&mut self, input: &Input, output: &Output);

    /// Receives the manoeuvre after the last step. What is kept for this moment is best dropped
    /// here: a batch may keep all observers.
    fn finish(&mut self, _manoeuvre: &Manoeuvre) {}
}

/// A parameter set and its result.
#[derive(Clone, Debug)]
pub struct Simulation<O> {
    /// The parameters.
    pub parameters: Parameters,
    /// The observer after the simulation, or the error of the parameters.
    pub result: Result<O, ParameterError>,
}

/// Simulates the manoeuvre once with these parameters.
///
/// # Errors
/// The parameters cannot be used: which, and why.
pub fn simulate<O: Observer>(
    manoeuvre: &Manoeuvre,
    parameters: &Parameters,
    mut observer: O,
) -> Result<O, ParameterError> {
    let mut washout = Washout::new(parameters)?;
    observer.feel(&washout.output().felt_specific_force);
    let shared = RefCell::new(observer);
    Replay::new(manoeuvre).run_prepared(
        &mut washout,
        |_, _| (),
        |felt| shared.borrow_mut().feel(felt),
        |input, output| shared.borrow_mut().observe(input, output),
    );
    let mut observer = shared.into_inner();
    observer.finish(manoeuvre);
    Ok(observer)
}

/// Simulates the manoeuvre with each parameter set on the cores of rayon's pool, each with a new
/// observer.
pub fn simulations<O, P>(
    manoeuvre: &Manoeuvre,
    sets: P,
    observer: impl Fn() -> O + Sync + Send,
) -> impl ParallelIterator<Item = Simulation<O>>
where
    O: Observer + Send,
    P: ParallelIterator<Item = Parameters>,
{
    sets.map(move |parameters| Simulation { parameters, result: simulate(manoeuvre, &parameters, observer()) })
}
