//! Lines about the telemetry while it comes: signs, sizes, samples that are dropped, and its delay.

use moris_live::Session;
use moris_live::session::TelemetryFault;
use moris_live::signs::{Check, Verdict};

use super::event_log::Note;

/// The lines that have been told.
#[derive(Clone, Copy, Debug, Default)]
pub struct TelemetryWatch {
    signs: [Verdict; Check::ALL.len()],
    /// Kind of the fault of the table.
    fault: Option<&'static str>,
    /// Samples, and dropped ones of them, at the last line, and its time \[s\].
    counts: [u64; 2],
    dropped_at: Option<f64>,
    /// Samples, and repeated ones of them, at the last look, and its time \[s\].
    looked: [u64; 2],
    looked_at: f64,
    is_repetition_reported: bool,
    delay: Option<f64>,
}

impl TelemetryWatch {
    /// Tells what is new.
    pub fn check(&mut self, session: &Session, mut note: impl FnMut(Note)) {
        // Growth of a delay with which it is told again.
        const DELAY_GROWTH: f64 = 1.5;
        let now = session.time();
        for (&check, known) in Check::ALL.iter().zip(&mut self.signs) {
            let verdict = session.signs().verdict(check);
            if verdict != *known && verdict != Verdict::Unknown {
                *known = verdict;
                note(Note::Sign(check, verdict));
            }
        }
        let fault = session.telemetry_fault();
        let fault = if let Some(TelemetryFault::Table(fault)) = fault { Some(fault) } else { None };
        let before = std::mem::replace(&mut self.fault, fault.map(|fault| fault.kind()));
        if let Some(fault) = fault.filter(|fault| before != Some(fault.kind())) {
            note(Note::Table(fault));
        }
        self.check_dropped(session, now, &mut note);
        self.check_repeated(session, now, &mut note);
        let delay = session.delay();
        if session.is_delay_long() && self.delay.is_none_or(|known| delay > DELAY_GROWTH * known) {
            self.delay = Some(delay);
            note(Note::Delayed(delay));
        }
    }

    fn check_dropped(&mut self, session: &Session, now: f64, note: &mut impl FnMut(Note)) {
        // Part of the samples from which on those that are dropped are told, and the least number
        // of them.
        const DROPPED_PART: f64 = 0.1;
        const LEAST_DROPPED: u64 = 5;
        // Time between lines about dropped samples [s].
        const DROPPED_SAMPLE_INTERVAL: f64 = 5.0;
        let counts = session.source().counts();
        let [received, dropped] = [counts.received - self.counts[0], counts.dropped() - self.counts[1]];
        if self.dropped_at.is_some_and(|at| now - at < DROPPED_SAMPLE_INTERVAL) {
            return;
        }
        if let Some(reason) = session.source().dropped()
            && dropped >= LEAST_DROPPED
            && dropped as f64 >= DROPPED_PART * received as f64
        {
            self.dropped_at = Some(now);
            note(Note::SamplesDropped([received, dropped], reason));
        }
        self.counts = [counts.received, counts.dropped()];
    }

    /// Tells once of samples that come several times, as of a source slower than its packets.
    fn check_repeated(&mut self, session: &Session, now: f64, note: &mut impl FnMut(Note)) {
        // Time between looks [s], the part of the samples that are the same, and the number of others
        // a second below which their steps are felt.
        const LOOK_INTERVAL: f64 = 5.0;
        const SAME_PART: f64 = 0.6;
        const FELT_SAMPLE_RATE: f64 = 20.0;
        let passed = now - self.looked_at;
        if passed < LOOK_INTERVAL {
            return;
        }
        let counts = session.source().counts();
        let [received, same] = [counts.received - self.looked[0], counts.same - self.looked[1]];
        (self.looked, self.looked_at) = ([counts.received, counts.same], now);
        let is_slow = ((received - same) as f64) < FELT_SAMPLE_RATE * passed;
        if is_slow && same as f64 > SAME_PART * received as f64 && !self.is_repetition_reported {
            self.is_repetition_reported = true;
            note(Note::SamplesRepeated([received, same]));
        }
    }
}

