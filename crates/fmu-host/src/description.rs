//! The parts of modelDescription.xml that a host needs.

use std::collections::HashMap;

use moris_interface::{Identity, Kind};

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::HostError;

/// Type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    Real,
    Integer,
    Boolean,
    /// Got and set as an integer.
    Enumeration,
    String,
}

/// A variable of an FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variable {
    /// The number by which the FMU knows it.
    pub value_reference: u32,
    pub kind: VariableKind,
}

/// The parts of modelDescription.xml that a host needs.
#[derive(Debug, Default)]
pub(crate) struct Description {
    /// Of FMI 3.0, the instantiation token.
    pub guid: String,
    pub is_fmi3: bool,
    pub model_identifier: String,
    pub variables: HashMap<String, Variable>,
}

impl Description {
    /// Reads the file's contents.
    pub fn parse(xml: &str) -> Result<Self, HostError> {
        let mut description = Description::default();
        let mut reader = Reader::from_str(xml);
        // The variable whose type is the next element.
        let mut variable = None;
        loop {
            let event = reader.read_event().map_err(|error| HostError::Description(error.to_string()))?;
            let (Event::Start(element) | Event::Empty(element)) = event else {
                if event == Event::Eof { break } else { continue }
            };
            match element.name().as_ref() {
                b"fmiModelDescription" => {
                    description.is_fmi3 = attribute(&element, "fmiVersion")?.starts_with("3.");
                    let name = if description.is_fmi3 { "instantiationToken" } else { "guid" };
                    description.guid = attribute(&element, name)?;
                }
                b"CoSimulation" => description.model_identifier = attribute(&element, "modelIdentifier")?,
                b"ScalarVariable" => variable = Some((attribute(&element, "name")?, value_reference(&element)?)),
                name if description.is_fmi3 => {
                    let Some(kind) = kind3(name) else { continue };
                    let value_reference = value_reference(&element)?;
                    description.variables.insert(attribute(&element, "name")?, Variable { value_reference, kind });
                }
                name => {
                    let Some(kind) = kind(name) else { continue };
                    let Some((name, value_reference)) = variable.take() else { continue };
                    description.variables.insert(name, Variable { value_reference, kind });
                }
            }
        }
        if description.model_identifier.is_empty() {
            return Err(HostError::Description("it is not for co-simulation".into()));
        }
        Ok(description)
    }
}

fn kind(element_name: &[u8]) -> Option<VariableKind> {
    match element_name {
        b"Real" => Some(VariableKind::Real),
        b"Integer" => Some(VariableKind::Integer),
        b"Boolean" => Some(VariableKind::Boolean),
        b"Enumeration" => Some(VariableKind::Enumeration),
        b"String" => Some(VariableKind::String),
        _ => None,
    }
}

/// Of the types of FMI 3.0, those that a host of numbers needs.
fn kind3(element_name: &[u8]) -> Option<VariableKind> {
    match element_name {
        b"Float64" => Some(VariableKind::Real),
        b"Int32" => Some(VariableKind::Integer),
        name => kind(name).filter(|kind| matches!(kind, VariableKind::Boolean | VariableKind::Enumeration)),
    }
}

fn value_reference(element: &BytesStart) -> Result<u32, HostError> {
    let text = attribute(element, "valueReference")?;
    text.parse().map_err(|error| HostError::Description(format!("value reference '{text}': {error}")))
}

fn attribute(element: &BytesStart, name: &str) -> Result<String, HostError> {
    let describe = |error: &dyn std::fmt::Display| HostError::Description(error.to_string());
    let found = element.try_get_attribute(name).map_err(|error| describe(&error))?;
    let found = found.ok_or_else(|| describe(&format!("an element has no attribute '{name}'")))?;
    Ok(found.unescape_value().map_err(|error| describe(&error))?.into_owned())
}

/// The variables of a model's library by name, for a library without a description.
pub fn variables_of(identity: &Identity) -> HashMap<String, Variable> {
    let variable = |slot: usize| {
        let kind = match identity.row(slot).kind {
            Kind::Real(_) => VariableKind::Real,
            Kind::Integer => VariableKind::Integer,
            Kind::Boolean => VariableKind::Boolean,
            Kind::Enumeration(_) => VariableKind::Enumeration,
        };
        (identity.variable_name(slot), Variable { value_reference: slot as u32, kind })
    };
    (0..identity.slots.len()).map(variable).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_a_host_needs() {
        let xml = r#"<?xml version="1.0" encoding="UTF-8"?>
            <fmiModelDescription fmiVersion="2.0" modelName="A &amp; B" guid="{1}">
              <CoSimulation modelIdentifier="AB"/>
              <TypeDefinitions><SimpleType name="T"><Enumeration><Item name="a" value="1"/></Enumeration></SimpleType></TypeDefinitions>
              <ModelVariables>
                <ScalarVariable name="leg[1].&lt;x&gt;" valueReference="7" causality="output"><Real unit="m"/></ScalarVariable>
                <ScalarVariable name="choice" valueReference="8"><Enumeration declaredType="T" start="1"/></ScalarVariable>
              </ModelVariables>
            </fmiModelDescription>"#;
        let description = Description::parse(xml).unwrap();
        assert_eq!((description.guid.as_str(), description.model_identifier.as_str()), ("{1}", "AB"));
        assert_eq!(description.variables.len(), 2);
        let leg = Variable { value_reference: 7, kind: VariableKind::Real };
        assert_eq!(description.variables["leg[1].<x>"], leg);
        let choice = Variable { value_reference: 8, kind: VariableKind::Enumeration };
        assert_eq!(description.variables["choice"], choice);
    }

    #[test]
    fn refuses_what_is_no_co_simulation_fmu() {
        let model_exchange =
            r#"<fmiModelDescription guid="1"><ModelExchange modelIdentifier="A"/></fmiModelDescription>"#;
        for xml in [model_exchange, "", "<fmiModelDescription/>", "<fmiModelDescription guid='1'><a></b>"] {
            assert!(matches!(Description::parse(xml), Err(HostError::Description(_))), "{xml}");
        }
    }
}
