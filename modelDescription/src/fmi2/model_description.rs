//! The root of the file, and the parts of it that are small.

use serde::{Deserialize, Serialize};

use super::model_structure::ModelStructure;
use super::scalar_variable::ScalarVariable;
use super::type_definitions::SimpleType;
use crate::common::parts::{DefaultExperiment, LogCategories, UnitDefinitions};

/// `fmiModelDescription`: the order of the fields is the order that the schema prescribes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "fmiModelDescription")]
pub struct ModelDescription {
    /// Exactly "2.0", whatever the revision of the standard.
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: String,
    #[serde(rename = "@modelName")]
    pub model_name: String,
    /// Identifies the description as the binary's own.
    #[serde(rename = "@guid")]
    pub guid: String,
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
    /// "structured": names have dots and indices.
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
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    /// True if input derivatives are supported.
    #[serde(rename = "@canInterpolateInputs")]
    pub can_interpolate_inputs: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    /// True: the callbacks for memory are not called.
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    pub provides_directional_derivative: bool,
    /// None rather than empty: the schema knows no empty lists.
    #[serde(rename = "SourceFiles", skip_serializing_if = "Option::is_none")]
    pub source_files: Option<SourceFiles>,
}

/// `SourceFiles`: the files to compile, in an FMU with sources.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SourceFiles {
    #[serde(rename = "File")]
    pub files: Vec<SourceFile>,
}

/// `File`, by its name in the directory `sources`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SourceFile {
    #[serde(rename = "@name")]
    pub name: String,
}

/// `TypeDefinitions`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TypeDefinitions {
    #[serde(rename = "SimpleType")]
    pub types: Vec<SimpleType>,
}

/// `ModelVariables`: a variable's index is its place in this list, from 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelVariables {
    #[serde(rename = "ScalarVariable")]
    pub variables: Vec<ScalarVariable>,
}
