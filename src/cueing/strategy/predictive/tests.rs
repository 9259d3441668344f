//! Tests of the plan as a whole: when it is made, what it keeps, and what it is made from.

use super::*;
use crate::interface::{Parameters, Rig};
use crate::platform::Geometry;
use nalgebra::SMatrix;

use dual_active_set::tests::{DenseRows, Program, compare};
use legs::tests::{leg_context, length};
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

/// The rows of the plan that is being made.
fn rows(predictive: &Predictive) -> DenseRows<CONTROLS, ROWS> {
    DenseRows::of(&PlanRows { program: predictive.programs.over(predictive.horizon), limits: &predictive.limits })
}

/// Advances by `steps` steps of 1 ms at this reference. Returns the last step's decisions.
fn passed(predictive: &mut Predictive, steps: usize, reference: f64) -> Option<[Decision; 2]> {
    let geometry = Geometry::from(&Rig::default());
    passed_in(predictive, &leg_context(&geometry), steps, &[AxisState::default(); 2], [reference; 2])
}

/// The same in other leg_context, in these states, and at references of surge and sway.
fn passed_in(
    predictive: &mut Predictive,
    leg_context: &LegContext,
    steps: usize,
    states: &[AxisState; 2],
    references: [f64; 2],
) -> Option<[Decision; 2]> {
    let mut decisions = None;
    for _ in 0..steps {
        decisions = predictive.decide(states, leg_context, f64::INFINITY, 0.001);
        predictive.observe(references, [0.0; 2], &Vector3::zeros(), 0.001);
    }
    decisions
}

/// LegContext in which the legs may leave the middle of their stroke by `half` only.
fn narrow(geometry: &Geometry, half: f64) -> LegContext<'_> {
    let neutral = leg_context(geometry);
    let middle = neutral.stroke.iter().sum::<f64>() / 2.0;
    LegContext { stroke: [middle - half, middle + half], ..neutral }
}

#[test]
fn a_plan_is_made_every_20_ms_and_is_never_older_than_that_and_its_making() {
    let mut predictive = predictive();
    let mut begun = 0;
    for _ in 0..500 {
        passed(&mut predictive, 1, 3.0);
        assert!(predictive.plan().age < 0.04, "{}", predictive.plan().age);
        begun += usize::from(predictive.begun < 0.0015);
    }
    assert_eq!(begun, 25);
    assert!(predictive.plan().iterations > 0 && !predictive.plan().kept);
}

#[test]
fn a_new_plan_is_as_old_as_its_making() {
    let mut predictive = predictive();
    // A demand beyond every limit takes more iterations than one step has.
    let (mut making, mut slow) = (0.0, 0);
    for _ in 0..1000 {
        let running = predictive.solver.status() == Status::Running;
        making = if predictive.due && !running { 0.001 } else { making + 0.001 };
        passed(&mut predictive, 1, 6.0);
        if running && predictive.solver.status() == Status::Solved {
            assert!((predictive.plan().age - making).abs() < 1e-12, "{} s, {making} s", predictive.plan().age);
            slow += usize::from(making > 0.0025);
        }
    }
    assert!(slow > 0);
}

#[test]
fn a_step_of_up_to_1_ms_has_eight_iterations_and_a_longer_one_more_in_proportion() {
    let mut before = predictive();
    passed(&mut before, 1000, 6.0);
    while !before.due {
        passed(&mut before, 1, 6.0);
    }
    let geometry = Geometry::from(&Rig::default());
    let advanced = |predictive: &mut Predictive, step: f64| {
        predictive.decide(&[AxisState::default(); 2], &leg_context(&geometry), f64::INFINITY, step);
        predictive.solver.iterations()
    };
    advanced(&mut before, 0.001);
    for (step, iterations) in [(0.0001, 8), (0.001, 8), (0.0015, 12)] {
        let mut predictive = before.clone();
        assert_eq!(advanced(&mut predictive, step), iterations);
        assert_eq!(predictive.solver.status(), Status::Running);
    }
}

