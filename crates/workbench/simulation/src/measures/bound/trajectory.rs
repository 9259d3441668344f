//! The motion behind a bound.

/// A motion with constant accelerations over each interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Length of an interval \[s\].
    pub interval: f64,
    /// h/g, by which the tilt's acceleration acts at the head \[s2\].
    pub arm: f64,
    /// The intervals' ends, the first at time 0.
    pub knots: Vec<Knot>,
}

/// The axis at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Knot {
    /// Position relative to neutral \[m\].
    pub position: f64,
    /// Velocity \[m/s\].
    pub velocity: f64,
    /// Specific force due to tilt, g sin(tilt) \[m/s2\].
    pub tilt_force: f64,
    /// The rate of that \[m/s3\].
    pub tilt_force_rate: f64,
}

impl Trajectory {
    /// Felt specific force at a time, as a deviation from rest \[m/s2\]. At the end of an
    /// interval it is that of the next interval. Before the first and after the last interval,
    /// these are extrapolated.
    pub fn felt(&self, time: f64) -> f64 {
        let last = self.knots.len() - 2;
        let k = ((time / self.interval).max(0.0) as usize).min(last);
        self.felt_within(k, time - k as f64 * self.interval)
    }

    /// Felt specific force in interval `k`, `time` after its beginning.
    fn felt_within(&self, k: usize, time: f64) -> f64 {
        let (from, to) = (&self.knots[k], &self.knots[k + 1]);
        let acceleration = (to.velocity - from.velocity) / self.interval;
        let tilt_acceleration = (to.tilt_force_rate - from.tilt_force_rate) / self.interval;
        let tilt = from.tilt_force + time * (from.tilt_force_rate + 0.5 * time * tilt_acceleration);
        acceleration - self.arm * tilt_acceleration + tilt
    }

    /// RMS error relative to a desired force that is linear between its samples, in continuous time
    /// and over its whole duration \[m/s2\]. An interval is a whole number of steps.
    pub fn rms_error(&self, desired: &[f64], step: f64) -> f64 {
        let steps = (self.interval / step).round() as usize;
        let last = self.knots.len() - 2;
        let squares = desired.windows(2).enumerate().map(|(sample, pair)| {
            let k = (sample / steps).min(last);
            let begin = (sample - k * steps) as f64 * step;
            // The error is quadratic in time, its square quartic: three points of Gauss are exact.
            let square = |fraction: f64| {
                let desired = pair[0] + fraction * (pair[1] - pair[0]);
                (self.felt_within(k, begin + fraction * step) - desired).powi(2)
            };
            let outer = 0.5 * 0.6_f64.sqrt();
            (5.0 * square(0.5 - outer) + 8.0 * square(0.5) + 5.0 * square(0.5 + outer)) / 18.0
        });
        (squares.sum::<f64>() / (desired.len() - 1) as f64).sqrt()
    }
}
