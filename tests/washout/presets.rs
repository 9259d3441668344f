//! The parameter sets that are shipped.

use std::collections::HashSet;

use moris_washout::Washout;
use moris_washout::presets::{self, *};

#[test]
fn every_set_changes_each_of_its_parameters_once_and_can_be_used() {
    let sets = [
        (PAPER, 1.0),
        (SMALL_MOTIONS, 1.0),
        (MOTORCYCLE, 1.0),
        (CAR, 1.0),
        (PREACTION, 4.0),
        (CLASSICAL, 1.0),
        (ADAPTIVE, 2.0),
        (OPTIMAL, 3.0),
        (PREDICTIVE, 4.0),
        (ROBUST, 5.0),
        (PREVIEW, 4.0),
    ];
    for (set, strategy) in sets {
        let values = presets::values(set);
        let names: HashSet<_> = values.iter().map(|(name, _)| *name).collect();
        assert_eq!(names.len(), values.len(), "{names:?}");
        let parameters = presets::parameters(set);
        assert_eq!(parameters, presets::with("", &[&[("strategy", strategy)], &values[..]].concat()));
        Washout::new(&parameters).unwrap();
    }
}

#[test]
fn a_preview_widens_the_limits_of_the_predictive_set() {
    let (predictive, preview) = (presets::parameters(PREDICTIVE), presets::parameters(PREVIEW));
    let [narrow, wide] = [predictive, preview].map(|parameters| parameters.conditioning.force_limit);
    assert!((0..2).all(|axis| wide[axis] > narrow[axis]));
    assert!(preview.tilt.angle_limit > predictive.tilt.angle_limit);
    assert!(preview.soft_limit.pace > predictive.soft_limit.pace);
    assert_eq!(preview.tilt.rate_limit, predictive.tilt.rate_limit);
    assert_eq!(preview.structure, predictive.structure);
}
