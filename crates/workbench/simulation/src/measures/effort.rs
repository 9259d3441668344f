//! Effort of the platform: stroke used, time limited, tilt rate.

use super::run::{Limits, Platform, Series};

/// Effort of the platform in a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Shortest length of any actuator \[m\].
    pub shortest_leg: f64,
    /// Longest length of any actuator \[m\].
    pub longest_leg: f64,
    /// Span from the shortest to the longest length of any actuator, as a fraction of the stroke: 1
    /// when both ends are reached.
    pub stroke_used: f64,
    /// Smallest distance of any actuator from either end of its stroke \[m\].
    pub smallest_margin: f64,
    /// Fraction of the steps in which each limit acted, 0 to 1.
    pub limited: Limits<f64>,
    /// Largest rate of tilt coordination in roll or pitch \[rad/s\].
    pub largest_tilt_rate: f64,
    /// Distance of the platform from neutral at the end \[m\].
    pub final_distance: f64,
}

/// Effort of the platform in a run.
pub fn effort(platform: &Platform) -> Effort {
    fn values<const N: usize>(series: &dyn Series<N>) -> impl Iterator<Item = f64> {
        (0..series.count()).flat_map(|sample| series.at(sample))
    }
    let legs = || values(platform.legs);
    let shortest_leg = legs().fold(f64::INFINITY, f64::min);
    let longest_leg = legs().fold(f64::NEG_INFINITY, f64::max);
    let [shortest, longest] = platform.stroke;
    let last = platform.displacement.count().checked_sub(1).map(|last| platform.displacement.at(last));
    Effort {
        shortest_leg,
        longest_leg,
        stroke_used: (longest_leg - shortest_leg) / (longest - shortest),
        smallest_margin: (shortest_leg - shortest).min(longest - longest_leg),
        limited: Limits {
            tilt: fraction(platform.limited, |limited| limited.tilt),
            soft: fraction(platform.limited, |limited| limited.soft),
            safety: fraction(platform.limited, |limited| limited.safety),
            actuator: fraction(platform.limited, |limited| limited.actuator),
        },
        largest_tilt_rate: values(platform.tilt_rate).fold(0.0, |largest, rate| rate.abs().max(largest)),
        final_distance: last.map_or(0.0, |[x, y, z]| (x * x + y * y + z * z).sqrt()),
    }
}

/// Fraction of the steps in which a limit was active, 0 to 1. The first sample is
/// none: no step led to it.
pub fn fraction(limited: &[Limits<bool>], at_work: impl Fn(&Limits<bool>) -> bool) -> f64 {
    match limited {
        [] | [_] => 0.0,
        [_, steps @ ..] => steps.iter().filter(|limited| at_work(limited)).count() as f64 / steps.len() as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_effort_is_counted_over_the_steps() {
        let limited = |tilt, soft, safety, actuator| Limits { tilt, soft, safety, actuator };
        let mut legs = vec![[1.3; 6]; 5];
        legs[2][2] = 1.1;
        legs[3][0] = 1.5;
        let platform = Platform {
            legs: &legs,
            stroke: [1.0, 1.6],
            displacement: &vec![[0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [0.03, -0.04, 0.12]],
            tilt_rate: &vec![[0.0; 2], [0.01, -0.05], [0.0; 2], [0.0; 2], [0.0; 2]],
            limited: &[
                limited(true, true, true, true),
                limited(true, true, false, false),
                limited(true, false, true, false),
                limited(true, true, false, false),
                limited(false, false, false, false),
            ],
        };
        let effort = effort(&platform);
        assert_eq!((effort.shortest_leg, effort.longest_leg), (1.1, 1.5));
        assert!((effort.stroke_used - 0.4 / 0.6).abs() < 1e-12);
        assert!((effort.smallest_margin - 0.1).abs() < 1e-12);
        assert_eq!(effort.limited, Limits { tilt: 0.75, soft: 0.5, safety: 0.25, actuator: 0.0 });
        assert_eq!(effort.largest_tilt_rate, 0.05);
        assert!((effort.final_distance - 0.13).abs() < 1e-12);
    }
}
