//! Requirements of FMI 2.0 on a model description, and errors that no validator reports. The rules
//! are checked on the text of the file with an independent XML reader.

use std::collections::{BTreeSet, HashMap};

use crate::document::{child, elements, type_definitions, variables};
use crate::small_model::Small;
use moris_interface::{Causality, Identity, Kind, Model, SlotModel};
use moris_model_description::{fmi2::describe, to_xml};
use moris_motorcycle::Motorcycle;
use moris_stewart_platform::StewartPlatform;
use moris_washout::Washout;
use roxmltree::{Document, Node};

/// Every check, on every model of the workspace and on one with a variable of every kind.
macro_rules! on_every_model {
    ($($check:ident)+) => {
        mod washout { $( #[test] fn $check() { super::$check::<super::Washout>(); } )+ }
        mod motorcycle { $( #[test] fn $check() { super::$check::<super::Motorcycle>(); } )+ }
        mod stewart_platform { $( #[test] fn $check() { super::$check::<super::StewartPlatform>(); } )+ }
        mod small { $( #[test] fn $check() { super::$check::<super::Small>(); } )+ }
    };
}

on_every_model! {
    it_begins_as_fmi_asks
    its_parts_are_in_the_order_of_the_schema
    it_has_no_empty_element_where_the_schema_wants_content
    variables_are_the_models
    what_matters_comes_first
    start_values_are_the_models_bit_for_bit
    start_values_are_inside_their_ranges
    every_unit_used_is_defined_and_every_unit_defined_is_used
    every_enumeration_used_is_defined_with_its_items_from_one
    causality_variability_and_initial_go_together
    outputs_are_listed_once_in_order_and_depend_on_nothing
    initial_unknowns_are_the_calculated_variables_in_order
}

fn it_begins_as_fmi_asks<M: Model>() {
    let xml = to_xml(&describe::<M>());
    assert!(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription "));
    assert!(xml.ends_with("</fmiModelDescription>\n"));
    let document = Document::parse(&xml).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("fmiVersion"), Some("2.0"));
    assert_eq!(root.attribute("guid"), Some(moris_interface::guid::<M>().as_str()));
    assert_eq!(root.attribute("modelName"), Some(M::IDENTITY.name));
    assert_eq!(root.attribute("variableNamingConvention"), Some("structured"));
    let date = root.attribute("generationDateAndTime").unwrap();
    let shape: String = date.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).collect();
    assert_eq!(shape, "0000-00-00T00:00:00Z");
    assert!(!xml.contains("NaN") && !xml.contains("inf\"") && !xml.contains("INF"));

    let identifier = child(root, "CoSimulation").attribute("modelIdentifier").unwrap();
    assert!(identifier.starts_with(|c: char| c.is_ascii_alphabetic()));
    assert!(identifier.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'));
}

fn its_parts_are_in_the_order_of_the_schema<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let parts: Vec<_> = elements(document.root_element()).map(|part| part.tag_name().name()).collect();
    let order = [
        "CoSimulation",
        "UnitDefinitions",
        "TypeDefinitions",
        "LogCategories",
        "DefaultExperiment",
        "ModelVariables",
        "ModelStructure",
    ];
    let expected = order.into_iter().filter(|&part| part != "TypeDefinitions" || has_enumerations::<M>());
    assert_eq!(parts, expected.collect::<Vec<_>>());
}

/// True if the model has an enumeration; only then are there types to define.
fn has_enumerations<M: Model>() -> bool {
    M::IDENTITY.rows.iter().any(|row| matches!(row.kind, Kind::Enumeration(_)))
}

fn it_has_no_empty_element_where_the_schema_wants_content<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let lists = ["UnitDefinitions", "TypeDefinitions", "LogCategories", "ModelVariables", "Outputs", "InitialUnknowns"];
    for node in document.descendants().filter(|node| lists.contains(&node.tag_name().name())) {
        assert!(elements(node).count() > 0, "{}", node.tag_name().name());
    }
}

fn variables_are_the_models<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let identity = M::IDENTITY;
    let variables = variables(&document);
    assert_eq!(variables.len(), identity.slots.len());
    let mut names = BTreeSet::new();
    for variable in &variables {
        let slot = slot_of(*variable);
        let name = variable.attribute("name").unwrap();
        assert_eq!(name, identity.variable_name(slot));
        assert!(names.insert(name), "{name} appears twice");
        assert!(is_structured(name), "{name}");
        assert_eq!(variable.attribute("description"), Some(identity.row(slot).text()), "{name}");
        assert!(!identity.row(slot).text().is_empty(), "{name}");
        let type_name = match identity.row(slot).kind {
            Kind::Real(_) => "Real",
            Kind::Integer => "Integer",
            Kind::Boolean => "Boolean",
            Kind::Enumeration(_) => "Enumeration",
        };
        assert_eq!(type_of(*variable).tag_name().name(), type_name, "{name}");
    }
}

/// Inputs and outputs come before parameters. Of the parameters, the ten rows that matter most come
/// first and a rig's joints last. The elements of an array are consecutive.
fn what_matters_comes_first<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let identity = M::IDENTITY;
    let is_parameter = |node: &Node| node.attribute("causality") == Some("parameter");
    let variables = variables(&document);
    let parameters: Vec<Node> = variables.iter().copied().skip_while(|node| !is_parameter(node)).collect();
    assert!(parameters.iter().all(is_parameter));
    let mut rows: Vec<&str> = parameters.iter().map(|&node| identity.row(slot_of(node)).name).collect();
    let joints = rows.iter().filter(|name| ["rig.base[#].@", "rig.platform[#].@"].contains(name)).count();
    assert!(rows.iter().rev().take(joints).all(|name| name.starts_with("rig.")), "{rows:?}");
    rows.dedup();
    assert_eq!(rows.iter().collect::<BTreeSet<_>>().len(), rows.len(), "a row's variables are apart");
    assert!(rows.starts_with(&main_parameters(&identity)), "{rows:?}");
    let slots: Vec<usize> = variables.iter().map(|&node| slot_of(node)).collect();
    assert!(slots.windows(2).all(|two| two[1] == two[0] + 1 || identity.slots[two[1]].element == 0));
}

/// Names of the rows that matter most, by their places, which are 1, 2, 3 ...
fn main_parameters(identity: &Identity) -> Vec<&'static str> {
    let mut main: Vec<_> = identity.rows.iter().filter_map(|row| Some((row.importance_rank?, row.name))).collect();
    main.sort_unstable();
    assert!(main.iter().zip(1..).all(|((place, _), expected)| *place == expected), "{main:?}");
    main.into_iter().map(|(_, name)| name).collect()
}

#[test]
fn every_model_of_ours_has_ten_parameters_that_matter_most() {
    let models = [Washout::IDENTITY, Motorcycle::IDENTITY, StewartPlatform::IDENTITY];
    assert_eq!(models.map(|identity| main_parameters(&identity).len()), [10; 3]);
}

/// A row that has an effect only with some values of another names a row and values of that.
#[test]
fn conditions_are_of_variables_and_values_that_exist() {
    for identity in [Washout::IDENTITY, Motorcycle::IDENTITY, StewartPlatform::IDENTITY] {
        let all = identity.rows.iter().flat_map(|row| (0..row.slots()).flat_map(|element| row.conditions(element)));
        for condition in all {
            let other = identity.rows.iter().find(|other| other.name == condition.variable).expect(condition.variable);
            let exists = |value: &&str| match other.kind {
                Kind::Enumeration(enumeration) => enumeration.items.iter().any(|item| item.name == *value),
                _ => value.parse::<i32>().is_ok_and(|value| other.accepts(value.into())),
            };
            assert!(condition.values.iter().all(exists) && !condition.values.is_empty(), "{condition:?}");
        }
    }
}

/// FMI 2.0, 2.2.9, without quoted names and derivatives, which we do not use.
fn is_structured(name: &str) -> bool {
    name.split('.').all(|part| {
        let (identifier, index) = part.split_once('[').map_or((part, "1"), |(identifier, rest)| {
            (identifier, rest.strip_suffix(']').unwrap_or("no closing bracket"))
        });
        identifier.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && identifier.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && index.parse::<u32>().is_ok_and(|index| index > 0)
    })
}

fn start_values_are_the_models_bit_for_bit<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let identity = M::IDENTITY;
    let mut start = vec![f64::NAN; identity.slots.len()];
    M::start_slots(&mut start);
    for variable in variables(&document) {
        let slot = slot_of(variable);
        let name = identity.variable_name(slot);
        let written = type_of(variable).attribute("start");
        if matches!(identity.row(slot).causality, Causality::Independent | Causality::Output) {
            assert_eq!(written, None, "{name}");
            continue;
        }
        let read = match written.unwrap() {
            "true" => 1.0,
            "false" => 0.0,
            number => number.parse::<f64>().unwrap(),
        };
        assert_eq!(read.to_bits(), start[slot].to_bits(), "{name}: {read} is not {}", start[slot]);
    }
}

fn start_values_are_inside_their_ranges<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    for variable in variables(&document) {
        let number = |attribute| type_of(variable).attribute(attribute).and_then(|text| text.parse::<f64>().ok());
        let (Some(start), Some(min), Some(max)) = (number("start"), number("min"), number("max")) else { continue };
        assert!((min..=max).contains(&start), "{}", variable.attribute("name").unwrap());
    }
}

fn every_unit_used_is_defined_and_every_unit_defined_is_used<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let mut defined = HashMap::new();
    for unit in elements(child(document.root_element(), "UnitDefinitions")) {
        assert!(child(unit, "BaseUnit").attributes().count() > 0);
        let display = elements(unit).find(|node| node.has_tag_name("DisplayUnit"));
        let display = display.map(|node| node.attribute("name").unwrap());
        assert!(defined.insert(unit.attribute("name").unwrap(), display).is_none());
    }
    let mut used = BTreeSet::new();
    for variable in variables(&document) {
        let name = variable.attribute("name").unwrap();
        let unit = type_of(variable).attribute("unit");
        assert_ne!(unit, Some(""), "{name}");
        let defined_display = unit.and_then(|unit| *defined.get(unit).unwrap_or_else(|| panic!("{name}: {unit}")));
        let display = type_of(variable).attribute("displayUnit");
        let frequency = type_of(variable).attribute("quantity") == Some("AngularFrequency");
        assert_eq!(display, defined_display.filter(|_| !frequency), "{name}");
        assert!(display.is_none_or(|display| display == unit.unwrap().replace("rad", "deg")), "{name}");
        used.extend(unit);
    }
    assert_eq!(used, defined.keys().copied().collect());
}

