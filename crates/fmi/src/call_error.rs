//! Message and severity of a call that fails.

/// Severity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// A value was rejected; the state is as before the call.
    Discard,
    /// The call was wrong; the state is as before it, unless the text says otherwise.
    Error,
}

/// Reason why a call failed: the problem, the variable and the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallError {
    pub severity: Severity,
    pub text: String,
}

impl CallError {
    /// An error about a value.
    pub fn discard(text: impl Into<String>) -> Self {
        CallError { severity: Severity::Discard, text: text.into() }
    }

    /// An error about the call.
    pub fn error(text: impl Into<String>) -> Self {
        CallError { severity: Severity::Error, text: text.into() }
    }
}
