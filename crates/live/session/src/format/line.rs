//! Lines of text: numbers with separators, under titles or not, and pairs of keys and values.

/// A sample in text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line<'a> {
    /// Numbers in columns, and the titles above them.
    Columns {
        /// The line.
        text: &'a str,
        /// The line of titles.
        titles: Option<&'a str>,
    },
    /// Pairs like `ax=1.5`.
    Pairs(&'a str),
}

impl<'a> Line<'a> {
    /// The text.
    pub fn text(self) -> &'a str {
        match self {
            Line::Columns { text, .. } | Line::Pairs(text) => text,
        }
    }

    /// True for a line of titles: nothing in it is a number, or empty.
    pub fn is_titles(self) -> bool {
        let mut fields = fields(self.text());
        self.text().starts_with(|c: char| c.is_alphabetic() || c == '"')
            && fields.all(|field| field.is_empty() || truth(field).is_none())
    }

    /// The number in a column, from 0.
    pub fn column(self, at: usize) -> Option<f64> {
        truth(fields(self.text()).nth(at)?)
    }

    /// The number under a title, or of a key.
    pub fn value(self, name: &str) -> Option<f64> {
        match self {
            Line::Columns { titles, .. } => self.column(fields(titles?).position(|title| title == name)?),
            Line::Pairs(text) => {
                let pairs = text.split(|c: char| c.is_whitespace() || matches!(c, ';' | ',' | '&'));
                let mut pairs = pairs.filter_map(|pair| pair.split_once('='));
                truth(pairs.find(|(key, _)| *key == name)?.1)
            }
        }
    }
}

/// The fields of a line. With semicolons or tabs between them, a comma may stand in a number.
fn fields(line: &str) -> impl Iterator<Item = &str> {
    // Separators of columns, those first that stand in numbers as well.
    const SEPARATORS: [char; 3] = [';', '\t', ','];
    let separator = SEPARATORS.into_iter().find(|separator| line.contains(*separator)).unwrap_or(',');
    line.split(separator).map(|field| field.trim().trim_matches('"'))
}

/// The number of a text; one with a comma for its point, too.
fn truth(text: &str) -> Option<f64> {
    match text {
        "true" => Some(1.0),
        "false" => Some(0.0),
        _ => text.parse().ok().or_else(|| text.replacen(',', ".", 1).parse().ok()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> Line<'_> {
        Line::Columns { text, titles: None }
    }

    #[test]
    fn numbers_are_read_whatever_stands_between_them() {
        for text in ["1.5,-2,,true", " 1.5 ; -2 ;; true", "1.5\t-2\t\ttrue", "1,5;-2,0;;true", "1,5\t-2\t\ttrue"] {
            let found: Vec<_> = (0..5).map(|at| line(text).column(at)).collect();
            assert_eq!(found, [Some(1.5), Some(-2.0), None, Some(1.0), None], "{text}");
            assert!(!line(text).is_titles(), "{text}");
        }
        assert!(line("time,ax,\"ay\"").is_titles() && !line("nan,inf,1").is_titles() && !line(",,").is_titles());
    }

    #[test]
    fn titles_and_keys_name_values() {
        let under = Line::Columns { text: "1;2;3", titles: Some("time;\"ay\";ax") };
        assert_eq!(["ax", "ay", "az"].map(|name| under.value(name)), [Some(3.0), Some(2.0), None]);
        for text in ["ax=1.5\r\nay=-2\r\n", "ax=1.5 ay=-2", "ax=1.5,ay=-2", "ax=1.5&ay=-2"] {
            let pairs = Line::Pairs(text);
            assert_eq!(["ax", "ay", "x"].map(|name| pairs.value(name)), [Some(1.5), Some(-2.0), None], "{text}");
        }
    }
}
