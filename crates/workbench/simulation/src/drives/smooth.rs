//! Smooth functions of time.

/// A change of a function of time: size, start and duration \[s\].
pub type Change = (f64, f64, f64);

/// A smooth rise from 0 to 1 that begins at `start` and takes `duration` \[s\].
pub fn rise(t: f64, start: f64, duration: f64) -> f64 {
    let x = ((t - start) / duration).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The integral of [`rise`] over time.
fn rise_integral(t: f64, start: f64, duration: f64) -> f64 {
    let x = ((t - start) / duration).clamp(0.0, 1.0);
    duration * (x * x * x - 0.5 * x * x * x * x) + (t - start - duration).max(0.0)
}

/// The time derivative of [`rise`].
pub fn rise_rate(t: f64, start: f64, duration: f64) -> f64 {
    let x = ((t - start) / duration).clamp(0.0, 1.0);
    6.0 * x * (1.0 - x) / duration
}

/// Sum of changes.
pub fn changes(changes: &[Change], t: f64) -> f64 {
    changes.iter().map(|&(change, start, duration)| change * rise(t, start, duration)).sum()
}

/// The integral of [`changes`].
pub fn changes_integral(changes: &[Change], t: f64) -> f64 {
    changes.iter().map(|&(change, start, duration)| change * rise_integral(t, start, duration)).sum()
}
