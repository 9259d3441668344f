//! Number of cases of the tests that search.

/// `all` if the variable `MORIS_ALL_CASES` is set, else `few`, which take seconds.
pub fn cases<T>(all: T, few: T) -> T {
    if std::env::var_os("MORIS_ALL_CASES").is_some() { all } else { few }
}