#[cfg(test)]
mod tests {
    use moris_live::{Sample, Settings};
    use moris_washout::Parameters;

    use super::*;

    /// Lines in so many seconds of a source at 100 Hz.
    fn told(seconds: u32, sample: impl Fn(f64) -> Sample) -> Vec<(f64, Note)> {
        let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
        let mut watch = TelemetryWatch::default();
        let mut notes = Vec::new();
        for step in 1..=1000 * seconds {
            if step % 10 == 0 {
                session.receive(session.time(), &sample(session.time()));
            }
            session.step();
            if step % 1000 == 0 {
                watch.check(&session, |note| notes.push((session.time(), note)));
            }
        }
        notes
    }

    fn moving(t: f64) -> Sample {
        let mut sample = Sample { time: Some(t), ..Sample::default() };
        sample.motion.0[0] = t.sin();
        sample
    }

    #[test]
    fn dropped_samples_are_told_while_they_happen() {
        let times = |notes: &[(f64, Note)]| {
            let time = |(time, note): &(f64, Note)| match note {
                Note::SamplesDropped([received, dropped], _) => Some((*time, *received, *dropped)),
                _ => None,
            };
            notes.iter().filter_map(time).collect::<Vec<_>>()
        };
        assert_eq!(times(&told(10, moving)), []);
        // A clock that stands, and forces in cm/s2: at once, then every 5 s.
        let stands = told(12, |t| Sample { time: Some(1.0), ..moving(t) });
        assert_eq!(times(&stands), [(1.0, 100, 99), (6.0, 500, 500), (11.0, 500, 500)]);
        let large = told(3, |t| {
            let mut sample = moving(t);
            sample.motion.0[2] *= 100.0;
            sample
        });
        assert_eq!(times(&large), [(1.0, 100, 100)]);
        // One in twenty is no line.
        let few = told(10, |t| {
            if ((100.0 * t).round() as u32).is_multiple_of(20) {
                Sample { time: Some(0.0), ..moving(t) }
            } else {
                moving(t)
            }
        });
        assert_eq!(times(&few), []);
    }

    #[test]
    fn samples_that_come_several_times_are_told_once() {
        // 10 and 50 different samples a second, of a vehicle that drives or stands.
        let repeated = |rate: f64, speed: f64| {
            let notes = told(16, |t| {
                let mut sample = moving((rate * t + 1e-6).floor() / rate);
                sample.motion.0[9] = speed;
                Sample { time: Some(t), ..sample }
            });
            notes.iter().filter(|(_, note)| matches!(note, Note::SamplesRepeated(..))).count()
        };
        assert_eq!([repeated(10.0, 9.0), repeated(50.0, 9.0), repeated(10.0, 0.0)], [1, 0, 0]);
    }

    #[test]
    fn a_mismatch_is_told_once() {
        let notes = told(20, |t| {
            let mut sample = moving(t);
            sample.motion.0[2] = 1.0 + 0.1 * (3.0 * t).sin();
            sample
        });
        let found: Vec<_> = notes.iter().filter(|(_, note)| matches!(note, Note::Table(_))).collect();
        assert!(matches!(found[..], [(time, _)] if *time <= 3.0), "{notes:?}");
    }

    #[test]
    fn a_delay_that_a_person_notices_is_told_once_and_again_when_it_has_grown() {
        let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
        let mut watch = TelemetryWatch::default();
        let mut told = Vec::new();
        for gap in [10_u64, 80, 80, 160, 160] {
            let mut count = 0;
            for k in 0..10_000 {
                let now = session.time();
                if k % gap == 0 {
                    session.receive(now, &Sample { time: Some(now), ..Sample::default() });
                }
                session.step();
                if k % 1000 == 999 {
                    watch.check(&session, |note| count += usize::from(matches!(note, Note::Delayed(..))));
                }
            }
            told.push(count);
        }
        assert_eq!(told, [0, 1, 0, 1, 0]);
    }
}
