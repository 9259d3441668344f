//! The order in which the legs are numbered.

use nalgebra::Vector3;

use crate::interface::Rig;

/// Advice for a rig that [`is_opposite`], as a sentence.
pub const NUMBERING_ADVICE: &str = "The joints of the base are numbered one way round, those of the platform the other; leg 1 joins \
                          joint 1 of the base with joint 1 of the platform";

/// True if the base's joints go clockwise from 1 to 6 and the platform's counterclockwise, or the
/// other way about. Few rigs are so made; more often one of the lists is read the wrong way.
pub fn is_opposite(rig: &Rig) -> bool {
    twice_signed_area(&rig.base) * twice_signed_area(&rig.platform) < 0.0
}

/// Twice the area within the joints from 1 to 6, seen from above; negative if they go clockwise.
fn twice_signed_area(joints: &[Vector3<f64>; 6]) -> f64 {
    (0..6).map(|i| joints[i].xy().perp(&joints[(i + 1) % 6].xy())).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_list_the_wrong_way_is_opposite_and_both_are_not() {
        let rig = Rig::default();
        let reversed = |joints: &[Vector3<f64>; 6]| core::array::from_fn(|i| joints[5 - i]);
        assert!(!is_opposite(&rig));
        assert!(is_opposite(&Rig { base: reversed(&rig.base), ..rig }));
        assert!(is_opposite(&Rig { platform: reversed(&rig.platform), ..rig }));
        assert!(!is_opposite(&Rig { base: reversed(&rig.base), platform: reversed(&rig.platform), ..rig }));
    }
}
