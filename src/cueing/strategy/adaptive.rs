//! The adaptive strategy: a coordinated filter of each axis whose two gains follow
//! the gradient of a cost.
//!
//! After Parrish, Dieudonne, Bowles and Martin (*Coordinated Adaptive Washout for Motion
//! Simulators*, 1975) and Nahon, Reid and Kirdeikis (1992). With u = f - g sin q what the tilt
//! leaves of the reference f,
//!
//! ```text
//!     a = P1 u + H alpha - d v - e x,    alpha = b (P2 u - q') within the tilt's limits
//!     J = [(felt - f)^2 + rho_x x^2 + rho_v v^2 + rho_w w^2 + k1 (P1 - P10)^2 + k2 (P2 - P20)^2] / 2
//!     P1' = -K1 dJ/dP1,    P2' = -K2 dJ/dP2
//! ```
//!
//! The pace b is that of [`smooth_tilt`](super::smooth_tilt). The sensitivities dx/dP1, dx/dP2 and
//! dq/dP2 are integrated beside the motion. The weights of travel and of its velocity, rho_x and
//! rho_v, increase near the ends of the actuators' strokes.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use super::at_rest_if_tiny;
use super::law::{AxisState, Decision, Law, LawInput, StepContext, Unsolvable};
use super::regulator::AxisModel;
use crate::filter::bumpless::{GlidingOffset, compressed, expanded, glide_by_logarithms};
use crate::interface::{AdaptiveParameters, Parameters};
use crate::motion::min_max::max;
use crate::motion::square_root::square_root;

/// The strategy with its state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptive {
    models: [AxisModel; 2],
    parameters: AdaptiveParameters,
    axes: [Adaptation; 2],
    /// Logarithms of the adaptation's numbers in force less those set.
    glide: GlidingOffset<GLIDING_COUNT>,
    /// Stiffness, compressed, and damping of travel's return in force less those set.
    return_glide: GlidingOffset<2>,
}

/// The gains of one axis, and the sensitivities to them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Adaptation {
    gains: [f64; 2],
    /// Sensitivity of position and velocity to P1.
    to_travel_gain: [f64; 2],
    /// Sensitivity of position and velocity to P2.
    to_tilt_gain: [f64; 2],
    /// Sensitivity of the tilt and its rate to P2.
    tilt: [f64; 2],
}

/// Bound on the sensitivities. Sensitivities are of no use long before they reach it.
const LARGEST_SENSITIVITY: f64 = 1e3;
/// The fraction of its nominal value below which no gain falls. Without a gain, the
/// tilt would never return.
const LEAST_GAIN: f64 = 0.1;
/// While a limit holds the tilt, its sensitivity decays at this rate \[1/s\].
const SENSITIVITY_DECAY: f64 = 0.2;
/// The weights of travel increase when less than this is left of a stroke \[m\] ...
const NEAR_END: f64 = 0.1;
/// Stroke above which that distance grows in proportion \[m\].
const NEAR_END_STROKE: f64 = 0.6;
/// ... by up to this many times their value, at its end.
const LARGEST_INCREASE: f64 = 10.0;
/// Up to this a stiffness glides evenly \[1/s2\]. Above it the damping, which glides evenly always,
/// is ahead: travel that creeps back is felt less than travel that swings.
const EVEN_STIFFNESS: f64 = 11.0;
/// Time of a stroke at the legs' full speed up to which velocity has its own weight \[s\]: that of
/// the default rig.
const STROKE_TIME: f64 = 0.6;

