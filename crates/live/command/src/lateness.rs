//! Histogram of delays: wide classes for printing, fine bins for quantiles.

use std::fmt::{self, Display, Formatter};
use std::time::Duration;

/// Upper ends of the classes \[us\].
const CLASS_LIMITS_US: [u64; 10] = [20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000];
/// Width of a bin \[us\], and their number: up to 20 ms.
const BIN_WIDTH_US: u64 = 5;
const BIN_COUNT: usize = 4_000;

/// Counts of delays by their length.
#[derive(Clone, Debug)]
pub struct Lateness {
    bins: [u32; BIN_COUNT],
    counts: [u64; CLASS_LIMITS_US.len() + 1],
    largest: Duration,
}

/// The upper end of each class \[ms\], of the last the largest time, and its count.
pub type Classes = [(f64, u64); CLASS_LIMITS_US.len() + 1];

impl Default for Lateness {
    fn default() -> Self {
        Lateness { bins: [0; BIN_COUNT], counts: Default::default(), largest: Duration::ZERO }
    }
}

impl Lateness {
    /// Counts a delay.
    pub fn take(&mut self, late: Duration) {
        let micros = late.as_micros().min(u128::from(u64::MAX)) as u64;
        let class = CLASS_LIMITS_US.iter().position(|end| micros <= *end).unwrap_or(CLASS_LIMITS_US.len());
        self.counts[class] += 1;
        if let Some(bin) = self.bins.get_mut((micros / BIN_WIDTH_US) as usize) {
            *bin += 1;
        }
        self.largest = self.largest.max(late);
    }

    /// Counts in classes, for printing.
    pub fn classes(&self) -> Classes {
        let end = |class: usize| {
            CLASS_LIMITS_US.get(class).map_or(self.largest.as_secs_f64() * 1e3, |end| *end as f64 * 1e-3)
        };
        std::array::from_fn(|class| (end(class), self.counts[class]))
    }

    /// Times longer than that of a step.
    pub fn overruns(&self) -> u64 {
        let on_time = CLASS_LIMITS_US.iter().filter(|end| **end <= 1_000).count();
        self.counts[on_time..].iter().sum()
    }

    /// The time that this part of all does not exceed \[us\], to 5 us.
    pub fn quantile(&self, part: f64) -> f64 {
        let wanted = part * self.counts.iter().sum::<u64>() as f64;
        let mut count = 0.0;
        for (bin, of_bin) in self.bins.iter().enumerate() {
            count += f64::from(*of_bin);
            if count >= wanted {
                return ((bin as u64 + 1) * BIN_WIDTH_US) as f64;
            }
        }
        self.largest.as_secs_f64() * 1e6
    }

    /// Quantiles in a line.
    pub fn summary(&self) -> String {
        if self.counts.iter().all(|count| *count == 0) {
            return "none".to_owned();
        }
        let [half, most, nearly] = [0.5, 0.99, 0.999].map(|part| 1e-3 * self.quantile(part));
        format!("median {half:.3} ms, 99 % {most:.3} ms, 99.9 % {nearly:.3} ms")
    }
}

impl Display for Lateness {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        writeln!(f, "wake-up late by at most   steps")?;
        for (end, count) in self.classes().into_iter().filter(|(_, count)| *count > 0) {
            writeln!(f, "{end:>21.2} ms {count:>7}")?;
        }
        writeln!(f, "{}", self.summary())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_counted_by_classes() {
        let mut lateness = Lateness::default();
        for micros in [0, 20, 21, 1_000, 1_001, 60_000] {
            lateness.take(Duration::from_micros(micros));
        }
        assert_eq!(lateness.overruns(), 2);
        let shown = lateness.to_string();
        assert!(shown.contains("0.02 ms       2") && shown.contains("60.00 ms       1"), "{shown}");
    }

    #[test]
    fn quantiles_are_right_to_a_bin() {
        let mut lateness = Lateness::default();
        assert_eq!(lateness.summary(), "none");
        (0..1000).for_each(|k| lateness.take(Duration::from_micros(10 * k + 1)));
        assert_eq!((lateness.quantile(0.5), lateness.quantile(0.99)), (4_995.0, 9_895.0));
        lateness.take(Duration::from_secs(1));
        assert_eq!(lateness.quantile(1.0), 1e6);
    }
}
