//! Travel and tilt that add up: what all strategies but the classical one have in common.
//!
//! On either axis, with a tilt q whose gravity acts along it (surge: nose up; sway:
//! roll), the rider feels
//!
//! ```text
//!     felt = cos(q + b) a - H (alpha + b'') + (g + z'') sin(q + b)
//! ```
//!
//! where b is the platform's other rotation about that axis, z is heave and H the height of the
//! head. A strategy decides on the tilt's acceleration alpha and on a *dropped force* e. The
//! travel's acceleration a follows from felt = r + e, with r the cue at the step's end. The part of
//! the cue that is not dropped is felt at once, however rarely a strategy decides.
//!
//! Strategies follow the *effective reference* f = r - g sin(b) + H b'', which already contains b.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::at_rest_if_tiny;
use super::law::{AxisState, Decision, LawInput, StepContext, Unsolvable};
use super::laws::AnyLaw;
use super::regulator::AxisModel;
use super::smooth_tilt::TiltLimits;
use crate::cueing::compensation::{centripetal, tangential};
use crate::interface::{Parameters, SafetyParameters, TiltParameters};
use crate::motion::Motion;
use crate::motion::braking_law::Limits;
use crate::motion::min_max::min;
use crate::motion::orientation::RotationalMotion;
use crate::platform::LocationFrame;
use crate::platform::reach::horizontal_reach;

/// Travel and tilt of surge and sway, and the law that decides on them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coordinated {
    pub law: AnyLaw,
    /// The tilts q of surge and sway.
    tilt: [Motion; 2],
    /// True if a limit stops either tilt.
    pub limited: bool,
    dropped_force: [f64; 2],
    /// Weight of the law in force, with the engagement; the rest of the motion returns to neutral.
    law_weight: f64,
    /// Weight of the law's decisions: 1 while it decides, falling to 0 where it has none, as after
    /// the end of a plan.
    decision_weight: f64,
}

/// Disengaged, travel returns to neutral critically damped at this frequency \[rad/s\].
const RETURN_FREQUENCY: f64 = 1.0;
/// Disengaged, the tilt returns to level critically damped at this frequency \[rad/s\].
const LEVEL_FREQUENCY: f64 = 2.0;
/// Time over which the return to neutral fades in after a plan's end \[s\].
const DECISION_FADE: f64 = 1.0;
/// A tilt within this fraction of its angle's or rate's limit counts as limited.
const LIMITED_FRACTION: f64 = 0.999;
/// Smallest magnitude of the determinant of the head's axes that is divided by. Only a platform
/// that is nearly turned on its side has a smaller one.
const LEAST_DETERMINANT: f64 = 0.1;

impl Coordinated {
    /// At rest at neutral, by the strategy that the parameters choose. None if that
    /// is the classical one.
    ///
    /// # Errors
    /// The strategy's weights cannot be used.
    pub fn new(parameters: &Parameters) -> Result<Option<Self>, Unsolvable> {
        let law = AnyLaw::of(&models(parameters), parameters)?;
        Ok(law.map(|law| Coordinated {
            law,
            tilt: [Motion::default(); 2],
            limited: false,
            dropped_force: [0.0; 2],
            law_weight: 1.0,
            decision_weight: 1.0,
        }))
    }

    /// Takes other parameters.
    ///
    /// # Errors
    /// The strategy's weights cannot be used. Nothing has changed then.
    pub fn retune(&mut self, parameters: &Parameters) -> Result<(), Unsolvable> {
        self.law.set_parameters(&models(parameters), parameters)
    }

    /// States of surge and sway.
    fn states(&self, linear: &Motion<Vector3<f64>>) -> [AxisState; 2] {
        [0, 1].map(|k: usize| AxisState {
            position: linear.position[k],
            velocity: linear.velocity[k],
            tilt: self.tilt[k].position,
            tilt_rate: self.tilt[k].velocity,
            tilt_acceleration: self.tilt[k].acceleration,
        })
    }

