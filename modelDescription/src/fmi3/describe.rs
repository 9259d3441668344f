//! From a model's rows to its description.

use moris_interface::{Causality, Identity, Kind, LOG_CATEGORIES_OF_FMI3, Layout, Model, Row, guid_of, start_values};

use super::model_description::{CoSimulation, ModelDescription, ModelVariables};
use super::model_structure::{ModelStructure, Unknown};
use super::type_definitions::{TypeDefinition, TypeDefinitions};
use super::variable::{Dimension, TypedVariable, Variable};
use crate::common::attributes::Initial;
use crate::common::enumerations::enumerations;
use crate::common::origin;
use crate::common::parts::{LogCategories, UnitDefinitions};
use crate::common::units::units;

/// The model description of a model that is exported for co-simulation, with its own start values.
pub fn describe<M: Model>(layout: Layout) -> ModelDescription {
    describe_with::<M>(&start_values::<M>(&[]), layout)
}

/// The model description of a model that is exported for co-simulation with these start values.
/// `start` has one for each slot.
///
/// Variables are listed in the order of the slots, and a value reference is the number of a
/// variable's first slot.
pub fn describe_with<M: Model>(start: &[f64], layout: Layout) -> ModelDescription {
    let identity = M::IDENTITY;
    ModelDescription {
        fmi_version: "3.0".to_owned(),
        model_name: identity.name.to_owned(),
        instantiation_token: layout.token(&guid_of::<M>(start)),
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
        log_categories: LogCategories::of(
            LOG_CATEGORIES_OF_FMI3.iter().map(|(category, text)| (category.name(), *text)),
        ),
        default_experiment: (&identity).into(),
        model_variables: ModelVariables { variables: variables(&identity, start, layout) },
        model_structure: model_structure(&identity, layout),
    }
}

/// Capabilities of the C functions of moris-fmi, for any model.
fn co_simulation(identity: &Identity) -> CoSimulation {
    CoSimulation {
        model_identifier: identity.name.to_owned(),
        can_be_instantiated_only_once_per_process: false,
        can_get_and_set_fmu_state: true,
        can_serialize_fmu_state: true,
        provides_directional_derivatives: false,
        provides_adjoint_derivatives: false,
        provides_per_element_dependencies: false,
        can_handle_variable_communication_step_size: true,
        max_output_derivative_order: 1,
        provides_intermediate_update: false,
        might_return_early_from_do_step: false,
        has_event_mode: false,
    }
}

/// The quantities and the enumerations; none without any.
fn type_definitions(identity: &Identity) -> Option<TypeDefinitions> {
    let quantities = units(identity).into_iter().map(|unit| TypeDefinition::Float64Type(unit.into()));
    let enumerations = enumerations(identity).into_iter().map(|it| TypeDefinition::EnumerationType(it.into()));
    let types: Vec<TypeDefinition> = quantities.chain(enumerations).collect();
    (!types.is_empty()).then_some(TypeDefinitions { types })
}

/// A variable of the description: one or all of a row's slots.
struct Place {
    row: &'static Row,
    name: String,
    first_slot: usize,
    dimensions: Vec<Dimension>,
}

fn places(identity: &Identity, layout: Layout) -> Vec<Place> {
    let slots = identity.listed_slots().into_iter();
    match layout {
        Layout::Scalars => slots
            .map(|slot| Place {
                row: identity.row(slot),
                name: identity.variable_name(slot),
                first_slot: slot,
                dimensions: Vec::new(),
            })
            .collect(),
        Layout::Arrays => slots
            .filter(|&slot| identity.slots[slot].element == 0)
            .map(|slot| {
                let row = identity.row(slot);
                Place { row, name: row.array_name(), first_slot: slot, dimensions: dimensions(row) }
            })
            .collect(),
    }
}

fn variables(identity: &Identity, start: &[f64], layout: Layout) -> Vec<TypedVariable> {
    places(identity, layout).into_iter().map(|place| typed_variable(place, start)).collect()
}

fn typed_variable(place: Place, start: &[f64]) -> TypedVariable {
    match place.row.kind {
        Kind::Real(unit) => TypedVariable::Float64(Variable {
            declared_type: (!unit.name.is_empty()).then(|| unit.quantity.to_owned()),
            ..variable(place, start, |value| value)
        }),
        Kind::Integer => TypedVariable::Int32(variable(place, start, |value| value as i32)),
        Kind::Boolean => TypedVariable::Boolean(variable(place, start, |value| value != 0.0)),
        Kind::Enumeration(enumeration) => TypedVariable::Enumeration(Variable {
            declared_type: Some(enumeration.name.to_owned()),
            min: Some(1),
            max: Some(enumeration.items.len() as i64),
            ..variable(place, start, |value| value as i64)
        }),
    }
}

/// Attributes that variables of all types have; `convert` makes values from those of slots.
fn variable<T>(place: Place, start: &[f64], convert: fn(f64) -> T) -> Variable<T> {
    let Place { row, name, first_slot, dimensions } = place;
    let size = dimensions.iter().map(|dimension| dimension.start as usize).product::<usize>();
    let start = &start[first_slot..first_slot + size];
    // Outputs are calculated and the time is the host's: neither may have a start value.
    let has_start = matches!(row.causality, Causality::Input | Causality::Parameter);
    Variable {
        name,
        value_reference: first_slot as u32,
        description: description(row, !dimensions.is_empty()),
        causality: row.causality,
        variability: row.variability,
        initial: (row.causality == Causality::Output).then_some(Initial::Calculated),
        declared_type: None,
        min: row.range.map(|(min, _)| convert(min)),
        max: row.range.map(|(_, max)| convert(max)),
        start: has_start.then(|| start.iter().map(|&value| convert(value)).collect()),
        dimensions,
    }
}

/// The row's sentence and, for an array whose elements have components, their names: the array's
/// name does not say them.
fn description(row: &Row, is_array: bool) -> String {
    match row.components {
        components if is_array && components.len() > 1 => {
            format!("{} Components: {}.", row.text(), components.join(", "))
        }
        _ => row.text().to_owned(),
    }
}

/// Elements, then components; a row that has but one of either has no dimension for it.
pub(super) fn dimensions(row: &Row) -> Vec<Dimension> {
    let sizes = [row.count, row.components.len()];
    sizes.into_iter().filter(|&size| size > 1).map(|size| Dimension { start: size as u64 }).collect()
}

/// As in FMI 2.0: at communication points the outputs depend on nothing, during initialisation
/// possibly on everything.
fn model_structure(identity: &Identity, layout: Layout) -> ModelStructure {
    let outputs = |dependencies: Option<Vec<u32>>| {
        places(identity, layout)
            .iter()
            .filter(|place| place.row.causality == Causality::Output)
            .map(|place| Unknown { value_reference: place.first_slot as u32, dependencies: dependencies.clone() })
            .collect()
    };
    ModelStructure { outputs: outputs(Some(vec![])), initial_unknowns: outputs(None) }
}
