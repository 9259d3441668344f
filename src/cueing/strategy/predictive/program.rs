//! The plan as a quadratic program, condensed: its variables are the dropped force at the nodes and
//! the blocks' tilt accelerations alone.
//!
//! The nodes are the blocks' ends. The dropped force e is linear between them, from the value in
//! force at the start. The tilt's acceleration goes to a block's value alpha+ in a ramp of duration
//! R from the value alpha before. Over a block of duration T, with the reference's mean F and the
//! dropped force e at its beginning and e+ at its end,
//!
//! ```text
//!     x+ = x + v T + F T^2/2 + (2 e + e+) T^2/6 + H A2 - gc (q T^2/2 + w T^3/6 + A4)
//!     v+ = v + F T + (e + e+) T/2 + H A1 - gc (q T + w T^2/2 + A3)
//!     q+ = q + w T + A2,   w+ = w + A1,   Ak = alpha+ T^k/k! + (alpha - alpha+) Rk
//! ```
//!
//! with Rk the ramp from 1 to 0, integrated k times over the block, and gc somewhat below g, the
//! slope of a chord of g sin q. The nodes' states are linear in the start, the reference and the
//! variables. The cost is that of the regulator and weights of both variables' slopes. Its terms
//! are the integrals of their squares and of their slopes' squares, the trapezoidal rule for the
//! motion, and the regulator's cost to come at the end.

use alloc::boxed::Box;

use nalgebra::{Matrix4, SMatrix, SVector, Vector4};
use serde::{Deserialize, Serialize};

use super::dual_active_set::{Rows, Search};
use super::expected::Forecast;
use super::horizon::{BLOCKS, Horizon, margin_ramp};
use super::legs::LegRow;
use crate::cueing::strategy::law::{AxisState, Unsolvable};
use crate::cueing::strategy::regulator::{AxisModel, Regulator, Weights};
use crate::motion::min_max::max;

/// Variables of an axis: dropped forces at the nodes \[m/s2\], then tilt accelerations of the
/// blocks relative to their limit.
pub const AXIS_CONTROLS: usize = 2 * BLOCKS;
/// Variables: those of surge, then those of sway.
pub const CONTROLS: usize = 2 * AXIS_CONTROLS;
/// Rows of an axis: position, velocity, tilt and tilt rate at the nodes, position in the middle of
/// the blocks after the first, tilt acceleration, and two for the end. Tilt and tilt rate are those
/// that [`smooth_tilt`](crate::cueing::strategy::smooth_tilt) approaches.
pub const AXIS_ROWS: usize = 6 * BLOCKS + 1;
/// Rows of the actuators' lengths, six for each node.
pub const LEG_ROWS: usize = 6 * BLOCKS;
/// Rows: those of surge, of sway, and of the actuators.
pub const ROWS: usize = 2 * AXIS_ROWS + LEG_ROWS;

/// States of an axis at the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Nodes(pub(super) SVector<f64, { 4 * BLOCKS }>);

impl Nodes {
    /// At rest at neutral.
    pub fn at_rest() -> Self {
        Nodes(SVector::zeros())
    }

    /// The state at a node. Its tilt acceleration is that of the controls, and zero here.
    #[inline(always)]
    pub fn at(&self, node: usize) -> AxisState {
        let [position, velocity, tilt, tilt_rate] = self.0.fixed_rows::<4>(4 * node).into_owned().into();
        AxisState { position, velocity, tilt, tilt_rate, tilt_acceleration: 0.0 }
    }
}

/// The start's four, its dropped force and tilt acceleration, the reference's means, and its slow
/// and fast part at the end.
pub type Data = SVector<f64, DATA>;
const DATA: usize = BLOCKS + 8;
/// The start's dropped force, its tilt acceleration relative to the limit, and the first mean among
/// the data.
const DROPPED_INDEX: usize = 4;
const TILTING_INDEX: usize = 5;
const MEANS_INDEX: usize = 6;
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
pub const GRAVITY_ALONG_TILT: f64 = 0.985;
/// A small weight of tilt acceleration keeps the program strictly convex.
const LEAST_TILT_ACCELERATION_WEIGHT: f64 = 1e-5;
/// Weight of the dropped force's slope, relative to that of the dropped force \[s2\].
const SLOPE_WEIGHT: f64 = 6e-2;
/// Weights of position and velocity over the far horizon, relative to those over the near one.
const FAR_WEIGHTS: [f64; 2] = [0.25, 0.043];
/// Time in which the tilt's acceleration goes from one block's value to the next \[s\].
pub const TILT_RAMP_TIME: f64 = 0.04;
/// Weight of the slope of the tilt's acceleration, relative to that of the dropped force, with the
/// acceleration relative to its limit \[s2\].
const TILT_SLOPE_WEIGHT: f64 = 1e-5;

/// The programs over both horizons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Programs {
    pub near: Program,
    pub far: Program,
}

