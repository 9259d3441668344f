//! Three first-order lags, with arrays of every shape, at least one variable of every kind, values
//! that are refused, and a trap.

use moris_interface::{
    Group, Identity, Model, Reader, Refusal, Row, Slot, Writer, enumeration, interface, interface_tree, slot_count,
    slot_table, units::S,
};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

interface! {
    /// The independent variable.
    pub struct Clock: Independent, Continuous {
        /// Simulation time.
        "time" time: f64 [S] = 0.0;
    }
}

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
    /// All variables.
    pub struct Variables {
        clock: Clock,
        input: Input,
        output: Output,
        tunable: Tunable,
        fixed: Fixed,
    }
}

/// Counts from 1, row by row.
const WEIGHTS: [Vector3<f64>; 6] = [
    Vector3::new(1.0, 2.0, 3.0),
    Vector3::new(4.0, 5.0, 6.0),
    Vector3::new(7.0, 8.0, 9.0),
    Vector3::new(10.0, 11.0, 12.0),
    Vector3::new(13.0, 14.0, 15.0),
    Vector3::new(16.0, 17.0, 18.0),
];

const SLOTS: [Slot; slot_count(Variables::ROWS)] = slot_table(Variables::ROWS);
const ROWS: &[Row] = Variables::ROWS;
/// Where the outputs begin: after time and inputs.
const FIRST_OUTPUT: usize = slot_count(Clock::ROWS) + slot_count(Input::ROWS);

/// Three first-order lags.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Lags {
    y: [f64; 3],
    slope: [f64; 3],
    weights: [[f64; 3]; 6],
    count: i32,
    euler: bool,
    tau: f64,
}

fn variables(slots: &[f64]) -> Variables {
    Variables::read(&mut Reader::new(slots))
}

fn accept(variables: &Variables) -> Result<(), Refusal> {
    let refuse = |variable: &str, reason: &str| Err(Refusal { variable: variable.into(), reason: reason.into() });
    if variables.tunable.gain.min() < 0.0 {
        return refuse("gain", "must not be negative");
    }
    if variables.fixed.tau <= 0.0 {
        return refuse("tau", "must be positive");
    }
    Ok(())
}

impl Lags {
    fn sums(&self, values: &[f64; 3]) -> [f64; 6] {
        self.weights.map(|row| row.iter().zip(values).map(|(weight, value)| weight * value).sum())
    }
}

impl Model for Lags {
    const IDENTITY: Identity = Identity {
        name: "Lags",
        version: "1.0",
        text: "Three first-order lags.",
        rows: ROWS,
        slots: &SLOTS,
        main_parameters: &[],
        stop_time: 2.0,
        step_size: 0.1,
    };

    fn start(slots: &mut [f64]) {
        Variables::default().write(&mut Writer::new(slots));
    }

    fn new(slots: &[f64]) -> Result<Self, Refusal> {
        let v = variables(slots);
        accept(&v)?;
        let weights = v.fixed.weight.map(Into::into);
        Ok(Lags { y: v.fixed.y0.into(), slope: [0.0; 3], weights, count: 0, euler: false, tau: v.fixed.tau })
    }

    fn retune(&mut self, slots: &[f64]) -> Result<(), Refusal> {
        accept(&variables(slots))
    }

    fn step(&mut self, slots: &[f64], _: Option<&[f64]>, step: f64) {
        let v = variables(slots);
        assert!(!v.tunable.trap, "trapped in step");
        self.euler = v.tunable.method == Method::Euler;
        let part = if self.euler { step / self.tau } else { -(-step / self.tau).exp_m1() };
        for k in 0..3 {
            let target =
                if v.input.frozen { self.y[k] } else { v.tunable.gain[k] * (v.input.u[k] + f64::from(v.input.offset)) };
            self.y[k] += part * (target - self.y[k]);
            self.slope[k] = (target - self.y[k]) / self.tau;
        }
        self.count += 1;
    }

    fn outputs(&self, slots: &mut [f64]) {
        let method_used = if self.euler { Method::Euler } else { Method::Exact };
        let still = self.slope == [0.0; 3];
        let output = Output { y: self.y.into(), sum: self.sums(&self.y), count: self.count, still, method_used };
        output.write(&mut Writer::new(&mut slots[FIRST_OUTPUT..]));
    }

    fn output_derivatives(&self, slots: &mut [f64]) {
        slots[FIRST_OUTPUT..][..3].copy_from_slice(&self.slope);
        slots[FIRST_OUTPUT + 3..][..6].copy_from_slice(&self.sums(&self.slope));
    }
}
