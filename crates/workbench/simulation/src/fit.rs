//! The largest scale at which the cues have the right sign and proportion.
//!
//! One factor scales the specific force of surge and sway and all rates. A further one lowers the
//! break frequencies of surge and sway of the classical strategy, whose own phase a smaller scale
//! does not change. Heave has a factor of its own. The search simulates with longer internal steps
//! than the set, as the cues are below 2 Hz, and confirms its result with the set's own.

use crate::measures::shape::{Desired, Shape, below_cue_frequency};
use crate::{Manoeuvre, Replay};
use moris_washout::interface::{STANDARD_GRAVITY, StrategyKind};
use moris_washout::{ParameterError, Parameters, Washout};

use crate::preview::Previewer;

/// Factor on a scale that misses the aims by the set's own internal step, and
/// how often it is tried.
pub const SCALE_REDUCTION: f64 = 0.94;
pub const MAX_REDUCTIONS: usize = 6;

/// Bounds of the errors that a scale has to keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aims {
    /// Largest shape error of surge and sway together.
    pub error: f64,
    /// Largest fraction of inverted time of an axis.
    pub inverted: f64,
    /// Least correlation of an axis.
    pub shape: f64,
}

impl Default for Aims {
    fn default() -> Self {
        Aims { error: 0.5, inverted: 0.02, shape: -1.0 }
    }
}

impl Aims {
    /// Distance from the aims; at most 1 where all are reached.
    pub fn distance(&self, shape: &Shape) -> f64 {
        let inverted = shape.most_inverted_axis().map_or(0.0, |(_, inverted)| inverted);
        let least = shape.least_shape().unwrap_or(1.0);
        let shape_distance = (1.0 - least) / (1.0 - self.shape).max(f64::EPSILON);
        (shape.error.unwrap_or(0.0) / self.error).max(inverted / self.inverted).max(shape_distance)
    }

    /// The best of one candidate a strategy: of those that reach the aims by shape, then by size;
    /// where none does, the nearest to them.
    pub fn best(&self, candidates: &[Candidate]) -> Option<usize> {
        let distance = |k: &usize| self.distance(&candidates[*k].shape);
        let reaching: Vec<usize> = (0..candidates.len()).filter(|k| distance(k) <= 1.0).collect();
        if reaching.is_empty() {
            return (0..candidates.len()).min_by(|one, other| distance(one).total_cmp(&distance(other)));
        }
        let quality = |&k: &usize| {
            let shape = &candidates[k].shape;
            [shape.least_shape().unwrap_or(1.0), shape.size().unwrap_or(1.0)]
        };
        best_of(&reaching.iter().map(quality).collect::<Vec<_>>()).map(|best| reaching[best])
    }

    /// True if a candidate is felt larger among those that reach the aims, or is nearer to them.
    fn prefer(&self, one: &Candidate, other: &Candidate) -> bool {
        let distance = [one, other].map(|candidate| self.distance(&candidate.shape));
        match distance.map(|distance| distance <= 1.0) {
            [true, true] => one.shape.size() > other.shape.size(),
            [false, false] => distance[0] < distance[1],
            [fits, _] => fits,
        }
    }
}

/// The best of pairs of shape and size: of those with the best shape, but for
/// 0.02, the largest.
pub fn best_of(qualities: &[[f64; 2]]) -> Option<usize> {
    // Differences of shape up to this do not decide: the size does.
    const SAME_SHAPE: f64 = 0.02;
    let shape = qualities.iter().map(|[shape, _]| *shape).reduce(f64::max)?;
    let like_it = (0..qualities.len()).filter(|&k| qualities[k][0] >= shape - SAME_SHAPE);
    like_it.reduce(|best, next| if qualities[next][1] > qualities[best][1] { next } else { best })
}

/// Factors on the parameters of a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors {
    /// On the specific force of surge and sway and on all rates.
    pub scale: f64,
    /// On the break frequencies of surge and sway.
    pub breaks: f64,
    /// On the specific force of heave.
    pub heave: f64,
}

