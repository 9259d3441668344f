//! Number of cases of the tests that search.

/// `all` if the variable `MORIS_ALL_CASES` is set, else `few`, which take seconds.
pub fn cases<T>(all: T, few: T) -> T {
    if std::env::var_os("MORIS_ALL_CASES").is_some() { all } else { few }
}

/// As [`cases`] for a search at random, which takes `all` so many times as the variable says.
#[allow(dead_code)]
pub fn searches(all: usize, few: usize) -> usize {
    let times = std::env::var("MORIS_ALL_CASES").map(|times| times.parse().unwrap_or(1));
    times.map_or(few, |times: usize| times * all)
}
