//! The channels of a recording, as the checks compare them.

use moris_washout::Input;

use crate::message::{Message, given};
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{Conventions, Frame, Quantity};
use crate::recording::signal::{centred, integral, is_constant, relation, root_mean_square, runs, smooth};
use crate::recording::table::Table;
use crate::texts::text;

/// Time over which changes of speed are compared with the force \[s\].
const CHANGE_TIME: f64 = 2.0;
/// Least change of speed in it that is compared, as a root mean square \[m/s\].
pub const MIN_SPEED_CHANGE: f64 = 0.3;
/// Least lateral force of bends that is compared, as a root mean square \[m/s2\].
pub const MIN_BEND_FORCE: f64 = 0.3;
/// Speed above which bends need a yaw rate \[m/s\].
pub const BEND_SPEED: f64 = 3.0;

/// A recording before it is faded in.
pub struct Channels<'a> {
    /// The part in which all columns have values of their own.
    pub table: &'a Table,
    /// The table of which it is a part.
    pub whole: &'a Table,
    pub inputs: &'a [Input],
    pub conventions: &'a Conventions,
    /// Time between samples \[s\].
    pub step: f64,
    /// The recording's sample that is the first here.
    pub first: usize,
    /// The speeds with the sign of the direction, which loggers leave out.
    pub speeds: Vec<f64>,
    /// Times in which the vehicle reverses without a sign, for a message.
    pub reversing: Vec<String>,
}

