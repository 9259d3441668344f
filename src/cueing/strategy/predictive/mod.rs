//! The predictive strategy: a plan of surge, sway and tilt over the next seconds, made
//! anew 50 times a second.
//!
//! A plan is the solution of a quadratic [`program`] over the blocks of a [`horizon`]. It has the
//! least dropped force for the reference that is [`forecast`]. Travel, tilt and the actuators'
//! lengths ([`legs`]) stay within their limits. The [`dual_active_set`] method solves it a few
//! iterations at a time, so that no internal step takes long.
//!
//! A plan sets the dropped force and the tilt's acceleration. The rest follows from the input
//! without delay: see [`coordinated`](super::coordinated).

pub mod dual_active_set;
pub mod forecast;
pub mod horizon;
pub mod legs;
pub mod preview;
pub mod program;

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use self::dual_active_set::{DualActiveSet, Rows, Status};
use self::forecast::{Forecast, Forecaster, Memory, Tables};
use self::horizon::{BLOCKS, Horizon, SAMPLE};
use self::legs::{Surroundings, leg_rows};
use self::preview::Course;
use self::program::{AXIS_CONTROLS, AXIS_ROWS, AxisControls, CONTROLS, Nodes, Programs, ROWS};
use super::regulator::{AxisModel, Regulator, Weights};
use super::{AxisState, Decision};
use crate::interface::{ForecastKind, PredictiveParameters};

/// Iterations of an internal step of up to [`PACE`] seconds; longer steps do more in proportion.
const ITERATIONS_PER_STEP: f64 = 8.0;
const PACE: f64 = 0.001;
/// Length of a preview above which the far horizon is used \[s\].
const LONG_PREVIEW: f64 = 2.0;
/// A plan that takes more iterations is abandoned.
const MAX_ITERATIONS: u32 = 120;
/// Largest surcharges on dropped forces, of surge and of sway, that reverse the felt force. They
/// add to the weight of 1. Sway has few opposite cues, and a surcharge does not reduce them.
const OPPOSITE_SURCHARGE: [f64; 2] = [0.5, 0.0];
/// Felt force in the opposite direction from which on the surcharge is largest \[m/s2\].
const OPPOSITE_FORCE: f64 = 0.15;
/// Differences of time below this are rounding \[s\].
const INSTANT: f64 = 1e-9;

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
    factor: Box<SMatrix<f64, CONTROLS, CONTROLS>>,
    rows: Box<Rows<CONTROLS, ROWS>>,
    solver: Box<DualActiveSet<CONTROLS, ROWS>>,
    /// True: a new plan is due.
    due: bool,
    /// Horizon of the plan that is being made, its nodes without control, and the time since it was
    /// begun \[s\].
    horizon: Horizon,
    free: [Nodes; 2],
    begun: f64,
    plan: Plan,
}

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
    fn from(parameters: &PredictiveParameters) -> Self {
        Tuning {
            weights: Weights {
                position: parameters.weight_position,
                velocity: parameters.weight_velocity,
                tilt_rate: parameters.weight_tilt_rate,
                tilt_acceleration: parameters.weight_tilt_acceleration,
                slow_pole: parameters.slow_pole,
                fast_pole: parameters.fast_pole,
            },
            forecast: parameters.forecast,
            memory: Memory { fit: parameters.memory, selection: parameters.selection },
        }
    }
}

impl Predictive {
    /// At rest. None if the weights cannot be used.
    pub fn new(models: &[AxisModel; 2], tuning: &Tuning) -> Option<Self> {
        let tables = Box::new(Tables::default());
        let programs = Programs::new(models, &tuning.weights)?;
        let plan = Plan {
            controls: [AxisControls::zeros(); 2],
            nodes: [Nodes::zeros(); 2],
            horizon: Horizon::Near,
            age: 0.0,
            iterations: 0,
            kept: false,
        };
        Some(Predictive {
            models: *models,
            tuning: *tuning,
            forecasters: [0, 1].map(|_| Box::new(Forecaster::new(&tables))),
            tables,
            until_sample: SAMPLE,
            rows: Box::new(program::rows(&programs.near)),
            programs,
            factor: Box::new(SMatrix::zeros()),
            solver: Box::new(DualActiveSet::new()),
            due: true,
            horizon: Horizon::Near,
            free: [Nodes::zeros(); 2],
            begun: 0.0,
            plan,
        })
    }