impl Factors {
    /// A scale alone.
    pub fn scale(scale: f64) -> Self {
        Factors { scale, breaks: 1.0, heave: 1.0 }
    }

    /// The parameters with these factors. An automatic scale begins with them.
    pub fn applied(&self, parameters: &Parameters) -> Parameters {
        let mut scaled = *parameters;
        let conditioning = &mut scaled.conditioning;
        for axis in 0..2 {
            conditioning.force_scale[axis] *= self.scale;
            scaled.splitter.omega1[axis] *= self.breaks;
            scaled.splitter.omega2[axis] *= self.breaks;
            scaled.splitter.low_pass_omega[axis] *= self.breaks;
        }
        conditioning.force_scale[2] *= self.heave;
        conditioning.rate_scale *= self.scale;
        scaled.automatic_scale.start = 1.0;
        scaled
    }
}

/// Factors, and the shape with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The factors.
    pub factors: Factors,
    /// The shape of the felt force.
    pub shape: Shape,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The largest scale that reaches the aims, or the nearest to them; with the set's internal
    /// step.
    pub best: Candidate,
    /// True if it reaches them.
    pub fits: bool,
    /// Every candidate of its break frequencies, the largest scale first.
    pub curve: Vec<Candidate>,
}

/// A recording to search on.
#[derive(Clone, Debug)]
pub struct Search<'a> {
    manoeuvre: &'a Manoeuvre,
    desired: Desired,
    heave: Option<Vec<f64>>,
    previewer: Option<Previewer>,
    /// Aims of the search for a scale.
    pub aims: Aims,
}

impl<'a> Search<'a> {
    /// A search on a recording of which so many seconds ahead are known; 0: none.
    pub fn new(manoeuvre: &'a Manoeuvre, preview: f64, aims: Aims) -> Self {
        let force: Vec<[f64; 3]> = manoeuvre.inputs().iter().map(|input| input.specific_force.into()).collect();
        let heave: Vec<f64> = force.iter().map(|force| force[2] - STANDARD_GRAVITY).collect();
        Search {
            manoeuvre,
            desired: Desired::new(&force, manoeuvre.step()),
            heave: below_cue_frequency(&heave, manoeuvre.step()),
            previewer: Previewer::of(manoeuvre, preview),
            aims,
        }
    }

