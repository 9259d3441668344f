//! Samples that no vehicle causes: far from the one before them, relative to the ride's own
//! changes, and left again by the next one.

use crate::motion::{CHANNEL_COUNT, Channels, Sample};

/// The ride's usual changes, and a sample that has yet to be confirmed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spikes {
    usual: Channels,
    last: Option<(f64, Sample)>,
    doubtful: Option<(f64, Sample)>,
}

/// Judgement of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Judgement {
    /// It is used, after the doubtful one before it if there is one that it confirms.
    Used(Option<(f64, Sample)>),
    /// The sample waits for the next one.
    Doubtful,
}

impl Spikes {
    /// Forgets the samples, not the usual changes.
    pub fn clear(&mut self) {
        (self.last, self.doubtful) = (None, None);
    }

    /// All times until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        for (at, _) in self.last.iter_mut().chain(&mut self.doubtful) {
            *at -= time;
        }
    }

    /// Judges a sample of this time. The second value is true if a doubtful one before it was a
    /// spike.
    pub fn judge(&mut self, time: f64, sample: &Sample) -> (Judgement, bool) {
        // Least deviation of a spike, as for recordings: forces, rates, angles, speed.
        const MIN_SPIKE_DEVIATION: [f64; CHANNEL_COUNT] =
            [5.0, 5.0, 5.0, 1.0, 1.0, 1.0, f64::INFINITY, f64::INFINITY, f64::INFINITY, 5.0];
        // Usual changes from sample to sample beyond which one is a spike.
        const SPIKE_CHANGE_FACTOR: f64 = 10.0;
        // Samples over which the usual change is averaged.
        const AVERAGED_SAMPLES: f64 = 100.0;
        // Time after which a sample says nothing of the next [s].
        const LONG_AGO: f64 = 0.2;
        let Some((before, last)) = self.last.filter(|(before, _)| time - before < LONG_AGO) else {
            (self.last, self.doubtful) = (Some((time, *sample)), None);
            return (Judgement::Used(None), false);
        };
        let doubtful = self.doubtful.take();
        let previous = doubtful.map_or(last.motion.0, |(_, doubtful)| doubtful.motion.0);
        let change = (sample.motion.0 - previous).abs();
        // A spike counts little among the usual changes.
        let bounded =
            Channels::from_fn(|k, _| change[k].min(1.3 * self.usual[k] + 0.2 * MIN_SPIKE_DEVIATION[k].min(1.0)));
        let deviation = (sample.motion.0 - last.motion.0).abs();
        // What the ride does within a sample, it may do in each that has been lost.
        let gap = ((time - before) / 0.01).clamp(1.0, 10.0);
        let is_far = (0..CHANNEL_COUNT)
            .any(|k| deviation[k] > MIN_SPIKE_DEVIATION[k].max(SPIKE_CHANGE_FACTOR * self.usual[k]) * gap.sqrt());
        self.usual += (bounded - self.usual) / AVERAGED_SAMPLES;
        if !is_far {
            self.last = Some((time, *sample));
            return (Judgement::Used(None), doubtful.is_some());
        }
        // Nearer to the doubtful one than that is to the last: both are true.
        let confirms = doubtful.is_some_and(|(_, doubtful)| {
            let scaled = |from: &Channels, to: &Channels| {
                (0..CHANNEL_COUNT)
                    .filter(|k| MIN_SPIKE_DEVIATION[*k].is_finite())
                    .map(|k| ((from - to)[k] / MIN_SPIKE_DEVIATION[k]).abs())
                    .fold(0.0, f64::max)
            };
            scaled(&sample.motion.0, &doubtful.motion.0) < 0.5 * scaled(&doubtful.motion.0, &last.motion.0)
        });
        if confirms {
            self.last = Some((time, *sample));
            return (Judgement::Used(doubtful), false);
        }
        self.doubtful = Some((time, *sample));
        (Judgement::Doubtful, doubtful.is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Motion;

    fn sample(t: f64, surge: f64) -> Sample {
        let mut motion = Motion::at_rest();
        motion.0[0] = surge + 0.3 * (50.0 * t).sin();
        Sample { motion, ..Sample::default() }
    }

    /// Surges that are used, of a smooth ride with others at some samples.
    fn used(count: usize, other: impl Fn(usize) -> Option<f64>) -> Vec<f64> {
        let mut spikes = Spikes::default();
        let mut found = Vec::new();
        for k in 0..count {
            let t = k as f64 * 0.01;
            let sample = sample(t, other(k).unwrap_or(2.0 * t.sin()));
            if let Judgement::Used(doubtful) = spikes.judge(t, &sample).0 {
                found.extend(doubtful.map(|(_, sample)| sample.motion.0[0]));
                found.push(sample.motion.0[0]);
            }
        }
        found
    }

    #[test]
    fn single_spikes_are_left_out_and_nothing_else() {
        assert_eq!(used(1000, |_| None).len(), 1000);
        for spike in [8.0, 15.0, 40.0, 90.0, -60.0] {
            for every in [5, 13, 100] {
                let found = used(1000, |k| (k > 99 && k % every == 0).then_some(spike));
                assert!(found.iter().all(|surge| surge.abs() < 2.5), "{spike} every {every}");
                assert!(found.len() + 900 / every + 1 >= 1000, "{}", found.len());
            }
        }
    }

    #[test]
    fn a_blow_that_lasts_and_a_rough_ride_are_true() {
        let found = used(200, |k| (100..110).contains(&k).then_some(-30.0));
        assert_eq!(found.len(), 200);
        let rough = used(3000, |k| Some(if k * 7919 % 5 < 2 { 6.0 } else { -6.0 } * (k as f64 / 1000.0).min(1.0)));
        assert!(rough.len() > 2850, "{}", rough.len());
    }
}
