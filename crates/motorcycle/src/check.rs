//! Whether parameters can be used: each on its own, and together.

use moris_interface::{Group, Refusal, refuse};

use nalgebra::{Complex, SVector};

use crate::interface::Parameters;
use crate::lateral::{Design, Lateral, static_loads};
use crate::longitudinal::Longitudinal;
use crate::motorcycle::STRONGEST_WIND;
use crate::rider::Rider;
use crate::suspension::Suspension;

/// Checks each parameter, and the machine's balance.
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn check(parameters: &Parameters) -> Result<(), Refusal> {
    parameters.check_ranges()?;
    let loads = static_loads(&crate::lateral::bicycle(&parameters.machine), parameters.run.gravity);
    let weight = loads.front + loads.rear;
    let least = LEAST_LOAD.max(parameters.longitudinal.lift_reserve) * weight;
    if loads.front <= least || loads.rear <= least {
        return refuse(
            "frame.centre.x",
            format!(
                "is {}, and so of the weight the front wheel carries {:.1} % and the rear wheel {:.1} %; each must carry \
                 more than {:.1} %",
                parameters.machine.frame_x,
                100.0 * loads.front / weight,
                100.0 * loads.rear / weight,
                100.0 * least / weight
            ),
        );
    }
    let rider = &parameters.rider;
    if rider.torso_length > rider.head_height {
        return refuse(
            "head.torsoLength",
            format!(
                "is {}, but the seat would be below the road: it must not exceed head.height, {}",
                rider.torso_length, rider.head_height
            ),
        );
    }
    if rider.torso_mass > parameters.machine.frame_mass {
        return refuse(
            "rider.torsoMass",
            format!(
                "is {}, but it is a part of frame.mass and must not exceed it, {}",
                rider.torso_mass, parameters.machine.frame_mass
            ),
        );
    }
    Ok(())
}

/// The lateral equations, and a rider who masters them up to the top speed.
///
/// # Errors
/// The first parameter that cannot be used, and why.
pub fn ridden(
    parameters: &Parameters,
    longitudinal: &Longitudinal,
    suspension: &Suspension,
) -> Result<(Lateral, Rider), Refusal> {
    let top = longitudinal.top_speed(STRONGEST_WIND).max(parameters.run.initial_speed);
    if top > LARGEST_SPEED {
        return refuse(
            "drive.power",
            format!(
                "is {}, and with it the motorcycle would reach {top:.0} m/s with a storm in its back (aero.dragArea is {}); \
                 at most {LARGEST_SPEED} m/s can be ridden",
                parameters.longitudinal.power, parameters.longitudinal.drag_area
            ),
        );
    }
    let Some(lateral) = Lateral::new(&Design::new(parameters)) else {
        return refuse(
            "frame.inertia.xz",
            "makes, with the masses and moments of inertia, no mass matrix that is positive definite: no bodies are such"
                .to_owned(),
        );
    };
    let fastest = top.max(2.0 * parameters.rider.feet_speed);
    let rider = Rider::new(&lateral, parameters, fastest)?;
    let mut pole = suspension.fastest_pole().max(fastest_lag(parameters));
    for k in 0..=SPEEDS {
        let speed = fastest * f64::from(k) / f64::from(SPEEDS);
        let ridden = rider.closed_loop(&lateral, speed);
        let finite = ridden.iter().all(|number| number.is_finite());
        let poles = if finite { ridden.complex_eigenvalues() } else { SVector::repeat(Complex::new(0.0, 0.0)) };
        if poles.iter().any(|pole| pole.re >= 0.0) {
            return refuse(
                "feet.speed",
                format!(
                    "is {}, and with these masses and tyres neither feet nor rider keep the motorcycle upright at \
                     {speed:.1} m/s; mend it, rider.torqueWeight, or the masses and tyres",
                    parameters.rider.feet_speed
                ),
            );
        }
        pole = poles.iter().map(|pole| libm::hypot(pole.re, pole.im)).fold(pole, f64::max);
    }
    let step = parameters.run.max_step;
    if pole * step > LARGEST_POLE {
        return refuse(
            "solver.maxStep",
            format!(
                "is {step}, too long for how quickly this motorcycle moves: make it {:.1e} at most, or mend the stiffnesses, \
                 time constants or relaxation lengths",
                LARGEST_POLE / pole
            ),
        );
    }
    Ok((lateral, rider))
}

/// What either wheel must carry of the weight at least.
const LEAST_LOAD: f64 = 0.02;
/// Beyond this nothing is designed \[m/s\].
pub const LARGEST_SPEED: f64 = 150.0;
/// The Runge-Kutta rule is stable for poles in the left half-plane up to 2.6 divided by the step; with a margin.
const LARGEST_POLE: f64 = 2.0;

/// The largest pole of throttle, brakes and the rider's taking up of commands \[rad/s\].
fn fastest_lag(parameters: &Parameters) -> f64 {
    let Parameters { longitudinal, rider, .. } = parameters;
    (1.0 / longitudinal.drive_time)
        .max(1.0 / longitudinal.brake_time)
        .max(2.0 * rider.lean_frequency)
        .max(2.0 * rider.body_lean_frequency)
}

/// How many speeds are looked at.
const SPEEDS: u32 = 200;
