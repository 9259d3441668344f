//! The loop: a step a millisecond. It allocates nothing, and waits for nobody.

use std::fmt::{self, Display, Formatter};
use std::sync::atomic::Ordering;
use std::time::Duration;

use moris_live::log::{Digest, Entry, Happening};
use moris_live::signs::{Check, Verdict};
use moris_live::source::Health;
use moris_live::{Event, STEP, Session, State};
use rtrb::{Consumer, Producer};

use super::Shared;
use super::frames::{Frames, Loss};
use super::journal::Note;
use super::lateness::Lateness;
use super::pace;
use super::page::{EVERY, Order, Shown};
use super::signals::Interrupts;
use super::telemetry::Received;
use super::watch::Part;

/// Lateness from which on steps are not made up for: their motion would come at once \[s\].
const LATEST: f64 = 0.02;
/// Steps between looks at the signs.
const LOOK: u64 = 1000;

/// The loop.
pub struct Steps<'a> {
    pub session: &'a mut Session,
    pub shared: &'a Shared,
    pub received: Consumer<Received>,
    /// From standard input, from the page, its stop and park, and from the device.
    pub orders: [Consumer<Order>; 4],
    pub interrupts: Interrupts,
    /// Copies of the session that begins to park.
    pub parking: Producer<Session>,
    /// The controller does not follow any more.
    pub is_lost: bool,
    /// Threads whose failure is known.
    pub known: [bool; Part::ALL.len()],
    pub frames: Frames,
    pub journal: Producer<Note>,
    /// For the page; what it does not take is dropped.
    pub shown: Option<Producer<Shown>>,
    /// Engages by itself.
    pub engages: bool,
    /// Time after which it ends \[s\].
    pub ends_at: Option<f64>,
}

/// The counts of the loop.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    steps: u64,
    lateness: Lateness,
    slips: u64,
    lost_notes: u64,
    /// Frames for which the ring had no room.
    pub lost_frames: u64,
    /// The last reason for which the controller did not follow.
    pub loss: Option<Loss>,
}

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Summary { steps, lateness, slips, lost_notes, .. } = self;
        writeln!(f, "{steps} steps, {} late by more than one, {slips} slips of the clock", lateness.overruns())?;
        if *lost_notes > 0 {
            writeln!(f, "{lost_notes} lines of the journal lost")?;
        }
        write!(f, "{lateness}")
    }
}

/// Waits for so many steps, and does nothing in them.
pub fn empty(steps: u64) -> Lateness {
    let mut lateness = Lateness::default();
    let zero = pace::now();
    for step in 1..=steps {
        let deadline = zero + Duration::from_secs_f64(step as f64 * STEP);
        pace::wait_until(deadline);
        lateness.take(pace::now().saturating_sub(deadline));
    }
    lateness
}

