//! The measures of the bench, in their order.

use moris_simulation::Evaluated;
use moris_simulation::findings::fit;
use moris_simulation::measures::comfort::Excess;
use moris_simulation::measures::statistics::mean;

/// A measure: its name with its unit, its decimals, and its value where it is defined.
pub struct Column {
    /// Name in the file.
    pub name: &'static str,
    /// Digits behind the point.
    pub decimals: usize,
    /// Value of an evaluated drive; none where it is not defined.
    pub value: fn(&Evaluated) -> Option<f64>,
}

/// Shorthand for a column.
const fn column(name: &'static str, decimals: usize, value: fn(&Evaluated) -> Option<f64>) -> Column {
    Column { name, decimals, value }
}

/// The columns. Their list is part of the bench's version.
pub const BENCH_COLUMNS: [Column; 30] = [
    column("desired x [m/s2]", 4, |of| desired(of, 0)),
    column("desired y [m/s2]", 4, |of| desired(of, 1)),
    column("desired z [m/s2]", 4, |of| desired(of, 2)),
    column("bound x [m/s2]", 4, |of| of.bounds[0]),
    column("bound y [m/s2]", 4, |of| of.bounds[1]),
    column("bound z [m/s2]", 4, |of| of.bounds[2]),
    column("RMS error x [m/s2]", 4, |of| error(of, 0)),
    column("RMS error y [m/s2]", 4, |of| error(of, 1)),
    column("RMS error z [m/s2]", 4, |of| error(of, 2)),
    column("sensed error x [m/s2]", 4, |of| sensed(of, 0)),
    column("sensed error y [m/s2]", 4, |of| sensed(of, 1)),
    column("sensed error z [m/s2]", 4, |of| sensed(of, 2)),
    column("shape x", 3, |of| of.measures.shape.axes[0].as_ref().map(|axis| axis.shape)),
    column("shape y", 3, |of| of.measures.shape.axes[1].as_ref().map(|axis| axis.shape)),
    column("size x", 3, |of| of.measures.shape.axes[0].as_ref().map(|axis| axis.size)),
    column("size y", 3, |of| of.measures.shape.axes[1].as_ref().map(|axis| axis.size)),
    column("inverted x [%]", 2, |of| of.measures.shape.axes[0].as_ref().map(|axis| 100.0 * axis.inverted)),
    column("inverted y [%]", 2, |of| of.measures.shape.axes[1].as_ref().map(|axis| 100.0 * axis.inverted)),
    column("shake [m/s2]", 3, |of| largest(of, 0)),
    column("jolt [m/s2]", 3, |of| largest(of, 1)),
    column("peak [m/s2]", 3, |of| largest(of, 2)),
    column("false force cues [%]", 2, |of| Some(100.0 * mean(&of.measures.force_cues.map(|cues| cues.false_cues)))),
    column("missing force cues [%]", 2, |of| Some(100.0 * mean(&of.measures.force_cues.map(|cues| cues.missing_cues)))),
    column("false rate cues [%]", 2, |of| rates(of, mean(&of.measures.rate_cues.map(|cues| cues.false_cues)))),
    column("missing rate cues [%]", 2, |of| rates(of, mean(&of.measures.rate_cues.map(|cues| cues.missing_cues)))),
    column("sick in the vehicle [%]", 2, |of| Some(of.measures.rider.sick[0])),
    column("sick on the platform [%]", 2, |of| Some(of.measures.rider.sick[1])),
    column("stroke used [%]", 1, |of| fit(of).map(|_| 100.0 * of.measures.effort.stroke_used)),
    column("soft limits [%]", 2, |of| {
        of.simulation.foreign.is_none().then_some(100.0 * of.measures.effort.limited.soft)
    }),
    column("limited [%]", 2, |of| {
        let effort = &of.measures.effort;
        fit(of).map(|_| 100.0 * effort.limited.safety.max(effort.limited.actuator))
    }),
];

fn desired(of: &Evaluated, axis: usize) -> Option<f64> {
    of.measures.force[axis].as_ref().map(|_| of.desired_rms(axis))
}

fn error(of: &Evaluated, axis: usize) -> Option<f64> {
    of.measures.force[axis].as_ref().map(|fidelity| fidelity.rms_error)
}

fn sensed(of: &Evaluated, axis: usize) -> Option<f64> {
    of.measures.sensed_force[axis].as_ref().map(|fidelity| fidelity.rms_error)
}

/// The largest excess of the axes: shake, jolt or peak.
fn largest(of: &Evaluated, which: usize) -> Option<f64> {
    let of_axis = |comfort: &moris_simulation::measures::comfort::Comfort| {
        let value = |excess: Option<Excess>| excess.map(|excess| excess.value);
        [value(comfort.shake), value(comfort.jolt), Some(comfort.peak.value)][which]
    };
    of.measures.comfort.iter().flatten().filter_map(of_axis).reduce(f64::max)
}

/// A value of rates, where rates are known.
fn rates(of: &Evaluated, value: f64) -> Option<f64> {
    let has_rate = of.simulation.foreign.as_ref().is_none_or(|foreign| foreign.has_rate);
    has_rate.then_some(100.0 * value)
}
