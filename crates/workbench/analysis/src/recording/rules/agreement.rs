//! Channels that should tell the same.
//!
//! - Speed is the integral of the force along x, without gravity on slopes.
//! - The lateral force of bends is speed times yaw rate, where a vehicle does not lean.
//! - Rates are the derivatives of angles.

use std::f64::consts::TAU;

use moris_interface::shown;
use moris_simulation::measures::delay::delay;
use moris_simulation::measures::statistics::correlation;
use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::channels::{BEND_SPEED, Channels, MIN_BEND_FORCE, MIN_SPEED_CHANGE};
use crate::message::{Message, Remedy};
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{
    Axes, Conventions, Dimension, ForceUnit, Frame, Gravity, Quantity, RateUnit, SpeedUnit, Unit,
};
use crate::recording::signal::{centred, integral, is_constant, median, relation, root_mean_square, smooth};
use crate::texts::text;

/// The weaker signal may be this much smaller than the least size that is compared, because its
/// unit may be larger.
const WEAK_FRACTION: f64 = 0.01;
/// Least rates that are compared with an angle's derivative, as root mean squares \[rad/s\]: for
/// its sign and delay, and where the other may be missing.
const MIN_RATE: f64 = 0.005;
const MIN_MISSED_RATE: f64 = 0.02;
/// Ratio of two signals that should be equal, up to which they are taken as equal: slopes and bias
/// change the force.
const EQUAL_RATIO: f64 = 1.5;
/// Largest relative distance from another unit's ratio that shows this unit.
const UNIT_TOLERANCE: f64 = 0.2;
/// Ratio above which no slope or bias changes the speed, but the scale of time is wrong.
const MIN_TIME_SCALE: f64 = 5.0;
/// Ratio below which a sign is wrong. Two-wheelers have a small lateral force of either sign.
const OPPOSITE_RATIO: f64 = -0.5;
/// Difference that another reading of a channel leaves, as a part of what the given one does, from
/// which it is the right one.
const CLEAR_FRACTION: f64 = 0.3;

/// The parts w, x, y and z of a quaternion as another convention has them.
type Reading = fn([f64; 4]) -> [f64; 4];

/// True for a ratio that slopes and bias explain.
fn is_equal(ratio: f64) -> bool {
    (1.0 / EQUAL_RATIO..EQUAL_RATIO).contains(&ratio)
}

fn is_same(ratio: Option<f64>) -> bool {
    // Ratios of two signals that are the same, of either sign.
    const SAME_RATIOS: [f64; 2] = [0.67, 1.5];
    ratio.is_some_and(|ratio| (SAME_RATIOS[0]..SAME_RATIOS[1]).contains(&ratio.abs()))
}

/// True for a signal that is small beside the one that it should be, and does not go with it.
fn is_noise(found: &[f64], needed: &[f64]) -> bool {
    // Fraction of what others show, below which a channel holds noise alone.
    const NOISE_FRACTION: f64 = 0.1;
    let relation = relation(needed, found);
    relation.sizes[1] < NOISE_FRACTION * relation.sizes[0] && relation.slope().is_none()
}

/// Factor from the signal that is expected to the other; none where one is small, or they do not go
/// together.
fn signal_ratio(expected: &[f64], found: &[f64], least: f64) -> Option<f64> {
    let relation = relation(expected, found);
    let [one, other] = relation.sizes;
    let is_small = one.max(other) < least || one.min(other) < WEAK_FRACTION * least;
    if is_small { None } else { relation.slope() }
}

/// Root mean square of what two signals differ by.
fn rms_difference(one: &[f64], other: &[f64]) -> f64 {
    root_mean_square(&one.iter().zip(other).map(|(one, other)| one - other).collect::<Vec<_>>())
}

/// Each pair of axes once, by the axis of a quantity.
fn pair_of_axes(quantity: Quantity) -> Option<[usize; 2]> {
    let (Quantity::Force(axis) | Quantity::Rate(axis)) = quantity else { return None };
    [[0, 1], [0, 2], [1, 2]].get(axis).copied()
}

