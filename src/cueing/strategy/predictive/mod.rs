//! The predictive strategy: a plan of surge, sway and tilt over the next seconds, made
//! anew 50 times a second.
//!
//! A plan is the solution of a quadratic [`program`] over the blocks of a [`horizon`]. The plan has
//! the least dropped force for the reference that is [`forecast`]. Travel, tilt and the actuators'
//! lengths ([`legs`]) stay within their limits. The [`dual_active_set`] method solves it a few
//! iterations at a time, so that no internal step takes long.
//!
//! A plan sets the dropped force and the tilt's acceleration. The rest follows from the input
//! without delay: see [`coordinated`](super::coordinated).

pub mod dual_active_set;
pub mod expected;
pub mod forecast;
pub mod horizon;
mod idle_return;
pub mod legs;
pub mod preview;
pub mod program;
#[cfg(test)]
mod tests;

use alloc::boxed::Box;

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use self::dual_active_set::{DualActiveSet, Status};
use self::forecast::{Forecaster, Memory, Tables};
use self::horizon::{BLOCKS, Horizon, PLAN_INTERVAL, margin_ramp};
use self::idle_return::IdleReturn;
use self::legs::{LARGEST_HEAVE, LegContext, leg_rows};
use self::preview::{PreviewedCue, TIME_ROUNDING};
use self::program::{
    AXIS_CONTROLS, AXIS_ROWS, AxisControls, CONTROLS, Nodes, PlanLimits, PlanRows, Programs, ROWS, TILT_RAMP_TIME,
};
use super::law::{AxisState, Decision, Law, LawInput, PlanStatus, Previewing, Unsolvable};
use super::regulator::{AxisModel, Weights};
use crate::filter::bumpless::{GlidingOffset, glide_by_logarithms};
use crate::interface::{ForecastKind, Parameters, PredictiveParameters};

/// Iterations of an internal step of up to [`REFERENCE_STEP`] seconds; longer steps
/// do more in proportion.
const ITERATIONS_PER_STEP: f64 = 8.0;
const REFERENCE_STEP: f64 = 0.001;
/// Length of a preview below which nothing counts as known: the host's own step may be one \[s\].
const SHORTEST_PREVIEW: f64 = 0.1;
/// Length of a preview above which the far horizon is used \[s\].
const LONG_PREVIEW: f64 = 2.0;
/// A plan that takes more iterations is abandoned.
const MAX_ITERATIONS: u32 = 120;
/// Largest slope of the dropped force \[m/s3\]: half a m/s2 is felt of it within 20 ms. Where rows
/// hardly leave a solution, a plan may change by tens of m/s2. What it then misses, the soft limits
/// keep.
const MAX_DROPPED_SLOPE: f64 = 25.0;

/// The tunable parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tuning {
    pub weights: Weights,
    pub forecast: ForecastKind,
    pub memory: Memory,
}

/// The strategy with its state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Predictive {
    models: [AxisModel; 2],
    tuning: Tuning,
    tables: Box<Tables>,
    forecasters: [Box<Forecaster>; 2],
    until_sample: f64,
    programs: Programs,
    limits: Box<PlanLimits>,
    solver: Box<DualActiveSet<CONTROLS, ROWS>>,
    /// True: a new plan is due.
    due: bool,
    /// Horizon of the plan that is being made, its nodes without control, and the time since it was
    /// begun \[s\].
    horizon: Horizon,
    free: [Nodes; 2],
    begun: f64,
    plan: Plan,
    /// Dropped forces in force \[m/s2\]. Each goes linearly from node to node of the plan, at most
    /// at [`MAX_DROPPED_SLOPE`].
    dropped_forces: [f64; 2],
    idle_return: [IdleReturn; 2],
    /// Logarithms of the weights and poles in force less those set.
    glide: GlidingOffset<GLIDING_COUNT>,
    /// Time until the programs follow the glide again \[s\].
    until_followed: f64,
}

/// Time from one change of the programs to the next while the weights glide \[s\].
const FOLLOW_TIME: f64 = 0.06;

/// A plan, and how far it has been carried out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    controls: [AxisControls; 2],
    nodes: [Nodes; 2],
    horizon: Horizon,
    /// Time since the plan was begun \[s\].
    pub age: f64,
    /// Iterations that it took.
    pub iterations: u32,
    /// True if the last attempt at a newer plan failed.
    pub kept: bool,
}