fn every_enumeration_used_is_defined_with_its_items_from_one<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let variables = variables(&document);
    let mut sizes = HashMap::new();
    for definition in type_definitions(&document) {
        let name = definition.attribute("name").unwrap();
        assert!(variables.iter().all(|variable| variable.attribute("name") != Some(name)), "{name} is a variable too");
        let items: Vec<_> = elements(child(definition, "Enumeration")).collect();
        let names: BTreeSet<_> = items.iter().map(|item| item.attribute("name").unwrap()).collect();
        assert_eq!(names.len(), items.len(), "{name}");
        for (item, value) in items.iter().zip(1..) {
            assert_eq!(item.attribute("value"), Some(value.to_string().as_str()), "{name}");
            assert!(!item.attribute("description").unwrap().is_empty(), "{name}");
        }
        assert!(sizes.insert(name, items.len().to_string()).is_none(), "{name} is defined twice");
    }
    let mut used = BTreeSet::new();
    for of_type in variables.iter().map(|variable| type_of(*variable)).filter(|node| node.has_tag_name("Enumeration")) {
        let name = of_type.attribute("declaredType").unwrap();
        assert_eq!(of_type.attribute("min"), Some("1"));
        assert_eq!(of_type.attribute("max"), Some(sizes[name].as_str()));
        used.insert(name);
    }
    assert_eq!(used, sizes.keys().copied().collect());
}

