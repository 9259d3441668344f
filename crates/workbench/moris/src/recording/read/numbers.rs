//! The numbers of a text file's fields.

use crate::recording::message::{given, quoted};

/// Above all that is measured, in any unit: times in ns since 1970 are below 1e19.
const LARGEST: f64 = 1e30;

/// Parses numbers that all have the same decimal mark.
#[derive(Default)]
pub struct Numbers {
    mark: Option<char>,
}

impl Numbers {
    /// A field's number.
    ///
    /// # Errors
    /// The reason why it is none.
    pub fn parse(&mut self, field: Option<&str>) -> Result<f64, String> {
        let text = field.ok_or("is missing: the line has too few fields")?.trim();
        let mark = text.chars().find(|c| [',', '.'].contains(c));
        let number = if mark == Some(',') { text.replacen(',', ".", 1).parse::<f64>() } else { text.parse::<f64>() };
        if let (Some(mark), Ok(_)) = (mark, &number)
            && *self.mark.get_or_insert(mark) != mark
        {
            return Err(format!(
                "is {}, but numbers before it have a decimal {}; write all with the same",
                quoted(text),
                if mark == ',' { "point" } else { "comma" }
            ));
        }
        match number {
            Ok(number) if number.abs() <= LARGEST => Ok(number),
            Ok(number) if !number.is_nan() => {
                Err(format!("is {}, which no sensor measures; cut this part off", quoted(text)))
            }
            Ok(_) => Err(format!("is {}; {}", quoted(text), remedy())),
            Err(_) if text.is_empty() => Err(format!("is empty; {}", remedy())),
            Err(_) => Err(format!("is \"{}\", which is not a number", quoted(text))),
        }
    }
}

/// The remedy for a gap.
fn remedy() -> String {
    format!("cut this part off, fill the gap with plausible values, or use {}", given("empty-fields", "interpolate"))
}

/// True for a field that holds nothing: empty, or NaN.
pub fn is_empty(field: Option<&str>) -> bool {
    field.is_none_or(|field| field.trim().is_empty() || field.trim().eq_ignore_ascii_case("nan"))
}

/// True for a number, with a decimal point or comma.
pub fn is_number(field: &str) -> bool {
    field.trim().replace(',', ".").parse::<f64>().is_ok()
}
