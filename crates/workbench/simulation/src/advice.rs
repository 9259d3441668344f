//! Advice for the findings: another scale, with and without a preview.

use crate::Manoeuvre;
use crate::measures::shape::Shape;
use moris_washout::interface::{AutomaticScale, StrategyKind};
use moris_washout::{ParameterError, Parameters};

use crate::findings::INVERTED;
use crate::fit::{Aims, Candidate, Search};

/// A scale, and the inverted time with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alternative {
    /// Factor on the force of surge and sway and on the rates.
    pub factor: f64,
    /// Largest fraction of inverted time of surge and sway.
    pub inverted: f64,
}

impl From<Candidate> for Alternative {
    fn from(Candidate { factors, shape }: Candidate) -> Self {
        let inverted = shape.most_inverted().map_or(0.0, |(_, inverted)| inverted);
        Alternative { factor: factors.scale, inverted }
    }
}

/// Other scales at which the cues have the right sign and proportion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advice {
    /// Length of the part that was searched, where it is not the whole manoeuvre \[s\].
    pub part: Option<f64>,
    /// With the same strategy and limits.
    pub scaled: Option<Alternative>,
    /// Alternative with a preview, and the preview's length \[s\].
    pub previewed: Option<(f64, Alternative)>,
}

/// Preview that is tried \[s\].
const PREVIEW: f64 = 1.0;
/// Longest part of a manoeuvre that is searched \[s\]: each scale is a simulation.
const LONGEST: f64 = 120.0;

/// The part of a manoeuvre with the largest surge and sway, if it is longer than [`LONGEST`].
fn hardest(manoeuvre: &Manoeuvre) -> Option<Manoeuvre> {
    let count = (LONGEST / manoeuvre.step()) as usize + 1;
    let inputs = manoeuvre.inputs();
    let (mut sum, mut sums) = (0.0, vec![0.0]);
    for input in inputs {
        sum += input.specific_force.xy().norm_squared();
        sums.push(sum);
    }
    let of = |start: usize| sums[start + count] - sums[start];
    let last = inputs.len().checked_sub(count).filter(|last| *last > 0)?;
    let start = (0..=last).max_by(|one, other| of(*one).total_cmp(&of(*other)))?;
    Some(Manoeuvre::new(manoeuvre.step(), inputs[start..start + count].to_vec()))
}