impl Channels<'_> {
    /// True for a speed that is measured and changes.
    fn has_speed(&self) -> bool {
        self.is_measured(Quantity::Speed) && !self.is_constant(Quantity::Speed)
    }

    /// Changes of the speed, without their mean.
    fn speed_changes(&self) -> Vec<f64> {
        centred(self.changes(&self.speeds).into_iter())
    }

    /// Ratio of the changes of speed and the integral of a force.
    fn ratio_of_force(&self, force: impl Iterator<Item = f64>) -> Option<f64> {
        let found = self.changes(&self.speeds);
        let expected = self.driven(force);
        let is_small = root_mean_square(&found) < MIN_SPEED_CHANGE
            || root_mean_square(&expected) < WEAK_FRACTION * MIN_SPEED_CHANGE;
        if is_small { None } else { relation(&expected, &self.speed_changes()).slope() }
    }

    /// True where slopes explain the changes of speed beside the force along x, as the pitch or the
    /// rate of pitch gives them.
    fn slopes_explain(&self) -> bool {
        let of_rate = centred(integral(self.rate(1), self.step).into_iter());
        let explains = |force: Vec<f64>| self.ratio_of_force(force.into_iter()).is_some_and(is_equal);
        explains(self.on_slopes(self.angle(1), 1.0)) || explains(self.on_slopes(of_rate.into_iter(), 1.0))
    }

    /// The force along x with so many times the gravity of slopes. Pitch is positive with the nose
    /// down, where gravity accelerates.
    fn on_slopes(&self, pitch: impl Iterator<Item = f64>, times: f64) -> Vec<f64> {
        self.force(0).zip(pitch).map(|(force, pitch)| force + times * STANDARD_GRAVITY * pitch.sin()).collect()
    }

    /// Part of the changes of speed that is left with so many times the gravity of slopes.
    fn left_on_slopes(&self, times: f64) -> Option<f64> {
        self.unexplained_speed(self.on_slopes(self.angle(1), times).into_iter())
    }

    /// Ratio of the changes of speed and the integral of the force along x; 1 where slopes explain
    /// it.
    fn surge_ratio(&self) -> Option<f64> {
        let ratio = self.ratio_of_force(self.force(0));
        if ratio.is_some_and(is_equal) {
            return ratio;
        }
        if self.slopes_explain() {
            return Some(1.0);
        }
        // Gravity on slopes may hide the ratio.
        ratio.or_else(|| self.ratio_of_force(self.on_slopes(self.angle(1), 1.0).into_iter()))
    }

    /// Ratio of the lateral force of bends and speed times yaw rate.
    fn sway_ratio(&self) -> Option<f64> {
        signal_ratio(&self.turning(), &self.lateral(), MIN_BEND_FORCE)
    }

    /// True for a vehicle that leans into bends, which has no lateral force.
    fn leans(&self) -> bool {
        // Roll of a vehicle that leans into bends, as a root mean square [rad].
        const LEANING_ROLL: f64 = 0.1;
        // Ratios of the vertical force in bends and that of a vehicle which leans into them.
        const BALANCED_RATIOS: [f64; 2] = [0.5, 2.0];
        let rolls = || root_mean_square(&centred(self.angle(0))) > LEANING_ROLL;
        let expected = self.smoothed(|(input, speed)| (speed * input.angular_velocity.z).hypot(STANDARD_GRAVITY));
        let vertical = self.smoothed(|(input, _)| input.specific_force.z);
        let is_balanced = |ratio: f64| (BALANCED_RATIOS[0]..BALANCED_RATIOS[1]).contains(&ratio);
        let has_lean = self.is_measured(Quantity::Lean) && !self.is_constant(Quantity::Lean);
        has_lean || rolls() || relation(&expected, &vertical).slope().is_some_and(is_balanced)
    }

    /// The sentence for a column that does not show what another does.
    fn unmeasured(&self, quantity: Quantity, contradiction: &str) -> Message {
        let name = self.conventions.column(quantity);
        if !self.is_constant(quantity) {
            return text!["unmeasured", name, contradiction];
        }
        let value = shown(self.table.value(quantity, 0) / self.table.unit(quantity).0.in_si);
        text!["unmeasured-constant", name, value, contradiction]
    }

    /// The remedy where two columns are exchanged, each with the sign that it then needs.
    fn exchanged_columns(&self, quantities: [Quantity; 2], signs: [f64; 2]) -> Message {
        if self.conventions.mounting.is_some() {
            return text!["check-mounting-alone"];
        }
        let [one, other] = quantities.map(Quantity::key);
        let signed = |key: &str, sign: f64| if sign < 0.0 { format!("-{key}") } else { key.to_owned() };
        let keys = [signed(other, signs[0]), signed(one, signs[1])];
        text!["if-they-are", remedy = self.conventions.columns_of(&[&keys[0], &keys[1]], &quantities)]
    }

    /// Part of the changes of speed that a force along x leaves unexplained; none where there are
    /// few.
    fn unexplained_speed(&self, force: impl Iterator<Item = f64>) -> Option<f64> {
        let changes = self.speed_changes();
        let size = root_mean_square(&changes);
        (size >= MIN_SPEED_CHANGE).then(|| rms_difference(&changes, &self.driven(force)) / size)
    }

    /// The angular velocities about all axes, smoothed, axis after axis; none where one is missing.
    fn measured_rates(&self) -> Option<Vec<f64>> {
        let is_usable = self.has_body_rates() && (0..3).all(|axis| self.is_measured(Quantity::Rate(axis)));
        let axis = |axis: usize| smooth(self.rate(axis).skip(1), self.step);
        is_usable.then(|| (0..3).flat_map(axis).collect())
    }

    /// The same of the orientation, whose quaternions are read and whose rates are turned so.
    fn rates_of_orientation(
        &self,
        reading: Reading,
        turned: impl Fn(&Input, Vector3<f64>) -> Vector3<f64>,
    ) -> Vec<f64> {
        let rotation = |input: &Input| {
            let RollPitchYaw { roll, pitch, yaw } = input.orientation;
            let own = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
            let [w, x, y, z] = reading([own.w, own.i, own.j, own.k]);
            UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
        };
        let rate = |pair: &[Input]| {
            let change = rotation(&pair[0]).inverse() * rotation(&pair[1]);
            turned(&pair[1], change.scaled_axis() / self.step)
        };
        let rates: Vec<Vector3<f64>> = self.inputs.windows(2).map(rate).collect();
        (0..3).flat_map(|axis| smooth(rates.iter().map(|rate| rate[axis]), self.step)).collect()
    }

    /// Ratio of a rate and the derivative of its angle, where the recording has both.
    fn rate_ratio(&self, axis: usize) -> Option<f64> {
        if !self.has_body_rates() || !self.has(Quantity::Angle(axis)) {
            return None;
        }
        let (derivative, rate) = self.derivative_and_rate(axis, TAU);
        signal_ratio(&derivative, &rate, MIN_RATE)
    }

    /// The columns that turn an angle, and the rate about its axis where that goes with it.
    fn turned_angle(&self, axis: usize) -> Remedy {
        let quantities = [Quantity::Angle(axis), Quantity::Rate(axis)];
        let [angle, rate] = quantities.map(|quantity| format!("-{}", quantity.key()));
        let count = if self.rate_ratio(axis).is_none_or(|ratio| ratio > 0.0) { 2 } else { 1 };
        self.conventions.columns_of(&[angle.as_str(), rate.as_str()][..count], &quantities[..count])
    }
}