impl Programs {
    /// Both programs.
    ///
    /// # Errors
    /// There is no regulator for these weights, or the program is not convex.
    pub fn new(models: &[AxisModel; 2], weights: &Weights) -> Result<Self, Unsolvable> {
        let program = |horizon| Program::new(models, weights, horizon);
        Ok(Programs { near: program(Horizon::Near)?, far: program(Horizon::Far)? })
    }

    /// Replaces both by those for other models or weights.
    ///
    /// # Errors
    /// As [`Programs::new`]. Nothing has changed then.
    pub fn retune(&mut self, models: &[AxisModel; 2], weights: &Weights) -> Result<(), Unsolvable> {
        // In place of the old ones, because a change of parameters allocates nothing.
        let axis = |horizon, axis: usize| AxisProgram::new(&models[axis], weights, horizon);
        let axes = |horizon| Ok([axis(horizon, 0)?, axis(horizon, 1)?]);
        let (near, far) = (axes(Horizon::Near)?, axes(Horizon::Far)?);
        self.near.replace(&near);
        self.far.replace(&far);
        Ok(())
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
    /// L^-T of the Hessian L L' of both axes.
    pub factor: Box<SMatrix<f64, CONTROLS, CONTROLS>>,
}

impl Program {
    /// The program of both axes.
    ///
    /// # Errors
    /// As [`Programs::new`].
    pub fn new(models: &[AxisModel; 2], weights: &Weights, horizon: Horizon) -> Result<Self, Unsolvable> {
        let axis = |axis: usize| AxisProgram::new(&models[axis], weights, horizon).map(Box::new);
        let mut program = Program { horizon, axes: [axis(0)?, axis(1)?], factor: Box::new(SMatrix::zeros()) };
        program.join_factors();
        Ok(program)
    }

    fn replace(&mut self, axes: &[AxisProgram; 2]) {
        for (axis, new) in self.axes.iter_mut().zip(axes) {
            (**axis).clone_from(new);
        }
        self.join_factors();
    }

    fn join_factors(&mut self) {
        for (k, axis) in self.axes.iter().enumerate() {
            let begin = k * AXIS_CONTROLS;
            self.factor.fixed_view_mut::<AXIS_CONTROLS, AXIS_CONTROLS>(begin, begin).copy_from(&axis.factor);
        }
    }
}

/// The weights over a horizon. Travel is dear because something unforeseen may need it. Over the
/// far horizon the force is known, and travel is cheap.
fn over_horizon(weights: &Weights, horizon: Horizon) -> Weights {
    let [of_position, of_velocity] = match horizon {
        Horizon::Near => [1.0; 2],
        Horizon::Far => FAR_WEIGHTS,
    };
    let Weights { position, velocity, tilt_rate, tilt_acceleration, slow_pole, fast_pole } = *weights;
    let (position, velocity) = (of_position * position, of_velocity * velocity);
    Weights { position, velocity, tilt_rate, tilt_acceleration, slow_pole, fast_pole }
}

/// One axis of the program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisProgram {
    model: AxisModel,
    horizon: Horizon,
    from_data: SMatrix<f64, { 4 * BLOCKS }, DATA>,
    /// By node and control: how a unit of the control moves the node.
    effects: [[[f64; 4]; AXIS_CONTROLS]; BLOCKS],
    gradient: SMatrix<f64, AXIS_CONTROLS, DATA>,
    hessian: SMatrix<f64, AXIS_CONTROLS, AXIS_CONTROLS>,
    /// L^-T of the Hessian L L'.
    factor: SMatrix<f64, AXIS_CONTROLS, AXIS_CONTROLS>,
    scales: RowScales,
}

/// Factors by which motions are relative to their limits in the rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct RowScales {
    /// Of the position at each node, and in the middle of the block before it.
    positions: [f64; BLOCKS],
    middles: [f64; BLOCKS],
    velocity: f64,
    /// Of tilt, tilt rate and tilt acceleration in the row of the tilt.
    tilt: [f64; 3],
    /// Of tilt rate and tilt acceleration in the row of the tilt rate.
    tilt_rate: [f64; 2],
    /// Of tilt and tilt rate at the end.
    end_tilt: [f64; 2],
}

