//! Bumpless transfer: a jump that a new parameter would cause is held as a
//! correction, and goes to zero. A [`DecayingOffset`] begins to decay at once; a [`GlidingOffset`]
//! glides, without a jump of its first three derivatives.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

/// A correction to the inputs of three filters that decays to zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DecayingOffset {
    value: Vector3<f64>,
}

/// Corrections that go to zero through four equal lags. The changes add up, so a host may
/// make any number of them at any time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GlidingOffset<const N: usize> {
    /// The output of each lag; the last one's is the correction.
    lags: [SVector<f64, N>; 4],
    /// True until all have ended.
    glides: bool,
}

/// Break frequency of each lag \[rad/s\]: 2 % of a correction is left after 2 s, and its slope is
/// at most 1.01 times the correction a second.
const GLIDE_PACE: f64 = 4.5;
/// Corrections below this become zero.
const GLIDE_END: f64 = 1e-12;

impl<const N: usize> Default for GlidingOffset<N> {
    fn default() -> Self {
        GlidingOffset { lags: [SVector::zeros(); 4], glides: false }
    }
}

impl<const N: usize> GlidingOffset<N> {
    /// The corrections now.
    pub fn values(&self) -> SVector<f64, N> {
        self.lags[3]
    }

    /// True if there is no correction.
    #[inline(always)]
    pub fn is_over(&self) -> bool {
        !self.glides
    }

    /// Adds corrections.
    pub fn add(&mut self, values: &SVector<f64, N>) {
        self.lags.iter_mut().for_each(|lag| *lag += values);
        self.glides = true;
    }

    /// Advances by `step` seconds.
    pub fn advance(&mut self, step: f64) {
        if self.is_over() {
            return;
        }
        let angle = GLIDE_PACE * step;
        let decay = libm::exp(-angle);
        let [a, b, c, d] = self.lags;
        let b_next = b + angle * a;
        let c_next = c + angle * (b + angle / 2.0 * a);
        let d_next = d + angle * (c + angle / 2.0 * (b + angle / 3.0 * a));
        self.lags = [a, b_next, c_next, d_next].map(|lag| decay * lag);
        if self.lags.iter().all(|lag| lag.amax() < GLIDE_END) {
            *self = Self::default();
        }
    }
}

/// A gain of either sign as it glides: by its ratio where it is large, and evenly below `scale`. A
/// weak feedback thus becomes a strong one through all paces of return between them.
pub fn compressed(gain: f64, scale: f64) -> f64 {
    libm::asinh(gain / scale)
}

/// The gain that [`compressed`] has made this of.
pub fn expanded(value: f64, scale: f64) -> f64 {
    scale * libm::sinh(value)
}

/// Makes the functions of a struct whose numbers glide by their logarithms. The pattern names all
/// its fields, the list those that glide.
macro_rules! glide_by_logarithms {
    ($parameters:ty, $fields:pat => [$($gliding:ident),+]) => {
        /// Count of the numbers that glide.
        const GLIDING_COUNT: usize = [$(stringify!($gliding)),+].len();

        /// Logarithms of the numbers that glide.
        fn logarithms(parameters: &$parameters) -> SVector<f64, GLIDING_COUNT> {
            let $fields = *parameters;
            SVector::from([$($gliding),+].map(libm::log))
        }

        /// The parameters in force on the way to these.
        fn in_force(parameters: &$parameters, glide: &GlidingOffset<GLIDING_COUNT>) -> $parameters {
            let mut in_force = *parameters;
            [$(in_force.$gliding),+] = (logarithms(parameters) + glide.values()).map(libm::exp).into();
            in_force
        }
    };
}
pub(crate) use glide_by_logarithms;

/// Time constant of the decay of an offset \[s\].
const OFFSET_TIME_CONSTANT: f64 = 0.5;
/// Offsets below this become zero.
const OFFSET_TOLERANCE: f64 = 1e-15;

impl DecayingOffset {
    /// The correction now.
    pub fn value(&self) -> Vector3<f64> {
        self.value
    }

    /// True if there is no correction.
    #[inline(always)]
    pub fn is_over(&self) -> bool {
        self.value == Vector3::zeros()
    }

    /// Adds a correction.
    pub fn add(&mut self, value: Vector3<f64>) {
        self.value += value;
    }

    /// Advances by `step` seconds. Returns the correction at their start and end.
    pub fn advance(&mut self, step: f64) -> (Vector3<f64>, Vector3<f64>) {
        let start = self.value;
        if start != Vector3::zeros() {
            let end = start * libm::exp(-step / OFFSET_TIME_CONSTANT);
            self.value = end.map(|value| if value.abs() < OFFSET_TOLERANCE { 0.0 } else { value });
        }
        (start, self.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed form of four equal lags: exp(-p t) times the first four terms of exp(p t).
    #[test]
    fn offsets_glide_through_four_lags_and_add_up() {
        let form = |t: f64| {
            let x = GLIDE_PACE * t;
            (-x).exp() * (1.0 + x + x * x / 2.0 + x * x * x / 6.0)
        };
        let mut offset = GlidingOffset::<2>::default();
        offset.add(&SVector::from([1.0, -2.0]));
        let mut time = 0.0;
        for k in 0..200 {
            if k == 50 {
                offset.add(&SVector::from([0.5, 0.0]));
            }
            let step = if k % 3 == 0 { 0.01 } else { 0.02 };
            offset.advance(step);
            time += step;
            let second = if k >= 50 { 0.5 * form(time - 0.83) } else { 0.0 };
            let [one, two] = offset.values().into();
            assert!((one - form(time) - second).abs() < 1e-12 && (two + 2.0 * form(time)).abs() < 1e-12, "at {time}");
        }
        assert!((form(2.0) - 0.0212).abs() < 1e-4);
        offset.advance(10.0);
        assert!(offset.is_over());
    }

    #[test]
    fn gains_of_either_sign_are_compressed_and_expanded() {
        for gain in [-400.0, -0.1, 0.0, 1e-3, 7.0] {
            assert!((expanded(compressed(gain, 0.3), 0.3) - gain).abs() <= 1e-12 * gain.abs());
        }
        let way = |from: f64, to: f64| compressed(to, 0.3) - compressed(from, 0.3);
        assert!((way(100.0, 200.0) - 2.0_f64.ln()).abs() < 1e-5, "by ratios");
        assert!((way(-1e-3, 1e-3) - 2e-3 / 0.3).abs() < 1e-7, "evenly");
    }

    #[test]
    fn an_offset_decays_with_its_time_constant_and_ends() {
        let mut offset = DecayingOffset::default();
        offset.add(Vector3::new(1.0, -2.0, 0.0));
        for k in 0..100 {
            let (start, end) = offset.advance(0.02);
            let expected = |steps: i32| Vector3::new(1.0, -2.0, 0.0) * (-0.04 * f64::from(steps)).exp();
            assert!((start - expected(k)).amax() < 1e-12 && (end - expected(k + 1)).amax() < 1e-12);
        }
        // 1e-15 is reached after 35 time constants.
        offset.advance(17.0);
        assert_eq!(offset.advance(0.02), (Vector3::zeros(), Vector3::zeros()));
    }
}
