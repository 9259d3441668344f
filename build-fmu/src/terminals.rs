//! Terminals: groups of variables that a tool connects at once, with those of another FMU's
//! terminal of the same kind.
//!
//! The file is FMI 3.0's, which allows it in an FMU of FMI 2.0 as well.

use moris_interface::{Identity, Row};
use moris_model_description::to_xml;
use serde::Serialize;

use crate::{FmiVersion, FmuModel};

/// Path of the file in an FMU.
pub const FILE: &str = "terminalsAndIcons/terminalsAndIcons.xml";

/// A group of variables.
pub struct Terminal {
    pub name: &'static str,
    /// Two terminals of the same kind have the same members.
    pub kind: &'static str,
    pub text: &'static str,
    /// Rows of the interface by their names as arrays, each with the name of its member.
    pub members: &'static [(&'static str, &'static str)],
}

/// `fmiTerminalsAndIcons`: the root of the file.
#[derive(Serialize)]
#[serde(rename = "fmiTerminalsAndIcons")]
struct TerminalsAndIcons {
    /// The version of FMI that defines the file, whatever version the FMU has.
    #[serde(rename = "@fmiVersion")]
    fmi_version: &'static str,
    #[serde(rename = "Terminals")]
    terminals: TerminalList,
}

/// `Terminals`
#[derive(Serialize)]
struct TerminalList {
    #[serde(rename = "Terminal")]
    terminals: Vec<TerminalElement>,
}

/// `Terminal`
#[derive(Serialize)]
struct TerminalElement {
    #[serde(rename = "@name")]
    name: &'static str,
    /// `plug`: both terminals have the same members.
    #[serde(rename = "@matchingRule")]
    matching_rule: &'static str,
    #[serde(rename = "@terminalKind")]
    kind: &'static str,
    #[serde(rename = "@description")]
    description: &'static str,
    #[serde(rename = "TerminalMemberVariable")]
    members: Vec<Member>,
}

/// `TerminalMemberVariable`
#[derive(Serialize)]
struct Member {
    #[serde(rename = "@variableName")]
    variable_name: String,
    #[serde(rename = "@memberName")]
    member_name: String,
    #[serde(rename = "@variableKind")]
    variable_kind: &'static str,
}

/// The text of the file for a model's FMU.
///
/// # Panics
/// A terminal names a row that the model does not have. Terminals belong to the sources.
pub fn xml(model: &FmuModel, fmi: FmiVersion) -> String {
    let identity = &model.functions.identity;
    let element = |terminal: &Terminal| TerminalElement {
        name: terminal.name,
        matching_rule: "plug",
        kind: terminal.kind,
        description: terminal.text,
        members: terminal.members.iter().flat_map(|&(row, member)| members(identity, fmi, row, member)).collect(),
    };
    let terminals = TerminalList { terminals: model.terminals.iter().map(element).collect() };
    to_xml(&TerminalsAndIcons { fmi_version: "3.0", terminals })
}

/// The variables of a row, each as a member: `length[1]` to `length[6]`, say, or an array `length`.
fn members(identity: &Identity, fmi: FmiVersion, row_name: &str, member: &str) -> Vec<Member> {
    let row = identity.rows.iter().find(|row| row.array_name() == row_name);
    let row = row.unwrap_or_else(|| panic!("{} has no {row_name}", identity.name));
    let signal = |variable_name, member_name| Member { variable_name, member_name, variable_kind: "signal" };
    let scalars = || {
        let scalar = |element| signal(row.variable_name(element), format!("{member}{}", suffix(row, element)));
        (0..row.slots()).map(scalar).collect()
    };
    fmi.choose_names(scalars(), vec![signal(row.array_name(), member.to_owned())])
}

/// Index and component of a row's scalar number `element`, as far as the row has them.
fn suffix(row: &Row, element: usize) -> String {
    let (index, component) = (element / row.components.len() + 1, row.components[element % row.components.len()]);
    let index = if row.count > 1 { format!("[{index}]") } else { String::new() };
    let component = if component.is_empty() { String::new() } else { format!(".{component}") };
    index + &component
}
