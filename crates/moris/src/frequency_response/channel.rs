//! The six channels: what goes in at the head, and what is felt there.

use moris_washout::Output;

/// An axis of specific force or of angular velocity, in head axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    Surge,
    Sway,
    Heave,
    Roll,
    Pitch,
    Yaw,
}

/// Number of channels.
pub const CHANNELS: usize = 6;

/// All channels, each at the place of its [`Channel::index`].
pub const ALL: [Channel; CHANNELS] =
    [Channel::Surge, Channel::Sway, Channel::Heave, Channel::Roll, Channel::Pitch, Channel::Yaw];

/// The channels that gravity joins: a tilted head feels it along surge or sway, and surge and
/// sway are cued by tilting.
pub const CROSS: [(Channel, Channel); 4] = [
    (Channel::Pitch, Channel::Surge),
    (Channel::Roll, Channel::Sway),
    (Channel::Surge, Channel::Pitch),
    (Channel::Sway, Channel::Roll),
];

impl Channel {
    /// Its place among [`ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// 0, 1, 2 for x, y, z.
    pub fn axis(self) -> usize {
        self.index() % 3
    }

    /// True for a specific force, false for an angular velocity.
    pub fn is_force(self) -> bool {
        self.index() < 3
    }

    /// As it is written.
    pub fn name(self) -> &'static str {
        ["surge", "sway", "heave", "roll rate", "pitch rate", "yaw rate"][self.index()]
    }

    /// The unit that people read it in.
    pub fn unit(self) -> &'static str {
        if self.is_force() { "m/s²" } else { "°/s" }
    }

    /// One of the unit that people read it in, in SI units.
    pub fn unit_in_si(self) -> f64 {
        if self.is_force() { 1.0 } else { 1_f64.to_radians() }
    }

    /// The unit of a ratio of `output` to this as an input: empty where they are alike.
    pub fn unit_to(self, output: Channel) -> &'static str {
        match (self.is_force(), output.is_force()) {
            (true, false) => "°/s per m/s²",
            (false, true) => "m/s² per °/s",
            _ => "",
        }
    }
}

/// Felt quantities in SI units, in the order of the channels.
pub fn felt(output: &Output) -> [f64; CHANNELS] {
    let (force, rate) = (output.felt_specific_force, output.felt_angular_velocity);
    [force.x, force.y, force.z, rate.x, rate.y, rate.z]
}
