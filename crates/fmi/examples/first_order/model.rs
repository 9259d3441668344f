//! A first-order lag, with at least one variable of every kind, with values that it
//! refuses, and with traps.

use moris_interface::{
    Group, Identity, Model, Reader, Refusal, Row, Slot, Writer, enumeration, interface, interface_tree, slot_count,
    slot_table, units::S,
};
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
    pub struct Output: Output, Continuous {
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
        "gain" gain: f64 = 1.0;
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
    /// All variables.
    pub struct Variables {
        clock: Clock,
        input: Input,
        switch: Switch,
        output: Output,
        counted: Counted,
        tunable: Tunable,
        fixed: Fixed,
    }
}

const SLOTS: [Slot; slot_count(Variables::ROWS)] = slot_table(Variables::ROWS);
/// Where the outputs begin: after time and three inputs.
const FIRST_OUTPUT: usize = 4;
const ROWS: &[Row] = Variables::ROWS;

/// A first-order lag.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FirstOrder {
    y: f64,
    slope: f64,
    count: i32,
    rising: bool,
    euler: bool,
    tau: f64,
    gain: f64,
}

fn variables(slots: &[f64]) -> Variables {
    Variables::read(&mut Reader::new(slots))
}

fn accept(variables: &Variables) -> Result<(), Refusal> {
    let refuse = |variable: &str, reason: &str| Err(Refusal { variable: variable.into(), reason: reason.into() });
    if variables.tunable.gain < 0.0 {
        return refuse("gain", "must not be negative");
    }
    if variables.fixed.tau <= 0.0 {
        return refuse("tau", "must be positive");
    }
    Ok(())
}

impl Model for FirstOrder {
    const IDENTITY: Identity = Identity {
        name: "FirstOrder",
        version: "1.0",
        text: "A first-order lag.",
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
        assert!(v.tunable.trap != 1, "trapped in new");
        let (tau, gain) = (v.fixed.tau, v.tunable.gain);
        Ok(FirstOrder { y: v.fixed.y0, slope: 0.0, count: 0, rising: false, euler: false, tau, gain })
    }

    fn retune(&mut self, slots: &[f64]) -> Result<(), Refusal> {
        let v = variables(slots);
        accept(&v)?;
        assert!(v.tunable.trap != 2, "trapped in retune");
        self.gain = v.tunable.gain;
        Ok(())
    }

    fn longest_step(&self) -> f64 {
        1.0
    }

    fn step(&mut self, slots: &[f64], derivatives: Option<&[f64]>, step: f64) {
        let v = variables(slots);
        let before = self.y;
        let slope = self.gain * derivatives.map_or(0.0, |derivatives| derivatives[1]);
        let target = self.gain * (v.input.u + f64::from(v.switch.offset));
        self.euler = v.tunable.method == Method::Euler;
        if !v.switch.frozen {
            self.y = if self.euler {
                let part = step / f64::from(v.fixed.substeps);
                (0..v.fixed.substeps).fold(before, |y, _| y + part * (target - y) / self.tau)
            } else {
                // y = target + slope (t - tau) is the solution that the transient decays to.
                let decay = (-step / self.tau).exp();
                target + slope * (step - self.tau) + (before - target + slope * self.tau) * decay
            };
        }
        assert!(v.tunable.trap != 3, "trapped in step");
        self.slope = (target + slope * step - self.y) / self.tau;
        self.rising = self.y > before;
        self.count += 1;
    }

    fn outputs(&self, slots: &mut [f64]) {
        let method_used = if self.euler { Method::Euler } else { Method::Exact };
        let counted = Counted { count: self.count, rising: self.rising, method_used };
        let mut writer = Writer::new(&mut slots[FIRST_OUTPUT..]);
        Output { y: self.y }.write(&mut writer);
        counted.write(&mut writer);
    }

    fn output_derivatives(&self, slots: &mut [f64]) {
        slots[FIRST_OUTPUT] = self.slope;
    }
}
