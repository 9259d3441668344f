//! The categories of the messages that a host receives.

/// Subject of a message; each has a name and a description in [`LOG_CATEGORIES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogCategory {
    /// A stage of the instance's life; only with debug logging on.
    Events,
    /// Something that the user should look at, though it worked.
    Warning,
    /// A value that was not taken.
    Discard,
    /// A call that failed.
    Error,
    /// A failure after which nothing works.
    Fatal,
    /// Stands for all of the others when a host chooses categories; no message has it.
    All,
}

/// Name and description of every category, in the order of [`LogCategory`]: the model
/// description's `LogCategories`.
pub const LOG_CATEGORIES: &[(&str, &str)] = &[
    ("logEvents", "Stages of the instance's life: instantiated, initialized, terminated, reset"),
    ("logStatusWarning", "Warnings; sent even with debug logging off"),
    ("logStatusDiscard", "Values that were not taken; sent even with debug logging off"),
    ("logStatusError", "Calls that failed; sent even with debug logging off"),
    ("logStatusFatal", "Failures after which the instance cannot be used; sent even with debug logging off"),
    ("logAll", "All messages"),
];

/// The categories of FMI 3.0 with their descriptions: a message's status is told beside it.
pub const LOG_CATEGORIES_OF_FMI3: &[(LogCategory, &str)] = &[
    (LogCategory::Events, "Stages of the instance's life: instantiated, initialized, terminated, reset"),
    (LogCategory::Warning, "Doubts about values that were taken; sent unless switched off"),
    (LogCategory::Discard, "Values that were not taken"),
    (LogCategory::Error, "Calls that failed; sent unless this category is switched off by its name"),
];

impl LogCategory {
    /// The name that the host sees.
    pub fn name(self) -> &'static str {
        LOG_CATEGORIES[self as usize].0
    }

    /// The category of this name.
    pub fn named(name: &str) -> Option<Self> {
        use LogCategory::*;
        [Events, Warning, Discard, Error, Fatal, All].into_iter().find(|category| category.name() == name)
    }
}
