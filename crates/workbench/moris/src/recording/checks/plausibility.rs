//! Detection of wrong units and axes.
//!
//! Rates in deg/s that are read as rad/s are 57 times too large. Those of a calm car still resemble
//! a motorcycle's. Four tests distinguish them, each by a fact that holds for every vehicle:
//!
//! - no head turns faster than 10 rad/s for a hundredth of the time;
//! - rates are the derivatives of the angles, where the recording has both;
//! - roll and pitch are bounded, so the integral of their rates may drift, but does not swing by
//!   more than half a turn;
//! - correlated lateral force and yaw rate are those of a turn, a = v omega, whose radius a /
//!   omega^2 is at least a metre.

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use crate::recording::columns::UnitSource;
use crate::recording::conventions::{
    AngleUnit, Axes, Conventions, ForceUnit, Gravity, Quantity, RateFrame, RateUnit, Unit,
};
use crate::recording::median;
use crate::recording::message::{RecordingError, given, named};
use crate::recording::table::Table;

/// Largest distance of the median specific force from standard gravity \[m/s2\]: sensors
/// are biased and tilted.
const GRAVITY_TOLERANCE: f64 = 3.0;
/// Medians below this contain no gravity \[m/s2\].
const NO_GRAVITY: f64 = 3.0;
/// Angular velocity that no head exceeds for a hundredth of a recording \[rad/s\].
const FASTEST: f64 = 10.0;
/// Angular velocity that few heads exceed for a hundredth of a recording \[rad/s\].
const BRISK: f64 = 2.5;
/// Roll or pitch that no vehicle exceeds \[rad\].
const STEEPEST: f64 = 3.2;
/// Time over which the drift of an integrated rate is removed \[s\].
const DRIFT: f64 = 10.0;
/// Swing of roll or pitch, drift removed, that no vehicle exceeds \[rad\]: a
/// motorcycle goes from -1 to 1.
const WIDEST_SWING: f64 = 3.5;
/// Correlation above which two signals count as correlated.
const TOGETHER: f64 = 0.7;
/// Time constant of the smoothing before turns are detected \[s\].
const SMOOTHING: f64 = 0.5;
/// Least lateral specific force of a turn, as a standard deviation \[m/s2\].
const TURN: f64 = 0.3;
/// Radius below which no vehicle turns \[m\]; in deg/s for rad/s, a radius of 1 km reads as 0.3 m.
const TIGHTEST: f64 = 1.0;
/// Mean acceleration above which the sensor or the road is taken as tilted \[m/s2\].
const BIAS: f64 = 0.3;
/// Cue at the first sample above which the recording begins with a jolt \[m/s2\].
const JOLT: f64 = 1.0;

/// Checks a recording in SI units and the washout's axes.
///
/// # Errors
/// The unit or the axes are implausible. The message names those that fit, and the option for them.
pub fn check(table: &Table, inputs: &[Input], conventions: &Conventions) -> Result<(), RecordingError> {
    let refused = |reason: String| RecordingError::Whole { file: table.file.clone(), reason };
    force_is_plausible(table, inputs, conventions).map_err(refused)?;
    angles_are_plausible(table, inputs).map_err(refused)?;
    rates_are_plausible(table, inputs, conventions).map_err(refused)
}

/// The unit of a quantity's column, and its source.
pub(super) fn unit(table: &Table, quantity: Quantity) -> (Unit, UnitSource) {
    let column = table.column(quantity);
    column.map_or((quantity.dimension().default_unit(), UnitSource::Default), |column| (column.unit, column.source))
}

/// The remedy for a unit: an option where the header leaves it open, otherwise the header.
pub(super) fn remedy(table: &Table, quantity: Quantity, word: &str) -> String {
    let (unit, source) = unit(table, quantity);
    match source {
        UnitSource::Header => format!("correct the header, which gives {}", unit.word),
        UnitSource::Option | UnitSource::Default => format!("use {}", given(quantity.dimension().option(), word)),
    }
}

