//! The root of the file, and the parts of it that are small.

use serde::{Deserialize, Serialize};

use super::model_structure::ModelStructure;
use super::type_definitions::TypeDefinitions;
use super::variable::TypedVariable;
use crate::common::parts::{DefaultExperiment, LogCategories, UnitDefinitions};

/// `fmiModelDescription`: the order of the fields is the order that the schema prescribes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "fmiModelDescription")]
pub struct ModelDescription {
    /// "3.0"
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: String,
    #[serde(rename = "@modelName")]
    pub model_name: String,
    /// Identifies the description as the binary's own.
    #[serde(rename = "@instantiationToken")]
    pub instantiation_token: String,
    #[serde(rename = "@description")]
    pub description: String,
    #[serde(rename = "@author")]
    pub author: String,
    #[serde(rename = "@version")]
    pub version: String,
    #[serde(rename = "@copyright")]
    pub copyright: String,
    #[serde(rename = "@license")]
    pub license: String,
    #[serde(rename = "@generationTool")]
    pub generation_tool: String,
    /// `YYYY-MM-DDThh:mm:ssZ`.
    #[serde(rename = "@generationDateAndTime")]
    pub generation_date_and_time: String,
    /// "structured": names have dots.
    #[serde(rename = "@variableNamingConvention")]
    pub variable_naming_convention: String,
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation,
    /// None rather than empty: the schema knows no empty lists.
    #[serde(rename = "UnitDefinitions", skip_serializing_if = "Option::is_none")]
    pub unit_definitions: Option<UnitDefinitions>,
    /// None rather than empty: the schema knows no empty lists.
    #[serde(rename = "TypeDefinitions", skip_serializing_if = "Option::is_none")]
    pub type_definitions: Option<TypeDefinitions>,
    #[serde(rename = "LogCategories")]
    pub log_categories: LogCategories,
    #[serde(rename = "DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
    #[serde(rename = "ModelVariables")]
    pub model_variables: ModelVariables,
    #[serde(rename = "ModelStructure")]
    pub model_structure: ModelStructure,
}

/// `CoSimulation`: what the binary is called and what it can do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoSimulation {
    /// The name of the shared library, without its ending.
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: String,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canGetAndSetFMUState")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUState")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivatives")]
    pub provides_directional_derivatives: bool,
    #[serde(rename = "@providesAdjointDerivatives")]
    pub provides_adjoint_derivatives: bool,
    #[serde(rename = "@providesPerElementDependencies")]
    pub provides_per_element_dependencies: bool,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    #[serde(rename = "@providesIntermediateUpdate")]
    pub provides_intermediate_update: bool,
    #[serde(rename = "@mightReturnEarlyFromDoStep")]
    pub might_return_early_from_do_step: bool,
    #[serde(rename = "@hasEventMode")]
    pub has_event_mode: bool,
}

/// `ModelVariables`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelVariables {
    #[serde(rename = "$value")]
    pub variables: Vec<TypedVariable>,
}