/// A speed that goes with the force along y; without a speed, a yaw rate that goes with the force
/// along x.
pub fn exchanged_forces(channels: &Channels, _: Quantity) -> Option<Message> {
    if !channels.has(Quantity::Speed) {
        let surge = channels.smoothed(|(input, _)| input.specific_force.x);
        let speed = speed_of_bends(channels, 2, &surge)?;
        let is_expected = speed_of_bends(channels, 2, &channels.lateral()).is_some();
        let remedy = channels.exchanged_columns([Quantity::Force(0), Quantity::Force(1)], [1.0, speed]);
        return (!is_expected).then(|| text!["forces-exchanged-in-bends", remedy]);
    }
    let needed = channels.speed_changes();
    if root_mean_square(&needed) < MIN_SPEED_CHANGE {
        return None;
    }
    let ratio = |axis: usize| {
        let relation = relation(&channels.driven(channels.force(axis)), &needed);
        // Noise goes with nothing.
        relation.slope().filter(|_| relation.sizes[0] > 0.0)
    };
    if ratio(0).is_some() || !is_same(ratio(1)) {
        return None;
    }
    let remedy = channels.exchanged_columns([Quantity::Force(0), Quantity::Force(1)], [ratio(1)?, 1.0]);
    Some(text!["forces-exchanged", remedy])
}

/// The speed of bends by a rate and a force \[m/s\], of either sign; none where they are not those
/// of bends.
fn speed_of_bends(channels: &Channels, rate: usize, force: &[f64]) -> Option<f64> {
    // Correlation of two signals that nothing but bends has, and speeds of bends [m/s].
    const BEND_CORRELATION: f64 = 0.9;
    const BEND_SPEEDS: [f64; 2] = [2.0, 80.0];
    let found = relation(&smooth(channels.rate(rate), channels.step), force);
    let is_clear = found.sizes[1] >= MIN_BEND_FORCE && found.correlation.abs() > BEND_CORRELATION;
    found.slope().filter(|speed| is_clear && (BEND_SPEEDS[0]..BEND_SPEEDS[1]).contains(&speed.abs()))
}

/// Two axes of which the angle of each goes with the rate of the other.
pub fn exchanged_rates(channels: &Channels, quantity: Quantity) -> Option<Message> {
    // Least rates where axes may be exchanged, as root mean squares [rad/s].
    const MIN_EXCHANGED_RATE: f64 = 0.002;
    let [one, other] = pair_of_axes(quantity)?;
    let has_angles = [one, other].iter().all(|&axis| channels.has(Quantity::Angle(axis)));
    if !channels.has_body_rates() || !has_angles {
        return None;
    }
    let signals = [one, other].map(|axis| channels.derivative_and_rate(axis, TAU));
    let ratio =
        |angle: usize, rate: usize| relation(&signals[angle].0, &signals[rate].1).slope_above(MIN_EXCHANGED_RATE);
    let (first, second) = (ratio(0, 1), ratio(1, 0));
    if ratio(0, 0).is_some() || ratio(1, 1).is_some() || !is_same(first) || !is_same(second) {
        return None;
    }
    let remedy = channels.exchanged_columns([one, other].map(Quantity::Rate), [first?, second?]);
    let [rate, other_rate] = [other, one].map(|axis| Quantity::Rate(axis).key());
    let (angle, other_angle) = (["Roll", "Pitch", "Yaw"][one], Quantity::Angle(other).key());
    Some(text!["rates-exchanged", angle, rate, other_angle, other_rate, remedy])
}

/// Bends whose lateral force goes with a rate that is not the yaw rate.
pub fn exchanged_yaw_rate(channels: &Channels, rate: Quantity) -> Option<Message> {
    let Quantity::Rate(axis) = rate else { return None };
    let lateral = channels.lateral();
    let (found, is_expected) = if channels.has(Quantity::Speed) {
        let turning = channels.smoothed(|(input, speed)| speed * input.angular_velocity[axis]);
        let found = relation(&turning, &lateral).slope_above(MIN_BEND_FORCE).filter(|ratio| is_same(Some(*ratio)));
        (found, relation(&channels.turning(), &lateral).slope().is_some())
    } else {
        (speed_of_bends(channels, axis, &lateral), channels.speed_of_bends().is_some())
    };
    if !channels.is_measured(Quantity::Rate(2)) || is_expected {
        return None;
    }
    let remedy = channels.exchanged_columns([rate, Quantity::Rate(2)], [1.0, found?]);
    Some(text!["yaw-rate-exchanged", rate = rate.key(), remedy])
}

