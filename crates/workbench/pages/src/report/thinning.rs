//! Reduction of a recording's samples, so that the page of a long recording opens.

/// Intervals of samples, of each of which two values are kept.
///
/// For a curve these are the least and the greatest value, in their order. Peaks keep their height,
/// and move by less than an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thinning {
    samples: usize,
    /// Number of intervals; none if every sample is kept.
    intervals: Option<usize>,
}

impl Thinning {
    /// Keeps at most `most` of `samples` samples, or all if there are no more.
    /// `most` is at least 4.
    pub fn new(samples: usize, most: usize) -> Self {
        Thinning { samples, intervals: (samples > most.max(4)).then_some(most.max(4) / 2) }
    }

    /// Interval between the samples that are kept, in samples; 1 if all are.
    pub fn factor(&self) -> f64 {
        self.intervals.map_or(1.0, |intervals| self.samples as f64 / (2 * intervals) as f64)
    }

    /// First samples of each half of each interval.
    fn halves(&self) -> impl Iterator<Item = usize> + use<> {
        let (samples, count) = (self.samples, self.intervals.map_or(self.samples, |intervals| 2 * intervals));
        (0..count).map(move |k| k * samples / count)
    }

    /// Values at the times that are kept: for times themselves, and for what belongs
    /// together, such as a pose.
    pub fn at_times(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        self.halves().map(value).collect()
    }

    /// The least and the greatest value of each interval, in their order.
    pub fn extremes(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let Some(intervals) = self.intervals else { return (0..self.samples).map(value).collect() };
        let mut kept = Vec::with_capacity(2 * intervals);
        for k in 0..intervals {
            let (from, to) = (k * self.samples / intervals, (k + 1) * self.samples / intervals);
            let (mut least, mut greatest) = ((from, value(from)), (from, value(from)));
            for sample in from + 1..to {
                let at = (sample, value(sample));
                if at.1 < least.1 {
                    least = at;
                }
                if at.1 > greatest.1 {
                    greatest = at;
                }
            }
            let in_order = if least.0 <= greatest.0 { [least.1, greatest.1] } else { [greatest.1, least.1] };
            kept.extend(in_order);
        }
        kept
    }

    /// Flags that are raised where any is until the next that is kept.
    pub fn any(&self, flag: impl Fn(usize) -> bool) -> Vec<bool> {
        let ends = self.halves().skip(1).chain([self.samples]);
        self.halves().zip(ends).map(|(from, to)| (from..to).any(&flag)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_samples_are_all_kept() {
        let thinning = Thinning::new(100, 100);
        let value = |k: usize| (k as f64).sin();
        let all: Vec<f64> = (0..100).map(value).collect();
        assert_eq!((thinning.at_times(value), thinning.extremes(value)), (all.clone(), all));
        assert_eq!(thinning.factor(), 1.0);
    }

    #[test]
    fn peaks_and_flags_stay() {
        let (samples, most) = (10_007, 500);
        let thinning = Thinning::new(samples, most);
        let value = |k: usize| if k == 6_321 { 5.0 } else { (k as f64 * 1e-3).sin() };
        let times = thinning.at_times(|k| k as f64);
        let kept = thinning.extremes(value);
        let flags = thinning.any(|k| k == 6_321);
        assert_eq!((times.len(), kept.len(), flags.len()), (most, most, most));
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
        let peak = kept.iter().position(|&value| value == 5.0).unwrap();
        assert!((times[peak] - 6_321.0).abs() <= 2.0 * thinning.factor() + 1.0, "{}", times[peak]);
        assert_eq!(flags.iter().filter(|&&flag| flag).count(), 1);
        // Every value lies between those of its interval.
        for (k, &time) in times.iter().enumerate() {
            let (from, to) = (time as usize, times.get(k + 1).map_or(samples, |&next| next as usize));
            let pair = [kept[k & !1], kept[k | 1]];
            assert!((from..to).all(|k| value(k) >= pair[0].min(pair[1]) && value(k) <= pair[0].max(pair[1])));
        }
    }
}