fn causality_variability_and_initial_go_together<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    for variable in variables(&document) {
        let is_real = type_of(variable).has_tag_name("Real");
        let [causality, variability] = ["causality", "variability"].map(|name| variable.attribute(name).unwrap());
        let legal = match (causality, variability, variable.attribute("initial")) {
            ("independent", "continuous", None) => is_real,
            ("input", "continuous", None) | ("output", "continuous", Some("calculated")) => is_real,
            ("input", "discrete", None) | ("output", "discrete", Some("calculated")) => !is_real,
            ("parameter", "fixed" | "tunable", None) => true,
            _ => false,
        };
        assert!(legal, "{variable:?}");
    }
    let times = variables(&document).iter().filter(|node| node.attribute("causality") == Some("independent")).count();
    assert_eq!(times, 1);
}

fn outputs_are_listed_once_in_order_and_depend_on_nothing<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let unknowns = unknowns(&document, "Outputs");
    assert_eq!(indices(&unknowns), indices_of_outputs(&document));
    assert!(unknowns.iter().all(|unknown| unknown.attribute("dependencies") == Some("")));
}

fn initial_unknowns_are_the_calculated_variables_in_order<M: Model>() {
    let xml = to_xml(&describe::<M>());
    let document = Document::parse(&xml).unwrap();
    let unknowns = unknowns(&document, "InitialUnknowns");
    assert_eq!(indices(&unknowns), indices_of_outputs(&document));
    // Each lists what it depends on, in order: hosts iterate over it.
    let variables = variables(&document);
    for unknown in unknowns {
        let dependencies = unknown.attribute("dependencies").expect("an explicit list").split_whitespace();
        let dependencies: Vec<usize> = dependencies.map(|index| index.parse().unwrap()).collect();
        assert!(dependencies.is_sorted_by(|one, next| one < next));
        let is_known =
            |index: &usize| ["input", "parameter"].contains(&variables[index - 1].attribute("causality").unwrap());
        assert!(dependencies.iter().all(is_known));
    }
}

