//! Compares the telemetry with its table over the first minute: units, axes and gravity.
//!
//! Recordings are tested by the same facts. Rates are the derivatives of angles, the force
//! along x changes the speed, the force along y is that of bends, and gravity is along z.
//! What a unit, an exchanged axis or the gravity of the table explains is a [`TableFault`],
//! with the line to change.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::{self, Display, Formatter};
use std::sync::LazyLock;

use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY};
use moris_washout::motion::orientation::Orientation;
use nalgebra::Vector3;

use crate::motion::{Channels, Motion, Sample};
use crate::relation::{Relation, Sums, compared_sample};

/// Windows with which two channels are judged.
const ENOUGH_WINDOWS: f64 = 12.0;
/// Correlation of two channels that are the same quantity, in any unit.
const SAME_CORRELATION: f64 = 0.8;
/// The same where the factors of units are near to each other.
const STRICT_CORRELATION: f64 = 0.9;
/// Largest factor between a ratio and that of a unit of rates that explains it.
const UNIT_FACTOR: f64 = 1.4;
/// Least forces that say something, as root mean squares \[m/s2\].
const LEAST_FORCE: f64 = 0.3;
/// Angles up to which a body's rates are those of its angles, about \[rad\].
const LEVEL_ANGLE: f64 = 0.3;
/// Roll and pitch beyond which angles are no radians \[rad\].
const LARGEST_ANGLE: f64 = 1.6;
/// Angular velocity that no head keeps \[rad/s\].
const FASTEST_RATE: f64 = 10.0;

/// Correlation below which two channels are not the same quantity.
const OTHER_CORRELATION: f64 = 0.5;
/// Windows with which another reading of a channel is judged, and the part of what the given one
/// leaves unexplained that it may leave, as for recordings.
const CLEAR_WINDOWS: f64 = 20.0;
const CLEAR_PART: f64 = 0.3;
/// Speed below which the source has none \[m/s\].
const NO_SPEED: f64 = 0.1;

/// Time for which the mean force must be of one kind, to contradict or to agree \[s\].
const GRAVITY_HELD: f64 = 1.5;

/// A table that contradicts its telemetry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableFault {
    /// Name of its sentence in `table_faults.toml`.
    name: &'static str,
    /// The number that shows it.
    value: f64,
    /// The axis, and the one with which it is exchanged.
    axes: [usize; 2],
}

/// Sentences by the names of faults.
static SENTENCES: LazyLock<BTreeMap<String, String>> =
    LazyLock::new(|| toml::from_str(include_str!("table_faults.toml")).unwrap_or_default());

/// The sentence of a name.
pub(crate) fn sentence(name: &'static str) -> &'static str {
    SENTENCES.get(name).map_or(name, String::as_str)
}

impl TableFault {
    fn new(name: &'static str, value: f64) -> Self {
        TableFault { name, value, axes: [0; 2] }
    }

    /// A clock that advances by so many seconds in a second.
    pub fn of_pace(pace: f64) -> Self {
        let name = match pace {
            300.0..3000.0 => "time-ms",
            3e-4..3e-3 => "time-s",
            _ => "time-scale",
        };
        TableFault::new(name, pace)
    }

    /// Rates so many times the derivatives of the angles, or those of bends.
    fn of_rates(ratio: f64) -> Self {
        TableFault::new(if ratio > 1.0 { "rates-large" } else { "rates-small" }, ratio)
    }

    /// Kind of the fault, whatever its remedy.
    pub fn kind(&self) -> &'static str {
        self.name.split('-').next().unwrap_or_default()
    }
}

