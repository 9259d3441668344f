//! Prints of microcontrollers: values behind their names, and lines behind a monitor's clock.
//!
//! - `ax:0.1,ay:0.2` and `ax=0.1 ay=0.2`, as serial plotters read it.
//! - `12:30:00.250 -> 0.1,0.2`, as the Arduino IDE saves it. The clock is the column `clock`.

/// Mark behind the clock.
const CLOCK_MARK: &str = " -> ";

/// The text as CSV with the same lines; none where it has none of these forms.
pub fn as_csv(text: &str) -> Option<String> {
    // Lines that show the form.
    const SHOWN: usize = 5;
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    if lines.clone().take(SHOWN).all(|line| line.contains(CLOCK_MARK)) && lines.next()?.contains(':') {
        return Some(behind_clock(text));
    }
    let mut shown = text.lines().filter(|line| !line.trim().is_empty()).take(SHOWN).map(name_value_pairs);
    let first: Vec<(&str, &str)> = shown.next()??;
    let is_alike = |pairs: Option<Vec<(&str, &str)>>| {
        pairs.is_some_and(|pairs| pairs.iter().map(|pair| pair.0).eq(first.iter().map(|pair| pair.0)))
    };
    if first.len() < 2 || !shown.all(is_alike) {
        return None;
    }
    let mut csv = first.iter().map(|pair| pair.0).collect::<Vec<_>>().join(",") + "\n";
    for line in text.lines() {
        match name_value_pairs(line) {
            Some(pairs) => csv += &pairs.iter().map(|pair| pair.1).collect::<Vec<_>>().join(","),
            None => csv += line,
        }
        csv.push('\n');
    }
    Some(csv)
}

/// The lines with the clock as a column of its own, and a name for it where the names are.
fn behind_clock(text: &str) -> String {
    let mut csv = String::with_capacity(text.len());
    let mut is_named = false;
    for line in text.lines() {
        if let Some((clock, rest)) = line.split_once(CLOCK_MARK) {
            let is_header = !is_named && rest.starts_with(char::is_alphabetic) && rest.contains([',', ';', '\t', ' ']);
            is_named |= is_header;
            let mark = [',', ';', '\t'].into_iter().find(|mark| rest.contains(*mark)).unwrap_or(' ');
            csv += if is_header { "clock" } else { clock };
            csv.push(mark);
            csv += rest;
        }
        csv.push('\n');
    }
    csv
}

/// The names and values of a line.
fn name_value_pairs(line: &str) -> Option<Vec<(&str, &str)>> {
    let parts = line.split([',', ';', '\t', ' ', '|']).filter(|part| !part.is_empty());
    let pairs: Vec<(&str, &str)> = parts.map(|part| part.split_once([':', '='])).collect::<Option<_>>()?;
    let is_pair = |(name, value): &(&str, &str)| name.starts_with(char::is_alphabetic) && value.parse::<f64>().is_ok();
    (!pairs.is_empty() && pairs.iter().all(is_pair)).then_some(pairs)
}

#[cfg(test)]
mod tests {
    use super::as_csv;

    #[test]
    fn names_before_values_and_a_clock_before_lines_are_columns() {
        let labelled = ["ax:0.1,ay:-2\nax:0.2,ay:3e-1\n", "ax=0.1 ay=-2\nax=0.2 ay=3e-1\n"].map(as_csv);
        assert_eq!(labelled, ["ax,ay\n0.1,-2\n0.2,3e-1\n"; 2].map(|csv| Some(csv.to_owned())));
        let monitor = as_csv("12:30:00.1 -> ax,ay\n12:30:00.2 -> 1,2\n12:30:00.3 -> 3,4\n");
        assert_eq!(monitor.as_deref(), Some("clock,ax,ay\n12:30:00.2,1,2\n12:30:00.3,3,4\n"));
        assert_eq!(as_csv("time,ax\n12:30:00,1\n12:30:01,1\n"), None);
    }
}