    /// Roll and pitch of the tilt.
    pub fn tilt(&self) -> [Motion; 2] {
        let [surge, sway] = self.tilt;
        [sway, surge.map(|value| -value)]
    }

    /// Advances the tilt by `step` seconds, and decides on the dropped force.
    pub fn advance_tilt(&mut self, context: &StepContext, step: f64) {
        let StepContext { parameters, guard, engagement, .. } = *context;
        let states = self.states(&guard.commanded().coordinates.linear);
        let law_input = LawInput { states, references: context.effective_references(), context };
        let decisions = self.law.decisions(&law_input, step);
        // Where a law has nothing to decide by, the dropped force stays while the return fades in.
        let change = step / DECISION_FADE;
        self.decision_weight =
            (self.decision_weight + if decisions.is_some() { change } else { -change }).clamp(0.0, 1.0);
        let law_weight = self.decision_weight * engagement;
        let decisions = decisions
            .unwrap_or(self.dropped_force.map(|dropped_force| Decision { dropped_force, tilt_acceleration: 0.0 }));
        let TiltParameters { angle_limit, rate_limit, acceleration_limit, tracking: _ } = parameters.tilt;
        let max_step = parameters.structure.max_step;
        let limits = Limits::symmetric(angle_limit, rate_limit, acceleration_limit, max_step);
        let smooth = TiltLimits::new(angle_limit, rate_limit, acceleration_limit);
        self.limited = false;
        for (k, decision) in decisions.iter().enumerate() {
            let now = self.tilt[k];
            let returning = -LEVEL_FREQUENCY * (LEVEL_FREQUENCY * now.position + 2.0 * now.velocity);
            let demanded = law_weight * decision.tilt_acceleration + (1.0 - law_weight) * returning;
            let acceleration = smooth.nearest_acceleration(&law_input.states[k], demanded, step);
            let next = limits.at_velocity(&now, now.velocity + acceleration * step, step);
            self.limited |= next.position.abs() >= LIMITED_FRACTION * angle_limit;
            self.limited |= next.velocity.abs() >= LIMITED_FRACTION * rate_limit;
            self.tilt[k] = next.map(at_rest_if_tiny);
            self.dropped_force[k] = decision.dropped_force;
        }
        self.law_weight = law_weight;
    }

    /// Surge and sway at the end of a step, such that the rider feels the cue plus the dropped
    /// force. `turning` is the platform's rotation there, and `heave` its heave.
    pub fn travel(&self, context: &StepContext, turning: &RotationalMotion, heave: &Motion, step: f64) -> [Motion; 2] {
        let StepContext { parameters, guard, head, force, .. } = *context;
        let rotation = &turning.orientation.rotation;
        let arm = rotation * head.point;
        let mut other_acceleration = tangential(turning.acceleration, arm) + centripetal(turning.velocity, arm);
        other_acceleration.z += heave.acceleration + parameters.structure.gravity;
        // The head's x and y, in the base frame: felt = axis . (a + other), with the acceleration of travel a.
        let axes = [Vector3::x(), Vector3::y()].map(|axis| rotation * head.to_platform_axes(axis));
        let now = &guard.commanded().coordinates.linear;
        // Disengaged, travel returns to neutral, and the rider feels that and the tilt's gravity. The tilt's
        // acceleration is compensated all the same: it may jump.
        let returning = -RETURN_FREQUENCY * (RETURN_FREQUENCY * now.position + 2.0 * now.velocity);
        let alone = Vector3::new(returning.x, returning.y, heave.acceleration + parameters.structure.gravity);
        let needed = [0, 1].map(|k: usize| {
            let cued = force[k] + self.dropped_force[k];
            self.law_weight * cued + (1.0 - self.law_weight) * axes[k].dot(&alone) - axes[k].dot(&other_acceleration)
        });
        let determinant = axes[0].x * axes[1].y - axes[0].y * axes[1].x;
        let divisor = determinant.abs().max(LEAST_DETERMINANT).copysign(determinant);
        let accelerations = [
            (needed[0] * axes[1].y - needed[1] * axes[0].y) / divisor,
            (needed[1] * axes[0].x - needed[0] * axes[1].x) / divisor,
        ];
        [0, 1].map(|k: usize| {
            let now = now.axis(k);
            let limits = Limits::safety(&parameters.safety, k, parameters.structure.max_step);
            limits.at_velocity(&now, now.velocity + accelerations[k] * step, step).map(at_rest_if_tiny)
        })
    }
}