impl Display for TableFault {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        const RATE_NAMES: [&str; 3] = ["wx", "wy", "wz"];
        const ANGLE_NAMES: [&str; 3] = ["roll", "pitch", "yaw"];
        let TableFault { name, value, axes: [axis, other] } = *self;
        for (k, part) in sentence(name).split(['{', '}']).enumerate() {
            match part {
                "value:.0" => write!(f, "{value:.0}"),
                "value:.1" => write!(f, "{value:.1}"),
                "value:.2" => write!(f, "{value:.2}"),
                "value:.3" => write!(f, "{value:.3}"),
                "inverse:.0" => write!(f, "{:.0}", 1.0 / value),
                "inverse:.1e" => write!(f, "{:.1e}", 1.0 / value),
                "gravity / value:.4" => write!(f, "{:.4}", STANDARD_GRAVITY / value),
                "rate" => f.write_str(RATE_NAMES[axis]),
                "angle" => f.write_str(ANGLE_NAMES[axis]),
                "other rate" => f.write_str(RATE_NAMES[other]),
                "other angle" => f.write_str(ANGLE_NAMES[other]),
                "force" => f.write_str(["ax", "ay"][axis]),
                "cause" => f.write_str(["the change of speed", "speed times wz"][axis]),
                _ if k % 2 == 0 => f.write_str(part),
                _ => write!(f, "{{{part}}}"),
            }?;
        }
        Ok(())
    }
}

/// The fault of a force so many times that of the speed.
fn unit_of_force(ratio: f64) -> Option<TableFault> {
    // Largest factor between a ratio and that of a unit that explains it: units of force are near
    // to each other.
    const NEAR_UNIT_FACTOR: f64 = 1.2;
    const UNITS: [(f64, &str); 6] = [
        (1.0 / STANDARD_GRAVITY, "force-g"),
        (STANDARD_GRAVITY, "force-si"),
        (1.0 / 3.6, "force-km"),
        (3.6, "force-m"),
        (0.44704, "force-mile"),
        (1.0 / 0.44704, "force-m"),
    ];
    let is_near = |unit: f64| (1.0 / NEAR_UNIT_FACTOR..NEAR_UNIT_FACTOR).contains(&(ratio / unit));
    UNITS.into_iter().find(|(unit, _)| is_near(*unit)).map(|(_, name)| TableFault::new(name, ratio))
}

/// The comparison so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TableCheck {
    last: Option<(f64, Sample)>,
    window: Window,
    time: f64,
    windows: f64,
    fast_windows: f64,
    upside_down_windows: f64,
    largest_angle: f64,
    largest_yaw: f64,
    fastest: f64,
    has_attitude: bool,
    /// Derivatives of the angles, by column, and rates, by row.
    rates: [[Sums; 3]; 3],
    /// The change of speed with gravity's part, and the force along x.
    surge: Sums,
    /// Speed times each rate, and the force along y without gravity's part.
    bends: [Sums; 3],
    /// The change of speed with so many times gravity's part, 0 and the opposite one, and the force
    /// along x.
    slopes: [Sums; 2],
    /// The change of speed, and the force along x turned from the world's axes, without gravity or
    /// with it.
    world: [Sums; 2],
    /// The change of speed with gravity's part, and the force along y.
    crossed: Sums,
    /// Speed times yaw rate with so many times gravity's part, 1, 0 and the opposite one, and the
    /// force along y.
    banks: [Sums; 3],
    /// Speed times yaw rate and the force along y, whatever the attitude.
    turns: Sums,
    /// Speed times yaw rate, and gravity's part along y.
    leaning: Sums,
    /// Each rate and the force along y, and the yaw rate and the force along x.
    sways: [Sums; 3],
    yaw_surge: Sums,
    gravity: MeanForce,
    found: Option<TableFault>,
}

/// Integrals over a window.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Window {
    time: f64,
    sum: Channels,
    begin: Channels,
}

