//! The future of a recording as the washout's preview.

use moris_interface::Group;
use moris_washout::Preview;
use moris_washout::interface::PREVIEW_SAMPLES;

use crate::Manoeuvre;

/// The preview of a recording at any of its times.
#[derive(Clone, Debug)]
pub struct Previewer {
    /// Time between the recording's samples \[s\].
    step: f64,
    source: Source,
}

#[derive(Clone, Debug)]
enum Source {
    /// The recording itself.
    Recording {
        /// Specific force along x and y at each sample, averaged as [`Previewer::of`] says
        /// \[m/s2\].
        forces: [Vec<f64>; 2],
        /// Elements of the preview.
        count: usize,
    },
    /// A preview as of each sample.
    Given(Vec<Preview>),
}

/// Time from one element to the next \[s\].
pub const PREVIEW_STEP: f64 = Preview::START.step;
/// The longest preview \[s\].
pub const LONGEST_PREVIEW: f64 = PREVIEW_STEP * PREVIEW_SAMPLES as f64;
/// The length of a preview as written on the command line \[s\].
///
/// # Errors
/// The text is not a number, or the preview is longer than the washout accepts.
pub fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| (0.0..=LONGEST_PREVIEW).contains(seconds));
    seconds.ok_or_else(|| format!("a time from 0 to {LONGEST_PREVIEW} s is needed, such as 1"))
}

/// Tolerance of a count of elements.
const COUNT_ROUNDING: f64 = 1e-9;

impl Previewer {
    /// A preview of so many seconds, at most [`LONGEST_PREVIEW`]; none of no length.
    ///
    /// An element is a weighted mean of the force around its time. The weight is a triangle
    /// that ends at the neighbouring elements. So motion faster than the elements is not
    /// aliased to a slow one.
    pub fn of(manoeuvre: &Manoeuvre, seconds: f64) -> Option<Self> {
        let step = manoeuvre.step();
        let count = ((seconds / PREVIEW_STEP + COUNT_ROUNDING) as usize).min(PREVIEW_SAMPLES);
        let reach = (PREVIEW_STEP / step).round() as usize;
        let force = |axis: usize| manoeuvre.inputs().iter().map(|input| input.specific_force[axis]).collect::<Vec<_>>();
        let forces = [0, 1].map(|axis| triangle_average(&force(axis), reach));
        (seconds > 0.0).then_some(Previewer { step, source: Source::Recording { forces, count } })
    }

    /// Previews as of each sample. Between samples the latest holds.
    pub fn given(previews: Vec<Preview>, step: f64) -> Self {
        Previewer { step, source: Source::Given(previews) }
    }

    /// The preview at a time \[s\]; it ends with the recording.
    pub fn at(&self, time: f64) -> Preview {
        let (forces, count) = match &self.source {
            Source::Recording { forces, count } => (forces, *count),
            Source::Given(previews) => {
                let sample = (time / self.step + COUNT_ROUNDING) as usize;
                return previews.get(sample).copied().unwrap_or_default();
            }
        };
        let last = (forces[0].len() - 1) as f64 * self.step;
        let left = ((last - time) / PREVIEW_STEP + COUNT_ROUNDING).max(0.0) as usize;
        let element = |axis: usize, k: usize| {
            let position = (time + (k + 1) as f64 * PREVIEW_STEP) / self.step;
            forces[axis].get(position.round() as usize).copied().unwrap_or(0.0)
        };
        Preview {
            count: count.min(left) as i32,
            step: PREVIEW_STEP,
            surge: std::array::from_fn(|k| element(0, k)),
            sway: std::array::from_fn(|k| element(1, k)),
        }
    }
}

/// Mean around each value, weighted by a triangle that ends at `reach` values on either side.
fn triangle_average(values: &[f64], reach: usize) -> Vec<f64> {
    let reach = reach.max(1);
    // Two running means over `reach` values in succession have a triangular weight.
    let ahead = running_mean(values, reach);
    let mut backwards = ahead;
    backwards.reverse();
    let mut averaged = running_mean(&backwards, reach);
    averaged.reverse();
    averaged
}

/// Mean of each value and those after it, `reach` values in total; fewer at the end.
fn running_mean(values: &[f64], reach: usize) -> Vec<f64> {
    let mut means = vec![0.0; values.len()];
    let mut sum = 0.0;
    for k in (0..values.len()).rev() {
        sum += values[k];
        if k + reach < values.len() {
            sum -= values[k + reach];
        }
        means[k] = sum / reach.min(values.len() - k) as f64;
    }
    means
}

#[cfg(test)]
mod tests {
    use moris_washout::Input;

    use super::*;

    fn ramp(count: usize) -> Manoeuvre {
        let mut input = Input::default();
        let input = |k: usize| {
            input.specific_force.x = 0.01 * k as f64;
            input.specific_force.y = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            input
        };
        Manoeuvre::new(0.01, (0..count).map(input).collect())
    }

    #[test]
    fn elements_are_the_forces_of_their_times() {
        let previewer = Previewer::of(&ramp(1001), 1.0).unwrap();
        let preview = previewer.at(2.0);
        assert_eq!((preview.count, preview.step), (5, 0.2));
        for k in 0..5 {
            assert!((preview.surge[k] - 2.0 - 0.2 * (k + 1) as f64).abs() < 1e-9, "{}", preview.surge[k]);
            assert!(preview.sway[k].abs() < 0.01, "vibration is averaged out: {}", preview.sway[k]);
        }
        assert_eq!(previewer.at(9.6).count, 2, "the recording ends at 10 s");
        assert_eq!(previewer.at(10.0).count, 0);
        assert_eq!(Previewer::of(&ramp(1001), 9.0).unwrap().at(0.0).count, 20);
    }

    #[test]
    fn given_previews_hold_to_the_next_sample() {
        let previews = (0..100).map(|count| Preview { count, ..Preview::default() }).collect();
        let previewer = Previewer::given(previews, 0.02);
        let counts = [0.0, 0.06, 0.0799, 0.08, 1.98, 5.0].map(|time| previewer.at(time).count);
        assert_eq!(counts, [0, 3, 3, 4, 99, 0]);
    }
}
