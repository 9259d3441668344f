//! The categories of the messages that a host of FMI 3.0 receives.

use crate::LogCategory;

/// Every category with its description: the model description's `LogCategories`.
pub const LOG_CATEGORIES: &[(LogCategory, &str)] = &[
    (LogCategory::Events, "Stages of the instance's life: instantiated, initialized, terminated, reset"),
    (LogCategory::Discard, "Values that were not taken"),
    (LogCategory::Error, "Calls that failed; sent unless this category is switched off by its name"),
];
