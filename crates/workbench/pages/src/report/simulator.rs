//! Data with which a page can simulate its recording again, with other parameters.

use serde::Serialize;

use crate::report::encode::{bytes, exact};

/// The WebAssembly of the report's page, `modules/simulation.rs`; empty where it was not compiled.
pub const SIMULATION_MODULE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/page_simulation.wasm"));

/// Remedy where [`SIMULATION_MODULE`] was not compiled.
pub const MODULE_REMEDY: &str = "Sliders for the parameters need Rust's target for WebAssembly, which was missing when the \
     workbench was compiled. Run `rustup target add wasm32-unknown-unknown`, then compile the workbench again.";

/// The simulation as WebAssembly, the recording's inputs, and the parameters to choose from.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Simulator {
    /// The WebAssembly of the package's `modules/simulation.rs`.
    #[serde(serialize_with = "bytes")]
    pub module: Vec<u8>,
    /// Time between samples \[s\].
    pub step: f64,
    /// The recording's samples; the inputs may be those of its beginning only.
    pub samples: usize,
    /// Slot by slot of the washout's inputs, a value for each sample.
    #[serde(serialize_with = "exact")]
    pub inputs: Vec<Vec<f64>>,
    /// Least RMS error of the specific force on each axis with the first run's limits \[m/s2\].
    pub bounds: [Option<f64>; 3],
    /// Slot by slot of the washout's parameters.
    pub parameters: Vec<Parameter>,
    /// Heading of a saved parameter file, without the marks of a comment.
    pub heading: String,
    /// The command that simulates with the saved file, and the file's name at its end.
    pub command: String,
    /// Name of the saved file.
    pub file: String,
    /// Name of the rig.
    pub rig_name: String,
    /// Diameter of its legs, where it is known \[m\].
    pub actuator_diameter: Option<f64>,
}

/// A parameter to choose.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Parameter {
    pub name: String,
    /// Description, a sentence.
    pub text: String,
    /// Empty for pure numbers.
    pub unit: String,
    pub kind: ParameterKind,
    /// Names of an enumeration's items, of which the first has the value 1.
    pub items: Vec<String>,
    /// Values that are accepted.
    pub accepted: [f64; 2],
    /// Values of the slider.
    pub slider: [f64; 2],
    /// Heading below which it stands; none for one that only a search shows.
    pub group: Option<String>,
    /// Names of other parameters, each with its items or numbers that give this one an effect.
    pub used_if: Vec<(String, Vec<&'static str>)>,
    /// False for what belongs to the rig or the recording.
    pub is_free: bool,
    /// The first run's value.
    pub start: f64,
    /// The value of the rig with default parameters, which a parameter file omits.
    pub base: f64,
}

/// Type of a parameter's values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ParameterKind {
    #[default]
    Real,
    Integer,
    Boolean,
    Enumeration,
}
