//! A second-order low-pass with a double pole, omega^2/(s + omega)^2: no overshoot, and the least
//! delay of those without.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use wide::{CmpLt, f64x4};

use crate::motion::lanes::lanes;

/// Three low-passes of one break frequency, side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CriticallyDamped {
    /// The outputs and their time derivatives; the fourth lane is zero.
    value: f64x4,
    slope: f64x4,
    /// omega times the last step, and exp(-that).
    angle: f64,
    decay: f64,
}

/// State below this is set to zero: what decays for long would otherwise end in denormal
/// numbers, which are slow.
const DENORMAL_THRESHOLD: f64x4 = f64x4::new([1e-30; 4]);

impl CriticallyDamped {
    /// The outputs now.
    pub fn value(&self) -> Vector3<f64> {
        let [x, y, z, _] = self.value.to_array();
        Vector3::new(x, y, z)
    }

    /// Sets the outputs, at rest.
    pub fn set(&mut self, value: Vector3<f64>) {
        self.value = lanes(&value);
        self.slope = f64x4::ZERO;
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`; `omega`
    /// \[rad/s\] is above 0.
    ///
    /// The solution is exact. The response to a ramp of slope s is the ramp, late by 2/omega. A
    /// deviation e from it, with slope e', decays as ((1 + omega t) e + t e') exp(-omega t).
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, omega: f64, step: f64) {
        let angle = omega * step;
        if angle != self.angle {
            (self.angle, self.decay) = (angle, libm::exp(-angle));
        }
        let (start, end) = (lanes(&start), lanes(&end));
        let slope = (end - start) / step;
        let lag = slope * (2.0 / omega);
        let error = self.value - start + lag;
        let error_slope = self.slope - slope;
        let value = end - lag + (error * (1.0 + angle) + error_slope * step) * self.decay;
        let slope = slope + (error_slope * (1.0 - angle) - error * (omega * angle)) * self.decay;
        self.value = !value.abs().cmp_lt(DENORMAL_THRESHOLD) & value;
        self.slope = !slope.abs().cmp_lt(DENORMAL_THRESHOLD) & slope;
    }
}
