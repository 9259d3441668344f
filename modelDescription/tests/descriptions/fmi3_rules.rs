//! Requirements of FMI 3.0 on a model description. The rules are checked on the text of
//! the file with an independent XML reader, and against the description for FMI 2.0,
//! which has its own tests.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

use crate::document::{child, elements, type_definitions, variables};
use crate::small_model::Small;
use moris_interface::{Causality, Identity, Kind, Model, Row, SlotModel};
use moris_model_description::fmi2::describe;
use moris_model_description::fmi3::{self, Layout};
use moris_model_description::to_xml;
use moris_motorcycle::Motorcycle;
use moris_stewart_platform::StewartPlatform;
use moris_washout::Washout;
use roxmltree::{Document, Node};

/// Every check, on both descriptions of every model of the workspace and of one with a
/// variable of every kind.
macro_rules! on_every_model {
    ($($check:ident)+) => {
        mod washout { $( #[test] fn $check() { super::both(super::$check::<super::Washout>); } )+ }
        mod motorcycle { $( #[test] fn $check() { super::both(super::$check::<super::Motorcycle>); } )+ }
        mod stewart_platform { $( #[test] fn $check() { super::both(super::$check::<super::StewartPlatform>); } )+ }
        mod small { $( #[test] fn $check() { super::both(super::$check::<super::Small>); } )+ }
    };
}

on_every_model! {
    it_begins_as_fmi_asks
    its_parts_are_in_the_order_of_the_schema
    variables_are_the_rows
    variables_have_the_values_of_fmi_2
    start_values_are_the_models_bit_for_bit
    every_unit_and_every_type_used_is_defined
    causality_variability_and_initial_go_together
    outputs_and_initial_unknowns_are_the_outputs_in_order
    log_categories_have_names_of_the_standard
}

fn both(check: fn(Layout)) {
    check(Layout::Scalars);
    check(Layout::Arrays);
}

fn xml<M: Model>(layout: Layout) -> String {
    to_xml(&fmi3::describe::<M>(layout))
}

fn it_begins_as_fmi_asks<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    assert!(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription "));
    assert!(xml.ends_with("</fmiModelDescription>\n"));
    let document = Document::parse(&xml).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("fmiVersion"), Some("3.0"));
    assert_eq!(root.attribute("instantiationToken"), Some(layout.token(&moris_interface::guid::<M>()).as_str()));
    assert_eq!(root.attribute("modelName"), Some(M::IDENTITY.name));
    assert_eq!(root.attribute("variableNamingConvention"), Some("structured"));
    assert!(!xml.contains("NaN") && !xml.contains("inf\"") && !xml.contains("INF"));
    assert_eq!(child(root, "CoSimulation").attribute("modelIdentifier"), Some(M::IDENTITY.name));
}

fn its_parts_are_in_the_order_of_the_schema<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    let document = Document::parse(&xml).unwrap();
    let parts: Vec<_> = elements(document.root_element()).map(|part| part.tag_name().name()).collect();
    let expected = [
        "CoSimulation",
        "UnitDefinitions",
        "TypeDefinitions",
        "LogCategories",
        "DefaultExperiment",
        "ModelVariables",
        "ModelStructure",
    ];
    assert_eq!(parts, expected);
    assert!(elements(document.root_element()).all(|part| elements(part).count() > 0 || part.attributes().count() > 0));
}

/// The variables in the order of their value references.
fn variables_by_reference<'a, 'input>(document: &'a Document<'input>) -> Vec<Node<'a, 'input>> {
    let mut variables = variables(document);
    variables.sort_by_key(|node| node.attribute("valueReference").unwrap().parse::<usize>().unwrap());
    variables
}

/// The variables that the description must have, each with its name, its row and its slots.
fn places(identity: &Identity, layout: Layout) -> Vec<(String, &'static Row, Range<usize>)> {
    let mut first = 0;
    let mut places = Vec::new();
    for row in identity.rows {
        let slots = first..first + row.count * row.components.len();
        first = slots.end;
        match layout {
            Layout::Scalars => {
                places.extend(slots.enumerate().map(|(k, slot)| (row.variable_name(k), row, slot..slot + 1)));
            }
            Layout::Arrays => places.push((row.array_name(), row, slots)),
        }
    }
    places
}

fn variables_are_the_rows<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    let document = Document::parse(&xml).unwrap();
    let (variables, places) = (variables_by_reference(&document), places(&M::IDENTITY, layout));
    assert_eq!(variables.len(), places.len());
    let mut names = BTreeSet::new();
    for (variable, (expected_name, row, slots)) in variables.iter().zip(places) {
        let name = variable.attribute("name").unwrap();
        assert_eq!(name, expected_name);
        assert!(names.insert(name), "{name} appears twice");
        let identifier = |part: &str| {
            part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
                && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        // An array's name has no index, a scalar's one from 1.
        let without_index = |part: &str| part.split('[').next().unwrap().to_owned();
        let is_indexed = name.contains('[');
        assert_eq!(is_indexed, layout == Layout::Scalars && row.count > 1, "{name}");
        assert!(name.split('.').all(|part| identifier(&without_index(part))), "{name}");
        assert_eq!(variable.attribute("valueReference"), Some(slots.start.to_string().as_str()), "{name}");
        assert_eq!(size(*variable), slots.len(), "{name}");
        assert!(variable.attribute("description").unwrap().starts_with(row.text()), "{name}");
        let type_name = match row.kind {
            Kind::Real(_) => "Float64",
            Kind::Integer => "Int32",
            Kind::Boolean => "Boolean",
            Kind::Enumeration(_) => "Enumeration",
        };
        assert_eq!(variable.tag_name().name(), type_name, "{name}");
    }
}

/// Number of values of a variable.
fn size(variable: Node) -> usize {
    elements(variable)
        .map(|dimension| {
            assert!(dimension.has_tag_name("Dimension"));
            dimension.attribute("start").unwrap().parse::<usize>().unwrap()
        })
        .product()
}

/// The variables' elements, in their order, must be the scalar variables that FMI 2.0 has under the
/// same value references. Start values, units, ranges, causality and variability must be the same.
fn variables_have_the_values_of_fmi_2<M: Model>(layout: Layout) {
    let (xml2, xml3) = (to_xml(&describe::<M>()), xml::<M>(layout));
    let (document2, document3) = (Document::parse(&xml2).unwrap(), Document::parse(&xml3).unwrap());
    let mut scalars = variables(&document2).into_iter();
    for variable in variables(&document3) {
        let name = variable.attribute("name").unwrap();
        let start = variable.attribute("start").map(|list| list.split(' ').collect::<Vec<_>>());
        assert!(start.as_ref().is_none_or(|start| start.len() == size(variable)), "{name}");
        let real_type = real_type(&document3, variable);
        for element in 0..size(variable) {
            let scalar = scalars.next().unwrap();
            let values = elements(scalar).next().unwrap();
            let first: usize = variable.attribute("valueReference").unwrap().parse().unwrap();
            assert_eq!(scalar.attribute("valueReference"), Some((first + element).to_string().as_str()), "{name}");
            assert_eq!(values.attribute("start"), start.as_ref().map(|start| start[element]), "{name}");
            for attribute in ["causality", "variability", "initial"] {
                assert_eq!(variable.attribute(attribute), scalar.attribute(attribute), "{name}");
            }
            for attribute in ["min", "max"] {
                assert_eq!(variable.attribute(attribute), values.attribute(attribute), "{name}");
            }
            for attribute in ["quantity", "unit", "displayUnit", "nominal"] {
                assert_eq!(real_type.and_then(|node| node.attribute(attribute)), values.attribute(attribute), "{name}");
                assert!(!variable.has_attribute(attribute), "{name}: fmi-sim wants it in the type");
            }
            let enumeration = variable.attribute("declaredType").filter(|_| variable.has_tag_name("Enumeration"));
            assert_eq!(enumeration, values.attribute("declaredType"), "{name}");
        }
    }
    assert!(scalars.next().is_none());
}

/// The type of a real that has a unit.
fn real_type<'a, 'input>(document: &'a Document<'input>, variable: Node) -> Option<Node<'a, 'input>> {
    let declared = variable.attribute("declaredType").filter(|_| variable.has_tag_name("Float64"))?;
    let found = type_definitions(document).into_iter().find(|node| node.attribute("name") == Some(declared)).unwrap();
    assert!(found.has_tag_name("Float64Type"), "{declared}");
    Some(found)
}

fn start_values_are_the_models_bit_for_bit<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    let document = Document::parse(&xml).unwrap();
    let mut start = vec![f64::NAN; M::IDENTITY.slots.len()];
    M::start_slots(&mut start);
    for (variable, (_, row, slots)) in variables_by_reference(&document).into_iter().zip(places(&M::IDENTITY, layout)) {
        let name = variable.attribute("name").unwrap();
        let Some(list) = variable.attribute("start") else {
            assert!(matches!(row.causality, Causality::Independent | Causality::Output), "{name}");
            continue;
        };
        let read = |text: &str| match text {
            "true" => 1.0,
            "false" => 0.0,
            number => number.parse::<f64>().unwrap(),
        };
        let read: Vec<u64> = list.split(' ').map(|text| read(text).to_bits()).collect();
        let expected: Vec<u64> = start[slots.clone()].iter().map(|value| value.to_bits()).collect();
        assert_eq!(read, expected, "{name}");
    }
}

fn every_unit_and_every_type_used_is_defined<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    let document = Document::parse(&xml).unwrap();
    let root = document.root_element();
    let units: HashMap<_, _> = elements(child(root, "UnitDefinitions"))
        .map(|unit| {
            let display = elements(unit).find(|node| node.has_tag_name("DisplayUnit"));
            (unit.attribute("name").unwrap(), display.map(|node| node.attribute("name").unwrap()))
        })
        .collect();
    let types: BTreeMap<_, _> = type_definitions(&document)
        .into_iter()
        .map(|definition| {
            // FMPy 0.3.15 to 0.3.23 rejects a description of an enumeration type.
            assert_eq!(definition.attribute("description"), None);
            for (item, value) in elements(definition).zip(1..) {
                assert!(definition.has_tag_name("EnumerationType"));
                assert_eq!(item.attribute("value"), Some(value.to_string().as_str()));
            }
            (definition.attribute("name").unwrap(), definition)
        })
        .collect();
    assert_eq!(types.len(), type_definitions(&document).len(), "two types have one name");
    let mut units_used = BTreeSet::new();
    let mut types_used = BTreeSet::new();
    for variable in variables(&document) {
        let name = variable.attribute("name").unwrap();
        assert!(!types.contains_key(name), "{name} is a type too");
        let Some(declared) = variable.attribute("declaredType") else {
            assert!(!variable.has_tag_name("Enumeration"), "{name}");
            continue;
        };
        let definition = types[declared];
        assert_eq!(definition.tag_name().name(), format!("{}Type", variable.tag_name().name()), "{name}");
        types_used.insert(declared);
        if variable.has_tag_name("Enumeration") {
            assert_eq!(variable.attribute("min"), Some("1"), "{name}");
            assert_eq!(variable.attribute("max"), Some(elements(definition).count().to_string().as_str()), "{name}");
        } else {
            let unit = definition.attribute("unit").unwrap();
            let frequency = definition.attribute("quantity") == Some("AngularFrequency");
            assert_eq!(definition.attribute("displayUnit"), units[unit].filter(|_| !frequency), "{name}");
            units_used.insert(unit);
        }
    }
    assert_eq!(units_used, units.keys().copied().collect());
    assert_eq!(types_used, types.keys().copied().collect());
}

fn causality_variability_and_initial_go_together<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    let document = Document::parse(&xml).unwrap();
    for variable in variables(&document) {
        let is_real = variable.has_tag_name("Float64");
        let [causality, variability] = ["causality", "variability"].map(|name| variable.attribute(name).unwrap());
        let legal = match (causality, variability, variable.attribute("initial")) {
            ("independent", "continuous", None) => is_real && size(variable) == 1,
            ("input", "continuous", None) | ("output", "continuous", Some("calculated")) => is_real,
            ("input", "discrete", None) | ("output", "discrete", Some("calculated")) => !is_real,
            ("parameter", "fixed" | "tunable", None) => true,
            _ => false,
        };
        assert!(legal, "{variable:?}");
    }
    let is_time = |node: &&Node| node.attribute("causality") == Some("independent");
    assert_eq!(variables(&document).iter().filter(is_time).count(), 1);
}

fn outputs_and_initial_unknowns_are_the_outputs_in_order<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    let document = Document::parse(&xml).unwrap();
    let is_output = |node: &Node| node.attribute("causality") == Some("output");
    let expected: Vec<_> =
        variables(&document).into_iter().filter(is_output).map(|node| node.attribute("valueReference")).collect();
    let structure = child(document.root_element(), "ModelStructure");
    let names: Vec<_> = elements(structure).map(|node| node.tag_name().name()).collect();
    assert_eq!(names, [vec!["Output"; expected.len()], vec!["InitialUnknown"; expected.len()]].concat());
    let references: Vec<_> = elements(structure).map(|node| node.attribute("valueReference")).collect();
    assert_eq!(references, [&expected[..], &expected[..]].concat());
    let knowns: Vec<_> = variables(&document)
        .into_iter()
        .filter(|node| ["input", "parameter"].contains(&node.attribute("causality").unwrap()))
        .map(|node| node.attribute("valueReference").unwrap())
        .collect();
    for node in elements(structure) {
        // Hosts iterate over the list.
        let dependencies = node.attribute("dependencies").expect("an explicit list");
        assert!(node.has_tag_name("InitialUnknown") || dependencies.is_empty());
        assert!(dependencies.split_whitespace().all(|reference| knowns.contains(&reference)), "{dependencies}");
    }
}

fn log_categories_have_names_of_the_standard<M: Model>(layout: Layout) {
    let xml = xml::<M>(layout);
    let document = Document::parse(&xml).unwrap();
    let standard = ["logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal"];
    for category in elements(child(document.root_element(), "LogCategories")) {
        assert!(standard.contains(&category.attribute("name").unwrap()));
        assert!(!category.attribute("description").unwrap().is_empty());
    }
}

/// Names and shapes that users of the washout rely on.
#[test]
fn the_washout_s_vectors_are_arrays() {
    let xml = xml::<Washout>(Layout::Arrays);
    let document = Document::parse(&xml).unwrap();
    let dimensions = |name: &str| -> Vec<_> {
        let variables = variables(&document);
        let variable = variables.iter().find(|node| node.attribute("name") == Some(name)).unwrap();
        elements(*variable).map(|dimension| dimension.attribute("start").unwrap().to_owned()).collect()
    };
    assert_eq!(dimensions("vehicle.specificForce"), ["3"]);
    assert_eq!(dimensions("platform.orientation"), ["3"]);
    assert_eq!(dimensions("actuator.length"), ["6"]);
    assert_eq!(dimensions("rig.base"), ["6", "3"]);
    assert_eq!(dimensions("splitter.omega1"), ["3"]);
    assert!(dimensions("gravity").is_empty());
    assert!(xml.contains("Components: roll, pitch, yaw."));
}

/// An importer that joins FMUs of both versions finds the same names, under the
/// same value references.
#[test]
fn scalars_have_the_names_and_value_references_of_fmi_2() {
    fn names<M: Model>() -> [Vec<(String, String)>; 2] {
        [to_xml(&describe::<M>()), xml::<M>(Layout::Scalars)].map(|xml| {
            let document = Document::parse(&xml).unwrap();
            let attribute = |node: &Node, name: &str| node.attribute(name).unwrap().to_owned();
            let pair = |node: Node| (attribute(&node, "name"), attribute(&node, "valueReference"));
            variables(&document).into_iter().map(pair).collect()
        })
    }
    for [fmi2, fmi3] in [names::<Washout>(), names::<Motorcycle>(), names::<StewartPlatform>(), names::<Small>()] {
        assert_eq!(fmi2, fmi3);
        assert!(!fmi3.is_empty());
    }
}

#[test]
fn a_changed_variable_is_one_changed_line() {
    for layout in [Layout::Scalars, Layout::Arrays] {
        let xml = xml::<Small>(layout);
        let variables = xml.lines().filter(|line| line.contains(" causality="));
        assert!(variables.clone().all(|line| line.ends_with("</Float64>") || line.ends_with("/>")));
        assert_eq!(variables.count(), places(&Small::IDENTITY, layout).len());
    }
}