impl Law for Adaptive {
    fn at_rest(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Self, Unsolvable> {
        Ok(Adaptive::new(models, &on_rig(parameters)))
    }

    fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable> {
        let before = self.parameters;
        // The gains continue from where they are.
        (self.models, self.parameters) = (*models, on_rig(parameters));
        let in_motion = self.axes.iter().any(|axis| axis.to_travel_gain != [0.0; 2]);
        if in_motion && before != self.parameters {
            self.glide.add(&(logarithms(&before) - logarithms(&self.parameters)));
            self.return_glide.add(&(gliding_return(&before) - gliding_return(&self.parameters)));
        }
        Ok(())
    }

    fn decisions(&mut self, law_input: &LawInput, step: f64) -> Option<[Decision; 2]> {
        let StepContext { parameters, guard, .. } = law_input.context;
        let longer = (parameters.rig.stroke_length() / NEAR_END_STROKE).max(1.0);
        let scaled_clearance = guard.actuator_clearance() / longer;
        Some(self.decide(&law_input.states, law_input.references, scaled_clearance, step))
    }
}

/// The strategy's parameters on the rig. Velocity weighs more, by the square, where the stroke
/// takes longer than [`STROKE_TIME`] at the legs' full speed: travel would jolt at that speed.
fn on_rig(parameters: &Parameters) -> AdaptiveParameters {
    let Parameters { adaptive, rig, .. } = parameters;
    let slower = (rig.stroke_length() / rig.velocity_limit / STROKE_TIME).max(1.0);
    AdaptiveParameters { weight_velocity: slower * slower * adaptive.weight_velocity, ..*adaptive }
}

impl Adaptive {
    /// At rest, with the nominal gains.
    pub fn new(models: &[AxisModel; 2], parameters: &AdaptiveParameters) -> Self {
        let gains = [parameters.nominal1, parameters.nominal2];
        let axis = Adaptation { gains, to_travel_gain: [0.0; 2], to_tilt_gain: [0.0; 2], tilt: [0.0; 2] };
        Adaptive {
            models: *models,
            parameters: *parameters,
            axes: [axis; 2],
            glide: GlidingOffset::default(),
            return_glide: GlidingOffset::default(),
        }
    }

    /// Decision for a step of `step` seconds. The step begins in these states and has these
    /// references at its end. The actuators' clearance is `scaled_clearance` \[m\].
    pub fn decide(
        &mut self,
        states: &[AxisState; 2],
        references: [f64; 2],
        scaled_clearance: f64,
        step: f64,
    ) -> [Decision; 2] {
        let near_end = (1.0 - scaled_clearance / NEAR_END).max(0.0);
        let weight_scale = 1.0 + LARGEST_INCREASE * near_end * near_end;
        let is_set = self.glide.is_over() && self.return_glide.is_over();
        let parameters = if is_set { self.parameters } else { self.gliding(step) };
        [0, 1].map(|k: usize| {
            self.axes[k].decide(&self.models[k], &parameters, &states[k], references[k], weight_scale, step)
        })
    }

