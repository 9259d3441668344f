//! The plan as a quadratic program, condensed: its variables are the blocks' dropped forces and
//! tilt accelerations alone.
//!
//! Over block j of duration T, with the reference's mean F and constant dropped force e and
//! tilt acceleration alpha,
//!
//! ```text
//!     u  = F + H alpha + e
//!     x' = x + v T + u T^2/2 - g' (q T^2/2 + w T^3/6 + alpha T^4/24)
//!     v' = v + u T - g' (q T + w T^2/2 + alpha T^3/6)
//!     q' = q + w T + alpha T^2/2,   w' = w + alpha T
//! ```
//!
//! with g' somewhat below g, the chord of the sine. The nodes' states are linear in the start, the
//! reference and the variables. The cost is that of the regulator, by the trapezoidal rule, with
//! the regulator's cost to come at the end.

use nalgebra::{Matrix4, SMatrix, SVector, Vector4};
use serde::{Deserialize, Serialize};

use super::dual_active_set::Rows;
use super::forecast::Forecast;
use super::horizon::{BLOCKS, Horizon};
use crate::cueing::strategy::AxisState;
use crate::cueing::strategy::regulator::{AxisModel, Regulator, Weights};

/// Variables of an axis: dropped forces \[m/s2\], then tilt accelerations relative to their limit.
pub const AXIS_CONTROLS: usize = 2 * BLOCKS;
/// Variables: those of surge, then those of sway.
pub const CONTROLS: usize = 2 * AXIS_CONTROLS;
/// Rows of an axis: position, velocity, tilt and tilt rate at the nodes, position in the middle of
/// the blocks after the first, tilt acceleration, and two for the end.
pub const AXIS_ROWS: usize = 6 * BLOCKS + 1;
/// Rows of the actuators' lengths, six for each node.
pub const LEG_ROWS: usize = 6 * BLOCKS;
/// Rows: those of surge, of sway, and of the actuators.
pub const ROWS: usize = 2 * AXIS_ROWS + LEG_ROWS;

/// Position, velocity, tilt and tilt rate at each node, node by node.
pub type Nodes = SVector<f64, { 4 * BLOCKS }>;
/// The start's four, the reference's means, and its slow and fast part at the end.
pub type Data = SVector<f64, { BLOCKS + 6 }>;
/// The variables of an axis.
pub type AxisControls = SVector<f64, AXIS_CONTROLS>;

/// The fractions of the limits that a plan uses; the rest is for what the plan does not see.
const POSITION_FRACTION: f64 = 0.435 / 0.45;
const VELOCITY_FRACTION: f64 = 0.95;
const RATE_FRACTION: f64 = 0.999;
/// The plan must be able to stop inside its limits from the end. The position plus the velocity
/// times this time must be inside them \[s\].
const STOPPING_TIME: f64 = 0.3;
/// Gravity along the tilt relative to the sine's tangent.
pub const CHORD: f64 = 0.985;
/// A small weight of tilt acceleration keeps the program strictly convex.
const LEAST_TILT_ACCELERATION_WEIGHT: f64 = 1e-5;

/// The programs over both horizons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Programs {
    pub near: Program,
    pub far: Program,
}

impl Programs {
    /// Both programs. None if there is no regulator for these weights.
    pub fn new(models: &[AxisModel; 2], weights: &Weights) -> Option<Self> {
        let program = |horizon| Program::new(models, weights, horizon);
        Some(Programs { near: program(Horizon::Near)?, far: program(Horizon::Far)? })
    }

    /// Replaces both by those for other models or weights.
    pub fn retune(&mut self, models: &[AxisModel; 2], weights: &Weights) {
        self.near.retune(models, weights);
        self.far.retune(models, weights);
    }

    /// The program over a horizon.
    pub fn over(&self, horizon: Horizon) -> &Program {
        match horizon {
            Horizon::Near => &self.near,
            Horizon::Far => &self.far,
        }
    }
}