/// Forces that change the speed where they are taken from the world's axes to the vehicle's.
pub fn world_forces(channels: &Channels, _: Quantity) -> Option<Message> {
    let Channels { conventions, inputs, .. } = channels;
    if conventions.force_frame == Frame::World || conventions.mounting.is_some() {
        return None;
    }
    let gravity = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    let accelerations = |input: &Input| {
        let to_vehicle = Orientation::new(input.orientation).rotation.transpose();
        let own = input.specific_force - to_vehicle * gravity;
        let given = if conventions.gravity == Gravity::Removed { own } else { input.specific_force - gravity };
        [to_vehicle * given, own, given]
    };
    if !channels.has(Quantity::Speed) {
        // Without a speed the forces of bends tell it.
        let speed = |which: usize, axis: usize| {
            speed_of_bends(channels, 2, &channels.smoothed(|(input, _)| accelerations(input)[which][axis]))
        };
        let is_clear = speed(0, 1).is_some_and(|speed| speed > 0.0);
        let is_other = [(1, 0), (1, 1), (2, 0), (2, 1)].iter().all(|&(which, axis)| speed(which, axis).is_none());
        return (is_clear && is_other).then(|| text!["world-forces-in-bends"]);
    }
    let explained = |input: &Input| {
        let [world, own, given] = accelerations(input);
        // Neither level axes nor other ones of the vehicle may explain it as well.
        [world.x, own.x, given.x, -own.x, own.y, -own.y]
    };
    let left = |which: usize| channels.unexplained_speed(inputs.iter().map(|input| explained(input)[which]));
    let world = left(0)?;
    let is_clear = world < CLEAR_FRACTION && (1..6).filter_map(left).all(|other| world < CLEAR_FRACTION * other);
    is_clear.then(|| text!["world-forces"])
}

/// True where gravity has been taken out of the vertical force alone: that along x changes with
/// slopes. Conversion has put gravity back into all of them.
pub fn has_horizontal_gravity(channels: &Channels) -> bool {
    // Along x conversion has taken it away once.
    let [with, without] = [2.0, 1.0].map(|times| channels.left_on_slopes(times).unwrap_or(f64::INFINITY));
    channels.conventions.gravity == Gravity::Removed
        && channels.has(Quantity::Speed)
        && with < CLEAR_FRACTION
        && with < CLEAR_FRACTION * without
}

/// Rates that are those of the angles about the world's axes.
pub fn world_rates(channels: &Channels, _: Quantity) -> Option<Message> {
    let found = channels.measured_rates()?;
    let turned = |input: &Input, own: Vector3<f64>| Orientation::new(input.orientation).rotation * own;
    let own = rms_difference(&found, &channels.rates_of_orientation(|parts| parts, |_, own| own));
    let world = rms_difference(&found, &channels.rates_of_orientation(|parts| parts, turned));
    (own > MIN_MISSED_RATE && world < CLEAR_FRACTION * own).then(|| text!["world-rates"])
}

/// Rates that are those of the quaternion in another convention.
pub fn quaternion(channels: &Channels, _: Quantity) -> Option<Message> {
    const OTHERS: [(&str, [&str; 4], Reading); 5] = [
        ("its inverse", ["qw", "-qx", "-qy", "-qz"], |[w, x, y, z]| [w, -x, -y, -z]),
        ("one whose scalar part comes last", ["qz", "qw", "qx", "qy"], |[w, x, y, z]| [z, w, x, y]),
        ("an inverse whose scalar part comes last", ["qz", "-qw", "-qx", "-qy"], |[w, x, y, z]| [z, -w, -x, -y]),
        ("one of axes that point to the right and down", ["qw", "qx", "-qy", "-qz"], |[w, x, y, z]| [w, x, -y, -z]),
        ("an inverse of such axes", ["qw", "-qx", "qy", "qz"], |[w, x, y, z]| [w, -x, y, z]),
    ];
    if !channels.has_quaternion() || channels.conventions.axes != Axes::ForwardLeftUp {
        return None;
    }
    let found = channels.measured_rates()?;
    let left = |reading: Reading| rms_difference(&found, &channels.rates_of_orientation(reading, |_, own| own));
    let own = left(|parts| parts);
    let others = OTHERS.iter().map(|(kind, keys, reading)| (left(*reading), kind, keys));
    let (other, kind, keys) = others.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if own <= MIN_MISSED_RATE || other >= CLEAR_FRACTION * own {
        return None;
    }
    let columns = channels.conventions.columns_of(keys, &Quantity::QUATERNION);
    Some(text!["quaternion", kind = *kind, columns])
}

/// A roll that is the pitch, as the speed on slopes tells.
pub fn exchanged_angles(channels: &Channels, _: Quantity) -> Option<Message> {
    let Channels { conventions, .. } = channels;
    if conventions.gravity == Gravity::Removed || conventions.mounting.is_some() {
        return None;
    }
    let left = |times: f64| channels.unexplained_speed(channels.on_slopes(channels.angle(0), times).into_iter());
    let by_pitch = [0.0, 1.0, -1.0].into_iter().filter_map(|times| channels.left_on_slopes(times));
    let by_roll = [1.0, -1.0].into_iter().find(|&times| left(times).is_some_and(|left| left < CLEAR_FRACTION))?;
    if left(by_roll)? >= CLEAR_FRACTION * by_pitch.fold(f64::INFINITY, f64::min) {
        return None;
    }
    let quantities = [0, 1].map(Quantity::Angle);
    let remedy = channels.exchanged_columns(quantities, [1.0, by_roll]);
    Some(text!["angles-exchanged", remedy])
}

