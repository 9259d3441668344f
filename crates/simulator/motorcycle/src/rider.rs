//! The rider: reference lean, steering torque and torso.
//!
//! The rider follows a reference lean by steering torque. The torque has three parts:
//!
//! - the torque of the steady turn with that lean;
//! - minus a gain times the deviation of the lateral state from that turn's;
//! - minus a gain times the accumulated error of the lean.
//!
//! The gains minimise a quadratic cost (LQR). Gains are computed at the beginning for speeds from
//! walking pace to the top speed, and interpolated. Below walking pace feet and hands replace them,
//! see [`crate::lateral::foot_support`].

use moris_interface::ParameterError;
use moris_washout::riccati;
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};
use serde::{Deserialize, Serialize};

use crate::interface::{self, Parameters};
use crate::lateral::{self, Lateral, foot_support, place};
use crate::speeds::Speeds;

/// The lateral state, and the accumulated error of the lean.
const PLANT_SIZE: usize = lateral::STATE_SIZE + 1;
const LEAN_ERROR_INDEX: usize = lateral::STATE_SIZE;
/// Number of speeds for which gains are computed.
pub const GAIN_SPEED_COUNT: usize = 48;

/// Gains of the rider at one speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GainSet {
    /// Torque against a deviation of the lateral state, and against the accumulated error.
    pub gain: lateral::State,
    pub error_gain: f64,
    /// Lateral state and torque of the steady turn, divided by its lean.
    pub turn: lateral::State,
    pub turn_torque: f64,
}

impl GainSet {
    fn interpolated(&self, other: &GainSet, t: f64) -> GainSet {
        let number = |from: f64, to: f64| from + t * (to - from);
        GainSet {
            gain: self.gain + (other.gain - self.gain) * t,
            error_gain: number(self.error_gain, other.error_gain),
            turn: self.turn + (other.turn - self.turn) * t,
            turn_torque: number(self.turn_torque, other.turn_torque),
        }
    }
}

/// State of the rider: reference lean, accumulated error of the lean, torso.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Reference roll angle, to the right \[rad\], and its rate \[rad/s\].
    pub lean: f64,
    pub lean_rate: f64,
    /// Accumulated error of the lean \[s\].
    pub error: f64,
    /// Lean of the torso to the right, relative to the motorcycle \[rad\], and its rate \[rad/s\].
    pub torso: f64,
    pub torso_rate: f64,
}

/// The rider's gains for all speeds, and the rider's limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rider {
    gains: SVector<GainSet, GAIN_SPEED_COUNT>,
    speeds: Speeds,
    parameters: interface::Rider,
    /// Largest tangent of the lean, by the rider's limit and the tyres' friction.
    largest_lean: f64,
    steer_lock: f64,
}

impl Rider {
    /// The rider of a motorcycle that goes up to `fastest` \[m/s\].
    ///
    /// # Errors
    /// No steering torque stabilises the motorcycle with these parameters.
    pub fn new(lateral: &Lateral, parameters: &Parameters, fastest: f64) -> Result<Rider, ParameterError> {
        // The slowest speed with gains of its own, as a fraction of the speed at which foot support
        // ends.
        const SLOWEST_FRACTION: f64 = 0.3;
        let limits = &parameters.rider;
        let mut rider = Rider {
            gains: SVector::repeat(GainSet::default()),
            speeds: Speeds { slowest: SLOWEST_FRACTION * limits.feet_speed, fastest },
            parameters: *limits,
            largest_lean: 0.0,
            steer_lock: 0.0,
        };
        rider.set_limits(parameters);
        for k in 0..GAIN_SPEED_COUNT {
            let speed = rider.knot(k);
            rider.gains[k] = design_gains(lateral, speed, limits).ok_or_else(|| ParameterError {
                variable: "rider.torqueWeight".into(),
                reason: format!(
                    "is {} N m; no steering torque stabilises this motorcycle at {speed:.1} m/s; change rider.torqueWeight, \
                     the masses or the tyres",
                    limits.torque_weight
                ),
            })?;
        }
        Ok(rider)
    }

    /// Sets all limits and frequencies by these parameters; the gains do not change.
    pub fn set_limits(&mut self, parameters: &Parameters) {
        // The reference lean needs at most this fraction of the friction.
        const FRICTION_FRACTION: f64 = 0.9;
        let limits = &parameters.rider;
        self.parameters = *limits;
        self.largest_lean = libm::tan(limits.lean_limit).min(FRICTION_FRACTION * parameters.tyres.friction);
        self.steer_lock = parameters.machine.steer_lock;
    }

    /// The largest speed \[m/s\] for which there are gains.
    pub fn fastest(&self) -> f64 {
        self.speeds.fastest
    }

    /// The speed \[m/s\] below which feet support the motorcycle.
    pub fn feet_speed(&self) -> f64 {
        self.parameters.feet_speed
    }

