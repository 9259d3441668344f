//! Reach of a platform along one axis alone.

use nalgebra::Vector3;

use super::{Geometry, Pose, leg_lengths};
use crate::interface::Rig;
use crate::motion::orientation::{Orientation, RollPitchYaw};
use crate::motion::square_root::square_root;

/// An axis of the platform's motion: a translation in the base frame or a rotation from level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    Surge,
    Sway,
    Heave,
    Roll,
    Pitch,
    Yaw,
}

impl Axis {
    /// All six, translations first.
    pub const ALL: [Axis; 6] = [Axis::Surge, Axis::Sway, Axis::Heave, Axis::Roll, Axis::Pitch, Axis::Yaw];

    /// The axis' name in lower case.
    pub fn name(self) -> &'static str {
        ["surge", "sway", "heave", "roll", "pitch", "yaw"][self as usize]
    }

    /// True for a rotation, in \[rad\]; a translation is in \[m\].
    pub fn is_rotation(self) -> bool {
        self as usize >= 3
    }
}

/// Reach from neutral along one axis in both directions \[m or rad\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Not above 0.
    pub min: f64,
    /// Not below 0.
    pub max: f64,
}

impl Range {
    /// Smaller of the reaches in the two directions.
    pub fn min_reach(self) -> f64 {
        self.max.min(-self.min)
    }
}

/// The neutral pose displaced along one axis by this much \[m or rad\].
pub fn displaced(rig: &Rig, axis: Axis, amount: f64) -> Pose {
    let mut displacement = [0.0; 6];
    displacement[axis as usize] = amount;
    let [x, y, z, roll, pitch, yaw] = displacement;
    Pose {
        position: Pose::neutral(rig).position + Vector3::new(x, y, z),
        orientation: Orientation::new(RollPitchYaw::new(roll, pitch, yaw)),
    }
}

/// Clearance of the strokes in a pose: smallest distance of a leg from either end of its
/// stroke \[m\]. Negative where a leg would have to be beyond its stroke. With cranks, the
/// stroke is the arc of the arms' ends, and what their transmission has beyond its limit
/// counts as well, times the arm.
pub fn stroke_clearance(rig: &Rig, pose: &Pose) -> f64 {
    let geometry = Geometry::from(rig);
    let clearance = clearance_of_lengths(rig, &leg_lengths(&geometry, pose));
    let Some(cranks) = &geometry.cranks else { return clearance };
    clearance.min(cranks.arm * (cranks.transmission(&geometry, pose) - cranks.least_transmission))
}

/// The smallest distance of these lengths, or arcs, from either end of their stroke \[m\].
pub fn clearance_of_lengths(rig: &Rig, lengths: &[f64; 6]) -> f64 {
    let [start, end] = rig.stroke();
    lengths.iter().map(|length| (length - start).min(end - length)).fold(f64::INFINITY, f64::min)
}

/// Lengths of the shortest and of the longest leg at neutral \[m\].
pub fn neutral_lengths(geometry: &Geometry, neutral_height: f64) -> [f64; 2] {
    let position = Vector3::new(0.0, 0.0, neutral_height);
    let lengths = leg_lengths(geometry, &Pose { position, orientation: Orientation::new(RollPitchYaw::default()) });
    [f64::min, f64::max].map(|pick| lengths.iter().copied().fold(lengths[0], pick))
}

/// The stroke that the soft limits use \[m\]. That of cranks ends no farther than at the arcs at
/// which a transmission comes to its limit while the platform heaves.
pub(crate) fn clear_stroke(rig: &Rig) -> [f64; 2] {
    let [start, end] = rig.stroke();
    let geometry = Geometry::from(rig);
    let Some(cranks) = &geometry.cranks else { return [start, end] };
    let [lowest, highest] = [-1.0, 1.0].map(|sign| {
        let pose = |heave: f64| displaced(rig, Axis::Heave, sign * heave);
        let (mut within, mut without) = (0.0, 2.0 * cranks.arm);
        for _ in 0..HEAVE_HALVINGS {
            let middle = 0.5 * (within + without);
            let complies = cranks.transmission(&geometry, &pose(middle)) >= cranks.least_transmission;
            if complies { within = middle } else { without = middle }
        }
        leg_lengths(&geometry, &pose(within))
    });
    [lowest.into_iter().fold(end, f64::min).max(start), highest.into_iter().fold(start, f64::max).min(end)]
}

/// Halvings of two arms: to a ten-thousandth of an arm.
const HEAVE_HALVINGS: u32 = 14;

/// Reach of the platform along this axis alone, all other coordinates neutral, up to the pose at
/// which the first leg is at an end of its stroke. Rotations end at a quarter turn.
pub fn single_axis_range(rig: &Rig, axis: Axis) -> Range {
    Range { min: -reach_along(rig, axis, -1.0), max: reach_along(rig, axis, 1.0) }
}

/// Stroke from which on margins have their full size \[m\].
const FULL_MARGIN_STROKE: f64 = 0.3;

/// Factor on a margin at the ends of the stroke, 1 from a stroke of 0.3 m on: a short stroke would
/// be used up by the whole margin.
pub fn short_stroke_factor(rig: &Rig) -> f64 {
    (rig.stroke_length() / FULL_MARGIN_STROKE).min(1.0)
}

/// The soft limits' pace on this rig: less below a stroke of 0.1 m, down to half. There limits of
/// several legs begin to act within milliseconds of each other.
pub fn pace_within_stroke(pace: f64, rig: &Rig) -> f64 {
    pace * (0.5 + 1.5 * short_stroke_factor(rig)).min(1.0)
}

