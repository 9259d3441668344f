//! Rules that every recording must pass, in SI units and the washout's axes.
//!
//! A row of [`RECORDING_RULES`] is one of them: what it needs, when it fires, and which others it
//! explains. Their sentences stand in `texts.toml`.
//!
//! - `units` detects wrong units and axes, by gravity, and by what heads can do.
//! - `waveform` looks at one channel: it stands still, repeats, or has few digits.
//! - `agreement` compares [`Channels`] that should tell the same.
//! - `motion` warns about motion that is possible, but unusual.

mod agreement;
mod channels;
mod motion;
mod units;
mod waveform;

use super::conventions::Quantity::{self, Angle, Force, Lean, Rate, Speed, Time};
use super::message::RecordingError;
use crate::message::Message;
pub use agreement::has_horizontal_gravity;
pub use channels::Channels;

/// A rule.
struct Rule {
    name: &'static str,
    /// True if a recording that breaks it is refused; otherwise it is a warning.
    refuses: bool,
    /// Quantities without which there is nothing to test.
    needs: &'static [Quantity],
    /// Quantities that are tested one by one.
    of: &'static [Quantity],
    /// The breach of the rule as a sentence; none where there is none.
    test: fn(&Channels, Quantity) -> Option<Message>,
    /// Later rules whose findings have the cause that this one names: it is told in their place.
    supersedes: &'static [&'static str],
}

/// A rule that is tested once.
const TESTED_ONCE: &[Quantity] = &[Time];
const FORCES_AND_RATES: &[Quantity] = &[Force(0), Rate(0), Force(1), Rate(1), Force(2), Rate(2)];
const ALL_ANGLES: &[Quantity] = &Quantity::ANGLES;

/// Declares rules, a row each.
macro_rules! rules {
    ($( $name:literal $effect:ident $needs:expr, $of:expr, $test:path $(, supersedes [$($others:literal),+])?; )+) => {
        &[$( Rule {
            name: $name,
            refuses: rules!(@refuses $effect),
            needs: &$needs,
            of: $of,
            test: $test,
            supersedes: &[$( $($others),+ )?],
        }, )+]
    };
    (@refuses refuse) => { true };
    (@refuses warn) => { false };
}

/// The rules of a recording before it is faded in, in the order in which they are told.
const RECORDING_RULES: &[Rule] = rules! {
    // Angles before gravity: with them it is put back.
    "angle range" refuse [], TESTED_ONCE, units::angle_range;
    "angle unit" refuse [], &[Angle(0), Angle(1), Angle(2), Lean], units::angle_unit;
    "attitude from below" refuse [], TESTED_ONCE, units::attitude_from_below;
    "exchanged sensors" refuse [], TESTED_ONCE, units::exchanged_sensors;
    // What a sensor shows after it has stopped is no unit or axis.
    "repeated lines" warn [], &[Time, Force(0), Rate(0), Angle(0)], waveform::repeated_lines,
        supersedes ["stop", "gravity", "rate unit"];
    "stopped speed" warn [], &[Speed], waveform::stopped_speed,
        supersedes ["stop", "no force", "speed and force", "delayed speed", "delayed bends"];
    "stop" warn [Speed], &[Force(0), Rate(2)], waveform::stop, supersedes ["gravity", "rate unit"];
    "gravity" refuse [], TESTED_ONCE, units::gravity;
    "rate unit" refuse [], TESTED_ONCE, units::rate_unit;
    "repeated values" warn [], TESTED_ONCE, waveform::repeated;
    "coarse values" warn [], FORCES_AND_RATES, waveform::coarse;
    "world forces" warn [Angle(2)], TESTED_ONCE, agreement::world_forces,
        supersedes ["exchanged forces", "no force", "no lateral force", "speed and force", "sign of bends", "rates of bends"];
    "exchanged forces" warn [], TESTED_ONCE, agreement::exchanged_forces, supersedes ["no lateral force"];
    "world rates" warn [Angle(0), Angle(1), Angle(2)], TESTED_ONCE, agreement::world_rates,
        supersedes ["exchanged rates", "no rate of an angle", "sign of rates", "scale of rates", "delayed angle"];
    "quaternion" warn [], TESTED_ONCE, agreement::quaternion,
        supersedes ["exchanged rates", "no rate of an angle", "sign of rates", "scale of rates", "delayed angle"];
    "exchanged rates" warn [], &[Rate(0), Rate(1), Rate(2)], agreement::exchanged_rates,
        supersedes ["exchanged yaw rate", "no rate of an angle", "no yaw rate", "no lateral force"];
    "exchanged yaw rate" warn [], &[Rate(0), Rate(1)], agreement::exchanged_yaw_rate,
        supersedes ["no yaw rate", "no lateral force"];
    "exchanged angles" warn [Speed, Angle(0), Angle(1)], TESTED_ONCE, agreement::exchanged_angles,
        supersedes ["sign of pitch", "sign of roll", "no force", "speed and force", "delayed speed"];
    "sign of pitch" warn [Speed, Angle(1)], TESTED_ONCE, agreement::sign_of_pitch,
        supersedes ["no force", "speed and force", "delayed speed"];
    "sign of roll" warn [Speed, Angle(0)], TESTED_ONCE, agreement::sign_of_roll,
        supersedes ["no lateral force", "sign of bends", "rates of bends", "unit of bends"];
    "same forces" warn [], &[Force(0), Force(1), Force(2)], agreement::same_values;
    "same rates" warn [], &[Rate(0), Rate(1), Rate(2)], agreement::same_values;
    "no force" warn [Speed], TESTED_ONCE, agreement::missing_force;
    "no lateral force" warn [Speed], TESTED_ONCE, agreement::missing_lateral_force;
    "no speed" warn [Speed], TESTED_ONCE, agreement::missing_speed;
    "no rate of an angle" warn [], ALL_ANGLES, agreement::missing_rate, supersedes ["no yaw rate"];
    "no yaw rate" warn [Speed], TESTED_ONCE, agreement::missing_yaw_rate;
    "speed and force" warn [Speed], TESTED_ONCE, agreement::speed_and_force, supersedes ["unit of bends"];
    "sign of bends" warn [Speed], TESTED_ONCE, agreement::sign_of_bends, supersedes ["unit of bends"];
    "rates of bends" warn [Speed], TESTED_ONCE, agreement::rates_of_bends, supersedes ["unit of bends"];
    "unit of bends" warn [Speed], TESTED_ONCE, agreement::unit_of_bends;
    "reversing" warn [Speed], TESTED_ONCE, agreement::reversing;
    "backward bends" warn [], TESTED_ONCE, agreement::backward_bends;
    "sign of rates" warn [], ALL_ANGLES, agreement::sign_of_rates;
    "scale of rates" warn [], TESTED_ONCE, agreement::scale_of_rates;
    "delayed speed" warn [Speed], &[Speed], agreement::delayed;
    "delayed bends" warn [Speed], &[Force(1)], agreement::delayed;
    "delayed angle" warn [], ALL_ANGLES, agreement::delayed;
};

