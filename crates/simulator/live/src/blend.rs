//! The way from one parameter set to another, in small changes.
//!
//! [`Session::retune`](crate::Session::retune) lets nothing jump, but a change of many parameters
//! at once may be felt as a jolt. Changes of [`INTERVAL`] within [`TIME`] are not.

use moris_interface::{Group as _, Kind};
use moris_washout::Parameters;

/// Time from one set to another \[s\].
pub const TIME: f64 = 2.0;
/// Time from one change to the next \[s\].
pub const INTERVAL: f64 = 0.04;

/// The values of all slots at a part of the way. Positive numbers go in equal factors, others in
/// equal differences. What is no real number changes halfway.
pub fn blended(from: &[f64], to: &[f64], part: f64) -> Vec<f64> {
    let part = part.clamp(0.0, 1.0);
    let smooth = part * part * (3.0 - 2.0 * part);
    let slots = Parameters::SLOTS.iter().zip(from.iter().zip(to));
    let value = |(slot, (from, to)): (&moris_interface::Slot, (&f64, &f64))| {
        let is_real = matches!(Parameters::ROWS[usize::from(slot.row)].kind, Kind::Real(_));
        match () {
            () if part >= 1.0 || from == to => *to,
            () if !is_real => *if part < 0.5 { from } else { to },
            () if *from > 0.0 && *to > 0.0 => from * (to / from).powf(smooth),
            () => from + smooth * (to - from),
        }
    };
    slots.map(value).collect()
}

#[cfg(test)]
mod tests {
    use moris_interface::slots_of;

    use super::*;
    use crate::log::slot_of;

    #[test]
    fn the_way_begins_and_ends_with_the_sets_and_is_halfway_in_the_middle() {
        let from = slots_of(&Parameters::default());
        let mut to = from.clone();
        let slots = ["scale.specificForce.x", "washoutPoint.x", "compensation"].map(|name| slot_of(name).unwrap());
        let ends = [[1.0, 0.25], [0.0, 0.4], [3.0, 1.0]];
        for (slot, [start, end]) in slots.into_iter().zip(ends) {
            assert_eq!(from[slot], start);
            to[slot] = end;
        }
        assert_eq!(blended(&from, &to, 0.0), from);
        assert_eq!(blended(&from, &to, 1.0), to);
        assert_eq!(slots.map(|slot| blended(&from, &to, 0.5)[slot]), [0.5, 0.2, 1.0]);
        assert_eq!(blended(&from, &to, 0.4)[slots[2]], 3.0);
    }
}
