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

/// Role of a variable, as a host sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    Input,
    Output,
    Parameter,
    /// Local, calculated or independent.
    Other,
}

/// The declaration of a variable, for hosts whose users name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declaration {
    pub causality: Causality,
    /// The unit, or that of the variable's type.
    pub unit: Option<String>,
    /// The element that declares it, such as Real or Float64.
    pub element: String,
    /// Sizes of an array of FMI 3.0; of a size that a parameter sets, none. Empty for a single
    /// number.
    pub dimensions: Vec<Option<usize>>,
}

impl Declaration {
    /// True for an array of FMI 3.0.
    pub fn is_array(&self) -> bool {
        !self.dimensions.is_empty()
    }
}

/// An element of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Element {
    /// Place in the array, row by row.
    pub index: usize,
    /// Length of the array.
    pub length: usize,
}

/// The parts of modelDescription.xml that a host needs.
#[derive(Debug, Default)]
pub(crate) struct Description {
    /// Of FMI 3.0, the instantiation token.
    pub guid: String,
    pub is_fmi3: bool,
    pub model_identifier: String,
    /// True if an FMU of FMI 2.0 takes slopes of its inputs.
    pub interpolates_inputs: bool,
    pub variables: HashMap<String, Variable>,
    pub declarations: HashMap<String, Declaration>,
}

impl Description {
    /// A variable by name. `name[2]` and `name[2,3]` are elements of an array
    /// `name`, counted from 1.
    pub fn find(&self, name: &str) -> Option<(Variable, &Declaration, Option<Element>)> {
        // Elements of an array that a host gets and sets.
        const MAX_ARRAY_LENGTH: usize = 4096;
        let named = |name: &str| self.variables.get(name).copied().zip(self.declarations.get(name));
        if let Some((variable, declaration)) = named(name) {
            return Some((variable, declaration, None));
        }
        let (array, places) = name.strip_suffix(']')?.rsplit_once('[')?;
        let (variable, declaration) = named(array)?;
        let sizes: Vec<usize> = declaration.dimensions.iter().copied().collect::<Option<_>>()?;
        let places: Vec<usize> = places.split(',').map(|place| place.trim().parse().ok()).collect::<Option<_>>()?;
        let is_inside = places.iter().zip(&sizes).all(|(place, size)| (1..=*size).contains(place));
        let length = sizes.iter().try_fold(1, |length: usize, size| length.checked_mul(*size))?;
        if places.len() != sizes.len() || !is_inside || length > MAX_ARRAY_LENGTH {
            return None;
        }
        let index = places.iter().zip(&sizes).fold(0, |index, (place, size)| index * size + place - 1);
        Some((variable, declaration, Some(Element { index, length })))
    }

