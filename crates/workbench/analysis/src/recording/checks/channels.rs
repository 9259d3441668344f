//! The channels of a recording, as the checks compare them.

use moris_washout::Input;

use crate::recording::conventions::{Conventions, Quantity, RateFrame};
use crate::recording::signal::{centred, integral, regression, root_mean_square, runs, smooth};
use crate::recording::table::Table;

/// Time over which changes of speed are compared with the force \[s\].
const WINDOW: f64 = 2.0;
/// Least change of speed in it that is compared, as a root mean square \[m/s\].
pub const LEAST_CHANGE: f64 = 0.3;
/// Least lateral force of bends that is compared, as a root mean square \[m/s2\].
pub const LEAST_SWAY: f64 = 0.3;
/// Speed below which a vehicle stands \[m/s\].
const STANDS: f64 = 0.3;

/// A recording before it is faded in.
pub struct Channels<'a> {
    pub table: &'a Table,
    pub inputs: &'a [Input],
    pub conventions: &'a Conventions,
    /// Time between samples \[s\].
    pub step: f64,
    /// The recording's sample that is the first here.
    pub first: usize,
    /// The speeds with the sign of the direction, which loggers leave out.
    pub speeds: Vec<f64>,
    /// A warning where the vehicle reverses without a sign.
    pub reversing: Option<String>,
}

impl<'a> Channels<'a> {
    /// The channels of a part of a recording that begins with its sample `first_sample`.
    pub fn new(table: &'a Table, inputs: &'a [Input], conventions: &'a Conventions, first_sample: usize) -> Self {
        let speeds = inputs.iter().map(|input| input.speed).collect();
        let (step, first) = (table.step(), first_sample);
        let mut channels = Channels { table, inputs, conventions, step, first, speeds, reversing: None };
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
        if self.speeds.iter().any(|speed| *speed < -STANDS) {
            return;
        }
        let forces: Vec<f64> = self.force(0).collect();
        let least = ((WINDOW / self.step) as usize).max(2);
        let stops_or_drives = runs(&self.speeds, |a, b| (*a < STANDS) == (*b < STANDS));
        let drives = stops_or_drives.filter(|run| self.speeds[run.start] >= STANDS && run.len() > least);
        let direction = |drive: &std::ops::Range<usize>| {
            let found = centred(self.changes(&self.speeds[drive.clone()]).into_iter());
            let expected = self.driven(forces[drive.clone()].iter().copied());
            let is_small = root_mean_square(&found) < LEAST_CHANGE || root_mean_square(&expected) < LEAST_CHANGE;
            if is_small { 0.0 } else { regression(&expected, &found).unwrap_or(0.0) }
        };
        let drives: Vec<_> = drives.map(|drive| (direction(&drive), drive)).collect();
        let goes_forward = drives.iter().any(|(direction, _)| *direction > 0.0);
        let mut times = Vec::new();
        for (_, drive) in drives.into_iter().filter(|(direction, _)| goes_forward && *direction < 0.0) {
            times.push(format!("{:.1} s to {:.1} s", self.time(drive.start), self.time(drive.end)));
            self.speeds[drive].iter_mut().for_each(|speed| *speed = -*speed);
        }
        if !times.is_empty() {
            let times = times.join(", ");
            self.reversing = Some(format!(
                "The vehicle seems to reverse from {times}, where the speed has no sign: write it negative."
            ));
        }
    }

    /// True for a quantity that the recording has, or that is taken as at rest.
    pub fn has(&self, quantity: Quantity) -> bool {
        self.table.columns.contains_key(&quantity)
    }

    /// True where rates are the derivatives of angles, for small angles.
    pub fn has_body_rates(&self) -> bool {
        self.conventions.rate_frame == RateFrame::Body
    }

    /// Specific force along an axis.
    pub fn force(&self, axis: usize) -> impl Iterator<Item = f64> {
        self.inputs.iter().map(move |input| input.specific_force[axis])
    }

    /// Angular velocity about an axis.
    pub fn rate(&self, axis: usize) -> impl Iterator<Item = f64> {
        self.inputs.iter().map(move |input| input.angular_velocity[axis])
    }

    /// Changes of a signal over [`WINDOW`], or a quarter of a short one.
    pub fn changes(&self, values: &[f64]) -> Vec<f64> {
        let window = ((WINDOW / self.step).round() as usize).min(values.len() / 4).max(1);
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
        if root_mean_square(&lateral) < LEAST_SWAY { None } else { regression(&yaw, &lateral) }
    }

    /// Changes of an angle from sample to sample over the step. Where they are larger than half a
    /// period, the angle has jumped by a turn.
    pub fn derivative(&self, axis: usize, period: f64) -> impl Iterator<Item = f64> {
        let angle = move |input: &Input| input.orientation.to_vector()[axis];
        self.inputs.windows(2).map(move |pair| {
            let change = angle(&pair[1]) - angle(&pair[0]);
            (change - period * (change / period).round()) / self.step
        })
    }

    /// Derivative of an angle and the rate about its axis, both smoothed.
    pub fn derivative_and_rate(&self, axis: usize, period: f64) -> (Vec<f64>, Vec<f64>) {
        (smooth(self.derivative(axis, period), self.step), smooth(self.rate(axis).skip(1), self.step))
    }
}