    /// The torso's lean as a fraction of the reference lean, and its natural frequency \[rad/s\].
    pub fn torso(&self) -> (f64, f64) {
        (self.parameters.body_lean_share, self.parameters.body_lean_frequency)
    }

    /// Largest tangent of the reference lean with these gains.
    pub fn steepest(&self, gains: &GainSet) -> f64 {
        self.largest_lean.min(self.steer_lock / gains.turn[place::STEER].abs())
    }

    /// Accumulated error \[s\] with which the torque of this rider equals that of `other`, the
    /// rider so far. The torque then does not jump, and the difference decays with the error.
    pub fn error_for_torque_of(&self, other: &Rider, state: &State, lateral: &lateral::State, speed: f64) -> f64 {
        /// Largest change of the error \[s\]: about the error accumulated in a rough simulation.
        const LARGEST: f64 = 0.2;
        let (gains, other_gains) = (self.gains(speed), other.gains(speed));
        let jump = self.torque(state, lateral, &gains, 0.0) - other.torque(state, lateral, &other_gains, 0.0);
        let change = jump / gains.error_gain;
        if change.is_finite() { state.error + within(change, LARGEST) } else { state.error }
    }

    /// Speed \[m/s\] of the knot number `k`, below [`GAIN_SPEED_COUNT`], for
    /// which gains were computed.
    pub fn knot(&self, k: usize) -> f64 {
        self.speeds.knot(k, GAIN_SPEED_COUNT)
    }

    /// Gains at a speed \[m/s\]: interpolated between two knots.
    pub fn gains(&self, speed: f64) -> GainSet {
        let (k, fraction) = self.speeds.find(speed, GAIN_SPEED_COUNT);
        self.gains[k].interpolated(&self.gains[k + 1], fraction)
    }

    /// Torque on the bars to the right \[N m\], with foot support from 0 to 1.
    pub fn torque(&self, state: &State, lateral: &lateral::State, gains: &GainSet, feet: f64) -> f64 {
        let lean = libm::tan(state.lean);
        let mut deviation = lateral - gains.turn * lean;
        deviation[place::LEAN_RATE] -= state.lean_rate * (1.0 + lean * lean);
        (1.0 - feet) * (gains.turn_torque * lean - gains.gain.dot(&deviation) - gains.error_gain * state.error)
    }

    /// The derivative of the rider's state for a commanded roll angle and a commanded torso lean,
    /// both \[rad\] to the right. `feet` is the foot support from 0 to 1.
    pub fn derivative(
        &self,
        state: &State,
        lateral: &lateral::State,
        gains: &GainSet,
        feet: f64,
        command: (f64, f64),
    ) -> State {
        let limits = &self.parameters;
        let riding = 1.0 - feet;
        let steepest = libm::atan(self.steepest(gains));
        let target = riding * within(command.0, steepest);
        let rate = within(0.5 * limits.lean_frequency * (target - state.lean), limits.lean_rate_limit);
        let torso = within(command.1 + limits.body_lean_share * state.lean, limits.body_lean_limit);
        State {
            lean: state.lean_rate,
            lean_rate: 2.0 * limits.lean_frequency * (rate - state.lean_rate),
            error: riding * (lateral[place::LEAN] - libm::tan(state.lean))
                - feet * state.error / SUPPORT_FORGETTING_TIME,
            torso: state.torso_rate,
            torso_rate: limits.body_lean_frequency
                * (limits.body_lean_frequency * (torso - state.torso) - 2.0 * state.torso_rate),
        }
    }

    /// Second derivative of the reference roll angle on a path, for the second derivative `control`
    /// of its tangent.
    ///
    /// The law reduces rates beyond the rider's limit, and slows down in time
    /// before the largest lean.
    pub fn lean_acceleration(&self, state: &State, gains: &GainSet, feet: f64, control: f64) -> f64 {
        // Rates [1/s] at which a reference lean on a path approaches its limit, and its rate the
        // largest rate.
        const LIMIT_APPROACH: f64 = 8.0;
        const LIMIT_RATE: f64 = 30.0;
        // Natural frequency with which the reference lean on a path returns to zero below walking
        // pace [1/s].
        const UPRIGHT_FREQUENCY: f64 = 4.0;
        let lean = libm::tan(state.lean);
        let (square, most) = (1.0 + lean * lean, self.steepest(gains));
        let rate = state.lean_rate * square;
        let fastest = self.parameters.lean_rate_limit * square;
        let to_right = LIMIT_RATE * ((LIMIT_APPROACH * (most - lean)).min(fastest) - rate);
        let to_left = LIMIT_RATE * ((-LIMIT_APPROACH * (most + lean)).max(-fastest) - rate);
        let upright = -UPRIGHT_FREQUENCY * (UPRIGHT_FREQUENCY * lean + 2.0 * rate);
        let control = (1.0 - feet) * control.min(to_right).max(to_left) + feet * upright;
        control / square - 2.0 * lean * state.lean_rate * state.lean_rate
    }

