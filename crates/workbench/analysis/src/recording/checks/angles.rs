//! Wrong units of roll, pitch, yaw and lean, by their size and by the rates.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::{Channels, remedy};
use crate::message::{Message, given, message};
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{AngleUnit, Quantity};
use crate::recording::signal::{median, regression, root_mean_square};

/// Roll or pitch that no vehicle exceeds \[rad\].
const STEEPEST: f64 = 3.2;
/// Roll, pitch or lean that vehicles reach only where their rates show it \[rad\].
const STEEP: f64 = FRAC_PI_2 + 0.1;
/// Ratios of an angle's derivative and a rate that show degrees.
const DEGREES: [f64; 2] = [30.0, 110.0];
/// Spread of a derivative that hardly varies, as a part of it.
const STEADY: f64 = 0.2;
/// Least derivative and rate that are compared, as root mean squares \[rad/s\].
const LEAST_RATE: f64 = 0.005;

/// Rejects angles that no vehicle reaches, and those that change as degrees would. A given unit
/// overrides all tests but the first.
pub fn check(channels: &Channels) -> Result<(), Message> {
    let Channels { table, inputs, .. } = channels;
    let angles = inputs.iter().map(|input| input.orientation.roll.abs().max(input.orientation.pitch.abs()));
    let steepest = angles.fold(0.0, f64::max);
    let is_radians = |quantity| table.unit(quantity).0 == AngleUnit::Radian.unit();
    if steepest > STEEPEST {
        return Err(if is_radians(Quantity::Angle(0)) {
            let remedy = remedy(table, Quantity::Angle(0), AngleUnit::Degree.word());
            message![
                "roll or pitch reaches {steepest:.0}: these are degrees, not radians; ",
                remedy,
                ", or whole turns too many; write angles from -pi to pi"
            ]
        } else {
            format!("roll or pitch reaches {:.0} degrees, which no vehicle does", steepest.to_degrees()).into()
        });
    }
    let is_open = |quantity| table.unit(quantity).1 == UnitSource::Default && table.columns.contains_key(&quantity);
    let lean = inputs.iter().map(|input| input.lean.abs()).fold(0.0, f64::max);
    let evidence = (0..3)
        .filter(|&axis| is_open(Quantity::Angle(axis)))
        .find_map(|axis| evidence(channels, axis))
        .map(|evidence| (Quantity::Angle(0), evidence))
        .or_else(|| {
            (is_open(Quantity::Lean) && lean > STEEP).then(|| (Quantity::Lean, format!("lean reaches {lean:.1}")))
        });
    let Some((quantity, evidence)) = evidence else { return Ok(()) };
    let remedy = remedy(table, quantity, AngleUnit::Degree.word());
    let radians = given(quantity.dimension().option(), AngleUnit::Radian.word());
    Err(message!["{evidence}: these are degrees, not radians; ", remedy, " (or ", radians, ", if they are)"])
}

/// Evidence that an angle is in degrees.
fn evidence(channels: &Channels, axis: usize) -> Option<String> {
    let name = Quantity::Angle(axis).key();
    let ratio = |period: f64| {
        let (derivative, rate) = channels.derivative_and_rate(axis, period);
        let is_small = |values: &[f64]| root_mean_square(values) < LEAST_RATE;
        if is_small(&derivative) || is_small(&rate) { None } else { regression(&rate, &derivative) }
    };
    // Degrees jump by 360. A steady turn has nothing but the two means.
    let of_changes = || ratio(360.0).or_else(|| steady_ratio(channels, axis));
    let of_changes = channels.has_body_rates().then(of_changes).flatten();
    if let Some(ratio) = of_changes.filter(|ratio| (DEGREES[0]..DEGREES[1]).contains(&ratio.abs())) {
        return Some(format!("{name} changes {:.0} times as fast as its rate", ratio.abs()));
    }
    let reach = channels.inputs.iter().map(|input| input.orientation.to_vector()[axis].abs()).fold(0.0, f64::max);
    let is_confirmed = || ratio(TAU).is_some_and(|ratio| (0.5..2.0).contains(&ratio.abs()));
    (axis < 2 && reach > STEEP && !is_confirmed()).then(|| format!("{name} reaches {reach:.1}"))
}

/// Ratio of an angle's derivative in degrees and a rate that hardly vary; none of others.
fn steady_ratio(channels: &Channels, axis: usize) -> Option<f64> {
    let derivative = || channels.derivative(axis, 360.0);
    let usual = median(derivative());
    let rate = median(channels.rate(axis));
    let spread = median(derivative().map(|change| (change - usual).abs()));
    (rate.abs() > LEAST_RATE && spread < STEADY * usual.abs()).then(|| usual / rate)
}