    /// The best factors for a set of parameters.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn fit(&self, parameters: &Parameters) -> Result<Fit, ParameterError> {
        // Factors on the break frequencies of the classical strategy.
        const BREAK_FACTORS: [f64; 7] = [1.0, 4.0, 2.5, 1.6, 0.6, 0.35, 0.15];
        let is_classical = parameters.structure.strategy == StrategyKind::Classical;
        let breaks: &[f64] = if is_classical { &BREAK_FACTORS } else { &BREAK_FACTORS[..1] };
        let curves = breaks.iter().map(|&breaks| self.curve(parameters, breaks)).collect::<Result<Vec<_>, _>>()?;
        let best_of = |curve: &Vec<Candidate>| self.best(curve);
        let best = curves
            .iter()
            .filter_map(best_of)
            .reduce(|best, next| if self.aims.prefer(&next, &best) { next } else { best });
        let mut best = best.unwrap_or(Candidate { factors: Factors::scale(1.0), shape: Shape::default() });
        let curve = curves.into_iter().find(|curve| curve.contains(&best)).unwrap_or_default();
        best.factors.heave = self.heave(parameters, best.factors)?;
        let reaches = |candidate: &Candidate| self.aims.distance(&candidate.shape) <= 1.0;
        let searched = reaches(&best);
        best = self.exact(parameters, best.factors)?;
        let mut trial = best;
        for _ in 0..MAX_REDUCTIONS {
            if !searched || reaches(&trial) {
                break;
            }
            trial =
                self.exact(parameters, Factors { scale: SCALE_REDUCTION * trial.factors.scale, ..trial.factors })?;
        }
        if reaches(&trial) {
            best = trial;
        }
        Ok(Fit { fits: reaches(&best), best, curve })
    }

    /// The largest scale that reaches the aims with these break frequencies, by the quick
    /// simulation of the search, and true; the nearest to them where none does, and false.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn scale(&self, parameters: &Parameters) -> Result<(Candidate, bool), ParameterError> {
        let curve = self.curve(parameters, 1.0)?;
        let distance = |candidate: &Candidate| self.aims.distance(&candidate.shape);
        let reaching = curve.iter().find(|candidate| distance(candidate) <= 1.0);
        let nearest = || curve.iter().min_by(|one, other| distance(one).total_cmp(&distance(other)));
        let none = Candidate { factors: Factors::scale(1.0), shape: Shape::default() };
        Ok((reaching.or_else(nearest).copied().unwrap_or(none), reaching.is_some()))
    }

    /// The shape with a factor on the scale, by the quick simulation of the search.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn candidate(&self, parameters: &Parameters, factors: Factors) -> Result<Candidate, ParameterError> {
        Ok(Candidate { factors, shape: self.shape(&quick_parameters(&factors.applied(parameters)))? })
    }

    /// The same with the internal step of the parameters.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn exact(&self, parameters: &Parameters, factors: Factors) -> Result<Candidate, ParameterError> {
        Ok(Candidate { factors, shape: self.shape(&factors.applied(parameters))? })
    }

    /// Candidates from the largest scale to the first that reaches the aims, with bisections
    /// between it and the one before; all of the grid where none reaches them.
    fn curve(&self, parameters: &Parameters, breaks: f64) -> Result<Vec<Candidate>, ParameterError> {
        // Factors that are tried first, the largest first.
        const FIRST_FACTORS: [f64; 13] = [1.0, 0.8, 0.65, 0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03];
        // Bisections between two of them.
        const BISECTION_COUNT: usize = 3;
        let at = |scale: f64| self.candidate(parameters, Factors { scale, breaks, heave: 1.0 });
        let mut curve = Vec::new();
        let mut above = None;
        for scale in FIRST_FACTORS {
            let candidate = at(scale)?;
            curve.push(candidate);
            if self.aims.distance(&candidate.shape) > 1.0 {
                above = Some(scale);
                continue;
            }
            let (mut fits, mut fails) = (scale, above.unwrap_or(scale));
            for _ in 0..BISECTION_COUNT {
                if fails - fits < 0.02 * fits {
                    break;
                }
                let middle = (fits * fails).sqrt();
                let candidate = at(middle)?;
                curve.push(candidate);
                if self.aims.distance(&candidate.shape) <= 1.0 { fits = middle } else { fails = middle }
            }
            break;
        }
        curve.sort_by(|a, b| b.factors.scale.total_cmp(&a.factors.scale));
        Ok(curve)
    }

    fn best(&self, curve: &[Candidate]) -> Option<Candidate> {
        curve.iter().copied().reduce(|best, next| if self.aims.prefer(&next, &best) { next } else { best })
    }

    /// The largest factor on heave with at most the aims' error; 1 where none has.
    fn heave(&self, parameters: &Parameters, factors: Factors) -> Result<f64, ParameterError> {
        // Factors on heave, the largest first.
        const HEAVE_FACTORS: [f64; 6] = [1.0, 0.7, 0.5, 0.35, 0.25, 0.15];
        let Some(desired) = &self.heave else { return Ok(1.0) };
        let mean_square = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>();
        let asked = mean_square(&mut desired.iter().copied());
        if asked.sqrt() <= crate::measures::shape::MIN_DESIRED_RMS * (desired.len() as f64).sqrt() {
            return Ok(1.0);
        }
        for heave in HEAVE_FACTORS {
            let scaled = Factors { heave, ..factors }.applied(parameters);
            let scale = scaled.conditioning.force_scale[2];
            let felt: Vec<f64> =
                self.felt(&quick_parameters(&scaled))?.iter().map(|force| force[2] - STANDARD_GRAVITY).collect();
            let Some(felt) = below_cue_frequency(&felt, self.manoeuvre.step()) else { return Ok(1.0) };
            let error = mean_square(&mut desired.iter().zip(&felt).map(|(desired, felt)| felt - scale * desired));
            if error <= (self.aims.error * scale).powi(2) * asked {
                return Ok(heave);
            }
        }
        Ok(1.0)
    }

    fn shape(&self, parameters: &Parameters) -> Result<Shape, ParameterError> {
        let scale = &parameters.conditioning.force_scale;
        Ok(self.desired.shape(&self.felt(parameters)?, [scale[0], scale[1]]))
    }

    /// The felt specific force at the samples.
    fn felt(&self, parameters: &Parameters) -> Result<Vec<[f64; 3]>, ParameterError> {
        let inputs = self.manoeuvre.inputs();
        let mut washout = Washout::new(parameters)?.starting_with(&inputs[0]);
        let mut felt = vec![washout.output().felt_specific_force.into()];
        let preview = |washout: &mut Washout, time: f64| {
            if let Some(previewer) = &self.previewer {
                washout.preview(&previewer.at(time));
            }
        };
        let observe = |_: &_, output: &moris_washout::Output| felt.push(output.felt_specific_force.into());
        Replay::new(self.manoeuvre).run_part(0..usize::MAX, &mut washout, preview, |_| (), observe);
        Ok(felt)
    }
}

