//! Shape: sign, time and proportion of the felt force of surge and sway, whatever its size.
//!
//! Both forces are taken below [`CUE_FREQUENCY`], by a Butterworth low-pass of second order,
//! forward and backward, so that it shifts nothing in time. An axis counts where the desired force
//! exceeds [`MIN_DESIRED_RMS`].

use std::array::from_fn;
use std::f64::consts::FRAC_1_SQRT_2;

use super::cues::HORIZONTAL_FORCE_THRESHOLD;
use super::statistics::{correlation, rms};
use super::zero_phase::{section, zero_phase};

/// Frequency below which a force is a cue of the vehicle's manoeuvre \[Hz\].
pub const CUE_FREQUENCY: f64 = 2.0;
/// RMS of the desired force above which an axis counts \[m/s2\].
pub const MIN_DESIRED_RMS: f64 = 0.1;

/// Shape of the felt force on one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisShape {
    /// Pearson's correlation of felt and desired; 0 where nothing is felt.
    pub shape: f64,
    /// RMS of felt over RMS of desired.
    pub size: f64,
    /// Fraction of the time in which the felt force is above [`HORIZONTAL_FORCE_THRESHOLD`] and has
    /// the opposite sign of the desired one, both below 2 Hz. Verdict, findings, `fit` and the last
    /// check of `tune` take the larger of surge's and sway's ([`Shape::most_inverted_axis`]), the
    /// search and the bench the mean.
    pub inverted: f64,
}

/// Shape of the felt force of surge and sway.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shape {
    /// Surge and sway; none where an axis does not count.
    pub axes: [Option<AxisShape>; 2],
    /// Fraction of the time in which the felt force is above the threshold and more than 90 degrees
    /// from the desired one. None where no axis counts.
    pub inverted_horizontal: Option<f64>,
    /// RMS of felt less scaled desired force over RMS of scaled desired force, of the axes that
    /// count. None where none does, or where nothing is asked of them.
    pub error: Option<f64>,
}

impl Shape {
    /// The largest fraction of inverted time of an axis, with its index; none where none counts.
    pub fn most_inverted_axis(&self) -> Option<(usize, f64)> {
        let inverted = |axis: usize| Some((axis, self.axes[axis]?.inverted));
        (0..2).filter_map(inverted).reduce(|most, next| if next.1 > most.1 { next } else { most })
    }

    /// The least correlation of an axis; none where none counts.
    pub fn least_shape(&self) -> Option<f64> {
        self.axes.iter().flatten().map(|axis| axis.shape).reduce(f64::min)
    }

    /// Geometric mean of the axes' sizes; none where none counts.
    pub fn size(&self) -> Option<f64> {
        let sizes: Vec<f64> = self.axes.iter().flatten().map(|axis| axis.size.ln()).collect();
        (!sizes.is_empty()).then(|| (sizes.iter().sum::<f64>() / sizes.len() as f64).exp())
    }
}

/// One axis of a series of vectors.
fn series_axis(series: &[[f64; 3]], axis: usize) -> Vec<f64> {
    series.iter().map(|sample| sample[axis]).collect()
}

/// The desired force below [`CUE_FREQUENCY`], prepared for comparisons with several felt ones.
#[derive(Clone, Debug)]
pub struct Desired {
    step: f64,
    /// The axes that count.
    axes: [Option<Vec<f64>>; 2],
}

impl Desired {
    /// The desired specific force \[m/s2\], sampled every `step` seconds.
    pub fn new(force: &[[f64; 3]], step: f64) -> Self {
        let counting = |k: usize| {
            below_cue_frequency(&series_axis(force, k), step).filter(|low| rms(low.iter().copied()) > MIN_DESIRED_RMS)
        };
        Desired { step, axes: from_fn(counting) }
    }

