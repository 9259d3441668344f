//! Advice for the verdict: alternatives to the parameters, each simulated on the whole recording
//! before it is named.

use std::array::from_fn;

use moris_washout::interface::{AutomaticScale, StrategyKind};
use moris_washout::platform::reach::Axis;
use moris_washout::{ParameterError, Parameters};

use crate::findings::RIGHT_SHAPE;
use crate::fit::{Aims, Factors, Search, best_of};
use crate::preview::Previewer;
use crate::verdict::Fault;
use crate::{Evaluated, Manoeuvre, Replay, Simulation, capitalised, measures};

/// Rates of tilt that are tried: one that riders may notice, and one that is hardly perceived
/// \[rad/s\].
pub const FASTER_TILT: f64 = 6.0_f64.to_radians();
const SLOWER_TILT: f64 = 2.0_f64.to_radians();
/// The soft limits' pace \[rad/s\].
const SOFT_PACE: f64 = 5.0;
/// Longest part of a manoeuvre that the search for a scale goes through \[s\]: each scale is a
/// simulation. What it finds is simulated on the whole.
const MAX_SEARCHED: f64 = 120.0;

/// Changes to a set of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Changes {
    /// Another strategy.
    pub strategy: Option<StrategyKind>,
    /// The automatic scale, where it is off.
    pub automatic: bool,
    /// Another preview \[s\].
    pub preview: Option<f64>,
    /// Another limit of the tilt's rate \[rad/s\].
    pub tilt_rate: Option<f64>,
    /// Soft limits, where they are off.
    pub soft_limits: bool,
    /// A low-pass on the inputs, where there is none \[rad/s\].
    pub cutoff: Option<f64>,
    /// Factors on surge, sway and rates, on the rates alone, and on heave.
    pub factors: [f64; 3],
}

/// What of [`Changes::factors`] is searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Searched {
    Nothing,
    Scale,
    Rates,
    Heave,
}

impl Changes {
    const NONE: Changes = Changes {
        strategy: None,
        automatic: false,
        preview: None,
        tilt_rate: None,
        soft_limits: false,
        cutoff: None,
        factors: [1.0; 3],
    };

    /// The parameters with these changes.
    pub fn applied(&self, parameters: &Parameters) -> Parameters {
        let [scale, rates, heave] = self.factors;
        let mut changed = Factors { scale, breaks: 1.0, heave }.applied(parameters);
        changed.conditioning.rate_scale *= rates;
        if let Some(strategy) = self.strategy {
            changed.structure.strategy = strategy;
        }
        if self.automatic {
            changed.automatic_scale.automatic = AutomaticScale::On;
        }
        if let Some(rate) = self.tilt_rate {
            changed.tilt.rate_limit = rate;
        }
        if self.soft_limits {
            changed.soft_limit.pace = SOFT_PACE;
        }
        if let Some(cutoff) = self.cutoff {
            changed.conditioning.cutoff = cutoff;
        }
        changed
    }

    /// True where the changes are a scale alone.
    fn is_scale(&self) -> bool {
        let [_, rates, heave] = self.factors;
        Changes { factors: [1.0; 3], ..*self } == Changes::NONE && [rates, heave] == [1.0; 2]
    }

    /// True for what is the user's to decide: a preview needs a vehicle that knows its road, and
    /// riders may notice a faster tilt.
    fn is_conditional(&self) -> bool {
        self.preview.is_some() || self.tilt_rate.is_some_and(|rate| rate > SLOWER_TILT)
    }

    /// The changes as an imperative in lower case.
    pub fn text(&self) -> String {
        let [scale, rates, heave] = self.factors;
        let scaled = |what: &str, factor: f64| (factor < 1.0).then(|| format!("scale {what} by {factor:.2}"));
        let parts = [
            self.strategy.map(|strategy| format!("set strategy = {}", strategy.name())),
            self.automatic.then(|| "set scale.automatic = on".to_owned()),
            self.preview.map(|seconds| format!("give a preview of {seconds} s (vehicle.preview.*)")),
            self.tilt_rate.map(|rate| {
                let notice = if rate > SLOWER_TILT { ", which riders may notice" } else { "" };
                format!("set tilt.rateLimit = {rate:.4} rad/s ({:.0} °/s{notice})", rate.to_degrees())
            }),
            self.soft_limits.then(|| format!("set softLimit.pace = {SOFT_PACE}")),
            self.cutoff.map(|cutoff| format!("set input.cutoff = {cutoff} rad/s")),
            scaled("force and rates", scale),
            scaled("the rates", rates),
            scaled("heave", heave),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(" and ")
    }
}

/// An alternative, simulated on the whole recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// The difference.
    pub changes: Changes,
    /// All parameters.
    pub parameters: Parameters,
    /// Preview of the alternative \[s\].
    pub preview: f64,
    /// The severity of each fault.
    severities: Vec<(Fault, f64)>,
    /// The figure of the fault that the advice is about, and the size, as clauses.
    result: String,
    size: Option<f64>,
    shape: Option<f64>,
}

