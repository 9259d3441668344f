//! Health of the telemetry: which samples count, and what their absence means.

use crate::attitude::angle_between;
use crate::clock::{Clock, Stamp};
use crate::clock_pace::ClockPace;
use crate::motion::{Implausible, Sample};
use crate::spikes::{Judgement, Spikes};
use crate::standing::Standing;
use crate::transitions::{Event, named};

/// Time without a good sample after which the source is silent \[s\].
pub const SILENT_TIME: f64 = 0.5;
/// Time without a good sample after which it is stale \[s\].
pub const STALE_TIME: f64 = 1.5;

named! {
    /// Health of the source.
    #[derive(Default)]
    Health {
        /// There has been no sample yet.
        #[default]
        Waiting "waiting",
        /// Good samples of a running vehicle.
        Running "running",
        /// Good samples of a paused vehicle.
        Paused "paused",
        /// No good sample for [`SILENT_TIME`].
        Silent "silent",
        /// No good sample for [`STALE_TIME`].
        Stale "stale",
    }
}

/// Numbers of samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// All that arrived.
    pub received: u64,
    /// Not finite, or absurd: dropped.
    pub bad: u64,
    /// With an earlier time than one before: dropped.
    pub repeated: u64,
    /// The same as the one before, of a vehicle that moves.
    pub same: u64,
    /// Changes of the place.
    pub teleports: u64,
    /// Spikes that no vehicle causes: dropped, and counted among the bad ones.
    pub spikes: u64,
}

impl Counts {
    /// All that were dropped.
    pub fn dropped(&self) -> u64 {
        self.bad + self.repeated
    }
}

/// Reason for which a sample was dropped.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DropReason {
    /// No number, or absurd.
    #[error("{0}")]
    Implausible(Implausible),
    /// Far from the samples around it.
    #[error("a spike that no vehicle causes")]
    Spike,
    /// The packet's clock stands at this time \[s\], or goes back a little.
    #[error("the packets' clock does not advance: repeated time {0:.3} s; check the line of time")]
    Repeated(f64),
}

/// Effect of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accepted {
    /// Time of the sample \[s\]; none if it is not to be used.
    pub time: Option<f64>,
    /// True if it takes the place of the sample before it.
    pub instead: bool,
    /// A sample that was held back until this one confirmed it, with its time \[s\].
    pub confirmed: Option<(f64, Sample)>,
    /// Events that follow.
    pub events: [Option<Event>; 2],
    /// True if it has nothing to do with the samples before it.
    pub is_new: bool,
}

/// The source of telemetry.
#[derive(Clone, Copy, Debug, Default)]
pub struct Source {
    /// True for a source inside the program: it neither pauses without saying so
    /// nor sends random bytes.
    is_inside: bool,
    clock: Clock,
    pace: ClockPace,
    standing: Standing,
    health: Health,
    counts: Counts,
    dropped: Option<DropReason>,
    last_good: f64,
    last: Option<Sample>,
    /// Time of the last sample \[s\].
    stamp: f64,
    /// Samples that follow from each other while the vehicle does not run yet, and whether the
    /// first of them is of another place.
    confirming: u32,
    is_elsewhere: bool,
    spikes: Spikes,
    /// The last pause was sent as such.
    says_paused: bool,
}

impl Source {
    /// A source inside the program, or outside of it.
    pub fn new(is_inside: bool) -> Self {
        Source { is_inside, ..Source::default() }
    }

    /// Health of the telemetry now.
    pub fn health(&self) -> Health {
        self.health
    }

    /// The numbers of samples.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// The reason for which a sample was dropped last.
    pub fn dropped(&self) -> Option<DropReason> {
        self.dropped
    }

    /// Seconds by which the packets' clock advances in a second, if it must be in another unit.
    pub fn wrong_pace(&self) -> Option<f64> {
        self.pace.wrong()
    }

