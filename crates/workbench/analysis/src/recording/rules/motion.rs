//! Motion that is unusual but possible.

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use super::channels::Channels;
use super::units::usual_maximum;
use crate::message::Message;
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{Gravity, Quantity};
use crate::recording::signal::{integral, relation, smooth};
use crate::texts::text;

/// A lasting force along x or y, and what may be its cause.
pub fn bias(channels: &Channels, quantity: Quantity) -> Option<Message> {
    // Mean acceleration above which the sensor or the road is taken as tilted [m/s2].
    const MIN_BIAS: f64 = 0.3;
    let inputs = channels.inputs;
    let mean_of = |value: &dyn Fn(&Input) -> f64| inputs.iter().map(value).sum::<f64>() / inputs.len() as f64;
    let is_along_x = quantity == Quantity::Force(0);
    let mean = mean_of(&|input| input.specific_force[usize::from(!is_along_x)]);
    let gain = inputs[inputs.len() - 1].speed - inputs[0].speed;
    let (axis, motion, explained) = if is_along_x {
        ("x", "the recording ends faster than it begins", gain / (inputs.len() as f64 * channels.step))
    } else {
        ("y", "the bends are mostly to one side", mean_of(&|input| input.speed * input.angular_velocity.z))
    };
    let tilt = (mean / STANDARD_GRAVITY).clamp(-1.0, 1.0).asin().to_degrees();
    let cause = if channels.has(Quantity::Speed) && (mean - explained).abs() < MIN_BIAS {
        text!["bias-of-speed", motion]
    } else if is_along_x {
        text!["bias-x", tilt, motion]
    } else {
        text!["bias-y", tilt, motion]
    };
    (mean.abs() > MIN_BIAS).then(|| text!["bias", axis, mean, cause])
}

/// Accelerations that may be in g: without gravity and speed only the motion tells their unit.
pub fn force_unit(channels: &Channels, _: Quantity) -> Option<Message> {
    // Largest force along x and y below which accelerations of vehicles may be in g [m/s2].
    const WEAK_FORCE: f64 = 1.5;
    // Speed that no vehicle has in bends, or gains in this time [m/s, s].
    const MAX_SPEED: f64 = 100.0;
    const GAIN_TIME: f64 = 30.0;
    let (unit, source) = channels.table.unit(Quantity::Force(0));
    let is_unknown = source == UnitSource::Default && !channels.has(Quantity::Speed);
    let force = channels.inputs.iter().map(|input| input.specific_force.xy().norm()).fold(0.0, f64::max);
    let gained = integral(channels.force(0), channels.step);
    let window = (GAIN_TIME / channels.step) as usize;
    let gain = gained.iter().skip(window).zip(&gained).map(|(after, before)| (after - before).abs());
    let bends = relation(&smooth(channels.rate(2), channels.step), &channels.lateral()).slope().unwrap_or(0.0);
    let speed = gain.fold(bends.abs(), f64::max);
    let is_possible = speed * STANDARD_GRAVITY < MAX_SPEED;
    let may_be = channels.conventions.gravity == Gravity::Removed && is_unknown && force < WEAK_FORCE && is_possible;
    may_be.then(|| text!["force-unit", force, unit = unit.word])
}

/// Rates that may be in another unit than the one that is taken.
pub fn fast_rates(channels: &Channels, _: Quantity) -> Option<Message> {
    // Angular velocity that few heads exceed for a hundredth of a recording [rad/s].
    const BRISK_RATE: f64 = 2.5;
    let (unit, source) = channels.table.unit(Quantity::Rate(0));
    let fast = usual_maximum(channels.inputs);
    let is_open = source == UnitSource::Default && fast > BRISK_RATE;
    is_open.then(|| text!["fast-rates", fast, unit = unit.word])
}

/// A beginning in motion.
pub fn jolt(channels: &Channels, _: Quantity) -> Option<Message> {
    // Cue at the first sample above which the recording begins with a jolt [m/s2].
    const MIN_JOLT: f64 = 1.0;
    let cue = channels.inputs[0].specific_force - Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    (cue.amax() > MIN_JOLT).then(|| text!["jolt", x = cue.x, y = cue.y, z = cue.z])
}