impl Alternative {
    fn severity(&self, fault: Fault) -> f64 {
        fault_severity(&self.severities, fault)
    }

    /// The smaller the better: 0 without any fault, 1 without this one, above that by its severity.
    fn rank(&self, fault: Fault) -> f64 {
        if self.severities.iter().all(|(_, severity)| *severity < 1.0) {
            return 0.0;
        }
        // A fault begins at a severity of 1.
        let severity = self.severity(fault);
        if severity < 1.0 { 1.0 } else { 1.0 + severity }
    }

    /// The changes with the figures that were simulated.
    pub fn text(&self) -> String {
        format!("{}: {}", self.changes.text(), self.result)
    }
}

/// Alternatives that are better, the best first.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    fault: Fault,
    found: Vec<Alternative>,
}

impl Advice {
    /// The advice out of what [`Advisor::best`] found.
    pub fn new(fault: Fault, mut found: Vec<Alternative>) -> Self {
        let mut ranked = Vec::new();
        while let Some(best) = Self::best(fault, &found) {
            ranked.push(found.remove(best));
        }
        Advice { fault, found: ranked }
    }

    /// Alternatives without any fault first, then those without this one, each by shape, then by
    /// size; then those with less of it.
    fn best(fault: Fault, found: &[Alternative]) -> Option<usize> {
        let rank = |k: usize| found[k].rank(fault);
        let least = (0..found.len()).map(rank).reduce(f64::min)?;
        let alike: Vec<usize> = (0..found.len()).filter(|&k| rank(k) == least).collect();
        let quality = |&k: &usize| [found[k].shape.unwrap_or(1.0), found[k].size.unwrap_or(1.0)];
        best_of(&alike.iter().map(quality).collect::<Vec<_>>()).map(|best| alike[best])
    }

    /// The alternative to take: the best that needs nothing but parameters.
    pub fn recommended(&self) -> Option<&Alternative> {
        self.found.iter().find(|one| !one.changes.is_conditional())
    }

    /// Of the others the one with the largest size, where that is larger than with the
    /// recommended one, and nothing more is wrong.
    pub fn conditional(&self) -> Option<&Alternative> {
        let recommended = self.recommended();
        let is_as_good = |one: &&Alternative| {
            recommended.is_none_or(|other| one.size > other.size && one.rank(self.fault) <= other.rank(self.fault))
        };
        let conditional = self.found.iter().filter(|one| one.changes.is_conditional()).filter(is_as_good);
        conditional.reduce(|best, next| if next.size > best.size { next } else { best })
    }

    /// The factor on force and rates that is better with nothing else changed.
    pub fn scale(&self) -> Option<f64> {
        self.found.iter().find(|one| one.changes.is_scale()).map(|one| one.changes.factors[0])
    }

    /// What to change, as a sentence; none where nothing is better.
    pub(crate) fn sentence(&self) -> Option<String> {
        let named: Vec<String> =
            [self.recommended(), self.conditional()].into_iter().flatten().map(Alternative::text).collect();
        (!named.is_empty()).then(|| format!("{}.", capitalised(&named.join("; or "))))
    }

    /// All alternatives in a sentence; none without any that the verdict has not.
    pub(crate) fn alternatives(&self) -> Option<String> {
        let all: Vec<String> = self.found.iter().map(Alternative::text).collect();
        (all.len() > 1).then(|| format!("Simulated and better: {}.", all.join("; ")))
    }
}

fn fault_severity(severities: &[(Fault, f64)], fault: Fault) -> f64 {
    severities.iter().find(|(other, _)| *other == fault).map_or(0.0, |(_, severity)| *severity)
}

/// Looks for alternatives to the parameters of a simulation.
#[derive(Clone, Debug)]
pub struct Advisor<'a> {
    /// The fault that an alternative has less of.
    pub fault: Fault,
    manoeuvre: &'a Manoeuvre,
    /// The part with the largest forces, where not the whole manoeuvre is searched.
    part: Option<Manoeuvre>,
    parameters: Parameters,
    preview: f64,
    before: Vec<(Fault, f64)>,
    /// True where shaking is what is rough, and no jolt.
    shakes: bool,
}