impl TableCheck {
    /// Takes a sample of this time \[s\].
    pub fn take(&mut self, time: f64, sample: &Sample) {
        // Time for which samples are compared [s].
        const COMPARED_TIME: f64 = 60.0;
        // Time over which samples are averaged before they are compared [s].
        const WINDOW_TIME: f64 = 0.25;
        let Some((interval, before)) = compared_sample(&mut self.last, time, sample) else {
            self.window = Window::default();
            return;
        };
        self.gravity.take(interval, sample);
        if self.time >= COMPARED_TIME {
            return;
        }
        self.time += interval;
        let window = &mut self.window;
        if window.time == 0.0 {
            window.begin = before.motion.0;
        }
        window.time += interval;
        window.sum += 0.5 * interval * (before.motion.0 + sample.motion.0);
        if window.time >= WINDOW_TIME {
            let Window { time, sum, begin } = std::mem::take(window);
            self.compare(&Motion(sum / time), &Motion((sample.motion.0 - begin) / time), time, sample);
            self.found = self.judge();
        }
    }

    /// Compares the means and slopes of a window.
    fn compare(&mut self, mean: &Motion, slope: &Motion, time: f64, sample: &Sample) {
        // The level angle where degrees are read as radians.
        const LEVEL_IN_DEGREES: f64 = LEVEL_ANGLE * 180.0 / PI;
        // A change of an angle within a window that may be a whole turn [rad].
        const WHOLE_TURN_CHANGE: f64 = 3.0;
        // Part of a turn's force that gravity may make up for: a vehicle that leans more is left
        // out.
        const MAX_LEAN_FRACTION: f64 = 0.25;
        // Speed below which a vehicle may be reversing, or hardly moves [m/s].
        const MANOEUVRING_SPEED: f64 = 1.5;
        // Cosine of the angle to the vertical below which a vehicle is upside down.
        const UPSIDE_DOWN: f64 = -0.5;
        let (force, rates, speed) = (mean.force(), mean.rates(), mean.speed());
        let RollPitchYaw { roll, pitch, yaw } = mean.angles();
        let (angle_slopes, speed_slope) = (slope.angles().to_vector(), slope.speed());
        self.windows += 1.0;
        self.fast_windows += f64::from(rates.iter().any(|rate| rate.abs() > FASTEST_RATE));
        self.fastest = self.fastest.max(speed.abs());
        self.upside_down_windows += f64::from(libm::cos(roll) * libm::cos(pitch) < UPSIDE_DOWN);
        // Columns of zeros are no attitude.
        let has_attitude = sample.has_angles && (roll != 0.0 || pitch != 0.0);
        self.has_attitude |= has_attitude;
        let is_level = |most: f64| roll.abs() < most && pitch.abs() < most;
        if has_attitude && is_level(LEVEL_IN_DEGREES) {
            self.largest_angle = self.largest_angle.max(roll.abs()).max(pitch.abs());
            self.largest_yaw = self.largest_yaw.max(yaw.abs());
            for angle in (0..3).filter(|&angle| (angle_slopes[angle] * time).abs() < WHOLE_TURN_CHANGE) {
                (0..3).for_each(|rate| self.rates[rate][angle].add(angle_slopes[angle], rates[rate]));
            }
        }
        let gravity = if has_attitude && is_level(LARGEST_ANGLE) { STANDARD_GRAVITY } else { 0.0 };
        (0..3).for_each(|rate| self.sways[rate].add(rates[rate], force.y));
        self.yaw_surge.add(rates.z, force.x);
        if speed.abs() < MANOEUVRING_SPEED {
            return;
        }
        // Nose up, gravity's reaction is forward; with the left side up, to the left.
        let uphill = -gravity * libm::sin(pitch);
        self.surge.add(speed_slope + uphill, force.x);
        self.crossed.add(speed_slope + uphill, force.y);
        let banked = gravity * libm::sin(roll) * libm::cos(pitch);
        let turn = speed * rates.z;
        self.turns.add(turn, force.y);
        if gravity > 0.0 {
            [0.0, -1.0]
                .iter()
                .zip(&mut self.slopes)
                .for_each(|(part, sums)| sums.add(speed_slope + part * uphill, force.x));
            let parts = [1.0, 0.0, -1.0];
            parts.iter().zip(&mut self.banks).for_each(|(part, sums)| sums.add(turn + part * banked, force.y));
            self.leaning.add(turn, banked);
            let to_vehicle = Orientation::new(RollPitchYaw::new(roll, pitch, yaw)).rotation.transpose();
            let up = to_vehicle * Vector3::z() * gravity;
            self.world[0].add(speed_slope + uphill, (to_vehicle * force).x);
            // Live has put gravity back along the vehicle's axes.
            self.world[1].add(speed_slope, (to_vehicle * (force - up)).x);
        }
        if banked.abs() <= MAX_LEAN_FRACTION * turn.abs().max(speed * rates.x.abs()) {
            (0..3).for_each(|rate| self.bends[rate].add(speed * rates[rate], force.y - banked));
        }
    }

