//! The six channels of the input at the head and of the felt motion.

use moris_washout::Output;
/// A translation stands for the specific force along it, a rotation for the angular velocity about
/// it, in head axes.
pub use moris_washout::platform::reach::Axis as Channel;

/// Number of channels.
pub const CHANNEL_COUNT: usize = Channel::ALL.len();

/// The channels coupled by gravity: a tilted head feels it along surge or sway, and surge and
/// sway are cued by tilting.
pub const CROSS_CHANNELS: [(Channel, Channel); 4] = [
    (Channel::Pitch, Channel::Surge),
    (Channel::Roll, Channel::Sway),
    (Channel::Surge, Channel::Pitch),
    (Channel::Sway, Channel::Roll),
];

/// Each channel on itself.
pub fn direct() -> [(Channel, Channel); CHANNEL_COUNT] {
    Channel::ALL.map(|channel| (channel, channel))
}

/// Name as in tables and pictures.
pub fn name(channel: Channel) -> &'static str {
    ["surge", "sway", "heave", "roll rate", "pitch rate", "yaw rate"][channel as usize]
}

/// Unit in tables and pictures.
pub fn unit(channel: Channel) -> &'static str {
    if channel.is_rotation() { "°/s" } else { "m/s²" }
}

/// One of [`unit()`] in SI units.
pub fn unit_in_si(channel: Channel) -> f64 {
    if channel.is_rotation() { 1_f64.to_radians() } else { 1.0 }
}

/// Unit of the ratio of an output to an input: empty where both have the same unit.
pub fn ratio_unit(input: Channel, output: Channel) -> &'static str {
    match (input.is_rotation(), output.is_rotation()) {
        (false, true) => "°/s per m/s²",
        (true, false) => "m/s² per °/s",
        _ => "",
    }
}

/// Felt quantities in SI units, in the order of the channels.
pub fn felt(output: &Output) -> [f64; CHANNEL_COUNT] {
    let (force, rate) = (output.felt_specific_force, output.felt_angular_velocity);
    [force.x, force.y, force.z, rate.x, rate.y, rate.z]
}
