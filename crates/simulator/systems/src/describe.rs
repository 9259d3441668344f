//! From a system to its description.

use moris_interface::{Causality, Identity, Kind};
use moris_model_description::fmi2::ModelDescription;
use quick_xml::se::Serializer;
use serde::Serialize;

use crate::parameter_set::ByComponent;
use crate::schema;
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
pub fn describe(system: &System, form: Form, parameters: &ByComponent) -> schema::SystemStructureDescription {
    let connections = (system.connections)();
    let (inputs, outputs) = if form == Form::Whole { (system.inputs, system.outputs) } else { (&[][..], &[][..]) };
    let origin = origin(system);
    schema::SystemStructureDescription {
        ssd: SSD,
        ssc: SSC,
        oms: OMS,
        version: "1.0",
        name: system.name.to_owned(),
        description: system.text.to_owned(),
        author: origin.author,
        copyright: origin.copyright,
        license: origin.license,
        generation_tool: origin.generation_tool,
        generation_date_and_time: origin.generation_date_and_time,
        system: schema::System {
            name: "simulator".to_owned(),
            connectors: (form == Form::Whole).then(|| own_connectors(system)),
            parameter_bindings: (form == Form::Whole && !parameters.is_empty()).then(|| bound_to(system.name)),
            elements: schema::Elements {
                components: (0..)
                    .zip(system.components)
                    .map(|(number, part)| schema::Component {
                        parameter_bindings: (form == Form::Flat
                            && parameters.iter().any(|(name, _)| name == part.name))
                        .then(|| bound_to(part.name)),
                        ..component(part, number, &connections, inputs, outputs)
                    })
                    .collect(),
            },
            connections: schema::Connections { connections: wires(inputs, &connections, outputs) },
            annotations: master(system),
        },
        units: units(system),
        default_experiment: schema::DefaultExperiment { start_time: 0.0, stop_time: system.stop_time },
    }
}

/// A parameter set with these parameters.
pub fn parameter_set(system: &System, parameters: Vec<schema::Parameter>) -> schema::ParameterSet {
    let origin = origin(system);
    schema::ParameterSet {
        ssv: SSV,
        ssc: SSC,
        version: "1.0",
        name: system.name.to_owned(),
        author: origin.author,
        copyright: origin.copyright,
        license: origin.license,
        generation_tool: origin.generation_tool,
        generation_date_and_time: origin.generation_date_and_time,
        parameters: schema::Parameters { parameters },
        units: units(system),
    }
}

/// The text of a file.
///
/// # Panics
/// A part of it has no XML form. All parts of the schemas have.
pub fn to_xml(root: &impl Serialize) -> Vec<u8> {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
    let mut serializer = Serializer::new(&mut text);
    serializer.indent(' ', 2);
    root.serialize(serializer).expect("every part of a system has an XML form");
    text.push('\n');
    text.into_bytes()
}

/// Who made the first of the components has made the system.
fn origin(system: &System) -> ModelDescription {
    system.components[0].model.description()
}

/// A binding to the parameter set of this name.
fn bound_to(name: &str) -> schema::ParameterBindings {
    schema::ParameterBindings { bindings: vec![schema::ParameterBinding { source: parameters_path(name) }] }
}

/// The system's own connectors, inputs first, each of the type of the component's variable that it
/// is.
fn own_connectors(system: &System) -> schema::Connectors {
    let own = |kind: schema::ConnectorKind| {
        move |port: &Port| {
            let identity = system.component(port.component).model.functions.identity;
            schema::Connector { name: port.name.to_owned(), ..connector(&identity, port.variable, kind) }
        }
    };
    let inputs = system.inputs.iter().map(own(schema::ConnectorKind::Input));
    schema::Connectors {
        connectors: inputs.chain(system.outputs.iter().map(own(schema::ConnectorKind::Output))).collect(),
    }
}

/// The annotation without which OMSimulator does not load a system: a master algorithm with a fixed
/// step.
fn master(system: &System) -> schema::Annotations {
    let master = schema::FixedStepMaster {
        description: "oms-ma",
        step_size: system.step_size,
        absolute_tolerance: 1e-4,
        relative_tolerance: 1e-4,
    };
    let information = schema::SimulationInformation { master };
    let annotations = schema::MasterAnnotations { information };
    schema::Annotations { annotation: schema::Annotation { type_: "org.openmodelica", annotations } }
}

/// A component with the connectors that are connected, to another or to the system's own, or shown.
fn component(
    component: &Component,
    number: i32,
    connections: &[Connection],
    inputs: &[Port],
    outputs: &[Port],
) -> schema::Component {
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
    let kind = |slot: usize| {
        let name = identity.variable_name(slot);
        match identity.row(slot).causality {
            Causality::Input if has_input(&name) => Some((name, schema::ConnectorKind::Input)),
            Causality::Output if has_output(&name) => Some((name, schema::ConnectorKind::Output)),
            _ => None,
        }
    };
    let connectors = (0..identity.slots.len()).filter_map(kind);
    let left = f64::from(number) * (BOX + GAP);
    schema::Component {
        name: component.name.to_owned(),
        description: component.model.title.to_owned(),
        type_: "application/x-fmu-sharedlibrary",
        source: fmu_path(component),
        implementation: "CoSimulation",
        connectors: schema::Connectors {
            connectors: connectors.map(|(name, kind)| connector(&identity, &name, kind)).collect(),
        },
        geometry: schema::ElementGeometry { x1: left, y1: 0.0, x2: left + BOX, y2: BOX },
        parameter_bindings: None,
    }
}

/// A connector for a model's variable.
fn connector(identity: &Identity, name: &str, kind: schema::ConnectorKind) -> schema::Connector {
    let slot = identity.slot(name).unwrap_or_else(|| panic!("{} has no variable {name}", identity.name));
    let type_ = match identity.row(slot).kind {
        Kind::Real(unit) => schema::Type::Real { unit: schema::unit_name(unit) },
        Kind::Boolean => schema::Type::Boolean {},
        Kind::Integer | Kind::Enumeration(_) => schema::Type::Integer {},
    };
    schema::Connector { name: name.to_owned(), kind, type_ }
}

/// All connections: from the system's inputs, between components, to the system's outputs.
fn wires(inputs: &[Port], connections: &[Connection], outputs: &[Port]) -> Vec<schema::Connection> {
    let wire = |from: (Option<&str>, &str), to: (Option<&str>, &str)| schema::Connection {
        start_element: from.0.map(str::to_owned),
        start_connector: from.1.to_owned(),
        end_element: to.0.map(str::to_owned),
        end_connector: to.1.to_owned(),
    };
    let inputs = inputs.iter().map(|port| wire((None, port.name), (Some(port.component), port.variable)));
    let outputs = outputs.iter().map(|port| wire((Some(port.component), port.variable), (None, port.name)));
    let inside = connections.iter().map(|Connection { from, to }| wire((Some(from.0), &from.1), (Some(to.0), &to.1)));
    inputs.chain(inside).chain(outputs).collect()
}

/// Every unit that the components' variables have, once.
fn units(system: &System) -> schema::Units {
    let mut units: Vec<schema::Unit> = Vec::new();
    for row in system.components.iter().flat_map(|component| component.model.functions.identity.rows) {
        if let Kind::Real(unit) = row.kind
            && !unit.name.is_empty()
            && units.iter().all(|known| known.name != unit.name)
        {
            let unit = moris_model_description::common::units::Unit::from(unit);
            units.push(schema::Unit { name: unit.name, base_unit: unit.base_unit });
        }
    }
    schema::Units { units }
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