/// A pitch with the wrong sign, as the speed on slopes tells.
pub fn sign_of_pitch(channels: &Channels, _: Quantity) -> Option<Message> {
    let Channels { conventions, .. } = channels;
    if conventions.gravity == Gravity::Removed || conventions.mounting.is_some() {
        return None;
    }
    let [level, right, opposite] = [0.0, 1.0, -1.0].map(|times| channels.left_on_slopes(times));
    let (level, right, opposite) = (level?, right?, opposite?);
    if opposite > CLEAR_FRACTION || opposite > CLEAR_FRACTION * level.min(right) {
        return None;
    }
    Some(text!["pitch-opposite", columns = channels.turned_angle(1)])
}

/// A roll with the wrong sign, as gravity in bends and on banks tells, or a lean to the outside of
/// bends. The few degrees by which a car rolls in bends tell nothing: another scale of the speed
/// has the same effect.
pub fn sign_of_roll(channels: &Channels, _: Quantity) -> Option<Message> {
    // Least lateral force that is left without speed times yaw rate, as a root mean square [m/s2].
    const MIN_BANK_FORCE: f64 = 0.1;
    let Channels { conventions, .. } = channels;
    if !channels.is_measured(Quantity::Angle(0)) || conventions.mounting.is_some() {
        return None;
    }
    // Roll is positive with the right side down, where gravity's reaction is along y.
    let gravity_of = |input: &Input| STANDARD_GRAVITY * input.orientation.roll.sin() * input.orientation.pitch.cos();
    let gravity = channels.smoothed(|(input, _)| gravity_of(input));
    let turning = channels.turning();
    if relation(&turning, &gravity).slope().is_some_and(|slope| slope.abs() < 1.0 / EQUAL_RATIO) {
        return None;
    }
    let is_opposite = if conventions.gravity == Gravity::Removed {
        // Conversion has added gravity by this roll, and bends alone tell the rest.
        let kinematic = channels.smoothed(|(input, _)| input.specific_force.y - gravity_of(input));
        [kinematic, gravity]
            .iter()
            .all(|force| relation(&turning, force).slope_above(MIN_BEND_FORCE).is_some_and(is_equal))
    } else {
        let measured = channels.smoothed(|(input, speed)| input.specific_force.y - speed * input.angular_velocity.z);
        let turned: Vec<f64> = gravity.iter().map(|force| -force).collect();
        let (level, right) = (root_mean_square(&measured), rms_difference(&measured, &gravity));
        level >= MIN_BANK_FORCE && rms_difference(&measured, &turned) < CLEAR_FRACTION * level.min(right)
    };
    is_opposite.then(|| text!["roll-opposite", columns = channels.turned_angle(0)])
}

/// Two axes with the same values, of either sign. Those of a mounted sensor may be equal.
pub fn same_values(channels: &Channels, quantity: Quantity) -> Option<Message> {
    let of = if let Quantity::Force(_) = quantity { Quantity::Force } else { Quantity::Rate };
    let quantities = pair_of_axes(quantity)?.map(of);
    let Channels { table, conventions, .. } = channels;
    let [Some(one), Some(other)] = quantities.map(|quantity| table.columns.get(&quantity)) else { return None };
    let equals = |sign: f64| one.iter().zip(other).all(|(one, other)| *one == sign * other);
    if conventions.mounting.is_some() || is_constant(one) || !(equals(1.0) || equals(-1.0)) {
        return None;
    }
    let [one, other] = quantities.map(|quantity| conventions.column(quantity));
    Some(text!["same-values", one, other])
}

/// A speed that changes without a force along x, and no slope explains it.
pub fn missing_force(channels: &Channels, _: Quantity) -> Option<Message> {
    let needed = channels.speed_changes();
    let is_missing = channels.is_measured(Quantity::Force(0))
        && channels.has_speed()
        && root_mean_square(&needed) >= MIN_SPEED_CHANGE
        && (channels.is_constant(Quantity::Force(0)) || is_noise(&channels.driven(channels.force(0)), &needed))
        && !channels.slopes_explain();
    is_missing.then(|| channels.unmeasured(Quantity::Force(0), "the speed changes"))
}

/// A vehicle that does not lean and drives bends without a lateral force.
pub fn missing_lateral_force(channels: &Channels, _: Quantity) -> Option<Message> {
    // Least lateral force of bends, as a root mean square [m/s2], that one which is measured must
    // go with, and the correlation below which it does not.
    const MIN_MISSED_BEND_FORCE: f64 = 0.5;
    const UNRELATED_CORRELATION: f64 = 0.3;
    let found = relation(&channels.turning(), &channels.lateral());
    if !channels.has_speed() || found.sizes[0] < MIN_BEND_FORCE || channels.leans() {
        return None;
    }
    if channels.is_constant(Quantity::Force(1)) {
        return Some(channels.unmeasured(Quantity::Force(1), "the vehicle drives bends"));
    }
    let is_missing = channels.is_measured(Quantity::Force(1))
        && found.sizes[0] >= MIN_MISSED_BEND_FORCE
        && found.correlation.abs() < UNRELATED_CORRELATION;
    let name = channels.conventions.column(Quantity::Force(1));
    is_missing.then(|| text!["no-bends", name, size = found.sizes[0]])
}

