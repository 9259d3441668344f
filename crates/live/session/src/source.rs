//! Health of the telemetry: which samples count, and what their absence means.

use crate::attitude::angle_between;
use crate::clock::{Clock, Stamp};
use crate::motion::Sample;
use crate::spikes::{Judgement, Spikes};
use crate::transitions::Event;

/// Time without a good sample after which the source is silent \[s\].
pub const SILENT: f64 = 0.5;
/// Time without a good sample after which it is stale \[s\].
pub const STALE: f64 = 1.5;
/// A place that differs from the expected one by more than this is another place \[m\].
const JUMP: f64 = 10.0;
/// An attitude that turns by more within a sample than its rates say is that of another place
/// \[rad\].
const TURN: f64 = 0.7;

/// Health of the source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Health {
    /// There has been no sample yet.
    #[default]
    Waiting,
    /// Good samples of a running vehicle.
    Running,
    /// Good samples of a paused vehicle.
    Paused,
    /// No good sample for [`SILENT`].
    Silent,
    /// No good sample for [`STALE`].
    Stale,
}

impl Health {
    /// The health's name.
    pub fn name(self) -> &'static str {
        match self {
            Health::Waiting => "waiting",
            Health::Running => "running",
            Health::Paused => "paused",
            Health::Silent => "silent",
            Health::Stale => "stale",
        }
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
    /// Changes of the place.
    pub teleports: u64,
    /// Spikes that no vehicle causes: dropped, and counted among the bad ones.
    pub spikes: u64,
}

/// Effect of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accepted {
    /// Its time \[s\]; none if it is not to be used.
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
    clock: Clock,
    health: Health,
    counts: Counts,
    last_good: f64,
    last: Option<Sample>,
    /// Time of the last sample \[s\].
    stamp: f64,
    spikes: Spikes,
}

impl Source {
    /// Health of the telemetry now.
    pub fn health(&self) -> Health {
        self.health
    }

    /// The numbers of samples.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Judges a sample that arrived then.
    pub fn receive(&mut self, arrival: f64, sample: &Sample) -> Accepted {
        let mut accepted = Accepted { time: None, instead: false, confirmed: None, events: [None; 2], is_new: false };
        self.counts.received += 1;
        // In a menu a program's clock stands still, and its numbers may be anything.
        if sample.paused && arrival.is_finite() {
            self.last_good = arrival;
            let before = std::mem::replace(&mut self.health, Health::Paused);
            accepted.events[0] = (before != Health::Paused).then_some(Event::Pause);
            return accepted;
        }
        if !sample.is_plausible() || !arrival.is_finite() {
            self.counts.bad += 1;
            return accepted;
        }
        let (time, restarted) = match self.clock.stamp(arrival, sample.time) {
            Stamp::Repeated => {
                self.counts.repeated += 1;
                return accepted;
            }
            Stamp::Instead => {
                accepted.instead = true;
                (self.stamp, false)
            }
            Stamp::At(time) => (time, false),
            Stamp::Restarted(time) => (time, true),
        };
        let elsewhere = restarted || self.last.is_some_and(|last| is_elsewhere(&last, sample, time - self.stamp));
        let before = std::mem::replace(&mut self.health, Health::Running);
        (self.last_good, self.stamp, self.last) = (arrival, time, Some(*sample));
        accepted.is_new = elsewhere || before != Health::Running;
        if accepted.is_new {
            self.spikes.clear();
        }
        let (judgement, was_spike) = self.spikes.judge(time, sample);
        self.counts.spikes += u64::from(was_spike);
        self.counts.bad += u64::from(was_spike);
        if let Judgement::Used(confirmed) = judgement {
            accepted.confirmed = confirmed;
            accepted.time = Some(time);
        }
        if before != Health::Running {
            accepted.events[0] = Some(Event::Resume);
        }
        if elsewhere {
            self.counts.teleports += 1;
            accepted.events[1] = Some(Event::Teleport);
        }
        accepted
    }

    /// All times until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        self.clock.slip(time);
        self.spikes.slip(time);
        self.last_good -= time;
        self.stamp -= time;
    }

    /// The event that follows from silence until now.
    pub fn listen(&mut self, now: f64) -> Option<Event> {
        let silence = now - self.last_good;
        let (health, event) = match self.health {
            Health::Running | Health::Paused if silence >= SILENT => (Health::Silent, Event::Silence),
            Health::Silent if silence >= STALE => (Health::Stale, Event::Stale),
            _ => return None,
        };
        self.health = health;
        Some(event)
    }
}

/// True if the vehicle cannot have gone from one sample to the next in this time.
fn is_elsewhere(before: &Sample, after: &Sample, time: f64) -> bool {
    let speed = before.motion.speed().abs().max(after.motion.speed().abs());
    let moved = before.position.zip(after.position).map_or(0.0, |(before, after)| (after - before).norm());
    let rate = before.motion.rates().norm().max(after.motion.rates().norm());
    let turned = || angle_between(&before.motion.angles(), &after.motion.angles());
    moved > JUMP + 2.0 * speed * time || time < 0.1 && turned() > TURN + 2.0 * rate * time
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
