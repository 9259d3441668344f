//! From the description to the text of the file.

use quick_xml::se::{SeError, Serializer};
use serde::Serialize;

/// Indentation of a variable, in spaces.
const VARIABLE_DEPTH: usize = 4;

const DECLARATION: &str = r#"<?xml version="1.0" encoding="UTF-8"?>"#;

/// The text of a description of either version as `modelDescription.xml` has it: UTF-8,
/// indented, a variable a line.
///
/// Numbers are written in the shortest form that reads back as the very same number.
pub fn to_xml(description: &impl Serialize) -> String {
    let body = indented(description).expect("every part of a model description has an XML form");
    format!("{DECLARATION}\n{}\n", one_variable_a_line(&body))
}

fn indented(description: &impl Serialize) -> Result<String, SeError> {
    let mut text = String::new();
    let mut serializer = Serializer::new(&mut text);
    serializer.indent(' ', 2);
    description.serialize(serializer)?;
    Ok(text)
}

/// Joins the lines of each variable, so that a changed variable is one changed line.
fn one_variable_a_line(xml: &str) -> String {
    let mut joined = String::with_capacity(xml.len());
    let mut among_variables = false;
    for line in xml.lines() {
        let (content, depth) = (line.trim_start(), line.len() - line.trim_start().len());
        // What is inside a variable, or ends one.
        let goes_on =
            among_variables && (depth > VARIABLE_DEPTH || depth == VARIABLE_DEPTH && content.starts_with("</"));
        if !joined.is_empty() && !goes_on {
            joined.push('\n');
        }
        joined.push_str(if goes_on { content } else { line });
        among_variables = (among_variables || content == "<ModelVariables>") && content != "</ModelVariables>";
    }
    joined
}