impl<'a> Channels<'a> {
    /// The channels of a part of a recording that begins with its sample `first`.
    pub fn new(
        [whole, table]: [&'a Table; 2],
        inputs: &'a [Input],
        conventions: &'a Conventions,
        first: usize,
    ) -> Self {
        let speeds = inputs.iter().map(|input| input.speed).collect();
        let (step, reversing) = (table.step(), Vec::new());
        let mut channels = Channels { table, whole, inputs, conventions, step, first, speeds, reversing };
        channels.sign_speeds();
        channels
    }

    /// Time of a sample in the recording \[s\].
    pub fn time(&self, sample: usize) -> f64 {
        (self.first + sample) as f64 * self.step
    }

    /// Gives the speeds the sign of the direction.
    ///
    /// Between two stops the vehicle reverses where the force along x is against the changes of the
    /// speed, while both go together between others.
    fn sign_speeds(&mut self) {
        // Speed below which a vehicle stands [m/s].
        const STANDING_SPEED: f64 = 0.3;
        if self.speeds.iter().any(|speed| *speed < -STANDING_SPEED) {
            return;
        }
        let forces: Vec<f64> = self.force(0).collect();
        let least = ((CHANGE_TIME / self.step) as usize).max(2);
        let stops_or_drives = runs(&self.speeds, |a, b| (*a < STANDING_SPEED) == (*b < STANDING_SPEED));
        let drives = stops_or_drives.filter(|run| self.speeds[run.start] >= STANDING_SPEED && run.len() > least);
        let direction = |drive: &std::ops::Range<usize>| {
            let found = centred(self.changes(&self.speeds[drive.clone()]).into_iter());
            let expected = self.driven(forces[drive.clone()].iter().copied());
            let is_small =
                root_mean_square(&found) < MIN_SPEED_CHANGE || root_mean_square(&expected) < MIN_SPEED_CHANGE;
            if is_small { 0.0 } else { relation(&expected, &found).slope().unwrap_or(0.0) }
        };
        let drives: Vec<_> = drives.map(|drive| (direction(&drive), drive)).collect();
        let goes_forward = drives.iter().any(|(direction, _)| *direction > 0.0);
        for (_, drive) in drives.into_iter().filter(|(direction, _)| goes_forward && *direction < 0.0) {
            self.reversing.push(format!("{:.1} s to {:.1} s", self.time(drive.start), self.time(drive.end)));
            self.speeds[drive].iter_mut().for_each(|speed| *speed = -*speed);
        }
    }

    /// The remedy for a unit: an option where the header leaves it open, otherwise the header.
    pub fn unit_remedy(&self, quantity: Quantity, word: &str) -> Message {
        let (unit, source) = self.table.unit(quantity);
        match source {
            UnitSource::Header => {
                let other = quantity.dimension().units().find(|other| other.word == word).unwrap_or(unit);
                let layout = self.table.layout.iter().map(|column| column.quantity);
                let alike: Vec<Quantity> = layout.filter(|other| other.dimension() == quantity.dimension()).collect();
                let factor = (other.in_si / unit.in_si * 1e6).round() / 1e6;
                let columns = self.conventions.scaled(&alike, &format!("* {factor}"));
                text!["correct-the-header", unit = unit.word, columns]
            }
            UnitSource::Ending | UnitSource::Option | UnitSource::Default => {
                text!["use", remedy = given(quantity.dimension().option(), word)]
            }
        }
    }

    /// The remedy for a quantity with the wrong sign.
    pub fn turned(&self, quantity: Quantity) -> Message {
        if self.conventions.mounting.is_some() {
            return text!["check-mounting"];
        }
        let column = format!("{}={}", quantity.key(), self.conventions.turned_column(quantity));
        text!["use", remedy = given("columns", column)]
    }

    /// True for a quantity that the recording has, or that is taken as at rest.
    pub fn has(&self, quantity: Quantity) -> bool {
        self.table.columns.contains_key(&quantity)
    }

    /// True for a quantity that the recording has.
    pub fn is_measured(&self, quantity: Quantity) -> bool {
        self.table.layout.iter().any(|column| column.quantity == quantity)
    }

    /// True for a quantity of the recording that has one value throughout.
    pub fn is_constant(&self, quantity: Quantity) -> bool {
        self.is_measured(quantity) && self.table.columns.get(&quantity).is_some_and(|values| is_constant(values))
    }

    /// True where rates are the derivatives of angles, for small angles.
    pub fn has_body_rates(&self) -> bool {
        self.conventions.rate_frame == Frame::Body
    }

    /// Specific force along an axis.
    pub fn force(&self, axis: usize) -> impl Iterator<Item = f64> {
        self.inputs.iter().map(move |input| input.specific_force[axis])
    }

    /// True where roll, pitch and yaw are those of a quaternion.
    pub fn has_quaternion(&self) -> bool {
        self.is_measured(Quantity::Quaternion(0))
            && self.has(Quantity::Angle(0))
            && !self.is_measured(Quantity::Angle(0))
    }

    /// Angular velocity about an axis.
    pub fn rate(&self, axis: usize) -> impl Iterator<Item = f64> {
        self.inputs.iter().map(move |input| input.angular_velocity[axis])
    }

    /// Roll, pitch or yaw.
    pub fn angle(&self, axis: usize) -> impl Iterator<Item = f64> {
        self.inputs.iter().map(move |input| input.orientation.to_vector()[axis])
    }

    /// Changes of a signal over [`CHANGE_TIME`], or a quarter of a short one.
    pub fn changes(&self, values: &[f64]) -> Vec<f64> {
        let window = ((CHANGE_TIME / self.step).round() as usize).min(values.len() / 4).max(1);
        values.iter().skip(window).zip(values).map(|(after, before)| after - before).collect()
    }

    /// Changes of speed by a force, without their mean.
    pub fn driven(&self, force: impl Iterator<Item = f64>) -> Vec<f64> {
        centred(self.changes(&integral(force, self.step)).into_iter())
    }

    /// A signal of inputs and signed speeds, smoothed.
    pub fn smoothed(&self, value: impl Fn((&Input, &f64)) -> f64) -> Vec<f64> {
        smooth(self.inputs.iter().zip(&self.speeds).map(value), self.step)
    }

    /// Lateral force of bends, smoothed.
    pub fn lateral(&self) -> Vec<f64> {
        self.smoothed(|(input, _)| input.specific_force.y)
    }

    /// Speed times yaw rate, smoothed: the lateral force of a vehicle that does not lean.
    pub fn turning(&self) -> Vec<f64> {
        self.smoothed(|(input, speed)| speed * input.angular_velocity.z)
    }

    /// The speed at which the lateral force of bends is speed times yaw rate \[m/s\]; none where
    /// the two do not go together.
    pub fn speed_of_bends(&self) -> Option<f64> {
        let yaw = smooth(self.rate(2), self.step);
        let lateral = self.lateral();
        if root_mean_square(&lateral) < MIN_BEND_FORCE { None } else { relation(&yaw, &lateral).slope() }
    }

    /// Changes of an angle from sample to sample over the step. Where they are larger than half a
    /// period, the angle has jumped by a turn.
    pub fn derivative(&self, axis: usize, period: f64) -> impl Iterator<Item = f64> {
        self.angle(axis).skip(1).zip(self.angle(axis)).map(move |(after, before)| {
            let change = after - before;
            (change - period * (change / period).round()) / self.step
        })
    }

    /// Derivative of an angle and the rate about its axis, both smoothed.
    pub fn derivative_and_rate(&self, axis: usize, period: f64) -> (Vec<f64>, Vec<f64>) {
        (smooth(self.derivative(axis, period), self.step), smooth(self.rate(axis).skip(1), self.step))
    }
}