    /// The first fault so far.
    pub fn fault(&self) -> Option<TableFault> {
        self.found.or_else(|| self.gravity.fault())
    }

    fn judge(&self) -> Option<TableFault> {
        self.units_of_rates()
            .or_else(|| self.gravity.fault())
            .or_else(|| self.attitude())
            .or_else(|| self.exchanged_rates())
            .or_else(|| self.world_forces())
            .or_else(|| self.exchanged_forces())
            .or_else(|| self.units_of_forces())
            .or_else(|| self.missing_bends())
            .or_else(|| self.missing_channel())
    }

    /// An attitude that gravity contradicts: upside down, or of the opposite sign.
    fn attitude(&self) -> Option<TableFault> {
        // Least force that an attitude of the wrong sign leaves, as a root mean square [m/s2].
        const LEAST_WRONG_FORCE: f64 = 0.1;
        // Part of speed times yaw rate below which gravity's part may be another scale of the speed: a
        // car rolls a little in bends.
        const LEANING_PART: f64 = 0.67;
        if self.windows >= ENOUGH_WINDOWS && self.upside_down_windows == self.windows {
            return Some(TableFault::new("upside_down", 0.0));
        }
        let is_wrong = |[right, level, opposite]: [&Sums; 3]| {
            let [right, level, opposite] = [right, level, opposite].map(|sums| sums.relation());
            let others = right.difference().min(level.difference());
            let is_clear = others >= LEAST_WRONG_FORCE && opposite.difference() < CLEAR_PART * others;
            level.count >= CLEAR_WINDOWS && is_clear
        };
        let attitude = |axis: usize| TableFault { axes: [axis; 2], ..TableFault::new("attitude", 0.0) };
        let leaning = self.leaning.relation();
        let may_be_scale = leaning.correlation.abs() > SAME_CORRELATION && leaning.ratio < LEANING_PART;
        let [level, opposite] = &self.slopes;
        if is_wrong([&self.surge, level, opposite]) {
            return Some(attitude(1));
        }
        (!may_be_scale && is_wrong(self.banks.each_ref())).then(|| attitude(0))
    }

    fn world_forces(&self) -> Option<TableFault> {
        // Another axis of the vehicle, of either sign, may explain it as well.
        let own =
            [&self.surge, &self.crossed, &self.slopes[0]].map(|sums| sums.relation().of_either_sign().difference());
        let others = own.into_iter().fold(f64::INFINITY, f64::min);
        let is_clear = |sums: &Sums| {
            let relation = sums.relation();
            let is_large = relation.count >= CLEAR_WINDOWS && relation.sizes[0] >= LEAST_FORCE;
            is_large && relation.difference() < CLEAR_PART * others.min(relation.sizes[0])
        };
        self.world.iter().any(is_clear).then(|| TableFault::new("world_forces", 0.0))
    }

    fn exchanged_forces(&self) -> Option<TableFault> {
        let [surge, crossed] = [self.surge, self.crossed].map(|sums| sums.relation().of_either_sign());
        let is_other = surge.correlation < OTHER_CORRELATION || crossed.difference() < CLEAR_PART * surge.difference();
        let by_speed = crossed.count >= ENOUGH_WINDOWS
            && crossed.sizes[0] >= LEAST_FORCE
            && crossed.is_near(1.0, UNIT_FACTOR, SAME_CORRELATION)
            && is_other;
        let by_bends = self.is_speed_of_bends(&self.yaw_surge) && self.has_other_bends(2);
        (by_speed || by_bends).then(|| TableFault::new("exchanged_forces", 0.0))
    }

