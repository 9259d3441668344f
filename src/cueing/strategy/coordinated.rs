//! Travel and tilt that add up: what the adaptive, the optimal and the predictive
//! strategy have in common.
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

use super::adaptive::Adaptive;
use super::optimal::Optimal;
use super::predictive::legs::Surroundings;
use super::predictive::{Plan, Predictive};
use super::regulator::AxisModel;
use super::{AxisState, at_rest_if_tiny};
use crate::cueing::compensation::{centripetal, tangential};
use crate::interface::{Parameters, StrategyKind};
use crate::motion::Motion;
use crate::motion::braking_law::Limits;
use crate::motion::orientation::RotationalMotion;
use crate::platform::LocationFrame;
use crate::platform::{ActuatorGuard, Geometry};

/// Travel and tilt of surge and sway, and the law that decides on them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coordinated {
    geometry: Geometry,
    law: Law,
    /// The tilts q of surge and sway.
    tilt: [Motion; 2],
    /// True if a limit stops either tilt.
    pub limited: bool,
    dropped_force: [f64; 2],
    /// Fraction of the law in force; the rest returns to neutral.
    fraction: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(clippy::large_enum_variant, reason = "a law is chosen once, and a box would allocate when a state is copied")]
enum Law {
    Adaptive(Adaptive),
    Optimal(Optimal),
    Predictive(Box<Predictive>),
}

/// State at a step's beginning, and the known part of its end.
#[derive(Clone, Copy, Debug)]
pub struct Circumstances<'a> {
    pub parameters: &'a Parameters,
    pub guard: &'a ActuatorGuard,
    pub head: &'a LocationFrame,
    /// The cue at the step's end, in head axes \[m/s2\].
    pub force: Vector3<f64>,
    /// Roll, pitch and yaw beside the tilt, at the step's end.
    pub angles: &'a Motion<Vector3<f64>>,
    /// The rider's lean as far as the platform makes up for it \[rad\].
    pub lean: f64,
    /// 1: engaged, 0: disengaged; between them: being engaged or disengaged.
    pub engagement: f64,
    /// Time until the vehicle stands, infinite while no stop is foreseen \[s\].
    pub time_to_stop: f64,
}

/// Disengaged, travel returns to neutral critically damped at this frequency \[rad/s\].
const RETURN_FREQUENCY: f64 = 1.0;
/// A tilt within this fraction of its angle's or rate's limit counts as limited.
const NEARLY: f64 = 0.999;
/// Smallest magnitude of the determinant of the head's axes that is divided by. Only a platform
/// that is nearly turned on its side has a smaller one.
const LEAST_DETERMINANT: f64 = 0.1;
/// Bound on heave under the predictive strategy \[m\]. Heave far below it hardly changes.
const SOFT_HEAVE: f64 = 0.1;

impl Coordinated {
    /// At rest at neutral, by the strategy that the parameters choose. None if its
    /// parameters cannot be used.
    pub fn new(parameters: &Parameters) -> Option<Self> {
        let models = models(parameters);
        let law = match parameters.structure.strategy {
            StrategyKind::Adaptive => Law::Adaptive(Adaptive::new(&models, &parameters.adaptive)),
            StrategyKind::Predictive => {
                Law::Predictive(Box::new(Predictive::new(&models, &(&parameters.predictive).into())?))
            }
            StrategyKind::Optimal | StrategyKind::Classical => {
                Law::Optimal(Optimal::new(&models, &(&parameters.optimal).into())?)
            }
        };
        Some(Coordinated {
            geometry: Geometry::from(&parameters.rig),
            law,
            tilt: [Motion::default(); 2],
            limited: false,
            dropped_force: [0.0; 2],
            fraction: 1.0,
        })
    }

    /// Takes other parameters. False, and nothing changes, if they cannot be used.
    pub fn retune(&mut self, parameters: &Parameters) -> bool {
        let models = models(parameters);
        match &mut self.law {
            Law::Adaptive(adaptive) => {
                adaptive.retune(&models, &parameters.adaptive);
                true
            }
            Law::Optimal(optimal) => optimal.retune(&models, &(&parameters.optimal).into()),
            Law::Predictive(predictive) => predictive.retune(&models, &(&parameters.predictive).into()),
        }
    }

