//! From a system to its description.

use moris_interface::{Causality, Identity, Kind, Unit};
use moris_model_description::Element;
use moris_model_description::common::{origin, units};

use crate::parameter_set::{ByComponent, Parameter};
use crate::system::{Component, Connection, Port, System};
use crate::{Form, fmu_path, parameters_path};

const SSD: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
const SSV: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";
/// The namespace of the annotation for OMSimulator.
const OMS: &str = "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd";
const SSC: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";

/// Size of a component in a drawing, and the room between two.
const BOX: f64 = 60.0;
const GAP: f64 = 40.0;

/// The description of a system whose components start with these parameters.
pub fn describe(system: &System, form: Form, parameters: &ByComponent) -> Element {
    let is_whole = form == Form::Whole;
    let connections = (system.connections)();
    let (inputs, outputs) = if is_whole { (system.inputs, system.outputs) } else { (&[][..], &[][..]) };
    let components = (0..).zip(system.components).map(|(number, part)| {
        let has_parameters = parameters.iter().any(|(name, _)| name == part.name);
        component(part, number, &connections, inputs, outputs)
            .containing((!is_whole && has_parameters).then(|| bound_to(part.name)))
    });
    // The schema knows no empty lists.
    let simulator = Element::new("ssd:System")
        .with("name", "simulator")
        .containing(is_whole.then(|| own_connectors(system)))
        .containing((is_whole && !parameters.is_empty()).then(|| bound_to(system.name)))
        .containing([
            Element::new("ssd:Elements").containing(components),
            Element::new("ssd:Connections").containing(wires(inputs, &connections, outputs)),
            master(system),
        ]);
    let root = Element::new("ssd:SystemStructureDescription")
        .with("xmlns:ssd", SSD)
        .with("xmlns:ssc", SSC)
        .with("xmlns:oms", OMS)
        .with("version", "1.0")
        .with("name", system.name)
        .with("description", system.text);
    with_origin(root).containing([
        simulator,
        Element::new("ssd:Units").containing(units(system)),
        Element::new("ssd:DefaultExperiment").with("startTime", 0.0).with("stopTime", system.stop_time),
    ])
}

/// A parameter set with these parameters.
pub fn parameter_set(system: &System, parameters: Vec<Parameter>) -> Element {
    let parameter = |(name, value)| Element::new("ssv:Parameter").with("name", name).containing([value]);
    let root = Element::new("ssv:ParameterSet")
        .with("xmlns:ssv", SSV)
        .with("xmlns:ssc", SSC)
        .with("version", "1.0")
        .with("name", system.name);
    with_origin(root).containing([
        Element::new("ssv:Parameters").containing(parameters.into_iter().map(parameter)),
        Element::new("ssv:Units").containing(units(system)),
    ])
}

/// A root with the origin that the components have, too.
fn with_origin(root: Element) -> Element {
    root.with("author", origin::AUTHOR)
        .with("copyright", origin::COPYRIGHT)
        .with("license", origin::LICENSE)
        .with("generationTool", origin::GENERATION_TOOL)
        .with("generationDateAndTime", origin::GENERATION_DATE_AND_TIME)
}

/// A binding to the parameter set of this name.
fn bound_to(name: &str) -> Element {
    let binding = Element::new("ssd:ParameterBinding").with("source", parameters_path(name));
    Element::new("ssd:ParameterBindings").containing([binding])
}

/// The system's own connectors, inputs first, each of the type of the component's variable that it
/// is.
fn own_connectors(system: &System) -> Element {
    let own = |kind: &'static str| {
        move |port: &Port| {
            let identity = system.component(port.component).model.functions.identity;
            connector(port.name, kind, &identity, port.variable)
        }
    };
    Element::new("ssd:Connectors")
        .containing(system.inputs.iter().map(own("input")))
        .containing(system.outputs.iter().map(own("output")))
}

/// The annotation without which OMSimulator does not load a system: a master algorithm with a fixed
/// step.
fn master(system: &System) -> Element {
    let master = Element::new("oms:FixedStepMaster")
        .with("description", "oms-ma")
        .with("stepSize", system.step_size)
        .with("absoluteTolerance", 1e-4)
        .with("relativeTolerance", 1e-4);
    let information = Element::new("oms:SimulationInformation").containing([master]);
    let annotation = Element::new("ssc:Annotation")
        .with("type", "org.openmodelica")
        .containing([Element::new("oms:Annotations").containing([information])]);
    Element::new("ssd:Annotations").containing([annotation])
}