    /// Reads the file's contents.
    pub fn parse(xml: &str) -> Result<Self, HostError> {
        let mut description = Description::default();
        let mut reader = Reader::from_str(xml);
        // The variable whose type is the next element.
        let mut variable = None;
        // The declared type whose unit is in the next element, and the units of those before.
        let (mut declared_type, mut units) = (None, HashMap::new());
        let mut last = None;
        loop {
            let event = reader.read_event().map_err(|error| HostError::Description(error.to_string()))?;
            let (Event::Start(element) | Event::Empty(element)) = event else {
                if event == Event::Eof { break } else { continue }
            };
            match element.name().as_ref() {
                b"fmiModelDescription" => {
                    description.is_fmi3 = required_attribute(&element, "fmiVersion")?.starts_with("3.");
                    let name = if description.is_fmi3 { "instantiationToken" } else { "guid" };
                    description.guid = required_attribute(&element, name)?;
                }
                b"CoSimulation" => {
                    description.model_identifier = required_attribute(&element, "modelIdentifier")?;
                    description.interpolates_inputs =
                        matches!(optional_attribute(&element, "canInterpolateInputs")?.as_deref(), Some("true" | "1"));
                }
                b"ScalarVariable" => {
                    let causality = variable_causality(&element)?;
                    variable = Some((required_attribute(&element, "name")?, value_reference(&element)?, causality));
                }
                b"SimpleType" => declared_type = Some(required_attribute(&element, "name")?),
                name if description.is_fmi3 && name.ends_with(b"Type") => {
                    if let Some(unit) = optional_attribute(&element, "unit")? {
                        units.insert(required_attribute(&element, "name")?, unit);
                    }
                }
                b"Dimension" if description.is_fmi3 => {
                    let declaration = last.as_ref().and_then(|name| description.declarations.get_mut(name));
                    if let Some(declaration) = declaration {
                        declaration
                            .dimensions
                            .push(optional_attribute(&element, "start")?.and_then(|size| size.parse().ok()));
                    }
                }
                name if description.is_fmi3 => {
                    let Some(kind) = fmi3_kind(name) else { continue };
                    let (name, element_name) = (required_attribute(&element, "name")?, name_text(name));
                    let variable = Variable { value_reference: value_reference(&element)?, kind };
                    let declaration = Declaration {
                        causality: variable_causality(&element)?,
                        unit: variable_unit(&element, &units)?,
                        element: element_name,
                        dimensions: Vec::new(),
                    };
                    description.variables.insert(name.clone(), variable);
                    description.declarations.insert(name.clone(), declaration);
                    last = Some(name);
                }
                name => {
                    let Some(kind) = fmi2_kind(name) else { continue };
                    let Some((variable, value_reference, causality)) = variable.take() else {
                        if let (Some(name), Some(unit)) = (declared_type.take(), optional_attribute(&element, "unit")?)
                        {
                            units.insert(name, unit);
                        }
                        continue;
                    };
                    let unit = variable_unit(&element, &units)?;
                    let declaration = Declaration { causality, unit, element: name_text(name), dimensions: Vec::new() };
                    description.declarations.insert(variable.clone(), declaration);
                    description.variables.insert(variable, Variable { value_reference, kind });
                }
            }
        }
        if description.model_identifier.is_empty() {
            return Err(HostError::Description("it is not for co-simulation".into()));
        }
        Ok(description)
    }
}

