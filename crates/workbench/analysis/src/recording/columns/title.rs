//! The title of a column, taken apart.

use super::units::any_spelled;

/// The name of a column, and the unit in brackets behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Title {
    /// The name of the file, where there are several.
    pub file: Option<String>,
    pub full: String,
    pub name: String,
    pub unit: Option<String>,
    /// Behind the name without a bracket, in case it is a unit: the last part of `gyro_x_deg_s`.
    pub endings: Vec<String>,
}

/// Likeness of a title and a name that is looked for, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Likeness {
    /// The name is the whole title.
    Whole,
    /// The name is the part before the brackets.
    BeforeUnit,
    /// The name is one of them in another case.
    OtherCase,
}

impl Title {
    /// Takes `ax [m/s2]`, `ax {m/s2}`, `ax/(m/s2)`, `ax,m/s2`, `ax:m/s2` and `ax in m/s2` apart. Of
    /// several brackets, the first with a known unit counts, otherwise the last. The mark of a
    /// comment before the name is no part of it.
    pub fn new(full: &str) -> Self {
        // Brackets around units.
        const OPENING: [char; 4] = ['[', '(', '{', '<'];
        let full = full.trim();
        let begin = full.chars().next().map_or(0, char::len_utf8);
        // Braces may be part of a name, as in `A_{Xpilot}`.
        let opens = |&(place, _): &(usize, &str)| {
            let (inner, behind) =
                full[place + 1..].split_once([']', ')', '}', '>']).unwrap_or((&full[place + 1..], ""));
            // An index before a unit is part of the name.
            let is_index = inner.parse::<usize>().is_ok() && behind.contains(OPENING);
            place >= begin && !is_index && (full[place..].starts_with(['[', '(']) || any_spelled(inner).is_some())
        };
        let end = full.match_indices(OPENING).find(opens).map_or(full.len(), |(place, _)| place);
        let behind = &full[end..];
        let before = full[..end].trim();
        // What stands behind a mark counts where it is a unit; a comma ends a name in any case.
        let marked = [",", " in ", ":", "/"].into_iter().find_map(|mark| {
            let (name, unit) = before.split_once(mark)?;
            (mark == "," || any_spelled(unit).is_some()).then_some((name, Some(unit.trim())))
        });
        let (name, after_mark) = marked.unwrap_or((before, None));
        let name = if behind.is_empty() { name } else { name.trim_end_matches('/').trim_end() };
        let bare = name.trim_start_matches(['#', '%']).trim();
        let name = if bare.is_empty() { name } else { bare };
        let brackets: Vec<&str> = behind
            .split(OPENING)
            .skip(1)
            .filter_map(|part| Some(part[..part.find([']', ')', '}', '>'])?].trim()))
            // A number or an axis in brackets is an index.
            .filter(|unit| !unit.is_empty() && unit.parse::<usize>().is_err())
            .filter(|unit| !["-", "x", "y", "z"].contains(&unit.to_lowercase().as_str()))
            .collect();
        let unit = brackets.iter().find(|unit| any_spelled(unit).is_some()).or(brackets.last()).copied();
        let unit = unit.or(after_mark.filter(|unit| any_spelled(unit).is_some())).map(str::to_owned);
        Title { file: None, full: full.to_owned(), name: name.to_owned(), unit, endings: name_endings(name) }
    }

    /// The title with its file's name before it, where there are several files.
    pub fn qualified(&self, title: &str) -> String {
        self.file.as_ref().map_or_else(|| title.to_owned(), |file| format!("{file}.{title}"))
    }

    /// The likeness with a name, which may have the file's name before it; none if it is another
    /// column's.
    pub fn likeness(&self, name: &str) -> Option<Likeness> {
        let whole = [self.full.clone(), self.qualified(&self.full)];
        let short = [self.name.clone(), self.qualified(&self.name)];
        let in_other_case = |title: &String| title.to_lowercase() == name.to_lowercase();
        if whole.iter().any(|title| title == name) {
            Some(Likeness::Whole)
        } else if short.iter().any(|title| title == name) {
            Some(Likeness::BeforeUnit)
        } else {
            whole.iter().chain(&short).any(in_other_case).then_some(Likeness::OtherCase)
        }
    }
}

/// The last parts of a name: `ms` of `time_ms` and `timeMS`, `deg/s` and `s` of `gyro_x_deg_s`.
fn name_endings(name: &str) -> Vec<String> {
    let is_mark = |c: char| "_ .".contains(c);
    let parts: Vec<&str> = name.split(is_mark).filter(|part| !part.is_empty()).collect();
    let last = |count: usize| (parts.len() > count).then(|| parts[parts.len() - count..].join("/"));
    // A unit of time behind a small letter.
    let (begin, end) = name.split_at_checked(name.len().saturating_sub(2)).unwrap_or((name, ""));
    let is_joined = begin.ends_with(char::is_lowercase) && ["MS", "US", "NS", "Ms", "Us", "Ns"].contains(&end);
    let joined = is_joined.then(|| end.to_owned());
    [last(3).map(|text| text.replace("/per/", "/")), last(2), last(1), joined].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_is_a_name_and_a_unit() {
        for title in ["ax [g]", "ax (g)", "ax {g}", "ax <g>", "ax/g", "ax/(g)", "ax:g", "ax in g", "ax,g", "# ax [g]"] {
            let Title { name, unit, .. } = Title::new(title);
            assert_eq!((name.as_str(), unit.as_deref()), ("ax", Some("g")), "{title}");
        }
        for (title, name, unit) in [
            ("(x) [g]", "(x)", Some("g")),
            ("G(x)", "G", None),
            ("A_{Xpilot} (ft/s^2)", "A_{Xpilot}", Some("ft/s^2")),
            ("acc/x", "acc/x", None),
            ("imu.a_rel[1] [m/s2]", "imu.a_rel[1]", Some("m/s2")),
            ("Accelerometer (z) [m/s²]", "Accelerometer", Some("m/s²")),
            ("[s]", "[s]", None),
        ] {
            let found = Title::new(title);
            assert_eq!((found.name.as_str(), found.unit.as_deref()), (name, unit), "{title}");
        }
    }

    #[test]
    fn a_name_may_end_with_a_unit() {
        assert_eq!(name_endings("gyro_x_deg_s"), ["x/deg/s", "deg/s", "s"]);
        assert_eq!(name_endings("TimestampMS"), ["MS"]);
        assert_eq!(name_endings("SPEED_KPH"), ["KPH"]);
        assert!(name_endings("time").is_empty() && name_endings("ALARMS").is_empty());
    }
}