#[test]
fn a_decision_is_on_the_line_to_the_next_node_and_on_the_ramp_to_the_block_that_the_plan_has_reached() {
    let mut predictive = predictive();
    passed(&mut predictive, 1500, 5.0);
    // From now on the plan is carried out to its end.
    passed(&mut predictive, 100, f64::NAN);
    let mut blocks = [false; BLOCKS];
    while let Some(block) = predictive.plan.horizon.block_at(predictive.plan.age) {
        blocks[block] = true;
        let Plan { controls, horizon, age, .. } = predictive.plan;
        let before = predictive.dropped_forces;
        let decisions = passed(&mut predictive, 1, f64::NAN).unwrap();
        for axis in 0..2 {
            let left = horizon.ends()[block] - age;
            let expected = before[axis] + (controls[axis][block] - before[axis]) * 0.001 / left;
            assert!((decisions[axis].dropped_force - expected).abs() < 1e-9, "{expected} in block {block}");
            // The tilt does not move here, so that each step begins a ramp at zero.
            let ramp_left = TILT_RAMP_TIME - (horizon.durations()[block] - left);
            let tilting = MODEL.acceleration_limit * controls[axis][BLOCKS + block];
            let expected = if ramp_left > 0.001 { tilting * 0.001 / ramp_left } else { tilting };
            assert!((decisions[axis].tilt_acceleration - expected).abs() < 1e-9, "{expected} in block {block}");
        }
    }
    assert!(blocks[3..].iter().all(|&reached| reached));
    let last = predictive.plan.controls.map(|controls| controls[BLOCKS - 1]);
    let apart = (0..2).map(|axis| (predictive.dropped_forces[axis] - last[axis]).abs());
    assert!(apart.fold(0.0, f64::max) < 1e-9, "the plan ends at its last nodes");
}

#[test]
fn a_long_step_goes_from_node_to_node() {
    let mut plan = predictive().plan;
    plan.controls[0].copy_from(&AxisControls::from_fn(|k, _| (k as f64).cos()));
    for (age, step, block, from) in [(0.0, 0.07, 1, 0.5), (0.05, 0.4, 4, 0.0)] {
        plan.age = age;
        let controls = plan.controls[0];
        let (begin, end) = (Horizon::Near.ends()[block - 1], Horizon::Near.ends()[block]);
        let fraction = (age + step - begin) / (end - begin);
        let expected = controls[block - 1] + fraction * (controls[block] - controls[block - 1]);
        assert!((plan.value_after(plan.courses(0)[0], from, step) - expected).abs() < 1e-12);
    }
    assert_eq!(plan.value_after(plan.courses(0)[0], 0.2, 5.0), plan.controls[0][BLOCKS - 1]);
}

#[test]
fn the_dropped_force_is_continuous_from_plan_to_plan() {
    const STEP: f64 = 0.001;
    let mut predictive = predictive();
    let geometry = Geometry::from(&Rig::default());
    let mut states = [AxisState::default(); 2];
    let (mut before, mut steepest, mut largest) = ([0.0; 2], 0.0_f64, 0.0_f64);
    for k in 0..20_000 {
        let t = f64::from(k) * STEP;
        let references = [3.0 * (0.7 * t).sin(), 2.0 * (1.1 * t).sin()];
        // A stop that is foreseen now and then changes the horizon.
        let time_to_stop = if k / 700 % 2 == 0 { f64::INFINITY } else { 2.0 };
        let decisions = predictive.decide(&states, &leg_context(&geometry), time_to_stop, STEP).unwrap();
        for (axis, state) in states.iter_mut().enumerate() {
            let dropped = decisions[axis].dropped_force;
            steepest = steepest.max((dropped - before[axis]).abs());
            largest = largest.max(dropped.abs());
            before[axis] = dropped;
            *state = moved(state, &decisions[axis], references[axis], STEP);
        }
        predictive.observe(references, [0.0; 2], &Vector3::zeros(), STEP);
    }
    assert!(largest > 0.5 && steepest < 0.05, "{steepest} m/s2 in a step, {largest} m/s2 at most");
}

