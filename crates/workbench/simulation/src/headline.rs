//! The verdict of a simulation: one sentence on the most important finding, one on what to change.

use crate::Evaluated;
use crate::findings::{INVERTED, RIGHT_SHAPE, fits_freely, fits_the_rig, is_better_than_rest};
use crate::{Finding, Weight};

/// Jolt and shake from which they are the verdict \[m/s2\].
const JOLTS: f64 = 1.0;
const SHAKES: f64 = 0.1;
/// Remedy where no scale is one.
const READ_WRONGLY: &str = "A unit, a sign or an axis of the felt motion may be wrong; the findings name it.";

impl Evaluated<'_> {
    /// The verdict with what to change.
    pub fn headline(&self) -> Finding {
        let measures = self.measures;
        let inverted = measures.shape.most_inverted().map_or(0.0, |(_, inverted)| inverted);
        let worst = |k: usize| measures.comfort.iter().flatten().map(|comfort| comfort.values()[k]).fold(0.0, f64::max);
        let (weight, text) = if !fits_the_rig(measures) {
            let text = match &self.simulation.foreign {
                Some(_) => "Too much for the rig: the motion exceeds its actuators' limits.".to_owned(),
                None => format!("Too much for the rig: its limits stop the platform. {}", self.smaller_scale()),
            };
            (Weight::Warning, text)
        } else if inverted >= INVERTED {
            let percent = 100.0 * inverted;
            (
                Weight::Warning,
                format!("Felt the wrong way round for {percent:.0} % of the time. {}", self.smaller_scale()),
            )
        } else if worst(1) >= JOLTS || worst(0) >= SHAKES {
            let text = "Right in sign, but not smooth: the platform jolts or shakes the rider. Another strategy or a smaller \
                        scale is smoother.";
            (Weight::Warning, text.to_owned())
        } else if !is_better_than_rest(self) {
            let remedy = if self.is_doubtful() { READ_WRONGLY } else { "The findings name it; scale it down." };
            (Weight::Warning, format!("Right in sign, but a channel is worse than on a platform at rest. {remedy}"))
        } else {
            self.good()
        };
        Finding { weight, text }
    }

    /// True if a unit, a sign or an axis of a foreign motion seems wrong.
    fn is_doubtful(&self) -> bool {
        self.simulation.foreign.as_ref().is_some_and(|foreign| foreign.is_doubtful)
    }

    /// Remedy where the scale is too large for the rig.
    fn smaller_scale(&self) -> String {
        match self.advice.and_then(|advice| advice.scaled) {
            _ if self.is_doubtful() => READ_WRONGLY.to_owned(),
            _ if self.simulation.foreign.is_some() => "A smaller scale of force and rates helps.".to_owned(),
            Some(found) => format!("Scale force and rates by {:.2}.", found.factor),
            None => "A smaller scale of force and rates, a better strategy or a faster tilt helps; moris fit finds the scale."
                .to_owned(),
        }
    }

    /// The verdict where nothing is wrong.
    fn good(&self) -> (Weight, String) {
        let shape = &self.measures.shape;
        let soft = if fits_freely(self.measures) { "" } else { " Soft limits take a part of the cues." };
        match (shape.least_shape(), shape.size()) {
            (Some(least), Some(size)) if least >= RIGHT_SHAPE => {
                (Weight::Good, format!("Felt the right way round, at {:.0} % of the size.{soft}", 100.0 * size))
            }
            (Some(_), Some(size)) => (
                Weight::Note,
                format!(
                    "Felt the right way round in part, at {:.0} % of the size.{soft}{}",
                    100.0 * size,
                    match &self.simulation.foreign {
                        Some(_) => "",
                        None => " moris fit finds a scale with a better shape.",
                    }
                ),
            ),
            _ => (Weight::Note, format!("Surge and sway are hardly asked for: there is little to judge.{soft}")),
        }
    }
}