    /// Changes the parameters. The plan stays; the next one is made with them. False, and nothing
    /// changes, if they cannot be used.
    pub fn retune(&mut self, models: &[AxisModel; 2], tuning: &Tuning) -> bool {
        if (models, tuning) == (&self.models, &self.tuning) {
            return true;
        }
        if models.iter().any(|model| Regulator::new(model, &tuning.weights).is_none()) {
            return false;
        }
        self.programs.retune(models, &tuning.weights);
        program::set_axis_normals(&mut self.rows, self.programs.over(self.horizon));
        (self.models, self.tuning) = (*models, *tuning);
        self.solver.abandon();
        self.due = true;
        true
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
        surroundings: &Surroundings,
        time_to_stop: f64,
        step: f64,
    ) -> Option<[Decision; 2]> {
        if self.due && self.solver.status() != Status::Running {
            self.begin(states, surroundings, time_to_stop);
        } else {
            self.proceed(step);
        }
        let decisions = self.plan.horizon.block_at(self.plan.age).map(|block| {
            [0, 1].map(|axis: usize| Decision {
                dropped_force: self.plan.controls[axis][block],
                tilt_acceleration: self.models[axis].acceleration_limit * self.plan.controls[axis][BLOCKS + block],
            })
        });
        self.plan.age += step;
        self.begun += step;
        decisions
    }

    /// Sets the courses that the cue will take in surge and sway.
    pub fn preview(&mut self, courses: &[Course; 2]) {
        for (forecaster, course) in self.forecasters.iter_mut().zip(courses) {
            forecaster.preview(course);
        }
    }

    /// Delays courses that have just been given by `lag` seconds.
    pub fn put_off_preview(&mut self, lag: f64) {
        for forecaster in &mut self.forecasters {
            forecaster.put_off_preview(lag);
        }
    }

    /// Advances by `step` seconds with these references of surge and sway; `beside` is the angular
    /// channel's part of them.
    pub fn observe(&mut self, references: [f64; 2], beside: [f64; 2], step: f64) {
        for (forecaster, beside) in self.forecasters.iter_mut().zip(beside) {
            forecaster.set_beside(beside);
        }
        let mut left = step;
        loop {
            let chunk = if left <= self.until_sample + INSTANT { left } else { self.until_sample };
            for (forecaster, reference) in self.forecasters.iter_mut().zip(references) {
                forecaster.advance(reference, chunk);
            }
            left -= chunk;
            self.until_sample -= chunk;
            if self.until_sample <= INSTANT {
                self.until_sample = SAMPLE;
                self.due = true;
                for forecaster in &mut self.forecasters {
                    forecaster.sample(&self.tables, self.tuning.forecast, &self.tuning.memory);
                }
            }
            if left <= INSTANT {
                break;
            }
        }
    }