/// The parameters with the internal step of the search.
fn quick_parameters(parameters: &Parameters) -> Parameters {
    // Internal step of the search with the predictive strategy, whose plan has longer steps; with
    // the adaptive one, whose gains follow at every step; with the others [s].
    const SEARCH_STEPS: [f64; 3] = [0.01, 0.002, 0.005];
    let mut quick = *parameters;
    let step = &mut quick.structure.max_step;
    *step = step.max(match parameters.structure.strategy {
        StrategyKind::Predictive => SEARCH_STEPS[0],
        StrategyKind::Adaptive => SEARCH_STEPS[1],
        _ => SEARCH_STEPS[2],
    });
    quick
}

#[cfg(test)]
mod tests {
    use moris_washout::{Input, presets};

    use super::*;

    /// A slalom of so many m/s2 to the side.
    fn slalom(amplitude: f64, frequency: f64) -> Manoeuvre {
        Manoeuvre::sampled(0.01, 30.0, |t| {
            let mut input = Input::default();
            let fade = (t / 3.0).min(1.0);
            input.specific_force.y = fade * amplitude * (std::f64::consts::TAU * frequency * t).sin();
            input
        })
    }

    #[test]
    fn what_fits_keeps_its_scale_and_what_does_not_gets_the_largest_that_does() {
        let predictive = Parameters::default();
        let gentle = slalom(0.3, 0.1);
        let fit = Search::new(&gentle, 0.0, Aims::default()).fit(&predictive).unwrap();
        assert!(fit.fits && fit.best.factors.scale == 1.0, "{fit:?}");
        let hard = slalom(6.0, 0.2);
        let search = Search::new(&hard, 0.0, Aims::default());
        let fit = search.fit(&predictive).unwrap();
        assert!(fit.fits && fit.best.factors.scale < 0.9, "{fit:?}");
        // A little more does not fit.
        let more = Factors::scale(1.2 * fit.best.factors.scale);
        assert!(Aims::default().distance(&search.candidate(&predictive, more).unwrap().shape) > 1.0);
    }

    #[test]
    fn the_classical_strategy_gets_lower_break_frequencies_where_they_give_more() {
        let hard = slalom(3.0, 0.25);
        let search = Search::new(&hard, 0.0, Aims::default());
        let quick = presets::with(presets::CLASSICAL, &[("splitter.y.omega1", 1.6), ("splitter.y.omega2", 0.6)]);
        let fit = search.fit(&quick).unwrap();
        assert!(fit.fits && fit.best.factors.breaks < 1.0, "{fit:?}");
        let found = fit.best.factors.applied(&quick);
        let omega = quick.splitter.omega1;
        assert!((found.splitter.omega1.y - fit.best.factors.breaks * omega.y).abs() < 1e-12);
        assert_eq!(found.splitter.omega1.z, omega.z);
    }
}
