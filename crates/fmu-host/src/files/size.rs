//! Sizes in words.

/// A size with a unit of at most three digits before the point.
pub fn shown(bytes: u64) -> String {
    const UNITS: [&str; 7] = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let mut unit = 0;
    let mut size = bytes as f64;
    while size >= 1000.0 && unit + 1 < UNITS.len() {
        size /= 1000.0;
        unit += 1;
    }
    let digits = usize::from(unit > 0 && size < 100.0);
    let text = format!("{size:.digits$}");
    format!("{} {}", text.strip_suffix(".0").unwrap_or(&text), UNITS[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_few_digits() {
        let sizes = [0, 999, 1000, 16_000_000, 4_700_000, 999_400_000, 4_200_000_000, u64::MAX];
        let texts = ["0 bytes", "999 bytes", "1 kB", "16 MB", "4.7 MB", "999 MB", "4.2 GB", "18.4 EB"];
        assert_eq!(sizes.map(shown), texts);
    }
}