/// The program over a horizon: what does not change from plan to plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Program {
    pub horizon: Horizon,
    /// Surge and sway.
    pub axes: [Box<AxisProgram>; 2],
}

impl Program {
    /// The program of both axes. None if there is no regulator for these weights.
    pub fn new(models: &[AxisModel; 2], weights: &Weights, horizon: Horizon) -> Option<Self> {
        let axis = |axis: usize| AxisProgram::new(&models[axis], weights, horizon).map(Box::new);
        Some(Program { horizon, axes: [axis(0)?, axis(1)?] })
    }

    /// Replaces the program by that for other models or weights; it stays if there is no other.
    fn retune(&mut self, models: &[AxisModel; 2], weights: &Weights) {
        // In place of the old one, because a change of parameters allocates nothing.
        let [Some(surge), Some(sway)] =
            [0, 1].map(|axis: usize| AxisProgram::new(&models[axis], weights, self.horizon))
        else {
            return;
        };
        (*self.axes[0], *self.axes[1]) = (surge, sway);
    }

    /// Sets `factor` to L^-T of the Hessian L L' of both axes, the dropped force of each block
    /// weighted more by `surcharges`. False if rounding has made the Hessian indefinite.
    pub fn factorize(
        &self,
        surcharges: &[SVector<f64, BLOCKS>; 2],
        factor: &mut SMatrix<f64, CONTROLS, CONTROLS>,
    ) -> bool {
        factor.fill(0.0);
        for (k, axis) in self.axes.iter().enumerate() {
            let mut hessian = axis.hessian;
            for (block, duration) in self.horizon.durations().iter().enumerate() {
                hessian[(block, block)] += duration * surcharges[k][block];
            }
            let Some(cholesky) = hessian.cholesky() else { return false };
            let mut inverse = SMatrix::<f64, AXIS_CONTROLS, AXIS_CONTROLS>::identity();
            if !cholesky.l_dirty().solve_lower_triangular_mut(&mut inverse) {
                return false;
            }
            let begin = k * AXIS_CONTROLS;
            factor.fixed_view_mut::<AXIS_CONTROLS, AXIS_CONTROLS>(begin, begin).copy_from(&inverse.transpose());
        }
        true
    }
}

/// One axis of the program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisProgram {
    model: AxisModel,
    horizon: Horizon,
    from_data: SMatrix<f64, { 4 * BLOCKS }, { BLOCKS + 6 }>,
    from_controls: SMatrix<f64, { 4 * BLOCKS }, AXIS_CONTROLS>,
    gradient: SMatrix<f64, AXIS_CONTROLS, { BLOCKS + 6 }>,
    hessian: SMatrix<f64, AXIS_CONTROLS, AXIS_CONTROLS>,
}

impl AxisProgram {
    /// The program of an axis. None if there is no regulator for these weights.
    pub fn new(model: &AxisModel, weights: &Weights, horizon: Horizon) -> Option<Self> {
        let regulator = Regulator::new(model, weights)?;
        let from_data = responses(model, horizon, |data: &Data| {
            (data.fixed_rows::<4>(0).into_owned(), data.fixed_rows::<BLOCKS>(4).into_owned(), AxisControls::zeros())
        });
        let from_controls =
            responses(model, horizon, |controls: &AxisControls| (Vector4::zeros(), SVector::zeros(), *controls));
        let mut weighted = SMatrix::<f64, { 4 * BLOCKS }, AXIS_CONTROLS>::zeros();
        for node in 0..BLOCKS {
            let weight = node_weight(model, weights, &regulator, horizon, node);
            let states = weight * from_controls.fixed_rows::<4>(4 * node);
            weighted.fixed_rows_mut::<4>(4 * node).copy_from(&states);
        }
        let mut hessian = from_controls.tr_mul(&weighted);
        for (block, duration) in horizon.durations().iter().enumerate() {
            hessian[(block, block)] += duration;
            hessian[(BLOCKS + block, BLOCKS + block)] +=
                duration * (weights.tilt_acceleration + LEAST_TILT_ACCELERATION_WEIGHT);
        }
        let mut gradient = weighted.tr_mul(&from_data);
        let end_to_end = regulator.cost.fixed_view::<4, 2>(0, 4);
        let end = from_controls.fixed_rows::<4>(4 * (BLOCKS - 1)).tr_mul(&end_to_end);
        gradient.fixed_columns_mut::<2>(BLOCKS + 4).copy_from(&end);
        Some(AxisProgram { model: *model, horizon, from_data, from_controls, gradient, hessian })
    }

