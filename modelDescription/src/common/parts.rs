//! Parts of the file that are the same in FMI 2.0 and 3.0.

use moris_interface::{Causality, Identity, Row};

use super::xml::Element;
use super::{origin, units};

/// The root with its attributes. `token` is the attribute that identifies the description as the
/// binary's own, with its value.
pub(crate) fn root(identity: &Identity, fmi_version: &str, token: (&'static str, String)) -> Element {
    Element::new("fmiModelDescription")
        .with("fmiVersion", fmi_version)
        .with("modelName", identity.name)
        .with(token.0, token.1)
        .with("description", identity.text)
        .with("author", origin::AUTHOR)
        .with("version", identity.version)
        .with("copyright", origin::COPYRIGHT)
        .with("license", origin::LICENSE)
        .with("generationTool", origin::GENERATION_TOOL)
        .with("generationDateAndTime", origin::GENERATION_DATE_AND_TIME)
        .with("variableNamingConvention", origin::VARIABLE_NAMING_CONVENTION)
}

/// Every unit that a row has, once, in the order in which they appear; with the unit for
/// display that any of the rows of that unit has.
pub(crate) fn unit_definitions(identity: &Identity) -> Option<Element> {
    let all = units::units(identity);
    let mut names: Vec<&str> = Vec::new();
    let mut elements = Vec::new();
    for unit in &all {
        if names.contains(&unit.name) {
            continue;
        }
        names.push(unit.name);
        let display = all.iter().filter(|other| other.name == unit.name).find_map(|other| other.display);
        let display = display.map(|it| Element::new("DisplayUnit").with("name", it.name).with("factor", it.factor));
        let base = units::exponents(unit).fold(Element::new("BaseUnit"), |base, (name, power)| base.with(name, power));
        elements.push(Element::new("Unit").with("name", unit.name).containing([base]).containing(display));
    }
    Element::list("UnitDefinitions", elements)
}

/// `LogCategories` from pairs of a name and a description: kinds of message that a host can ask
/// for.
pub(crate) fn log_categories<'a>(categories: impl IntoIterator<Item = (&'a str, &'a str)>) -> Element {
    let category = |(name, text)| Element::new("Category").with("name", name).with("description", text);
    Element::new("LogCategories").containing(categories.into_iter().map(category))
}

/// Experiment that a host runs by default; times in seconds.
pub(crate) fn default_experiment(identity: &Identity) -> Element {
    // Relative tolerance for tools that ask for one. The models step without error control: runs
    // with different communication steps agree to this.
    const DEFAULT_TOLERANCE: f64 = 1e-3;
    Element::new("DefaultExperiment")
        .with("startTime", 0.0)
        .with("stopTime", identity.stop_time)
        .with("tolerance", DEFAULT_TOLERANCE)
        .with("stepSize", identity.step_size)
}

/// A variable with the attributes that stand first whatever its type. `initial` is left out where
/// the standard's default is meant: `exact` for inputs and parameters, nothing for the time.
pub(crate) fn variable(element: &'static str, name: &str, slot: usize, text: &str, row: &Row) -> Element {
    Element::new(element)
        .with("name", name)
        .with("valueReference", slot)
        .with("description", text)
        .with("causality", row.causality.name())
        .with("variability", row.variability.name())
        .with_some("initial", (row.causality == Causality::Output).then_some("calculated"))
}

/// True for variables with a start value. Outputs are calculated and the time is the host's:
/// neither may have one.
pub(crate) fn has_start(row: &Row) -> bool {
    matches!(row.causality, Causality::Input | Causality::Parameter)
}
