//! Recognising units and axes that are not what they are said to be.

use std::path::Path;

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use super::RideError;
use super::conventions::{AngleUnit, Axes, Conventions, ForceUnit, Gravity, RateUnit};

/// Tolerance of the median specific force against standard gravity \[m/s2\]: sensors are biased and tilted, rides lean.
const GRAVITY_TOLERANCE: f64 = 3.0;
/// Medians below this are none where gravity has been taken out \[m/s2\].
const NO_GRAVITY: f64 = 3.0;
/// No head turns faster than this for a hundredth of a ride \[rad/s\]; in degrees a second it is a lazy bend.
const FASTEST: f64 = 10.0;
/// No vehicle rolls or pitches beyond this \[rad\].
const STEEPEST: f64 = 3.2;
/// A mean acceleration above this is a tilted sensor, or a slope \[m/s2\].
const BIAS: f64 = 0.3;
/// A ride that begins with more than this begins with a jolt \[m/s2\].
const JOLT: f64 = 1.0;

/// Looks at a ride in SI units and the washout's axes.
///
/// # Errors
/// What cannot be: the unit or the axes that it must be instead, and how to say so.
pub fn look_at(file: &Path, inputs: &[Input], conventions: &Conventions) -> Result<(), RideError> {
    let refused = |reason: String| RideError::Whole { file: file.to_owned(), reason };
    force_is_plausible(inputs, conventions).map_err(refused)?;
    rates_are_plausible(inputs, conventions).map_err(refused)?;
    angles_are_plausible(inputs, conventions).map_err(refused)
}

/// Judges by the medians of the accelerations, of which a ride's manoeuvres move none far.
fn force_is_plausible(inputs: &[Input], conventions: &Conventions) -> Result<(), String> {
    let median = Vector3::from_fn(|axis, _| median(inputs.iter().map(|input| input.specific_force[axis]).collect()));
    let gravity = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    if (median - gravity).norm() < GRAVITY_TOLERANCE {
        return Ok(());
    }
    // As the file has it: without the gravity that conversion has added, in the file's unit.
    let added = if conventions.gravity == Gravity::Removed { gravity } else { Vector3::zeros() };
    let raw = (median - added) / conventions.force_unit.in_si();
    let signs = conventions.axes.signs();
    let shown = format!(
        "most of the time the accelerations are about ({:.2}, {:.2}, {:.2}) {}",
        raw.x,
        raw.y * signs[1],
        raw.z * signs[2],
        conventions.force_unit.word()
    );
    let size = raw.norm();
    let other_unit = match conventions.force_unit {
        ForceUnit::MetrePerSecondSquared if (0.8..1.2).contains(&size) => {
            Some("which is gravity in g, not in m/s2: say --force-unit g")
        }
        ForceUnit::Gravity if (size - STANDARD_GRAVITY).abs() < GRAVITY_TOLERANCE => {
            Some("which is gravity in m/s2, not in g: say --force-unit m/s2")
        }
        _ => None,
    };
    let meaning = if let Some(other_unit) = other_unit {
        other_unit.to_owned()
    } else if conventions.gravity == Gravity::Removed {
        "but gravity is said to have been taken out: say --gravity included".to_owned()
    } else if (median + gravity).norm() < GRAVITY_TOLERANCE {
        match conventions.axes {
            Axes::ForwardLeftUp => "so z points down: say --axes forward-right-down".to_owned(),
            Axes::ForwardRightDown => "so z points up: say --axes forward-left-up".to_owned(),
        }
    } else if median.norm() < NO_GRAVITY {
        "so gravity has been taken out: say --gravity removed".to_owned()
    } else if (median.norm() - STANDARD_GRAVITY).abs() < GRAVITY_TOLERANCE {
        let axis = ["x", "y", "z"][median.iamax()];
        format!(
            "so {axis} is nearest to the vertical; say with --columns which column is which axis, or level the sensor"
        )
    } else {
        "which is gravity in no unit known here: convert the file to m/s2 or g".to_owned()
    };
    Err(format!("{shown}, {meaning}"))
}

fn rates_are_plausible(inputs: &[Input], conventions: &Conventions) -> Result<(), String> {
    if conventions.rate_unit == RateUnit::DegreePerSecond {
        return Ok(());
    }
    let mut rates: Vec<f64> = inputs.iter().map(|input| input.angular_velocity.amax()).collect();
    rates.sort_by(f64::total_cmp);
    let fast = rates[(rates.len() - 1) * 99 / 100];
    if fast <= FASTEST {
        return Ok(());
    }
    Err(format!("angular velocities reach {fast:.0}, which are degrees a second, not radians: say --rate-unit deg/s"))
}

fn angles_are_plausible(inputs: &[Input], conventions: &Conventions) -> Result<(), String> {
    let angles = inputs.iter().map(|input| input.orientation.roll.abs().max(input.orientation.pitch.abs()));
    let steepest = angles.fold(0.0, f64::max);
    if steepest <= STEEPEST {
        return Ok(());
    }
    Err(match conventions.angle_unit {
        AngleUnit::Radian => {
            format!("roll or pitch reaches {steepest:.0}, which are degrees, not radians: say --angle-unit deg")
        }
        AngleUnit::Degree => format!("roll or pitch reaches {:.0} degrees", steepest.to_degrees()),
    })
}

/// Warnings about an unusual recording.
pub fn remarks(inputs: &[Input]) -> Vec<String> {
    let mut remarks = Vec::new();
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let mean = inputs.iter().map(|input| input.specific_force[axis]).sum::<f64>() / inputs.len() as f64;
        if mean.abs() > BIAS {
            remarks.push(format!(
                "The specific force along {name} is {mean:.2} m/s2 on average: the sensor is tilted by {:.1} degrees or \
                 biased, or the ride ends faster than it begins, or uphill. The platform will lean as much.",
                (mean / STANDARD_GRAVITY).clamp(-1.0, 1.0).asin().to_degrees()
            ));
        }
    }
    let first = inputs[0].specific_force - Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    if first.amax() > JOLT {
        remarks.push(format!(
            "The ride does not begin at rest: the specific force jumps by ({:.1}, {:.1}, {:.1}) m/s2 at once; \
             --fade-in 1 leads it in from rest.",
            first.x, first.y, first.z
        ));
    }
    remarks
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