fn fmi2_kind(element_name: &[u8]) -> Option<VariableKind> {
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
fn fmi3_kind(element_name: &[u8]) -> Option<VariableKind> {
    match element_name {
        b"Float64" | b"Float32" => Some(VariableKind::Real),
        b"Int8" | b"UInt8" | b"Int16" | b"UInt16" | b"Int32" | b"UInt32" | b"Int64" | b"UInt64" => {
            Some(VariableKind::Integer)
        }
        name => fmi2_kind(name).filter(|kind| matches!(kind, VariableKind::Boolean | VariableKind::Enumeration)),
    }
}

fn value_reference(element: &BytesStart) -> Result<u32, HostError> {
    let text = required_attribute(element, "valueReference")?;
    text.parse().map_err(|error| HostError::Description(format!("value reference '{text}': {error}")))
}

fn variable_causality(element: &BytesStart) -> Result<Causality, HostError> {
    Ok(match optional_attribute(element, "causality")?.as_deref() {
        Some("input") => Causality::Input,
        Some("output") => Causality::Output,
        Some("parameter" | "structuralParameter") => Causality::Parameter,
        _ => Causality::Other,
    })
}

/// The unit of a variable: its own, or that of its declared type.
fn variable_unit(element: &BytesStart, of_types: &HashMap<String, String>) -> Result<Option<String>, HostError> {
    let own = optional_attribute(element, "unit")?;
    let of_type = optional_attribute(element, "declaredType")?.and_then(|name| of_types.get(&name).cloned());
    Ok(own.or(of_type).filter(|unit| !unit.is_empty()))
}

fn name_text(name: &[u8]) -> String {
    String::from_utf8_lossy(name).into_owned()
}

fn required_attribute(element: &BytesStart, name: &str) -> Result<String, HostError> {
    optional_attribute(element, name)?
        .ok_or_else(|| HostError::Description(format!("an element has no attribute '{name}'")))
}

fn optional_attribute(element: &BytesStart, name: &str) -> Result<Option<String>, HostError> {
    let describe = |error: &dyn std::fmt::Display| HostError::Description(error.to_string());
    let Some(found) = element.try_get_attribute(name).map_err(|error| describe(&error))? else { return Ok(None) };
    Ok(Some(found.unescape_value().map_err(|error| describe(&error))?.into_owned()))
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
              <TypeDefinitions>
                <SimpleType name="T"><Enumeration><Item name="a" value="1"/></Enumeration></SimpleType>
                <SimpleType name="Angle"><Real unit="deg"/></SimpleType>
              </TypeDefinitions>
              <ModelVariables>
                <ScalarVariable name="leg[1].&lt;x&gt;" valueReference="7" causality="output"><Real unit="m"/></ScalarVariable>
                <ScalarVariable name="choice" valueReference="8"><Enumeration declaredType="T" start="1"/></ScalarVariable>
                <ScalarVariable name="roll" valueReference="9" causality="input"><Real declaredType="Angle"/></ScalarVariable>
              </ModelVariables>
            </fmiModelDescription>"#;
        let description = Description::parse(xml).unwrap();
        assert_eq!((description.guid.as_str(), description.model_identifier.as_str()), ("{1}", "AB"));
        assert_eq!(description.variables.len(), 3);
        let declared =
            |name: &str| (description.declarations[name].causality, description.declarations[name].unit.clone());
        assert_eq!(declared("leg[1].<x>"), (Causality::Output, Some("m".to_owned())));
        assert_eq!(declared("choice"), (Causality::Other, None));
        assert_eq!(declared("roll"), (Causality::Input, Some("deg".to_owned())));
        let leg = Variable { value_reference: 7, kind: VariableKind::Real };
        assert_eq!(description.variables["leg[1].<x>"], leg);
        let choice = Variable { value_reference: 8, kind: VariableKind::Enumeration };
        assert_eq!(description.variables["choice"], choice);
    }

    #[test]
    fn reads_units_and_arrays_of_fmi_3() {
        let xml = r#"<fmiModelDescription fmiVersion="3.0" instantiationToken="1">
              <CoSimulation modelIdentifier="A"/>
              <TypeDefinitions><Float64Type name="Length" unit="mm"/></TypeDefinitions>
              <ModelVariables>
                <Float64 name="x" valueReference="1" causality="output" declaredType="Length"/>
                <Float32 name="legs" valueReference="2" causality="output" unit="m"><Dimension start="6"/></Float32>
                <Int16 name="mode" valueReference="3" causality="parameter"/>
              </ModelVariables>
            </fmiModelDescription>"#;
        let declarations = Description::parse(xml).unwrap().declarations;
        assert_eq!((declarations["x"].unit.as_deref(), declarations["x"].is_array()), (Some("mm"), false));
        assert!(declarations["legs"].is_array() && declarations["legs"].element == "Float32");
        assert_eq!(declarations["mode"].causality, Causality::Parameter);
    }

    #[test]
    fn elements_of_arrays_are_found_by_their_places() {
        let xml = r#"<fmiModelDescription fmiVersion="3.0" instantiationToken="1">
              <CoSimulation modelIdentifier="A"/>
              <ModelVariables>
                <Float64 name="legs" valueReference="2"><Dimension start="6"/></Float64>
                <Float64 name="base" valueReference="3"><Dimension start="6"/><Dimension start="3"/></Float64>
                <Float64 name="long" valueReference="4"><Dimension start="100000000000"/><Dimension start="3"/></Float64>
                <Float64 name="open" valueReference="5"><Dimension valueReference="9"/></Float64>
                <Float64 name="alone[1]" valueReference="6"/>
              </ModelVariables>
            </fmiModelDescription>"#;
        let description = Description::parse(xml).unwrap();
        let found = |name: &str| {
            let (variable, _, element) = description.find(name)?;
            Some((variable.value_reference, element.map(|element| (element.index, element.length))))
        };
        assert_eq!(found("legs[1]"), Some((2, Some((0, 6)))));
        assert_eq!(found("legs[6]"), Some((2, Some((5, 6)))));
        assert_eq!(found("base[2,3]"), Some((3, Some((5, 18)))));
        assert_eq!(found("base[6, 1]"), Some((3, Some((15, 18)))));
        assert_eq!((found("alone[1]"), found("legs")), (Some((6, None)), Some((2, None))));
        for none in [
            "legs[0]",
            "legs[7]",
            "legs[1,1]",
            "base[4]",
            "base[7,1]",
            "long[1,1]",
            "open[1]",
            "legs[",
            "legs[]",
            "[1]",
        ] {
            assert_eq!(found(none), None, "{none}");
        }
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