    /// The cause of the last pause.
    pub fn pause_cause(&self) -> &'static str {
        if self.says_paused { "the packets' field `paused` says so" } else { "all numbers stay the same" }
    }

    /// Judges a sample that arrived then.
    pub fn receive(&mut self, arrival: f64, sample: &Sample) -> Accepted {
        let mut accepted = Accepted { time: None, instead: false, confirmed: None, events: [None; 2], is_new: false };
        self.counts.received += 1;
        // In a menu a program's clock stands still, and its numbers may be anything.
        if sample.paused && arrival.is_finite() {
            self.says_paused = true;
            accepted.events[0] = self.pause(arrival);
            return accepted;
        }
        let implausible = sample.implausible();
        if implausible.is_some() || !arrival.is_finite() {
            self.counts.bad += 1;
            self.dropped = implausible.map(DropReason::Implausible);
            self.confirming = 0;
            return accepted;
        }
        if !self.is_inside {
            let changes = self.standing.changes();
            if self.standing.is_paused(arrival, sample) {
                self.says_paused = false;
                accepted.events[0] = self.pause(arrival);
                return accepted;
            }
            self.counts.same += u64::from(self.standing.changes() == changes);
        }
        let (time, restarted) = match self.clock.stamp(arrival, sample.time) {
            Stamp::Repeated => {
                self.counts.repeated += 1;
                self.dropped = sample.time.map(DropReason::Repeated);
                return accepted;
            }
            Stamp::Instead => {
                accepted.instead = true;
                (self.stamp, false)
            }
            Stamp::At(time) => (time, false),
            Stamp::Restarted(time) => (time, true),
        };
        self.pace.take(arrival, sample.time, restarted);
        let elsewhere = restarted || self.last.is_some_and(|last| is_elsewhere(&last, sample, time - self.stamp));
        (self.stamp, self.last) = (time, Some(*sample));
        let was_running = self.health == Health::Running;
        if elsewhere {
            self.spikes.clear();
        }
        let (judgement, was_spike) = self.spikes.judge(time, sample);
        if was_spike {
            self.counts.spikes += 1;
            self.counts.bad += 1;
            self.dropped = Some(DropReason::Spike);
        }
        // Silence follows, until the vehicle is seen again.
        if self.spikes.are_frequent() {
            self.confirming = 0;
            return accepted;
        }
        if !was_running && (judgement == Judgement::Doubtful || !self.confirms(elsewhere)) {
            return accepted;
        }
        let elsewhere = if was_running { elsewhere } else { std::mem::take(&mut self.is_elsewhere) };
        (self.health, self.last_good, self.confirming) = (Health::Running, arrival, 0);
        accepted.is_new = elsewhere || !was_running;
        if let Judgement::Used(confirmed) = judgement {
            accepted.confirmed = confirmed.filter(|_| !accepted.is_new);
            accepted.time = Some(time);
        }
        if !was_running {
            accepted.events[0] = Some(Event::Resume);
        }
        if elsewhere {
            self.counts.teleports += 1;
            accepted.events[1] = Some(Event::Teleport);
        }
        accepted
    }

    /// A sample of a paused vehicle. The event, if it is the first one.
    fn pause(&mut self, arrival: f64) -> Option<Event> {
        (self.last_good, self.confirming) = (arrival, 0);
        let before = std::mem::replace(&mut self.health, Health::Paused);
        (before != Health::Paused).then_some(Event::Pause)
    }

    /// True once enough samples follow from each other.
    fn confirms(&mut self, elsewhere: bool) -> bool {
        // Samples that follow from each other with which a vehicle runs: random bytes do not.
        const CONFIRMING_SAMPLES: u32 = 5;
        if self.confirming == 0 {
            self.is_elsewhere = elsewhere;
        } else if elsewhere {
            (self.confirming, self.is_elsewhere) = (0, true);
        }
        self.confirming += 1;
        self.is_inside || self.confirming >= CONFIRMING_SAMPLES
    }

    /// All times until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        self.clock.slip(time);
        self.pace.slip(time);
        self.standing.slip(time);
        self.spikes.slip(time);
        self.last_good -= time;
        self.stamp -= time;
    }

    /// The event that follows from silence until now.
    pub fn listen(&mut self, now: f64) -> Option<Event> {
        let silence = now - self.last_good;
        let (health, event) = match self.health {
            Health::Running | Health::Paused if silence >= SILENT_TIME => (Health::Silent, Event::Silence),
            Health::Silent if silence >= STALE_TIME => (Health::Stale, Event::Stale),
            _ => return None,
        };
        self.health = health;
        Some(event)
    }
}

