//! Sets of FMU parameters that the runs are made with.

/// A name and the parameters that differ from their start values.
#[derive(Clone, Copy, Debug)]
pub struct ParameterSet {
    /// The name in tables and figures.
    pub name: &'static str,
    /// The FMU's variables and their values, in the FMU's units.
    pub values: &'static [(&'static str, f64)],
}

/// The FMU as it is delivered.
pub const DEFAULT: ParameterSet = ParameterSet { name: "default", values: &[] };

/// For small quick motion, as in run b.
pub const WAKE: ParameterSet = ParameterSet { name: "wake", values: moris_washout::presets::WAKE };

/// As delivered, and ahead of a stop.
pub const PREACTION: ParameterSet = ParameterSet { name: "preaction", values: moris_washout::presets::PREACTION };
