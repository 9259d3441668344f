//! Linear interpolation between samples.

/// The place of a time among samples.
#[derive(Clone, Copy)]
pub struct Place {
    /// The first sample after it.
    pub after: usize,
    /// Fraction of the way from the sample before.
    fraction: f64,
}

/// The places of times among at least two samples. Both ascend; times beyond the samples' ends are
/// at the ends.
pub fn places(samples: &[f64], times: &[f64]) -> Vec<Place> {
    let mut after = 1;
    let place = |&time: &f64| {
        while after + 1 < samples.len() && samples[after] < time {
            after += 1;
        }
        let (before, next) = (samples[after - 1], samples[after]);
        Place { after, fraction: ((time - before) / (next - before)).clamp(0.0, 1.0) }
    };
    times.iter().map(place).collect()
}

/// The values at places.
pub fn values(places: &[Place], samples: &[f64]) -> Vec<f64> {
    let value = |place: &Place| {
        let (before, next) = (samples[place.after - 1], samples[place.after]);
        before + place.fraction * (next - before)
    };
    places.iter().map(value).collect()
}