impl Steps<'_> {
    /// Steps until a person, the time or the end of a recording ends it.
    pub fn run(&mut self) -> Summary {
        let mut summary = Summary::default();
        let mut digest = Digest::default();
        let mut state = self.session.state();
        let mut health = self.session.source().health();
        let mut signs = [Verdict::Unknown; Check::ALL.len()];
        // The time of the clock at the session's time 0.
        let mut zero = pace::now();
        let mut ending = false;
        if self.engages {
            self.ask(Event::Start, &mut summary);
        }
        loop {
            let deadline = zero + Duration::from_secs_f64((summary.steps + 1) as f64 * STEP);
            pace::wait_until(deadline);
            let late = pace::now().saturating_sub(deadline);
            summary.lateness.take(late);
            if late.as_secs_f64() > LATEST {
                zero += late;
                summary.slips += 1;
                self.record(Happening::Slip(late.as_secs_f64()), &mut summary);
                self.session.slip(late.as_secs_f64());
                self.note(Note::Slipped(self.session.time(), late.as_secs_f64()), &mut summary);
            }
            while let Ok(Received { arrival, sample }) = self.received.pop() {
                self.frames.newest = Some(arrival);
                let arrival = arrival.as_secs_f64() - zero.as_secs_f64();
                self.record(Happening::Sample(arrival, sample), &mut summary);
                self.session.receive(arrival, &sample);
            }
            for source in 0..self.orders.len() {
                while let Ok(order) = self.orders[source].pop() {
                    self.obey(order, &mut summary);
                }
            }
            self.interrupts.look(pace::now());
            ending |= self.fails(&mut summary)
                || self.ends_at.is_some_and(|end| self.session.time() >= end)
                || self.shared.played.load(Ordering::Relaxed)
                || self.interrupts.ends();
            self.frames.ends = ending;
            if ending {
                self.end(&mut summary);
            } else if self.engages {
                self.engage(&mut summary);
            }
            let commands = *self.session.step();
            summary.steps += 1;
            digest.take(&commands);
            self.frames.take(&commands);
            self.shared.state.store(commands.state as u8, Ordering::Relaxed);
            if commands.state != state {
                state = commands.state;
                if state == State::Parking {
                    // Its one allocation, of a list of numbers.
                    let _ = self.parking.push(self.session.clone());
                }
                self.note(Note::State(commands.time, state), &mut summary);
            }
            if self.session.source().health() != health {
                health = self.session.source().health();
                self.note(Note::Source(commands.time, health), &mut summary);
            }
            if summary.steps.is_multiple_of(LOOK) {
                self.look_at_signs(&mut signs, &mut summary);
            }
            if let Some(shown) = &mut self.shown
                && summary.steps.is_multiple_of(EVERY)
            {
                let _ = shown.push(Shown::of(self.session, &summary.lateness, self.is_lost));
            }
            if ending && state == State::Off {
                self.record(Happening::End(digest.0), &mut summary);
                summary.lost_frames = self.frames.lost;
                return summary;
            }
        }
    }

    /// Engages if the vehicle runs.
    fn engage(&mut self, summary: &mut Summary) {
        let session = &self.session;
        let ready = session.state() == State::Neutral && session.source().health() == Health::Running;
        if ready && session.signs().contradiction().is_none() {
            self.ask(Event::Engage, summary);
        }
    }

    /// The next command on the way to the end: down, then off; off at once after a second Ctrl-C.
    fn end(&mut self, summary: &mut Summary) {
        let event = match self.session.state() {
            State::Off => return,
            _ if self.interrupts.ends_at_once() => Event::Stop,
            // There is nobody who would follow to the lowest pose.
            _ if self.is_lost => Event::Stop,
            State::Settled => Event::Stop,
            // Where the legs are is unknown: frames would move them.
            State::Fault if !self.session.is_located() => Event::Stop,
            State::Fault => Event::Clear,
            State::Parking => return,
            _ => Event::Park,
        };
        self.ask(event, summary);
    }

    /// True once a thread has failed: a fault, and then the way down.
    fn fails(&mut self, summary: &mut Summary) -> bool {
        for part in Part::ALL {
            if self.shared.failed.has(part) && !std::mem::replace(&mut self.known[part as usize], true) {
                self.note(Note::Failed(self.session.time(), part), summary);
                self.ask(Event::Fault, summary);
            }
        }
        self.known.contains(&true)
    }

    fn obey(&mut self, order: Order, summary: &mut Summary) {
        match order {
            Order::Event(event) => {
                self.engages &= matches!(event, Event::Engage | Event::Start);
                self.is_lost &= !matches!(event, Event::Clear | Event::Start);
                self.ask(event, summary);
            }
            Order::Lost(loss) => {
                self.is_lost = !matches!(loss, Loss::Gap(_));
                summary.loss = Some(loss);
                self.note(Note::Lost(self.session.time(), loss), summary);
                self.ask(Event::Fault, summary);
            }
            Order::Choose(slot, value) => {
                self.record(Happening::Choice(slot, value), summary);
                self.session.choose(usize::from(slot), value);
            }
            Order::Retune => {
                self.record(Happening::Retune, summary);
                let is_in_force = self.session.retune().is_ok();
                self.note(Note::Retuned(self.session.time(), is_in_force), summary);
            }
        }
    }

    fn ask(&mut self, event: Event, summary: &mut Summary) {
        self.record(Happening::Event(event), summary);
        if let Err(refusal) = self.session.handle(event) {
            self.note(Note::Refused(self.session.time(), refusal), summary);
        }
    }

    fn look_at_signs(&mut self, known: &mut [Verdict; Check::ALL.len()], summary: &mut Summary) {
        for (check, known) in Check::ALL.into_iter().zip(known) {
            let verdict = self.session.signs().verdict(check);
            if verdict != *known && verdict != Verdict::Unknown {
                *known = verdict;
                self.note(Note::Sign(self.session.time(), check, verdict), summary);
            }
        }
    }

    fn record(&mut self, happening: Happening, summary: &mut Summary) {
        self.note(Note::Entry(Entry { step: summary.steps, happening }), summary);
    }

    fn note(&mut self, note: Note, summary: &mut Summary) {
        summary.lost_notes += u64::from(self.journal.push(note).is_err());
    }
}
