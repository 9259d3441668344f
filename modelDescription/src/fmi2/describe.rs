//! From a model's rows to its description.

use moris_interface::{Causality, Identity, Kind, LOG_CATEGORIES, Model, guid_of, start_values};

use super::model_description::{CoSimulation, ModelDescription, ModelVariables, TypeDefinitions};
use super::model_structure::{ModelStructure, Unknowns};
use super::scalar_variable::{ScalarVariable, Values};
use super::type_definitions::SimpleType;
use crate::common::attributes::Initial;
use crate::common::enumerations::enumerations;
use crate::common::origin;
use crate::common::parts::{LogCategories, UnitDefinitions};
use crate::common::units::RealAttributes;

/// The model description of a model that is exported for co-simulation, with its own start values.
pub fn describe<M: Model>() -> ModelDescription {
    describe_with::<M>(&start_values::<M>(&[]))
}

/// The model description of a model that is exported for co-simulation with these start values.
/// `start` has one for each slot.
///
/// Variables are listed as [`Identity::listed_slots`] orders them, and a value
/// reference is a slot's number.
pub fn describe_with<M: Model>(start: &[f64]) -> ModelDescription {
    let identity = M::IDENTITY;
    ModelDescription {
        fmi_version: "2.0".to_owned(),
        model_name: identity.name.to_owned(),
        guid: guid_of::<M>(start),
        description: identity.text.to_owned(),
        author: origin::AUTHOR.to_owned(),
        version: identity.version.to_owned(),
        copyright: origin::COPYRIGHT.to_owned(),
        license: origin::LICENSE.to_owned(),
        generation_tool: origin::GENERATION_TOOL.to_owned(),
        generation_date_and_time: origin::GENERATION_DATE_AND_TIME.to_owned(),
        variable_naming_convention: origin::VARIABLE_NAMING_CONVENTION.to_owned(),
        co_simulation: co_simulation(&identity),
        unit_definitions: UnitDefinitions::of(&identity),
        type_definitions: type_definitions(&identity),
        log_categories: LogCategories::of(LOG_CATEGORIES.iter().copied()),
        default_experiment: (&identity).into(),
        model_variables: ModelVariables {
            variables: (identity.listed_slots().into_iter())
                .map(|slot| scalar_variable(&identity, slot, start[slot]))
                .collect(),
        },
        model_structure: model_structure(&identity),
    }
}

/// Capabilities of the C functions of moris-fmi, for any model.
fn co_simulation(identity: &Identity) -> CoSimulation {
    CoSimulation {
        model_identifier: identity.name.to_owned(),
        can_handle_variable_communication_step_size: true,
        can_interpolate_inputs: true,
        max_output_derivative_order: 1,
        can_be_instantiated_only_once_per_process: false,
        can_not_use_memory_management_functions: true,
        can_get_and_set_fmu_state: true,
        can_serialize_fmu_state: true,
        provides_directional_derivative: false,
        source_files: None,
    }
}

/// The enumerations; none without any.
fn type_definitions(identity: &Identity) -> Option<TypeDefinitions> {
    let types: Vec<SimpleType> = enumerations(identity).into_iter().map(SimpleType::from).collect();
    (!types.is_empty()).then_some(TypeDefinitions { types })
}

fn scalar_variable(identity: &Identity, slot: usize, start: f64) -> ScalarVariable {
    let row = identity.row(slot);
    // Outputs are calculated and the time is the host's: neither may have a start value.
    let has_start = matches!(row.causality, Causality::Input | Causality::Parameter);
    ScalarVariable {
        name: identity.variable_name(slot),
        value_reference: slot as u32,
        description: row.text().to_owned(),
        causality: row.causality,
        variability: row.variability,
        initial: (row.causality == Causality::Output).then_some(Initial::Calculated),
        values: values(row.kind, row.range, has_start.then_some(start)),
    }
}

fn values(kind: Kind, range: Option<(f64, f64)>, start: Option<f64>) -> Values {
    match kind {
        Kind::Real(unit) => {
            let RealAttributes { quantity, unit, display_unit, nominal } = unit.into();
            let (min, max) = range.unzip();
            Values::Real { quantity, unit, display_unit, min, max, nominal, start }
        }
        Kind::Integer => Values::Integer {
            min: range.map(|(min, _)| min as i32),
            max: range.map(|(_, max)| max as i32),
            start: start.map(|value| value as i32),
        },
        Kind::Boolean => Values::Boolean { start: start.map(|value| value != 0.0) },
        Kind::Enumeration(enumeration) => Values::Enumeration {
            declared_type: enumeration.name.to_owned(),
            min: 1,
            max: enumeration.items.len() as i32,
            start: start.map(|value| value as i32),
        },
    }
}

/// At communication points the outputs depend on no input: they change only in a step. A host
/// therefore knows that there is no algebraic loop.
///
/// During initialisation the outputs are those of the model at rest. The model decides what they
/// depend on: the washout's felt force follows the rider's lean. No dependencies are given there,
/// which means on all that is known.
fn model_structure(identity: &Identity) -> ModelStructure {
    let is_output = |&(_, slot): &(u32, usize)| identity.row(slot).causality == Causality::Output;
    let outputs: Vec<u32> = (1..).zip(identity.listed_slots()).filter(is_output).map(|(index, _)| index).collect();
    ModelStructure {
        outputs: Unknowns::all_with(&outputs, Some(&[])),
        initial_unknowns: Unknowns::all_with(&outputs, None),
    }
}