/// Compares the medians of the accelerations, which manoeuvres hardly change, with gravity.
fn force_is_plausible(table: &Table, inputs: &[Input], conventions: &Conventions) -> Result<(), String> {
    let median = Vector3::from_fn(|axis, _| median(inputs.iter().map(|input| input.specific_force[axis])));
    let gravity = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    if (median - gravity).norm() < GRAVITY_TOLERANCE {
        return Ok(());
    }
    // As the file has it: without the gravity that conversion has added, in the file's unit.
    let added = if conventions.gravity == Gravity::Removed { gravity } else { Vector3::zeros() };
    let (unit, _) = unit(table, Quantity::Force(2));
    let raw = (median - added) / unit.in_si;
    let is_mounted = conventions.mounting.is_some();
    let signs = if is_mounted { [1.0; 3] } else { conventions.axes.signs() };
    let shown = format!(
        "most of the time the accelerations{} are about ({:.2}, {:.2}, {:.2}) {}",
        if is_mounted { format!(", turned by {},", named("mounting")) } else { String::new() },
        raw.x,
        raw.y * signs[1],
        raw.z * signs[2],
        unit.word
    );
    let size = raw.norm();
    let other_unit = [ForceUnit::MetrePerSecondSquared, ForceUnit::Gravity, ForceUnit::MilliGravity]
        .map(ForceUnit::unit)
        .into_iter()
        .find(|other| *other != unit && (0.75..1.25).contains(&(size * other.in_si / STANDARD_GRAVITY)));
    let meaning = if let Some(other) = other_unit {
        let remedy = remedy(table, Quantity::Force(2), other.word);
        format!("which is gravity in {}, not in {}: {remedy}", other.word, unit.word)
    } else if conventions.gravity == Gravity::Removed {
        format!(
            "which includes gravity although {} was given: use {}",
            given("gravity", "removed"),
            given("gravity", "included")
        )
    } else if (median + gravity).norm() < GRAVITY_TOLERANCE {
        match conventions.axes {
            Axes::ForwardLeftUp => format!("so z points down: use {}", given("axes", "forward-right-down")),
            Axes::ForwardRightDown => format!("so z points up: use {}", given("axes", "forward-left-up")),
        }
    } else if median.norm() < NO_GRAVITY {
        format!("so gravity has been taken out: use {}", given("gravity", "removed"))
    } else if (median.norm() - STANDARD_GRAVITY).abs() < GRAVITY_TOLERANCE {
        let axis = ["x", "y", "z"][median.iamax()];
        format!(
            "so {axis} is nearest to the vertical; name the column of each axis with {}, or use {}",
            named("columns"),
            given("mounting", "auto")
        )
    } else {
        "which is gravity in no unit known here: convert the file to m/s2 or g".to_owned()
    };
    Err(format!("{shown}, {meaning}"))
}

/// Rejects rates that are plausible only as deg/s. A given unit overrides all
/// tests except the first.
fn rates_are_plausible(table: &Table, inputs: &[Input], conventions: &Conventions) -> Result<(), String> {
    let (unit, source) = unit(table, Quantity::Rate(0));
    if unit != RateUnit::RadianPerSecond.unit() {
        return Ok(());
    }
    let fast = usual_maximum(inputs);
    let evidence = if fast > FASTEST {
        Some(format!("angular velocities reach {fast:.0}"))
    } else if source == UnitSource::Default {
        not_radians(table, inputs, conventions)
    } else {
        None
    };
    let Some(evidence) = evidence else { return Ok(()) };
    let remedy = remedy(table, Quantity::Rate(0), RateUnit::DegreePerSecond.word());
    let insist = if source == UnitSource::Default && fast <= FASTEST {
        format!(" (or {}, if they are)", given(Quantity::Rate(0).dimension().option(), "rad/s"))
    } else {
        String::new()
    };
    Err(format!("{evidence}: these are degrees a second, not radians; {remedy}{insist}"))
}

/// Angular velocity that is exceeded for a hundredth of the time \[rad/s\].
fn usual_maximum(inputs: &[Input]) -> f64 {
    let mut rates: Vec<f64> = inputs.iter().map(|input| input.angular_velocity.amax()).collect();
    rates.sort_by(f64::total_cmp);
    rates[(rates.len() - 1) * 99 / 100]
}

/// Evidence that angular velocities are not in rad/s.
fn not_radians(table: &Table, inputs: &[Input], conventions: &Conventions) -> Option<String> {
    let step = table.step();
    let rates = |axis: usize| inputs.iter().map(move |input| input.angular_velocity[axis]);
    let is_body = conventions.rate_frame == RateFrame::Body;
    for (axis, name) in ["roll", "pitch"].into_iter().enumerate() {
        if table.has_orientation() && is_body {
            let angle = |input: &Input| input.orientation.to_vector()[axis];
            let derivative: Vec<f64> =
                inputs.windows(2).map(|pair| (angle(&pair[1]) - angle(&pair[0])) / step).collect();
            let scale = regression(&derivative, &rates(axis).take(derivative.len()).collect::<Vec<f64>>());
            if let Some(scale) = scale.filter(|scale| (30.0..100.0).contains(scale)) {
                return Some(format!("angular velocities are {scale:.0} times the derivative of {name}"));
            }
        }
        let swing = widest_swing(rates(axis), step);
        if is_body && swing > WIDEST_SWING {
            return Some(format!("in rad/s, {name} would swing by {:.0} degrees within {DRIFT} s", swing.to_degrees()));
        }
    }
    let lateral = smooth(inputs.iter().map(|input| input.specific_force.y), step);
    let yaw = smooth(rates(2), step);
    let deviation = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    if deviation(&lateral) < TURN {
        return None;
    }
    // a = v omega of a turn; a two-wheeler has no lateral force in its turns, and none that has the yaw rate's sign.
    let speed = regression(&yaw, &lateral)?;
    let radius = speed / deviation(&yaw);
    (0.0..TIGHTEST).contains(&radius).then(|| {
        format!("in rad/s, the turns' lateral force and yaw rate would be those of {speed:.2} m/s and a radius of {radius:.2} m")
    })
}

