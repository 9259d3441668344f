//! The compiled half of the Python package `moris`; the other half is in `python/moris`.
//!
//! `washout` is the class `Washout`, `output` what its step returns. `setup` reads rigs and
//! parameters, `judged` another washout's motion, `arrays` and `preview` numpy's arrays, `parallel`
//! has the threads, `variables` finds variables by name, `table` lists them. `fmu` packs an FMU.
//! `error` makes the exceptions, and `words` has the remedies in them.

mod arrays;
mod error;
mod fit;
mod fmu;
mod judged;
mod output;
mod parallel;
mod preview;
mod recording;
mod response;
mod setup;
mod simulation;
mod survey;
mod sweep;
mod table;
mod tune;
mod variables;
mod washout;
mod words;

use pyo3::prelude::*;

#[pymodule]
mod _moris {
    /// Version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// Time over which recordings are faded in by default \[s\].
    #[pymodule_export]
    const FADE_IN: f64 = moris_analysis::recording::FADE_IN;

    #[pymodule_export]
    use crate::{
        fit::fit, fmu::pack_fmu, output::PyOutput, recording::PyRecording, response::frequency_response,
        simulation::PySimulation, simulation::bound, simulation::parameter_file, simulation::parameter_values,
        survey::survey, sweep::sweep_chunk, sweep::sweep_measures, table::presets, table::rigs, table::variable_rows,
        tune::PyTuning, washout::PyWashout,
    };
}
