//! From a model's rows to its description.

use moris_interface::{Causality, Identity, Kind, LOG_CATEGORIES_OF_FMI3, Layout, Model, Row, guid_of, start_values};

use crate::common::enumerations::{enumerations, items};
use crate::common::xml::Element;
use crate::common::{parts, units};

/// The model description of a model that is exported for co-simulation, with its own start values.
pub fn describe<M: Model>(layout: Layout) -> Element {
    describe_with::<M>(&start_values::<M>(&[]), layout)
}

/// The model description of a model that is exported for co-simulation with these start values.
/// `start` has one for each slot.
///
/// Variables are listed in the order of the slots, and a value reference is the number of a
/// variable's first slot. The parts are in the order that the schema prescribes.
pub fn describe_with<M: Model>(start: &[f64], layout: Layout) -> Element {
    let identity = M::IDENTITY;
    let variables = variable_places(&identity, layout).into_iter().map(|place| variable_element(&place, start));
    parts::root(&identity, "3.0", ("instantiationToken", layout.token(&guid_of::<M>(start))))
        .containing([co_simulation(&identity)])
        .containing(parts::unit_definitions(&identity))
        .containing(type_definitions(&identity))
        .containing([
            parts::log_categories(LOG_CATEGORIES_OF_FMI3.iter().map(|(category, text)| (category.name(), *text))),
            parts::default_experiment(&identity),
            Element::new("ModelVariables").containing(variables),
            model_structure(&identity, layout),
        ])
}

/// Name of the binary without its ending, and the capabilities of the C functions of moris-fmi, for
/// any model.
fn co_simulation(identity: &Identity) -> Element {
    Element::new("CoSimulation")
        .with("modelIdentifier", identity.name)
        .with("canBeInstantiatedOnlyOncePerProcess", false)
        .with("canGetAndSetFMUState", true)
        .with("canSerializeFMUState", true)
        .with("providesDirectionalDerivatives", false)
        .with("providesAdjointDerivatives", false)
        .with("providesPerElementDependencies", false)
        .with("canHandleVariableCommunicationStepSize", true)
        .with("maxOutputDerivativeOrder", 1)
        .with("providesIntermediateUpdate", false)
        .with("mightReturnEarlyFromDoStep", false)
        .with("hasEventMode", false)
}

/// The quantities of reals with their units, and the enumerations; none without any.
///
/// A variable's unit stands in its type. The standard allows it in the variable, too, as in the
/// description of FMI 2.0, but the importer fmi-sim rejects it there. An enumeration has no
/// description of its own, which FMPy 0.3.15 to 0.3.23 cannot read: its items and the variable
/// have theirs.
fn type_definitions(identity: &Identity) -> Option<Element> {
    let quantities = units::units(identity).into_iter().map(|unit| {
        let quantity = Element::new("Float64Type").with("name", unit.quantity).with("quantity", unit.quantity);
        units::with_nominal(units::with_display(quantity.with("unit", unit.name), unit), unit)
    });
    let enumerations = enumerations(identity).into_iter().map(|enumeration| {
        Element::new("EnumerationType").with("name", enumeration.name).containing(items(enumeration))
    });
    Element::list("TypeDefinitions", quantities.chain(enumerations).collect())
}

/// A variable of the description: one or all of a row's slots.
struct Place {
    row: &'static Row,
    name: String,
    first_slot: usize,
    /// Sizes of the array, outermost first; none for a scalar.
    dimensions: Vec<usize>,
}

fn variable_places(identity: &Identity, layout: Layout) -> Vec<Place> {
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

/// A variable; the element's name is its type. An array has a start value for
/// each element, row by row.
fn variable_element(place: &Place, start: &[f64]) -> Element {
    let Place { row, name, first_slot, dimensions } = place;
    let convert = |value: f64| match row.kind {
        Kind::Real(_) => value.to_string(),
        Kind::Integer | Kind::Enumeration(_) => (value as i32).to_string(),
        Kind::Boolean => (value != 0.0).to_string(),
    };
    // A real's type has its unit; none: dimensionless.
    let (declared_type, range) = match row.kind {
        Kind::Real(unit) => ((!unit.name.is_empty()).then_some(unit.quantity), row.range),
        Kind::Integer | Kind::Boolean => (None, row.range),
        Kind::Enumeration(enumeration) => (Some(enumeration.name), Some((1.0, enumeration.items.len() as f64))),
    };
    let (min, max) = range.unzip();
    let starts = || {
        let start = &start[*first_slot..first_slot + dimensions.iter().product::<usize>()];
        start.iter().map(|&value| convert(value)).collect::<Vec<_>>().join(" ")
    };
    let text = row_description(row, !dimensions.is_empty());
    parts::variable(element_type_name(row.kind), name, *first_slot, &text, row)
        .with_some("declaredType", declared_type)
        .with_some("min", min.map(convert))
        .with_some("max", max.map(convert))
        .with_some("start", parts::has_start(row).then(starts))
        .containing(dimensions.iter().map(|size| Element::new("Dimension").with("start", size)))
}

/// The row's sentence and, for an array whose elements have components, their names: the array's
/// name does not say them.
fn row_description(row: &Row, is_array: bool) -> String {
    match row.components {
        components if is_array && components.len() > 1 => {
            format!("{} Components: {}.", row.text(), components.join(", "))
        }
        _ => row.text().to_owned(),
    }
}

/// Elements, then components; a row that has but one of either has no dimension for it.
pub(super) fn dimensions(row: &Row) -> Vec<usize> {
    [row.count, row.components.len()].into_iter().filter(|&size| size > 1).collect()
}

/// The name of the type of a row's elements.
pub(super) fn element_type_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Real(_) => "Float64",
        Kind::Integer => "Int32",
        Kind::Boolean => "Boolean",
        Kind::Enumeration(_) => "Enumeration",
    }
}

/// As in FMI 2.0: at communication points the outputs depend on nothing, during initialisation on
/// what their rows say.
fn model_structure(identity: &Identity, layout: Layout) -> Element {
    let places = variable_places(identity, layout);
    let unknowns = |element: &'static str, dependencies: &dyn Fn(&Row) -> String| -> Vec<Element> {
        let outputs = places.iter().filter(|place| place.row.causality == Causality::Output);
        let unknown = |place: &Place| {
            Element::new(element).with("valueReference", place.first_slot).with("dependencies", dependencies(place.row))
        };
        outputs.map(unknown).collect()
    };
    let at_start = |output: &Row| {
        let knowns = places.iter().filter(|place| output.starts_depending_on(place.row));
        knowns.map(|place| place.first_slot.to_string()).collect::<Vec<_>>().join(" ")
    };
    Element::new("ModelStructure")
        .containing(unknowns("Output", &|_| String::new()))
        .containing(unknowns("InitialUnknown", &at_start))
}
