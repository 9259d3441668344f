//! A survey of a rig: is its platform free of singularities wherever its legs can go?

use nalgebra::Vector3;

use super::{Geometry, Pose, forward_kinematics, jacobian, leg_lengths};
use crate::interface::Rig;

/// Leg lengths tried for each leg, evenly from the shortest to the longest.
const LEVELS: usize = 4;
/// Condition number beyond which the platform counts as singular; the default rig stays below 4.
const WORST_CONDITION: f64 = 50.0;
/// A move from one grid point to the next is followed in this many parts.
const PARTS: usize = 2;

/// Result of a survey over a grid of leg lengths, 4 levels for each leg.
///
/// Both figures are of the Jacobian with angular velocity counted as the speed of a point at the
/// platform joints' mean radius, so that they have no unit and do not depend on the rig's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Survey {
    /// Smallest singular value.
    pub smallest_singular_value: f64,
    /// Largest ratio of the largest to the smallest singular value.
    pub worst_condition: f64,
}

/// Leg lengths at which the platform is singular or cannot be followed to \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurveyFailed {
    pub lengths: [f64; 6],
}

/// Surveys a rig over the whole box of its leg lengths.
///
/// From neutral the platform is followed by forward kinematics from grid point to grid
/// point, each one leg's move away from the last. At each the Jacobian must be well
/// conditioned and its determinant of the sign it has at neutral: a change of sign tells of
/// a singularity between the points.
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
    let neutral_sign = jacobian(&geometry, &pose).determinant().signum();
    let radius = mean_radius(&rig.platform);
    let mut found = Survey { smallest_singular_value: f64::INFINITY, worst_condition: 0.0 };
    let mut failed = false;
    walk(&mut |levels: &[usize; 6]| {
        let target = levels.map(|level| level_length(rig, level));
        match follow(&geometry, &pose, &lengths, &target) {
            Some(next) => pose = next,
            None => failed = true,
        }
        lengths = target;
        let mut jacobian = jacobian(&geometry, &pose);
        jacobian.fixed_columns_mut::<3>(3).apply(|entry| *entry /= radius);
        let singular_values = jacobian.svd(false, false).singular_values;
        let condition = singular_values.max() / singular_values.min();
        failed |= condition.is_nan() || condition > WORST_CONDITION || jacobian.determinant().signum() != neutral_sign;
        found.smallest_singular_value = found.smallest_singular_value.min(singular_values.min());
        found.worst_condition = found.worst_condition.max(condition);
        !failed
    });
    if failed { Err(SurveyFailed { lengths }) } else { Ok(found) }
}

/// Visits every point of the grid, going back and forth so that each differs from the last by one
/// level of one leg. Stops when `visit` returns false.
fn walk(visit: &mut impl FnMut(&[usize; 6]) -> bool) {
    let mut levels = [0; 6];
    let mut upward = [true; 6];
    loop {
        if !visit(&levels) {
            return;
        }
        // The reflected Gray code: the first leg that can move on does, and those before it turn round.
        let mut leg = 0;
        while leg < 6 && levels[leg] == if upward[leg] { LEVELS - 1 } else { 0 } {
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
    rig.min_length + (rig.max_length - rig.min_length) * level as f64 / (LEVELS - 1) as f64
}

/// Forward kinematics along the straight line between two sets of leg lengths.
fn follow(geometry: &Geometry, pose: &Pose, from: &[f64; 6], to: &[f64; 6]) -> Option<Pose> {
    let mut pose = *pose;
    for part in 1..=PARTS {
        let fraction = part as f64 / PARTS as f64;
        let lengths = std::array::from_fn(|i| from[i] + fraction * (to[i] - from[i]));
        pose = forward_kinematics(geometry, &lengths, &pose).ok()?;
    }
    Some(pose)
}

/// The mean distance of the joints from their centroid.
fn mean_radius(joints: &[Vector3<f64>; 6]) -> f64 {
    let centroid = joints.iter().sum::<Vector3<f64>>() / 6.0;
    joints.iter().map(|joint| (joint - centroid).norm()).sum::<f64>() / 6.0
}