#[test]
fn the_dropped_force_is_smooth_where_the_plan_is_not() {
    let geometry = Geometry::from(&Rig::default());
    let mut predictive = predictive();
    // As where rows hardly leave a solution.
    predictive.plan.controls[0].copy_from(&AxisControls::from_fn(|k, _| if k % 2 == 0 { 15.0 } else { -15.0 }));
    predictive.due = false;
    let mut before = 0.0;
    for k in 0..100 {
        let states = [AxisState::default(); 2];
        let [surge, sway] = predictive.decide(&states, &leg_context(&geometry), f64::INFINITY, 0.001).unwrap();
        // Up to the first node at 40 ms, and down to the second one.
        let expected: f64 = if k < 40 { 0.025 } else { -0.025 };
        assert!((surge.dropped_force - before - expected).abs() < 1e-12 && sway.dropped_force == 0.0);
        before = surge.dropped_force;
    }
}

#[test]
fn a_plan_in_the_making_is_abandoned_when_the_parameters_change() {
    let mut predictive = predictive();
    passed(&mut predictive, 1000, 6.0);
    while predictive.solver.status() != Status::Running {
        passed(&mut predictive, 1, 6.0);
    }
    let models = [AxisModel { position_limit: 0.2, ..MODEL }; 2];
    let tuning = predictive.tuning;
    predictive.retune(&models, &tuning).unwrap();
    assert_eq!(predictive.solver.status(), Status::Failed, "its rows are no more those that it was begun with");
    passed(&mut predictive, 1, 6.0);
    assert!(predictive.begun < 0.0015 && !predictive.due, "a new one is begun at once");
}

#[test]
fn retuning_is_construction_and_what_cannot_be_used_changes_nothing() {
    let mut predictive = predictive();
    passed(&mut predictive, 50, 3.0);
    while predictive.due || predictive.solver.status() == Status::Running {
        passed(&mut predictive, 1, 3.0);
    }
    let (before, tuning) = (predictive.clone(), predictive.tuning);
    predictive.retune(&[MODEL; 2], &tuning).unwrap();
    assert_eq!(predictive, before);
    let unusable = Tuning { weights: Weights { position: f64::NAN, ..tuning.weights }, ..tuning };
    assert_eq!(predictive.retune(&[MODEL; 2], &unusable), Err(Unsolvable::RiccatiEquation));
    assert_eq!(predictive, before);

    let models = [AxisModel { position_limit: 0.2, ..MODEL }, MODEL];
    let other = Tuning { weights: Weights { position: 2.0, ..tuning.weights }, ..tuning };
    predictive.retune(&models, &other).unwrap();
    // The plan stays until the next one is made, and the weights glide.
    assert!(predictive.due && predictive.plan == before.plan);
    let hessian = |programs: &Programs| *programs.near.axes[0].hessian();
    let begun = Programs::new(&models, &tuning.weights).unwrap();
    assert!((hessian(&predictive.programs) - hessian(&begun)).amax() < 1e-9 * hessian(&begun).amax());
    passed(&mut predictive, 10_000, 3.0);
    let made = Predictive::new(&models, &other).unwrap();
    assert_eq!((&predictive.programs, predictive.models, predictive.tuning), (&made.programs, models, other));
}

