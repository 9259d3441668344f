//! From a model's rows to its description.

use moris_fmi::LOG_CATEGORIES;
use moris_interface::{Causality, Identity, Kind, Model, guid_of, start_values};

use crate::common::units::{RealAttributes, Unit};
use crate::fmi2::model_description::{
    Category, CoSimulation, DefaultExperiment, LogCategories, ModelDescription, ModelVariables, TypeDefinitions,
    UnitDefinitions,
};
use crate::fmi2::model_structure::{ModelStructure, Unknowns};
use crate::fmi2::scalar_variable::{Initial, ScalarVariable, Values};
use crate::fmi2::type_definitions::SimpleType;

/// Whom the FMU is from and who may use it.
const AUTHOR: &str = "MORIS washout contributors";
const COPYRIGHT: &str = "Copyright (c) MORIS washout contributors";
const LICENSE: &str = "MIT OR Apache-2.0";
const GENERATION_TOOL: &str = concat!("MORIS washout model-description ", env!("CARGO_PKG_VERSION"));

/// The date of the interface, not of the build: the same sources give the same file.
const GENERATION_DATE_AND_TIME: &str = "2026-01-01T00:00:00Z";

/// The model description of a model that is exported for co-simulation, with its own start values.
pub fn describe<M: Model>() -> ModelDescription {
    describe_with::<M>(&start_values::<M>(&[]))
}

/// The model description of a model that is exported for co-simulation with these start
/// values, one for each slot.
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
        author: AUTHOR.to_owned(),
        version: identity.version.to_owned(),
        copyright: COPYRIGHT.to_owned(),
        license: LICENSE.to_owned(),
        generation_tool: GENERATION_TOOL.to_owned(),
        generation_date_and_time: GENERATION_DATE_AND_TIME.to_owned(),
        variable_naming_convention: "structured".to_owned(),
        co_simulation: co_simulation(&identity),
        unit_definitions: unit_definitions(&identity),
        type_definitions: type_definitions(&identity),
        log_categories: log_categories(),
        default_experiment: DefaultExperiment {
            start_time: 0.0,
            stop_time: identity.stop_time,
            step_size: identity.step_size,
        },
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
    }
}

/// Every unit that a row has, once, in the order in which they appear; with the unit for display
/// that any of these rows has.
fn unit_definitions(identity: &Identity) -> Option<UnitDefinitions> {
    let mut units: Vec<Unit> = Vec::new();
    for row in identity.rows {
        let Kind::Real(unit) = row.kind else { continue };
        let unit = Unit::from(unit);
        match units.iter_mut().find(|known| known.name == unit.name) {
            Some(known) => known.display_unit = known.display_unit.take().or(unit.display_unit),
            None if unit.name.is_empty() => {}
            None => units.push(unit),
        }
    }
    (!units.is_empty()).then_some(UnitDefinitions { units })
}

/// Every enumeration that a row has, once, in the order in which they appear.
fn type_definitions(identity: &Identity) -> Option<TypeDefinitions> {
    let mut types: Vec<SimpleType> = Vec::new();
    for row in identity.rows {
        if let Kind::Enumeration(enumeration) = row.kind
            && types.iter().all(|known| known.name != enumeration.name)
        {
            types.push(enumeration.into());
        }
    }
    (!types.is_empty()).then_some(TypeDefinitions { types })
}

fn log_categories() -> LogCategories {
    let category =
        |&(name, description): &(&str, &str)| Category { name: name.to_owned(), description: description.to_owned() };
    LogCategories { categories: LOG_CATEGORIES.iter().map(category).collect() }
}

fn scalar_variable(identity: &Identity, slot: usize, start: f64) -> ScalarVariable {
    let row = identity.row(slot);
    // Outputs are calculated and the time is the host's: neither may have a start value.
    let has_start = matches!(row.causality, Causality::Input | Causality::Parameter);
    ScalarVariable {
        name: identity.variable_name(slot),
        value_reference: slot as u32,
        description: row.text().to_owned(),
        causality: row.causality.into(),
        variability: row.variability.into(),
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

/// At communication points the outputs depend on no input: they change only in a step, and so a
/// host knows that there is no algebraic loop. During initialisation they are those of the model at
/// rest, and what that depends on is the model's affair (the washout's felt force follows the
/// rider's lean): no dependencies are given, which means on all that is known.
fn model_structure(identity: &Identity) -> ModelStructure {
    let is_output = |&(_, slot): &(u32, usize)| identity.row(slot).causality == Causality::Output;
    let outputs: Vec<u32> = (1..).zip(identity.listed_slots()).filter(is_output).map(|(index, _)| index).collect();
    ModelStructure {
        outputs: Unknowns::all_with(&outputs, Some(&[])),
        initial_unknowns: Unknowns::all_with(&outputs, None),
    }
}
