//! The schemas of SSP 1.0, as far as a package of ours uses them: `SystemStructure.ssd` and
//! parameter sets, `.ssv`.
//!
//! The order of the fields is the order that the schemas prescribe.

use moris_model_description::common::units::BaseUnit;
use serde::Serialize;

/// `SystemStructureDescription`: the root of `SystemStructure.ssd`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename = "ssd:SystemStructureDescription")]
pub struct SystemStructureDescription {
    #[serde(rename = "@xmlns:ssd")]
    pub ssd: &'static str,
    #[serde(rename = "@xmlns:ssc")]
    pub ssc: &'static str,
    #[serde(rename = "@xmlns:oms")]
    pub oms: &'static str,
    #[serde(rename = "@version")]
    pub version: &'static str,
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@description")]
    pub description: String,
    #[serde(rename = "@author")]
    pub author: String,
    #[serde(rename = "@copyright")]
    pub copyright: String,
    #[serde(rename = "@license")]
    pub license: String,
    #[serde(rename = "@generationTool")]
    pub generation_tool: String,
    #[serde(rename = "@generationDateAndTime")]
    pub generation_date_and_time: String,
    #[serde(rename = "ssd:System")]
    pub system: System,
    #[serde(rename = "ssd:Units")]
    pub units: Units,
    #[serde(rename = "ssd:DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
}

/// `System`: components and how they are connected.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct System {
    #[serde(rename = "@name")]
    pub name: String,
    /// None rather than empty: the schema knows no empty lists.
    #[serde(rename = "ssd:Connectors", skip_serializing_if = "Option::is_none")]
    pub connectors: Option<Connectors>,
    #[serde(rename = "ssd:ParameterBindings", skip_serializing_if = "Option::is_none")]
    pub parameter_bindings: Option<ParameterBindings>,
    #[serde(rename = "ssd:Elements")]
    pub elements: Elements,
    #[serde(rename = "ssd:Connections")]
    pub connections: Connections,
    #[serde(rename = "ssd:Annotations")]
    pub annotations: Annotations,
}

/// `Annotations`, of which there is one: the master algorithm, which OMSimulator needs to load a
/// system.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Annotations {
    #[serde(rename = "ssc:Annotation")]
    pub annotation: Annotation,
}

/// `Annotation` for OMSimulator.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Annotation {
    /// `org.openmodelica`
    #[serde(rename = "@type")]
    pub type_: &'static str,
    #[serde(rename = "oms:Annotations")]
    pub annotations: MasterAnnotations,
}

/// `oms:Annotations`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MasterAnnotations {
    #[serde(rename = "oms:SimulationInformation")]
    pub information: SimulationInformation,
}

/// `oms:SimulationInformation`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulationInformation {
    #[serde(rename = "oms:FixedStepMaster")]
    pub master: FixedStepMaster,
}

/// `oms:FixedStepMaster`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FixedStepMaster {
    #[serde(rename = "@description")]
    pub description: &'static str,
    /// \[s\]
    #[serde(rename = "@stepSize")]
    pub step_size: f64,
    #[serde(rename = "@absoluteTolerance")]
    pub absolute_tolerance: f64,
    #[serde(rename = "@relativeTolerance")]
    pub relative_tolerance: f64,
}

/// `Connectors`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Connectors {
    #[serde(rename = "ssd:Connector")]
    pub connectors: Vec<Connector>,
}

/// `Connector`: a variable that can be connected.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Connector {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@kind")]
    pub kind: ConnectorKind,
    #[serde(rename = "$value")]
    pub type_: Type,
}

/// Which way a connector goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ConnectorKind {
    Input,
    Output,
}

/// Type of a connector.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Type {
    #[serde(rename = "ssc:Real")]
    Real {
        #[serde(rename = "@unit", skip_serializing_if = "Option::is_none")]
        unit: Option<String>,
    },
    #[serde(rename = "ssc:Integer")]
    Integer {},
    #[serde(rename = "ssc:Boolean")]
    Boolean {},
}

/// `ParameterBindings`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterBindings {
    #[serde(rename = "ssd:ParameterBinding")]
    pub bindings: Vec<ParameterBinding>,
}