/// Changes to begin with, and what is searched for on top of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate(Changes, Searched);

impl<'a> Advisor<'a> {
    /// For a simulation of a manoeuvre with a preview of so many seconds; none where nothing is
    /// wrong, and for another washout's motion.
    pub fn of(evaluated: &Evaluated, manoeuvre: &'a Manoeuvre, preview: f64) -> Option<Self> {
        let before = evaluated.severities();
        let fault = evaluated.fault().filter(|_| evaluated.simulation.foreign.is_none())?;
        let (parameters, part) = (evaluated.simulation.parameters, hardest_part(manoeuvre));
        Some(Advisor { fault, manoeuvre, part, parameters, preview, before, shakes: evaluated.shakes() })
    }

    /// The changes that are tried, simplest first.
    pub fn candidates(&self) -> Vec<Candidate> {
        // Low-pass on the inputs that is tried against jolts [rad/s].
        const SMOOTH_CUTOFF: f64 = 12.0;
        // Preview that is tried [s].
        const TRIED_PREVIEW: f64 = 1.0;
        let Parameters { structure, tilt, conditioning, soft_limit, automatic_scale, .. } = &self.parameters;
        let is_predictive = structure.strategy == StrategyKind::Predictive;
        let none = Changes::NONE;
        let tilts = |rate: f64| Changes { tilt_rate: Some(rate), ..none };
        let mut candidates = vec![Candidate(none, Searched::Scale)];
        let mut add = |is_possible: bool, changes: Changes, searched: Searched| {
            candidates.extend(is_possible.then_some(Candidate(changes, searched)));
        };
        if let Fault::WorseThanRest(axis @ (Axis::Heave | Axis::Roll | Axis::Pitch | Axis::Yaw)) = self.fault {
            let part = if axis == Axis::Heave { Searched::Heave } else { Searched::Rates };
            add(true, none, part);
            add(tilt.rate_limit > SLOWER_TILT, tilts(SLOWER_TILT), Searched::Nothing);
            return candidates;
        }
        let predictive = Changes { strategy: Some(StrategyKind::Predictive), ..none };
        add(!is_predictive, predictive, Searched::Scale);
        let is_fixed = automatic_scale.automatic == AutomaticScale::Off;
        add(is_fixed, Changes { automatic: true, ..none }, Searched::Nothing);
        let previewed = Changes { preview: Some(TRIED_PREVIEW), ..none };
        add(is_predictive && self.preview < TRIED_PREVIEW, previewed, Searched::Scale);
        if self.fault == Fault::Rough {
            add(soft_limit.pace == 0.0, Changes { soft_limits: true, ..none }, Searched::Nothing);
            let smooth = Changes { cutoff: Some(SMOOTH_CUTOFF), ..none };
            add(conditioning.cutoff == 0.0, smooth, Searched::Nothing);
        } else {
            add(tilt.rate_limit < FASTER_TILT, tilts(FASTER_TILT), Searched::Scale);
        }
        candidates
    }