    /// The nodes without any control.
    pub fn free_nodes(&self, data: &Data) -> Nodes {
        self.from_data * data
    }

    /// The nodes under these controls.
    pub fn nodes(&self, free: &Nodes, controls: &AxisControls) -> Nodes {
        free + self.from_controls * controls
    }

    /// The gradient of the cost without any control.
    pub fn gradient(&self, data: &Data) -> AxisControls {
        self.gradient * data
    }

    /// Effect of one unit of each control on a state (0: position, 2: tilt) of a node.
    pub fn response(&self, node: usize, state: usize) -> AxisControls {
        self.from_controls.row(4 * node + state).transpose()
    }

    /// Matrix of the cost's quadratic part.
    pub fn hessian(&self) -> &SMatrix<f64, AXIS_CONTROLS, AXIS_CONTROLS> {
        &self.hessian
    }

    /// The normals of the axis's rows; all rows lie within -1 and 1.
    pub fn normals(&self) -> SMatrix<f64, AXIS_CONTROLS, AXIS_ROWS> {
        let mut normals = SMatrix::<f64, AXIS_CONTROLS, AXIS_ROWS>::zeros();
        for control in 0..AXIS_CONTROLS {
            let mut controls = AxisControls::zeros();
            controls[control] = 1.0;
            let nodes = self.from_controls.column(control).into_owned();
            normals.set_row(control, &self.rows(&nodes, &controls).transpose());
        }
        normals
    }

    /// The values of the axis's rows.
    pub fn rows(&self, nodes: &Nodes, controls: &AxisControls) -> SVector<f64, AXIS_ROWS> {
        let AxisModel { position_limit, velocity_limit, angle_limit, rate_limit, acceleration_limit, .. } = self.model;
        let position = 1.0 / (POSITION_FRACTION * position_limit);
        let scales = [
            position,
            1.0 / (VELOCITY_FRACTION * velocity_limit),
            1.0 / angle_limit,
            1.0 / (RATE_FRACTION * rate_limit),
        ];
        let durations = self.horizon.durations();
        let mut rows = SVector::zeros();
        for node in 0..BLOCKS {
            for (state, scale) in scales.iter().enumerate() {
                rows[4 * node + state] = scale * nodes[4 * node + state];
            }
            rows[4 * BLOCKS + node] = controls[BLOCKS + node];
            if node + 1 < BLOCKS {
                let middle = nodes[4 * node] + 0.5 * durations[node + 1] * nodes[4 * node + 1];
                rows[5 * BLOCKS + node] = position * middle;
            }
        }
        let end = nodes.fixed_rows::<4>(4 * (BLOCKS - 1));
        let tilt_stopping_time = 0.5 * rate_limit / acceleration_limit;
        rows[AXIS_ROWS - 2] = position * (end[0] + STOPPING_TIME * end[1]);
        rows[AXIS_ROWS - 1] = (end[2] + tilt_stopping_time * end[3]) / angle_limit;
        rows
    }
}

/// Initial state of the program.
pub fn data(state: &AxisState, forecast: &Forecast) -> Data {
    let start = [state.position, state.velocity, state.tilt, state.tilt_rate];
    Data::from_fn(|k, _| match k {
        0..4 => start[k],
        k if k < BLOCKS + 4 => forecast.means[k - 4],
        k => forecast.end[k - BLOCKS - 4],
    })
}

