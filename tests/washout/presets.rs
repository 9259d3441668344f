//! The parameter sets that are shipped.

use std::collections::HashSet;

use moris_washout::presets::{self, *};
use moris_washout::{Washout, warnings};

#[test]
fn every_set_changes_each_of_its_parameters_once_and_can_be_used() {
    let sets = [(PAPER, 1.0), (CLASSICAL, 1.0), (ADAPTIVE, 2.0), (OPTIMAL, 3.0), (ROBUST, 5.0), (PREVIEW, 4.0)];
    for (set, strategy) in sets {
        let values = presets::values(set);
        let names: HashSet<_> = values.iter().map(|(name, _)| *name).collect();
        assert_eq!(names.len(), values.len(), "{names:?}");
        let parameters = presets::parameters(set);
        assert_eq!(parameters, presets::with("", &[&[("strategy", strategy)], &values[..]].concat()));
        Washout::new(&parameters).unwrap();
        assert_eq!(warnings(&parameters), Vec::<String>::new());
        // A set that is another one, or the start values, is none.
        let is_same = |(other, _): &&(&str, f64)| presets::parameters(other) == parameters;
        assert!(sets.iter().filter(is_same).count() == 1 && parameters != presets::parameters(""));
    }
}

#[test]
fn a_parameter_without_effect_or_beyond_the_usual_range_is_named() {
    let of = |changed: &[(&str, f64)]| warnings(&presets::with("", changed));
    assert_eq!(
        of(&[("splitter.x.omega1", 2.0)]),
        ["splitter.x.omega1 has no effect with strategy predictive, only with classical"]
    );
    // Heave has the splitter's filter with every strategy, and the classical one has it all.
    assert!(of(&[("splitter.z.omega1", 2.0)]).is_empty());
    assert!(of(&[("splitter.x.omega1", 2.0), ("strategy", 1.0)]).is_empty());
    assert_eq!(
        of(&[("splitter.x.zeta2", 0.7), ("strategy", 1.0)]),
        ["splitter.x.zeta2 has no effect with splitter.order 3, only with 4"]
    );
    assert_eq!(
        of(&[("robust.splitTime", 0.3), ("automaticScale.memory", 9.0)]),
        [
            "robust.splitTime has no effect with strategy predictive, only with robust",
            "automaticScale.memory has no effect with scale.automatic off, only with on"
        ]
    );
    // Of many one sentence.
    let four = ["splitter.x.omega1", "splitter.x.zeta1", "splitter.y.omega1", "splitter.y.zeta1"];
    assert_eq!(
        of(&four.map(|name| (name, 1.7))),
        [
            "splitter.x.omega1, splitter.y.omega1, splitter.x.zeta1 and 1 more have no effect with strategy predictive, only with classical"
        ]
    );
    // 3 was meant in degrees a second.
    assert_eq!(
        of(&[("tilt.rateLimit", 3.0)]),
        ["tilt.rateLimit is 3 rad/s, but the usual range is 0.02 to 0.053 rad/s; in degrees it would be 0.0524 rad/s"]
    );
    assert_eq!(
        of(&[("scale.specificForce.x", -1.0)]),
        ["scale.specificForce.x is -1, but the usual range is 0.01 to 1"]
    );
    assert!(of(&[("scale.specificForce.x", 0.0), ("input.rateCutoff", 0.0)]).is_empty(), "0 switches off");
    assert!(of(&[("automaticScale.start", 1.0)]).is_empty(), "files of a fit have it");
    assert_eq!(of(&[("automaticScale.start", 0.5)]).len(), 1);
}

#[test]
fn a_preview_widens_the_limits_of_the_predictive_set() {
    let (predictive, preview) = (presets::parameters(""), presets::parameters(PREVIEW));
    let [narrow, wide] = [predictive, preview].map(|parameters| parameters.conditioning.force_limit);
    assert!((0..2).all(|axis| wide[axis] > narrow[axis]));
    assert!(preview.tilt.angle_limit > predictive.tilt.angle_limit);
    assert!(preview.soft_limit.pace > predictive.soft_limit.pace);
    assert_eq!(preview.tilt.rate_limit, predictive.tilt.rate_limit);
    assert_eq!(preview.structure, predictive.structure);
}
