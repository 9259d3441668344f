//! Message and severity of a call that fails.

/// Severity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// A value was not taken; everything is as before the call.
    Discard,
    /// The call was wrong; everything is as before it, unless the text says otherwise.
    Error,
}

/// Why a call did not do what was asked: what, which variable, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallError {
    pub severity: Severity,
    pub text: String,
}

impl CallError {
    /// A error about a value.
    pub fn discard(text: impl Into<String>) -> Self {
        CallError { severity: Severity::Discard, text: text.into() }
    }

    /// A error about the call.
    pub fn error(text: impl Into<String>) -> Self {
        CallError { severity: Severity::Error, text: text.into() }
    }
}
