//! The classical washout of Reid and Nahon (UTIAS Report 296, 1985) as a model: the script of
//! `docs/your-washout.md`, equation by equation.
#![allow(non_snake_case)] // FMI 2.0 names the library as the model

use std::array;

use moris_interface::units::{ANGULAR_FREQUENCY, M, M_PER_S2, RAD, RAD_PER_S};
use moris_interface::{Group, Identity, Model, ParameterError, interface, variables};
use serde::{Deserialize, Serialize};

const G: f64 = 9.80665;

interface! {
    /// Motion of the vehicle.
    pub struct Input: Input, Continuous {
        /// Specific force along x, y, z, with gravity's reaction.
        "force[#]" force: [f64; 3] [M_PER_S2] = [0.0, 0.0, G];
        /// Angular velocity about x, y, z.
        "rate[#]" rate: [f64; 3] [RAD_PER_S] = [0.0; 3];
    }
}

interface! {
    /// Motion of the platform, from neutral.
    pub struct Output: Output, Continuous {
        /// Position along x, y, z.
        "position[#]" position: [f64; 3] [M] = [0.0; 3];
        /// Roll, pitch, yaw.
        "angle[#]" angle: [f64; 3] [RAD] = [0.0; 3];
    }
}

interface! {
    /// Parameters.
    pub struct Parameters: Parameter, Tunable {
        /// Factor on forces and rates.
        "scale" scale: f64 { 0.0 ..= 2.0 } = 0.5;
        /// Break frequency of translation and tilt.
        "frequency" frequency: f64 [ANGULAR_FREQUENCY] { 0.1 ..= 20.0 } = 2.5;
        /// Break frequency of the third order of translation.
        "slow" slow: f64 [ANGULAR_FREQUENCY] { 0.01 ..= 5.0 } = 0.4;
        /// Break frequency of rotation.
        "rateFrequency" rate_frequency: f64 [ANGULAR_FREQUENCY] { 0.01 ..= 20.0 } = 1.0;
        /// Largest rate of tilt coordination.
        "tiltRate" tilt_rate: f64 [RAD_PER_S] { 0.001 ..= 1.0 } = 0.0523598775598299;
    }
}

variables!(Input, Output, Parameters);

/// The washout, with a damping of 1.
#[derive(Clone, Serialize, Deserialize)]
pub struct ReidNahon {
    parameters: Parameters,
    position: [f64; 3],
    velocity: [f64; 3],
    integral: [f64; 3],
    low: [f64; 2],
    low_rate: [f64; 2],
    tilt: [f64; 2],
    angles: [f64; 3],
    /// The last change of the output a second.
    slope: Output,
}

impl ReidNahon {
    /// A step of so many seconds with this input, by Euler's method.
    fn advance(&mut self, input: &Input, step: f64) {
        let Parameters { scale, frequency: wn, slow, rate_frequency, tilt_rate } = self.parameters;
        let force: [f64; 3] = array::from_fn(|k| scale * (input.force[k] - [0.0, 0.0, G][k]));
        for (k, force) in force.iter().enumerate() {
            let acceleration = force
                - (2.0 * wn + slow) * self.velocity[k]
                - (wn * wn + 2.0 * wn * slow) * self.position[k]
                - wn * wn * slow * self.integral[k];
            self.velocity[k] += step * acceleration;
            self.position[k] += step * self.velocity[k];
            self.integral[k] += step * self.position[k];
            self.angles[k] += step * (scale * input.rate[k] - rate_frequency * self.angles[k]);
        }
        for ((low, low_rate), force) in self.low.iter_mut().zip(&mut self.low_rate).zip(force) {
            *low_rate += step * (wn * wn * (force - *low) - 2.0 * wn * *low_rate);
            *low += step * *low_rate;
        }
        for (tilt, needed) in self.tilt.iter_mut().zip([self.low[1], -self.low[0]]) {
            let wanted = (needed / G).clamp(-0.3, 0.3).asin();
            *tilt += (wanted - *tilt).clamp(-tilt_rate * step, tilt_rate * step);
        }
    }
}

impl Model for ReidNahon {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = Identity {
        name: "ReidNahon",
        version: "1",
        text: "The classical washout of Reid and Nahon.",
        rows: Variables::ROWS,
        slots: Variables::SLOTS,
        stop_time: 40.0,
        step_size: 0.01,
    };

    fn new(parameters: &Parameters, _: &Input) -> Result<Self, ParameterError> {
        let [position, velocity, integral, angles] = [[0.0; 3]; 4];
        let [low, low_rate, tilt] = [[0.0; 2]; 3];
        let slope = Output { position, angle: angles };
        Ok(ReidNahon { parameters: *parameters, position, velocity, integral, low, low_rate, tilt, angles, slope })
    }

    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        self.parameters = *parameters;
        Ok(())
    }

    fn step_between(&mut self, _: &Input, end: &Input, step: f64) {
        let before = self.output();
        self.advance(end, step);
        let after = self.output();
        let slope = |before: [f64; 3], after: [f64; 3]| array::from_fn(|k| (after[k] - before[k]) / step);
        self.slope =
            Output { position: slope(before.position, after.position), angle: slope(before.angle, after.angle) };
    }

    fn output(&self) -> Output {
        let [roll, pitch] = self.tilt;
        let [x, y, z] = self.angles;
        Output { position: self.position, angle: [x + roll, y + pitch, z] }
    }

    fn output_derivative(&self) -> Output {
        self.slope
    }
}

moris_fmi::export_fmi2!(ReidNahon);
