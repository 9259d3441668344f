//! The description of a system: its connectors and connections are those of the models.

use moris_build_fmu::archive::pack;
use moris_build_fmu::model::{MOTORCYCLE, WASHOUT};
use moris_build_fmu::ssp::{COMPONENTS, DESCRIPTION_PATH, Form, MOTORCYCLE_LAP, MOTORCYCLE_SIMULATOR, SYSTEMS, System};
use moris_build_fmu::{FmuModel, Start};
use moris_interface::{Causality, Kind};
use moris_setup::load_set;
use roxmltree::{Document, Node};

const ENDS: [&str; 4] = ["startElement", "startConnector", "endElement", "endConnector"];

/// The description of a system.
pub fn structure(system: &System, form: Form) -> String {
    String::from_utf8(system.texts(form)[DESCRIPTION_PATH].clone()).expect("a text")
}

/// Connections between components: from a component's output, to a component's input.
pub fn connections(structure: &str) -> Vec<[String; 4]> {
    let document = Document::parse(structure).expect("well-formed XML");
    let wires = document.descendants().filter(|node| node.has_tag_name("Connection"));
    let inside = wires.filter(|wire| ENDS.iter().all(|end| wire.has_attribute(*end)));
    inside.map(|wire| ENDS.map(|end| wire.attribute(end).expect("checked").to_owned())).collect()
}

fn model(component: &str) -> &'static FmuModel {
    COMPONENTS.iter().find(|(name, _)| *name == component).expect("a component").1
}

/// Asserts that a connector is a variable of the model, with its causality, type and unit.
fn assert_fits(connector: &Node, component: &str, variable: &str) {
    let identity = &model(component).functions.identity;
    let slot = identity.slot(variable).unwrap_or_else(|| panic!("{component} has no {variable}"));
    let row = identity.row(slot);
    let kind = if row.causality == Causality::Input { "input" } else { "output" };
    assert_eq!(connector.attribute("kind"), Some(kind), "{component}.{variable}");
    let of = connector.first_element_child().expect("a type");
    let (tag, unit) = match row.kind {
        Kind::Real(unit) => ("Real", Some(unit.name).filter(|name| !name.is_empty())),
        Kind::Boolean => ("Boolean", None),
        Kind::Integer | Kind::Enumeration(_) => ("Integer", None),
    };
    assert_eq!((of.tag_name().name(), of.attribute("unit")), (tag, unit), "{component}.{variable}");
}

#[test]
fn every_connector_is_a_variable() {
    let mut checked = 0;
    for (system, form) in SYSTEMS.into_iter().flat_map(|system| [(system, Form::Whole), (system, Form::Flat)]) {
        let text = structure(system, form);
        let document = Document::parse(&text).unwrap();
        for connector in document.descendants().filter(|node| node.has_tag_name("Connector")) {
            let owner = connector.ancestors().nth(2).expect("an owner");
            let name = connector.attribute("name").unwrap();
            if owner.has_tag_name("Component") {
                assert_fits(&connector, owner.attribute("name").unwrap(), name);
            } else {
                // The system's own: the variable that it is connected to.
                let is_own = |wire: &Node, [element, own]: [&str; 2]| {
                    !wire.has_attribute(element) && wire.attribute(own) == Some(name)
                };
                let wire = document
                    .descendants()
                    .find(|wire| is_own(wire, [ENDS[0], ENDS[1]]) || is_own(wire, [ENDS[2], ENDS[3]]))
                    .expect("a connection");
                let of =
                    |[element, variable]: [usize; 2]| wire.attribute(ENDS[element]).zip(wire.attribute(ENDS[variable]));
                let (component, variable) = of([0, 1]).or(of([2, 3])).unwrap();
                assert_fits(&connector, component, variable);
            }
            checked += 1;
        }
    }
    assert!(checked > 300, "{checked}");
}

