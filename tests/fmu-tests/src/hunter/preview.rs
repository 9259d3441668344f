//! Previews that a host gives: of what comes, or of nothing of the kind.

use moris_washout::Preview;
use moris_washout::interface::PREVIEW_SAMPLES;
use serde::{Deserialize, Serialize};

use super::random::{bits_at, fraction_at};

/// Previews by the number of the step. Any may contradict the inputs and the previews before it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Previews {
    pub forces: Forces,
    /// Of forces that are no forecast \[m/s2\].
    pub amplitude: f64,
    /// Range of the number of elements.
    pub count: [i32; 2],
    /// Range of the time between elements \[s\], log-uniform.
    pub step: [f64; 2],
    /// Steps for which count, step and forces hold.
    pub held: usize,
    pub seed: u32,
}

/// Forces of a preview.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Forces {
    /// The inputs to come.
    Ahead,
    /// The negative of it.
    Contrary,
    /// Uniform noise.
    Noise,
    /// The amplitude and its negative, from element to element and from preview to preview.
    Alternating,
    /// A jump from the amplitude to its negative at a random element.
    Jump,
    /// NaN, infinities and large numbers among ordinary ones, in the step's length, too.
    NonFinite,
}

impl Previews {
    /// The preview before step number `step`. `ahead` gives surge and sway of the inputs after a
    /// time \[s\].
    pub fn at(&self, step: usize, ahead: impl Fn(f64) -> [f64; 2]) -> Preview {
        let number = step / self.held.max(1);
        // Random numbers of this preview.
        let fraction = |k: usize| fraction_at(self.seed, 64 * number + k);
        let bits = |k: usize| bits_at(self.seed, 64 * number + k);
        let [fewest, most] = self.count;
        let count = fewest + ((most - fewest + 1) as f64 * fraction(0)).floor() as i32;
        let [shortest, longest] = self.step;
        let mut length = shortest * (longest / shortest).powf(fraction(1));
        if self.forces == Forces::NonFinite && bits(2).is_multiple_of(4) {
            length = non_finite(bits(3));
        }
        let jump = bits(4) as usize % PREVIEW_SAMPLES;
        let signed = |positive: bool| if positive { self.amplitude } else { -self.amplitude };
        let force = |axis: usize, k: usize| match self.forces {
            Forces::Ahead => ahead((k + 1) as f64 * length)[axis],
            Forces::Contrary => -ahead((k + 1) as f64 * length)[axis],
            Forces::Noise => self.amplitude * (2.0 * fraction(8 + 2 * k + axis) - 1.0),
            Forces::Alternating => signed((number + k + axis).is_multiple_of(2)),
            Forces::Jump => signed(k < jump),
            Forces::NonFinite => non_finite(bits(8 + 2 * k + axis)),
        };
        Preview {
            count,
            step: length,
            surge: std::array::from_fn(|k| force(0, k)),
            sway: std::array::from_fn(|k| force(1, k)),
        }
    }
}

/// A number, or what is none.
fn non_finite(bits: u64) -> f64 {
    const VALUES: [f64; 10] =
        [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, f64::MIN, 5e-324, -0.0, 1e4, -3.0, 0.2];
    VALUES[(bits % VALUES.len() as u64) as usize]
}