    /// The matrix of the closed loop of lateral state and accumulated error at a speed \[m/s\].
    pub fn closed_loop(&self, lateral: &Lateral, speed: f64) -> SMatrix<f64, PLANT_SIZE, PLANT_SIZE> {
        let gains = self.gains(speed);
        let (a, torque) = lean_plant(lateral, speed, self.parameters.feet_speed);
        a - torque * gains.gain.push(gains.error_gain).transpose()
    }
}

/// Time constant with which foot support discharges accumulated errors \[s\].
pub(crate) const SUPPORT_FORGETTING_TIME: f64 = 0.5;

/// The limited value: at most `limit` to either side.
pub(crate) fn within(value: f64, limit: f64) -> f64 {
    value.max(-limit).min(limit)
}

/// Gains at a speed, and the steady turn.
///
/// The gains minimise the integral of the sum of these squares: lean / 0.1, lean rate / 0.5, steer
/// / 0.2, steer rate / 2, accumulated error / 0.1 and torque / weight.
fn design_gains(lateral: &Lateral, speed: f64, limits: &interface::Rider) -> Option<GainSet> {
    let (turn, turn_torque) = steady_turn(&lateral.state_matrix(speed, 0.0), &lateral.torque)?;
    let (a, torque) = lean_plant(lateral, speed, limits.feet_speed);
    let unit = lateral::units::<PLANT_SIZE>();
    let (scale, inverse) = (SMatrix::from_diagonal(&unit), SMatrix::from_diagonal(&unit.map(|u| 1.0 / u)));
    let mut cost = SVector::<f64, PLANT_SIZE>::zeros();
    cost[place::LEAN] = 100.0;
    cost[place::LEAN_RATE] = 4.0;
    cost[place::STEER] = 25.0;
    cost[place::STEER_RATE] = 0.25;
    cost[LEAN_ERROR_INDEX] = 100.0;
    let torque = inverse * torque;
    let inverse_weight = limits.torque_weight * limits.torque_weight;
    let spread = torque * torque.transpose() * inverse_weight;
    let to_go = riccati::solve::<PLANT_SIZE, { 2 * PLANT_SIZE }>(
        &(inverse * a * scale),
        &spread,
        &SMatrix::from_diagonal(&cost),
    )?;
    let gain = inverse * to_go * torque * inverse_weight;
    let finite = gain.iter().chain(turn.iter()).chain([&turn_torque]).all(|number| number.is_finite());
    finite.then(|| GainSet {
        gain: gain.fixed_rows::<{ lateral::STATE_SIZE }>(0).into_owned(),
        error_gain: gain[LEAN_ERROR_INDEX],
        turn,
        turn_torque,
    })
}

/// Lateral state and torque of a steady turn with the lean 1. Lean rate and steer rate are zero.
/// The other five variables and the torque solve six equations.
fn steady_turn(a: &lateral::StateMatrix, torque: &lateral::State) -> Option<(lateral::State, f64)> {
    use place::{FRONT_FORCE, LEAN, LEAN_RATE, REAR_FORCE, STEER, STEER_RATE, VELOCITY, YAW_RATE};
    let rows = [VELOCITY, YAW_RATE, LEAN_RATE, STEER_RATE, REAR_FORCE, FRONT_FORCE];
    let unknowns = [VELOCITY, YAW_RATE, STEER, REAR_FORCE, FRONT_FORCE];
    let matrix = Matrix6::from_fn(|i, j| if j < 5 { a[(rows[i], unknowns[j])] } else { torque[rows[i]] });
    let right = Vector6::from_fn(|i, _| -a[(rows[i], LEAN)]);
    let solution = matrix.lu().solve(&right)?;
    let mut turn = lateral::State::zeros();
    turn[LEAN] = 1.0;
    for (j, &place) in unknowns.iter().enumerate() {
        turn[place] = solution[j];
    }
    Some((turn, solution[5]))
}

/// Plant of the lean control at a speed, with the foot support at that speed.
///
/// The first part is the matrix of the lateral state and the accumulated error of the lean, the
/// second the effect of a torque.
fn lean_plant(
    lateral: &Lateral,
    speed: f64,
    feet_speed: f64,
) -> (SMatrix<f64, PLANT_SIZE, PLANT_SIZE>, SVector<f64, PLANT_SIZE>) {
    let feet = foot_support(speed, feet_speed);
    let mut a = SMatrix::<f64, PLANT_SIZE, PLANT_SIZE>::zeros();
    a.fixed_view_mut::<{ lateral::STATE_SIZE }, { lateral::STATE_SIZE }>(0, 0)
        .copy_from(&lateral.state_matrix(speed, feet));
    a[(LEAN_ERROR_INDEX, place::LEAN)] = 1.0 - feet;
    a[(LEAN_ERROR_INDEX, LEAN_ERROR_INDEX)] = -feet / SUPPORT_FORGETTING_TIME;
    (a, lateral.torque.push(0.0) * (1.0 - feet))
}