/// The nodes' response to one unit of each argument.
fn responses<const K: usize>(
    model: &AxisModel,
    horizon: Horizon,
    split: impl Fn(&SVector<f64, K>) -> (Vector4<f64>, SVector<f64, BLOCKS>, AxisControls),
) -> SMatrix<f64, { 4 * BLOCKS }, K> {
    let mut responses = SMatrix::<f64, { 4 * BLOCKS }, K>::zeros();
    for k in 0..K {
        let mut unit = SVector::<f64, K>::zeros();
        unit[k] = 1.0;
        let (start, reference, controls) = split(&unit);
        responses.set_column(k, &rolled_out(model, horizon, start, &reference, &controls));
    }
    responses
}

/// The nodes that follow from a start, a reference and controls.
fn rolled_out(
    model: &AxisModel,
    horizon: Horizon,
    start: Vector4<f64>,
    reference: &SVector<f64, BLOCKS>,
    controls: &AxisControls,
) -> Nodes {
    let mut nodes = Nodes::zeros();
    let [mut x, mut v, mut q, mut w]: [f64; 4] = start.into();
    for (block, &t) in horizon.durations().iter().enumerate() {
        let alpha = model.acceleration_limit * controls[BLOCKS + block];
        let constant = reference[block] + model.head_height * alpha + controls[block];
        let gravity = CHORD * model.gravity;
        // The tilt's first and second integral over the block.
        let once = t * (q + t * (w / 2.0 + t * alpha / 6.0));
        let twice = t * t * (q / 2.0 + t * (w / 6.0 + t * alpha / 24.0));
        (x, v) = (x + t * (v + 0.5 * t * constant) - gravity * twice, v + t * constant - gravity * once);
        (q, w) = (q + w * t + 0.5 * alpha * t * t, w + alpha * t);
        nodes.fixed_rows_mut::<4>(4 * block).copy_from(&Vector4::new(x, v, q, w));
    }
    nodes
}

/// Weight of a node's state: by the trapezoidal rule, and at the last one the cost to come.
fn node_weight(
    model: &AxisModel,
    weights: &Weights,
    regulator: &Regulator,
    horizon: Horizon,
    node: usize,
) -> Matrix4<f64> {
    let (last, durations) = (node + 1 == BLOCKS, horizon.durations());
    let time = 0.5 * (durations[node] + if last { 0.0 } else { durations[node + 1] });
    let state_weights = Vector4::new(
        weights.position / model.position_limit.powi(2),
        weights.velocity / model.velocity_limit.powi(2),
        0.0,
        weights.tilt_rate / model.rate_limit.powi(2),
    );
    let running = Matrix4::from_diagonal(&(time * state_weights));
    if last { running + regulator.cost.fixed_view::<4, 4>(0, 0) } else { running }
}

/// The rows, those of the actuators without their normals.
pub fn rows(program: &Program) -> Rows<CONTROLS, ROWS> {
    let mut rows =
        Rows { normals: vec![SVector::zeros(); ROWS], lower: SVector::repeat(-1.0), upper: SVector::repeat(1.0) };
    set_axis_normals(&mut rows, program);
    rows
}