/// Slope of y over x through the origin. None where they are not correlated.
pub(super) fn regression(x: &[f64], y: &[f64]) -> Option<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (xx, xy, yy) = (dot(x, x), dot(x, y), dot(y, y));
    (xy.abs() > TOGETHER * (xx * yy).sqrt()).then(|| xy / xx)
}

/// A signal without its mean, after a first-order low-pass.
pub(super) fn smooth(values: impl Iterator<Item = f64> + Clone, step: f64) -> Vec<f64> {
    let count = values.clone().count();
    let mean = values.clone().sum::<f64>() / count as f64;
    let alpha = step / (SMOOTHING + step);
    let mut state = 0.0;
    values
        .map(|value| {
            state += alpha * (value - mean - state);
            state
        })
        .collect()
}

/// Widest swing of the integral of a rate over any [`DRIFT`] seconds, from which its straight
/// drift is removed \[rad\].
fn widest_swing(rates: impl Iterator<Item = f64>, step: f64) -> f64 {
    let angles: Vec<f64> = rates
        .scan(0.0, |angle, rate| {
            *angle += rate * step;
            Some(*angle)
        })
        .collect();
    let window = ((DRIFT / step) as usize).clamp(2, angles.len().max(2));
    // Windows that overlap by half: a swing at the end of one is in the middle of the next.
    let swing = |part: &[f64]| {
        let (first, last) = (part[0], part[part.len() - 1]);
        let slope = (last - first) / (part.len() - 1) as f64;
        let level = part.iter().enumerate().map(|(k, angle)| angle - slope * k as f64);
        let (low, high) = level.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), a| (low.min(a), high.max(a)));
        high - low
    };
    angles
        .chunks(window / 2)
        .enumerate()
        .map(|(k, _)| &angles[k * (window / 2)..(k * (window / 2) + window).min(angles.len())])
        .filter(|part| part.len() > 1)
        .map(swing)
        .fold(0.0, f64::max)
}

fn angles_are_plausible(table: &Table, inputs: &[Input]) -> Result<(), String> {
    let angles = inputs.iter().map(|input| input.orientation.roll.abs().max(input.orientation.pitch.abs()));
    let steepest = angles.fold(0.0, f64::max);
    if steepest <= STEEPEST {
        return Ok(());
    }
    Err(if unit(table, Quantity::Angle(0)).0 == AngleUnit::Radian.unit() {
        let remedy = remedy(table, Quantity::Angle(0), AngleUnit::Degree.word());
        format!("roll or pitch reaches {steepest:.0}: these are degrees, not radians; {remedy}")
    } else {
        format!("roll or pitch reaches {:.0} degrees, which no vehicle does", steepest.to_degrees())
    })
}

/// Warnings about a recording that is unusual but possible.
pub fn warnings(table: &Table, inputs: &[Input]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let mean = inputs.iter().map(|input| input.specific_force[axis]).sum::<f64>() / inputs.len() as f64;
        if mean.abs() > BIAS {
            warnings.push(format!(
                "The specific force along {name} is {mean:.2} m/s2 on average: the sensor is tilted by {:.1} degrees or \
                 biased, or the recording ends faster than it begins, or uphill. The platform will lean as much.",
                (mean / STANDARD_GRAVITY).clamp(-1.0, 1.0).asin().to_degrees()
            ));
        }
    }
    let (rate_unit, source) = unit(table, Quantity::Rate(0));
    let fast = usual_maximum(inputs);
    if source == UnitSource::Default && fast > BRISK {
        warnings.push(format!(
            "Angular velocities reach {fast:.1} {}, and neither the header nor {} gives a unit. If they are in deg/s, \
             use {}.",
            rate_unit.word,
            named("rate-unit"),
            given("rate-unit", "deg/s")
        ));
    }
    let first = inputs[0].specific_force - Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    if first.amax() > JOLT {
        warnings.push(format!(
            "The recording does not begin at rest: the specific force jumps by ({:.1}, {:.1}, {:.1}) m/s2 at once; \
             {} fades it in from rest.",
            first.x,
            first.y,
            first.z,
            given("fade-in", 1)
        ));
    }
    warnings
}
