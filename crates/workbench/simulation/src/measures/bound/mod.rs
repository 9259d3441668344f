//! The bound: the smallest RMS error of the felt specific force that any controller could reach on
//! one axis under the same limits. The controller may even know the whole recording in advance.
//!
//! The axis is linearised: felt = p'' - (h/g) tilt_force'' + tilt_force. Here p is the platform's
//! position, and tilt_force = g sin(tilt) is the specific force added by the tilt. The head's
//! height h above the platform determines the tangential acceleration that the tilt causes at the
//! head. Surge is combined with pitch, sway with roll; heave has no tilt. The limits are on
//! position, velocity and acceleration, and on the tilt, its rate and its acceleration. The axis
//! starts at rest at neutral; its final state is free.
//!
//! The best motion is found by a convex quadratic program over intervals of time.
//!
//! - [`Bound::rms_error`] is a lower bound. Its program constrains only means and slopes over
//!   intervals and their ends, so that accelerations may vary within an interval. The bound does
//!   not rely on the solver's accuracy: it is the value of a dual solution, computed here from the
//!   solver's multipliers.
//! - [`Bound::attained`] is the RMS error of a motion that keeps all limits. The true optimum
//!   lies between the two.

mod certificate;
mod interior_point;
mod limits;
mod program;
mod projection;
mod trajectory;

use interior_point::{NotSolved, Solution, solve};
use nalgebra::SVector;
use projection::Projection;
use trajectory::Knot;
pub use trajectory::Trajectory;

use crate::{Refusal, refuse};

/// The limits of one axis of the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    /// Least position relative to neutral, below 0 \[m\].
    pub min: f64,
    /// Greatest position relative to neutral, above 0 \[m\].
    pub max: f64,
    /// Largest velocity \[m/s\].
    pub velocity: f64,
    /// Largest acceleration \[m/s2\].
    pub acceleration: f64,
    /// The tilt that goes with the axis; none for heave.
    pub tilt: Option<TiltLimits>,
}

/// The limits of tilt coordination, and what it does at the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TiltLimits {
    /// Largest angle \[rad\].
    pub angle: f64,
    /// Largest rate \[rad/s\].
    pub rate: f64,
    /// Largest acceleration \[rad/s2\].
    pub acceleration: f64,
    /// Height of the head above the point that the position is of \[m\].
    pub head_height: f64,
    /// Magnitude of gravity \[m/s2\].
    pub gravity: f64,
}

/// The least error on one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// No motion within the limits has a smaller RMS error than this \[m/s2\].
    pub rms_error: f64,
    /// RMS error of the best motion found that keeps the limits \[m/s2\].
    pub attained: f64,
    /// The best motion found.
    pub trajectory: Trajectory,
}

/// Default length of an interval \[s\]. Shorter ones take more time and do not improve the bound
/// on smooth recordings.
pub const DEFAULT_INTERVAL: f64 = 0.02;

/// The bound for a desired specific force along one axis.
///
/// `desired` is the deviation from rest (in heave, without gravity), sampled every `step` seconds
/// and linear in between. `interval` \[s\] is the length of the program's intervals, by default
/// [`DEFAULT_INTERVAL`]. The length is rounded to a whole number of steps, at least one.
///
/// # Errors
/// The recording or the limits cannot be used, or the solver fails.
pub fn bound(desired: &[f64], step: f64, limits: &AxisLimits, interval: f64) -> Result<Bound, Refusal> {
    check_limits(limits)?;
    if step.is_nan() || step <= 0.0 {
        refuse!("the time between samples is {step} s; it must be above 0");
    }
    if let Some((sample, &value)) = desired.iter().enumerate().find(|(_, value)| !value.is_finite()) {
        refuse!("sample {sample} of the desired specific force is {value}; it must be a finite number");
    }
    let steps = (interval / step).round().max(1.0) as usize;
    if desired.len() <= steps {
        refuse!("the recording has {} samples; a bound needs at least {}", desired.len(), steps + 1);
    }
    let desired_over: Vec<Projection> = desired.windows(steps + 1).step_by(steps).map(Projection::of_line).collect();
    let interval = steps as f64 * step;
    let duration = (desired.len() - 1) as f64 * step;

    let (least, arm, knots) = match &limits.tilt {
        None => {
            let relaxed = program::relaxed(&desired_over, interval, limits);
            let restricted = program::restricted(&desired_over, interval, limits);
            let least = certificate::lower_bound(&relaxed, &solve(&relaxed)?);
            (least, 0.0, solution_knots(&solve(&restricted)?))
        }
        Some(tilt) => {
            let relaxed = program::relaxed_with_tilt(&desired_over, interval, limits, tilt);
            let restricted = program::restricted_with_tilt(&desired_over, interval, limits, tilt);
            let least = certificate::lower_bound(&relaxed, &solve(&relaxed)?);
            (least, tilt.head_height / tilt.gravity, solution_knots(&solve(&restricted)?))
        }
    };
    let trajectory = Trajectory { interval, arm, knots };
    Ok(Bound {
        rms_error: (2.0 * least * interval / duration).max(0.0).sqrt(),
        attained: trajectory.rms_error(desired, step),
        trajectory,
    })
}

/// The states of a solution, without tilt where there is none.
fn solution_knots<const N: usize, const U: usize, const R: usize>(solution: &Solution<N, U, R>) -> Vec<Knot> {
    let knot = |state: &SVector<f64, N>| {
        let at = |index: usize| state.get(index).copied().unwrap_or(0.0);
        Knot { position: at(0), velocity: at(1), tilt_force: at(2), tilt_force_rate: at(3) }
    };
    solution.states.iter().map(knot).collect()
}

impl From<NotSolved> for Refusal {
    fn from(NotSolved { value, least }: NotSolved) -> Self {
        let gap = format!("its error stayed between {least:.3e} and {value:.3e}");
        Refusal(format!("the solver found no best motion ({gap}); try another interval"))
    }
}

fn check_limits(limits: &AxisLimits) -> Result<(), Refusal> {
    let AxisLimits { min, max, velocity, acceleration, tilt } = *limits;
    let limit = |name: &str, value: f64, holds: bool, needed: &str| {
        if !(holds && value.is_finite()) {
            refuse!("the {name} limit is {value}; it must be {needed}");
        }
        Ok(())
    };
    limit("least position", min, min < 0.0, "below 0")?;
    limit("greatest position", max, max > 0.0, "above 0")?;
    limit("velocity", velocity, velocity > 0.0, "above 0")?;
    limit("acceleration", acceleration, acceleration > 0.0, "above 0")?;
    let Some(TiltLimits { angle, rate, acceleration, head_height, gravity }) = tilt else { return Ok(()) };
    let is_acute = angle > 0.0 && angle <= std::f64::consts::FRAC_PI_2;
    limit("tilt angle", angle, is_acute, "above 0 and at most a right angle")?;
    limit("tilt rate", rate, rate > 0.0, "above 0")?;
    limit("tilt acceleration", acceleration, acceleration > 0.0, "above 0")?;
    limit("head height", head_height, true, "a finite number")?;
    limit("gravity", gravity, gravity > 0.0, "above 0")
}