impl From<&PredictiveParameters> for Tuning {
    #[rustfmt::skip]
    fn from(parameters: &PredictiveParameters) -> Self {
        let PredictiveParameters {
            weight_position: position, weight_velocity: velocity, weight_tilt_rate: tilt_rate,
            weight_tilt_acceleration: tilt_acceleration, slow_pole, fast_pole, forecast, memory, selection, leg_margin: _,
        } = *parameters;
        let weights = Weights { position, velocity, tilt_rate, tilt_acceleration, slow_pole, fast_pole };
        Tuning { weights, forecast, memory: Memory { fit: memory, selection } }
    }
}

impl Law for Box<Predictive> {
    fn at_rest(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Self, Unsolvable> {
        Predictive::new(models, &(&parameters.predictive).into()).map(Box::new)
    }

    fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable> {
        // The dropped forces go on from where they are.
        self.retune(models, &(&parameters.predictive).into())
    }

    fn decisions(&mut self, law_input: &LawInput, step: f64) -> Option<[Decision; 2]> {
        let LawInput { states, references, context } = law_input;
        let decisions = self.decide(states, &LegContext::of(context), context.time_to_stop, step);
        let cue = [0, 1].map(|k: usize| context.force[k]);
        let unknown = self.preview_length() < SHORTEST_PREVIEW && context.time_to_stop.is_infinite();
        for (idle_return, cue) in self.idle_return.iter_mut().zip(cue) {
            idle_return.advance(cue, unknown, step);
        }
        let rates = context.angles.velocity;
        self.observe(*references, [0, 1].map(|k: usize| references[k] - cue[k]), &rates, step);
        decisions.map(|decisions| {
            [0, 1].map(|k: usize| Decision {
                dropped_force: decisions[k].dropped_force + self.idle_return[k].force(&states[k]),
                ..decisions[k]
            })
        })
    }

    fn largest_heave(&self) -> f64 {
        LARGEST_HEAVE
    }

    fn plan(&self) -> Option<PlanStatus> {
        let Plan { age, iterations, kept, .. } = self.plan;
        Some(PlanStatus { age, iterations, kept })
    }

    fn as_previewing(&mut self) -> Option<&mut dyn Previewing> {
        Some(&mut **self)
    }
}

impl Previewing for Predictive {
    /// Sets the courses that the cue will take in surge and sway.
    fn preview(&mut self, courses: &[PreviewedCue; 2]) {
        for (forecaster, course) in self.forecasters.iter_mut().zip(courses) {
            forecaster.preview(course);
        }
    }

    /// Delays courses that have just been given by `lag` seconds.
    fn delay_preview(&mut self, lag: f64) {
        for forecaster in &mut self.forecasters {
            forecaster.delay_preview(lag);
        }
    }
}

impl Predictive {
    /// At rest.
    ///
    /// # Errors
    /// The weights cannot be used.
    pub fn new(models: &[AxisModel; 2], tuning: &Tuning) -> Result<Self, Unsolvable> {
        let tables = Box::new(Tables::default());
        let programs = Programs::new(models, &tuning.weights)?;
        let plan = Plan {
            controls: [AxisControls::zeros(); 2],
            nodes: [Nodes::at_rest(); 2],
            horizon: Horizon::Near,
            age: 0.0,
            iterations: 0,
            kept: false,
        };
        Ok(Predictive {
            models: *models,
            tuning: *tuning,
            forecasters: [0, 1].map(|_| Box::new(Forecaster::new(&tables))),
            tables,
            until_sample: PLAN_INTERVAL,
            limits: Box::default(),
            programs,
            solver: Box::new(DualActiveSet::new()),
            due: true,
            horizon: Horizon::Near,
            free: [Nodes::at_rest(); 2],
            begun: 0.0,
            plan,
            dropped_forces: [0.0; 2],
            idle_return: [IdleReturn::default(); 2],
            glide: GlidingOffset::default(),
            until_followed: 0.0,
        })
    }

    /// Changes the parameters. The plan stays; the next one is made with them. In motion, weights
    /// and poles glide to their values.
    ///
    /// # Errors
    /// The weights cannot be used. Nothing has changed then.
    pub fn retune(&mut self, models: &[AxisModel; 2], tuning: &Tuning) -> Result<(), Unsolvable> {
        if (models, tuning) == (&self.models, &self.tuning) {
            return Ok(());
        }
        self.programs.retune(models, &tuning.weights)?;
        let before = core::mem::replace(&mut self.tuning, *tuning);
        self.models = *models;
        if before.weights != tuning.weights && self.dropped_forces != [0.0; 2] {
            self.glide.add(&(logarithms(&before.weights) - logarithms(&tuning.weights)));
        }
        self.follow_glide();
        self.solver.abandon();
        self.due = true;
        Ok(())
    }

    /// Makes the programs with the weights in force.
    fn follow_glide(&mut self) {
        if !self.glide.is_over() {
            // Weights on the way may be unusable where both ends are not: the next ones follow.
            let _ = self.programs.retune(&self.models, &in_force(&self.tuning.weights, &self.glide));
        }
        self.until_followed = FOLLOW_TIME;
    }

