//! Ways in which a model description presents the interface's rows.

use alloc::{
    borrow::ToOwned,
    format,
    string::{String, ToString},
    vec::Vec,
};

use crate::Identity;

/// Presentation of a row of several values in a model description. One library serves both: the
/// instantiation token says which description the host has read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// A scalar variable for each slot, named as in FMI 2.0.
    Scalars,
    /// An array variable for each row. Its value reference is the row's first slot.
    Arrays,
}

/// End of the instantiation token of a description with arrays.
const ARRAYS_SUFFIX: &str = "-arrays";

/// Types of the variables in a model description of FMI 2.0. One library serves both: the GUID says
/// which description the host has read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Types {
    /// Each variable has its own type.
    Own,
    /// Every variable is a Real, for hosts that know no other type. Booleans are 0 and 1,
    /// enumerations and integers whole numbers.
    Reals,
}

/// End of the GUID of a description with reals only.
const REALS_SUFFIX: &str = "-reals";

impl Types {
    /// GUID of a description with these types, given the GUID of the model.
    pub fn token(self, guid: &str) -> String {
        match self {
            Types::Own => guid.to_owned(),
            Types::Reals => format!("{guid}{REALS_SUFFIX}"),
        }
    }

    /// Types of the description with this GUID; `None` if the description is not of the model with
    /// the GUID `guid`.
    pub fn of_token(token: &[u8], guid: &[u8]) -> Option<Self> {
        match token.strip_prefix(guid)? {
            b"" => Some(Types::Own),
            end if end == REALS_SUFFIX.as_bytes() => Some(Types::Reals),
            _ => None,
        }
    }
}

impl Layout {
    /// Instantiation token of a description in this layout, given the GUID of the model.
    pub fn token(self, guid: &str) -> String {
        match self {
            Layout::Scalars => guid.to_owned(),
            Layout::Arrays => format!("{guid}{ARRAYS_SUFFIX}"),
        }
    }

    /// Layout of the description with this token; `None` if the description is not of the
    /// model with this GUID.
    pub fn of_token(token: &[u8], guid: &[u8]) -> Option<Self> {
        match token.strip_prefix(guid)? {
            b"" => Some(Layout::Scalars),
            end if end == ARRAYS_SUFFIX.as_bytes() => Some(Layout::Arrays),
            _ => None,
        }
    }

    /// Name of the variable that a slot belongs to.
    pub fn variable_name(self, identity: &Identity, slot: usize) -> String {
        match self {
            Layout::Scalars => identity.variable_name(slot),
            Layout::Arrays => identity.row(slot).array_name(),
        }
    }

    /// Replaces names of scalars by names of the description's variables: `rig.base[2].x`
    /// becomes `rig.base[2,1]`.
    pub fn rename(self, identity: &Identity, text: String) -> String {
        match self {
            Layout::Scalars => text,
            Layout::Arrays => with_names_of_elements(identity, &text),
        }
    }
}

fn with_names_of_elements(identity: &Identity, text: &str) -> String {
    let in_name = |c: char| c.is_ascii_alphanumeric() || "._[]".contains(c);
    let renamed = |piece: &str| {
        // The full stop of a sentence is no part of a name.
        let name = piece.trim_end_matches(|c| c == '.' || !in_name(c));
        match element_name(identity, name) {
            Some(element) => element + &piece[name.len()..],
            None => piece.to_owned(),
        }
    };
    text.split_inclusive(|c| !in_name(c)).map(renamed).collect()
}

/// Name of the array element that is the scalar of this name; `None` where that is
/// no element of an array.
fn element_name(identity: &Identity, scalar: &str) -> Option<String> {
    let slot = identity.slot(scalar)?;
    let (row, element) = (identity.row(slot), usize::from(identity.slots[slot].element));
    let sizes = [row.count, row.components.len()];
    let indices = [element / sizes[1] + 1, element % sizes[1] + 1];
    let indices: Vec<String> =
        sizes.iter().zip(indices).filter(|(size, _)| **size > 1).map(|(_, index)| index.to_string()).collect();
    (!indices.is_empty()).then(|| format!("{}[{}]", row.array_name(), indices.join(",")))
}