#[test]
fn a_plan_is_made_from_the_same_forecast_by_any_steps() {
    let observed = |step: usize| {
        let mut predictive = predictive();
        predictive.tuning.memory = Memory { fit: 20.0, selection: 1.0 };
        for k in (0..12_000).step_by(step) {
            // Constant over 60 ms.
            let reference = |phase: f64| 2.0 * (0.1 * (k / 60) as f64 + phase).sin();
            predictive.observe([reference(0.0), reference(1.0)], [0.0; 2], &Vector3::zeros(), 0.001 * step as f64);
        }
        predictive
    };
    let fine = observed(1);
    for step in [4, 15, 20, 30, 60] {
        let coarse = observed(step);
        assert!((coarse.until_sample - fine.until_sample).abs() < 1e-9, "{step} ms");
        for (found, expected) in coarse.forecasters.iter().zip(&fine.forecasters) {
            let [found, expected] = [found, expected]
                .map(|forecaster| forecaster.over(Horizon::Near, &fine.tables, ForecastKind::Learned).means);
            assert!(expected.amax() > 0.1 && (found - expected).amax() < 1e-6, "{step} ms: {found} beside {expected}");
        }
    }
}

#[test]
fn a_long_preview_is_planned_for_over_the_far_horizon() {
    let mut predictive = predictive();
    let course = |count: usize| PreviewedCue { step: 0.1, count, ..PreviewedCue::default() };
    for (counts, lag, horizon) in [
        ([20, 20], 0.0, Horizon::Near),
        ([19, 22], 0.0, Horizon::Far),
        ([22, 19], 0.0, Horizon::Far),
        ([19, 19], 0.2, Horizon::Far),
        ([0, 0], 0.0, Horizon::Near),
    ] {
        predictive.preview(&counts.map(course));
        predictive.delay_preview(lag);
        predictive.due = true;
        predictive.solver.abandon();
        passed(&mut predictive, 1, 0.0);
        assert_eq!(predictive.horizon, horizon, "{counts:?} elements, {lag} s later");
    }
}

#[test]
fn each_axis_is_planned_for_its_own_reference() {
    let geometry = Geometry::from(&Rig::default());
    for references in [[1.0, 0.0], [0.0, 1.0]] {
        let mut predictive = predictive();
        passed_in(&mut predictive, &leg_context(&geometry), 500, &[AxisState::default(); 2], references);
        for (controls, reference) in predictive.plan.controls.iter().zip(references) {
            assert_eq!(controls.amax() > 0.01, reference > 0.0, "{controls} for {reference} m/s2");
        }
    }
}

/// Begins a plan at rest after a second at this reference.
fn begun(predictive: &mut Predictive, reference: f64, time_to_stop: f64) {
    let geometry = Geometry::from(&Rig::default());
    for _ in 0..1000 {
        predictive.observe([reference; 2], [0.0; 2], &Vector3::zeros(), 0.001);
    }
    predictive.begin(&[AxisState::default(); 2], &leg_context(&geometry), time_to_stop);
}

#[test]
fn a_foreseen_stop_ends_the_reference_of_surge_where_no_preview_contains_it() {
    // Velocities in surge and sway at the far horizon's end, without any control.
    let ends = |predictive: &Predictive| predictive.free.map(|nodes| nodes.at(BLOCKS - 1).velocity);
    let mut plain = predictive();
    begun(&mut plain, 2.0, 1.5);
    let [surge, sway] = ends(&plain);
    assert_eq!(plain.horizon, Horizon::Far);
    assert!((surge - 3.0).abs() < 1e-9, "2 m/s2 over 1.5 s: {surge} m/s");
    assert!(sway > 6.0, "2 m/s2 over 6 s, some of it expected to fade: {sway} m/s");

    let mut endless = predictive();
    begun(&mut endless, 2.0, f64::INFINITY);
    assert_eq!(endless.horizon, Horizon::Near);
    let [surge, sway] = ends(&endless);
    assert!(surge == sway && surge > 4.0, "{surge}, {sway}");

    let mut previewed = predictive();
    previewed.preview(&[PreviewedCue { step: 0.5, count: 12, values: [2.0; _], ..PreviewedCue::default() }; 2]);
    begun(&mut previewed, 2.0, 1.5);
    let [surge, sway] = ends(&previewed);
    assert!(surge == sway && surge > 6.0, "{surge}, {sway}");
}