    /// The shape of a felt force that was sampled at the same times. `scale` is the fraction of the
    /// vehicle's surge and sway that the rider is meant to feel.
    pub fn shape(&self, felt: &[[f64; 3]], scale: [f64; 2]) -> Shape {
        let felt: [Option<Vec<f64>>; 2] =
            from_fn(|k| self.axes[k].as_ref().and_then(|_| below_cue_frequency(&series_axis(felt, k), self.step)));
        let pairs = || (0..2).filter_map(|k| Some((k, self.axes[k].as_ref()?, felt[k].as_ref()?)));
        let error = pairs().fold([0.0; 2], |[error, asked], (k, desired, felt)| {
            let of = |(d, f): (&f64, &f64)| [(f - scale[k] * d).powi(2), (scale[k] * d).powi(2)];
            let sums = desired.iter().zip(felt).map(of);
            sums.fold([error, asked], |[error, asked], [e, a]| [error + e, asked + a])
        });
        let mut axes = [None; 2];
        for (k, desired, felt) in pairs() {
            axes[k] = Some(axis_shape(desired, felt));
        }
        Shape {
            axes,
            inverted_horizontal: pairs().next().map(|_| {
                let at = |sample: usize| {
                    let vector =
                        pairs().map(|(_, desired, felt)| (desired[sample] * felt[sample], felt[sample].powi(2)));
                    let (product, square) = vector.fold((0.0, 0.0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
                    square.sqrt() > HORIZONTAL_FORCE_THRESHOLD && product < 0.0
                };
                let count = pairs().map(|(_, desired, _)| desired.len()).min().unwrap_or(0);
                (0..count).filter(|&sample| at(sample)).count() as f64 / count as f64
            }),
            error: (error[1] > 0.0).then(|| (error[0] / error[1]).sqrt()),
        }
    }
}

fn axis_shape(desired: &[f64], felt: &[f64]) -> AxisShape {
    let is_inverted = |(d, f): (&f64, &f64)| f.abs() > HORIZONTAL_FORCE_THRESHOLD && f * d < 0.0;
    AxisShape {
        shape: correlation(desired, felt).unwrap_or(0.0),
        size: rms(felt.iter().copied()) / rms(desired.iter().copied()),
        inverted: desired.iter().zip(felt).filter(|&pair| is_inverted(pair)).count() as f64 / desired.len() as f64,
    }
}

/// The signal below [`CUE_FREQUENCY`], without a shift in time. None where the sampling is too
/// coarse or the signal too short.
pub fn below_cue_frequency(signal: &[f64], step: f64) -> Option<Vec<f64>> {
    zero_phase(signal.iter().copied(), CUE_FREQUENCY, step, 1, low_pass).map(Iterator::collect)
}

/// Butterworth low-pass of second order by the bilinear transform, with `k` the tangent of half the
/// cutoff's angle. The filter starts as if the first value had always been there.
fn low_pass(k: f64) -> impl FnMut(f64) -> f64 + Clone {
    let (mut first, mut section) = (None, section(k, FRAC_1_SQRT_2, k, 2.0));
    move |value| {
        let first = *first.get_or_insert(value);
        first + section(value - first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    /// Two forces, computed from the time alone: desired and felt.
    fn forces(step: f64, count: usize) -> [Vec<[f64; 3]>; 2] {
        let desired = |t: f64| {
            [3.0 * (1.3 * t).sin() + 0.5 * (9.0 * t).cos(), 2.0 * (0.7 * t + 0.4).sin() + 0.3 * (40.0 * t).sin(), 9.8]
        };
        let felt = |t: f64| {
            let sway = if t > 4.0 { 0.5 * (0.7 * t + 2.3).sin() } else { 0.0 };
            [1.2 * (1.3 * t - 0.9).sin() + 0.4 * (25.0 * t).sin() + 0.2, sway, 9.8]
        };
        let times = || (0..count).map(|k| k as f64 * step);
        [times().map(desired).collect(), times().map(felt).collect()]
    }

    /// Values of SciPy 1.17 and NumPy for [`forces`]: `sosfiltfilt(butter(2, 2, fs=1/step,
    /// output="sos"), force)`, then `corrcoef`, ratios of RMS and counts.
    #[test]
    fn shape_size_and_inverted_are_those_of_scipy() {
        struct Expected {
            step: f64,
            count: usize,
            low: [(usize, f64); 3],
            error: f64,
            axes: [(f64, f64, usize); 2],
            vector: usize,
        }
        let expected = [
            Expected {
                step: 0.01,
                count: 1200,
                low: [(0, 0.48871644683110976), (400, -2.7007434711089053), (1199, 0.8495229452203309)],
                error: 0.9786330871591309,
                axes: [(0.6153437164069411, 0.414691460440332, 299), (-0.30372500585035705, 0.18236924991904974, 354)],
                vector: 309,
            },
            Expected {
                step: 0.02,
                count: 900,
                low: [(0, 0.4888087234368364), (300, 2.666309012111116), (899, -2.9795667425349603)],
                error: 1.0346696425524147,
                axes: [(0.5905392056516049, 0.4093886515095779, 245), (-0.2629022577570852, 0.2216204804726392, 333)],
                vector: 267,
            },
        ];
        for Expected { step, count, low, error, axes, vector } in expected {
            let [desired, felt] = forces(step, count);
            let filtered = below_cue_frequency(&series_axis(&desired, 0), step).unwrap();
            for (sample, value) in low {
                assert_near(filtered[sample], value, 1e-9);
            }
            let shape = Desired::new(&desired, step).shape(&felt, [0.4, 0.3]);
            assert_near(shape.error.unwrap(), error, 1e-9);
            assert_near(shape.inverted_horizontal.unwrap(), vector as f64 / count as f64, 1e-12);
            for (found, (correlation, size, inverted)) in shape.axes.iter().zip(axes) {
                let found = found.unwrap();
                assert_near(found.shape, correlation, 1e-9);
                assert_near(found.size, size, 1e-9);
                assert_near(found.inverted, inverted as f64 / count as f64, 1e-12);
            }
            assert_eq!(shape.most_inverted_axis().unwrap().0, 1);
        }
    }

    #[test]
    fn a_scaled_copy_has_its_size_no_inversion_and_no_error_at_its_scale() {
        let [desired, _] = forces(0.01, 1200);
        let felt: Vec<[f64; 3]> = desired.iter().map(|[x, y, z]| [0.3 * x, 0.6 * y, *z]).collect();
        let shape = Desired::new(&desired, 0.01).shape(&felt, [0.3, 0.6]);
        let [surge, sway] = shape.axes.map(Option::unwrap);
        assert_near(surge.shape, 1.0, 1e-12);
        assert_near(surge.size, 0.3, 1e-12);
        assert_near(sway.size, 0.6, 1e-12);
        assert_near(shape.error.unwrap(), 0.0, 1e-9);
        assert_eq!((surge.inverted, sway.inverted, shape.inverted_horizontal), (0.0, 0.0, Some(0.0)));
        // At rest the error is all that is asked, and nothing is inverted.
        let rest = vec![[0.0, 0.0, 9.8]; desired.len()];
        let shape = Desired::new(&desired, 0.01).shape(&rest, [0.5; 2]);
        assert_near(shape.error.unwrap(), 1.0, 1e-12);
        assert_eq!((shape.least_shape(), shape.size(), shape.inverted_horizontal), (Some(0.0), Some(0.0), Some(0.0)));
    }

    #[test]
    fn an_axis_on_which_little_is_desired_does_not_count() {
        let desired: Vec<[f64; 3]> = (0..500).map(|k| [(0.02 * f64::from(k)).sin(), 0.05, 9.8]).collect();
        let shape = Desired::new(&desired, 0.01).shape(&desired, [1.0; 2]);
        assert!(shape.axes[0].is_some() && shape.axes[1].is_none());
        let none = Desired::new(&[[0.0; 3]; 500], 0.01).shape(&[[1.0; 3]; 500], [1.0; 2]);
        assert_eq!(none, Shape::default());
        // Too coarse or too short for the filter.
        assert_eq!(Desired::new(&desired, 0.25).shape(&desired, [1.0; 2]), Shape::default());
        assert_eq!(Desired::new(&desired[..9], 0.01).shape(&desired[..9], [1.0; 2]), Shape::default());
        // Nothing is asked at a scale of 0.
        assert_eq!(Desired::new(&desired, 0.01).shape(&desired, [0.0; 2]).error, None);
    }
}