impl Advice {
    /// Searches for a scale at which a manoeuvre is felt the right way round, if it is not at its
    /// own; the predictive strategy also with a preview. Of a long manoeuvre the part with the
    /// largest forces is searched. None where the scale is automatic, and for the classical
    /// strategy, which no scale alone sets right.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn of(
        manoeuvre: &Manoeuvre,
        parameters: &Parameters,
        preview: f64,
        shape: &Shape,
    ) -> Result<Option<Self>, ParameterError> {
        let is_right = shape.most_inverted().is_none_or(|(_, inverted)| inverted < INVERTED);
        let strategy = parameters.structure.strategy;
        let is_automatic = parameters.automatic_scale.automatic == AutomaticScale::On;
        if is_right || is_automatic || strategy == StrategyKind::Classical {
            return Ok(None);
        }
        let part = hardest(manoeuvre);
        let searched = part.as_ref().unwrap_or(manoeuvre);
        let found = |preview: f64| -> Result<Option<Alternative>, ParameterError> {
            let found = Search::new(searched, preview, Aims::default()).scale(parameters)?;
            // The quick simulation of the search may find the scale itself just right.
            Ok(found.map(Alternative::from).filter(|found| found.factor < 1.0))
        };
        let previews = strategy == StrategyKind::Predictive && preview < PREVIEW;
        let previewed = if previews { found(PREVIEW)?.map(|found| (PREVIEW, found)) } else { None };
        Ok(Some(Advice { part: part.as_ref().map(Manoeuvre::duration), scaled: found(preview)?, previewed }))
    }

    /// Clauses of a sentence on inverted time.
    pub(crate) fn clauses(&self) -> String {
        let scaled = self
            .scaled
            .map(|Alternative { factor, inverted }| format!("; at a scale of {factor:.2}: {:.0} %", 100.0 * inverted));
        let previewed = self.previewed.map(|(seconds, Alternative { factor, inverted })| {
            format!("; with a preview of {seconds} s at {factor:.2}: {:.0} %", 100.0 * inverted)
        });
        let clauses: String = [scaled, previewed].into_iter().flatten().collect();
        match self.part.filter(|_| !clauses.is_empty()) {
            Some(part) => format!("; the hardest {part:.0} s alone{}", clauses.replacen(';', ":", 1)),
            None => clauses,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use crate::measures::shape::{AxisShape, Shape};
    use moris_washout::{Input, presets};

    use super::*;

    /// 30 s of a slalom of this force \[m/s2\].
    fn slalom(force: f64) -> Manoeuvre {
        let input = |k: usize| {
            let time = k as f64 * 0.01;
            let mut input = Input::default();
            input.specific_force.y = force * (time / 2.0).min(1.0) * (TAU * 0.25 * time).sin();
            input
        };
        Manoeuvre::new(0.01, (0..3000).map(input).collect())
    }

    /// A shape with this inverted time in sway.
    fn inverted(inverted: f64) -> Shape {
        let axis = AxisShape { shape: 0.4, size: 0.7, inverted };
        Shape { axes: [None, Some(axis)], inverted: Some(inverted), error: Some(0.8) }
    }

    #[test]
    fn a_hard_ride_gets_a_scale_and_a_larger_one_with_a_preview() {
        let parameters = presets::parameters(presets::PREDICTIVE);
        let advice = Advice::of(&slalom(4.5), &parameters, 0.0, &inverted(0.1)).unwrap().unwrap();
        let scaled = advice.scaled.unwrap();
        let (seconds, previewed) = advice.previewed.unwrap();
        assert!(seconds == 1.0 && scaled.factor < previewed.factor, "{scaled:?}, {previewed:?}");
        assert!(scaled.inverted <= 0.02 && previewed.inverted <= 0.02);
        let clauses = advice.clauses();
        assert!(
            clauses.starts_with("; at a scale of 0.") && clauses.contains("; with a preview of 1 s at 0."),
            "{clauses}"
        );
    }

    #[test]
    fn of_a_long_ride_the_hardest_part_is_searched() {
        let quiet = slalom(0.5).inputs().to_vec();
        let hard = slalom(4.5).inputs().to_vec();
        let of = |parts: &[&[Input]]| Manoeuvre::new(0.01, parts.concat());
        let long = of(&[&quiet, &quiet, &quiet, &hard, &hard, &hard, &hard, &quiet]);
        let part = hardest(&long).unwrap();
        assert_eq!(part.inputs()[..], long.inputs()[8999..21_000]);
        assert!(hardest(&of(&[&hard, &hard, &hard, &hard])).is_none());
        let parameters = presets::parameters(presets::PREDICTIVE);
        let advice = Advice::of(&long, &parameters, 0.0, &inverted(0.1)).unwrap().unwrap();
        let whole = Advice::of(&part, &parameters, 0.0, &inverted(0.1)).unwrap().unwrap();
        assert_eq!((advice.scaled, advice.previewed), (whole.scaled, whole.previewed));
        assert!(whole.part.is_none() && advice.scaled.is_some());
        let clauses = advice.clauses();
        assert!(clauses.starts_with("; the hardest 120 s alone: at a scale of 0."), "{clauses}");
    }

    #[test]
    fn who_needs_none_gets_none() {
        let predictive = presets::parameters(presets::PREDICTIVE);
        let automatic = presets::with(presets::PREDICTIVE, &[("scale.automatic", 2.0)]);
        let of = |parameters, shape| Advice::of(&slalom(0.3), parameters, 0.0, &shape).unwrap();
        assert_eq!(of(&predictive, inverted(0.01)), None);
        assert_eq!(of(&automatic, inverted(0.1)), None);
        assert_eq!(of(&presets::parameters(presets::PAPER), inverted(0.1)), None);
    }
}
