//! A survey of a rig for singularities, over all lengths of its legs or arcs of its cranks.

use nalgebra::Vector3;

use super::{Geometry, Pose, forward_kinematics, jacobian, leg_lengths};
use crate::interface::Rig;

/// Leg lengths tried for each leg, evenly from the shortest to the longest.
const LEVELS_PER_LEG: usize = 4;
/// Condition number beyond which the platform counts as singular; the default rig stays below 4.
const WORST_CONDITION: f64 = 50.0;
/// A move from one grid point to the next is followed in this many parts.
const PARTS_PER_MOVE: usize = 2;

/// Result of a survey over a grid of leg lengths, 4 levels for each leg.
///
/// In the Jacobian, angular velocity counts as the speed of a point at the platform joints' mean
/// radius. Both figures therefore have no unit and do not depend on the rig's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Survey {
    /// Smallest singular value.
    pub smallest_singular_value: f64,
    /// Largest ratio of the largest to the smallest singular value.
    pub worst_condition: f64,
}

/// Leg lengths, or arcs of cranks, at which the platform is singular or cannot
/// be followed to \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurveyFailed {
    pub lengths: [f64; 6],
}

/// Surveys a rig over the whole box of its leg lengths, or of the angles of its cranks. The rods of
/// cranks count as legs from the ends of the arms.
///
/// From neutral the platform is followed by forward kinematics from grid point to grid point,
/// each one leg's move away from the last. At each the Jacobian must be well conditioned, and
/// its determinant must have the sign that it has at neutral. A change of sign means a
/// singularity between the points.
///
/// ```
/// use moris_washout::Rig;
/// use moris_washout::platform::survey;
///
/// let rig = Rig::default();
/// assert!(survey(&rig).expect("not singular").worst_condition < 4.0);
/// // Legs between two hexagons alike hold no platform.
/// let parallel = Rig { platform: rig.base, ..rig };
/// assert!(survey(&parallel).is_err());
/// ```
///
/// # Errors
/// The first leg lengths found at which the platform is singular.
pub fn survey(rig: &Rig) -> Result<Survey, SurveyFailed> {
    let geometry = Geometry::from(rig);
    let mut pose = Pose::neutral(rig);
    let mut lengths = leg_lengths(&geometry, &pose);
    let rods = |lengths: &[f64; 6]| geometry.cranks.map_or(geometry, |cranks| cranks.rods(&geometry, lengths));
    let neutral_sign = jacobian(&rods(&lengths), &pose).determinant().signum();
    let radius = mean_radius(&rig.platform);
    let mut found = Survey { smallest_singular_value: f64::INFINITY, worst_condition: 0.0 };
    let mut failed = false;
    visit_grid(&mut |levels: &[usize; 6]| {
        let target = levels.map(|level| level_length(rig, level));
        match follow_leg_lengths(&geometry, &pose, &lengths, &target) {
            Some(next) => pose = next,
            None => failed = true,
        }
        lengths = target;
        let mut jacobian = jacobian(&rods(&lengths), &pose);
        jacobian.fixed_columns_mut::<3>(3).apply(|entry| *entry /= radius);
        // A decomposition of what is no number does not end: joints at one point have no radius.
        if !jacobian.iter().all(|entry| entry.is_finite()) {
            failed = true;
            return false;
        }
        let singular_values = jacobian.svd(false, false).singular_values;
        let condition = singular_values.max() / singular_values.min();
        let regular = (1.0..=WORST_CONDITION).contains(&condition);
        failed |= !regular || jacobian.determinant().signum() != neutral_sign;
        found.smallest_singular_value = found.smallest_singular_value.min(singular_values.min());
        found.worst_condition = found.worst_condition.max(condition);
        !failed
    });
    if failed { Err(SurveyFailed { lengths }) } else { Ok(found) }
}

