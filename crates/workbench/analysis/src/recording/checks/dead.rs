//! Channels that stand still while others show that they must not.

use std::f64::consts::TAU;

use moris_interface::shown;
use moris_washout::interface::STANDARD_GRAVITY;

use super::Channels;
use super::channels::{LEAST_CHANGE, LEAST_SWAY};
use super::consistency::slopes_explain;
use crate::message::{Message, message, named};
use crate::recording::conventions::Quantity;
use crate::recording::signal::{centred, is_constant, median, regression, root_mean_square};

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

/// Warnings about channels with one value throughout, or with noise alone, while the vehicle speeds
/// up, turns or leans.
pub fn warnings(channels: &Channels) -> Vec<Message> {
    let [roll, pitch, yaw] = [0, 1, 2].map(|axis| channels.misses_angle(axis));
    let contradictions = [
        (channels.misses_speed(), Quantity::Force(0), "the speed changes"),
        (channels.misses_bends(), Quantity::Force(1), "the vehicle drives bends"),
        (channels.is_stuck(), Quantity::Speed, "the force along x changes it"),
        (roll, Quantity::Rate(0), "roll changes"),
        (pitch, Quantity::Rate(1), "pitch changes"),
        (yaw, Quantity::Rate(2), "yaw changes"),
        (!yaw && channels.misses_turns(), Quantity::Rate(2), "the lateral force is that of bends"),
    ];
    let found = contradictions.into_iter().filter(|(is_found, ..)| *is_found);
    found.map(|(_, quantity, contradiction)| channels.warning(quantity, contradiction)).collect()
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

    /// True where the speed changes without a force along x, and no slope explains it.
    fn misses_speed(&self) -> bool {
        let needed = centred(self.changes(&self.speeds).into_iter());
        self.is_measured(Quantity::Force(0))
            && self.has_speed()
            && root_mean_square(&needed) >= LEAST_CHANGE
            && (self.is_constant(Quantity::Force(0)) || is_noise(&self.driven(self.force(0)), &needed))
            && !slopes_explain(self)
    }

    /// True where the force along x changes the speed, which is constant.
    fn is_stuck(&self) -> bool {
        self.is_constant(Quantity::Speed) && root_mean_square(&self.driven(self.force(0))) >= DRIVEN
    }

    /// True where a vehicle that does not lean drives bends without a lateral force.
    fn misses_bends(&self) -> bool {
        self.is_constant(Quantity::Force(1))
            && self.has_speed()
            && root_mean_square(&self.turning()) >= LEAST_SWAY
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
        let lateral = self.lateral();
        self.is_measured(Quantity::Rate(2))
            && self.has_speed()
            && median(self.speeds.iter().map(|speed| speed.abs())) > DRIVES
            && root_mean_square(&lateral) >= LEAST_SWAY
            && (self.is_constant(Quantity::Rate(2)) || is_noise(&self.turning(), &lateral))
    }

    /// True where an angle changes without its rate.
    fn misses_angle(&self, axis: usize) -> bool {
        let (derivative, rate) = self.derivative_and_rate(axis, TAU);
        self.is_measured(Quantity::Angle(axis))
            && self.is_measured(Quantity::Rate(axis))
            && self.has_body_rates()
            && root_mean_square(&derivative) >= LEAST_RATE
            && (self.is_constant(Quantity::Rate(axis)) || is_noise(&rate, &derivative))
    }
}

/// True for a signal that is small beside the one that it should be, and does not go with it.
fn is_noise(found: &[f64], needed: &[f64]) -> bool {
    root_mean_square(found) < NOISE * root_mean_square(needed) && regression(needed, found).is_none()
}
