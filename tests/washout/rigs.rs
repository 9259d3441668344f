//! Rigs: what is known of the default one, and which are refused.

use std::time::Instant;

use moris_washout::platform::survey;
use moris_washout::{Parameters, check, warnings};
use moris_washout::{Rig, Washout};
use nalgebra::Vector3;

use crate::common::rotation::{Vec3, to_base};

fn joints(radius: f64, degrees: [f64; 6]) -> [Vector3<f64>; 6] {
    degrees.map(|angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        Vector3::new(radius * cos, radius * sin, 0.0)
    })
}

/// True if all legs are inside the stroke with the platform displaced from neutral by this.
fn reaches(rig: &Rig, offset: Vec3, angles: Vec3) -> bool {
    (0..6).all(|i| {
        let turned = Vector3::from(to_base(angles, rig.platform[i].into()));
        let leg = Vector3::from(offset) + Vector3::new(0.0, 0.0, rig.neutral_height) + turned - rig.base[i];
        (rig.min_length..=rig.max_length).contains(&leg.norm())
    })
}

/// Reach of the default platform along one of x, y, z, roll, pitch, yaw alone, in
/// the direction of `sign`.
fn range(axis: usize, sign: f64) -> f64 {
    let rig = Rig::default();
    let (mut inside, mut outside) = (0.0, 1.5);
    while outside - inside > 1e-6 {
        let middle = 0.5 * (inside + outside);
        let mut displacement = [0.0; 6];
        displacement[axis] = sign * middle;
        let [x, y, z, roll, pitch, yaw] = displacement;
        if reaches(&rig, [x, y, z], [roll, pitch, yaw]) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

#[test]
fn the_default_rig_is_the_described_one() {
    let rig = Rig::default();
    let base = joints(1.0, [-8.0, 8.0, 112.0, 128.0, 232.0, 248.0]);
    let platform = joints(0.85, [-52.0, 52.0, 68.0, 172.0, 188.0, 292.0]);
    for i in 0..6 {
        assert!((rig.base[i] - base[i]).norm() < 1e-14 && (rig.platform[i] - platform[i]).norm() < 1e-14);
    }
    let length = Washout::new(&Parameters::default()).unwrap().output().length;
    assert!(length.iter().all(|length| (length - 1.29996).abs() < 5e-6), "{length:?}");
}

#[test]
fn the_default_rigs_ranges_on_single_axes() {
    let meters = |axis, below: f64, above: f64| {
        let (b, a) = (range(axis, -1.0), range(axis, 1.0));
        assert!((b - below).abs() < 2e-3 && (a - above).abs() < 2e-3, "axis {axis}: -{b} +{a}");
    };
    meters(0, 0.576, 0.468);
    meters(1, 0.478, 0.478);
    meters(2, 0.383, 0.344);
    let degrees = |axis, below: f64, above: f64| {
        let (b, a) = (range(axis, -1.0).to_degrees(), range(axis, 1.0).to_degrees());
        assert!((b - below).abs() < 0.05 && (a - above).abs() < 0.05, "axis {axis}: -{b} +{a}");
    };
    degrees(3, 25.2, 25.2);
    degrees(4, 25.5, 24.9);
    degrees(5, 34.0, 34.0);
}

#[test]
fn the_default_rig_is_free_of_singularities() {
    let survey = survey(&Rig::default()).unwrap();
    println!("{survey:?}");
    assert!(survey.smallest_singular_value > 0.5);
    assert!(survey.worst_condition <= 3.5);
}

/// The message with which a rig is refused; panics if it is accepted.
fn refusal(rig: Rig) -> String {
    check(&Parameters { rig, ..Parameters::default() }).expect_err("this rig must be refused").to_string()
}

#[test]
fn similar_hexagons_are_refused() {
    // The classic: joints of platform and base at the same angles; the platform can turn about its axis freely.
    let angles = [-8.0, 8.0, 112.0, 128.0, 232.0, 248.0];
    let rig = Rig { base: joints(1.0, angles), platform: joints(0.85, angles), neutral_height: 1.29, ..Rig::default() };
    let message = refusal(rig);
    assert!(message.contains("singular") && message.contains("rig."), "{message}");
}

#[test]
fn a_rig_singular_only_away_from_neutral_is_refused() {
    // Well conditioned at neutral; but with legs this long and a base this narrow it folds inside its stroke.
    let rig = Rig { min_length: 0.3, max_length: 2.5, ..Rig::default() };
    let message = refusal(rig);
    assert!(message.contains("singular"), "{message}");
}

#[test]
fn a_scaled_default_rig_is_accepted() {
    let Rig { base, platform, neutral_height, min_length, max_length, .. } = Rig::default();
    for scale in [0.2, 0.5, 3.0] {
        let rig = Rig {
            base: base.map(|joint| scale * joint),
            platform: platform.map(|joint| scale * joint),
            neutral_height: scale * neutral_height,
            min_length: scale * min_length,
            max_length: scale * max_length,
            ..Rig::default()
        };
        assert_eq!(check(&Parameters { rig, ..Parameters::default() }), Ok(()), "scale {scale}");
    }
}

#[test]
fn neutral_outside_the_stroke_is_refused() {
    let message = refusal(Rig { neutral_height: 2.0, ..Rig::default() });
    assert!(message.contains("rig.neutralHeight") && message.contains("actuator"), "{message}");
}

/// Sweeps make a washout for each set of parameters on one rig.
#[test]
fn a_rig_of_one_s_own_is_surveyed_once() {
    let mut parameters = Parameters::default();
    parameters.rig.neutral_height = 1.087_654_321;
    let made = || {
        let start = Instant::now();
        Washout::new(&parameters).expect("accepted");
        start.elapsed()
    };
    let first = made();
    let again = (0..20).map(|_| made()).min().expect("some");
    assert!(4 * again < first, "{first:?} at first, then {again:?}");
}

#[test]
fn a_rig_near_an_end_or_with_weak_actuators_is_warned_of() {
    let default = Parameters::default();
    let warned = |rig: Rig| warnings(&Parameters { rig, ..default }).into_iter().next_back().unwrap_or_default();
    assert_eq!(warned(default.rig), "");
    // The legs are 1.29996 m long at neutral.
    let low = Rig { min_length: 1.297, max_length: 1.42, ..default.rig };
    let warning = warned(low);
    assert!(warning.starts_with("rig.neutralHeight is 1.091 m, where a leg is only 0.0030 m from an end"), "{warning}");
    let warning = warned(Rig { acceleration_limit: 0.8, ..default.rig });
    assert!(warning.starts_with("actuator.accelerationLimit is 0.8 m/s2, but braking from 1 m/s at"), "{warning}");
    assert!(warning.contains("takes 5.0 m/s2: only 0.16 m/s are used"), "{warning}");
}
