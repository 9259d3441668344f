//! Blocks (5) and (6), the angular channel: high-pass the rates of roll, pitch and
//! yaw, and integrate once.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::filter::bumpless::DecayingOffset;
use crate::filter::chain::Denominator;
use crate::filter::crossfade::CrossfadedChains;
use crate::interface::AngularParameters;
use crate::motion::Motion;

/// The angular channel with its state: roll, pitch, yaw.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AngularChannel {
    chains: CrossfadedChains,
    /// Correction to the input, after the motion was another one than demanded.
    offset: DecayingOffset,
    /// The rates at the end of the last step \[rad/s\].
    rates: Vector3<f64>,
}

impl AngularChannel {
    /// The channel at rest, ready for steps of `max_step` seconds.
    pub fn new(parameters: &AngularParameters, order: i32, max_step: f64) -> Self {
        let chains = CrossfadedChains::of_angle(denominators(parameters, order), max_step);
        AngularChannel { chains, offset: DecayingOffset::default(), rates: Vector3::zeros() }
    }

    /// Changes the filter parameters. Angles and rates fade to those of the new filters.
    pub fn retune(&mut self, parameters: &AngularParameters, order: i32) {
        self.chains.retune(denominators(parameters, order));
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
        let (position, rates) = self.chains.angle_and_rate();
        let acceleration = (rates - self.rates) / step;
        self.rates = rates;
        Motion { position, velocity: rates, acceleration }
    }

    /// Continues from angles and rates that are not those demanded, at the end of a step
    /// to whose end the rates `end` led. The angles' difference is washed out like an
    /// input, the rates' fades.
    #[cold]
    pub fn continue_from(&mut self, angles: &Vector3<f64>, rates: &Vector3<f64>, end: Vector3<f64>) {
        self.chains.set_angle(angles);
        self.chains.set_input(end + self.offset.value());
        let (_, demanded) = self.chains.angle_and_rate();
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
