//! The bound on each axis: how well the recording's specific force could be felt at best on this
//! rig.

use moris_simulation::measures::Axes;
use moris_simulation::measures::bound::{AxisLimits, Bound, DEFAULT_INTERVAL, TiltLimits, bound};
use moris_simulation::measures::statistics::rms;
use moris_washout::Parameters;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::reach::{Axis, single_axis_range};
use rayon::prelude::*;

use moris_simulation::{Refusal, Simulation};

/// The bound on one axis, and the desired signal it belongs to.
#[derive(Clone, Debug)]
pub struct AxisBound {
    /// The least error on the axis.
    pub bound: Bound,
    /// The desired specific force as a deviation from rest, at each sample \[m/s2\].
    pub desired: Vec<f64>,
}

impl AxisBound {
    /// RMS of the desired specific force as a deviation from rest \[m/s2\].
    pub fn desired_rms(&self) -> f64 {
        rms(self.desired.iter().copied())
    }
}

/// The bounds of surge, sway and heave, computed beside each other; none where nothing
/// is desired on an axis.
///
/// The bound knows an upright rider: the head's height is that of the washout
/// location without lean.
///
/// # Errors
/// The recording is too short for a bound, or the solver fails.
pub fn bounds(simulation: &Simulation) -> Result<Axes<Option<AxisBound>>, Refusal> {
    // More intervals than this take too long, and a longer recording gets longer ones: its bound is
    // a little lower, and as valid.
    const MOST_INTERVALS: f64 = 10_000.0;
    let duration = simulation.step * simulation.inputs.len() as f64;
    bounds_at(simulation, DEFAULT_INTERVAL.max(duration / MOST_INTERVALS))
}

/// The bounds with intervals of this length \[s\]. With longer ones they are a little lower, and as
/// valid.
///
/// # Errors
/// As [`bounds`].
pub fn bounds_at(simulation: &Simulation, interval: f64) -> Result<Axes<Option<AxisBound>>, Refusal> {
    // An axis on which less than this is desired has no bound worth computing: RMS [m/s2].
    const WORTH_BOUNDING: f64 = 0.01;
    let on_axis = |axis: usize| {
        let rest = [0.0, 0.0, STANDARD_GRAVITY][axis];
        let desired: Vec<f64> = simulation.inputs.iter().map(|input| input.specific_force[axis] - rest).collect();
        let bound = AxisBound {
            bound: bound(&desired, simulation.step, &axis_limits(&simulation.parameters, axis), interval)?,
            desired,
        };
        Ok((bound.desired_rms() >= WORTH_BOUNDING).then_some(bound))
    };
    let found: Result<Vec<Option<AxisBound>>, Refusal> = (0..3).into_par_iter().map(on_axis).collect();
    let mut found = found?.into_iter();
    Ok(std::array::from_fn(|_| found.next().flatten()))
}

/// The limits that the washout keeps on an axis: the safety unit's, or the stroke along the axis
/// alone where that is less.
fn axis_limits(parameters: &Parameters, axis: usize) -> AxisLimits {
    let Parameters { safety, tilt, structure, rig, .. } = parameters;
    let reach = single_axis_range(rig, [Axis::Surge, Axis::Sway, Axis::Heave][axis]);
    let head = moris_washout::platform::LocationFrame::new(structure, 0.0).point;
    AxisLimits {
        min: reach.min.max(-safety.position_limit[axis]),
        max: reach.max.min(safety.position_limit[axis]),
        velocity: safety.velocity_limit[axis],
        acceleration: safety.acceleration_limit[axis],
        tilt: (axis < 2).then_some(TiltLimits {
            angle: tilt.angle_limit,
            rate: tilt.rate_limit,
            acceleration: tilt.acceleration_limit,
            head_height: Vector3::z().dot(&head),
            gravity: structure.gravity,
        }),
    }
}
