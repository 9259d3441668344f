//! From a model's rows to its description.

use moris_interface::{Causality, Identity, Kind, LOG_CATEGORIES, Model, Row, guid_of, start_values};

use crate::common::enumerations::{enumerations, items};
use crate::common::xml::Element;
use crate::common::{parts, units};

/// The model description of a model that is exported for co-simulation, with its own start values.
pub fn describe<M: Model>() -> Element {
    describe_with::<M>(&start_values::<M>(&[]))
}

/// The model description of a model that is exported for co-simulation with these start values.
/// `start` has one for each slot.
///
/// Variables are listed as [`Identity::listed_slots`] orders them, and a value
/// reference is a slot's number. The parts are in the order that the schema prescribes.
pub fn describe_with<M: Model>(start: &[f64]) -> Element {
    let identity = M::IDENTITY;
    let variables = identity.listed_slots().into_iter().map(|slot| scalar_variable(&identity, slot, start[slot]));
    // Exactly "2.0", whatever the revision of the standard.
    parts::root(&identity, "2.0", ("guid", guid_of::<M>(start)))
        .containing([co_simulation(&identity)])
        .containing(parts::unit_definitions(&identity))
        .containing(type_definitions(&identity))
        .containing([
            parts::log_categories(LOG_CATEGORIES.iter().copied()),
            parts::default_experiment(&identity),
            Element::new("ModelVariables").containing(variables),
            model_structure(&identity),
        ])
}

/// The description of an FMU with sources, of which this file is the one to compile: its name in
/// the directory `sources`.
#[must_use]
pub fn with_source_file(mut description: Element, file: &str) -> Element {
    let files = Element::new("SourceFiles").containing([Element::new("File").with("name", file)]);
    let co_simulation = description.children.iter_mut().find(|part| part.name == "CoSimulation");
    co_simulation.expect("every description has the part").children.push(files);
    description
}

/// Name of the binary without its ending, and the capabilities of the C functions of moris-fmi, for
/// any model.
fn co_simulation(identity: &Identity) -> Element {
    Element::new("CoSimulation")
        .with("modelIdentifier", identity.name)
        .with("canHandleVariableCommunicationStepSize", true)
        // Input derivatives are supported.
        .with("canInterpolateInputs", true)
        .with("maxOutputDerivativeOrder", 1)
        .with("canBeInstantiatedOnlyOncePerProcess", false)
        // The callbacks for memory are not called.
        .with("canNotUseMemoryManagementFunctions", true)
        .with("canGetAndSetFMUstate", true)
        .with("canSerializeFMUstate", true)
        .with("providesDirectionalDerivative", false)
}

/// The enumerations; none without any.
fn type_definitions(identity: &Identity) -> Option<Element> {
    let simple_type = |enumeration: &'static moris_interface::Enumeration| {
        Element::new("SimpleType")
            .with("name", enumeration.name)
            .with("description", enumeration.text.trim())
            .containing([Element::new("Enumeration").containing(items(enumeration))])
    };
    Element::list("TypeDefinitions", enumerations(identity).into_iter().map(simple_type).collect())
}

fn scalar_variable(identity: &Identity, slot: usize, start: f64) -> Element {
    let row = identity.row(slot);
    let values = values(row, parts::has_start(row).then_some(start));
    parts::variable("ScalarVariable", &identity.variable_name(slot), slot, row.text(), row).containing([values])
}

/// A variable's type, with what that type's values have.
fn values(row: &Row, start: Option<f64>) -> Element {
    let (min, max) = row.range.unzip();
    match row.kind {
        Kind::Real(unit) => {
            let real = Element::new("Real").with_text("quantity", unit.quantity);
            // No unit: dimensionless.
            let real = units::with_display(real.with_text("unit", unit.name), unit);
            units::with_nominal(real.with_some("min", min).with_some("max", max), unit).with_some("start", start)
        }
        Kind::Integer => Element::new("Integer")
            .with_some("min", min.map(|min| min as i32))
            .with_some("max", max.map(|max| max as i32))
            .with_some("start", start.map(|value| value as i32)),
        Kind::Boolean => Element::new("Boolean").with_some("start", start.map(|value| value != 0.0)),
        Kind::Enumeration(enumeration) => Element::new("Enumeration")
            .with("declaredType", enumeration.name)
            .with("min", 1)
            .with("max", enumeration.items.len())
            .with_some("start", start.map(|value| value as i32)),
    }
}

/// At communication points the outputs depend on no input: they change only in a step. A host
/// therefore knows that there is no algebraic loop.
///
/// During initialisation the outputs are those of the model at rest. The model decides what they
/// depend on: the washout's felt force follows the rider's lean. No dependencies are given there,
/// which means on all that is known.
fn model_structure(identity: &Identity) -> Element {
    // A variable's index is its place in the list, from 1.
    let unknowns = |list: &'static str, dependencies: Option<&str>| {
        let outputs =
            (1..).zip(identity.listed_slots()).filter(|&(_, slot)| identity.row(slot).causality == Causality::Output);
        let unknown = |(index, _): (u32, usize)| {
            Element::new("Unknown").with("index", index).with_some("dependencies", dependencies)
        };
        Element::list(list, outputs.map(unknown).collect())
    };
    Element::new("ModelStructure")
        .containing(unknowns("Outputs", Some("")))
        .containing(unknowns("InitialUnknowns", None))
}