/// Visits every point of the grid, going back and forth so that each differs from the last by one
/// level of one leg. Stops when `visit` returns false.
fn visit_grid(visit: &mut impl FnMut(&[usize; 6]) -> bool) {
    let mut levels = [0; 6];
    let mut upward = [true; 6];
    loop {
        if !visit(&levels) {
            return;
        }
        // The reflected Gray code: the first leg that can move on does, and those before it turn round.
        let mut leg = 0;
        while leg < 6 && levels[leg] == if upward[leg] { LEVELS_PER_LEG - 1 } else { 0 } {
            upward[leg] = !upward[leg];
            leg += 1;
        }
        if leg == 6 {
            return;
        }
        if upward[leg] {
            levels[leg] += 1;
        } else {
            levels[leg] -= 1;
        }
    }
}

fn level_length(rig: &Rig, level: usize) -> f64 {
    rig.stroke()[0] + rig.stroke_length() * level as f64 / (LEVELS_PER_LEG - 1) as f64
}

/// Forward kinematics along the straight line between two sets of leg lengths.
fn follow_leg_lengths(geometry: &Geometry, pose: &Pose, from: &[f64; 6], to: &[f64; 6]) -> Option<Pose> {
    let mut pose = *pose;
    for part in 1..=PARTS_PER_MOVE {
        let fraction = part as f64 / PARTS_PER_MOVE as f64;
        let lengths = core::array::from_fn(|i| from[i] + fraction * (to[i] - from[i]));
        pose = forward_kinematics(geometry, &lengths, &pose).ok()?;
    }
    Some(pose)
}

