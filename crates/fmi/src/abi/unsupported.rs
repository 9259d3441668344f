//! Functions that have to be there and cannot be used.

use moris_interface::Model;

use super::{Component, Host};
use crate::CallError;

/// A function that is allowed in no state.
pub fn never_allowed<M: Model, H: Host>(_: &mut Component<M, H>) -> Result<(), CallError> {
    Ok(())
}

/// A function for what the FMU does not offer, as the attribute `capability` of its
/// model description says.
pub fn not_provided<M: Model, H: Host>(_: &mut Component<M, H>, capability: &str) -> Result<(), CallError> {
    Err(CallError::error(format!("not provided, as {capability} in modelDescription.xml says")))
}

/// A get or set function of a type that no variable has. A call for no variables succeeds.
pub fn none_of_this_type<M: Model, H: Host>(_: &mut Component<M, H>, count: usize) -> Result<(), CallError> {
    match count {
        0 => Ok(()),
        _ => Err(CallError::error("the model has no variables of this type")),
    }
}
