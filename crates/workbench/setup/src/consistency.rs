//! Checks for contradicting limits: each is valid, but one of them never has an effect.

use moris_interface::ParameterError;
use moris_washout::Parameters;

use crate::ranges::{Axis, single_axis_range};

/// Checks that the safety units' limits are within the rig's reach along each axis alone. Where
/// they are not, a safety unit never acts: the legs come to the ends of their stroke before.
///
/// # Errors
/// The first limit beyond the rig's reach.
pub fn check_consistency(parameters: &Parameters) -> Result<(), ParameterError> {
    let limits = parameters.safety.position_limit;
    for (place, axis) in [Axis::Surge, Axis::Sway, Axis::Heave].into_iter().enumerate() {
        let reach = single_axis_range(&parameters.rig, axis).min_reach();
        if limits[place] > reach {
            return Err(ParameterError {
                variable: format!("safety.{}.positionLimit", ["x", "y", "z"][place]),
                reason: format!(
                    "is {} m, but in {} the rig reaches only {reach:.3} m from neutral; reduce it, or omit it from the rig \
                     file to derive it from the rig",
                    limits[place],
                    axis.name()
                ),
            });
        }
    }
    Ok(())
}