    /// Begins a new plan from these states.
    fn begin(&mut self, states: &[AxisState; 2], surroundings: &Surroundings, time_to_stop: f64) {
        self.due = false;
        self.begun = 0.0;
        let preview = self.forecasters.iter().fold(0.0_f64, |most, axis| most.max(axis.preview_length()));
        let far = preview > LONG_PREVIEW || time_to_stop.is_finite();
        let horizon = if far { Horizon::Far } else { Horizon::Near };
        if horizon != self.horizon {
            self.horizon = horizon;
            program::set_axis_normals(&mut self.rows, self.programs.over(horizon));
        }
        let program = self.programs.over(horizon);
        let mut gradient = SVector::<f64, CONTROLS>::zeros();
        let mut surcharges = [SVector::zeros(); 2];
        for (k, axis) in program.axes.iter().enumerate() {
            let forecaster = &self.forecasters[k];
            // A stop ends the reference of surge; a preview already contains the stop.
            let forecast = if k == 0 && time_to_stop.is_finite() && preview == 0.0 {
                forecaster.until_stop(time_to_stop, horizon)
            } else {
                forecaster.over(horizon, &self.tables, self.tuning.forecast)
            };
            surcharges[k] = OPPOSITE_SURCHARGE[k] * opposition(&forecast, &self.plan.controls[k]);
            let data = program::data(&states[k], &forecast);
            self.free[k] = axis.free_nodes(&data);
            gradient.fixed_rows_mut::<AXIS_CONTROLS>(k * AXIS_CONTROLS).copy_from(&axis.gradient(&data));
            let free = axis.rows(&self.free[k], &AxisControls::zeros());
            self.rows.lower.fixed_rows_mut::<AXIS_ROWS>(k * AXIS_ROWS).copy_from(&free.map(|value| -1.0 - value));
            self.rows.upper.fixed_rows_mut::<AXIS_ROWS>(k * AXIS_ROWS).copy_from(&free.map(|value| 1.0 - value));
        }
        self.limit_legs(surroundings);
        if self.programs.over(horizon).factorize(&surcharges, &mut self.factor) {
            self.solver.start(&self.factor, &gradient);
        } else {
            self.solver.abandon();
            self.plan.kept = true;
        }
    }

    /// Sets the rows of the actuators, in halves of the stroke.
    fn limit_legs(&mut self, surroundings: &Surroundings) {
        let [min, max] = surroundings.stroke;
        let scale = 2.0 / (max - min);
        let program = self.programs.over(self.horizon);
        // After a change of horizon the plan's nodes are at other times: the rows are less exact for once.
        for (node, legs) in leg_rows(surroundings, &self.plan.nodes, self.horizon).iter().enumerate() {
            for (leg, row) in legs.iter().enumerate() {
                let mut free = row.offset;
                let number = 2 * AXIS_ROWS + 6 * node + leg;
                let Some(normal) = self.rows.normals.get_mut(number) else { continue };
                for (axis, program) in program.axes.iter().enumerate() {
                    let (by_position, by_tilt) = (row.by_position[axis], row.by_tilt[axis]);
                    free += by_position * self.free[axis][4 * node] + by_tilt * self.free[axis][4 * node + 2];
                    let controls = by_position * program.response(node, 0) + by_tilt * program.response(node, 2);
                    normal.fixed_rows_mut::<AXIS_CONTROLS>(axis * AXIS_CONTROLS).copy_from(&(scale * controls));
                }
                self.rows.lower[number] = scale * (min - free);
                self.rows.upper[number] = scale * (max - free);
            }
        }
    }