/// True if the vehicle cannot have gone from one sample to the next in this time.
fn is_elsewhere(before: &Sample, after: &Sample, time: f64) -> bool {
    // A place that differs from the expected one by more than this is another place [m].
    const MAX_PLACE_DEVIATION: f64 = 10.0;
    // An attitude that turns by more within a sample than its rates say is that of another place
    // [rad].
    const MAX_ATTITUDE_DEVIATION: f64 = 0.7;
    let speed = before.motion.speed().abs().max(after.motion.speed().abs());
    let moved = before.position.zip(after.position).map_or(0.0, |(before, after)| (after - before).norm());
    let rate = before.motion.rates().norm().max(after.motion.rates().norm());
    let turned = || angle_between(&before.motion.angles(), &after.motion.angles());
    moved > MAX_PLACE_DEVIATION + 2.0 * speed * time
        || time < 0.1 && turned() > MAX_ATTITUDE_DEVIATION + 2.0 * rate * time
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    fn at(time: f64) -> Sample {
        Sample { time: Some(time), position: Some(Vector3::new(20.0 * time, 0.0, 0.0)), ..Sample::default() }
    }

    /// Samples every 10 ms from one time to another, and the events that follow.
    fn events(source: &mut Source, from: f64, to: f64, sample: impl Fn(f64) -> Option<Sample>) -> Vec<Event> {
        let mut found = Vec::new();
        for k in (from * 1e3).round() as i32..(to * 1e3).round() as i32 {
            let now = f64::from(k) * 1e-3;
            if let Some(sample) = (k % 10 == 0).then(|| sample(now)).flatten() {
                found.extend(source.receive(now, &sample).events.into_iter().flatten());
            }
            found.extend(source.listen(now));
        }
        found
    }

    #[test]
    fn silence_and_its_end() {
        let mut source = Source::default();
        assert_eq!(events(&mut source, 0.0, 1.0, |t| Some(at(t))), [Event::Resume]);
        assert_eq!(events(&mut source, 1.0, 1.48, |_| None), []);
        assert_eq!(events(&mut source, 1.48, 2.4, |_| None), [Event::Silence]);
        assert_eq!(source.health(), Health::Silent);
        assert_eq!(events(&mut source, 2.4, 9.0, |_| None), [Event::Stale]);
        assert_eq!(events(&mut source, 9.0, 9.5, |t| Some(at(t))), [Event::Resume, Event::Teleport]);
    }

    #[test]
    fn samples_that_are_no_numbers_are_silence() {
        let mut source = Source::default();
        events(&mut source, 0.0, 1.0, |t| Some(at(t)));
        let broken = |t: f64| {
            let mut sample = at(t);
            sample.motion.0[(t * 1e3) as usize / 10 % 10] = [f64::NAN, f64::INFINITY, 1e30][(t * 1e3) as usize % 3];
            Some(sample)
        };
        let found = events(&mut source, 1.0, 3.0, broken);
        assert!(found.starts_with(&[Event::Silence]), "{found:?}");
        assert!(source.counts().bad > 150);
        // A clock that stands still is silence as well.
        let mut source = Source::default();
        events(&mut source, 0.0, 1.0, |t| Some(at(t)));
        assert_eq!(events(&mut source, 1.0, 4.0, |_| Some(at(0.99))), [Event::Silence, Event::Stale]);
        assert_eq!(source.counts().repeated, 300);
    }

    #[test]
    fn a_pause_is_known_by_its_flag() {
        let mut source = Source::default();
        events(&mut source, 0.0, 1.0, |t| Some(at(t)));
        let paused = |_| {
            // The clock stands still, and the numbers are none.
            let mut sample = Sample { paused: true, ..at(1.0) };
            sample.motion.0.fill(f64::NAN);
            Some(sample)
        };
        assert_eq!(events(&mut source, 1.0, 5.0, paused), [Event::Pause]);
        assert_eq!(events(&mut source, 5.0, 6.0, |t| Some(at(t))), [Event::Resume, Event::Teleport]);
    }

    /// A replay that stands, with a car at 20 m/s in it, then goes on.
    #[test]
    fn packets_that_stay_the_same_are_a_pause_and_other_ones_its_end() {
        let mut source = Source::default();
        let car = |t: f64| {
            let mut sample = Sample { time: Some(t), ..Sample::default() };
            (sample.motion.0[0], sample.motion.0[9]) = (t.sin(), 20.0);
            Some(sample)
        };
        assert_eq!(events(&mut source, 0.0, 1.0, car), [Event::Resume]);
        let stands = |t: f64| Some(Sample { time: Some(t), ..car(1.0)? });
        assert_eq!(events(&mut source, 1.0, 1.5, stands), []);
        assert_eq!(events(&mut source, 1.5, 9.0, stands), [Event::Pause]);
        assert_eq!(source.health(), Health::Paused);
        assert_eq!(events(&mut source, 9.0, 10.0, car), [Event::Resume]);
        // Inside the program a recording waits with its first sample.
        let mut source = Source::new(true);
        assert_eq!(events(&mut source, 0.0, 9.0, stands), [Event::Resume]);
    }

    /// Random 32-bit floats in each field: plausible ones follow each other now and then.
    #[test]
    fn random_numbers_are_no_running_vehicle() {
        for has_clock in [true, false] {
            let mut source = Source::default();
            let mut state = 7_u32;
            let mut next = move || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(f32::from_bits(state ^ state >> 16))
            };
            let found = (0..60_000).filter(|k| {
                let mut sample = Sample { time: Some(next()).filter(|_| has_clock), ..Sample::default() };
                sample.motion.0.iter_mut().for_each(|value| *value = next());
                source.receive(0.01 * f64::from(*k), &sample).events[0] == Some(Event::Resume)
            });
            assert_eq!(found.count(), 0);
        }
    }

    #[test]
    fn a_sample_that_is_dropped_has_a_reason() {
        let mut source = Source::default();
        events(&mut source, 0.0, 1.0, |t| Some(at(t)));
        let mut sample = at(2.0);
        sample.motion.0[2] = 980.665;
        source.receive(2.0, &sample);
        let reason = source.dropped().unwrap().to_string();
        assert_eq!(reason, "az is 981, more than 98 in the washout's unit: check its unit in the table");
        source.receive(2.0, &at(0.9));
        let reason = source.dropped().unwrap().to_string();
        assert!(reason.starts_with("the packets' clock does not advance: repeated time 0.900 s"), "{reason}");
        assert_eq!(source.counts().dropped(), 2);
    }

    #[test]
    fn a_jump_of_the_place_is_a_teleport_and_a_fast_ride_is_none() {
        let mut source = Source::default();
        let fast = |t: f64| {
            let mut sample = at(t);
            sample.position = Some(Vector3::new(90.0 * t, 0.0, if t < 1.0 { 0.0 } else { 300.0 }));
            sample.motion.0[9] = 90.0;
            Some(sample)
        };
        assert_eq!(events(&mut source, 0.0, 2.0, fast), [Event::Resume, Event::Teleport]);
        assert_eq!(source.counts().teleports, 1);
    }
}
