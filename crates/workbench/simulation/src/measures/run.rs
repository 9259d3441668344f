//! Input of the measures.

use crate::{Refusal, refuse};

/// Vectors, a sample each. A long run computes them where they are asked for.
pub trait Series<const N: usize> {
    /// Number of samples.
    fn count(&self) -> usize;
    /// The vector of a sample.
    fn at(&self, sample: usize) -> [f64; N];
}

impl<const N: usize> Series<N> for Vec<[f64; N]> {
    fn count(&self) -> usize {
        self.len()
    }

    fn at(&self, sample: usize) -> [f64; N] {
        self[sample]
    }
}

/// So many samples of a function.
impl<const N: usize, F: Fn(usize) -> [f64; N]> Series<N> for (usize, F) {
    fn count(&self) -> usize {
        self.0
    }

    fn at(&self, sample: usize) -> [f64; N] {
        self.1(sample)
    }
}

/// One recording with one set of parameters: series of equal length, sampled every `step` seconds.
/// The first sample is the one before the first step.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Time from one sample to the next \[s\].
    pub step: f64,
    /// Specific force that the vehicle's rider would feel, in head axes, gravity's
    /// reaction included \[m/s2\].
    pub desired_force: &'a dyn Series<3>,
    /// Specific force that the rider on the platform feels, in head axes, gravity's
    /// reaction included \[m/s2\].
    pub felt_force: &'a dyn Series<3>,
    /// The same, with any whole number of samples to a step, for the measures of comfort. The
    /// series begins and ends with `felt_force`; without finer samples it is the same series.
    pub felt_force_within_steps: &'a dyn Series<3>,
    /// Angular velocity that the vehicle's rider would feel, in head axes \[rad/s\].
    pub desired_rate: &'a dyn Series<3>,
    /// Fraction of the vehicle's surge and sway that the rider is meant to feel.
    pub scale: [f64; 2],
    /// Angular velocity that the rider on the platform feels, in head axes \[rad/s\].
    pub felt_rate: &'a dyn Series<3>,
    /// Motion of the platform.
    pub platform: Platform<'a>,
}

/// Motion of the platform, sampled as the [`Run`] is.
#[derive(Clone, Copy)]
pub struct Platform<'a> {
    /// Lengths of the actuators \[m\].
    pub legs: &'a dyn Series<6>,
    /// Shortest and longest length that an actuator may have \[m\].
    pub stroke: [f64; 2],
    /// Position of the platform relative to neutral, in the base frame \[m\].
    pub displacement: &'a dyn Series<3>,
    /// Rates of tilt coordination's roll and pitch \[rad/s\].
    pub tilt_rate: &'a dyn Series<2>,
    /// Limits active during the step before each sample.
    pub limited: &'a [Limits<bool>],
}

/// A value for each of the washout's limits: a flag that it was active, or a fraction of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits<T> {
    /// Tilt coordination.
    pub tilt: T,
    /// The soft limits in front of the safety units and the actuator guard.
    pub soft: T,
    /// The safety units.
    pub safety: T,
    /// The actuator guard.
    pub actuator: T,
}

impl Run<'_> {
    /// Checks that the run can be measured.
    ///
    /// # Errors
    /// The first thing found that is wrong with the series.
    pub fn check(&self) -> Result<(), Refusal> {
        if self.step.is_nan() || self.step <= 0.0 {
            refuse!("the time between samples is {} s; it must be above 0", self.step);
        }
        let expected = self.desired_force.count();
        if expected < 2 {
            refuse!("the run has {expected} samples; at least 2 are needed");
        }
        check_series("desired specific force", self.desired_force, expected)?;
        check_series("felt specific force", self.felt_force, expected)?;
        let steps = expected - 1;
        let divisions = (self.felt_force_within_steps.count().saturating_sub(1) / steps).max(1);
        check_series("felt specific force within steps", self.felt_force_within_steps, divisions * steps + 1)?;
        check_series("desired angular velocity", self.desired_rate, expected)?;
        check_series("felt angular velocity", self.felt_rate, expected)?;
        check_series("actuator lengths", self.platform.legs, expected)?;
        check_series("displacement", self.platform.displacement, expected)?;
        check_series("tilt rate", self.platform.tilt_rate, expected)?;
        check_length("active limits", self.platform.limited.len(), expected)
    }
}

fn check_series<const N: usize>(series: &'static str, values: &dyn Series<N>, expected: usize) -> Result<(), Refusal> {
    check_length(series, values.count(), expected)?;
    let wrong = |sample| Some((sample, values.at(sample).into_iter().find(|value| !value.is_finite())?));
    if let Some((sample, value)) = (0..expected).find_map(wrong) {
        refuse!("the {series} of sample {sample} is {value}; every value must be a finite number");
    }
    Ok(())
}

fn check_length(series: &'static str, found: usize, expected: usize) -> Result<(), Refusal> {
    if found != expected {
        refuse!(
            "the series of {series} has {found} samples, not {expected}; give each series a value for every sample"
        );
    }
    Ok(())
}

/// One axis of a series of vectors.
pub(crate) fn axis(series: &dyn Series<3>, axis: usize) -> impl ExactSizeIterator<Item = f64> + Clone {
    (0..series.count()).map(move |sample| series.at(sample)[axis])
}
