//! Channels that stand still while others show that they must not.

use std::f64::consts::TAU;

use moris_interface::shown;
use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;

use super::consistency::{LEAST_CHANGE, LEAST_SWAY, changes, derivative_and_rate, slopes_explain};
use super::speeds::signed_speeds;
use crate::message::{Message, message, named};
use crate::recording::conventions::{Conventions, Quantity, RateFrame};
use crate::recording::signal::{centred, integral, is_constant, median, regression, root_mean_square, smooth};
use crate::recording::table::Table;

/// Speed above which bends need a yaw rate \[m/s\].
const DRIVES: f64 = 3.0;
/// Least rate of an angle that needs a rate, as a root mean square \[rad/s\].
const LEAST_RATE: f64 = 0.02;
/// Fraction of what others show, below which a channel holds noise alone.
const NOISE: f64 = 0.1;
/// Least change of speed by the force that a constant speed contradicts, as a root mean square
/// \[m/s\].
const DRIVEN: f64 = 1.0;
/// Roll of a vehicle that leans into bends, as a root mean square \[rad\].
const LEANS: f64 = 0.1;
/// Ratios of the vertical force in bends and that of a vehicle which leans into them.
const BALANCED: [f64; 2] = [0.5, 2.0];

/// What is known of a recording's channels.
struct Channels<'a> {
    table: &'a Table,
    inputs: &'a [Input],
    conventions: &'a Conventions,
    speeds: Vec<f64>,
    step: f64,
}

/// Warnings about channels with one value throughout, or with noise alone, while the vehicle speeds
/// up, turns or leans.
pub fn warnings(table: &Table, inputs: &[Input], conventions: &Conventions) -> Vec<Message> {
    let step = table.step();
    let (speeds, _) = signed_speeds(inputs, step);
    let channels = Channels { table, inputs, conventions, speeds, step };
    let names = ["roll", "pitch", "yaw"];
    let of_angle = |axis: usize| channels.misses_angle(axis).then(|| (Quantity::Rate(axis), names[axis]));
    let found = [
        channels.misses_speed().then_some((Quantity::Force(0), "the speed changes")),
        channels.misses_bends().then_some((Quantity::Force(1), "the vehicle drives bends")),
        channels.is_stuck().then_some((Quantity::Speed, "the force along x changes it")),
    ];
    let mut warnings: Vec<Message> = found
        .into_iter()
        .flatten()
        .map(|(quantity, contradiction)| channels.warning(quantity, contradiction))
        .collect();
    warnings.extend(
        (0..3).filter_map(of_angle).map(|(quantity, name)| channels.warning(quantity, &format!("{name} changes"))),
    );
    if !channels.misses_angle(2) && channels.misses_turns() {
        warnings.push(channels.warning(Quantity::Rate(2), "the lateral force is that of bends"));
    }
    warnings
}

impl Channels<'_> {
    fn warning(&self, quantity: Quantity, contradiction: &str) -> Message {
        let name = self.conventions.column(quantity);
        let fact = if self.is_constant(quantity) {
            format!("is constant, {},", shown(self.table.value(quantity, 0) / self.table.unit(quantity).0.in_si))
        } else {
            "hardly changes".to_owned()
        };
        message![
            "Column {name} {fact} while {contradiction}: it is not measured. Name the column that is with ",
            named("columns"),
            "."
        ]
    }

    fn is_measured(&self, quantity: Quantity) -> bool {
        self.table.layout.iter().any(|column| column.quantity == quantity)
    }

    fn is_constant(&self, quantity: Quantity) -> bool {
        self.is_measured(quantity) && self.table.columns.get(&quantity).is_some_and(|values| is_constant(values))
    }

    fn has_speed(&self) -> bool {
        self.is_measured(Quantity::Speed) && !self.is_constant(Quantity::Speed)
    }

    fn smoothed(&self, value: impl Fn((&Input, &f64)) -> f64) -> Vec<f64> {
        smooth(self.inputs.iter().zip(&self.speeds).map(value), self.step)
    }

    /// Changes of speed by the force along x.
    fn driven(&self) -> Vec<f64> {
        let forces = self.inputs.iter().map(|input| input.specific_force.x);
        centred(changes(&integral(forces, self.step), self.step).into_iter())
    }

    /// True where the speed changes without a force along x, and no slope explains it.
    fn misses_speed(&self) -> bool {
        let needed = centred(changes(&self.speeds, self.step).into_iter());
        self.is_measured(Quantity::Force(0))
            && self.has_speed()
            && root_mean_square(&needed) >= LEAST_CHANGE
            && (self.is_constant(Quantity::Force(0)) || is_noise(&self.driven(), &needed))
            && !slopes_explain(self.step, self.inputs, &self.speeds)
    }

    /// True where the force along x changes the speed, which is constant.
    fn is_stuck(&self) -> bool {
        self.is_constant(Quantity::Speed) && root_mean_square(&self.driven()) >= DRIVEN
    }

    /// True where a vehicle that does not lean drives bends without a lateral force.
    fn misses_bends(&self) -> bool {
        let turning = || self.smoothed(|(input, speed)| speed * input.angular_velocity.z);
        self.is_constant(Quantity::Force(1))
            && self.has_speed()
            && root_mean_square(&turning()) >= LEAST_SWAY
            && !self.leans()
    }

    /// True for a vehicle that leans into bends, which has no lateral force.
    fn leans(&self) -> bool {
        let rolls = || root_mean_square(&centred(self.inputs.iter().map(|input| input.orientation.roll))) > LEANS;
        let expected = self.smoothed(|(input, speed)| (speed * input.angular_velocity.z).hypot(STANDARD_GRAVITY));
        let vertical = self.smoothed(|(input, _)| input.specific_force.z);
        let is_balanced = |ratio: f64| (BALANCED[0]..BALANCED[1]).contains(&ratio);
        let has_lean = self.is_measured(Quantity::Lean) && !self.is_constant(Quantity::Lean);
        has_lean || rolls() || regression(&expected, &vertical).is_some_and(is_balanced)
    }

    /// True where the lateral force is that of bends without a yaw rate.
    fn misses_turns(&self) -> bool {
        let lateral = self.smoothed(|(input, _)| input.specific_force.y);
        let turning = || self.smoothed(|(input, speed)| speed * input.angular_velocity.z);
        self.is_measured(Quantity::Rate(2))
            && self.has_speed()
            && median(self.speeds.iter().map(|speed| speed.abs())) > DRIVES
            && root_mean_square(&lateral) >= LEAST_SWAY
            && (self.is_constant(Quantity::Rate(2)) || is_noise(&turning(), &lateral))
    }

    /// True where an angle changes without its rate.
    fn misses_angle(&self, axis: usize) -> bool {
        let (derivative, rate) = derivative_and_rate(self.inputs, axis, self.step, TAU);
        self.is_measured(Quantity::Angle(axis))
            && self.is_measured(Quantity::Rate(axis))
            && self.conventions.rate_frame == RateFrame::Body
            && root_mean_square(&derivative) >= LEAST_RATE
            && (self.is_constant(Quantity::Rate(axis)) || is_noise(&rate, &derivative))
    }
}

/// True for a signal that is small beside the one that it should be, and does not go with it.
fn is_noise(found: &[f64], needed: &[f64]) -> bool {
    root_mean_square(found) < NOISE * root_mean_square(needed) && regression(needed, found).is_none()
}