impl RowScales {
    fn new(model: &AxisModel, horizon: Horizon) -> Self {
        let AxisModel { position_limit, velocity_limit, angle_limit, rate_limit, acceleration_limit, .. } = *model;
        let (ends, durations) = (horizon.ends(), horizon.durations());
        let position = |time| 1.0 / (position_limit * (1.0 - margin_ramp(time) * (1.0 - POSITION_FRACTION)));
        let limits = model.tilt_limits();
        // What the tilt approaches is linear in its state.
        let [by_tilt, by_rate, by_acceleration] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, acceleration_limit]]
            .map(|[q, w, a]| limits.approached(q, w, a));
        let rate_scale = 1.0 / (RATE_FRACTION * rate_limit);
        RowScales {
            positions: ends.map(position),
            middles: core::array::from_fn(|node| position(ends[node] - 0.5 * durations[node])),
            velocity: 1.0 / (VELOCITY_FRACTION * velocity_limit),
            tilt: [by_tilt[0], by_rate[0], by_acceleration[0]].map(|value| value / angle_limit),
            tilt_rate: [by_rate[1], by_acceleration[1]].map(|value| value * rate_scale),
            end_tilt: [1.0, 0.5 * rate_limit / acceleration_limit].map(|value| value / angle_limit),
        }
    }
}

impl AxisProgram {
    /// The program of an axis.
    ///
    /// # Errors
    /// As [`Programs::new`].
    pub fn new(model: &AxisModel, weights: &Weights, horizon: Horizon) -> Result<Self, Unsolvable> {
        let weights = &over_horizon(weights, horizon);
        let regulator = Regulator::new(model, weights)?;
        let from_data = responses(model, horizon, |data: &Data| (*data, AxisControls::zeros()));
        let from_controls = responses(model, horizon, |controls: &AxisControls| (Data::zeros(), *controls));
        let mut weighted = SMatrix::<f64, { 4 * BLOCKS }, AXIS_CONTROLS>::zeros();
        for node in 0..BLOCKS {
            let weight = node_weight(model, weights, &regulator, horizon, node);
            let states = weight * from_controls.fixed_rows::<4>(4 * node);
            weighted.fixed_rows_mut::<4>(4 * node).copy_from(&states);
        }
        let mut hessian = from_controls.tr_mul(&weighted);
        let mut gradient = weighted.tr_mul(&from_data);
        let tilting = weights.tilt_acceleration + LEAST_TILT_ACCELERATION_WEIGHT;
        let dropped_square = |duration: f64| {
            let (square, slope) = (duration / 6.0, SLOPE_WEIGHT / duration);
            [2.0 * square + slope, square - slope, 2.0 * square + slope]
        };
        let tilt_square = |duration: f64| {
            let (square, slope) = (tilting * TILT_RAMP_TIME / 6.0, TILT_SLOPE_WEIGHT / TILT_RAMP_TIME);
            [2.0 * square + slope, square - slope, 2.0 * square + slope + tilting * (duration - TILT_RAMP_TIME)]
        };
        for (block, &duration) in horizon.durations().iter().enumerate() {
            for (first, start, [before, mixed, after]) in
                [(0, DROPPED_INDEX, dropped_square(duration)), (BLOCKS, TILTING_INDEX, tilt_square(duration))]
            {
                let node = first + block;
                hessian[(node, node)] += after;
                if block == 0 {
                    gradient[(node, start)] += mixed;
                } else {
                    hessian[(node - 1, node - 1)] += before;
                    hessian[(node - 1, node)] += mixed;
                    hessian[(node, node - 1)] += mixed;
                }
            }
        }
        let end_to_end = regulator.cost.fixed_view::<4, 2>(0, 4);
        let end = from_controls.fixed_rows::<4>(4 * (BLOCKS - 1)).tr_mul(&end_to_end);
        gradient.fixed_columns_mut::<2>(DATA - 2).copy_from(&end);
        let mut inverse = SMatrix::<f64, AXIS_CONTROLS, AXIS_CONTROLS>::identity();
        let cholesky = hessian.cholesky().ok_or(Unsolvable::Program)?;
        let solved = cholesky.l_dirty().solve_lower_triangular_mut(&mut inverse);
        let factor = inverse.transpose();
        let scales = RowScales::new(model, horizon);
        // Filled in place: another copy of it would be 4 kB of stack.
        let effects = [[[0.0; 4]; AXIS_CONTROLS]; BLOCKS];
        let mut program = AxisProgram { model: *model, horizon, from_data, effects, gradient, hessian, factor, scales };
        for (control, column) in from_controls.column_iter().enumerate() {
            for (node, effects) in program.effects.iter_mut().enumerate() {
                effects[control].copy_from_slice(&column.as_slice()[4 * node..4 * node + 4]);
            }
        }
        solved.then_some(program).ok_or(Unsolvable::Program)
    }

    /// The nodes without any control.
    pub fn free_nodes(&self, data: &Data) -> Nodes {
        let AxisProgram { from_data, .. } = self;
        Nodes(from_data * data)
    }

