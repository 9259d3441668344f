//! Lean control with preview of the path: a linear-quadratic regulator.
//!
//! The rider of [`crate::rider`] holds a reference lean by torque on the bars. On a path the
//! reference's second derivative is the control u. The plant is the motorcycle with that rider and
//! the torso, and its position relative to the path. With ρ the steady lean in the path's curvature
//! and X the state of the steady turn with lean 1, the deviation z = x - X ρ obeys
//!
//! z' = A z + b u - X ρ',
//!
//! and ρ' is known ahead. The control that minimises the integral of z' Q z + r u^2 is
//!
//! u = -b' (P z - ∫ exp(A_c' τ) P X ρ'(t + τ) dτ) / r,   A_c = A - b b' P / r,
//!
//! with P from the Riccati equation: R. S. Sharp, "Motorcycle steering control by road preview",
//! J. Dyn. Syst. Meas. Control 129 (2007) 373-382, in continuous time. The integral is taken over
//! [`PREVIEW_INTERVALS`] intervals in which ρ is linear.

use moris_washout::riccati;
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::lateral::{self, Actions, Lateral, place};
use crate::rider::{GainSet, Rider};
use crate::speeds::Speeds;

/// Number of coordinates of the plant.
///
/// The states are the lateral state, the accumulated error of the lean, the reference lean (its
/// tangent) and its rate, and the torso's lean and its rate. The last three are the deviation from
/// the path to the right, the heading relative to it, and the deviation's integral.
const PLANT_SIZE: usize = lateral::STATE_SIZE + 8;
const LEAN_ERROR_INDEX: usize = lateral::STATE_SIZE;
const REFERENCE_INDEX: usize = LEAN_ERROR_INDEX + 1;
pub const REFERENCE_RATE: usize = LEAN_ERROR_INDEX + 2;
const TORSO_INDEX: usize = LEAN_ERROR_INDEX + 3;
const TORSO_RATE: usize = LEAN_ERROR_INDEX + 4;
const DEVIATION_INDEX: usize = LEAN_ERROR_INDEX + 5;
const HEADING_INDEX: usize = LEAN_ERROR_INDEX + 6;
const INTEGRAL_INDEX: usize = LEAN_ERROR_INDEX + 7;

/// State of the plant.
pub type Plant = SVector<f64, PLANT_SIZE>;
type PlantMatrix = SMatrix<f64, PLANT_SIZE, PLANT_SIZE>;

/// Intervals of the preview, and the duration of each \[s\].
pub const PREVIEW_INTERVALS: usize = 30;
pub const PREVIEW_INTERVAL: f64 = 0.1;

/// Number of speeds for which gains are computed.
const GAIN_SPEEDS: usize = 24;

/// Gains at one speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PreviewGains {
    /// Gain of the plant's state.
    pub gain: Plant,
    /// Gains of the changes of ρ over the preview's intervals.
    pub preview: SVector<f64, PREVIEW_INTERVALS>,
    /// The steady turn with lean 1.
    pub turn: Plant,
    /// Lean of a steady turn divided by its lateral acceleration, as v^2 times the curvature
    /// \[s2/m\].
    pub lean_per_acceleration: f64,
}

impl PreviewGains {
    fn interpolated(&self, other: &PreviewGains, t: f64) -> PreviewGains {
        PreviewGains {
            gain: self.gain + (other.gain - self.gain) * t,
            preview: self.preview + (other.preview - self.preview) * t,
            turn: self.turn + (other.turn - self.turn) * t,
            lean_per_acceleration: self.lean_per_acceleration
                + t * (other.lean_per_acceleration - self.lean_per_acceleration),
        }
    }

    /// The control's feedforward part, from ρ now and at the ends of the intervals.
    pub fn feedforward(&self, steady_leans: &[f64; PREVIEW_INTERVALS + 1]) -> f64 {
        (0..PREVIEW_INTERVALS).map(|k| self.preview[k] * (steady_leans[k + 1] - steady_leans[k])).sum()
    }

    /// The control's feedback part, from the deviation of the plant from the steady turn
    /// with lean `steady_lean`.
    pub fn feedback(&self, state: &Plant, steady_lean: f64) -> f64 {
        -self.gain.dot(&(state - self.turn * steady_lean))
    }
}