#[test]
fn a_changed_variable_is_one_changed_line() {
    let xml = to_xml(&describe::<Small>());
    let variables = xml.lines().filter(|line| line.contains("<ScalarVariable "));
    assert!(variables.clone().all(|line| line.ends_with("</ScalarVariable>")));
    assert_eq!(variables.count(), Small::IDENTITY.slots.len());
}

#[test]
fn angles_and_their_rates_are_shown_in_degrees_and_break_frequencies_are_not() {
    let xml = to_xml(&describe::<Washout>());
    let document = Document::parse(&xml).unwrap();
    let displays: Vec<_> = document.descendants().filter(|node| node.has_tag_name("DisplayUnit")).collect();
    let names = |display: &Node| {
        let factor: f64 = display.attribute("factor").unwrap().parse().unwrap();
        assert_eq!(factor, 1.0_f64.to_degrees());
        let unit = display.parent().unwrap().attribute("name").unwrap();
        (unit.to_owned(), display.attribute("name").unwrap().to_owned())
    };
    let names: BTreeSet<_> = displays.iter().map(names).collect();
    let pairs = [("rad", "deg"), ("rad/s", "deg/s"), ("rad/s2", "deg/s2")];
    assert_eq!(names, pairs.map(|(unit, display)| (unit.to_owned(), display.to_owned())).into());
    let display = |name: &str| {
        let variable = document.descendants().find(|node| node.attribute("name") == Some(name)).unwrap();
        type_of(variable).attribute("displayUnit")
    };
    assert_eq!(display("tilt.angleLimit"), Some("deg"));
    assert_eq!(display("tilt.rateLimit"), Some("deg/s"));
    assert_eq!(display("tilt.accelerationLimit"), Some("deg/s2"));
    assert_eq!(display("splitter.x.omega1"), None);
}

/// The slot that a variable's value reference is.
fn slot_of(variable: Node) -> usize {
    variable.attribute("valueReference").unwrap().parse().unwrap()
}

/// The one element inside a variable.
fn type_of<'a, 'input>(variable: Node<'a, 'input>) -> Node<'a, 'input> {
    let mut types = elements(variable);
    let only = types.next().unwrap();
    assert!(types.next().is_none());
    only
}

fn unknowns<'a, 'input>(document: &'a Document<'input>, list: &str) -> Vec<Node<'a, 'input>> {
    elements(child(child(document.root_element(), "ModelStructure"), list)).collect()
}

fn indices(unknowns: &[Node]) -> Vec<usize> {
    unknowns.iter().map(|unknown| unknown.attribute("index").unwrap().parse().unwrap()).collect()
}

/// Places in the list of variables, from 1, ascending.
fn indices_of_outputs(document: &Document) -> Vec<usize> {
    let variables = variables(document);
    let numbered = (1..).zip(&variables);
    numbered.filter(|(_, node)| node.attribute("causality") == Some("output")).map(|(index, _)| index).collect()
}