    /// The nodes under these controls.
    pub fn nodes(&self, free: &Nodes, controls: &AxisControls) -> Nodes {
        let controls = controls.data.0[0];
        let mut nodes = *free;
        for (node, state) in nodes.0.as_mut_slice().as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let moved = self.moved(node, &controls);
            *state = core::array::from_fn(|k| state[k] + moved[k]);
        }
        nodes
    }

    /// The state at a node after these controls from rest at neutral.
    #[inline(always)]
    fn moved(&self, node: usize, controls: &[f64; AXIS_CONTROLS]) -> [f64; 4] {
        let mut state = [0.0; 4];
        let (by_dropped, by_tilting) = self.effects[node].split_at(BLOCKS);
        let (dropped, tilting) = controls.split_at(BLOCKS);
        let effects = by_dropped.iter().zip(dropped).zip(by_tilting.iter().zip(tilting));
        // A control moves the nodes from the end of its block on.
        for ((by_dropped, dropped), (by_tilting, tilting)) in effects.take(node + 1) {
            for k in 0..4 {
                state[k] = state[k] + dropped * by_dropped[k] + tilting * by_tilting[k];
            }
        }
        state
    }

    /// The gradient of the cost without any control.
    pub fn gradient(&self, data: &Data) -> AxisControls {
        let AxisProgram { gradient, .. } = self;
        gradient * data
    }

    /// Matrix of the cost's quadratic part.
    pub fn hessian(&self) -> &SMatrix<f64, AXIS_CONTROLS, AXIS_CONTROLS> {
        &self.hessian
    }

    /// The values of the axis's rows, all of which lie within -1 and 1.
    pub fn rows(&self, nodes: &Nodes, controls: &AxisControls) -> SVector<f64, AXIS_ROWS> {
        let mut rows = SVector::<f64, AXIS_ROWS>::zeros();
        let mut before = [0.0; 4];
        for (node, state) in nodes.0.as_slice().as_chunks::<4>().0.iter().enumerate() {
            self.visit_rows(node, [&before, state], controls[BLOCKS + node], |row, value| rows[row] = value);
            before = *state;
        }
        rows
    }

    /// Visits the rows of a node, in this state after that of the node before: position, velocity,
    /// tilt, tilt rate, and the relative tilt acceleration in the block between them. After the
    /// first node also the position in the middle of the block, and after the last one the position
    /// and the tilt with which the platform can stop.
    #[inline(always)]
    fn visit_rows(&self, node: usize, states: [&[f64; 4]; 2], tilting: f64, mut visit: impl FnMut(usize, f64)) {
        for kind in 0..4 {
            visit(4 * node + kind, self.row(kind, node, states, tilting));
        }
        visit(4 * BLOCKS + node, self.row(4, node, states, tilting));
        if node > 0 {
            visit(5 * BLOCKS + node - 1, self.row(5, node, states, tilting));
        }
        if node == BLOCKS - 1 {
            visit(AXIS_ROWS - 2, self.row(6, node, states, tilting));
            visit(AXIS_ROWS - 1, self.row(7, node, states, tilting));
        }
    }

    /// The value of a node's row of this kind, by the order in [`AxisProgram::visit_rows`].
    #[inline(always)]
    fn row(&self, kind: usize, node: usize, [before, now]: [&[f64; 4]; 2], tilting: f64) -> f64 {
        let (scales, [x, v, q, w]) = (&self.scales, now);
        match kind {
            0 => scales.positions[node] * x,
            1 => scales.velocity * v,
            2 => scales.tilt[0] * q + scales.tilt[1] * w + scales.tilt[2] * tilting,
            3 => scales.tilt_rate[0] * w + scales.tilt_rate[1] * tilting,
            4 => tilting,
            5 => scales.middles[node] * self.middle(before, now, node, tilting),
            6 => scales.positions[node] * (x + STOPPING_TIME * v),
            _ => scales.end_tilt[0] * q + scales.end_tilt[1] * w,
        }
    }

    /// Sets how a row depends on the controls. `normal` is zero before.
    fn set_normal(&self, row: usize, normal: &mut [f64]) {
        let (kind, node) = match row {
            row if row < 4 * BLOCKS => (row % 4, row / 4),
            row if row < 5 * BLOCKS => (4, row - 4 * BLOCKS),
            row if row < AXIS_ROWS - 2 => (5, row - 5 * BLOCKS + 1),
            _ => (row + 8 - AXIS_ROWS, BLOCKS - 1),
        };
        let [before, now] = [node.max(1) - 1, node].map(|node| self.effects[node].iter());
        for (k, ((before, now), value)) in before.zip(now).zip(normal).enumerate() {
            let tilting = if k == BLOCKS + node { 1.0 } else { 0.0 };
            *value = self.row(kind, node, [before, now], tilting);
        }
    }
}

/// Part by which a tilt or its rate has to be beyond its limit for the rows to give way.
const GIVE_WAY_PART: f64 = 0.01;
/// Times after which a tilt and its rate return to their limits \[s\], with half of what the limits
/// of rate and acceleration allow.
const TURN_TIMES: [f64; 2] = [0.3, 0.1];
const RETURN_PART: f64 = 0.5;

