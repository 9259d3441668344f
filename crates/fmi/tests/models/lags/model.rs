//! Three first-order lags, with arrays of every shape, at least one variable of every kind, values
//! that are refused, and a trap.

use moris_interface::{
    Group, Identity, Model, ParameterError, enumeration, interface, interface_tree, refuse, units::S, variables,
};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

interface! {
    /// Signals to filter.
    pub struct Input: Input, Continuous {
        /// Inputs of the lags.
        "u.@" u: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
        /// Added to each of u.
        "offset" offset: i32 { -5 ..= 5 } = 0;
        /// True: the outputs stay where they are.
        "frozen" frozen: bool = false;
    }
}

interface! {
    /// The lagged inputs.
    pub struct Output: Output, Continuous {
        /// Follows gain * (u + offset).
        "y.@" y: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
        /// The weights' rows times y.
        "sum[#]" sum: [f64; 6] = [0.0; 6];
        /// Steps done.
        "count" count: i32 = 0;
        /// True if nothing moved in the last step.
        "still" still: bool = true;
        /// The method of the last step.
        "methodUsed" method_used: Method = Method::Exact;
    }
}

enumeration! {
    /// Method of integration.
    pub enum Method {
        /// By the closed form.
        "exact" Exact,
        /// By Euler's rule.
        "euler" Euler,
    }
}

interface! {
    /// Tunable parameters.
    pub struct Tunable: Parameter, Tunable {
        /// Ratio of output to input at rest; negative ones are refused.
        "gain.@" gain: Vector3<f64> = Vector3::new(1.0, 1.0, 1.0);
        /// Method of integration.
        "method" method: Method = Method::Exact;
        /// True: the next step panics.
        "trap" trap: bool = false;
    }
}

interface! {
    /// Fixed parameters.
    pub struct Fixed: Parameter, Fixed {
        /// Weights of y in the sums.
        "weight[#].@" weight: [Vector3<f64>; 6] = WEIGHTS;
        /// Time constant; must be positive.
        "tau" tau: f64 [S] = 0.5;
        /// The outputs at the beginning.
        "y0.@" y0: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
    }
}

interface_tree! {
    /// All parameters.
    pub struct Parameters {
        tunable: Tunable,
        fixed: Fixed,
    }
}

variables!(Input, Output, Parameters);

/// Counts from 1, row by row.
const WEIGHTS: [Vector3<f64>; 6] = [
    Vector3::new(1.0, 2.0, 3.0),
    Vector3::new(4.0, 5.0, 6.0),
    Vector3::new(7.0, 8.0, 9.0),
    Vector3::new(10.0, 11.0, 12.0),
    Vector3::new(13.0, 14.0, 15.0),
    Vector3::new(16.0, 17.0, 18.0),
];

/// Three first-order lags.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Lags {
    parameters: Parameters,
    y: Vector3<f64>,
    slope: Vector3<f64>,
    count: i32,
    method_used: Method,
}

fn check(parameters: &Parameters) -> Result<(), ParameterError> {
    if parameters.tunable.gain.min() < 0.0 {
        return refuse("gain", "must not be negative");
    }
    if parameters.fixed.tau <= 0.0 {
        return refuse("tau", "must be positive");
    }
    Ok(())
}

impl Lags {
    fn sums(&self, values: &Vector3<f64>) -> [f64; 6] {
        self.parameters.fixed.weight.map(|row| row.iter().zip(values).map(|(weight, value)| weight * value).sum())
    }
}

impl Model for Lags {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = Identity {
        name: "Lags",
        version: "1.0",
        text: "Three first-order lags.",
        rows: Variables::ROWS,
        slots: Variables::SLOTS,
        stop_time: 2.0,
        step_size: 0.1,
    };

    fn new(parameters: &Parameters, _: &Input) -> Result<Self, ParameterError> {
        check(parameters)?;
        Ok(Lags {
            parameters: *parameters,
            y: parameters.fixed.y0,
            slope: Vector3::zeros(),
            count: 0,
            method_used: Method::Exact,
        })
    }

    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        check(parameters)?;
        self.parameters = *parameters;
        Ok(())
    }

    fn warnings(parameters: &Parameters) -> Vec<String> {
        let slow = "tau is above 1000 s: the output hardly moves".to_owned();
        (parameters.fixed.tau > 1000.0).then_some(slow).into_iter().collect()
    }

    fn step_between(&mut self, input: &Input, _: &Input, step: f64) {
        let Parameters { tunable, fixed } = self.parameters;
        assert!(!tunable.trap, "trapped in step");
        self.method_used = tunable.method;
        let part = if tunable.method == Method::Euler { step / fixed.tau } else { -(-step / fixed.tau).exp_m1() };
        for k in 0..3 {
            let target =
                if input.frozen { self.y[k] } else { tunable.gain[k] * (input.u[k] + f64::from(input.offset)) };
            self.y[k] += part * (target - self.y[k]);
            self.slope[k] = (target - self.y[k]) / fixed.tau;
        }
        self.count += 1;
    }

    fn output(&self) -> Output {
        let still = self.slope == Vector3::zeros();
        Output { y: self.y, sum: self.sums(&self.y), count: self.count, still, method_used: self.method_used }
    }

    fn output_derivative(&self) -> Output {
        Output { y: self.slope, sum: self.sums(&self.slope), ..Output::START }
    }
}