    /// The plan that is being carried out.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Decision for a step of `step` seconds, at whose beginning surge and sway are in
    /// these states. None once the plan is over. `time_to_stop` is infinite while no stop of
    /// the vehicle is foreseen.
    pub fn decide(
        &mut self,
        states: &[AxisState; 2],
        leg_context: &LegContext,
        time_to_stop: f64,
        step: f64,
    ) -> Option<[Decision; 2]> {
        if self.due && self.solver.status() != Status::Running {
            if !self.glide.is_over() && self.until_followed <= 0.0 {
                self.follow_glide();
            }
            self.begin(states, leg_context, time_to_stop);
        } else {
            self.proceed(step);
        }
        let decisions = self.plan.horizon.block_at(self.plan.age).map(|_| {
            [0, 1].map(|axis: usize| {
                let limit = self.models[axis].acceleration_limit;
                let [dropped_forces, tilting] = self.plan.courses(axis);
                let before = self.dropped_forces[axis];
                let planned = self.plan.value_after(dropped_forces, before, step);
                let most = MAX_DROPPED_SLOPE * step;
                self.dropped_forces[axis] = before + (planned - before).clamp(-most, most);
                let tilting = self.plan.tilting_after(tilting, states[axis].tilt_acceleration / limit, step);
                Decision { dropped_force: self.dropped_forces[axis], tilt_acceleration: limit * tilting }
            })
        });
        self.plan.age += step;
        self.begun += step;
        if !self.glide.is_over() {
            self.until_followed -= step;
            self.glide.advance(step);
            if self.glide.is_over() {
                let _ = self.programs.retune(&self.models, &self.tuning.weights);
                self.solver.abandon();
            }
        }
        decisions
    }

    /// Advances by `step` seconds with these references of surge and sway; `angular_part` is the
    /// angular channel's part of them, and `rates` the angular velocity that it cues.
    pub fn observe(&mut self, references: [f64; 2], angular_part: [f64; 2], rates: &Vector3<f64>, step: f64) {
        for (forecaster, angular_part) in self.forecasters.iter_mut().zip(angular_part) {
            forecaster.set_angular(angular_part, rates);
            forecaster.learn_next(&self.tables);
        }
        let mut left = step;
        loop {
            let chunk = if left <= self.until_sample + TIME_ROUNDING { left } else { self.until_sample };
            for (forecaster, reference) in self.forecasters.iter_mut().zip(references) {
                forecaster.advance(reference, chunk);
            }
            left -= chunk;
            self.until_sample -= chunk;
            if self.until_sample <= TIME_ROUNDING {
                self.until_sample = PLAN_INTERVAL;
                self.due = true;
                for forecaster in &mut self.forecasters {
                    forecaster.sample(&self.tables, self.tuning.forecast, &self.tuning.memory);
                }
            }
            if left <= TIME_ROUNDING {
                break;
            }
        }
    }

    /// Begins a new plan from these states.
    fn begin(&mut self, states: &[AxisState; 2], leg_context: &LegContext, time_to_stop: f64) {
        self.due = false;
        self.begun = 0.0;
        let preview = self.preview_length();
        let far = preview > LONG_PREVIEW || time_to_stop.is_finite();
        let horizon = if far { Horizon::Far } else { Horizon::Near };
        self.horizon = horizon;
        let program = self.programs.over(horizon);
        let mut gradient = SVector::<f64, CONTROLS>::zeros();
        for (k, axis) in program.axes.iter().enumerate() {
            let forecaster = &self.forecasters[k];
            // A stop ends the reference of surge; a preview already contains the stop.
            let forecast = if k == 0 && time_to_stop.is_finite() && preview == 0.0 {
                forecaster.until_stop(time_to_stop, horizon)
            } else {
                forecaster.over(horizon, &self.tables, self.tuning.forecast)
            };
            let data = axis.data(&states[k], self.dropped_forces[k], &forecast);
            self.free[k] = axis.free_nodes(&data);
            gradient.fixed_rows_mut::<AXIS_CONTROLS>(k * AXIS_CONTROLS).copy_from(&axis.gradient(&data));
            let free = axis.rows(&self.free[k], &AxisControls::zeros());
            let bounds = axis.bounds(&states[k]);
            self.limits.lower.fixed_rows_mut::<AXIS_ROWS>(k * AXIS_ROWS).copy_from(&(-bounds - free));
            self.limits.upper.fixed_rows_mut::<AXIS_ROWS>(k * AXIS_ROWS).copy_from(&(bounds - free));
        }
        self.limit_legs(leg_context);
        self.solver.start(&self.programs.over(horizon).factor, &gradient);
    }