impl AxisProgram {
    /// Bound of each row's magnitude: 1, and as much more at the nodes of a tilt that is beyond new
    /// limits as it needs for its way back.
    pub fn bounds(&self, state: &AxisState) -> SVector<f64, AXIS_ROWS> {
        let AxisModel { angle_limit, rate_limit, acceleration_limit, .. } = self.model;
        let mut bounds = SVector::repeat(1.0);
        let AxisState { tilt, tilt_rate, tilt_acceleration, .. } = *state;
        let approached = self.model.tilt_limits().approached(tilt, tilt_rate, tilt_acceleration);
        let angle = max(approached[0].abs(), tilt.abs()) / angle_limit;
        let rate = max(approached[1].abs(), tilt_rate.abs()) / (RATE_FRACTION * rate_limit);
        let returns = [(2, angle, rate_limit / angle_limit), (3, rate, acceleration_limit / rate_limit)];
        for ((row, beyond, fastest), turn_time) in returns.into_iter().zip(TURN_TIMES) {
            if beyond <= 1.0 + GIVE_WAY_PART {
                continue;
            }
            for (node, time) in self.horizon.ends().into_iter().enumerate() {
                let returned = RETURN_PART * fastest * max(time - turn_time, 0.0);
                bounds[4 * node + row] = max(beyond + GIVE_WAY_PART - returned, 1.0);
            }
        }
        bounds[AXIS_ROWS - 1] = bounds[4 * (BLOCKS - 1) + 2];
        bounds
    }

    /// Position in the middle of a block after the first, between the nodes before and after it.
    /// `tilting` is the block's tilt acceleration, relative to its limit.
    ///
    /// The position is that of the cubic through the nodes, and by the tilt acceleration a term of
    /// fourth order less. The ramp's part of that is left out.
    #[inline(always)]
    pub(super) fn middle(
        &self,
        [x, v, ..]: &[f64; 4],
        [next_x, next_v, ..]: &[f64; 4],
        block: usize,
        tilting: f64,
    ) -> f64 {
        let t = self.horizon.durations()[block];
        let AxisModel { gravity, acceleration_limit, .. } = self.model;
        let cubic = 0.5 * (x + next_x) + 0.125 * t * (v - next_v);
        cubic - GRAVITY_ALONG_TILT * gravity * acceleration_limit * tilting * (t * t * (t * t)) / 384.0
    }
}

impl AxisProgram {
    /// Initial state of the program, with the dropped force in force \[m/s2\].
    pub fn data(&self, state: &AxisState, dropped_force: f64, forecast: &Forecast) -> Data {
        let tilting = state.tilt_acceleration / self.model.acceleration_limit;
        let start = [state.position, state.velocity, state.tilt, state.tilt_rate, dropped_force, tilting];
        Data::from_fn(|k, _| match k {
            0..MEANS_INDEX => start[k],
            k if k < DATA - 2 => forecast.means[k - MEANS_INDEX],
            k => forecast.end[k + 2 - DATA],
        })
    }
}

/// A ramp from 1 to 0 over [`TILT_RAMP_TIME`], once to four times integrated over a block.
fn ramp_integrals(duration: f64) -> [f64; 4] {
    let (ramp, after) = (TILT_RAMP_TIME, duration - TILT_RAMP_TIME);
    let square = ramp * ramp;
    [
        ramp / 2.0,
        square / 3.0 + ramp / 2.0 * after,
        ramp * square / 8.0 + square / 3.0 * after + ramp / 4.0 * after * after,
        square * square / 30.0
            + ramp * square / 8.0 * after
            + square / 6.0 * after * after
            + ramp / 12.0 * (after * after * after),
    ]
}

/// The nodes' response to one unit of each argument.
fn responses<const K: usize>(
    model: &AxisModel,
    horizon: Horizon,
    split: impl Fn(&SVector<f64, K>) -> (Data, AxisControls),
) -> SMatrix<f64, { 4 * BLOCKS }, K> {
    let mut responses = SMatrix::<f64, { 4 * BLOCKS }, K>::zeros();
    for k in 0..K {
        let mut unit = SVector::<f64, K>::zeros();
        unit[k] = 1.0;
        let (data, controls) = split(&unit);
        responses.set_column(k, &rolled_out(model, horizon, &data, &controls).0);
    }
    responses
}

