//! Validation of parameters: each alone, and in combination.

use moris_interface::{Group, ParameterError, check_fixed, refuse, slot_count};
use moris_washout::check_rig;
use moris_washout::interface::StructureParameters;
use moris_washout::platform::check_torso;
use nalgebra::Vector6;

use crate::identity::parameter_rows;
use crate::interface::{Inertia, Parameters};

/// Checks parameters; `at_rest` are the forces that carry the platform at rest at neutral \[N\].
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn check(parameters: &Parameters, at_rest: &Vector6<f64>) -> Result<(), ParameterError> {
    let Parameters { setting, rig, .. } = parameters;
    parameters.check_ranges()?;
    check_torso(setting.torso_length, setting.head_height, "platform")?;
    // The rules for a rig are the washout's, in the washout's internal step.
    check_rig(rig, StructureParameters::START.max_step)?;
    check_tunable(parameters, at_rest)
}

/// Checks a change of parameters, of which only tunable ones may differ; otherwise as [`check`].
///
/// # Errors
/// The first parameter that cannot be used or must not change, and why.
pub fn check_change(from: &Parameters, to: &Parameters, at_rest: &Vector6<f64>) -> Result<(), ParameterError> {
    to.check_ranges()?;
    check_fixed::<_, { slot_count(Parameters::ROWS) }>(parameter_rows(), from, to)?;
    check_tunable(to, at_rest)
}

fn check_tunable(parameters: &Parameters, at_rest: &Vector6<f64>) -> Result<(), ParameterError> {
    let Parameters { actuators, masses, .. } = parameters;
    check_inertia("platform.inertia", &masses.platform_inertia, true)?;
    check_inertia("rider.inertia", &masses.rider_inertia, false)?;
    check_force_limit(actuators.force_limit, at_rest)
}

/// A body's principal moments are positive, and none is larger than the other two together. A body
/// that need not be there may also have none at all.
fn check_inertia(name: &str, inertia: &Inertia, has_extent: bool) -> Result<(), ParameterError> {
    let moments = inertia.matrix().symmetric_eigenvalues();
    let (least, largest) = (moments.min(), moments.max());
    let slack = 1e-9 * largest;
    let positive = if has_extent { least >= 1e-6 && least >= 1e-9 * largest } else { least >= -slack };
    if positive && 2.0 * largest <= moments.sum() + slack {
        return Ok(());
    }
    refuse(
        name,
        format!(
            "has principal moments of {:.6}, {:.6} and {:.6} kg m2, which no rigid body has; they must be positive, and none larger than \
             the sum of the other two",
            moments[0], moments[1], moments[2]
        ),
    )
}

/// The drives must carry the platform at rest.
fn check_force_limit(limit: f64, at_rest: &Vector6<f64>) -> Result<(), ParameterError> {
    let (leg, needed) = at_rest
        .iter()
        .map(|force| force.abs())
        .enumerate()
        .fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
    if needed < limit {
        return Ok(());
    }
    refuse(
        "actuator.forceLimit",
        format!(
            "is {limit} N; at rest at neutral actuator {} carries {needed:.1} N; raise the limit or lower the masses",
            leg + 1
        ),
    )
}