    /// Roll and pitch of the tilt.
    pub fn tilt(&self) -> [Motion; 2] {
        let [surge, sway] = self.tilt;
        let pitch = Motion { position: -surge.position, velocity: -surge.velocity, acceleration: -surge.acceleration };
        [sway, pitch]
    }

    /// The plan of the predictive strategy.
    pub fn plan(&self) -> Option<&Plan> {
        match &self.law {
            Law::Predictive(predictive) => Some(predictive.plan()),
            Law::Adaptive(_) | Law::Optimal(_) => None,
        }
    }

    /// The predictive strategy, which alone makes use of a preview.
    pub fn predictive_mut(&mut self) -> Option<&mut Predictive> {
        match &mut self.law {
            Law::Predictive(predictive) => Some(predictive),
            Law::Adaptive(_) | Law::Optimal(_) => None,
        }
    }

    /// Advances the tilt by `step` seconds, and decides on the dropped force.
    pub fn advance_tilt(&mut self, circumstances: &Circumstances, step: f64) {
        let Circumstances { parameters, guard, engagement, .. } = *circumstances;
        let linear = &guard.coordinates().linear;
        let states = [0, 1].map(|k: usize| AxisState {
            position: linear.position[k],
            velocity: linear.velocity[k],
            tilt: self.tilt[k].position,
            tilt_rate: self.tilt[k].velocity,
        });
        let references = circumstances.effective_references();
        let decisions = match &mut self.law {
            Law::Adaptive(adaptive) => Some(adaptive.decide(&states, references, guard.stroke_margin(), step)),
            Law::Optimal(optimal) => Some(optimal.decide(&states, references, step)),
            Law::Predictive(predictive) => {
                let decisions = predictive.decide(
                    &states,
                    &circumstances.surroundings(&self.geometry),
                    circumstances.time_to_stop,
                    step,
                );
                let beside = [0, 1].map(|k: usize| references[k] - circumstances.force[k]);
                predictive.observe(references, beside, step);
                decisions
            }
        };
        let fraction = if decisions.is_some() { engagement } else { 0.0 };
        let decisions = decisions.unwrap_or_default();
        let tilt = &parameters.tilt;
        let longest_step = parameters.structure.max_step;
        let limits = Limits::symmetric(tilt.angle_limit, tilt.rate_limit, tilt.acceleration_limit, longest_step);
        self.limited = false;
        for (k, decision) in decisions.iter().enumerate() {
            let now = self.tilt[k];
            let level = limits.follow(&now, &Motion::default(), tilt.acceleration_limit, step);
            let decided = now.velocity + decision.tilt_acceleration * step;
            let next = limits.at_velocity(&now, fraction * decided + (1.0 - fraction) * level.velocity, step);
            self.limited |= next.position.abs() >= NEARLY * tilt.angle_limit;
            self.limited |= next.velocity.abs() >= NEARLY * tilt.rate_limit;
            self.tilt[k] = flushed(&next);
            self.dropped_force[k] = decision.dropped_force;
        }
        self.fraction = fraction;
    }