/// The nodes that follow from a start, a reference and controls.
fn rolled_out(model: &AxisModel, horizon: Horizon, data: &Data, controls: &AxisControls) -> Nodes {
    let mut nodes = Nodes::at_rest();
    let [mut x, mut v, mut q, mut w] = [data[0], data[1], data[2], data[3]];
    let gravity = GRAVITY_ALONG_TILT * model.gravity;
    let (mut dropped, mut alpha) = (data[DROPPED_INDEX], model.acceleration_limit * data[TILTING_INDEX]);
    for (block, &t) in horizon.durations().iter().enumerate() {
        let (next_dropped, next_alpha) = (controls[block], model.acceleration_limit * controls[BLOCKS + block]);
        // The tilt's acceleration, less its value after the ramp, once to four times integrated.
        let [by1, by2, by3, by4] = ramp_integrals(t).map(|integral| (alpha - next_alpha) * integral);
        let turned = next_alpha * t + by1;
        let turned_twice = next_alpha * t * t / 2.0 + by2;
        // The tilt's first and second integral over the block.
        let once = t * (q + t * (w / 2.0 + t * next_alpha / 6.0)) + by3;
        let twice = t * t * (q / 2.0 + t * (w / 6.0 + t * next_alpha / 24.0)) + by4;
        let mean = data[MEANS_INDEX + block];
        let dropped_once = t * (dropped + next_dropped) / 2.0;
        let dropped_twice = t * t * (2.0 * dropped + next_dropped) / 6.0;
        x += t * v + t * t * mean / 2.0 + dropped_twice + model.head_height * turned_twice - gravity * twice;
        v += t * mean + dropped_once + model.head_height * turned - gravity * once;
        (q, w) = (q + t * w + turned_twice, w + turned);
        (dropped, alpha) = (next_dropped, next_alpha);
        nodes.0.fixed_rows_mut::<4>(4 * block).copy_from(&Vector4::new(x, v, q, w));
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
    let [position, velocity, rate] =
        [model.position_limit, model.velocity_limit, model.rate_limit].map(|limit| limit * limit);
    let state_weights =
        Vector4::new(weights.position / position, weights.velocity / velocity, 0.0, weights.tilt_rate / rate);
    let running = Matrix4::from_diagonal(&(time * state_weights));
    if last { running + regulator.cost.fixed_view::<4, 4>(0, 0) } else { running }
}

/// Bounds of a plan's rows, and the legs near the plan before, in halves of the stroke.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanLimits {
    pub lower: SVector<f64, ROWS>,
    pub upper: SVector<f64, ROWS>,
    pub legs: [[LegRow; 6]; BLOCKS],
}

impl Default for PlanLimits {
    fn default() -> Self {
        let legs = [[LegRow::default(); 6]; BLOCKS];
        PlanLimits { lower: SVector::repeat(-1.0), upper: SVector::repeat(1.0), legs }
    }
}

/// The rows of a plan, as functions of its controls.
#[derive(Clone, Copy, Debug)]
pub struct PlanRows<'a> {
    pub program: &'a Program,
    pub limits: &'a PlanLimits,
}

impl Rows<CONTROLS, ROWS> for PlanRows<'_> {
    fn evaluate(&self, controls: &SVector<f64, CONTROLS>, search: &mut Search<ROWS>) {
        let controls = controls.as_slice().as_chunks::<AXIS_CONTROLS>().0;
        let mut before = [[0.0; 4]; 2];
        for (node, legs) in self.limits.legs.iter().enumerate() {
            let axes = self.program.axes.iter().zip(controls).zip(&mut before).enumerate();
            for (k, ((axis, controls), before)) in axes {
                let state = axis.moved(node, controls);
                axis.visit_rows(node, [before, &state], controls[BLOCKS + node], |row, value| {
                    search.see(k * AXIS_ROWS + row, value);
                });
                *before = state;
            }
            let [surge, sway] = &before;
            for (leg, row) in legs.iter().enumerate() {
                search.see(2 * AXIS_ROWS + 6 * node + leg, row.change([surge[0], sway[0]], [surge[2], sway[2]]));
            }
        }
    }

    fn set_normal(&self, row: usize, normal: &mut SVector<f64, CONTROLS>) {
        let axes = self.program.axes.iter().zip(normal.as_mut_slice().chunks_exact_mut(AXIS_CONTROLS)).enumerate();
        for (k, (axis, normal)) in axes {
            if let Some(leg) = row.checked_sub(2 * AXIS_ROWS) {
                let (node, row) = (leg / 6, &self.limits.legs[leg / 6][leg % 6]);
                for (value, [position, _, tilt, _]) in normal.iter_mut().zip(&axis.effects[node]) {
                    *value = row.by_position[k] * position + row.by_tilt[k] * tilt;
                }
            } else if row / AXIS_ROWS == k {
                axis.set_normal(row % AXIS_ROWS, normal);
            }
        }
    }

    fn bounds(&self) -> [&SVector<f64, ROWS>; 2] {
        [&self.limits.lower, &self.limits.upper]
    }
}

#[cfg(test)]
mod tests {
    use super::super::dual_active_set::tests::{DenseRows, most_violated};
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

    /// The dropped force in force at the start \[m/s2\].
    const DROPPED_BEFORE: f64 = -0.6;