    /// The time ahead for which the cue is known \[s\].
    fn preview_length(&self) -> f64 {
        self.forecasters.iter().fold(0.0, |most, axis| most.max(axis.preview_length()))
    }

    /// Sets the rows of the actuators, in halves of the stroke.
    fn limit_legs(&mut self, leg_context: &LegContext) {
        let planned = leg_context.planned_stroke();
        let scale = 2.0 / (planned[1] - planned[0]);
        let ends = self.horizon.ends();
        // After a change of horizon the plan's nodes are at other times: the rows are less exact for once.
        for (node, legs) in leg_rows(leg_context, &self.plan.nodes, self.horizon).iter().enumerate() {
            let part = margin_ramp(ends[node]);
            let [min, max] = [0, 1].map(|end: usize| {
                let stroke = leg_context.stroke[end];
                stroke + part * (planned[end] - stroke)
            });
            let states = self.free.each_ref().map(|axis| axis.at(node));
            for (leg, row) in legs.iter().enumerate() {
                let row = row.scaled(scale);
                let free = row.offset + row.change(states.map(|axis| axis.position), states.map(|axis| axis.tilt));
                let number = 2 * AXIS_ROWS + 6 * node + leg;
                self.limits.lower[number] = scale * min - free;
                self.limits.upper[number] = scale * max - free;
                self.limits.legs[node][leg] = row;
            }
        }
    }

    /// Continues to solve for the next plan, and adopts it once it is solved.
    fn proceed(&mut self, step: f64) {
        if self.solver.status() != Status::Running {
            return;
        }
        let pace = (ITERATIONS_PER_STEP * step / REFERENCE_STEP).clamp(ITERATIONS_PER_STEP, f64::from(MAX_ITERATIONS));
        let rows = PlanRows { program: self.programs.over(self.horizon), limits: &self.limits };
        match self.solver.advance(&rows, pace as u32) {
            Status::Running if self.solver.iterations() < MAX_ITERATIONS => {}
            Status::Solved => self.commit(),
            Status::Running | Status::Failed => {
                self.plan.kept = true;
                self.plan.iterations = self.solver.iterations();
                self.solver.abandon();
            }
        }
    }

    fn commit(&mut self) {
        let program = self.programs.over(self.horizon);
        for (k, axis) in program.axes.iter().enumerate() {
            let controls = self.solver.solution().fixed_rows::<AXIS_CONTROLS>(k * AXIS_CONTROLS).into_owned();
            self.plan.nodes[k] = axis.nodes(&self.free[k], &controls);
            self.plan.controls[k] = controls;
        }
        self.plan.horizon = self.horizon;
        self.plan.age = self.begun;
        self.plan.iterations = self.solver.iterations();
        self.plan.kept = false;
    }
}

glide_by_logarithms!(Weights,
    Weights { position, velocity, tilt_rate, tilt_acceleration, slow_pole, fast_pole }
    => [position, velocity, tilt_rate, tilt_acceleration, slow_pole, fast_pole]
);

impl Plan {
    /// Dropped forces of an axis at the nodes, and tilt accelerations relative to their limit.
    fn courses(&self, axis: usize) -> [&[f64]; 2] {
        let (dropped_forces, tilting) = self.controls[axis].as_slice().split_at(BLOCKS);
        [dropped_forces, tilting]
    }

    /// A quantity after a step of `step` seconds, at whose beginning it has this `value`: on the
    /// line to the next node, then from node to node. From the last node on the quantity stays.
    fn value_after(&self, nodes: &[f64], value: f64, step: f64) -> f64 {
        let end = self.age + step;
        let Some(block) = self.horizon.block_at(end) else { return nodes[BLOCKS - 1] };
        let node = self.horizon.ends()[block];
        let (mut time, mut from) = (self.age, value);
        let begin = node - self.horizon.durations()[block];
        if block > 0 && begin > self.age {
            (time, from) = (begin, nodes[block - 1]);
        }
        from + (nodes[block] - from) * (end - time) / (node - time)
    }

    /// The tilt's acceleration after a step of `step` seconds, at whose beginning it has this
    /// `value`: on the ramp to its block's, and then that.
    fn tilting_after(&self, blocks: &[f64], value: f64, step: f64) -> f64 {
        let end = self.age + step;
        let Some(block) = self.horizon.block_at(self.age) else { return blocks[BLOCKS - 1] };
        let ramped = self.horizon.ends()[block] - self.horizon.durations()[block] + TILT_RAMP_TIME;
        if end >= ramped { blocks[block] } else { value + (blocks[block] - value) * step / (ramped - self.age) }
    }
}
