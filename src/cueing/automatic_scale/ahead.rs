//! A shadow's regulator where the reference to come is known.
//!
//! Without a preview the regulator expects the reference to fade. With one, its travel and tilt are
//! fed back alike, and the reference ahead is fed forward: the linear-quadratic tracker. F is the
//! closed loop of travel and tilt, P the cost to come, and e the column of the reference. The
//! forward part is the integral of R^-1 B' exp(F' t) P e r(t) over t.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::cueing::strategy::Unsolvable;
use crate::cueing::strategy::predictive::preview::PreviewedCue;
use crate::cueing::strategy::regulator::{AxisModel, Regulator, Weights, dynamics};
use crate::interface::PREVIEW_SAMPLES;
use crate::motion::min_max::{max, min};

/// Points of the reference: now, and the preview's.
const REFERENCE_POINTS: usize = PREVIEW_SAMPLES + 1;
/// Time from one point to the next \[s\].
const POINT_INTERVAL: f64 = 0.2;
/// Steps of the integration from one point to the next.
const STEPS_PER_POINT: usize = 10;
/// Weights of the regulator with a preview. With them the shadows' shape errors are those of the
/// predictive strategy with one, scale by scale.
const REGULATOR_WEIGHTS: Weights = Weights {
    position: 0.05,
    velocity: 0.01,
    tilt_rate: 0.1,
    tilt_acceleration: 3e-3,
    slow_pole: 0.147,
    fast_pole: 2.24,
};

/// Travel, its velocity, tilt and its rate.
type Moved = SVector<f64, 4>;

/// Feedback of travel and tilt, and the weights of the reference's points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tracker {
    feedback: SMatrix<f64, 2, 4>,
    forward: [[f64; 2]; REFERENCE_POINTS],
}

impl Tracker {
    /// The tracker of an axis.
    ///
    /// # Errors
    /// There is no regulator for its limits.
    pub fn new(model: &AxisModel) -> Result<Self, Unsolvable> {
        let Regulator { gains, cost } = Regulator::new(model, &REGULATOR_WEIGHTS)?;
        let (a, b) = dynamics(model, &REGULATOR_WEIGHTS);
        let closed: SMatrix<f64, 4, 4> = (a - b * gains).fixed_view::<4, 4>(0, 0).transpose();
        // R^-1 B' on the costate of travel and tilt.
        let heaviness = REGULATOR_WEIGHTS.tilt_acceleration / (model.acceleration_limit * model.acceleration_limit);
        let to_input = SMatrix::<f64, 2, 4>::from_fn(|i, j| b[(j, i)] / if i == 0 { 1.0 } else { heaviness });
        let mut costate: Moved = cost.fixed_view::<4, 1>(0, 1).into();
        let mut forward = [SVector::<f64, 2>::zeros(); REFERENCE_POINTS];
        let step = POINT_INTERVAL / STEPS_PER_POINT as f64;
        for k in 0..REFERENCE_POINTS - 1 {
            for division in 0..STEPS_PER_POINT {
                // The rule of the midpoint, with the reference linear between the points.
                let middle = to_input * advanced_state(&closed, &costate, 0.5 * step) * step;
                let part = (division as f64 + 0.5) / STEPS_PER_POINT as f64;
                forward[k] += (1.0 - part) * middle;
                forward[k + 1] += part * middle;
                costate = advanced_state(&closed, &costate, step);
            }
        }
        // After the last point the reference fades.
        let fading = SMatrix::<f64, 4, 4>::identity() * REGULATOR_WEIGHTS.slow_pole - closed;
        forward[REFERENCE_POINTS - 1] += to_input * fading.lu().solve(&costate).ok_or(Unsolvable::RiccatiEquation)?;
        Ok(Tracker { feedback: gains.fixed_view::<2, 4>(0, 0).into(), forward: forward.map(Into::into) })
    }

    /// Dropped force and tilt acceleration that the reference ahead asks for at a scale of 1.
    pub fn forward(&self, references: &[f64; REFERENCE_POINTS]) -> [f64; 2] {
        [0, 1].map(|i: usize| -references.iter().zip(&self.forward).map(|(r, weight)| weight[i] * r).sum::<f64>())
    }

    /// The same with the feedback of travel and tilt, at a scale.
    pub fn control(&self, moved: &Moved, forward: [f64; 2], scale: f64) -> [f64; 2] {
        let fed_back = self.feedback * moved;
        [scale * forward[0] - fed_back[0], scale * forward[1] - fed_back[1]]
    }
}