    /// True for a rate and a force whose ratio is the speed of bends, where the source has none.
    fn is_speed_of_bends(&self, sums: &Sums) -> bool {
        const SPEEDS_OF_BENDS: [f64; 2] = [2.0, 80.0];
        let relation = sums.relation();
        self.fastest < NO_SPEED
            && relation.count >= CLEAR_WINDOWS
            && relation.sizes[1] >= LEAST_FORCE
            && relation.correlation.abs() > STRICT_CORRELATION
            && (SPEEDS_OF_BENDS[0]..SPEEDS_OF_BENDS[1]).contains(&relation.ratio)
    }

    /// True where the force along y does not follow this rate.
    fn has_other_bends(&self, rate: usize) -> bool {
        self.sways[rate].relation().correlation.abs() < OTHER_CORRELATION
    }

    /// A force or rate that is nothing beside what it changes. Tables may have no rates at all.
    fn missing_channel(&self) -> Option<TableFault> {
        // Least change of speed and of angles that shows it, as root mean squares [m/s2, rad/s], the
        // part of it below which a channel is nothing, and rates of a table that has them [rad/s].
        const LEAST_CHANGES: [f64; 2] = [0.7, 0.02];
        const NOTHING_PART: f64 = 0.02;
        const LEAST_OTHER_RATE: f64 = 1e-3;
        let is_nothing = |relation: &Relation, least: f64| {
            let is_known = relation.count >= CLEAR_WINDOWS && relation.sizes[0] >= least;
            is_known && relation.sizes[1] < NOTHING_PART * relation.sizes[0]
        };
        // Gravity may make up for a change of speed, and engines for gravity.
        let changes = [&self.surge, &self.slopes[0]];
        if self.has_attitude && changes.iter().all(|sums| is_nothing(&sums.relation(), LEAST_CHANGES[0])) {
            return Some(TableFault::new("missing_force", 0.0));
        }
        let rates = [0, 1, 2].map(|axis| self.rates[axis][axis].relation());
        let has_rates = rates.iter().any(|relation| relation.sizes[1] >= LEAST_OTHER_RATE);
        let missing = (0..3).find(|&axis| has_rates && is_nothing(&rates[axis], LEAST_CHANGES[1]));
        missing.map(|axis| TableFault { axes: [axis; 2], ..TableFault::new("missing_rate", 0.0) })
    }