    /// Surge and sway at the end of a step, such that the rider feels the cue plus the dropped
    /// force. `turning` is the platform's rotation there, and `heave` its heave.
    pub fn travel(
        &self,
        circumstances: &Circumstances,
        turning: &RotationalMotion,
        heave: &Motion,
        step: f64,
    ) -> [Motion; 2] {
        let Circumstances { parameters, guard, head, force, .. } = *circumstances;
        let rotation = &turning.orientation.rotation;
        let arm = rotation * head.point;
        let mut beside = tangential(turning.acceleration, arm) + centripetal(turning.velocity, arm);
        beside.z += heave.acceleration + parameters.structure.gravity;
        // The head's x and y, in the base frame: felt = axis . (a + beside).
        let axes = [Vector3::x(), Vector3::y()].map(|axis| rotation * head.to_platform_axes(axis));
        let needed = [0, 1].map(|k: usize| force[k] + self.dropped_force[k] - axes[k].dot(&beside));
        let determinant = axes[0].x * axes[1].y - axes[0].y * axes[1].x;
        let divisor = determinant.abs().max(LEAST_DETERMINANT).copysign(determinant);
        let accelerations = [
            (needed[0] * axes[1].y - needed[1] * axes[0].y) / divisor,
            (needed[1] * axes[0].x - needed[0] * axes[1].x) / divisor,
        ];
        let now = &guard.coordinates().linear;
        [0, 1].map(|k: usize| {
            let now = now.axis(k);
            let homewards = -RETURN_FREQUENCY * (RETURN_FREQUENCY * now.position + 2.0 * now.velocity);
            let acceleration = self.fraction * accelerations[k] + (1.0 - self.fraction) * homewards;
            let limits = Limits::safety(&parameters.safety, k, parameters.structure.max_step);
            flushed(&limits.at_velocity(&now, now.velocity + acceleration * step, step))
        })
    }

    /// Heave under this strategy: softly bounded by the predictive one, unchanged by the others.
    pub fn heave(&self, heave: &Motion) -> Motion {
        match &self.law {
            Law::Predictive(_) => softened(heave),
            Law::Adaptive(_) | Law::Optimal(_) => *heave,
        }
    }
}

/// The motion, with components that are too small to matter set to zero.
fn flushed(motion: &Motion) -> Motion {
    Motion {
        position: at_rest_if_tiny(motion.position),
        velocity: at_rest_if_tiny(motion.velocity),
        acceleration: at_rest_if_tiny(motion.acceleration),
    }
}

/// z -> L tanh(z/L).
fn softened(heave: &Motion) -> Motion {
    let ratio = libm::tanh(heave.position / SOFT_HEAVE);
    let slope = 1.0 - ratio * ratio;
    let speed = heave.velocity;
    Motion {
        position: SOFT_HEAVE * ratio,
        velocity: slope * speed,
        acceleration: slope * (heave.acceleration - 2.0 * ratio * speed * speed / SOFT_HEAVE),
    }
}

impl Circumstances<'_> {
    /// The effective references of surge and sway \[m/s2\].
    fn effective_references(&self) -> [f64; 2] {
        let Circumstances { force, angles, head, lean, .. } = self;
        let gravity = self.parameters.structure.gravity;
        let turned = [-angles.position.y, angles.position.x + lean];
        let turning = [-angles.acceleration.y, angles.acceleration.x];
        [0, 1].map(|k: usize| force[k] - gravity * libm::sin(turned[k]) + head.point.z * turning[k])
    }

    fn surroundings<'a>(&'a self, geometry: &'a Geometry) -> Surroundings<'a> {
        let Parameters { rig, predictive, angular, .. } = self.parameters;
        let stroke = [rig.min_length, rig.max_length];
        // A margin of half the stroke would leave nothing: at most a quarter is kept.
        let margin = predictive.leg_margin.min(0.25 * (rig.max_length - rig.min_length));
        Surroundings {
            geometry,
            neutral_height: rig.neutral_height,
            stroke: [stroke[0] + margin, stroke[1] - margin],
            heave: self.guard.coordinates().linear.position.z,
            angles: self.angles.position,
            angle_rates: self.angles.velocity,
            frequencies: Vector3::new(angular.omega1.roll, angular.omega1.pitch, angular.omega1.yaw),
        }
    }
}

/// The strategies' models of surge and sway.
fn models(parameters: &Parameters) -> [AxisModel; 2] {
    let Parameters { tilt, safety, structure, .. } = parameters;
    let head_height = LocationFrame::new(structure, 0.0).point.z;
    [0, 1].map(|k: usize| AxisModel {
        head_height,
        gravity: structure.gravity,
        position_limit: safety.position_limit[k],
        velocity_limit: safety.velocity_limit[k],
        angle_limit: tilt.angle_limit,
        rate_limit: tilt.rate_limit,
        acceleration_limit: tilt.acceleration_limit,
    })
}