    /// A state, a forecast and controls with a part of everything.
    fn example() -> (AxisState, Forecast, AxisControls) {
        let state = AxisState { position: 0.1, velocity: -0.2, tilt: 0.05, tilt_rate: 0.01, tilt_acceleration: 0.07 };
        let forecast = Forecast { means: SVector::from_fn(|k, _| 0.5 - 0.3 * k as f64), end: [0.7, -0.4] };
        (state, forecast, AxisControls::from_fn(|k, _| (1.0 + k as f64).sin()))
    }

    /// The integral of the weighted squares by the trapezoidal rule, and the
    /// regulator's cost to come.
    fn cost(axis: &AxisProgram, state: &AxisState, forecast: &Forecast, controls: &AxisControls) -> f64 {
        let model = &axis.model;
        let [position, velocity] = if axis.horizon == Horizon::Far { [0.25, 0.043] } else { [1.0; 2] };
        let weights =
            Weights { position: position * WEIGHTS.position, velocity: velocity * WEIGHTS.velocity, ..WEIGHTS };
        let running = |state: &[f64]| {
            weights.position * (state[0] / model.position_limit).powi(2)
                + weights.velocity * (state[1] / model.velocity_limit).powi(2)
                + WEIGHTS.tilt_rate * (state[3] / model.rate_limit).powi(2)
        };
        let nodes = axis.nodes(&axis.free_nodes(&axis.data(state, DROPPED_BEFORE, forecast)), controls);
        let mut before = vec![state.position, state.velocity, state.tilt, state.tilt_rate];
        let mut cost = 0.0;
        let (mut dropped_before, mut tilting_before) =
            (DROPPED_BEFORE, state.tilt_acceleration / model.acceleration_limit);
        for (block, &duration) in axis.horizon.durations().iter().enumerate() {
            let after = nodes.0.as_slice()[4 * block..4 * block + 4].to_vec();
            let (dropped, tilting) = (controls[block], controls[BLOCKS + block]);
            // Simpson's rule is exact for the square of a line.
            let middle = 0.5 * (dropped_before + dropped);
            cost += duration / 6.0 * (dropped_before.powi(2) + 4.0 * middle * middle + dropped * dropped);
            cost += SLOPE_WEIGHT * (dropped - dropped_before).powi(2) / duration;
            // The tilt's acceleration is a line on the ramp and constant after it.
            let middle = 0.5 * (tilting_before + tilting);
            let ramp = TILT_RAMP_TIME / 6.0 * (tilting_before.powi(2) + 4.0 * middle * middle + tilting * tilting);
            cost += (WEIGHTS.tilt_acceleration + 1e-5) * (ramp + (duration - TILT_RAMP_TIME) * tilting * tilting);
            cost += TILT_SLOPE_WEIGHT * (tilting - tilting_before).powi(2) / TILT_RAMP_TIME;
            (dropped_before, tilting_before) = (dropped, tilting);
            cost += 0.5 * duration * (running(&before) + running(&after));
            before = after;
        }
        before.extend(forecast.end);
        let end = SVector::<f64, 6>::from_column_slice(&before);
        let to_come = Regulator::new(model, &weights).unwrap().cost;
        0.5 * (cost + end.dot(&(to_come * end)))
    }

    #[test]
    fn data_are_the_start_the_means_and_the_end() {
        let (state, forecast, _) = example();
        let AxisState { position, velocity, tilt, tilt_rate, tilt_acceleration } = state;
        for (axis, model) in program(Horizon::Near).axes.iter().zip(MODELS) {
            let tilting = tilt_acceleration / model.acceleration_limit;
            let mut expected = vec![position, velocity, tilt, tilt_rate, DROPPED_BEFORE, tilting];
            expected.extend(forecast.means.iter().chain(&forecast.end));
            assert_eq!(axis.data(&state, DROPPED_BEFORE, &forecast).as_slice(), expected);
        }
    }