/// The rules of the motion that is ridden.
const RULES_OF_MOTION: &[Rule] = rules! {
    "bias" warn [], &[Force(0), Force(1)], motion::bias;
    "force unit" warn [], TESTED_ONCE, motion::force_unit;
    "fast rates" warn [], TESTED_ONCE, motion::fast_rates;
    "jolt" warn [], TESTED_ONCE, motion::jolt;
};

/// The warnings about a recording before it is faded in.
///
/// # Errors
/// The recording breaks a rule that refuses it. The message names the cause and the remedy.
pub fn warnings(channels: &Channels) -> Result<Vec<Message>, RecordingError> {
    apply_rules(RECORDING_RULES, channels)
}

/// The warning about gravity that only the vertical force lacks.
pub fn horizontal_gravity() -> Message {
    crate::texts::text!["horizontal-gravity"]
}

/// The warnings about the motion that is ridden.
///
/// # Errors
/// None of these rules refuses.
pub fn warnings_of_motion(channels: &Channels) -> Result<Vec<Message>, RecordingError> {
    apply_rules(RULES_OF_MOTION, channels)
}

fn apply_rules(rules: &[Rule], channels: &Channels) -> Result<Vec<Message>, RecordingError> {
    let refused = |reason: &Message| channels.table.refused(reason.clone().without_full_stop());
    let mut found: Vec<(&Rule, Message)> = Vec::new();
    for rule in rules.iter().filter(|rule| rule.needs.iter().all(|&quantity| channels.has(quantity))) {
        for message in rule.of.iter().filter_map(|&quantity| (rule.test)(channels, quantity)) {
            let cause = found.iter().find(|(other, _)| other.supersedes.contains(&rule.name));
            match cause {
                Some((_, cause)) if rule.refuses => return Err(refused(cause)),
                None if rule.refuses => return Err(refused(&message)),
                Some(_) => (),
                None => found.push((rule, message)),
            }
        }
    }
    Ok(found.into_iter().map(|(_, message)| message).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_supersedes_rules_that_come_after_it() {
        for (k, rule) in RECORDING_RULES.iter().enumerate() {
            for other in rule.supersedes {
                assert!(RECORDING_RULES[k + 1..].iter().any(|rule| rule.name == *other), "{}: {other}", rule.name);
            }
        }
    }
}
