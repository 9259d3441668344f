//! The numbers of a text file's fields.

use crate::message::Message;
use crate::recording::message::quoted;
use crate::texts::text;

/// Parses numbers that all have the same decimal mark, and the same sign between thousands.
#[derive(Default)]
pub struct Numbers {
    mark: Option<char>,
    /// Comma or point between thousands.
    group: Option<char>,
}

impl Numbers {
    /// The way in which the fields of some columns are written.
    ///
    /// A comma or point separates thousands where a number has both, or several, or where each is
    /// before three digits among whole numbers below 1000. One that is not before three digits
    /// shows that it is the decimal mark.
    pub fn of<'a>(columns: impl Iterator<Item = impl Iterator<Item = &'a str>>) -> Self {
        // By mark: it separates thousands for certain, perhaps, or not at all.
        let (mut certain, mut likely, mut decimal) = ([false; 2], [false; 2], [false; 2]);
        for column in columns {
            let (mut grouped, mut has_small, mut has_large) = ([false; 2], false, false);
            for field in column {
                let digits = field.trim().trim_start_matches(['-', '+', '−']);
                let counts = NUMBER_MARKS.map(|mark| digits.matches(mark).count());
                if counts == [0, 0] {
                    has_small |= !digits.is_empty() && digits.len() <= 3 && digits.bytes().all(|b| b.is_ascii_digit());
                    has_large |= digits.len() > 3 && digits.bytes().all(|b| b.is_ascii_digit());
                }
                for (k, mark) in NUMBER_MARKS.into_iter().enumerate().filter(|(k, _)| counts[*k] > 0) {
                    let is_first = counts[1 - k] > 0 && digits.find(mark) < digits.find(NUMBER_MARKS[1 - k]);
                    let whole =
                        if is_first { &digits[..digits.find(NUMBER_MARKS[1 - k]).unwrap_or(0)] } else { digits };
                    match is_grouped(whole, mark) {
                        true if is_first || counts[k] > 1 => certain[k] = true,
                        true => grouped[k] = true,
                        false => decimal[k] = true,
                    }
                }
            }
            (0..2).for_each(|k| likely[k] |= grouped[k] && has_small && !has_large);
        }
        let group = (0..2).find(|&k| (certain[k] || likely[k]) && !decimal[k]).map(|k| NUMBER_MARKS[k]);
        Numbers { mark: None, group }
    }

    /// A field's number.
    ///
    /// # Errors
    /// The reason why it is none.
    pub fn parse(&mut self, field: Option<&str>) -> Result<f64, Message> {
        // Above all that is measured, in any unit: times in ns since 1970 are below 1e19.
        const LARGEST: f64 = 1e30;
        let text = field.ok_or("is missing: the line has too few fields")?.trim();
        // Nearly all numbers are plain.
        let plain = text.parse::<f64>().ok().filter(|_| self.group.is_none() && self.mark != Some(','));
        let cleaned;
        let (number, mark) = match plain {
            Some(number) => (Ok(number), text.contains('.').then_some('.')),
            None => {
                cleaned = self.cleaned(text);
                let mark = cleaned.chars().find(|c| NUMBER_MARKS.contains(c));
                let plain = cleaned.replacen(',', ".", 1);
                // Fortran's double precision.
                (plain.parse::<f64>().or_else(|_| plain.replacen(['D', 'd'], "E", 1).parse()), mark)
            }
        };
        if let (Some(mark), Ok(_)) = (mark, &number)
            && *self.mark.get_or_insert(mark) != mark
        {
            let other = if mark == ',' { "point" } else { "comma" };
            return Err(text!["other-decimal-mark", text = quoted(text), other]);
        }
        match number {
            Ok(number) if number.abs() <= LARGEST => Ok(number),
            Ok(number) if !number.is_nan() => Err(text!["measured-by-none", text = quoted(text)]),
            Ok(_) => Err(text!["gap", value = quoted(text)]),
            _ if text.is_empty() => Err(text!["gap", value = "empty"]),
            _ if is_empty(Some(text)) => Err(text!["gap", value = text!["no-value", text = quoted(text)]]),
            _ => Err(text!["not-a-number", text = quoted(text)]),
        }
    }

    /// The text with a plain minus, and without signs between thousands.
    fn cleaned(&self, text: &str) -> String {
        let is_apart = |c: char| matches!(c, '\'' | '’' | '_' | ' ' | '\u{a0}' | '\u{2009}' | '\u{202f}');
        let groups = text.split(is_apart).skip(1);
        let is_grouped = groups.clone().count() > 0
            && groups.clone().all(|part| part.bytes().take_while(u8::is_ascii_digit).count() == 3);
        let keeps = |c: &char| Some(*c) != self.group && !(is_grouped && is_apart(*c));
        text.chars().filter(keeps).map(|c| if c == '−' { '-' } else { c }).collect()
    }
}

/// Marks of decimals or between thousands.
const NUMBER_MARKS: [char; 2] = [',', '.'];

/// True for digits in groups of three behind the first one to three, which are no zero.
fn is_grouped(text: &str, mark: char) -> bool {
    let all_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let mut parts = text.split(mark);
    let first = parts.next().unwrap_or_default();
    (1..=3).contains(&first.len())
        && !first.starts_with('0')
        && all_digits(first)
        && parts.all(|part| part.len() == 3 && all_digits(part))
}

/// True for a field that holds nothing: empty, a word for a missing value, or signs such as - or ?.
pub fn is_empty(field: Option<&str>) -> bool {
    // Words for a value that is missing, in lower case; an empty field is missing, too.
    const MISSING: &str = "na n/a n.a. #n/a #na <na> nan -nan +nan nan(ind) -nan(ind) 1.#ind -1.#ind 1.#qnan -1.#qnan \
        1.#nan nat null (null) <null> #null! \\n none nil missing invalid unavailable #value! \
        #div/0! #num!";
    field.is_none_or(|field| {
        let field = field.trim();
        MISSING.split_whitespace().any(|word| field.eq_ignore_ascii_case(word))
            || field.chars().all(|c| "-–—?*.".contains(c))
    })
}

/// True for a number, with a decimal point or comma.
pub fn is_number(field: impl AsRef<str>) -> bool {
    field.as_ref().trim().replace(',', ".").parse::<f64>().is_ok()
}
