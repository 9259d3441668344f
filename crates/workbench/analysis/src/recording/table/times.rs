//! Times of samples: their order, their usual step, and gaps between them.

use moris_interface::shown;

use super::sampling::MIN_SAMPLE_STEP;
use crate::message::{Message, given};
use crate::recording::signal::median;
use crate::texts::text;

/// Longest gap that is interpolated over without a warning \[s\].
pub const LONGEST_GAP: f64 = 0.2;

/// Spreads samples of equal times, as clocks with few digits write them, evenly up to the next
/// time. Returns a warning if there are any.
pub fn spread_equal_times(time: &mut [f64]) -> Option<Message> {
    let mean = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let (mut first, mut spread) = (0, 0);
    while first < time.len() {
        let count = time[first..].iter().take_while(|&&t| t == time[first]).count();
        // The last times have none after them.
        let step = time.get(first + count).map_or(mean, |next| (next - time[first]) / count as f64);
        for k in 1..count {
            time[first + k] += k as f64 * step;
        }
        spread += count - 1;
        first += count;
    }
    (spread > 0).then(|| text!["equal-times-spread", spread])
}

/// The first sample whose time is not after the one before, and the reason why it is refused.
pub fn disorder(time: &[f64]) -> Option<(usize, Message)> {
    let wrong = (1..time.len()).find(|&k| time[k] <= time[k - 1])?;
    let (before, after) = (time[wrong - 1], time[wrong]);
    let fault = if after < before { "goes back" } else { "stands still" };
    let remedy = if time.windows(2).all(|pair| pair[1] <= pair[0]) && after < before {
        text!["last-line-first"]
    } else if after < before && is_nearly_sorted(time) {
        text!["lines-misplaced"]
    } else {
        remedy_for_equal_times(time, wrong)
    };
    let (before, after) = (shown(before), shown(after));
    Some((wrong, text!["time-in-disorder", fault, after, before, remedy]))
}

/// True for different times of which each is a few places from where it belongs.
fn is_nearly_sorted(time: &[f64]) -> bool {
    // Number of lines by which samples in nearly the right order may be misplaced.
    const MOST_MISPLACED: usize = 8;
    let mut sorted = time.to_vec();
    sorted.sort_by(f64::total_cmp);
    let is_near = |k: usize| time[k] >= time[k - MOST_MISPLACED];
    sorted.windows(2).all(|pair| pair[0] < pair[1]) && (MOST_MISPLACED..time.len()).all(is_near)
}

/// The remedy where a sample has the time of the one before.
fn remedy_for_equal_times(time: &[f64], sample: usize) -> Message {
    let duration = time[time.len() - 1] - time[0];
    if time[sample] != time[sample - 1] || duration <= 0.0 {
        return text!["or-none-of-the-times"];
    }
    let rate = (time.len() - 1) as f64 / duration;
    if rate > 1.0 / MIN_SAMPLE_STEP {
        return text!["finer-than-any", rate];
    }
    text!["times-rounded", resample = given("resample", format!("{rate:.0}"))]
}

/// The median step \[s\], which is insensitive to missing samples and outliers.
pub fn median_step(time: &[f64]) -> f64 {
    median(time.windows(2).map(|pair| pair[1] - pair[0]))
}

/// The steps longer than `longest` \[s\], each with the line before it.
pub fn gaps(time: &[f64], lines: &[u64], longest: f64) -> impl Iterator<Item = (f64, u64)> {
    let steps = time.windows(2).map(|pair| pair[1] - pair[0]);
    steps.zip(lines.iter().copied()).filter(move |(step, _)| *step > longest)
}
