//! From the description to the text of the file.

use quick_xml::se::{SeError, Serializer};
use serde::Serialize;

use crate::ModelDescription;

const DECLARATION: &str = r#"<?xml version="1.0" encoding="UTF-8"?>"#;

/// The text of `modelDescription.xml`: UTF-8, indented, a variable a line.
///
/// Numbers are written in the shortest form that reads back as the very same number.
pub fn to_xml(description: &ModelDescription) -> String {
    let body = indented(description).expect("every part of a model description has an XML form");
    format!("{DECLARATION}\n{}\n", one_variable_a_line(&body))
}

fn indented(description: &ModelDescription) -> Result<String, SeError> {
    let mut text = String::new();
    let mut serializer = Serializer::new(&mut text);
    serializer.indent(' ', 2);
    description.serialize(serializer)?;
    Ok(text)
}

/// Joins the three lines of each `ScalarVariable`, so that a changed variable is one changed line.
fn one_variable_a_line(xml: &str) -> String {
    let mut joined = String::with_capacity(xml.len());
    let mut inside = false;
    for line in xml.lines() {
        let content = line.trim_start();
        if !joined.is_empty() && !inside {
            joined.push('\n');
        }
        joined.push_str(if inside { content } else { line });
        inside = (inside || content.starts_with("<ScalarVariable ")) && !content.starts_with("</ScalarVariable");
    }
    joined
}
