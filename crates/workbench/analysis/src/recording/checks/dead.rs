//! Channels that stand still while others show that they must not.

use std::f64::consts::TAU;

use moris_interface::shown;
use moris_washout::Input;

use super::consistency::{LEAST_CHANGE, LEAST_SWAY, changes, derivative_and_rate};
use super::speeds::signed_speeds;
use crate::recording::conventions::{Conventions, Quantity, RateFrame};
use crate::recording::message::named;
use crate::recording::signal::{is_constant, median, root_mean_square, smooth};
use crate::recording::table::Table;

/// Speed above which bends need a yaw rate \[m/s\].
const DRIVES: f64 = 3.0;
/// Least rate of an angle that needs a rate, as a root mean square \[rad/s\].
const LEAST_RATE: f64 = 0.02;

/// Warnings about channels with one value throughout, while the vehicle speeds up, turns or leans.
pub fn warnings(table: &Table, inputs: &[Input], conventions: &Conventions) -> Vec<String> {
    let step = table.step();
    let is_measured = |quantity: Quantity| table.layout.iter().any(|column| column.quantity == quantity);
    let is_dead = |quantity: Quantity| {
        is_measured(quantity) && table.columns.get(&quantity).is_some_and(|values| is_constant(values))
    };
    let has_speed = is_measured(Quantity::Speed) && !is_dead(Quantity::Speed);
    let (speeds, _) = signed_speeds(inputs, step);
    let speeds_up = || has_speed && root_mean_square(&changes(&speeds, step)) >= LEAST_CHANGE;
    let smoothed = |values: &mut dyn Iterator<Item = f64>| root_mean_square(&smooth(values, step));
    let bends = || {
        let turning = inputs.iter().zip(&speeds).map(|(input, speed)| speed * input.angular_velocity.z);
        has_speed && smoothed(&mut { turning }) >= LEAST_SWAY
    };
    let sways = || {
        let lateral = inputs.iter().map(|input| input.specific_force.y);
        has_speed && median(speeds.iter().map(|speed| speed.abs())) > DRIVES && smoothed(&mut { lateral }) >= LEAST_SWAY
    };
    let turns = |axis: usize| {
        let changes = || root_mean_square(&derivative_and_rate(inputs, axis, step, TAU).0) >= LEAST_RATE;
        is_measured(Quantity::Angle(axis)) && conventions.rate_frame == RateFrame::Body && changes()
    };
    let mut warnings = Vec::new();
    let mut warn = |quantity: Quantity, contradiction: &str| {
        let value = table.value(quantity, 0) / table.unit(quantity).0.in_si;
        warnings.push(format!(
            "Column {} is constant, {}, {contradiction}: it is not measured. Name the column that is with {}.",
            conventions.column(quantity),
            shown(value),
            named("columns")
        ));
    };
    if is_dead(Quantity::Force(0)) && speeds_up() {
        warn(Quantity::Force(0), "while the speed changes");
    }
    if is_dead(Quantity::Force(1)) && bends() {
        warn(Quantity::Force(1), "while the vehicle drives bends");
    }
    for (axis, name) in ["roll", "pitch", "yaw"].into_iter().enumerate() {
        if is_dead(Quantity::Rate(axis)) && turns(axis) {
            warn(Quantity::Rate(axis), &format!("while {name} changes"));
        }
    }
    if is_dead(Quantity::Rate(2)) && !turns(2) && sways() {
        warn(Quantity::Rate(2), "while the lateral force is that of bends");
    }
    warnings
}
