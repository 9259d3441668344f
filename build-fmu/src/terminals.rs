//! Terminals: groups of variables that a tool connects at once, with those of another FMU's
//! terminal of the same kind.
//!
//! The file is FMI 3.0's, which allows it in an FMU of FMI 2.0 as well.

use moris_interface::{Identity, Row};
use moris_model_description::{Element, to_xml};

use crate::{FmiVersion, FmuModel};

/// Path of the file in an FMU.
pub const TERMINALS_PATH: &str = "terminalsAndIcons/terminalsAndIcons.xml";

/// A group of variables.
pub struct Terminal {
    pub name: &'static str,
    /// Two terminals of the same kind have the same members.
    pub kind: &'static str,
    pub text: &'static str,
    /// Rows of the interface by their names as arrays, each with the name of its member.
    pub members: &'static [(&'static str, &'static str)],
}

/// The text of the file for a model's FMU.
///
/// # Panics
/// A terminal names a row that the model does not have. Terminals belong to the sources.
pub fn xml(model: &FmuModel, fmi: FmiVersion) -> String {
    let identity = &model.functions.identity;
    let element = |terminal: &Terminal| {
        Element::new("Terminal")
            .with("name", terminal.name)
            // `plug`: both terminals have the same members.
            .with("matchingRule", "plug")
            .with("terminalKind", terminal.kind)
            .with("description", terminal.text)
            .containing(terminal.members.iter().flat_map(|&(row, member)| row_members(identity, fmi, row, member)))
    };
    let terminals = Element::new("Terminals").containing(model.terminals.iter().map(element));
    // The version of FMI that defines the file, whatever version the FMU has.
    to_xml(&Element::new("fmiTerminalsAndIcons").with("fmiVersion", "3.0").containing([terminals]))
}

/// The variables of a row, each as a member: `length[1]` to `length[6]`, say, or an array `length`.
fn row_members(identity: &Identity, fmi: FmiVersion, row_name: &str, member: &str) -> Vec<Element> {
    let row = identity.rows.iter().find(|row| row.array_name() == row_name);
    let row = row.unwrap_or_else(|| panic!("{} has no {row_name}", identity.name));
    let signal = |variable: String, member: String| {
        Element::new("TerminalMemberVariable")
            .with("variableName", variable)
            .with("memberName", member)
            .with("variableKind", "signal")
    };
    let scalars = || {
        let scalar = |element| signal(row.variable_name(element), format!("{member}{}", element_suffix(row, element)));
        (0..row.slots()).map(scalar).collect()
    };
    fmi.choose_names(scalars(), vec![signal(row.array_name(), member.to_owned())])
}

/// Index and component of a row's scalar number `element`, as far as the row has them.
fn element_suffix(row: &Row, element: usize) -> String {
    let (index, component) = (element / row.components.len() + 1, row.components[element % row.components.len()]);
    let index = if row.count > 1 { format!("[{index}]") } else { String::new() };
    let component = if component.is_empty() { String::new() } else { format!(".{component}") };
    index + &component
}