    fn units_of_rates(&self) -> Option<TableFault> {
        // Least rates that say something, as root mean squares [rad/s].
        const LEAST_RATE: f64 = 0.005;
        // Radius below which no vehicle turns [m].
        const TIGHTEST_RADIUS: f64 = 1.0;
        // Part of the windows that must be faster than any head.
        const FAST_PART: f64 = 0.1;
        // Yaw that counts turns, beyond a whole one, or is no radians [rad].
        const WHOLE_TURN: f64 = 6.4;
        // Radians in a degree.
        const DEGREE: f64 = PI / 180.0;
        // Windows with which rates in degrees are found: few, to find them before the platform engages.
        const DEGREES_WINDOWS: f64 = 4.0;
        let is_enough = |relation: &Relation, in_degrees: f64| {
            let is_clear = relation.is_near(in_degrees, UNIT_FACTOR, STRICT_CORRELATION);
            relation.count >= if is_clear { DEGREES_WINDOWS } else { ENOUGH_WINDOWS }
        };
        let of_angles = (0..3).map(|axis| (axis, self.rates[axis][axis].relation()));
        let mut known = of_angles.filter(|(_, relation)| is_enough(relation, 1.0 / DEGREE));
        let by_angles = known.find_map(|(axis, relation)| {
            let is_near = |ratio: f64| relation.is_near(ratio, UNIT_FACTOR, SAME_CORRELATION);
            let is_angle = self.largest_angle > LARGEST_ANGLE || axis == 2 && self.largest_yaw > WHOLE_TURN;
            let is_large = relation.sizes[usize::from(is_angle)] >= LEAST_RATE;
            if is_large && is_near(DEGREE) && is_angle {
                Some(TableFault::new("angles", self.largest_angle.max(self.largest_yaw)))
            } else {
                (is_large && (is_near(DEGREE) || is_near(1.0 / DEGREE))).then(|| TableFault::of_rates(relation.ratio))
            }
        });
        let is_lateral = |relation: &Relation| is_enough(relation, DEGREE) && relation.sizes[1] >= LEAST_FORCE;
        let by_bends = || {
            // Angles in degrees as well leave no level bends.
            let mut all = [self.bends[2], self.turns].into_iter().map(|sums| sums.relation()).filter(is_lateral);
            let bends = all.find(|bends| bends.is_near(DEGREE, UNIT_FACTOR, SAME_CORRELATION))?;
            Some(TableFault::of_rates(1.0 / bends.ratio))
        };
        let by_radius = || {
            let yaw = Some(self.sways[2].relation()).filter(is_lateral)?;
            let is_tight = yaw.correlation > SAME_CORRELATION && yaw.ratio < TIGHTEST_RADIUS * yaw.sizes[0];
            (self.fastest < NO_SPEED && is_tight).then(|| TableFault::of_rates(1.0 / DEGREE))
        };
        let is_fast = self.windows >= ENOUGH_WINDOWS && self.fast_windows > FAST_PART * self.windows;
        by_angles
            .or_else(by_bends)
            .or_else(by_radius)
            .or_else(|| is_fast.then(|| TableFault::new("fast", FASTEST_RATE)))
    }

    /// A rate that is that of another angle, or of bends, while the right one is neither.
    fn exchanged_rates(&self) -> Option<TableFault> {
        // Least rates that say something, as root mean squares [rad/s].
        const LEAST_EXCHANGED_RATE: f64 = 0.01;
        // Factor between two channels beyond which they are not the same quantity.
        const OTHER_FACTOR: f64 = 2.0;
        let is_same = |relation: &Relation| {
            let is_known = relation.count >= ENOUGH_WINDOWS && relation.sizes[0] >= LEAST_EXCHANGED_RATE;
            is_known && relation.is_near(1.0, UNIT_FACTOR, SAME_CORRELATION)
        };
        let is_other = |relation: &Relation| !relation.is_near(1.0, OTHER_FACTOR, OTHER_CORRELATION);
        let of_angles = |rate: usize, angle: usize| {
            let relation = |rate: usize, angle: usize| self.rates[rate][angle].relation();
            rate != angle
                && is_same(&relation(rate, angle))
                && is_other(&relation(rate, rate))
                && is_other(&relation(angle, angle))
        };
        let mut pairs = (0..3).flat_map(|rate| (0..3).map(move |angle| (rate, angle)));
        let by_angles = pairs.find(|(rate, angle)| of_angles(*rate, *angle));
        let bends = self.bends.map(|sums| sums.relation());
        let is_bend = |rate: usize| {
            let strict = bends[rate].is_near(1.0, UNIT_FACTOR, STRICT_CORRELATION);
            strict && bends[rate].count >= ENOUGH_WINDOWS && bends[rate].sizes[1] >= LEAST_FORCE
        };
        let by_sways = |rate: usize| self.is_speed_of_bends(&self.sways[rate]) && self.has_other_bends(2);
        let by_bends =
            || (0..2).find(|&rate| is_bend(rate) && is_other(&bends[2]) || by_sways(rate)).map(|rate| (rate, 2));
        let pair = by_angles.or_else(by_bends)?;
        Some(TableFault { axes: pair.into(), ..TableFault::new("exchanged", 0.0) })
    }