/// exp(A t) x, by the first terms of its series.
fn advanced_state(a: &SMatrix<f64, 4, 4>, x: &Moved, time: f64) -> Moved {
    let mut term = *x;
    (1..=8).fold(*x, |sum, k| {
        term = a * term * (time / f64::from(k));
        sum + term
    })
}

/// The reference of an axis now and ahead, [`POINT_INTERVAL`] apart.
pub fn reference_points(now: f64, course: &PreviewedCue, largest: f64) -> [f64; REFERENCE_POINTS] {
    let PreviewedCue { step, count, values, age, .. } = course;
    let value = |k: usize| if k == 0 { now } else { max(min(values[k - 1], largest), -largest) };
    let end = course.length();
    core::array::from_fn(|point| {
        let time = point as f64 * POINT_INTERVAL;
        // Corner 0 is now, and corner k the k-th value.
        let after = max((age + min(time, end)) / step, 0.0);
        let upper = (libm::floor(after) as usize + 1).min(*count);
        let first = libm::floor(age / step) as usize + 1;
        let (from, from_time) =
            if upper <= first { (now, 0.0) } else { (value(upper - 1), (upper - 1) as f64 * step - age) };
        let to_time = upper as f64 * step - age;
        let part =
            if to_time > from_time { min((min(time, end) - from_time) / (to_time - from_time), 1.0) } else { 1.0 };
        let known = from + part * (value(upper) - from);
        if time > end { known * libm::exp(-REGULATOR_WEIGHTS.slow_pole * (time - end)) } else { known }
    })
}

/// True if a preview is known.
pub fn is_known(courses: &[PreviewedCue; 2]) -> bool {
    courses.iter().all(|course| course.count > 0 && course.length() > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cueing::strategy::regulator::control;
    use crate::cueing::strategy::regulator::tests::MODEL;

    #[test]
    fn a_reference_that_fades_is_fed_forward_as_the_regulator_does() {
        let regulator = Regulator::new(&MODEL, &REGULATOR_WEIGHTS).unwrap();
        let tracker = Tracker::new(&MODEL).unwrap();
        for (column, pole) in [(4, REGULATOR_WEIGHTS.slow_pole), (5, REGULATOR_WEIGHTS.fast_pole)] {
            let fading = core::array::from_fn(|k| (-pole * POINT_INTERVAL * k as f64).exp());
            for (i, found) in tracker.forward(&fading).into_iter().enumerate() {
                let expected = -regulator.gains[(i, column)];
                assert!((found - expected).abs() < 0.03 * expected.abs() + 1e-3, "{column} {i}: {found} {expected}");
            }
        }
        let moved = Moved::new(0.1, -0.2, 0.05, 0.01);
        let state = crate::cueing::strategy::regulator::State::new(0.1, -0.2, 0.05, 0.01, 0.0, 0.0);
        let [expected, found] = [control(&regulator.gains, &state), tracker.control(&moved, [0.0; 2], 0.3)];
        assert!((0..2).all(|i| (expected[i] - found[i]).abs() < 1e-12));
    }

    #[test]
    fn points_lie_on_the_course_and_fade_after_its_end() {
        let mut course = PreviewedCue { step: 0.4, count: 5, ..PreviewedCue::default() };
        course.values[..5].copy_from_slice(&[1.0, 3.0, 3.0, -100.0, 2.0]);
        course.age = 0.1;
        let found = reference_points(0.0, &course, 40.0);
        // The values are at 0.3, 0.7, 1.1, 1.5 and 1.9 s.
        let expected =
            [(0, 0.0), (1, 2.0 / 3.0), (2, 1.5), (3, 2.5), (4, 3.0), (6, 3.0 - 43.0 * 0.25), (9, 2.0 - 42.0 * 0.25)];
        for (k, value) in expected {
            assert!((found[k] - value).abs() < 1e-9, "{k}: {} {value}", found[k]);
        }
        assert!((found[12] - 2.0 * (-0.5 * REGULATOR_WEIGHTS.slow_pole).exp()).abs() < 1e-9);
        assert!(is_known(&[course; 2]) && !is_known(&[course, PreviewedCue::default()]));
        let mut none = PreviewedCue::default();
        none.delay(0.1);
        assert!(!is_known(&[none; 2]));
    }
}
