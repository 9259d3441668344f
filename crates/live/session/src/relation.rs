//! Two signals that should be equal: their sizes, and how well they go together.

use crate::motion::Sample;

/// Keeps a sample of this time \[s\] as the last one. Returns the interval \[s\] since
/// the one before and that one; none at first, and where the interval is too short or too
/// long to compare them.
pub fn compared_sample(last: &mut Option<(f64, Sample)>, time: f64, sample: &Sample) -> Option<(f64, Sample)> {
    // Shortest and longest time between samples that are compared [s].
    const SAMPLE_INTERVAL_RANGE: [f64; 2] = [1e-3, 0.2];
    let (earlier, before) = last.replace((time, *sample))?;
    let interval = time - earlier;
    (SAMPLE_INTERVAL_RANGE[0]..=SAMPLE_INTERVAL_RANGE[1]).contains(&interval).then_some((interval, before))
}

/// Sums of two signals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    count: f64,
    xx: f64,
    yy: f64,
    xy: f64,
}

/// Relation of two signals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relation {
    /// Size of the second one in terms of the first one's; infinite beside nothing.
    pub ratio: f64,
    /// Correlation about zero, from -1 to 1; 0 where one of them is nothing.
    pub correlation: f64,
    /// Root mean squares of the two.
    pub sizes: [f64; 2],
    /// Pairs of values.
    pub count: f64,
}

impl Sums {
    /// Takes a value of each.
    pub fn add(&mut self, x: f64, y: f64) {
        self.count += 1.0;
        self.xx += x * x;
        self.yy += y * y;
        self.xy += x * y;
    }

    /// The relation of what has been taken.
    pub fn relation(&self) -> Relation {
        let Sums { count, xx, yy, xy } = *self;
        let sizes = [xx, yy].map(|sum| (sum / count.max(1.0)).sqrt());
        let product = (xx * yy).sqrt();
        let correlation = if product > 0.0 { xy / product } else { 0.0 };
        Relation { ratio: sizes[1] / sizes[0], correlation, sizes, count }
    }
}

impl Relation {
    /// The same with the signs that go together.
    pub fn of_either_sign(&self) -> Relation {
        Relation { correlation: self.correlation.abs(), ..*self }
    }

    /// Root mean square of what the signals differ by.
    pub fn difference(&self) -> f64 {
        let [one, other] = self.sizes;
        (one * one + other * other - 2.0 * self.correlation * one * other).max(0.0).sqrt()
    }

    /// True for signals that go together, and whose ratio is this one but for a factor.
    pub fn is_near(&self, ratio: f64, factor: f64, correlation: f64) -> bool {
        self.correlation > correlation && (1.0 / factor..factor).contains(&(self.ratio / ratio))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratio_and_correlation_are_those_of_the_signals() {
        let mut sums = Sums::default();
        // A sine and three times it beside a cosine of the same size: cos of 45 degrees.
        for k in 0..1000 {
            let angle = f64::from(k) * std::f64::consts::TAU / 1000.0;
            sums.add(angle.sin(), 3.0 * (angle.sin() + angle.cos()));
        }
        let Relation { ratio, correlation, sizes, count } = sums.relation();
        assert!((ratio - 18_f64.sqrt()).abs() < 1e-9 && (correlation - 0.5_f64.sqrt()).abs() < 1e-9);
        assert!((sizes[0] - 0.5_f64.sqrt()).abs() < 1e-9 && count == 1000.0);
        let relation = sums.relation();
        assert!(relation.is_near(4.0, 1.1, 0.7) && !relation.is_near(4.0, 1.05, 0.7));
        assert!(!relation.is_near(4.0, 1.1, 0.75));
        // The second one is nine times the square of cos and sin of 45 degrees; less the first, 2 sin + 3 cos.
        assert!((relation.difference() - 6.5_f64.sqrt()).abs() < 1e-9);
        assert_eq!(Sums::default().relation().correlation, 0.0);
    }
}