    fn units_of_forces(&self) -> Option<TableFault> {
        [self.surge, self.bends[2]].iter().enumerate().find_map(|(axis, sums)| {
            let relation = sums.relation();
            let is_known = relation.count >= ENOUGH_WINDOWS
                && relation.sizes[0].max(relation.sizes[1]) >= LEAST_FORCE
                && relation.correlation > STRICT_CORRELATION;
            Some(TableFault { axes: [axis; 2], ..unit_of_force(relation.ratio).filter(|_| is_known)? })
        })
    }

    fn missing_bends(&self) -> Option<TableFault> {
        // Least lateral force of bends, by speed and yaw rate, beside which a force is missing
        // [m/s2], and the part of it below which it is.
        const LEAST_BENDS: f64 = 0.7;
        const MISSING_PART: f64 = 0.25;
        let relation = self.bends[2].relation();
        // A vehicle without an attitude may lean.
        let is_missing = self.has_attitude
            && relation.count >= CLEAR_WINDOWS
            && relation.sizes[0] >= LEAST_BENDS
            && relation.sizes[1] < MISSING_PART * relation.sizes[0];
        is_missing.then(|| TableFault::new("bends", relation.ratio))
    }
}

/// The mean force of the last moments. Once it is gravity's, it stays so: a vehicle may fall later.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct MeanForce {
    force: Vector3<f64>,
    time: f64,
    /// Name of the fault, and the axis of gravity.
    kind: Option<(&'static str, usize)>,
    held: f64,
    agrees: bool,
}

impl MeanForce {
    fn take(&mut self, interval: f64, sample: &Sample) {
        // Time constant of the mean force [s].
        const GRAVITY_TIME: f64 = 1.0;
        // Largest distance of the mean vertical force from gravity [m/s2]: bumps, slopes and hard
        // driving.
        const GRAVITY_TOLERANCE: f64 = 4.0;
        let angles = sample.motion.angles();
        if self.agrees {
            return;
        }
        if sample.has_angles && angles.roll.abs().max(angles.pitch.abs()) > LEVEL_ANGLE {
            *self = MeanForce::default();
            return;
        }
        self.time += interval;
        self.force += (sample.motion.force() - self.force) * (interval / self.time.min(GRAVITY_TIME));
        let kind = kind_of_gravity(&self.force);
        self.held = if kind == self.kind { self.held + interval } else { 0.0 };
        self.kind = kind;
        self.agrees = self.held >= GRAVITY_HELD && (self.force.z - STANDARD_GRAVITY).abs() < GRAVITY_TOLERANCE;
    }

    fn fault(&self) -> Option<TableFault> {
        let (name, axis) = self.kind.filter(|_| self.held >= GRAVITY_HELD)?;
        Some(TableFault { name, value: self.force.z, axes: [axis; 2] })
    }
}

/// The fault of a mean force, and the axis of gravity; none for gravity's, or of no kind.
fn kind_of_gravity(force: &Vector3<f64>) -> Option<(&'static str, usize)> {
    let is_gravity = |value: f64| (0.87..1.13).contains(&(value.abs() / STANDARD_GRAVITY));
    match force.z {
        z if (0.5..1.5).contains(&z) && force.norm() < 1.7 => Some(("gravity-in-g", 0)),
        -3.0..3.0 => {
            let axis = (0..2).find(|k| is_gravity(force[*k]));
            Some(axis.map_or(("gravity-missing", 0), |axis| ("gravity-along", axis)))
        }
        16.0..25.0 => Some(("gravity-twice", 0)),
        25.0.. => Some(("gravity-large", 0)),
        ..-6.0 => Some(("gravity-down", 0)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each name in this file has its sentence, whose places are all filled.
    #[test]
    fn each_fault_has_a_sentence() {
        let sources = concat!(include_str!("table_check.rs"), include_str!("signs.rs"));
        let used = |name: &str| sources.contains(&format!("\"{name}\""));
        for name in SENTENCES.keys() {
            assert!(used(name), "{name} is not used");
            let fault = TableFault::new(Box::leak(name.clone().into_boxed_str()), 2.0);
            assert!(!fault.to_string().contains(['{', '}']), "{fault}");
        }
        assert_eq!(SENTENCES.len(), 31);
    }
}