#[test]
fn the_plan_keeps_the_actuators_within_their_stroke() {
    let geometry = Geometry::from(&Rig::default());
    let half = 0.06;
    let narrow = narrow(&geometry, half);
    let middle = narrow.stroke.iter().sum::<f64>() / 2.0;
    let mut predictive = predictive();
    let states = [AxisState { tilt: 0.05, ..AxisState::default() }, AxisState { tilt: -0.03, ..AxisState::default() }];
    passed_in(&mut predictive, &narrow, 3000, &states, [5.0, 3.0]);
    assert!(!predictive.plan.kept);
    let DenseRows { normals, lower, upper } = rows(&predictive);
    assert!(normals.iter().all(|normal| normal.amax() > 0.0), "each row limits something");
    assert!((upper - lower).add_scalar(-2.0).amax() < 1e-12);
    // The plan is that of the step before, about which the rows are linear.
    let mut farthest = 0.0_f64;
    for (node, legs) in leg_rows(&narrow, &predictive.plan.nodes, Horizon::Near).iter().enumerate() {
        for leg in legs {
            let states = predictive.plan.nodes.map(|nodes| nodes.at(node));
            let length = length(leg, states.map(|axis| axis.position), states.map(|axis| axis.tilt));
            farthest = farthest.max((length - middle).abs());
            assert!((length - middle).abs() < half + 1e-3, "node {node}: {length} m");
        }
    }
    assert!(farthest > half - 1e-3, "a strong reference must reach a limit: {farthest} m");
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
    let AxisState { position, velocity, tilt, tilt_rate, .. } = *state;
    let Decision { dropped_force, tilt_acceleration } = *decision;
    let acceleration = reference + dropped_force - MODEL.gravity * tilt + MODEL.head_height * tilt_acceleration;
    AxisState {
        position: position + velocity * step,
        velocity: velocity + acceleration * step,
        tilt: tilt + tilt_rate * step,
        tilt_rate: tilt_rate + tilt_acceleration * step,
        tilt_acceleration,
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
        let references =
            [[(2.5, 0.07), (1.5, 0.21), (0.8, 0.9), (0.3, 11.0)], [(1.8, 0.09), (1.2, 0.33), (0.7, 1.1), (0.3, 13.0)]]
                .map(waves);
        let due = predictive.due;
        let decisions = predictive.decide(&states, &leg_context(&geometry), f64::INFINITY, STEP).unwrap_or_default();
        if due && predictive.solver.status() == Status::Running && predictive.solver.iterations() == 0 {
            begun += 1;
            if begun % 5 == 0 {
                // The solve begins at the minimum without rows, -J J' times the gradient.
                let factor = *predictive.programs.over(predictive.horizon).factor;
                let inverse = factor.try_inverse().unwrap();
                let gradient = -inverse.tr_mul(&(inverse * predictive.solver.solution()));
                compare(&Program { factor, gradient, rows: rows(&predictive) });
            }
        }
        limited += usize::from(predictive.plan().iterations > 10);
        for (axis, state) in states.iter_mut().enumerate() {
            *state = moved(state, &decisions[axis], references[axis], STEP);
        }
        predictive.observe(references, [0.0; 2], &Vector3::zeros(), STEP);
    }
    // The ride is long and demands more than the platform can do.
    assert!(begun > 1000 && limited > 1000, "{begun} programs, {limited}");
}

#[test]
fn the_factor_is_that_of_the_hessian() {
    let predictive = predictive();
    for horizon in [Horizon::Near, Horizon::Far] {
        let program = predictive.programs.over(horizon);
        let inverse = *program.factor * program.factor.transpose();
        for (k, axis) in program.axes.iter().enumerate() {
            let begin = k * AXIS_CONTROLS;
            let product = axis.hessian() * inverse.fixed_view::<AXIS_CONTROLS, AXIS_CONTROLS>(begin, begin);
            let difference = (product - SMatrix::identity()).amax();
            assert!(difference < 1e-8, "axis {k}: {difference}");
        }
    }
}