    #[test]
    fn the_cost_is_that_of_the_regulator() {
        let (state, forecast, controls) = example();
        for horizon in [Horizon::Near, Horizon::Far] {
            for axis in &program(horizon).axes {
                let gradient = axis.gradient(&axis.data(&state, DROPPED_BEFORE, &forecast));
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
            // The margin grows over 0.2 s, in which there are three nodes and two middles.
            let farthest = |part: f64| (1.0 - part * 0.015 / 0.45) * position_limit;
            let at_nodes = [0.2, 0.5, 1.0].into_iter().chain(std::iter::repeat(1.0));
            let in_middles = [0.35, 0.75].into_iter().chain(std::iter::repeat(1.0));
            let controls = AxisControls::from_fn(|k, _| 0.01 * k as f64);
            // Each node 10 % farther than the one before.
            let state = |node: usize| [0.1, 0.2, -0.03, 0.004].map(|start| start * 1.1_f64.powi(node as i32));
            let nodes = Nodes(SVector::from_fn(|k, _| state(k / 4)[k % 4]));
            let rows = program.rows(&nodes, &controls);
            let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, {expected}");
            for ((node, at_node), in_middle) in (0..BLOCKS).zip(at_nodes).zip(in_middles) {
                let [x, v, q, w] = state(node);
                let tilting = acceleration_limit * 0.01 * (BLOCKS + node) as f64;
                let [q, w] = program.model.tilt_limits().approached(q, w, tilting);
                let expected =
                    [x / farthest(at_node), v / (0.95 * velocity_limit), q / angle_limit, w / (0.999 * rate_limit)];
                for (k, expected) in expected.into_iter().enumerate() {
                    close(rows[4 * node + k], expected);
                }
                close(rows[4 * BLOCKS + node], 0.01 * (BLOCKS + node) as f64);
                if node < BLOCKS - 1 {
                    let t = Horizon::Near.durations()[node + 1];
                    let [next_x, next_v, ..] = state(node + 1);
                    let alpha = acceleration_limit * 0.01 * (BLOCKS + node + 1) as f64;
                    let gravity = GRAVITY_ALONG_TILT * model.gravity;
                    let middle = 0.5 * (x + next_x) + t / 8.0 * (v - next_v) - gravity * alpha * t.powi(4) / 384.0;
                    close(rows[5 * BLOCKS + node], middle / farthest(in_middle));
                }
            }
            let [x, v, q, w] = state(BLOCKS - 1);
            close(rows[6 * BLOCKS - 1], (x + 0.3 * v) / farthest(1.0));
            // The distance to a stop at the limits' rate is rate^2/(2 acceleration).
            close(rows[6 * BLOCKS], (q + w * rate_limit / (2.0 * acceleration_limit)) / angle_limit);
        }
    }

    #[test]
    fn the_normals_are_the_slopes_of_the_rows() {
        let (state, forecast, controls) = example();
        for horizon in [Horizon::Near, Horizon::Far] {
            let program = program(horizon);
            let mut limits = PlanLimits::default();
            limits.legs[3][2] = LegRow { offset: 0.2, by_position: [0.5, -0.7], by_tilt: [0.9, -0.3] };
            let normals = |limits: &PlanLimits| DenseRows::of(&PlanRows { program: &program, limits }).normals;
            for (k, axis) in program.axes.iter().enumerate() {
                let free = axis.free_nodes(&axis.data(&state, DROPPED_BEFORE, &forecast));
                let expected =
                    axis.rows(&axis.nodes(&free, &controls), &controls) - axis.rows(&free, &AxisControls::zeros());
                let mut all = SVector::<f64, CONTROLS>::zeros();
                all.fixed_rows_mut::<AXIS_CONTROLS>(k * AXIS_CONTROLS).copy_from(&controls);
                let change = axis.nodes(&Nodes::at_rest(), &controls).at(3);
                let leg = [0.5, -0.7][k] * change.position + [0.9, -0.3][k] * change.tilt;
                for (row, normal) in normals(&limits).iter().enumerate() {
                    let expected = match row.checked_sub(k * AXIS_ROWS) {
                        Some(row) if row < AXIS_ROWS => expected[row],
                        _ if row == 2 * AXIS_ROWS + 6 * 3 + 2 => leg,
                        _ => 0.0,
                    };
                    assert!((normal.dot(&all) - expected).abs() < 1e-12, "row {row} of axis {k}");
                }
            }
            // The search sees each row's value: the normal times the controls.
            let all = SVector::<f64, CONTROLS>::from_fn(|k, _| (2.0 + k as f64).cos());
            for (row, normal) in normals(&limits).iter().enumerate() {
                for (side, beyond) in [(1.0, true), (1.0, false), (-1.0, true), (-1.0, false)] {
                    let bound = normal.dot(&all) + if beyond { -side } else { side } * 1e-9;
                    (limits.lower, limits.upper) = (SVector::repeat(-1e9), SVector::repeat(1e9));
                    *(if side > 0.0 { &mut limits.upper[row] } else { &mut limits.lower[row] }) = bound;
                    let found = most_violated(&PlanRows { program: &program, limits: &limits }, &all);
                    assert_eq!(found, beyond.then_some(row), "side {side}");
                }
            }
        }
    }

    #[test]
    fn retuning_is_construction_and_without_a_regulator_changes_nothing() {
        let other = Weights { position: 2.0, ..WEIGHTS };
        let models = [MODELS[1], MODELS[0]];
        let mut programs = Programs::new(&MODELS, &WEIGHTS).unwrap();
        programs.retune(&models, &other).unwrap();
        assert_eq!(programs, Programs::new(&models, &other).unwrap());
        for horizon in [Horizon::Near, Horizon::Far] {
            assert_eq!(programs.over(horizon).horizon, horizon);
        }
        let before = programs.clone();
        let refused = programs.retune(&models, &Weights { position: f64::NAN, ..WEIGHTS });
        assert_eq!(refused, Err(Unsolvable::RiccatiEquation));
        assert_eq!(programs, before);
    }
}