#[test]
fn every_output_that_an_input_has_the_name_of_is_connected() {
    let names = |model: &FmuModel, causality| {
        let identity = &model.functions.identity;
        let slots = (0..identity.slots.len()).filter(move |&slot| identity.row(slot).causality == causality);
        slots.map(|slot| identity.variable_name(slot)).collect::<Vec<_>>()
    };
    let delivered = names(&MOTORCYCLE, Causality::Output);
    for (system, preview) in [(&MOTORCYCLE_SIMULATOR, false), (&MOTORCYCLE_LAP, true)] {
        let taken = names(&WASHOUT, Causality::Input);
        let expected: Vec<String> = taken
            .into_iter()
            .filter(|name| delivered.contains(name) && (preview || !name.starts_with("vehicle.preview.")))
            .collect();
        let wires = connections(&structure(system, Form::Whole));
        let passed = wires.iter().filter(|wire| wire[0] == "motorcycle" && wire[2] == "washout");
        assert!(passed.map(|wire| (&wire[1], &wire[3])).eq(expected.iter().map(|name| (name, name))));
        assert_eq!(wires, connections(&structure(system, Form::Flat)));
    }
}

#[test]
fn a_package_is_the_same_every_time() {
    for (form, parameters) in [(Form::Whole, "MotorcycleSimulator"), (Form::Flat, "washout")] {
        let contents = MOTORCYCLE_SIMULATOR.texts(form);
        let paths: Vec<&str> = contents.keys().map(String::as_str).collect();
        let parameters = format!("resources/{parameters}.ssv");
        assert_eq!(paths, [DESCRIPTION_PATH, "documentation/licenses/license.txt", &*parameters]);
        assert!(pack(&contents).unwrap() == pack(&MOTORCYCLE_SIMULATOR.texts(form)).unwrap());
        assert!(MOTORCYCLE_LAP.texts(form).keys().eq([DESCRIPTION_PATH, "documentation/licenses/license.txt"]));
    }
}

#[test]
fn every_parameter_of_the_simulator_is_the_washouts() {
    let own: Vec<String> = ["MotorcycleSimulator", "washout"]
        .into_iter()
        .zip([Form::Whole, Form::Flat])
        .map(|(name, form)| {
            let text = MOTORCYCLE_SIMULATOR.texts(form)[&format!("resources/{name}.ssv")].clone();
            String::from_utf8(text).unwrap().replace("name=\"washout.", "name=\"")
        })
        .collect();
    assert_eq!(own[0], own[1]);
    let document = Document::parse(&own[0]).unwrap();
    let mut checked = 0;
    for parameter in document.descendants().filter(|node| node.has_tag_name("Parameter")) {
        let slot = WASHOUT.functions.identity.slot(parameter.attribute("name").unwrap()).expect("a variable");
        let Kind::Real(unit) = WASHOUT.functions.identity.row(slot).kind else { panic!("FMPy reads numbers alone") };
        let value = parameter.first_element_child().expect("a value");
        assert_eq!(value.attribute("unit").unwrap_or_default(), unit.name);
        assert!(value.attribute("value").unwrap().parse::<f64>().is_ok());
        checked += 1;
    }
    assert!(checked > 5);
    assert!(MOTORCYCLE_SIMULATOR.starts().unwrap().iter().all(Start::is_own));
}

#[test]
fn the_motorcycle_has_the_lap_and_the_washout_the_preview() {
    let [motorcycle, washout, platform] = MOTORCYCLE_LAP.starts().unwrap().try_into().unwrap();
    assert!(platform.is_own() && motorcycle.count() == 1);
    let course = MOTORCYCLE.functions.identity.slot("path.course").unwrap();
    assert_eq!(motorcycle.slots()[course], 6.0, "the last item of the courses");
    let preset = load_set("preview", WASHOUT.functions.identity.rows).unwrap();
    let preset = Start::with(&WASHOUT, &preset).unwrap();
    let others: Vec<String> = (0..preset.slots().len())
        .filter(|&slot| washout.slots()[slot] != preset.slots()[slot])
        .map(|slot| WASHOUT.functions.identity.variable_name(slot))
        .collect();
    assert_eq!(others, ["scale.angularVelocity.x"]);
}