#[test]
fn condensed_nodes_are_those_of_the_block_equations() {
    let predictive = predictive();
    let controls = AxisControls::from_fn(|k, _| 0.3 * (k as f64).sin());
    let state = AxisState { position: 0.1, velocity: -0.2, tilt: 0.05, tilt_rate: 0.01, tilt_acceleration: -0.05 };
    let mut forecast = expected::Forecast::default();
    forecast.means.fill(0.7);
    let axis = &predictive.programs.near.axes[0];
    let data = axis.data(&state, -0.4, &forecast);
    let nodes = axis.nodes(&axis.free_nodes(&data), &controls);
    let (mut x, mut v, mut q, mut w) = (0.1, -0.2, 0.05, 0.01);
    let (mut dropped_before, mut alpha_before) = (-0.4, -0.05);
    for block in 0..BLOCKS {
        let alpha_after = MODEL.acceleration_limit * controls[BLOCKS + block];
        let steps = 20_000;
        let duration = Horizon::Near.durations()[block];
        let step = duration / f64::from(steps);
        for k in 0..steps {
            if 2 * k == steps && block > 0 {
                let [before, after] = [block - 1, block].map(|node| core::array::from_fn(|k| nodes.0[4 * node + k]));
                let found = axis.middle(&before, &after, block, controls[BLOCKS + block]);
                // The ramp's part is left out.
                let lever = MODEL.head_height + MODEL.gravity * duration * duration;
                let ramp = lever * TILT_RAMP_TIME * duration * (alpha_after - alpha_before).abs();
                assert!((found - x).abs() < 1e-8 + ramp / 16.0, "middle of block {block}: {found}, {x}");
            }
            let fraction = (f64::from(k) + 0.5) / f64::from(steps);
            let dropped = dropped_before + fraction * (controls[block] - dropped_before);
            let ramped = (duration * fraction / TILT_RAMP_TIME).min(1.0);
            let alpha = alpha_before + ramped * (alpha_after - alpha_before);
            let middle = q + 0.5 * step * (w + step * alpha / 3.0);
            let a = 0.7 + MODEL.head_height * alpha - program::GRAVITY_ALONG_TILT * MODEL.gravity * middle + dropped;
            x += step * (v + 0.5 * step * a);
            v += step * a;
            q += step * (w + 0.5 * step * alpha);
            w += step * alpha;
        }
        (dropped_before, alpha_before) = (controls[block], alpha_after);
        let AxisState { position, velocity, tilt, tilt_rate, .. } = nodes.at(block);
        for (k, (found, expected)) in [position, velocity, tilt, tilt_rate].into_iter().zip([x, v, q, w]).enumerate() {
            assert!((found - expected).abs() < 1e-8, "block {block}, state {k}: {found}, {expected}");
        }
    }
}

#[test]
fn a_solve_of_too_many_iterations_is_abandoned_and_the_plan_before_kept() {
    let geometry = Geometry::from(&Rig::default());
    // Far beyond the limits, where most rows contradict each other.
    let far = AxisState { position: 0.5, velocity: 0.9, tilt: 0.3, tilt_rate: 0.05, ..AxisState::default() };
    let mut predictive = predictive();
    predictive.begin(&[far; 2], &narrow(&geometry, 0.1), f64::INFINITY);
    let before = predictive.plan;
    for _ in 0..15 {
        assert_eq!(predictive.solver.status(), Status::Running);
        predictive.proceed(0.001);
    }
    assert_eq!(predictive.solver.status(), Status::Failed);
    assert_eq!(predictive.plan, Plan { kept: true, iterations: 120, ..before });
}
