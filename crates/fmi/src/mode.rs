//! The state of an instance in the calling sequence.

use serde::{Deserialize, Serialize};

/// The states of the calling sequences (FMI 2.0: 4.2.4; FMI 3.0: 2.3 and 4.2) that
/// an instance can be in.
///
/// An instance computes within the call and never rejects a valid step. So it is never in the
/// states "step failed", "step in progress" or "step canceled".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    Instantiated,
    Initialization,
    StepComplete,
    Terminated,
    /// After a panic of the model.
    Error,
}

impl Mode {
    /// All modes.
    pub const ALL: [Mode; 5] =
        [Mode::Instantiated, Mode::Initialization, Mode::StepComplete, Mode::Terminated, Mode::Error];

    /// The standard's name of the mode.
    pub fn name(self) -> &'static str {
        match self {
            Mode::Instantiated => "instantiated",
            Mode::Initialization => "initialization mode",
            Mode::StepComplete => "step complete",
            Mode::Terminated => "terminated",
            Mode::Error => "error",
        }
    }
}

/// A set of modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Modes(u8);

impl Modes {
    /// No mode.
    pub const NONE: Modes = Modes(0);

    /// The set of these modes.
    pub const fn of(modes: &[Mode]) -> Self {
        let mut bits = 0;
        let mut m = 0;
        while m < modes.len() {
            bits |= 1 << modes[m] as u8;
            m += 1;
        }
        Modes(bits)
    }

    /// True if `mode` is one of them.
    #[inline]
    pub const fn contains(self, mode: Mode) -> bool {
        self.0 & (1 << mode as u8) != 0
    }

    /// The modes' names, for a message.
    pub fn names(self) -> String {
        let names: Vec<_> = Mode::ALL.into_iter().filter(|&mode| self.contains(mode)).map(Mode::name).collect();
        if names.is_empty() { "none".into() } else { names.join(", ") }
    }
}
