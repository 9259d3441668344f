//! Blocks (5) and (6), the angular channel: high-pass the rates of roll, pitch and
//! yaw, and integrate once.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::filter::bumpless::FadingOffset;
use crate::filter::chain::{Chains, Denominator};
use crate::interface::AngularParameters;
use crate::motion::Motion;

/// The angular channel with its state: roll, pitch, yaw.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AngularChannel {
    chains: Chains,
    offset: FadingOffset,
    /// The rates at the end of the last step \[rad/s\].
    rates: Vector3<f64>,
}

impl AngularChannel {
    /// The channel at rest.
    pub fn new(parameters: &AngularParameters, order: i32) -> Self {
        let chains = Chains::new(denominators(parameters, order));
        AngularChannel { chains, offset: FadingOffset::default(), rates: Vector3::zeros() }
    }

    /// Changes the filter parameters without a jump: angles and rates stay what they are, and the
    /// difference fades away.
    ///
    /// The input changes from `before` to `after` at the same instant, because of
    /// other new parameters.
    pub fn retune(&mut self, parameters: &AngularParameters, order: i32, before: Vector3<f64>, after: Vector3<f64>) {
        let rates = self.chains.high_pass(before);
        self.chains.retune(denominators(parameters, order), 1);
        self.offset.add(rates - self.chains.high_pass(after));
    }

    /// Advances by `step` seconds while the rates go linearly from `start` to `end`. Returns angle,
    /// rate and acceleration of roll, pitch and yaw.
    ///
    /// The acceleration is the mean over the step, from one step's rate to the next one's. The
    /// accelerations therefore add up to the rates, also where the input jumps between two steps.
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) -> Motion<Vector3<f64>> {
        let (offset_start, offset_end) = self.offset.advance(step);
        let end = end + offset_end;
        self.chains.advance(start + offset_start, end, step);
        let rates = self.chains.high_pass(end);
        let acceleration = (rates - self.rates) / step;
        self.rates = rates;
        Motion { position: self.chains.first_integral(), velocity: rates, acceleration }
    }

    /// Continues from angles and rates that are not those demanded, at the end of a step
    /// to whose end the rates `end` led. The angles' difference is washed out like an
    /// input, the rates' fades.
    #[cold]
    pub fn continue_from(&mut self, angles: &Vector3<f64>, rates: &Vector3<f64>, end: Vector3<f64>) {
        self.chains.set_first_integral(angles);
        let demanded = self.chains.high_pass(end + self.offset.value());
        self.offset.add(rates - demanded);
        self.rates = *rates;
    }
}

fn denominators(parameters: &AngularParameters, order: i32) -> [Denominator; 3] {
    let AngularParameters { omega1, zeta1, omega2, zeta2 } = parameters;
    [
        Denominator::new(order, omega1.roll, zeta1.roll, omega2.roll, zeta2.roll),
        Denominator::new(order, omega1.pitch, zeta1.pitch, omega2.pitch, zeta2.pitch),
        Denominator::new(order, omega1.yaw, zeta1.yaw, omega2.yaw, zeta2.yaw),
    ]
}