impl StepContext<'_> {
    /// The effective references of surge and sway \[m/s2\].
    fn effective_references(&self) -> [f64; 2] {
        let StepContext { force, angles, head, lean, .. } = self;
        let gravity = self.parameters.structure.gravity;
        let turned = [-angles.position.y, angles.position.x + lean];
        let turning = [-angles.acceleration.y, angles.acceleration.x];
        [0, 1].map(|k: usize| force[k] - gravity * libm::sin(turned[k]) + head.point.z * turning[k])
    }
}

/// The strategies' models of surge and sway.
pub(in crate::cueing) fn models(parameters: &Parameters) -> [AxisModel; 2] {
    let Parameters { tilt, safety, structure, rig, .. } = parameters;
    let TiltParameters { angle_limit, rate_limit, acceleration_limit, tracking: _ } = *tilt;
    let SafetyParameters { position_limit, velocity_limit, acceleration_limit: _ } = safety;
    let reach = horizontal_reach(rig);
    let head_height = LocationFrame::new(structure, 0.0).point.z;
    [0, 1].map(|k: usize| AxisModel {
        head_height,
        gravity: structure.gravity,
        position_limit: min(position_limit[k], reach[k]),
        velocity_limit: velocity_limit[k],
        angle_limit,
        rate_limit,
        acceleration_limit,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cueing::evaluator::felt;
    use crate::cueing::strategy::predictive::legs::LegContext;
    use crate::cueing::strategy::regulator::Regulator;
    use crate::interface::StrategyKind;
    use crate::platform::{ActuatorGuard, PlatformCoordinates, PlatformMotion};
    use crate::presets;

    const STEP: f64 = 0.004;

    fn parameters(strategy: StrategyKind) -> Parameters {
        presets::with("", &[("strategy", 1.0 + strategy as i32 as f64), ("solver.maxStep", STEP)])
    }

    fn coordinated(parameters: &Parameters) -> Coordinated {
        Coordinated::new(parameters).unwrap().expect("the strategy is not the classical one")
    }

    /// A turn that has a part of everything.
    fn turn() -> Motion<Vector3<f64>> {
        Motion {
            position: Vector3::new(0.2, -0.15, 0.3),
            velocity: Vector3::new(0.4, 0.3, -0.5),
            acceleration: Vector3::new(-1.5, 1.0, 0.7),
        }
    }

    /// A guard a step after it set off from neutral.
    fn moving(parameters: &Parameters) -> ActuatorGuard {
        let mut guard = ActuatorGuard::new(&parameters.rig, STEP);
        let acceleration = Vector3::new(2.0, -1.0, 0.5);
        let linear = Motion { position: 0.5 * STEP * STEP * acceleration, velocity: STEP * acceleration, acceleration };
        let demand = PlatformCoordinates { linear, angles: Motion::default() };
        guard.advance(&guard.state(demand), &parameters.safety, false, STEP);
        assert_eq!(guard.commanded().coordinates, demand);
        guard
    }

    /// Runs `check` in context with this engagement, with the platform and the rider in
    /// motion.
    fn in_circumstances(parameters: &Parameters, engagement: f64, check: impl FnOnce(&StepContext)) {
        let guard = moving(parameters);
        check(&StepContext {
            parameters,
            guard: &guard,
            head: &LocationFrame::new(&parameters.structure, 0.1),
            force: Vector3::new(1.0, -0.7, 9.5),
            angles: &turn(),
            lean: 0.1 * engagement,
            engagement,
            time_to_stop: f64::INFINITY,
        });
    }

    /// The force felt with this travel.
    fn felt_force(context: &StepContext, turning: &RotationalMotion, travel: [Motion; 2], heave: &Motion) -> [f64; 2] {
        let Parameters { structure, rig, .. } = context.parameters;
        let linear = Motion::from_axes(|k| [travel[0], travel[1], *heave][k]);
        let motion = PlatformMotion::new(&linear, turning, rig.neutral_height);
        let force = felt(&motion, context.head, structure.gravity).specific_force;
        [force.x, force.y]
    }

    const HEAVE: Motion = Motion { position: 0.02, velocity: 0.1, acceleration: 0.8 };

    #[test]
    fn the_felt_force_is_the_cue_and_the_dropped_force() {
        for strategy in [StrategyKind::Adaptive, StrategyKind::Optimal] {
            let parameters = parameters(strategy);
            in_circumstances(&parameters, 1.0, |context| {
                let mut strategy = coordinated(&parameters);
                strategy.advance_tilt(context, STEP);
                let turning = RotationalMotion::new(context.angles);
                let travel = strategy.travel(context, &turning, &HEAVE, STEP);
                let felt = felt_force(context, &turning, travel, &HEAVE);
                for k in 0..2 {
                    let dropped = strategy.dropped_force[k];
                    assert!(dropped.abs() > 1e-3, "{dropped}");
                    assert!((felt[k] - context.force[k] - dropped).abs() < 1e-11, "{felt:?}, dropped {dropped}");
                    let now = context.guard.commanded().coordinates.linear.axis(k);
                    let mean = 0.5 * (now.velocity + travel[k].velocity);
                    assert!((travel[k].position - now.position - mean * STEP).abs() < 1e-15);
                }
            });
        }
    }

    #[test]
    fn a_platform_turned_on_its_side_needs_no_unbounded_travel() {
        let parameters = parameters(StrategyKind::Optimal);
        in_circumstances(&parameters, 1.0, |context| {
            // The determinant is the roll's cosine, -0.03 and 0.02 here.
            for roll in [1.6_f64, 1.55] {
                let head = LocationFrame::new(&parameters.structure, 0.0);
                let angles = Motion { position: Vector3::new(roll, 0.0, 0.0), ..Motion::default() };
                let context = StepContext { head: &head, angles: &angles, ..*context };
                let strategy = coordinated(&parameters);
                let turning = RotationalMotion::new(&angles);
                // Heave falls with the gravity: only the cue in sway is left.
                let heave = Motion { acceleration: -parameters.structure.gravity, ..HEAVE };
                let travel = strategy.travel(&context, &turning, &heave, STEP);
                let [_, felt] = felt_force(&context, &turning, travel, &heave);
                let expected = -0.7 * roll.cos().abs() / LEAST_DETERMINANT;
                assert!((felt - expected).abs() < 1e-11, "{felt} beside {expected}");
            }
        });
    }

    #[test]
    fn the_law_sees_the_effective_reference_and_the_platforms_motion() {
        let parameters = parameters(StrategyKind::Optimal);
        let Parameters { optimal, tilt, safety, structure, .. } = parameters;
        in_circumstances(&parameters, 1.0, |context| {
            let mut strategy = coordinated(&parameters);
            let before = [0.01, -0.02].map(|position| Motion { position, velocity: 0.5 * position, acceleration: 0.0 });
            strategy.tilt = before;
            strategy.advance_tilt(context, STEP);
            let turn = turn();
            let height = context.head.point.z;
            let (gravity, lean) = (structure.gravity, 0.1);
            let references = [
                1.0 + gravity * turn.position.y.sin() - height * turn.acceleration.y,
                -0.7 - gravity * (turn.position.x + lean).sin() + height * turn.acceleration.x,
            ];
            for k in 0..2 {
                let model = AxisModel {
                    head_height: structure.head_height,
                    gravity,
                    position_limit: safety.position_limit[k],
                    velocity_limit: safety.velocity_limit[k],
                    angle_limit: tilt.angle_limit,
                    rate_limit: tilt.rate_limit,
                    acceleration_limit: tilt.acceleration_limit,
                };
                let tuning = super::super::optimal::Tuning::from(&optimal);
                let gains = Regulator::new(&model, &tuning.weights).unwrap().gains;
                let now = context.guard.commanded().coordinates.linear.axis(k);
                let slow = references[k] * (1.0 - (-STEP / optimal.split_time).exp());
                let Motion { position, velocity, .. } = before[k];
                let state = [now.position, now.velocity, position, velocity, slow, references[k] - slow];
                let decided = [0, 1].map(|i| -(0..6).map(|j| gains[(i, j)] * state[j]).sum::<f64>());
                let Motion { velocity: rate, .. } = strategy.tilt[k];
                assert!((strategy.dropped_force[k] - decided[0]).abs() < 1e-11, "{decided:?}");
                let state = AxisState {
                    tilt: position,
                    tilt_rate: velocity,
                    tilt_acceleration: before[k].acceleration,
                    ..AxisState::default()
                };
                let limits = TiltLimits::new(tilt.angle_limit, tilt.rate_limit, tilt.acceleration_limit);
                let expected = velocity + STEP * limits.nearest_acceleration(&state, decided[1], STEP);
                assert!((rate - expected).abs() < 1e-13, "{rate} beside {expected}");
            }
            let [roll, pitch] = strategy.tilt();
            let [surge, sway] = strategy.tilt;
            let reversed = [-pitch.position, -pitch.velocity, -pitch.acceleration];
            assert_eq!((roll, reversed), (sway, [surge.position, surge.velocity, surge.acceleration]));
        });
    }

    #[test]
    fn between_engaged_and_disengaged_the_law_and_the_return_mix() {
        let mut parameters = parameters(StrategyKind::Optimal);
        // The tilt's acceleration builds up within the step, and stays small.
        parameters.tilt.acceleration_limit = 100.0;
        parameters.optimal.weight_tilt_acceleration = 1e5;
        let before = Motion { position: 0.002, velocity: 0.0005, acceleration: 0.0 };
        let after = |engagement: f64| {
            let mut strategy = coordinated(&parameters);
            strategy.tilt = [before; 2];
            let mut travel = [Motion::default(); 2];
            in_circumstances(&parameters, engagement, |context| {
                // The same decisions for every engagement, within the limits.
                let angles = Motion::default();
                let force = Vector3::new(0.02, -0.015, 9.8);
                let context = StepContext { lean: 0.0, angles: &angles, force, ..*context };
                strategy.advance_tilt(&context, STEP);
                let turning = RotationalMotion::new(context.angles);
                travel = strategy.travel(&context, &turning, &HEAVE, STEP);
            });
            (strategy.tilt.map(|tilt| tilt.velocity), travel.map(|axis| axis.acceleration))
        };
        let (engaged, mixed, disengaged) = (after(1.0), after(0.25), after(0.0));
        for k in 0..2 {
            let tilt = 0.25 * engaged.0[k] + 0.75 * disengaged.0[k];
            assert!((mixed.0[k] - tilt).abs() < 1e-15);
            let travel = 0.25 * engaged.1[k] + 0.75 * disengaged.1[k];
            assert!((mixed.1[k] - travel).abs() < 1e-10);
            let now = moving(&parameters).commanded().coordinates.linear.axis(k);
            assert!(
                (disengaged.1[k] + now.position + 2.0 * now.velocity).abs() < 1e-12,
                "critically damped at 1 rad/s"
            );
            assert!(disengaged.0[k] < before.velocity && engaged.0[k] != disengaged.0[k], "the tilt levels");
        }
    }

    #[test]
    fn a_tilt_near_its_limit_of_angle_or_rate_is_limited() {
        let parameters = parameters(StrategyKind::Optimal);
        let limited = |axis: usize, angle: f64, rate: f64| {
            let mut strategy = coordinated(&parameters);
            strategy.limited = true;
            strategy.tilt[axis].position = angle * parameters.tilt.angle_limit;
            strategy.tilt[axis].velocity = rate * parameters.tilt.rate_limit;
            in_circumstances(&parameters, 1.0, |context| {
                // So short a step hardly changes the tilt.
                strategy.advance_tilt(context, 1e-6);
            });
            strategy.limited
        };
        for axis in 0..2 {
            for sign in [1.0, -1.0] {
                assert!(limited(axis, sign * 0.9995, 0.0) && !limited(axis, sign * 0.9985, 0.0));
                assert!(limited(axis, 0.0, sign * 0.9995) && !limited(axis, 0.0, sign * 0.9985));
            }
        }
    }

    #[test]
    fn only_the_predictive_strategy_bounds_heave() {
        let largest = |strategy| coordinated(&parameters(strategy)).law.largest_heave();
        assert_eq!(largest(StrategyKind::Predictive), 0.1);
        assert_eq!([StrategyKind::Adaptive, StrategyKind::Optimal].map(largest), [f64::INFINITY; 2]);
    }

    #[test]
    fn after_a_plans_end_the_dropped_force_stays_while_the_return_fades_in() {
        let parameters = parameters(StrategyKind::Predictive);
        in_circumstances(&parameters, 1.0, |context| {
            let angles = Motion::default();
            let context = &StepContext { force: Vector3::new(4.0, 2.0, 9.8), angles: &angles, lean: 0.0, ..*context };
            let mut strategy = coordinated(&parameters);
            for _ in 0..250 {
                strategy.advance_tilt(context, STEP);
            }
            // Nothing can be planned for what is not a number.
            let force = Vector3::new(f64::NAN, f64::NAN, 9.8);
            let unknown = StepContext { force, ..*context };
            let mut before = strategy.clone();
            let (mut fading, mut largest) = (0, 0.0_f64);
            for _ in 0..1100 {
                strategy.advance_tilt(&unknown, STEP);
                assert!((strategy.law_weight - before.law_weight).abs() < 1.001 * STEP);
                if strategy.law_weight < 1.0 {
                    fading += 1;
                    assert_eq!(strategy.dropped_force, before.dropped_force);
                    largest = largest.max(strategy.dropped_force[0].abs());
                }
                before = strategy.clone();
            }
            assert!(strategy.law_weight == 0.0 && fading > 250 && largest > 0.01, "{fading} steps, {largest} m/s2");
        });
    }

    #[test]
    fn plans_keep_a_margin_from_the_ends_of_the_strokes() {
        let mut parameters = parameters(StrategyKind::Predictive);
        parameters.angular.omega1.pitch *= 2.0;
        parameters.angular.omega1.yaw *= 3.0;
        // Of the clearance at neutral, whose length is 0.04 mm below the stroke's middle, half is left.
        for (margin, kept, rounding) in [(0.02, 0.02, 1e-12), (10.0, 0.15, 2e-5)] {
            parameters.predictive.leg_margin = margin;
            in_circumstances(&parameters, 1.0, |context| {
                let leg_context = LegContext::of(context);
                for (found, expected) in leg_context.planned_stroke().into_iter().zip([1.0 + kept, 1.6 - kept]) {
                    assert!((found - expected).abs() < rounding, "{found} m beside {expected}");
                }
                let heave = context.guard.commanded().coordinates.linear.axis(2);
                assert_eq!((leg_context.heave, leg_context.heave_velocity), (heave.position, heave.velocity));
                let omega = parameters.angular.omega1;
                assert_eq!(leg_context.frequencies, Vector3::new(omega.roll, omega.pitch, omega.yaw));
            });
        }
    }

    #[test]
    fn tiny_motions_are_none() {
        let tiny = |value: f64| Motion { position: value, velocity: -value, acceleration: value };
        assert_eq!(tiny(1e-31).map(at_rest_if_tiny), Motion::default());
        assert_eq!(tiny(1e-29).map(at_rest_if_tiny), tiny(1e-29));
    }
}
