//! Whether parameters can be used: each on its own, and together.

use model_interface::{Group, Refusal, Row, Writer, slot_count};

use crate::interface::{Parameters, Rig};
use crate::platform::{Geometry, Pose, leg_lengths, survey};

/// Checks parameters; the rig with a survey of all its legs' lengths, unless it is the default rig.
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn check(parameters: &Parameters) -> Result<(), Refusal> {
    check_each(parameters)?;
    check_head(parameters)?;
    check_rig(&parameters.rig)
}

fn refuse<T>(variable: impl Into<String>, reason: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal { variable: variable.into(), reason: reason.into() })
}

/// What a value must be on its own.
enum Rule {
    Finite,
    NotNegative,
    Positive,
    /// Above 0 and at most this.
    UpTo(f64),
}

fn rule(row: &Row) -> Rule {
    match row.name {
        "rig.base[#].@" | "rig.platform[#].@" | "washoutPoint.@" => Rule::Finite,
        "scale.specificForce.@" | "scale.angularVelocity.@" => Rule::Finite,
        "gravityRemoval" | "compensation" | "angularVelocityFrame" | "splitter.lowPass" | "washoutLocation" => {
            Rule::Finite
        }
        "input.cutoff" | "head.height" | "head.torsoLength" => Rule::NotNegative,
        "tilt.angleLimit" => Rule::UpTo(LARGEST_TILT),
        "solver.maxStep" => Rule::UpTo(LONGEST_STEP),
        _ => Rule::Positive,
    }
}

/// 60 degrees: beyond it tilting hardly adds to the force that is felt along the axis \[rad\].
const LARGEST_TILT: f64 = 1.047_197_551_196_597_6;
/// Beyond this the limits act too coarsely \[s\].
const LONGEST_STEP: f64 = 0.05;

fn check_each(parameters: &Parameters) -> Result<(), Refusal> {
    let mut values = [0.0; slot_count(Parameters::ROWS)];
    parameters.write(&mut Writer::new(&mut values));
    let mut rest = &values[..];
    for row in Parameters::ROWS {
        let (mine, others) = rest.split_at(row.slots());
        rest = others;
        for (element, &value) in mine.iter().enumerate() {
            let reason = match rule(row) {
                _ if !value.is_finite() => "must be a finite number".to_owned(),
                Rule::Positive if value <= 0.0 => "must be above 0".to_owned(),
                Rule::NotNegative if value < 0.0 => "must not be below 0".to_owned(),
                Rule::UpTo(largest) if value <= 0.0 || value > largest => {
                    format!("must be above 0 and at most {largest}")
                }
                _ => match row.range {
                    Some((min, max)) if value < min || value > max => format!("must be from {min} to {max}"),
                    _ => continue,
                },
            };
            return refuse(row.variable_name(element), format!("is {value}, but {reason}"));
        }
    }
    Ok(())
}

fn check_head(parameters: &Parameters) -> Result<(), Refusal> {
    let structure = &parameters.structure;
    if structure.torso_length > structure.head_height {
        return refuse(
            "head.torsoLength",
            format!(
                "is {}, but the seat would be below the platform: it must not exceed head.height, {}",
                structure.torso_length, structure.head_height
            ),
        );
    }
    Ok(())
}

fn check_rig(rig: &Rig) -> Result<(), Refusal> {
    let Rig { min_length, max_length, .. } = *rig;
    if min_length >= max_length {
        return refuse("actuator.minLength", format!("is {min_length}, not below actuator.maxLength, {max_length}"));
    }
    let neutral = leg_lengths(&Geometry::from(rig), &Pose::neutral(rig));
    for (i, length) in neutral.iter().enumerate() {
        if !(min_length < *length && *length < max_length) {
            return refuse(
                "rig.neutralHeight",
                format!(
                    "is {}, where actuator {} would have to be {length:.4} m long, outside its stroke from {min_length} to \
                     {max_length} m",
                    rig.neutral_height,
                    i + 1
                ),
            );
        }
    }
    if is_default(rig) {
        return Ok(());
    }
    match survey(rig) {
        Ok(_) => Ok(()),
        Err(failed) => refuse(
            "rig.base, rig.platform",
            format!(
                "the platform is singular inside the stroke of its actuators, at or near lengths of {:.3?} m; choose other \
                 joints, or a shorter stroke",
                failed.lengths
            ),
        ),
    }
}

/// Whether the rig's legs and joints are the default's, of which it is known that they have no singularity.
fn is_default(rig: &Rig) -> bool {
    let default = Rig::default();
    let speeds_aside =
        Rig { velocity_limit: default.velocity_limit, acceleration_limit: default.acceleration_limit, ..*rig };
    speeds_aside == default
}