/// The mean distance of the joints from their centroid \[m\].
pub fn mean_radius(joints: &[Vector3<f64>; 6]) -> f64 {
    let centroid = joints.iter().sum::<Vector3<f64>>() / 6.0;
    joints.iter().map(|joint| (joint - centroid).norm()).sum::<f64>() / 6.0
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn the_grid_is_visited_once_by_moves_of_one_leg_by_one_level() {
        let mut visited = HashSet::new();
        let mut last: Option<[usize; 6]> = None;
        visit_grid(&mut |levels| {
            if let Some(last) = last {
                assert_eq!((0..6).map(|leg| levels[leg].abs_diff(last[leg])).sum::<usize>(), 1, "{last:?}, {levels:?}");
            }
            assert!(levels.iter().all(|level| *level < LEVELS_PER_LEG) && visited.insert(*levels));
            last = Some(*levels);
            true
        });
        assert_eq!(visited.len(), LEVELS_PER_LEG.pow(6));
        let mut count = 0;
        visit_grid(&mut |_| {
            count += 1;
            count < 5
        });
        assert_eq!(count, 5, "a visit that returns false is the last");
    }

    #[test]
    fn levels_go_from_the_shortest_to_the_longest() {
        let rig = Rig::default();
        let lengths: Vec<f64> = (0..LEVELS_PER_LEG).map(|level| level_length(&rig, level)).collect();
        assert!(lengths.iter().zip([1.0, 1.2, 1.4, 1.6]).all(|(found, expected)| (found - expected).abs() < 1e-15));
    }

    #[test]
    fn the_mean_radius_is_about_the_centroid() {
        let around = |centre: Vector3<f64>| {
            let at = |angle: f64, radius: f64| centre + radius * Vector3::new(angle.cos(), angle.sin(), 0.0);
            core::array::from_fn(|i| at(core::f64::consts::FRAC_PI_3 * i as f64, if i % 2 == 0 { 0.4 } else { 0.6 }))
        };
        // Opposite joints differ in radius: the centroid is still the centre, by threes.
        for centre in [Vector3::zeros(), Vector3::new(1.0, -2.0, 0.5)] {
            assert!((mean_radius(&around(centre)) - 0.5).abs() < 1e-14);
        }
    }

    #[test]
    fn the_platform_is_followed_to_its_new_lengths() {
        let rig = Rig::default();
        let geometry = Geometry::from(&rig);
        let pose = Pose::neutral(&rig);
        let lengths = leg_lengths(&geometry, &pose);
        let target = [1.25, 1.35, 1.3, 1.4, 1.28, 1.33];
        let found = follow_leg_lengths(&geometry, &pose, &lengths, &target).expect("inside the workspace");
        let reached = leg_lengths(&geometry, &found);
        assert!(reached.iter().zip(&target).all(|(a, b)| (a - b).abs() < 1e-9), "{reached:?}");
        assert!(follow_leg_lengths(&geometry, &pose, &lengths, &[1.3, 1.3, 1.3, 1.3, 1.3, 9.0]).is_none());
    }

    /// The default rig with the platform's joints this many degrees on either side of three points.
    fn with_pairs_apart(half_angle: f64) -> Rig {
        let mut rig = Rig::default();
        let angles = [-60.0, 60.0, 60.0, 180.0, 180.0, 300.0];
        for (i, angle) in angles.into_iter().enumerate() {
            let angle = f64::to_radians(angle + if i % 2 == 0 { half_angle } else { -half_angle });
            rig.platform[i] = 0.85 * Vector3::new(angle.cos(), angle.sin(), 0.0);
        }
        rig
    }

    /// Figures with numpy: the same grid, Newton's method with steps of a rotation vector, singular
    /// values of the Jacobian in units of the mean radius.
    #[test]
    fn figures_are_those_of_another_implementation() {
        for (half_angle, singular_value, condition) in [
            (8.0, 0.581_704_905_098, 3.462_205_976_243),
            (12.0, 0.486_944_757_104, 4.309_463_866_615),
            (16.0, 0.343_062_679_788, 6.333_663_282_896),
        ] {
            let found = survey(&with_pairs_apart(half_angle)).expect("not singular");
            assert!((found.smallest_singular_value - singular_value).abs() < 1e-9, "{half_angle}°: {found:?}");
            assert!((found.worst_condition - condition).abs() < 1e-8, "{half_angle}°: {found:?}");
        }
        // With these the platform is lost where neighbouring legs are at opposite ends.
        let refused = survey(&with_pairs_apart(20.0)).expect_err("singular");
        assert!(refused.lengths.iter().all(|length| (1.0..=1.6).contains(length)), "{refused:?}");
    }

    /// Legs that hardly move: the Jacobian is the same everywhere, and its sign with it.
    #[test]
    fn a_condition_of_more_than_fifty_is_refused() {
        let survey_at_neutral = |half_angle: f64| {
            let rig = with_pairs_apart(half_angle);
            let lengths = leg_lengths(&Geometry::from(&rig), &Pose::neutral(&rig));
            survey(&Rig { min_length: lengths[0] - 1e-6, max_length: lengths[0] + 1e-6, ..rig })
        };
        let [good, bad] = [50.0, 51.5].map(survey_at_neutral);
        let condition = good.expect("not singular").worst_condition;
        assert!((20.0..50.0).contains(&condition), "{condition}");
        assert!(bad.is_err(), "{bad:?}");
    }

    #[test]
    fn joints_at_one_point_are_refused_at_once() {
        let rig = Rig::default();
        for point in [Vector3::zeros(), Vector3::new(0.1, 0.2, 0.0)] {
            assert!(survey(&Rig { platform: [point; 6], ..rig }).is_err());
            assert!(survey(&Rig { base: [point; 6], ..rig }).is_err());
        }
    }

    #[test]
    fn the_size_of_a_rig_does_not_matter() {
        let rig = Rig::default();
        let found = survey(&rig).expect("not singular");
        let double = Rig {
            base: rig.base.map(|joint| 2.0 * joint),
            platform: rig.platform.map(|joint| 2.0 * joint),
            neutral_height: 2.0 * rig.neutral_height,
            min_length: 2.0 * rig.min_length,
            max_length: 2.0 * rig.max_length,
            ..rig
        };
        let same = survey(&double).expect("not singular");
        assert!((same.worst_condition - found.worst_condition).abs() < 1e-9, "{same:?}");
        assert!((same.smallest_singular_value - found.smallest_singular_value).abs() < 1e-9, "{same:?}");
    }
}