/// Smaller of the two reaches of surge and of sway, as [`single_axis_range`] but in
/// closed form for legs.
///
/// A leg whose joints are d apart at neutral has the squared length |d|^2 + 2 x d_k + x^2.
pub fn horizontal_reach(rig: &Rig) -> [f64; 2] {
    if rig.has_cranks() {
        return [Axis::Surge, Axis::Sway].map(|axis| single_axis_range(rig, axis).min_reach());
    }
    let neutral = Vector3::new(0.0, 0.0, rig.neutral_height);
    [0, 1].map(|k: usize| {
        let legs = rig.platform.iter().zip(&rig.base);
        legs.map(|(platform, base)| {
            let apart = neutral + platform - base;
            let along = apart[k].abs();
            let half_chord =
                |length: f64| square_root((along * along - apart.norm_squared() + length * length).max(0.0));
            // Away from the base joint the leg ends at its longest, towards it also at its shortest.
            let (longest, shortest) = (half_chord(rig.max_length), half_chord(rig.min_length));
            if shortest > 0.0 { (longest - along).min((along - shortest).abs()) } else { longest - along }
        })
        .fold(f64::INFINITY, f64::min)
    })
}

/// Largest reach considered: translations \[multiples of the farthest joint\], rotations \[rad\].
const SEARCH_LIMITS: [f64; 2] = [2.0, core::f64::consts::FRAC_PI_2];
/// Number of points checked on the path, so that a leg that leaves its stroke and returns is found.
const SEARCH_POINTS: u32 = 2000;
/// Halvings of the last part: to well below a nanometre.
const BISECTION_STEPS: u32 = 40;

fn reach_along(rig: &Rig, axis: Axis, sign: f64) -> f64 {
    let farthest = if axis.is_rotation() { SEARCH_LIMITS[1] } else { SEARCH_LIMITS[0] * rig.farthest_joint() };
    let inside = |amount: f64| stroke_clearance(rig, &displaced(rig, axis, sign * amount)) >= 0.0;
    let amount_at = |part: u32| farthest * f64::from(part) / f64::from(SEARCH_POINTS);
    let Some(beyond) = (1..=SEARCH_POINTS).find(|&part| !inside(amount_at(part))) else { return farthest };
    let (mut within, mut without) = (amount_at(beyond - 1), amount_at(beyond));
    for _ in 0..BISECTION_STEPS {
        let middle = 0.5 * (within + without);
        if inside(middle) { within = middle } else { without = middle }
    }
    within
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reaches of the default rig, compared with an independent computation.
    #[test]
    fn the_default_rig_reaches_as_far_as_it_is_said_to() {
        let range = |axis| single_axis_range(&Rig::default(), axis);
        let assert_near = |axis, unit: f64, min: f64, max: f64, tolerance: f64| {
            let found = range(axis);
            let near = |value: f64, expected: f64| (value * unit - expected).abs() <= tolerance;
            assert!(near(found.min, min) && near(found.max, max), "{axis:?}: {found:?}");
        };
        let degrees = 1f64.to_degrees();
        assert_near(Axis::Surge, 1.0, -0.576, 0.468, 2e-3);
        assert_near(Axis::Sway, 1.0, -0.478, 0.478, 2e-3);
        assert_near(Axis::Heave, 1.0, -0.383, 0.344, 2e-3);
        assert_near(Axis::Roll, degrees, -25.2, 25.2, 0.06);
        assert_near(Axis::Pitch, degrees, -25.5, 24.9, 0.06);
        assert_near(Axis::Yaw, degrees, -34.0, 34.0, 0.06);
    }

    #[test]
    fn the_closed_form_is_the_search() {
        let default = Rig::default();
        let short = Rig { min_length: 1.28, max_length: 1.33, ..default };
        let low = Rig { neutral_height: 0.95, max_length: 1.35, ..default };
        for rig in [default, short, low, Rig { max_length: 3.0, ..default }] {
            for (closed, axis) in horizontal_reach(&rig).into_iter().zip([Axis::Surge, Axis::Sway]) {
                let searched = single_axis_range(&rig, axis).min_reach();
                assert!((closed - searched).abs() < 1e-6, "{axis:?}: {closed} beside {searched}");
            }
        }
    }

    #[test]
    fn short_strokes_have_smaller_margins_and_a_slower_pace() {
        let rig = |stroke: f64| Rig { min_length: 1.0, max_length: 1.0 + stroke, ..Rig::default() };
        let stroke = |stroke: f64| short_stroke_factor(&rig(stroke));
        assert!((stroke(0.1) - 1.0 / 3.0).abs() < 1e-12 && (stroke(0.15) - 0.5).abs() < 1e-12);
        assert_eq!([0.31, 0.6, 1.5].map(stroke), [1.0; 3]);
        assert!((pace_within_stroke(5.0, &rig(0.06)) - 4.0).abs() < 1e-12);
        assert_eq!([0.1001, 0.6].map(|stroke| pace_within_stroke(5.0, &rig(stroke))), [5.0; 2]);
    }

    /// Straight up, a leg whose joints are `d` apart in plan has the length sqrt(d^2 + z^2).
    #[test]
    fn heave_is_what_pythagoras_says() {
        let rig = Rig::default();
        let apart = (rig.platform[0] - rig.base[0]).norm();
        let height = |length: f64| (length * length - apart * apart).sqrt();
        let heave = single_axis_range(&rig, Axis::Heave);
        assert!((heave.max - (height(rig.max_length) - rig.neutral_height)).abs() < 1e-9);
        assert!((heave.min - (height(rig.min_length) - rig.neutral_height)).abs() < 1e-9);
    }
}
