//! Recordings fitted with several strategies, each alone and all with one set of parameters.

use moris_setup::Setup;
use moris_simulation::advice::FASTER_TILT;
use moris_simulation::fit::{Aims, Candidate, Factors, Fit, MAX_REDUCTIONS, SCALE_REDUCTION, Search};
use moris_simulation::measures::shape::{AxisShape, Shape};
use rayon::prelude::*;

use crate::error::{About, Result};
use crate::recording::Recording;

/// A strategy's parameters under its name.
#[derive(Clone, Debug)]
pub struct Strategy {
    /// Name of the strategy.
    pub name: String,
    /// Rig and parameters.
    pub setup: Setup,
}

/// A recording with its fit for each strategy.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// Name of the recording.
    pub name: String,
    /// The fits, in the order of the strategies.
    pub fits: Vec<Fit>,
    /// The best of them.
    pub winner: usize,
    /// The winner's fit with a tilt of 6 degrees a second; none where its limit is as high already.
    pub faster_tilt: Option<Fit>,
}

/// Fits every recording with every strategy, beside each other.
///
/// # Errors
/// The parameters of a strategy cannot be used.
pub fn fitted(recordings: &[Recording], strategies: &[Strategy], preview: f64, aims: Aims) -> Result<Vec<Fitted>> {
    recordings.par_iter().map(|recording| of_recording(recording, strategies, preview, aims)).collect()
}

fn of_recording(recording: &Recording, strategies: &[Strategy], preview: f64, aims: Aims) -> Result<Fitted> {
    let search = Search::new(&recording.manoeuvre, preview, aims);
    let fit = |strategy: &Strategy| {
        let parameters = recording.parameters(&strategy.setup.parameters);
        search.fit(&parameters).about(|| format!("{}, {}", recording.name, strategy.name))
    };
    let fits: Vec<Fit> = strategies.par_iter().map(fit).collect::<Result<_>>()?;
    let winner = aims.best(&fits.iter().map(|fit| fit.best).collect::<Vec<_>>()).unwrap_or(0);
    let mut parameters = recording.parameters(&strategies[winner].setup.parameters);
    let is_slower = parameters.tilt.rate_limit < FASTER_TILT;
    parameters.tilt.rate_limit = FASTER_TILT;
    // A set whose other limits forbid it has no second line.
    let faster_tilt = if is_slower { search.fit(&parameters).ok() } else { None };
    Ok(Fitted { name: recording.name.clone(), fits, winner, faster_tilt })
}

/// One set of factors for several recordings.
#[derive(Clone, Debug)]
pub struct Common {
    /// The strategy, an index of those given.
    pub strategy: usize,
    /// The factors, and the worst of the recordings: least shape, largest inverted time and error,
    /// least size.
    pub worst: Candidate,
    /// Number of recordings that reach the aims with them.
    pub fitting: usize,
}

/// The best strategy with one set of factors for all recordings; none of no recording.
///
/// # Errors
/// The parameters of a strategy cannot be used.
pub fn common(
    recordings: &[Recording],
    strategies: &[Strategy],
    preview: f64,
    aims: Aims,
    fitted: &[Fitted],
) -> Result<Option<Common>> {
    let searches: Vec<Search> =
        recordings.iter().map(|recording| Search::new(&recording.manoeuvre, preview, aims)).collect();
    let of_strategy = |index: usize| {
        let factors = fitted.iter().map(|one| one.fits[index].best.factors);
        let hardest = factors.clone().min_by(|one, other| one.scale.total_cmp(&other.scale))?;
        let heave = factors.map(|factors| factors.heave).fold(1.0, f64::min);
        let wanted = fitted.iter().filter(|one| one.fits[index].fits).count();
        Some((Factors { heave, ..hardest }, wanted))
    };
    let shapes = |index: usize, factors: Factors| {
        let setup = &strategies[index].setup;
        let shape = |(recording, search): (&Recording, &Search)| {
            let exact = search.exact(&recording.parameters(&setup.parameters), factors);
            exact.map(|candidate| candidate.shape).about(|| format!("{}, {}", recording.name, strategies[index].name))
        };
        recordings.par_iter().zip(&searches).map(shape).collect::<Result<Vec<Shape>>>()
    };
    let mut all = Vec::new();
    for strategy in 0..strategies.len() {
        let Some((mut factors, wanted)) = of_strategy(strategy) else { return Ok(None) };
        let mut found = Common::of(strategy, factors, &shapes(strategy, factors)?, aims);
        for _ in 0..MAX_REDUCTIONS {
            if found.fitting >= wanted {
                break;
            }
            factors.scale *= SCALE_REDUCTION;
            found = Common::of(strategy, factors, &shapes(strategy, factors)?, aims);
        }
        all.push(found);
    }
    let most = all.iter().map(|one| one.fitting).max().unwrap_or(0);
    all.retain(|one| one.fitting == most);
    let best = aims.best(&all.iter().map(|one| one.worst).collect::<Vec<_>>());
    Ok(best.map(|best| all.swap_remove(best)))
}

impl Common {
    fn of(strategy: usize, factors: Factors, shapes: &[Shape], aims: Aims) -> Self {
        let axis = |k: usize| shapes.iter().filter_map(|shape| shape.axes[k]).reduce(worse_axis);
        let largest = |value: fn(&Shape) -> Option<f64>| shapes.iter().filter_map(value).reduce(f64::max);
        let shape = Shape {
            axes: [axis(0), axis(1)],
            inverted_horizontal: largest(|shape| shape.inverted_horizontal),
            error: largest(|shape| shape.error),
        };
        let fitting = shapes.iter().filter(|shape| aims.distance(shape) <= 1.0).count();
        Common { strategy, worst: Candidate { factors, shape }, fitting }
    }
}

/// The worse of each figure.
fn worse_axis(one: AxisShape, other: AxisShape) -> AxisShape {
    AxisShape {
        shape: one.shape.min(other.shape),
        size: one.size.min(other.size),
        inverted: one.inverted.max(other.inverted),
    }
}

/// Means over all channels of a strategy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitMeans {
    /// Mean correlation of felt and desired force.
    pub shape: f64,
    /// Mean fraction of inverted time.
    pub mean_inverted: f64,
    /// Largest fraction of inverted time.
    pub max_inverted: f64,
    /// Geometric mean of the sizes.
    pub size: f64,
    /// Geometric mean of the scales.
    pub scale: f64,
    /// Recordings that no scale fits.
    pub misfits: usize,
}

/// Means of some fits.
pub fn fit_means<'a>(fits: impl Iterator<Item = &'a Fit> + Clone) -> FitMeans {
    let axes: Vec<_> = fits.clone().flat_map(|fit| fit.best.shape.axes).flatten().collect();
    let count = axes.len().max(1) as f64;
    let scales: Vec<f64> = fits.clone().map(|fit| fit.best.factors.scale.ln()).collect();
    FitMeans {
        shape: axes.iter().map(|axis| axis.shape).sum::<f64>() / count,
        mean_inverted: axes.iter().map(|axis| axis.inverted).sum::<f64>() / count,
        max_inverted: axes.iter().map(|axis| axis.inverted).fold(0.0, f64::max),
        size: (axes.iter().map(|axis| axis.size.ln()).sum::<f64>() / count).exp(),
        scale: (scales.iter().sum::<f64>() / scales.len().max(1) as f64).exp(),
        misfits: fits.filter(|fit| !fit.fits).count(),
    }
}
