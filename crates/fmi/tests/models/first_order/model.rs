//! A first-order lag, with at least one variable of every kind, with values that it
//! refuses, and with traps.

use moris_interface::{
    Group, Identity, Model, ParameterError, enumeration, interface, interface_tree, refuse, units::S, variables,
};
use serde::{Deserialize, Serialize};

interface! {
    /// Signals to filter.
    pub struct Signals: Input, Continuous {
        /// Input of the lag.
        "u" u: f64 = 0.0;
    }
}

interface! {
    /// Inputs that jump.
    pub struct Switch: Input, Discrete {
        /// Added to u.
        "offset" offset: i32 { -5 ..= 5 } = 0;
        /// True: the output stays where it is.
        "frozen" frozen: bool = false;
    }
}

interface! {
    /// The lagged input.
    pub struct Lagged: Output, Continuous {
        /// Follows gain * (u + offset).
        "y" y: f64 = 0.0;
    }
}

interface! {
    /// A counter and a choice.
    pub struct Counted: Output, Discrete {
        /// Steps done.
        "count" count: i32 = 0;
        /// True if y grew in the last step.
        "rising" rising: bool = false;
        /// The method of the last step.
        "methodUsed" method_used: Method = Method::Exact;
    }
}

enumeration! {
    /// Method of integration.
    pub enum Method {
        /// By the closed form.
        "exact" Exact,
        /// By Euler's rule, in substeps.
        "euler" Euler,
    }
}

interface! {
    /// Tunable parameters.
    pub struct Tunable: Parameter, Tunable {
        /// Ratio of output to input at rest; negative ones are refused.
        "gain" gain: f64 = 1.0, usual(0.1 ..= 1e3);
        /// Method of integration.
        "method" method: Method = Method::Exact;
        /// Where the model panics: 1 in new, 2 in retune, 3 in step.
        "trap" trap: i32 { 0 ..= 3 } = 0;
        /// Has no effect.
        "idle" idle: bool = false;
    }
}

interface! {
    /// Fixed parameters.
    pub struct Fixed: Parameter, Fixed {
        /// Time constant; must be positive.
        "tau" tau: f64 [S] = 0.5;
        /// The output at the beginning.
        "y0" y0: f64 = 0.0;
        /// Euler steps in a communication step.
        "substeps" substeps: i32 { 1 ..= 10 } = 1;
    }
}

interface_tree! {
    /// All inputs.
    pub struct Input {
        signals: Signals,
        switch: Switch,
    }
}

interface_tree! {
    /// All outputs.
    pub struct Output {
        lagged: Lagged,
        counted: Counted,
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

/// A first-order lag.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FirstOrder {
    parameters: Parameters,
    y: f64,
    slope: f64,
    counted: Counted,
}

fn check(parameters: &Parameters) -> Result<(), ParameterError> {
    if parameters.tunable.gain < 0.0 {
        return refuse("gain", "must not be negative");
    }
    if parameters.fixed.tau <= 0.0 {
        return refuse("tau", "must be positive");
    }
    Ok(())
}

impl Model for FirstOrder {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = Identity {
        name: "FirstOrder",
        version: "1.0",
        text: "A first-order lag.",
        rows: Variables::ROWS,
        slots: Variables::SLOTS,
        stop_time: 2.0,
        step_size: 0.1,
    };

    fn new(parameters: &Parameters, _: &Input) -> Result<Self, ParameterError> {
        check(parameters)?;
        assert!(parameters.tunable.trap != 1, "trapped in new");
        Ok(FirstOrder { parameters: *parameters, y: parameters.fixed.y0, slope: 0.0, counted: Counted::default() })
    }

    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        check(parameters)?;
        assert!(parameters.tunable.trap != 2, "trapped in retune");
        self.parameters = *parameters;
        Ok(())
    }

    fn warnings(parameters: &Parameters) -> Vec<String> {
        let slow = "tau is above 1000 s: the output hardly moves".to_owned();
        (parameters.fixed.tau > 1000.0).then_some(slow).into_iter().collect()
    }

    fn input_warnings(_: &Parameters, input: &Input) -> Vec<String> {
        (input.signals.u == 13.0).then(|| "u is 13 at first".to_owned()).into_iter().collect()
    }

    fn max_communication_step(&self) -> f64 {
        1.0
    }

    fn step_between(&mut self, start: &Input, end: &Input, step: f64) {
        let Parameters { tunable, fixed } = self.parameters;
        let before = self.y;
        let slope = tunable.gain * (end.signals.u - start.signals.u) / step;
        let target = tunable.gain * (start.signals.u + f64::from(start.switch.offset));
        if !start.switch.frozen {
            self.y = match tunable.method {
                Method::Euler => {
                    let part = step / f64::from(fixed.substeps);
                    (0..fixed.substeps).fold(before, |y, _| y + part * (target - y) / fixed.tau)
                }
                // y = target + slope (t - tau) is the solution that the transient decays to.
                Method::Exact => {
                    let decay = (-step / fixed.tau).exp();
                    target + slope * (step - fixed.tau) + (before - target + slope * fixed.tau) * decay
                }
            };
        }
        assert!(tunable.trap != 3, "trapped in step");
        self.slope = (target + slope * step - self.y) / fixed.tau;
        self.counted = Counted { count: self.counted.count + 1, rising: self.y > before, method_used: tunable.method };
    }

    fn output(&self) -> Output {
        Output { lagged: Lagged { y: self.y }, counted: self.counted }
    }

    fn output_derivative(&self) -> Output {
        Output { lagged: Lagged { y: self.slope }, ..Output::START }
    }
}