/// A constant speed that the force along x would change.
pub fn missing_speed(channels: &Channels, _: Quantity) -> Option<Message> {
    // Least change of speed by the force that a constant speed contradicts, as a root mean square
    // [m/s].
    const MIN_DRIVEN_CHANGE: f64 = 1.0;
    let is_missing = channels.is_constant(Quantity::Speed)
        && root_mean_square(&channels.driven(channels.force(0))) >= MIN_DRIVEN_CHANGE;
    is_missing.then(|| channels.unmeasured(Quantity::Speed, "the force along x changes it"))
}

/// An angle that changes without its rate.
pub fn missing_rate(channels: &Channels, angle: Quantity) -> Option<Message> {
    let Quantity::Angle(axis) = angle else { return None };
    let quantity = Quantity::Rate(axis);
    let (derivative, rate) = channels.derivative_and_rate(axis, TAU);
    let is_missing = channels.is_measured(angle)
        && channels.is_measured(quantity)
        && channels.has_body_rates()
        && root_mean_square(&derivative) >= MIN_MISSED_RATE
        && (channels.is_constant(quantity) || is_noise(&rate, &derivative));
    is_missing.then(|| channels.unmeasured(quantity, &format!("{} changes", angle.key())))
}

/// A lateral force of bends without a yaw rate.
pub fn missing_yaw_rate(channels: &Channels, _: Quantity) -> Option<Message> {
    let lateral = channels.lateral();
    let is_missing = channels.is_measured(Quantity::Rate(2))
        && channels.has_speed()
        && median(channels.speeds.iter().map(|speed| speed.abs())) > BEND_SPEED
        && root_mean_square(&lateral) >= MIN_BEND_FORCE
        && (channels.is_constant(Quantity::Rate(2)) || is_noise(&channels.turning(), &lateral));
    is_missing.then(|| channels.unmeasured(Quantity::Rate(2), "the lateral force is that of bends"))
}

/// A unit, or a scale of time, that explains a ratio.
enum Cause {
    Unit(Quantity, Unit),
    TimeScale(f64),
    /// Factor of a speed in a unit that is not known.
    SpeedScale(f64),
    /// Factor of the force along x and y, with the units that it has and should have.
    Horizontal(f64, [Unit; 2]),
}

/// Changes of speed that are not the integral of the force along x.
pub fn speed_and_force(channels: &Channels, _: Quantity) -> Option<Message> {
    let Channels { table, conventions, .. } = channels;
    let surge = channels.surge_ratio()?;
    if surge < OPPOSITE_RATIO {
        return Some(text!["surge-opposite", surge, remedy = channels.turned(Quantity::Force(0))]);
    }
    if is_equal(surge) {
        return None;
    }
    let meaning = match ratio_cause(channels, surge, channels.sway_ratio()) {
        Some(Cause::Unit(quantity, unit)) => {
            let name = match quantity {
                Quantity::Speed => "it".to_owned(),
                _ => format!("the {}", quantity.dimension().name()),
            };
            let (given, remedy) = (table.unit(quantity).0.word, channels.unit_remedy(quantity, unit.word));
            text!["other-unit", name, other = unit.word, unit = given, remedy]
        }
        Some(Cause::TimeScale(scale)) if (1.0 / MIN_TIME_SCALE..MIN_TIME_SCALE).contains(&scale) => {
            text!["time-scale-or-slopes", pace = time_scale(conventions, scale)]
        }
        Some(Cause::TimeScale(scale)) => time_scale(conventions, scale),
        Some(Cause::SpeedScale(factor)) => {
            let columns = conventions.scaled(&[Quantity::Speed], &format!("* {factor}"));
            text!["speed-scale", factor = factor.to_string(), columns]
        }
        Some(Cause::Horizontal(factor, [unit, other])) => {
            let columns = conventions.scaled(&[0, 1].map(Quantity::Force), &format!("* {factor:.5}"));
            text!["horizontal-scale", unit = unit.word, other = other.word, columns]
        }
        None => text!["check-speed-unit"],
    };
    Some(text!["surge", surge, meaning])
}

/// The fact that time runs at another pace, and the remedy.
fn time_scale(conventions: &Conventions, scale: f64) -> Message {
    let columns = conventions.scaled(&[Quantity::Time], &format!("* {scale:.3}"));
    let (times, pace) = if scale < 1.0 { (1.0 / scale, "slow") } else { (scale, "fast") };
    text!["time-scale", times, pace, columns]
}

