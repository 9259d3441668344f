//! Whether parameters can be used: each on its own, and together.

use moris_interface::{Group, Refusal, Row, Writer, refuse, slot_count};
use moris_washout::interface::StructureParameters;
use nalgebra::Vector6;

use crate::interface::{Inertia, Parameters};

/// Checks parameters; `at_rest` are the forces that carry the platform at rest at neutral \[N\].
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn check(parameters: &Parameters, at_rest: &Vector6<f64>) -> Result<(), Refusal> {
    let Parameters { actuators, masses, setting, rig } = parameters;
    check_each(actuators)?;
    check_each(masses)?;
    check_each(setting)?;
    check_inertia("platform.inertia", &masses.platform_inertia, true)?;
    check_inertia("rider.inertia", &masses.rider_inertia, false)?;
    // Rig and head are the washout's too, and so are the rules for them.
    let structure = StructureParameters {
        head_height: setting.head_height,
        torso_length: setting.torso_length,
        gravity: setting.gravity,
        ..StructureParameters::default()
    };
    moris_washout::check(&moris_washout::Parameters { rig: *rig, structure, ..Default::default() })?;
    check_force_limit(actuators.force_limit, at_rest)
}

/// The least and the largest value that a variable may have.
///
/// The ends are so far out that no one misses them; beyond, the arithmetic fails.
fn range(row: &Row) -> (f64, f64) {
    match row.name {
        "actuator.bandwidth" => (0.1, 1e3),
        "actuator.damping" => (0.05, 10.0),
        "actuator.deadTime" => (0.0, 10.0),
        "actuator.forceLimit" => (1e-3, 1e9),
        "platform.mass" => (1e-3, 1e6),
        "rider.mass" | "payload.mass" => (0.0, 1e6),
        "platform.centreOfMass.@" | "rider.centreOfMass.@" | "payload.centreOfMass.@" => (-100.0, 100.0),
        "platform.inertia.@" | "rider.inertia.@" => (-1e8, 1e8),
        "gravity" | "head.height" | "head.torsoLength" => (0.0, 1e3),
        "solver.maxStep" => (1e-6, 0.01),
        _ => (-1e9, 1e9),
    }
}

fn check_each<G: Group>(group: &G) -> Result<(), Refusal> {
    let mut values = vec![0.0; slot_count(G::ROWS)];
    group.write(&mut Writer::new(&mut values));
    let mut rest = &values[..];
    for row in G::ROWS {
        let (mine, others) = rest.split_at(row.slots());
        rest = others;
        let (least, largest) = range(row);
        if let Some(element) = mine.iter().position(|value| !(least..=largest).contains(value)) {
            let value = mine[element];
            return refuse(row.variable_name(element), format!("is {value}, but must be from {least} to {largest}"));
        }
    }
    Ok(())
}

/// A body's principal moments are positive, and none is larger than the other two together. A body that need not be
/// there may also have none at all.
fn check_inertia(name: &str, inertia: &Inertia, has_extent: bool) -> Result<(), Refusal> {
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
            "has principal moments of {:.6}, {:.6} and {:.6} kg m2, which no body has: they must be positive, and none larger than \
             the other two together",
            moments[0], moments[1], moments[2]
        ),
    )
}

/// The drives must at least carry the platform.
fn check_force_limit(limit: f64, at_rest: &Vector6<f64>) -> Result<(), Refusal> {
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
            "is {limit} N, but at rest at neutral actuator {} carries {needed:.1} N; raise it, or lower the masses",
            leg + 1
        ),
    )
}
