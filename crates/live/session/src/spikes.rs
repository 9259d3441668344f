//! Samples that no vehicle causes: far from the one before them, relative to the ride's own
//! changes, and left again by the next one.

use crate::motion::{CHANNEL_COUNT, Channels, Sample};

/// Thresholds of spikes; arrays have forces, rates, angles and the speed.
struct SpikeLimits {
    /// Least deviation of a spike, as for recordings.
    min_deviation: [f64; CHANNEL_COUNT],
    /// Deviation that a vehicle makes in a blow, not again and again.
    violent_deviation: [f64; CHANNEL_COUNT],
    /// Usual changes from sample to sample beyond which one is a spike.
    change_factor: f64,
    /// Samples over which changes and violent samples are averaged.
    averaged_samples: f64,
    /// Fraction of violent samples up to which two that are alike are a blow, which
    /// itself is two of them.
    blow_fraction: f64,
    /// Samples alike beyond that fraction which are no spike: 60 ms at 100 Hz.
    alike_samples: u32,
    /// Fraction of violent samples beyond which nothing is believed.
    unbelievable_fraction: f64,
    /// Time after which a sample says nothing of the next \[s\].
    memory: f64,
}

const SPIKE_LIMITS: SpikeLimits = SpikeLimits {
    min_deviation: [5.0, 5.0, 5.0, 1.0, 1.0, 1.0, 0.5, 0.5, f64::INFINITY, 5.0],
    violent_deviation: [25.0, 25.0, 40.0, 6.0, 6.0, 6.0, 0.5, 0.5, f64::INFINITY, 10.0],
    change_factor: 10.0,
    averaged_samples: 100.0,
    blow_fraction: 0.03,
    alike_samples: 6,
    unbelievable_fraction: 0.25,
    memory: 0.2,
};

/// The ride's usual changes, and a sample that has yet to be confirmed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spikes {
    usual: Channels,
    last: Option<(f64, Sample)>,
    doubtful: Option<(f64, Sample)>,
    /// Doubtful samples in a row that are alike.
    alike: u32,
    /// Fraction of the last samples that deviated violently from those before.
    violent_fraction: f64,
}

/// Judgement of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Judgement {
    /// The sample is used, after the doubtful one before it if there is one that it confirms.
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

    /// True while so many samples deviate violently that no vehicle can be seen in them.
    pub fn are_frequent(&self) -> bool {
        self.violent_fraction > SPIKE_LIMITS.unbelievable_fraction
    }

    /// Judges a sample of this time. The second value is true if a doubtful one before it was a
    /// spike.
    pub fn judge(&mut self, time: f64, sample: &Sample) -> (Judgement, bool) {
        let Some((before, last)) = self.last.filter(|(before, _)| time - before < SPIKE_LIMITS.memory) else {
            (self.last, self.doubtful) = (Some((time, *sample)), None);
            return (Judgement::Used(None), false);
        };
        let doubtful = self.doubtful.take();
        let previous = doubtful.map_or(last.motion.0, |(_, doubtful)| doubtful.motion.0);
        let change = (sample.motion.0 - previous).abs();
        // A spike counts little among the usual changes.
        let bounded =
            Channels::from_fn(|k, _| change[k].min(1.3 * self.usual[k] + 0.2 * SPIKE_LIMITS.min_deviation[k].min(1.0)));
        let deviation = (sample.motion.0 - last.motion.0).abs();
        // What the ride does within a sample, it may do in each that has been lost.
        let gap = ((time - before) / 0.01).clamp(1.0, 10.0);
        let is_violent = (0..CHANNEL_COUNT).any(|k| deviation[k] > SPIKE_LIMITS.violent_deviation[k]);
        let is_far = is_violent
            || (0..CHANNEL_COUNT).any(|k| {
                deviation[k]
                    > SPIKE_LIMITS.min_deviation[k].max(SPIKE_LIMITS.change_factor * self.usual[k]) * gap.sqrt()
            });
        self.usual += (bounded - self.usual) / SPIKE_LIMITS.averaged_samples;
        let confirms = is_far && doubtful.is_some_and(|(_, doubtful)| are_alike(sample, &doubtful, &last));
        // A blow among few spikes counts once where it begins, and once where it ends.
        let is_counted = is_violent && !(confirms && self.violent_fraction < SPIKE_LIMITS.blow_fraction);
        self.violent_fraction +=
            (f64::from(u8::from(is_counted)) - self.violent_fraction) / SPIKE_LIMITS.averaged_samples;
        if !is_far {
            self.last = Some((time, *sample));
            return (Judgement::Used(None), doubtful.is_some());
        }
        self.alike = if confirms { self.alike + 1 } else { 0 };
        let needed =
            if self.violent_fraction < SPIKE_LIMITS.blow_fraction { 1 } else { SPIKE_LIMITS.alike_samples - 1 };
        if self.alike >= needed {
            self.last = Some((time, *sample));
            return (Judgement::Used(doubtful), false);
        }
        self.doubtful = Some((time, *sample));
        (Judgement::Doubtful, doubtful.is_some() && !confirms)
    }
}

/// True for a sample nearer to the doubtful one than that is to the last: both are true.
fn are_alike(sample: &Sample, doubtful: &Sample, last: &Sample) -> bool {
    let distance = |from: &Sample, to: &Sample| {
        (0..CHANNEL_COUNT)
            .filter(|k| SPIKE_LIMITS.min_deviation[*k].is_finite())
            .map(|k| ((from.motion.0 - to.motion.0)[k] / SPIKE_LIMITS.min_deviation[k]).abs())
            .fold(0.0, f64::max)
    };
    distance(sample, doubtful) < 0.5 * distance(doubtful, last)
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

    /// Pseudo-random numbers from 0 to 1.
    fn random(k: usize) -> f64 {
        ((k as f64 * 12.9898).sin() * 43_758.545).rem_euclid(1.0)
    }

    #[test]
    fn spikes_in_a_row_are_left_out_where_there_are_many() {
        let found = used(6000, |k| (k > 200 && random(k) < 0.1).then_some(90.0));
        assert!(found.iter().filter(|surge| surge.abs() > 2.5).count() <= 2 && found.len() > 5000, "{}", found.len());
    }

    #[test]
    fn spikes_in_every_second_sample_are_no_vehicle() {
        let mut spikes = Spikes::default();
        let mut first = None;
        for k in 0..1000 {
            let t = k as f64 * 0.01;
            let surge = if k > 200 && random(k) < 0.5 { 40.0 } else { 2.0 * t.sin() };
            spikes.judge(t, &sample(t, surge));
            first = first.or(spikes.are_frequent().then_some(k));
        }
        assert!(first.is_some_and(|k| (201..300).contains(&k)) && spikes.are_frequent(), "{first:?}");
        // A vehicle that is seen again is believed after 1.5 s.
        for k in 1000..1150 {
            let t = k as f64 * 0.01;
            spikes.judge(t, &sample(t, 2.0 * t.sin()));
        }
        assert!(!spikes.are_frequent());
    }

    #[test]
    fn a_blow_that_lasts_and_a_rough_ride_are_true() {
        let found = used(200, |k| (100..110).contains(&k).then_some(-30.0));
        assert_eq!(found.len(), 200);
        let rough = used(3000, |k| Some(if k * 7919 % 5 < 2 { 6.0 } else { -6.0 } * (k as f64 / 1000.0).min(1.0)));
        assert!(rough.len() > 2850, "{}", rough.len());
    }
}
