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
    use crate::fit::fit;
    #[pymodule_export]
    use crate::fmu::pack_fmu;
    #[pymodule_export]
    use crate::output::PyOutput;
    #[pymodule_export]
    use crate::recording::PyRecording;
    #[pymodule_export]
    use crate::response::frequency_response;
    #[pymodule_export]
    use crate::simulation::{PySimulation, bound, parameter_file, parameter_values};
    #[pymodule_export]
    use crate::survey::survey;
    #[pymodule_export]
    use crate::sweep::{sweep_chunk, sweep_measures};
    #[pymodule_export]
    use crate::table::{presets, rigs, variable_rows};
    #[pymodule_export]
    use crate::tune::PyTuning;
    #[pymodule_export]
    use crate::washout::PyWashout;
}
