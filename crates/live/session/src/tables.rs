//! Helpers for the tables of telemetry and of frames.

/// The tables of these names, each with its text.
macro_rules! shipped_tables {
    ($($name:literal)+) => { &[ $( ($name, include_str!(concat!("tables/", $name, ".toml"))) ),+ ] };
}
pub(crate) use shipped_tables;

/// The text of a shipped table.
pub fn shipped(tables: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    tables.iter().find(|(of, _)| *of == name).map(|(_, text)| *text)
}

/// Refuses a table by the first of its conditions that does not hold.
pub(crate) fn check<E>(conditions: &[(bool, &'static str)], refuse: impl Fn(&'static str) -> E) -> Result<(), E> {
    conditions.iter().find(|(holds, _)| !holds).map_or(Ok(()), |(_, reason)| Err(refuse(reason)))
}