/// The plant's state: the lateral state, and the coordinates after it in their order.
pub fn plant_state(lateral: &lateral::State, others: [f64; PLANT_SIZE - lateral::STATE_SIZE]) -> Plant {
    Plant::from_iterator(lateral.iter().copied().chain(others))
}

/// Gains for all speeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PreviewRider {
    gains: SVector<PreviewGains, GAIN_SPEEDS>,
    speeds: Speeds,
}

impl PreviewRider {
    /// The preview rider of a motorcycle with this rider; `None` where no reference lean keeps it
    /// on a path.
    pub fn new(lateral: &Lateral, rider: &Rider) -> Option<Self> {
        let speeds = Speeds { slowest: rider.feet_speed(), fastest: rider.fastest() };
        let mut designed = PreviewRider { gains: SVector::repeat(PreviewGains::default()), speeds };
        for k in 0..GAIN_SPEEDS {
            designed.gains[k] = design_gains(lateral, rider, speeds.knot(k, GAIN_SPEEDS))?;
        }
        Some(designed)
    }

    /// Gains at a speed \[m/s\]: interpolated between two knots.
    pub fn gains(&self, speed: f64) -> PreviewGains {
        let (k, fraction) = self.speeds.find(speed, GAIN_SPEEDS);
        self.gains[k].interpolated(&self.gains[k + 1], fraction)
    }

    /// The matrix of motorcycle, rider and path in closed loop at a speed \[m/s\].
    pub fn closed_loop(&self, lateral: &Lateral, rider: &Rider, speed: f64) -> PlantMatrix {
        plant_matrix(lateral, rider, &rider.gains(speed), speed) - control_effect() * self.gains(speed).gain.transpose()
    }
}

/// Effect of the control.
fn control_effect() -> Plant {
    let mut control = Plant::zeros();
    control[REFERENCE_RATE] = 1.0;
    control
}

/// The plant's matrix at a speed, without feet on the road.
fn plant_matrix(lateral: &Lateral, rider: &Rider, gains: &GainSet, speed: f64) -> PlantMatrix {
    let (fraction, frequency) = rider.torso();
    let mut a = PlantMatrix::zeros();
    for column in 0..PLANT_SIZE {
        let mut unit = Plant::zeros();
        unit[column] = 1.0;
        let motion: lateral::State = unit.fixed_rows::<{ lateral::STATE_SIZE }>(0).into_owned();
        let mut deviation = motion - gains.turn * unit[REFERENCE_INDEX];
        deviation[place::LEAN_RATE] -= unit[REFERENCE_RATE];
        let torque = gains.turn_torque * unit[REFERENCE_INDEX]
            - gains.gain.dot(&deviation)
            - gains.error_gain * unit[LEAN_ERROR_INDEX];
        let torso_acceleration =
            frequency * (frequency * (fraction * unit[REFERENCE_INDEX] - unit[TORSO_INDEX]) - 2.0 * unit[TORSO_RATE]);
        let actions = Actions { torque, torso: unit[TORSO_INDEX], torso_acceleration, wind: 0.0 };
        let error = unit[place::LEAN] - unit[REFERENCE_INDEX];
        let deviation = speed * unit[HEADING_INDEX] + unit[place::VELOCITY];
        let (heading, integral) = (unit[place::YAW_RATE], unit[DEVIATION_INDEX]);
        let rates =
            [error, unit[REFERENCE_RATE], 0.0, unit[TORSO_RATE], torso_acceleration, deviation, heading, integral];
        a.set_column(column, &plant_state(&lateral.derivative(&motion, speed, 0.0, &actions), rates));
    }
    a
}