/// The unit or scale that explains the ratios of the changes of speed and of the lateral force.
fn ratio_cause(channels: &Channels, surge: f64, sway: Option<f64>) -> Option<Cause> {
    // Ratio above which the scale of time is wrong where the speed fits the yaw rate in bends, and
    // the relative distance of this fit.
    const MIN_TIME_SCALE_IN_BENDS: f64 = 1.8;
    const BENDS_TOLERANCE: f64 = 0.1;
    let Channels { table, conventions, .. } = channels;
    let near = |a: f64, b: f64| (a / b).ln().abs();
    // In bends a wrong unit of speed or force has the opposite effect, and that of time none.
    let of_time = sway.is_none_or(|sway| sway > 0.0 && near(sway, 1.0) < near(sway, 1.0 / surge));
    let of_others =
        sway.is_none_or(|sway| sway <= 0.0 || near(sway, 1.0) >= near(sway, 1.0 / surge) || surge < MIN_TIME_SCALE);
    // A speed that fits the yaw rate in bends has the right unit.
    let fits_bends = sway.is_some_and(|sway| near(sway, 1.0) < BENDS_TOLERANCE)
        && !(1.0 / MIN_TIME_SCALE_IN_BENDS..MIN_TIME_SCALE_IN_BENDS).contains(&surge);
    let of_others = of_others && !fits_bends;
    let mut causes: Vec<(f64, Cause)> = Vec::new();
    let mut consider = |quantity: Quantity, effect: fn(f64, f64) -> f64| {
        let given = table.unit(quantity).0;
        // Feet are too near to km/h.
        let is_other = |unit: &Unit| *unit != given && *unit != SpeedUnit::FootPerSecond.unit();
        for unit in quantity.dimension().units().filter(is_other) {
            causes.push((near(surge, effect(given.in_si, unit.in_si)), Cause::Unit(quantity, unit)));
        }
    };
    if of_others {
        consider(Quantity::Speed, |given, other| given / other);
        if conventions.gravity == Gravity::Removed {
            consider(Quantity::Force(0), |given, other| other / given);
        }
    }
    if of_time {
        consider(Quantity::Time, |given, other| other / given);
    }
    if of_others && sway.is_some() && conventions.gravity == Gravity::Included {
        let (unit, units) = (table.unit(Quantity::Force(0)).0, [ForceUnit::MetrePerSecondSquared, ForceUnit::Gravity]);
        for other in units.map(ForceUnit::unit).into_iter().filter(|other| *other != unit) {
            let factor = other.in_si / unit.in_si;
            causes.push((near(surge, factor), Cause::Horizontal(factor, [other, unit])));
        }
    }
    if of_others {
        causes.extend([0.01, 0.001].map(|factor| (near(surge, 1.0 / factor), Cause::SpeedScale(factor))));
    }
    let nearest =
        causes.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(distance, _)| *distance < UNIT_TOLERANCE);
    let is_paced = fits_bends || !(1.0 / MIN_TIME_SCALE..MIN_TIME_SCALE).contains(&surge);
    let scale = || (of_time && sway.is_some() && is_paced).then_some(Cause::TimeScale(surge));
    nearest.map(|(_, cause)| cause).or_else(scale)
}

/// A lateral force of bends against speed times yaw rate.
pub fn sign_of_bends(channels: &Channels, _: Quantity) -> Option<Message> {
    let sway = channels.sway_ratio().filter(|sway| *sway < OPPOSITE_RATIO)?;
    let [rate, force] = [Quantity::Rate(2), Quantity::Force(1)].map(|quantity| channels.turned(quantity));
    let is_mounted = channels.conventions.mounting.is_some();
    let remedy = if is_mounted { rate } else { text!["rate-or-force", rate, force] };
    Some(text!["bends-opposite", sway, remedy])
}

/// A unit of the rates that explains the lateral force of bends.
pub fn rates_of_bends(channels: &Channels, _: Quantity) -> Option<Message> {
    let sway = channels.sway_ratio()?;
    rates_in_other_unit(channels, sway, text!["bends-rates", sway])
}

/// A unit that explains the lateral force of bends. Where the speed fits the force along x, its
/// unit is right, and only that along y may have another one.
pub fn unit_of_bends(channels: &Channels, _: Quantity) -> Option<Message> {
    let sway = channels.sway_ratio()?;
    if channels.surge_ratio().is_some_and(is_equal) {
        let factor = [STANDARD_GRAVITY, 1.0 / STANDARD_GRAVITY]
            .into_iter()
            .find(|factor| (sway * factor).ln().abs() < UNIT_TOLERANCE && !channels.leans())?;
        let columns = channels.conventions.scaled(&[Quantity::Force(1)], &format!("* {factor:.5}"));
        return Some(text!["bends-scale", sway, columns]);
    }
    if sway >= 1.0 / EQUAL_RATIO {
        return None;
    }
    let Cause::Unit(quantity, other) = ratio_cause(channels, 1.0 / sway, Some(sway))? else { return None };
    let (given, source) = channels.table.unit(quantity);
    let may_be = quantity == Quantity::Force(0) || quantity == Quantity::Speed && source == UnitSource::Default;
    let (name, remedy) = (quantity.dimension().name(), channels.unit_remedy(quantity, other.word));
    may_be.then(|| text!["bends-unit", sway, name, other = other.word, unit = given.word, remedy])
}

/// A vehicle that reverses where its speed has no sign.
pub fn reversing(channels: &Channels, _: Quantity) -> Option<Message> {
    let times = &channels.reversing;
    (!times.is_empty()).then(|| text!["reversing", times = times.join(", ")])
}