/// Sets the normals that do not change from plan to plan.
pub fn set_axis_normals(rows: &mut Rows<CONTROLS, ROWS>, program: &Program) {
    for (k, axis) in program.axes.iter().enumerate() {
        let normals = axis.normals();
        for (normal, column) in rows.normals.iter_mut().skip(k * AXIS_ROWS).zip(normals.column_iter()) {
            normal.fixed_rows_mut::<AXIS_CONTROLS>(k * AXIS_CONTROLS).copy_from(&column);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::STANDARD_GRAVITY;

    const MODELS: [AxisModel; 2] = [
        AxisModel {
            head_height: 1.2,
            gravity: STANDARD_GRAVITY,
            position_limit: 0.45,
            velocity_limit: 1.1,
            angle_limit: 0.38,
            rate_limit: 0.052,
            acceleration_limit: 0.2,
        },
        AxisModel {
            head_height: 0.9,
            gravity: 9.5,
            position_limit: 0.3,
            velocity_limit: 0.8,
            angle_limit: 0.25,
            rate_limit: 0.07,
            acceleration_limit: 0.4,
        },
    ];
    const WEIGHTS: Weights = Weights {
        position: 0.2,
        velocity: 0.03,
        tilt_rate: 0.01,
        tilt_acceleration: 0.02,
        slow_pole: 0.3,
        fast_pole: 4.0,
    };

    fn program(horizon: Horizon) -> Program {
        Program::new(&MODELS, &WEIGHTS, horizon).unwrap()
    }

    /// A state, a forecast and controls with a part of everything.
    fn example() -> (AxisState, Forecast, AxisControls) {
        let state = AxisState { position: 0.1, velocity: -0.2, tilt: 0.05, tilt_rate: 0.01 };
        let forecast = Forecast { means: SVector::from_fn(|k, _| 0.5 - 0.3 * k as f64), end: [0.7, -0.4] };
        (state, forecast, AxisControls::from_fn(|k, _| (1.0 + k as f64).sin()))
    }

    /// The integral of the weighted squares by the trapezoidal rule, and the
    /// regulator's cost to come.
    fn cost(axis: &AxisProgram, state: &AxisState, forecast: &Forecast, controls: &AxisControls) -> f64 {
        let model = &axis.model;
        let running = |state: &[f64]| {
            WEIGHTS.position * (state[0] / model.position_limit).powi(2)
                + WEIGHTS.velocity * (state[1] / model.velocity_limit).powi(2)
                + WEIGHTS.tilt_rate * (state[3] / model.rate_limit).powi(2)
        };
        let nodes = axis.nodes(&axis.free_nodes(&data(state, forecast)), controls);
        let mut before = vec![state.position, state.velocity, state.tilt, state.tilt_rate];
        let mut cost = 0.0;
        for (block, duration) in axis.horizon.durations().into_iter().enumerate() {
            let after = nodes.as_slice()[4 * block..4 * block + 4].to_vec();
            let (dropped, tilting) = (controls[block], controls[BLOCKS + block]);
            cost += duration * (dropped * dropped + (WEIGHTS.tilt_acceleration + 1e-5) * tilting * tilting);
            cost += 0.5 * duration * (running(&before) + running(&after));
            before = after;
        }
        before.extend(forecast.end);
        let end = SVector::<f64, 6>::from_column_slice(&before);
        let to_come = Regulator::new(model, &WEIGHTS).unwrap().cost;
        0.5 * (cost + end.dot(&(to_come * end)))
    }

    #[test]
    fn data_are_the_start_the_means_and_the_end() {
        let (state, forecast, _) = example();
        let AxisState { position, velocity, tilt, tilt_rate } = state;
        let mut expected = vec![position, velocity, tilt, tilt_rate];
        expected.extend(forecast.means.iter().chain(&forecast.end));
        assert_eq!(data(&state, &forecast).as_slice(), expected);
    }

    #[test]
    fn the_cost_is_that_of_the_regulator() {
        let (state, forecast, controls) = example();
        for horizon in [Horizon::Near, Horizon::Far] {
            for axis in &program(horizon).axes {
                let gradient = axis.gradient(&data(&state, &forecast));
                for scale in [0.1, -1.0, 3.0] {
                    let controls = scale * controls;
                    let quadratic = gradient.dot(&controls) + 0.5 * controls.dot(&(axis.hessian() * controls));
                    let [free, controlled] =
                        [AxisControls::zeros(), controls].map(|controls| cost(axis, &state, &forecast, &controls));
                    let expected = controlled - free;
                    assert!((quadratic - expected).abs() < 1e-10 * controlled, "{quadratic} beside {expected}");
                }
            }
        }
    }

    #[test]
    fn rows_are_motions_relative_to_their_limits() {
        for (program, model) in program(Horizon::Near).axes.iter().zip(MODELS) {
            let AxisModel { position_limit, velocity_limit, angle_limit, rate_limit, acceleration_limit, .. } = model;
            let farthest = 0.435 / 0.45 * position_limit;
            let controls = AxisControls::from_fn(|k, _| 0.01 * k as f64);
            // Each node 10 % farther than the one before.
            let state = |node: usize| [0.1, 0.2, -0.03, 0.004].map(|start| start * 1.1_f64.powi(node as i32));
            let nodes = Nodes::from_fn(|k, _| state(k / 4)[k % 4]);
            let rows = program.rows(&nodes, &controls);
            let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, {expected}");
            for node in 0..BLOCKS {
                let [x, v, q, w] = state(node);
                let expected = [x / farthest, v / (0.95 * velocity_limit), q / angle_limit, w / (0.999 * rate_limit)];
                for (k, expected) in expected.into_iter().enumerate() {
                    close(rows[4 * node + k], expected);
                }
                close(rows[4 * BLOCKS + node], 0.01 * (BLOCKS + node) as f64);
                if node < BLOCKS - 1 {
                    let half = 0.5 * Horizon::Near.durations()[node + 1];
                    close(rows[5 * BLOCKS + node], (x + half * v) / farthest);
                }
            }
            let [x, v, q, w] = state(BLOCKS - 1);
            close(rows[6 * BLOCKS - 1], (x + 0.3 * v) / farthest);
            // The distance to a stop at the limits' rate is rate^2/(2 acceleration).
            close(rows[6 * BLOCKS], (q + w * rate_limit / (2.0 * acceleration_limit)) / angle_limit);
        }
    }

    #[test]
    fn the_normals_are_the_slopes_of_the_rows() {
        let (state, forecast, controls) = example();
        for horizon in [Horizon::Near, Horizon::Far] {
            let program = program(horizon);
            let rows = rows(&program);
            assert_eq!((rows.normals.len(), rows.lower.min(), rows.upper.max()), (ROWS, -1.0, 1.0));
            for (k, axis) in program.axes.iter().enumerate() {
                let free = axis.free_nodes(&data(&state, &forecast));
                let expected =
                    axis.rows(&axis.nodes(&free, &controls), &controls) - axis.rows(&free, &AxisControls::zeros());
                let mut all = SVector::<f64, CONTROLS>::zeros();
                all.fixed_rows_mut::<AXIS_CONTROLS>(k * AXIS_CONTROLS).copy_from(&controls);
                for (number, normal) in rows.normals.iter().enumerate() {
                    let inside = (k * AXIS_ROWS..(k + 1) * AXIS_ROWS).contains(&number);
                    let expected = if inside { expected[number - k * AXIS_ROWS] } else { 0.0 };
                    assert!((normal.dot(&all) - expected).abs() < 1e-12, "row {number} of axis {k}");
                }
                for (node, state) in [(0, 0), (3, 2), (BLOCKS - 1, 0)] {
                    let change = axis.nodes(&Nodes::zeros(), &controls)[4 * node + state];
                    assert!((axis.response(node, state).dot(&controls) - change).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn retuning_is_construction_and_without_a_regulator_changes_nothing() {
        let other = Weights { position: 2.0, ..WEIGHTS };
        let models = [MODELS[1], MODELS[0]];
        let mut programs = Programs::new(&MODELS, &WEIGHTS).unwrap();
        programs.retune(&models, &other);
        assert_eq!(programs, Programs::new(&models, &other).unwrap());
        for horizon in [Horizon::Near, Horizon::Far] {
            assert_eq!(programs.over(horizon).horizon, horizon);
        }
        let before = programs.clone();
        programs.retune(&models, &Weights { position: f64::NAN, ..WEIGHTS });
        assert_eq!(programs, before);
    }
}