/// The steady turn with lean 1, and its yaw rate.
///
/// Deviation and integral are zero, and the lean is given. The other coordinates solve the plant's
/// equations with zero derivatives, except the heading's: the path turns with the yaw rate.
fn steady_turn(a: &PlantMatrix) -> Option<(Plant, f64)> {
    // The first thirteen coordinates without one.
    let without = |left_out: usize| -> [usize; 12] { std::array::from_fn(|k| if k < left_out { k } else { k + 1 }) };
    // The reference's second derivative is the control.
    let (unknown, equations) = (without(place::LEAN), without(REFERENCE_RATE));
    let matrix = SMatrix::<f64, 12, 12>::from_fn(|i, j| a[(equations[i], unknown[j])]);
    let right = SVector::<f64, 12>::from_fn(|i, _| -a[(equations[i], place::LEAN)]);
    let solution = matrix.lu().solve(&right)?;
    let mut turn = Plant::zeros();
    turn[place::LEAN] = 1.0;
    for (k, &coordinate) in unknown.iter().enumerate() {
        turn[coordinate] = solution[k];
    }
    turn[HEADING_INDEX] = -turn[place::VELOCITY] / a[(DEVIATION_INDEX, HEADING_INDEX)];
    Some((turn, turn[place::YAW_RATE]))
}

/// Gains at a speed.
fn design_gains(lateral: &Lateral, rider: &Rider, speed: f64) -> Option<PreviewGains> {
    let a = plant_matrix(lateral, rider, &rider.gains(speed), speed);
    let (turn, yaw_rate) = steady_turn(&a)?;
    let unit = lateral::units::<PLANT_SIZE>();
    let (scale, inverse) = (PlantMatrix::from_diagonal(&unit), PlantMatrix::from_diagonal(&unit.map(|u| 1.0 / u)));
    let scaled = inverse * a * scale;
    let mut cost = Plant::zeros();
    for (coordinate, size) in DEVIATION_WEIGHTS {
        cost[coordinate] = 1.0 / (size * size);
    }
    let spread = control_effect() * control_effect().transpose() * INVERSE_CONTROL_WEIGHT;
    let to_go = riccati::solve::<PLANT_SIZE, { 2 * PLANT_SIZE }>(&scaled, &spread, &PlantMatrix::from_diagonal(&cost))?;
    let gain = to_go * control_effect() * INVERSE_CONTROL_WEIGHT;
    let closed = scaled - control_effect() * gain.transpose();
    // The mean of exp(A_c' τ) P X over each interval.
    let (flow, mean) = matrix_flow(&closed.transpose(), PREVIEW_INTERVAL);
    let mut weight = to_go * (inverse * turn) * INVERSE_CONTROL_WEIGHT;
    let mut preview = SVector::<f64, PREVIEW_INTERVALS>::zeros();
    for k in 0..PREVIEW_INTERVALS {
        preview[k] = (mean * weight)[REFERENCE_RATE];
        weight = flow * weight;
    }
    let gain = inverse * gain;
    let finite = gain.iter().chain(turn.iter()).chain(preview.iter()).all(|number| number.is_finite());
    finite.then(|| PreviewGains { gain, preview, turn, lean_per_acceleration: 1.0 / (speed * yaw_rate) })
}

/// Deviations of equal cost. A control of 1 / sqrt([`INVERSE_CONTROL_WEIGHT`]) has the same cost.
pub const DEVIATION_WEIGHTS: [(usize, f64); 4] =
    [(DEVIATION_INDEX, 0.1), (HEADING_INDEX, 0.1), (REFERENCE_RATE, 1.0), (INTEGRAL_INDEX, 0.3)];
pub const INVERSE_CONTROL_WEIGHT: f64 = 16.0;

/// exp(A t), and the mean of exp(A τ) from 0 to t, by Taylor's series over a small part of the time
/// and repeated doubling.
fn matrix_flow(a: &PlantMatrix, time: f64) -> (PlantMatrix, PlantMatrix) {
    const DOUBLINGS: i32 = 12;
    const TERMS: u32 = 10;
    let identity = PlantMatrix::identity();
    let small = a * (time / f64::from(1 << DOUBLINGS));
    let (mut term, mut flow, mut mean) = (identity, identity, identity);
    for k in 1..=TERMS {
        term = term * small / f64::from(k);
        flow += term;
        mean += term / f64::from(k + 1);
    }
    for _ in 0..DOUBLINGS {
        mean = (mean + flow * mean) * 0.5;
        flow = flow * flow;
    }
    (flow, mean)
}