/// A component with the connectors that are connected, to another or to the system's own, or shown.
fn component(
    component: &Component,
    number: i32,
    connections: &[Connection],
    inputs: &[Port],
    outputs: &[Port],
) -> Element {
    let identity = component.model.functions.identity;
    let is_port =
        |ports: &[Port], name: &str| ports.iter().any(|port| port.component == component.name && port.variable == name);
    let has_input = |name: &str| {
        connections.iter().any(|wire| wire.to == (component.name, name.to_owned())) || is_port(inputs, name)
    };
    let has_output = |name: &str| {
        connections.iter().any(|wire| wire.from == (component.name, name.to_owned()))
            || component.shows(name)
            || is_port(outputs, name)
    };
    let connector_of = |slot: usize| {
        let name = identity.variable_name(slot);
        let kind = match identity.row(slot).causality {
            Causality::Input if has_input(&name) => "input",
            Causality::Output if has_output(&name) => "output",
            _ => return None,
        };
        Some(connector(&name, kind, &identity, &name))
    };
    let left = f64::from(number) * (BOX + GAP);
    let geometry = [("x1", left), ("y1", 0.0), ("x2", left + BOX), ("y2", BOX)];
    let drawn = geometry.into_iter().fold(Element::new("ssd:ElementGeometry"), |drawn, (end, at)| drawn.with(end, at));
    Element::new("ssd:Component")
        .with("name", component.name)
        .with("description", component.model.title)
        .with("type", "application/x-fmu-sharedlibrary")
        .with("source", fmu_path(component))
        .with("implementation", "CoSimulation")
        .containing([
            Element::new("ssd:Connectors").containing((0..identity.slots.len()).filter_map(connector_of)),
            drawn,
        ])
}

/// A connector of this name for a model's variable.
fn connector(name: &str, kind: &str, identity: &Identity, variable: &str) -> Element {
    let slot = identity.slot(variable).unwrap_or_else(|| panic!("{} has no variable {variable}", identity.name));
    let type_ = match identity.row(slot).kind {
        Kind::Real(unit) => Element::new("ssc:Real").with_text("unit", unit.name),
        Kind::Boolean => Element::new("ssc:Boolean"),
        Kind::Integer | Kind::Enumeration(_) => Element::new("ssc:Integer"),
    };
    Element::new("ssd:Connector").with("name", name).with("kind", kind).containing([type_])
}

/// All connections: from the system's inputs, between components, to the system's outputs.
fn wires(inputs: &[Port], connections: &[Connection], outputs: &[Port]) -> Vec<Element> {
    let wire = |from: (&str, &str), to: (&str, &str)| {
        Element::new("ssd:Connection")
            .with_text("startElement", from.0)
            .with("startConnector", from.1)
            .with_text("endElement", to.0)
            .with("endConnector", to.1)
    };
    let inputs = inputs.iter().map(|port| wire(("", port.name), (port.component, port.variable)));
    let outputs = outputs.iter().map(|port| wire((port.component, port.variable), ("", port.name)));
    let inside = connections.iter().map(|Connection { from, to }| wire((from.0, &from.1), (to.0, &to.1)));
    inputs.chain(inside).chain(outputs).collect()
}

/// Every unit that the components' variables have, once.
fn units(system: &System) -> Vec<Element> {
    let mut found: Vec<&Unit> = Vec::new();
    for unit in system.components.iter().flat_map(|component| units::units(&component.model.functions.identity)) {
        if found.iter().all(|known| known.name != unit.name) {
            found.push(unit);
        }
    }
    let element = |unit: &Unit| {
        let base = units::exponents(unit).fold(Element::new("ssc:BaseUnit"), |base, (of, power)| base.with(of, power));
        Element::new("ssc:Unit").with("name", unit.name).containing([base])
    };
    found.into_iter().map(element).collect()
}

impl System {
    /// The component of this name.
    ///
    /// # Panics
    /// There is none. Systems belong to the sources.
    pub(super) fn component(&self, name: &str) -> &Component {
        let found = self.components.iter().find(|component| component.name == name);
        found.unwrap_or_else(|| panic!("{} has no component {name}", self.name))
    }
}
