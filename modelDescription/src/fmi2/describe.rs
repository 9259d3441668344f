//! From a model's rows to its description.

use moris_interface::units::ONE;
use moris_interface::{Causality, Identity, Kind, LOG_CATEGORIES, Model, Row, Types, guid_of, start_values};

use crate::common::enumerations::{enumerations, items};
use crate::common::xml::Element;
use crate::common::{parts, units};

/// The model description of a model that is exported for co-simulation, with its own start values.
pub fn describe<M: Model>() -> Element {
    describe_with::<M>(&start_values::<M>(&[]), Types::Own)
}

/// The model description of a model that is exported for co-simulation with these start values, its
/// variables of these types. `start` has one for each slot.
///
/// Variables are listed as [`Identity::listed_slots`] orders them, and a value
/// reference is a slot's number. The parts are in the order that the schema prescribes.
pub fn describe_with<M: Model>(start: &[f64], types: Types) -> Element {
    let identity = M::IDENTITY;
    let variable = |slot| scalar_variable(&identity, slot, start[slot], types);
    let variables = identity.listed_slots().into_iter().map(variable);
    // Exactly "2.0", whatever the revision of the standard.
    parts::root(&identity, "2.0", ("guid", types.token(&guid_of::<M>(start))))
        .containing([co_simulation(&identity)])
        .containing(parts::unit_definitions(&identity))
        .containing(type_definitions(&identity).filter(|_| types == Types::Own))
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

fn scalar_variable(identity: &Identity, slot: usize, start: f64, types: Types) -> Element {
    let row = identity.row(slot);
    let start = parts::has_start(row).then_some(start);
    let (text, values) = match types {
        Types::Own => (row.text().to_owned(), type_values(row, start)),
        Types::Reals => (text_with_values(row), real_type(row, start)),
    };
    parts::variable("ScalarVariable", &identity.variable_name(slot), slot, &text, row).containing([values])
}

/// A variable's type, with what that type's values have.
fn type_values(row: &Row, start: Option<f64>) -> Element {
    let (min, max) = row.range.unzip();
    match row.kind {
        Kind::Real(_) => real_type(row, start),
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

/// The type Real, of any row.
fn real_type(row: &Row, start: Option<f64>) -> Element {
    let (unit, range) = match row.kind {
        Kind::Real(unit) => (unit, row.range),
        Kind::Integer => (&ONE, row.range),
        Kind::Boolean | Kind::Enumeration(_) => (&ONE, Some(row.bounds())),
    };
    let (min, max) = range.unzip();
    let real = Element::new("Real").with_text("quantity", unit.quantity);
    // No unit: dimensionless.
    let real = units::with_display(real.with_text("unit", unit.name), unit);
    units::with_nominal(real.with_some("min", min).with_some("max", max), unit).with_some("start", start)
}

/// The row's sentence and what its whole numbers mean, where no type says so.
fn text_with_values(row: &Row) -> String {
    let meaning = match row.kind {
        Kind::Boolean => "0: false, 1: true.".to_owned(),
        Kind::Enumeration(enumeration) => {
            let items: Vec<_> =
                (1..).zip(enumeration.items).map(|(value, item)| format!("{value}: {}", item.name)).collect();
            format!("{}.", items.join(", "))
        }
        Kind::Real(_) | Kind::Integer => return row.text().to_owned(),
    };
    format!("{} {meaning}", row.text())
}

/// At communication points the outputs depend on no input: they change only in a step. A host
/// therefore knows that there is no algebraic loop.
///
/// During initialisation the outputs are those of the model at rest, which depend on what the
/// outputs' rows say.
fn model_structure(identity: &Identity) -> Element {
    // A variable's index is its place in the list, from 1.
    let listed: Vec<(usize, &Row)> =
        (1..).zip(identity.listed_slots().into_iter().map(|slot| identity.row(slot))).collect();
    let unknowns = |list: &'static str, dependencies: &dyn Fn(&Row) -> String| {
        let outputs = listed.iter().filter(|(_, row)| row.causality == Causality::Output);
        let unknown = |(index, row): &(usize, &Row)| {
            Element::new("Unknown").with("index", index).with("dependencies", dependencies(row))
        };
        Element::list(list, outputs.map(unknown).collect())
    };
    let at_start = |output: &Row| {
        let knowns = listed.iter().filter(|(_, row)| output.starts_depending_on(row));
        knowns.map(|(index, _)| index.to_string()).collect::<Vec<_>>().join(" ")
    };
    Element::new("ModelStructure")
        .containing(unknowns("Outputs", &|_| String::new()))
        .containing(unknowns("InitialUnknowns", &at_start))
}
