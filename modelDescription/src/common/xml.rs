//! From the description to the text of the file.

use quick_xml::se::{SeError, Serializer};
use serde::Serialize;
use serde::ser::SerializeMap;

/// An element of an XML file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element {
    pub name: &'static str,
    /// In the order of the file, as are the children.
    pub attributes: Vec<(&'static str, String)>,
    pub children: Vec<Element>,
}

impl Element {
    /// An empty element.
    pub const fn new(name: &'static str) -> Self {
        Element { name, attributes: Vec::new(), children: Vec::new() }
    }

    /// An element with these children; none without any, since the schemas know no empty lists.
    pub fn list(name: &'static str, children: Vec<Element>) -> Option<Self> {
        (!children.is_empty()).then_some(Element { name, attributes: Vec::new(), children })
    }

    /// Adds an attribute.
    #[must_use]
    pub fn with(self, attribute: &'static str, value: impl ToString) -> Self {
        self.with_some(attribute, Some(value))
    }

    /// Adds an attribute if it has a value.
    #[must_use]
    pub fn with_some(mut self, attribute: &'static str, value: Option<impl ToString>) -> Self {
        self.attributes.extend(value.map(|value| (attribute, value.to_string())));
        self
    }

    /// Adds an attribute unless its text is empty.
    #[must_use]
    pub fn with_text(self, attribute: &'static str, text: &str) -> Self {
        self.with_some(attribute, (!text.is_empty()).then_some(text))
    }

    /// Adds children after those that are there.
    #[must_use]
    pub fn containing(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.children.extend(children);
        self
    }
}

impl Serialize for Element {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_map(None)?;
        for (name, value) in &self.attributes {
            fields.serialize_entry(&format!("@{name}"), value)?;
        }
        for child in &self.children {
            fields.serialize_entry(child.name, child)?;
        }
        fields.end()
    }
}

/// The text of a file, such as a description of either version as `modelDescription.xml` has it:
/// UTF-8, indented, a variable a line.
///
/// Numbers are written in the shortest form that reads back as the very same number.
pub fn to_xml(description: &Element) -> String {
    const XML_DECLARATION: &str = r#"<?xml version="1.0" encoding="UTF-8"?>"#;
    let body = indented_xml(description).expect("every part of a model description has an XML form");
    format!("{XML_DECLARATION}\n{}\n", one_variable_a_line(&body))
}

fn indented_xml(description: &Element) -> Result<String, SeError> {
    let mut text = String::new();
    let mut serializer = Serializer::with_root(&mut text, Some(description.name))?;
    serializer.indent(' ', 2);
    description.serialize(serializer)?;
    Ok(text)
}

/// Joins the lines of each variable, so that a changed variable is one changed line.
fn one_variable_a_line(xml: &str) -> String {
    // Indentation of a variable, in spaces.
    const VARIABLE_DEPTH: usize = 4;
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