    /// The parameters in force after a step.
    #[cold]
    fn gliding(&mut self, step: f64) -> AdaptiveParameters {
        self.glide.advance(step);
        self.return_glide.advance(step);
        let [stiffness, damping] = (gliding_return(&self.parameters) + self.return_glide.values()).into();
        let omega = square_root(max(expanded(stiffness, EVEN_STIFFNESS), f64::MIN_POSITIVE));
        AdaptiveParameters { omega, zeta: damping / (2.0 * omega), ..in_force(&self.parameters, &self.glide) }
    }
}

glide_by_logarithms!(AdaptiveParameters,
    AdaptiveParameters {
        gain1, gain2, nominal1, nominal2, weight_position, weight_velocity, weight_tilt_rate, pull1, pull2,
        omega: _, zeta: _,
    } => [gain1, gain2, nominal1, nominal2, weight_position, weight_velocity, weight_tilt_rate, pull1, pull2]
);

impl Adaptation {
    fn decide(
        &mut self,
        model: &AxisModel,
        parameters: &AdaptiveParameters,
        state: &AxisState,
        reference: f64,
        weight_scale: f64,
        step: f64,
    ) -> Decision {
        let AxisState { position, velocity, tilt, tilt_rate, .. } = *state;
        let (sin, cos) = libm::sincos(tilt);
        let [travel_gain, tilt_gain] = self.gains;
        let left = reference - model.gravity * sin;
        let rate = (tilt_gain * left).clamp(-model.rate_limit, model.rate_limit);
        let limits = model.tilt_limits();
        let by_rate = limits.by_rate(step);
        let demanded = by_rate * (rate - tilt_rate);
        let alpha = limits.nearest_acceleration(state, demanded, step);
        let AdaptiveParameters { nominal1, nominal2, .. } = *parameters;
        let [stiffness, damping] = stiffness_and_damping(parameters);
        // H alpha is not dropped: whatever its gain, travel makes up for the kick of a tilt that begins.
        let dropped = (travel_gain - 1.0) * left + (-damping * velocity - stiffness * position);

        let limited = alpha != demanded || rate != tilt_gain * left || tilt.abs() >= model.angle_limit;
        let gravity = model.gravity * cos;
        let [tilted, turned] = self.tilt;
        let turning = if limited { 0.0 } else { by_rate * (left - tilt_gain * gravity * tilted - turned) };
        let turned = if limited { -SENSITIVITY_DECAY * tilted } else { turned + step * turning };
        // Of what the tilt leaves, and of what travel makes up for besides.
        let (to_left, made_up) = (-gravity * tilted, model.head_height * turning);
        let forced = |[x, v]: [f64; 2], by: f64| by - damping * v - stiffness * x;
        let travel_acceleration = forced(self.to_travel_gain, left);
        let tilt_acceleration = forced(self.to_tilt_gain, travel_gain * to_left + made_up);

        let (weight_x, weight_v) = (
            weight_scale * parameters.weight_position * position,
            weight_scale * parameters.weight_velocity * velocity,
        );
        let gradients = [
            dropped * travel_acceleration
                + weight_x * self.to_travel_gain[0]
                + weight_v * self.to_travel_gain[1]
                + parameters.pull1 * (travel_gain - nominal1),
            dropped * (tilt_acceleration - to_left - made_up)
                + weight_x * self.to_tilt_gain[0]
                + weight_v * self.to_tilt_gain[1]
                + parameters.weight_tilt_rate * tilt_rate * turned
                + parameters.pull2 * (tilt_gain - nominal2),
        ];
        let laws = [(parameters.gain1, nominal1), (parameters.gain2, nominal2)];
        for ((gain, gradient), (rate, nominal)) in self.gains.iter_mut().zip(gradients).zip(laws) {
            *gain = (*gain - step * rate * gradient).clamp(LEAST_GAIN * nominal.min(1.0), 1.0);
        }
        self.to_travel_gain = integrated_sensitivity(self.to_travel_gain, travel_acceleration, step);
        self.to_tilt_gain = integrated_sensitivity(self.to_tilt_gain, tilt_acceleration, step);
        self.tilt = [limited_sensitivity(tilted + step * turned), limited_sensitivity(turned)];
        Decision { dropped_force: dropped, tilt_acceleration: alpha }
    }
}

/// Stiffness \[1/s2\] and damping \[1/s\] of travel.
fn stiffness_and_damping(parameters: &AdaptiveParameters) -> [f64; 2] {
    let AdaptiveParameters { omega, zeta, .. } = *parameters;
    [omega * omega, 2.0 * zeta * omega]
}

/// Stiffness and damping as they glide.
fn gliding_return(parameters: &AdaptiveParameters) -> SVector<f64, 2> {
    let [stiffness, damping] = stiffness_and_damping(parameters);
    SVector::from([compressed(stiffness, EVEN_STIFFNESS), damping])
}

/// A sensitivity of position and velocity after a step.
fn integrated_sensitivity([x, v]: [f64; 2], acceleration: f64, step: f64) -> [f64; 2] {
    [limited_sensitivity(x + step * v), limited_sensitivity(v + step * acceleration)]
}

fn limited_sensitivity(value: f64) -> f64 {
    at_rest_if_tiny(value.clamp(-LARGEST_SENSITIVITY, LARGEST_SENSITIVITY))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::STANDARD_GRAVITY;

    const STEP: f64 = 1e-3;
    /// With the head at the platform's origin, and limits that nothing reaches.
    const FREE: AxisModel = AxisModel {
        head_height: 0.0,
        gravity: STANDARD_GRAVITY,
        position_limit: 1e9,
        velocity_limit: 1e9,
        angle_limit: 1e9,
        rate_limit: 1e9,
        acceleration_limit: 1e9,
    };

    /// Parameters with these nominal gains, which the adaptation does not move.
    fn fixed(gains: [f64; 2]) -> AdaptiveParameters {
        let [nominal1, nominal2] = gains;
        AdaptiveParameters { nominal1, nominal2, gain1: 0.0, gain2: 0.0, ..AdaptiveParameters::default() }
    }

    fn adaptive(model: &AxisModel, parameters: &AdaptiveParameters) -> Adaptation {
        Adaptive::new(&[*model; 2], parameters).axes[0]
    }

    fn reference(time: f64) -> f64 {
        1.2 * (1.3 * time).sin() + 0.4 * (4.1 * time).cos()
    }

    /// An axis that moves as decided, by the explicit Euler rule.
    struct Axis {
        state: AxisState,
        /// The decision of the last step, and the tilt rate after it.
        dropped: f64,
        rate: f64,
        adaptation: Adaptation,
    }

    impl Axis {
        fn new(model: &AxisModel, parameters: &AdaptiveParameters) -> Self {
            let adaptation = adaptive(model, parameters);
            Axis { state: AxisState::default(), dropped: 0.0, rate: 0.0, adaptation }
        }

        fn advance(&mut self, model: &AxisModel, parameters: &AdaptiveParameters, time: f64) {
            let decision = self.adaptation.decide(model, parameters, &self.state, reference(time), 1.0, STEP);
            let AxisState { position, velocity, tilt, tilt_rate, .. } = self.state;
            self.dropped = decision.dropped_force;
            self.rate = tilt_rate + STEP * decision.tilt_acceleration;
            let acceleration = reference(time) - STANDARD_GRAVITY * tilt.sin()
                + self.dropped
                + model.head_height * decision.tilt_acceleration;
            self.state = AxisState {
                position: position + STEP * velocity,
                velocity: velocity + STEP * acceleration,
                tilt: tilt + STEP * self.rate,
                tilt_rate: self.rate,
                tilt_acceleration: decision.tilt_acceleration,
            };
        }
    }

    #[test]
    fn the_decision_is_the_law_of_the_coordinated_filter() {
        let parameters = fixed([0.7, 0.2]);
        let model = AxisModel { head_height: 1.3, ..FREE };
        let state = AxisState { position: 0.2, velocity: -0.3, tilt: 0.15, tilt_rate: 0.05, tilt_acceleration: 2.0 };
        let decision = adaptive(&model, &parameters).decide(&model, &parameters, &state, 2.0, 1.0, STEP);
        let left = 2.0 - STANDARD_GRAVITY * 0.15_f64.sin();
        let alpha = 15.0 * (0.2 * left - 0.05) / (1.0 + 15.0 * STEP);
        let AdaptiveParameters { omega, zeta, .. } = parameters;
        let acceleration = 0.7 * left + 1.3 * alpha + 2.0 * zeta * omega * 0.3 - omega * omega * 0.2;
        // What is felt: a - H alpha + g sin q.
        let felt = acceleration - 1.3 * alpha + STANDARD_GRAVITY * 0.15_f64.sin();
        assert!((decision.tilt_acceleration - alpha).abs() < 1e-9);
        assert!((decision.dropped_force - (felt - 2.0)).abs() < 1e-9);
    }

    #[test]
    fn sensitivities_and_the_gradient_are_finite_differences() {
        const SHIFT: f64 = 1e-6;
        const MODEL: AxisModel = AxisModel { head_height: 1.2, ..FREE };
        let base = [0.7, 0.12];
        let shifted =
            |gain: usize, by: f64| fixed(core::array::from_fn(|k| base[k] + if k == gain { by } else { 0.0 }));
        let sets = [shifted(0, 0.0), shifted(0, SHIFT), shifted(0, -SHIFT), shifted(1, SHIFT), shifted(1, -SHIFT)];
        let mut axes = sets.map(|set| Axis::new(&MODEL, &set));
        // The gains are pulled towards others.
        let towards = AdaptiveParameters { nominal1: 0.5, nominal2: 0.3, gain1: 1e-3, gain2: 1e-3, ..fixed(base) };
        let mut farthest = 0.0_f64;
        for k in 0..8000 {
            let time = k as f64 * STEP;
            let before = axes[0].state;
            let mut adapting = axes[0].adaptation;
            adapting.decide(&MODEL, &towards, &before, reference(time), 1.0, STEP);
            let states = axes.each_ref().map(|axis| axis.state);
            for (axis, set) in axes.iter_mut().zip(&sets) {
                axis.advance(&MODEL, set, time);
            }
            let slope =
                |of: fn(&Axis) -> f64, gain: usize| (of(&axes[1 + 2 * gain]) - of(&axes[2 + 2 * gain])) / (2.0 * SHIFT);
            let earlier = |of: fn(&AxisState) -> f64, gain: usize| {
                (of(&states[1 + 2 * gain]) - of(&states[2 + 2 * gain])) / (2.0 * SHIFT)
            };
            let Adaptation { to_travel_gain, to_tilt_gain, tilt, .. } = axes[0].adaptation;
            for (found, expected) in [
                (to_travel_gain[0], slope(|axis| axis.state.position, 0)),
                (to_travel_gain[1], slope(|axis| axis.state.velocity, 0)),
                (to_tilt_gain[0], slope(|axis| axis.state.position, 1)),
                (to_tilt_gain[1], slope(|axis| axis.state.velocity, 1)),
                (tilt[0], slope(|axis| axis.state.tilt, 1)),
                (tilt[1], slope(|axis| axis.state.tilt_rate, 1)),
            ] {
                assert!(
                    (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                    "{time} s: {found} beside {expected}"
                );
            }
            farthest = farthest.max(tilt[0].abs());
            let weights = AdaptiveParameters::default();
            let pulls = [weights.pull1 * (base[0] - 0.5), weights.pull2 * (base[1] - 0.3)];
            for (gain, pull) in pulls.into_iter().enumerate() {
                let mut gradient = axes[0].dropped * slope(|axis| axis.dropped, gain)
                    + weights.weight_position * before.position * earlier(|state| state.position, gain)
                    + weights.weight_velocity * before.velocity * earlier(|state| state.velocity, gain)
                    + pull;
                if gain == 1 {
                    gradient += weights.weight_tilt_rate * before.tilt_rate * slope(|axis| axis.rate, gain);
                }
                let found = (base[gain] - adapting.gains[gain]) / (1e-3 * STEP);
                assert!(
                    (found - gradient).abs() < 1e-5 * (1.0 + gradient.abs()),
                    "{time} s: {found} beside {gradient}"
                );
            }
        }
        assert!(farthest > 0.1, "the tilt moves: {farthest}");
    }

    #[test]
    fn while_a_limit_holds_the_tilt_its_sensitivity_decays() {
        let parameters = fixed([0.7, 0.2]);
        let limited = |model: AxisModel, tilt: f64, tilt_rate: f64| {
            let mut axis = adaptive(&model, &parameters);
            axis.tilt = [0.5, 0.3];
            let state = AxisState { tilt, tilt_rate, ..AxisState::default() };
            let decision = axis.decide(&model, &parameters, &state, 2.0, 1.0, STEP);
            ((axis.tilt[0] - 0.5 * (1.0 - SENSITIVITY_DECAY * STEP)).abs() < 1e-12, decision.tilt_acceleration)
        };
        let gentle = AxisModel { acceleration_limit: 0.2, ..FREE };
        let slow = AxisModel { rate_limit: 0.05, ..FREE };
        let low = AxisModel { angle_limit: 1.0, ..FREE };
        assert!(!limited(FREE, 0.0, 0.0).0);
        let (held, alpha) = limited(gentle, 0.0, 0.0);
        assert!(held && (alpha - 30.0 * 0.2 * STEP).abs() < 1e-12, "it builds up: {alpha}");
        let (held, alpha) = limited(slow, 0.0, 0.0);
        assert!(held && (alpha - 15.0 * 0.05 / (1.0 + 15.0 * STEP)).abs() < 1e-9, "{alpha}");
        assert!(limited(low, 1.0, 0.0).0 && limited(low, -1.0, 0.0).0 && !limited(low, 0.1, 0.0).0);
    }

    #[test]
    fn gains_stay_between_a_tenth_of_their_nominal_value_and_one() {
        let parameters = AdaptiveParameters { gain1: 1e6, gain2: 1e6, nominal1: 0.6, nominal2: 2.0, ..fixed([0.0; 2]) };
        let mut axis = adaptive(&FREE, &parameters);
        let (mut least, mut most) = ([1.0_f64; 2], [0.0_f64; 2]);
        for k in 0..2000 {
            let state = AxisState { position: (0.01 * k as f64).sin(), tilt: 0.1, ..AxisState::default() };
            axis.decide(&FREE, &parameters, &state, reference(k as f64 * STEP), 1.0, STEP);
            for gain in 0..2 {
                least[gain] = least[gain].min(axis.gains[gain]);
                most[gain] = most[gain].max(axis.gains[gain]);
            }
        }
        assert_eq!((least, most), ([LEAST_GAIN * 0.6, LEAST_GAIN], [1.0; 2]));
    }

    #[test]
    fn travel_weighs_more_near_the_ends_of_the_strokes() {
        let parameters = AdaptiveParameters { gain1: 1e-3, ..fixed([0.7, 0.2]) };
        let change = |clearance: f64, tenfold: f64| {
            let weights = AdaptiveParameters {
                weight_position: tenfold * parameters.weight_position,
                weight_velocity: tenfold * parameters.weight_velocity,
                ..parameters
            };
            let mut adaptive = Adaptive::new(&[FREE; 2], &weights);
            adaptive.axes[1].to_travel_gain = [0.3, 0.4];
            let state = AxisState { position: 0.2, velocity: 0.1, ..AxisState::default() };
            adaptive.decide(&[state; 2], [1.0; 2], clearance, STEP);
            assert_ne!(adaptive.axes[0], adaptive.axes[1], "each axis has its own sensitivities");
            adaptive.axes[1].gains[0]
        };
        for (clearance, factor) in
            [(0.3, 1.0), (NEAR_END, 1.0), (0.05, 1.0 + LARGEST_INCREASE / 4.0), (0.0, 1.0 + LARGEST_INCREASE)]
        {
            assert!((change(clearance, 1.0) - change(1.0, factor)).abs() < 1e-15, "{clearance} m");
        }
        assert_ne!(change(0.05, 1.0), change(1.0, 1.0));
    }

    #[test]
    fn sensitivities_are_bounded_and_come_to_rest() {
        assert_eq!(limited_sensitivity(2e3), LARGEST_SENSITIVITY);
        assert_eq!(limited_sensitivity(-2e3), -LARGEST_SENSITIVITY);
        assert_eq!(limited_sensitivity(1e-31), 0.0);
        assert_eq!(limited_sensitivity(-1e-29), -1e-29);
    }

    #[test]
    fn retuning_keeps_the_gains() {
        let mut adaptive = Adaptive::new(&[FREE; 2], &fixed([0.7, 0.2]));
        let axes = adaptive.axes;
        let model = AxisModel { gravity: 9.0, ..FREE };
        let parameters = Parameters { adaptive: fixed([0.4, 0.2]), ..Parameters::default() };
        adaptive.set_parameters(&[model; 2], &parameters).unwrap();
        let parameters = on_rig(&parameters);
        assert_eq!(adaptive, Adaptive { axes, ..Adaptive::new(&[model; 2], &parameters) });
    }
}
