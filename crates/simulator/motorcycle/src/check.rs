//! Validation of parameters: each alone, and in combination.

use moris_interface::{Group, ParameterError, check_fixed, refuse, slot_count};
use moris_washout::platform::check_torso;

use nalgebra::{Complex, SVector};

use crate::interface::{LARGEST_SPEED, Parameters, STRONGEST_WIND};
use crate::lateral::{Design, Lateral, static_loads};
use crate::longitudinal::Longitudinal;
use crate::rider::Rider;
use crate::suspension::Suspension;

/// Checks each parameter, and the weight on both wheels.
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn check(parameters: &Parameters) -> Result<(), ParameterError> {
    // Least fraction of the weight on either wheel.
    const LEAST_LOAD: f64 = 0.02;
    parameters.check_ranges()?;
    let loads = static_loads(&crate::lateral::bicycle(&parameters.machine), parameters.run.gravity);
    let weight = loads.front + loads.rear;
    let least = LEAST_LOAD.max(parameters.longitudinal.lift_reserve) * weight;
    if loads.front <= least || loads.rear <= least {
        return refuse(
            "frame.centre.x",
            format!(
                "is {} m; the front wheel carries {:.1} % of the weight and the rear wheel {:.1} %, and each must carry more \
                 than {:.1} %; move the centre of mass",
                parameters.machine.frame_x,
                100.0 * loads.front / weight,
                100.0 * loads.rear / weight,
                100.0 * least / weight
            ),
        );
    }
    let rider = &parameters.rider;
    check_torso(rider.torso_length, rider.head_height, "road")?;
    if rider.torso_mass > parameters.machine.frame_mass {
        return refuse(
            "rider.torsoMass",
            format!(
                "is {} kg; it is part of frame.mass and must not exceed it, {} kg",
                rider.torso_mass, parameters.machine.frame_mass
            ),
        );
    }
    Ok(())
}

/// Checks a change of parameters, of which only tunable ones may differ; otherwise as [`check`].
///
/// # Errors
/// The first parameter that cannot be used or must not change, and why.
pub fn check_change(from: &Parameters, to: &Parameters) -> Result<(), ParameterError> {
    check(to)?;
    check_fixed::<_, { slot_count(Parameters::ROWS) }>(Parameters::ROWS, from, to)
}

/// Speed \[m/s\] up to which the rider's gains are needed.
///
/// # Errors
/// The speed exceeds [`LARGEST_SPEED`].
pub fn fastest(parameters: &Parameters, longitudinal: &Longitudinal) -> Result<f64, ParameterError> {
    let top = longitudinal.top_speed(STRONGEST_WIND).max(parameters.run.initial_speed);
    if top > LARGEST_SPEED {
        return refuse(
            "drive.power",
            format!(
                "is {} W; the top speed in the strongest tail wind would be {top:.0} m/s (aero.dragArea is {}), and the rider's \
                 control is designed up to {LARGEST_SPEED} m/s; lower drive.power or raise aero.dragArea",
                parameters.longitudinal.power, parameters.longitudinal.drag_area
            ),
        );
    }
    Ok(top.max(2.0 * parameters.rider.feet_speed))
}

/// Lateral equations, and a rider whose control is stable up to the speed `fastest` \[m/s\].
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn design_rider(
    parameters: &Parameters,
    suspension: &Suspension,
    fastest: f64,
) -> Result<(Lateral, Rider), ParameterError> {
    // Number of speeds checked.
    const CHECKED_SPEEDS: u32 = 200;
    let Some(lateral) = Lateral::new(&Design::new(parameters)) else {
        return refuse(
            "frame.inertia.xz",
            "gives, with the other masses and moments of inertia, a mass matrix that is not positive definite; correct them so \
             that they are those of rigid bodies"
                .to_owned(),
        );
    };
    let rider = Rider::new(&lateral, parameters, fastest)?;
    check_step(parameters, suspension)?;
    let mut pole = 0.0;
    for k in 0..=CHECKED_SPEEDS {
        let speed = fastest * f64::from(k) / f64::from(CHECKED_SPEEDS);
        let closed_loop = rider.closed_loop(&lateral, speed);
        let finite = closed_loop.iter().all(|number| number.is_finite());
        let poles = if finite { closed_loop.complex_eigenvalues() } else { SVector::repeat(Complex::new(0.0, 0.0)) };
        if poles.iter().any(|pole| pole.re >= 0.0) {
            return refuse(
                "feet.speed",
                format!(
                    "is {} m/s; with these masses and tyres the motorcycle is unstable at {speed:.1} m/s; change feet.speed, \
                     rider.torqueWeight, the masses or the tyres",
                    parameters.rider.feet_speed
                ),
            );
        }
        pole = poles.iter().map(|pole| libm::hypot(pole.re, pole.im)).fold(pole, f64::max);
    }
    check_pole(parameters, pole)?;
    Ok((lateral, rider))
}

/// Checks the internal step against the suspension and the lags of throttle, brakes and rider.
///
/// # Errors
/// The step is too long.
pub fn check_step(parameters: &Parameters, suspension: &Suspension) -> Result<(), ParameterError> {
    check_pole(parameters, suspension.fastest_pole().max(fastest_lag(parameters)))
}

/// Checks the internal step against the magnitude of a pole \[rad/s\].
fn check_pole(parameters: &Parameters, pole: f64) -> Result<(), ParameterError> {
    // The Runge-Kutta rule is stable for poles in the left half-plane up to 2.6 divided by the
    // step; with a margin.
    const LARGEST_POLE: f64 = 2.0;
    let step = parameters.run.max_step;
    if pole * step <= LARGEST_POLE {
        return Ok(());
    }
    refuse(
        "solver.maxStep",
        format!(
            "is {step} s, too long for the fastest mode of this motorcycle; set it to {:.1e} s at most, or change \
             stiffnesses, time constants or relaxation lengths",
            LARGEST_POLE / pole
        ),
    )
}

/// Largest pole of throttle, brakes and the rider's reference filters \[rad/s\].
fn fastest_lag(parameters: &Parameters) -> f64 {
    let Parameters { longitudinal, rider, .. } = parameters;
    (1.0 / longitudinal.drive_time)
        .max(1.0 / longitudinal.brake_time)
        .max(2.0 * rider.lean_frequency)
        .max(2.0 * rider.body_lean_frequency)
}