    /// The best of a candidate, simulated on the whole manoeuvre. None where it has not clearly
    /// less of the fault, or more of another.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn best(&self, Candidate(changes, searched): Candidate) -> Result<Option<Alternative>, ParameterError> {
        // Factor from one scale that is tried to the next, and the least scale.
        const SCALE_STEP: f64 = 0.85;
        const MIN_SCALE: f64 = 0.03;
        // Factors on the rates or on heave that are tried, the largest first.
        const SMALLER_PARTS: [f64; 6] = [0.7, 0.5, 0.35, 0.25, 0.15, 0.0];
        let with = |place: usize, factor: f64| Changes {
            factors: from_fn(|k| if k == place { factor } else { changes.factors[k] }),
            ..changes
        };
        let trials: Vec<Changes> = match searched {
            Searched::Nothing => vec![changes],
            Searched::Rates => SMALLER_PARTS.map(|factor| with(1, factor)).into(),
            Searched::Heave => SMALLER_PARTS.map(|factor| with(2, factor)).into(),
            Searched::Scale => {
                let (start, count) = self.fitting_scale(&changes)?;
                let scales = (0..count).map(|k| start * SCALE_STEP.powi(k as i32));
                scales.filter(|scale| *scale >= MIN_SCALE).map(|scale| with(0, scale)).collect()
            }
        };
        let mut best: Option<Alternative> = None;
        for changes in trials.into_iter().filter(|changes| *changes != Changes::NONE) {
            let Some(found) = self.simulated(changes)? else { return Ok(None) };
            if !self.is_better(&found) {
                continue;
            }
            let is_done = found.severity(self.fault) < 1.0 && found.severity(Fault::Disproportion) < 1.0;
            if best.as_ref().is_none_or(|best| found.rank(self.fault) < best.rank(self.fault)) {
                best = Some(found);
            }
            if is_done {
                break;
            }
        }
        Ok(best)
    }

    /// The largest scale that is right, by the quick simulation of the search, and how many are
    /// tried from there on. Where no scale is right in proportion, too, one that is right in sign
    /// and on the whole; else the nearest alone.
    fn fitting_scale(&self, changes: &Changes) -> Result<(f64, usize), ParameterError> {
        // Number of scales that are tried, and the same where none is right in proportion.
        const MAX_SCALES: usize = 8;
        const LESS_SCALES: usize = 3;
        let searched = self.part.as_ref().unwrap_or(self.manoeuvre);
        let preview = changes.preview.unwrap_or(self.preview);
        let parameters = changes.applied(&self.parameters);
        let strict = Aims { shape: RIGHT_SHAPE, ..Aims::default() };
        let mut search = Search::new(searched, preview, strict);
        if let (found, true) = search.scale(&parameters)? {
            return Ok((found.factors.scale, MAX_SCALES));
        }
        search.aims = Aims::default();
        let (found, reaches) = search.scale(&parameters)?;
        Ok((found.factors.scale, if reaches { LESS_SCALES } else { 1 }))
    }

    fn simulated(&self, changes: Changes) -> Result<Option<Alternative>, ParameterError> {
        let parameters = changes.applied(&self.parameters);
        let preview = changes.preview.unwrap_or(self.preview);
        let previewer = Previewer::of(self.manoeuvre, preview);
        let simulation = Simulation::previewed(&Replay::new(self.manoeuvre), &parameters, previewer, || ())?;
        let Ok(measures) = measures(&simulation) else { return Ok(None) };
        let evaluated = Evaluated { simulation: &simulation, measures: &measures, bounds: [None; 3], advice: None };
        let result = match self.fault {
            Fault::Rough => evaluated.roughness(self.shakes),
            fault => evaluated.result(fault),
        };
        Ok(Some(Alternative {
            changes,
            parameters,
            preview,
            severities: evaluated.severities(),
            result: format!("{result}{}", evaluated.size_clause()),
            size: measures.shape.size(),
            shape: measures.shape.least_shape(),
        }))
    }

    /// True where an alternative has clearly less of the fault, and no more of any other.
    fn is_better(&self, alternative: &Alternative) -> bool {
        // Largest severity of the fault, relative to what it was, that counts as better: where the
        // fault is gone with it, and where it is not.
        const BETTER_SEVERITY_RATIOS: [f64; 2] = [0.95, 0.8];
        // Largest growth of another fault that is there already.
        const NO_WORSE: f64 = 1.05;
        let others = alternative.severities.iter().filter(|(fault, _)| *fault != self.fault);
        let is_no_worse =
            |(fault, after): &(Fault, f64)| *after < f64::max(1.0, NO_WORSE * fault_severity(&self.before, *fault));
        let after = alternative.severity(self.fault);
        let least = BETTER_SEVERITY_RATIOS[usize::from(after >= 1.0)] * fault_severity(&self.before, self.fault);
        after <= least && others.into_iter().all(is_no_worse)
    }
}

/// The part of a manoeuvre with the largest surge and sway, if it is longer than [`MAX_SEARCHED`].
fn hardest_part(manoeuvre: &Manoeuvre) -> Option<Manoeuvre> {
    let count = (MAX_SEARCHED / manoeuvre.step()) as usize + 1;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_that_is_just_one_ranks_behind_none() {
        let alternative = |inverted: f64| Alternative {
            changes: Changes::NONE,
            parameters: Parameters::default(),
            preview: 0.0,
            severities: vec![(Fault::Inverted, inverted), (Fault::Rough, 1.3)],
            result: String::new(),
            size: None,
            shape: None,
        };
        let ranks = [0.99, 1.0, 1.1].map(|inverted| alternative(inverted).rank(Fault::Inverted));
        assert!(ranks.is_sorted_by(|one, other| one < other), "{ranks:?}");
    }
}
