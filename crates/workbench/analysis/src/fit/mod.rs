//! Recordings fitted with several strategies, and drives for those who have no recording.

pub mod usual;

use moris_setup::Setup;
use moris_simulation::fit::{Aims, Fit, Search};
use rayon::prelude::*;

use crate::error::{About, Result};
use crate::recording::Recording;

/// Rate of tilt that a second line shows \[rad/s\].
const FASTER_TILT: f64 = 6.0_f64.to_radians();

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
    let better = |best: usize, next: usize| if aims.prefer(&fits[next].best, &fits[best].best) { next } else { best };
    let winner = (1..fits.len()).fold(0, better);
    let mut parameters = recording.parameters(&strategies[winner].setup.parameters);
    let is_slower = parameters.tilt.rate_limit < FASTER_TILT;
    parameters.tilt.rate_limit = FASTER_TILT;
    // A set whose other limits forbid it has no second line.
    let faster_tilt = if is_slower { search.fit(&parameters).ok() } else { None };
    Ok(Fitted { name: recording.name.clone(), fits, winner, faster_tilt })
}

/// Means over all channels of a strategy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Means {
    /// Mean correlation of felt and desired force.
    pub shape: f64,
    /// Mean and largest fraction of inverted time.
    pub inverted: [f64; 2],
    /// Geometric mean of the sizes.
    pub size: f64,
    /// Geometric mean of the scales.
    pub scale: f64,
    /// Recordings that no scale fits.
    pub misfits: usize,
}

/// Means of some fits.
pub fn means<'a>(fits: impl Iterator<Item = &'a Fit> + Clone) -> Means {
    let axes: Vec<_> = fits.clone().flat_map(|fit| fit.best.shape.axes).flatten().collect();
    let count = axes.len().max(1) as f64;
    let scales: Vec<f64> = fits.clone().map(|fit| fit.best.factors.scale.ln()).collect();
    Means {
        shape: axes.iter().map(|axis| axis.shape).sum::<f64>() / count,
        inverted: [
            axes.iter().map(|axis| axis.inverted).sum::<f64>() / count,
            axes.iter().map(|axis| axis.inverted).fold(0.0, f64::max),
        ],
        size: (axes.iter().map(|axis| axis.size.ln()).sum::<f64>() / count).exp(),
        scale: (scales.iter().sum::<f64>() / scales.len().max(1) as f64).exp(),
        misfits: fits.filter(|fit| !fit.fits).count(),
    }
}