/// Bends of a vehicle without a measured speed, at one that is negative, or that none has.
pub fn backward_bends(channels: &Channels, _: Quantity) -> Option<Message> {
    // Speed of bends below which a sign is wrong [m/s].
    const BACKWARD_SPEED: f64 = -3.0;
    // Speed of bends above which the rates are in a larger unit [m/s].
    const FASTEST_BENDS: f64 = 200.0;
    if channels.has(Quantity::Speed) || channels.conventions.mounting.is_some() {
        return None;
    }
    let speed = channels.speed_of_bends()?;
    if speed > FASTEST_BENDS && channels.table.unit(Quantity::Rate(2)).0 == RateUnit::DegreePerSecond.unit() {
        let remedy = channels.unit_remedy(Quantity::Rate(2), RateUnit::RadianPerSecond.word());
        return Some(text!["bends-too-fast", speed, remedy]);
    }
    if speed >= BACKWARD_SPEED {
        return None;
    }
    let [rate, force] = [Quantity::Rate(2), Quantity::Force(1)].map(|quantity| channels.turned(quantity));
    Some(text!["bends-backward", speed, remedy = text!["rate-or-force", rate, force]])
}

/// A unit of the rates that explains the ratio of what they should be and what they are.
fn rates_in_other_unit(channels: &Channels, ratio: f64, fact: Message) -> Option<Message> {
    // Largest logarithm of a ratio over that of a unit of rates.
    const RATE_UNIT_TOLERANCE: f64 = 0.4;
    let given = channels.table.unit(Quantity::Rate(2)).0;
    let distance = |unit: &Unit| (ratio * given.in_si / unit.in_si).ln().abs();
    let others = Dimension::Rate.units().filter(|other| *other != given);
    let other = others.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let remedy = channels.unit_remedy(Quantity::Rate(2), other.word);
    let is_near = ratio > 0.0 && distance(&other) < RATE_UNIT_TOLERANCE;
    is_near.then(|| text!["rates-in-unit", fact, other = other.word, unit = given.word, remedy])
}

/// A rate against the derivative of its angle.
pub fn sign_of_rates(channels: &Channels, angle: Quantity) -> Option<Message> {
    let Quantity::Angle(axis) = angle else { return None };
    let rate = Quantity::Rate(axis);
    let ratio = channels.rate_ratio(axis).filter(|ratio| *ratio < OPPOSITE_RATIO)?;
    let [turned_rate, turned_angle] = [rate, angle].map(|quantity| channels.turned(quantity));
    let (rate, angle) = (rate.key(), angle.key());
    Some(text!["rate-opposite", rate, ratio, angle, turned_rate, turned_angle])
}

/// Rates that are all as many times the derivatives of the angles.
pub fn scale_of_rates(channels: &Channels, _: Quantity) -> Option<Message> {
    let sizes: Vec<f64> = (0..3).filter_map(|axis| channels.rate_ratio(axis)).map(f64::abs).collect();
    let size = sizes.iter().product::<f64>().powf(1.0 / sizes.len().max(1) as f64);
    let agree = !sizes.is_empty() && sizes.iter().all(|other| (other / size).ln().abs() < UNIT_TOLERANCE);
    if (0.5..2.0).contains(&size) || !agree {
        return None;
    }
    let of_time = || {
        let pace = time_scale(channels.conventions, 1.0 / size);
        (sizes.len() > 1).then(|| text!["rates-and-time", size, pace])
    };
    rates_in_other_unit(channels, 1.0 / size, text!["rates-and-angles", size]).or_else(of_time)
}

/// A speed, a lateral force of bends or an angle that comes later or earlier than what it follows.
pub fn delayed(channels: &Channels, quantity: Quantity) -> Option<Message> {
    let (expected, found, least, cause) = match quantity {
        Quantity::Speed => {
            let expected = channels.changes(&integral(channels.force(0), channels.step));
            (expected, channels.changes(&channels.speeds), MIN_SPEED_CHANGE, "the force along x that changes it")
        }
        Quantity::Force(_) => (channels.turning(), channels.lateral(), MIN_BEND_FORCE, "speed times yaw rate"),
        Quantity::Angle(axis) if channels.has_body_rates() && channels.has(quantity) => {
            let (derivative, rate) = channels.derivative_and_rate(axis, TAU);
            (rate, derivative, MIN_RATE, "the angular velocity that changes it")
        }
        _ => return None,
    };
    let delay = clear_delay(&expected, &found, least, channels.step)?;
    let (place, remedy) = if delay > 0.0 { ("after", "earlier") } else { ("before", "later") };
    Some(text!["delayed", name = quantity.key(), delay = delay.abs(), place, cause, remedy])
}

/// The delay of a signal behind the one that is expected, where it explains most of their
/// difference \[s\].
fn clear_delay(expected: &[f64], found: &[f64], least: f64, step: f64) -> Option<f64> {
    // Least delay that is warned of, of either sign [s].
    const MIN_DELAY: f64 = 0.2;
    // Largest fraction of the unexplained variance that is left without the delay.
    const MAX_UNEXPLAINED_FRACTION: f64 = 0.2;
    if root_mean_square(found) < least {
        return None;
    }
    let delay = delay(expected, found, step).filter(|delay| delay.abs() >= MIN_DELAY)?;
    let shift = (delay.abs() / step).round() as usize;
    let (earlier, later) = if delay > 0.0 { (expected, found) } else { (found, expected) };
    let unexplained = |shift: usize| {
        let correlation = correlation(&earlier[..earlier.len() - shift], &later[shift..])?;
        Some(1.0 - correlation * correlation)
    };
    (unexplained(shift)? < MAX_UNEXPLAINED_FRACTION * unexplained(0)?).then_some(delay)
}