    /// Continues to solve for the next plan, and adopts it once it is solved.
    fn proceed(&mut self, step: f64) {
        if self.solver.status() != Status::Running {
            return;
        }
        let pace = (ITERATIONS_PER_STEP * step / PACE).clamp(ITERATIONS_PER_STEP, f64::from(MAX_ITERATIONS));
        match self.solver.advance(&self.rows, pace as u32) {
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

/// Degree, from 0 to 1, to which the plan before makes the rider feel the opposite of what is
/// expected, in each block. An opposite cue is worse than a missing one of the same error.
fn opposition(forecast: &Forecast, controls: &AxisControls) -> SVector<f64, BLOCKS> {
    SVector::from_fn(|block, _| {
        let expected = forecast.means[block];
        let opposite = -(expected + controls[block]) * expected.signum();
        (opposite / OPPOSITE_FORCE).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::{Parameters, Rig};
    use crate::platform::Geometry;
    use dual_active_set::tests::{Program, compare};
    use legs::tests::surroundings;
    use std::f64::consts::TAU;

    const MODEL: AxisModel = AxisModel {
        head_height: 1.2,
        gravity: 9.80665,
        position_limit: 0.45,
        velocity_limit: 1.0,
        angle_limit: 0.38,
        rate_limit: 0.052,
        acceleration_limit: 0.2,
    };

    fn predictive() -> Predictive {
        Predictive::new(&[MODEL; 2], &(&Parameters::default().predictive).into()).unwrap()
    }

    /// Advances by `steps` steps of 1 ms at this reference. Returns the last step's decisions.
    fn passed(predictive: &mut Predictive, steps: usize, reference: f64) -> Option<[Decision; 2]> {
        let geometry = Geometry::from(&Rig::default());
        let mut decisions = None;
        for _ in 0..steps {
            decisions = predictive.decide(&[AxisState::default(); 2], &surroundings(&geometry), f64::INFINITY, 0.001);
            predictive.observe([reference; 2], [0.0; 2], 0.001);
        }
        decisions
    }

    #[test]
    fn a_plan_is_made_every_20_ms_and_is_never_older_than_that_and_its_making() {
        let mut predictive = predictive();
        for _ in 0..500 {
            passed(&mut predictive, 1, 3.0);
            assert!(predictive.plan().age < 0.04, "{}", predictive.plan().age);
        }
        assert!(predictive.plan().iterations > 0 && !predictive.plan().kept);
    }

    #[test]
    fn without_a_new_plan_the_one_before_is_carried_out_to_its_end() {
        let mut predictive = predictive();
        passed(&mut predictive, 500, 3.0);
        // Nothing can be planned for what is not a number.
        let decisions = passed(&mut predictive, 1000, f64::NAN).expect("the plan reaches 3 s ahead");
        assert!(predictive.plan().kept);
        assert!(decisions.iter().all(|decision| decision.dropped_force.is_finite()));
        assert!((0.9..1.1).contains(&predictive.plan().age));
        assert_eq!(passed(&mut predictive, 2100, f64::NAN), None);
    }

    #[test]
    fn the_plan_keeps_its_rows() {
        let mut predictive = predictive();
        passed(&mut predictive, 2000, 6.0);
        for (axis, program) in predictive.programs.near.axes.iter().enumerate() {
            let rows = program.rows(&predictive.plan.nodes[axis], &predictive.plan.controls[axis]);
            assert!(rows.amax() <= 1.0 + 1e-8, "{}", rows.amax());
            assert!(rows.amax() > 0.999, "a strong reference must reach a limit");
        }
    }

    /// Surge and sway `step` seconds later, if they move by this decision at this reference.
    fn moved(state: &AxisState, decision: &Decision, reference: f64, step: f64) -> AxisState {
        let AxisState { position, velocity, tilt, tilt_rate } = *state;
        let Decision { dropped_force, tilt_acceleration } = *decision;
        let acceleration = reference + dropped_force - MODEL.gravity * tilt + MODEL.head_height * tilt_acceleration;
        AxisState {
            position: position + velocity * step,
            velocity: velocity + acceleration * step,
            tilt: tilt + tilt_rate * step,
            tilt_rate: tilt_rate + tilt_acceleration * step,
        }
    }

    #[test]
    fn the_programs_of_a_ride_have_the_solution_that_an_interior_point_method_finds() {
        const STEP: f64 = 0.001;
        let mut predictive = predictive();
        let geometry = Geometry::from(&Rig::default());
        let mut states = [AxisState::default(); 2];
        let (mut begun, mut limited) = (0, 0);
        for k in 0..30_000 {
            let t = f64::from(k) * STEP;
            let waves = |waves: [(f64, f64); 4]| waves.iter().map(|(a, f)| a * (TAU * f * t).sin()).sum::<f64>();
            let references = [
                [(2.5, 0.07), (1.5, 0.21), (0.8, 0.9), (0.3, 11.0)],
                [(1.8, 0.09), (1.2, 0.33), (0.7, 1.1), (0.3, 13.0)],
            ]
            .map(waves);
            let due = predictive.due;
            let decisions =
                predictive.decide(&states, &surroundings(&geometry), f64::INFINITY, STEP).unwrap_or_default();
            if due && predictive.solver.status() == Status::Running && predictive.solver.iterations() == 0 {
                begun += 1;
                if begun % 5 == 0 {
                    // The solve begins at the minimum without rows, -J J' times the gradient.
                    let inverse = predictive.factor.try_inverse().unwrap();
                    let gradient = -inverse.tr_mul(&(inverse * predictive.solver.solution()));
                    compare(&Program { factor: *predictive.factor, gradient, rows: (*predictive.rows).clone() });
                }
            }
            limited += usize::from(predictive.plan().iterations > 10);
            for (axis, state) in states.iter_mut().enumerate() {
                *state = moved(state, &decisions[axis], references[axis], STEP);
            }
            predictive.observe(references, [0.0; 2], STEP);
        }
        // The ride is long and demands more than the platform can do.
        assert!(begun > 1000 && limited > 1000, "{begun} programs, {limited}");
    }

    #[test]
    fn only_a_felt_force_against_the_expected_one_is_opposed() {
        let mut forecast = Forecast::default();
        forecast.means.fill(-2.0);
        let mut controls = AxisControls::zeros();
        controls.as_mut_slice()[..4].copy_from_slice(&[1.0, 2.0, 2.0 + 0.5 * OPPOSITE_FORCE, 5.0]);
        let opposed = opposition(&forecast, &controls);
        assert_eq!((opposed[0], opposed[1], opposed[3], opposed[4]), (0.0, 0.0, 1.0, 0.0));
        assert!((opposed[2] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_factor_is_that_of_the_hessian_with_the_surcharges() {
        let predictive = predictive();
        let program = predictive.programs.over(Horizon::Far);
        let surcharges = [SVector::from_fn(|k, _| 0.1 * k as f64), SVector::repeat(0.3)];
        let mut factor = SMatrix::<f64, CONTROLS, CONTROLS>::zeros();
        assert!(program.factorize(&surcharges, &mut factor));
        // J J' is the inverse of the Hessian.
        let inverse = factor * factor.transpose();
        for (k, surcharge) in surcharges.iter().enumerate() {
            let mut hessian = *program.axes[k].hessian();
            for block in 0..BLOCKS {
                hessian[(block, block)] += Horizon::Far.durations()[block] * surcharge[block];
            }
            let begin = k * AXIS_CONTROLS;
            let product = hessian * inverse.fixed_view::<AXIS_CONTROLS, AXIS_CONTROLS>(begin, begin);
            assert!((product - SMatrix::identity()).amax() < 1e-8, "{}", (product - SMatrix::identity()).amax());
        }
    }

    #[test]
    fn condensed_nodes_are_those_of_the_block_equations() {
        let predictive = predictive();
        let controls = AxisControls::from_fn(|k, _| 0.3 * (k as f64).sin());
        let state = AxisState { position: 0.1, velocity: -0.2, tilt: 0.05, tilt_rate: 0.01 };
        let mut forecast = Forecast::default();
        forecast.means.fill(0.7);
        let data = program::data(&state, &forecast);
        let axis = &predictive.programs.near.axes[0];
        let nodes = axis.nodes(&axis.free_nodes(&data), &controls);
        let (mut x, mut v, mut q, mut w) = (0.1, -0.2, 0.05, 0.01);
        for block in 0..BLOCKS {
            let alpha = MODEL.acceleration_limit * controls[BLOCKS + block];
            let steps = 20_000;
            let step = Horizon::Near.durations()[block] / f64::from(steps);
            for _ in 0..steps {
                let middle = q + 0.5 * step * (w + step * alpha / 3.0);
                let a = 0.7 + MODEL.head_height * alpha - program::CHORD * MODEL.gravity * middle + controls[block];
                x += step * (v + 0.5 * step * a);
                v += step * a;
                q += step * (w + 0.5 * step * alpha);
                w += step * alpha;
            }
            let expected = [x, v, q, w];
            for (k, expected) in expected.iter().enumerate() {
                let found = nodes[4 * block + k];
                assert!((found - expected).abs() < 1e-8, "block {block}, state {k}: {found}, {expected}");
            }
        }
    }
}