/// `ParameterBinding`: a parameter set that a component, or all components of a system, start with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterBinding {
    #[serde(rename = "@source")]
    pub source: String,
}

/// `Elements`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Elements {
    #[serde(rename = "ssd:Component")]
    pub components: Vec<Component>,
}

/// `Component`: an FMU.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Component {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@description")]
    pub description: String,
    #[serde(rename = "@type")]
    pub type_: &'static str,
    #[serde(rename = "@source")]
    pub source: String,
    #[serde(rename = "@implementation")]
    pub implementation: &'static str,
    #[serde(rename = "ssd:Connectors")]
    pub connectors: Connectors,
    #[serde(rename = "ssd:ElementGeometry")]
    pub geometry: ElementGeometry,
    #[serde(rename = "ssd:ParameterBindings", skip_serializing_if = "Option::is_none")]
    pub parameter_bindings: Option<ParameterBindings>,
}

/// `ElementGeometry`: where a tool may draw the component, lower left and upper right corner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ElementGeometry {
    #[serde(rename = "@x1")]
    pub x1: f64,
    #[serde(rename = "@y1")]
    pub y1: f64,
    #[serde(rename = "@x2")]
    pub x2: f64,
    #[serde(rename = "@y2")]
    pub y2: f64,
}

/// `Connections`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Connections {
    #[serde(rename = "ssd:Connection")]
    pub connections: Vec<Connection>,
}

/// `Connection`: from one connector to another; without an element, a connector is the system's
/// own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Connection {
    #[serde(rename = "@startElement", skip_serializing_if = "Option::is_none")]
    pub start_element: Option<String>,
    #[serde(rename = "@startConnector")]
    pub start_connector: String,
    #[serde(rename = "@endElement", skip_serializing_if = "Option::is_none")]
    pub end_element: Option<String>,
    #[serde(rename = "@endConnector")]
    pub end_connector: String,
}

/// `Units`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Units {
    #[serde(rename = "ssc:Unit")]
    pub units: Vec<Unit>,
}

/// `Unit`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unit {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "ssc:BaseUnit")]
    pub base_unit: BaseUnit,
}

/// `DefaultExperiment` \[s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    pub start_time: f64,
    #[serde(rename = "@stopTime")]
    pub stop_time: f64,
}

/// `ParameterSet`: the root of a parameter set.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename = "ssv:ParameterSet")]
pub struct ParameterSet {
    #[serde(rename = "@xmlns:ssv")]
    pub ssv: &'static str,
    #[serde(rename = "@xmlns:ssc")]
    pub ssc: &'static str,
    #[serde(rename = "@version")]
    pub version: &'static str,
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@author")]
    pub author: String,
    #[serde(rename = "@copyright")]
    pub copyright: String,
    #[serde(rename = "@license")]
    pub license: String,
    #[serde(rename = "@generationTool")]
    pub generation_tool: String,
    #[serde(rename = "@generationDateAndTime")]
    pub generation_date_and_time: String,
    #[serde(rename = "ssv:Parameters")]
    pub parameters: Parameters,
    #[serde(rename = "ssv:Units")]
    pub units: Units,
}

/// `Parameters`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameters {
    #[serde(rename = "ssv:Parameter")]
    pub parameters: Vec<Parameter>,
}

/// `Parameter`: a variable's name, with its component's before it where the set is the whole
/// system's, and a value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "$value")]
    pub value: Value,
}

/// A parameter's value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Value {
    #[serde(rename = "ssv:Real")]
    Real {
        #[serde(rename = "@value")]
        value: f64,
        #[serde(rename = "@unit", skip_serializing_if = "Option::is_none")]
        unit: Option<String>,
    },
    #[serde(rename = "ssv:Integer")]
    Integer {
        #[serde(rename = "@value")]
        value: i64,
    },
    #[serde(rename = "ssv:Boolean")]
    Boolean {
        #[serde(rename = "@value")]
        value: bool,
    },
    #[serde(rename = "ssv:Enumeration")]
    Enumeration {
        #[serde(rename = "@value")]
        value: String,
    },
}

/// A unit's name; none for what has none.
pub fn unit_name(unit: &moris_interface::Unit) -> Option<String> {
    (!unit.name.is_empty()).then(|| unit.name.to_owned())
}
