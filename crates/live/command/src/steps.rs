//! The loop: a step a millisecond. A step allocates nothing, and waits for nobody.

use std::fmt::{self, Display, Formatter};
use std::sync::atomic::Ordering;
use std::time::Duration;

use moris_live::log::{Digest, Entry, Happening};
use moris_live::{Event, Legs, Refusal, STEP, Session, State};
use moris_washout::Parameters;
use rtrb::{Consumer, Producer};

use super::Shared;
use super::event_log::Note;
use super::frames::{Frames, Loss};
use super::lateness::Lateness;
use super::leg_position::LegPosition;
use super::loop_clock;
use super::page::{Order, SNAPSHOT_INTERVAL_STEPS, Snapshot};
use super::signals::Interrupts;
use super::telemetry::Received;
use super::telemetry_watch::TelemetryWatch;
use super::thread_monitor::Part;

/// The loop of a live session.
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
    pub place: LegPosition,
    /// Threads whose failure is known.
    pub known: [bool; Part::ALL.len()],
    pub frames: Frames,
    pub journal: Producer<(f64, Note)>,
    /// For the page; what it does not take is dropped.
    pub shown: Option<Producer<Snapshot>>,
    /// For the page: the parameters in force, where what it has asked for was refused.
    pub refused: Producer<Parameters>,
    /// Starts by itself, once.
    pub starts: bool,
    /// True for a session that engages by itself.
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
    let zero = loop_clock::now();
    for step in 1..=steps {
        let deadline = zero + Duration::from_secs_f64(step as f64 * STEP);
        loop_clock::wait_until(deadline);
        lateness.take(loop_clock::now().saturating_sub(deadline));
    }
    lateness
}

impl Steps<'_> {
    /// Steps until the operator, the time or the end of a recording ends it.
    pub fn run(&mut self) -> Summary {
        // Lateness from which on steps are not made up for: their motion would come at once [s].
        const MAX_CATCH_UP_LATENESS: f64 = 0.02;
        // Steps between looks at the telemetry's signs, sizes, losses and delay.
        const TELEMETRY_CHECK_STEPS: u64 = 1000;
        let mut summary = Summary::default();
        let mut digest = Digest::default();
        let mut state = self.session.state();
        let mut health = self.session.source().health();
        // The time of the clock at the session's time 0.
        let mut zero = loop_clock::now();
        let mut ending = false;
        let mut watch = TelemetryWatch::default();
        loop {
            let deadline = zero + Duration::from_secs_f64((summary.steps + 1) as f64 * STEP);
            loop_clock::wait_until(deadline);
            let late = loop_clock::now().saturating_sub(deadline);
            summary.lateness.take(late);
            if late.as_secs_f64() > MAX_CATCH_UP_LATENESS {
                zero += late;
                summary.slips += 1;
                self.record(Happening::Slip(late.as_secs_f64()), &mut summary);
                self.session.slip(late.as_secs_f64());
                self.note(Note::Slipped(late.as_secs_f64()), &mut summary);
            }
            while let Ok(Received { arrival, sample }) = self.received.pop() {
                // Samples of a source inside come before their time.
                self.frames.newest = Some(arrival.min(loop_clock::now()));
                let arrival = arrival.as_secs_f64() - zero.as_secs_f64();
                self.record(Happening::Sample(arrival, sample), &mut summary);
                self.session.receive(arrival, &sample);
            }
            for source in 0..self.orders.len() {
                while let Ok(order) = self.orders[source].pop() {
                    self.obey(order, &mut summary);
                }
            }
            self.interrupts.look(loop_clock::now());
            ending |= self.fails(&mut summary)
                || self.ends_at.is_some_and(|end| self.session.time() >= end)
                || self.shared.played.load(Ordering::Relaxed)
                || self.interrupts.ends();
            self.frames.ends = ending;
            if ending {
                self.end(&mut summary);
            } else if self.engages {
                self.start(&mut summary);
                self.engage(&mut summary);
            }
            // The last word of a session that ends is no question.
            let is_open = !ending && (!self.session.is_located() || self.session.state() == State::Off);
            self.shared.asks.store(is_open && self.place.wants_report(), Ordering::Relaxed);
            let commands = *self.session.step();
            summary.steps += 1;
            digest.take(&commands);
            self.frames.take(&commands);
            self.shared.state.store(commands.state as u8, Ordering::Relaxed);
            // The reason before what follows from it.
            if self.session.source().health() != health {
                health = self.session.source().health();
                let cause = self.session.source().pause_cause();
                self.note(Note::Source(health, cause), &mut summary);
            }
            if summary.steps.is_multiple_of(TELEMETRY_CHECK_STEPS) || commands.state != state {
                let Steps { session, journal, .. } = &mut *self;
                watch.check(session, |note| {
                    summary.lost_notes += u64::from(journal.push((commands.time, note)).is_err())
                });
            }
            if commands.state != state {
                state = commands.state;
                if state == State::Parking {
                    // Its one allocation, of a list of numbers.
                    let _ = self.parking.push(self.session.without_road());
                }
                self.note(Note::State(state), &mut summary);
            }
            if let Some(shown) = &mut self.shown
                && summary.steps.is_multiple_of(SNAPSHOT_INTERVAL_STEPS)
            {
                let _ = shown.push(Snapshot::of(self.session, &summary.lateness, self.is_lost));
            }
            if ending && state == State::Off {
                self.record(Happening::End(digest.0), &mut summary);
                summary.lost_frames = self.frames.lost;
                return summary;
            }
        }
    }

    /// Starts by itself, once the controller may have reported the legs' place.
    fn start(&mut self, summary: &mut Summary) {
        let is_ready = self.session.is_located() || self.place.is_ready(self.session.time());
        if self.starts && is_ready {
            self.starts = false;
            self.ask(Event::Start, summary);
        }
    }

    /// Engages if the vehicle runs.
    fn engage(&mut self, summary: &mut Summary) {
        if self.session.state() == State::Neutral && self.session.telemetry_refusal().is_none() {
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
                self.note(Note::Failed(part), summary);
                self.ask(Event::Fault, summary);
            }
        }
        self.known.contains(&true)
    }

    fn obey(&mut self, order: Order, summary: &mut Summary) {
        match order {
            Order::Event(event) => {
                self.engages &= matches!(event, Event::Engage | Event::Start);
                self.starts &= event == Event::Engage;
                let is_obeyed = self.ask(event, summary);
                self.is_lost &= !(is_obeyed && matches!(event, Event::Clear | Event::Start));
            }
            Order::Lost(loss) => {
                // The legs may be anywhere after another one.
                self.is_lost = !matches!(loss, Loss::Gap(_));
                summary.loss = Some(loss);
                self.note(Note::Lost(loss), summary);
                self.place.forget();
                // After a gap the frames go on from the last one.
                self.ask(if self.is_lost { Event::Lost } else { Event::Fault }, summary);
            }
            Order::Report(lengths) => self.place.report(self.session.time(), lengths),
            Order::Legs(legs) => self.give(legs, summary),
            Order::Choose(slot, value) => {
                self.record(Happening::Choice(slot, value), summary);
                self.session.choose(usize::from(slot), value);
            }
            Order::Retune => {
                self.record(Happening::Retune, summary);
                let is_in_force = self.session.retune().is_ok();
                if !is_in_force {
                    // A page that does not take it has others to take before.
                    let _ = self.refused.push(self.session.target_parameters());
                }
                self.note(Note::Retuned(is_in_force), summary);
            }
        }
    }

    /// Takes the place of the legs that the operator gives for the next start. While they follow
    /// commands it is none: it would be believed later, when they are somewhere else.
    fn give(&mut self, legs: Legs, summary: &mut Summary) {
        let state = self.session.state();
        if self.session.is_located() && state != State::Off {
            self.note(Note::Refused(Refusal::Commanded(state)), summary);
            return;
        }
        let now = self.session.time();
        let away = self.session.way_from_settled(&self.session.commands().length);
        if !self.place.give(legs, now, away) {
            self.note(Note::Doubted(away), summary);
        }
    }

    /// Asks for an event. True if it has an effect.
    fn ask(&mut self, event: Event, summary: &mut Summary) -> bool {
        let state = self.session.state();
        let moves = matches!(event, Event::Start | Event::Clear) && state.after(event) != state;
        // The operator or the controller may say that they are elsewhere than the last frame has left them.
        let is_given_anew = state == State::Off && self.place.is_known_anew(self.session.time());
        if moves && (is_given_anew || !self.session.is_located()) {
            self.locate(summary);
        }
        self.record(Happening::Event(event), summary);
        let refused = self.session.handle(event).err();
        refused.map(|refusal| self.note(Note::Refused(refusal), summary)).is_none()
    }

    /// Gives the session the legs' place, if it is known.
    fn locate(&mut self, summary: &mut Summary) {
        let now = self.session.time();
        let legs = self.place.take(now);
        if legs == Legs::Unknown && !self.session.is_located() {
            return;
        }
        self.record(Happening::Legs(legs), summary);
        let stroke = self.session.washout().parameters().rig.stroke_length();
        let hold = stroke / self.place.slow_speed();
        let located = self.session.locate(legs);
        let is_known = matches!(legs, Legs::Settled | Legs::Reported(_));
        self.frames.is_placed = located.is_ok() && is_known && !self.place.starts_settled();
        if located.is_err() {
            // Where the last frame has left them is no place for a start, if the controller denies it.
            self.record(Happening::Legs(Legs::Unknown), summary);
            let _ = self.session.locate(Legs::Unknown);
        }
        let note = match located {
            Ok(()) => Note::Located(legs, hold),
            Err(refusal) => Note::Refused(refusal),
        };
        self.note(note, summary);
    }

    fn record(&mut self, happening: Happening, summary: &mut Summary) {
        self.note(Note::Entry(Entry { step: summary.steps, happening }), summary);
    }

    fn note(&mut self, note: Note, summary: &mut Summary) {
        summary.lost_notes += u64::from(self.journal.push((self.session.time(), note)).is_err());
    }
}

#[cfg(test)]
mod tests {
    use moris_live::frame::{Encoder, Message, SHIPPED_FRAMES};
    use moris_live::log::{header, replay};
    use moris_live::{Motion, Sample, Settings, shipped};
    use moris_washout::Rig;
    use rtrb::RingBuffer;

    use super::*;
    use crate::actuator_limits::{Actuators, FrameLimiter};
    use crate::frames::Sending;

    /// The loop's parts on a computed clock, and what it has noted.
    struct Computed<'a> {
        steps: Steps<'a>,
        summary: Summary,
        notes: Consumer<(f64, Note)>,
        sent: Consumer<Sending>,
        limiter: FrameLimiter,
        digest: Digest,
        text: String,
        said: Vec<String>,
    }

    fn place(frames: &str, settled: bool) -> LegPosition {
        let template = shipped(SHIPPED_FRAMES, frames).unwrap().parse().unwrap();
        LegPosition::of(&template, &Encoder::new(&template, &Rig::default()).unwrap(), settled, None)
    }

    fn with_place<T>(place: LegPosition, test: impl FnOnce(&mut Computed) -> T) -> T {
        let settings =
            Settings { starts_settled: place.starts_settled(), slow_speed: place.slow_speed(), ..Settings::default() };
        let mut session = Session::new(&Parameters::default(), &settings).unwrap();
        let shared = Shared::default();
        let (journal, notes) = RingBuffer::new(100_000);
        let (to_device, sent) = RingBuffer::new(16);
        let steps = Steps {
            session: &mut session,
            shared: &shared,
            received: RingBuffer::new(1).1,
            orders: std::array::from_fn(|_| RingBuffer::new(1).1),
            interrupts: Interrupts::default(),
            parking: RingBuffer::new(1).0,
            is_lost: false,
            place,
            known: [false; Part::ALL.len()],
            frames: Frames::new(to_device, std::thread::current(), 0.01, 0.0),
            journal,
            shown: None,
            refused: RingBuffer::new(1).0,
            starts: false,
            engages: false,
            ends_at: None,
        };
        let text = header(&Parameters::default(), &settings, None);
        let (summary, digest) = (Summary::default(), Digest::default());
        let limiter = FrameLimiter::new(0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] });
        test(&mut Computed { steps, summary, notes, sent, limiter, digest, text, said: Vec::new() })
    }

    impl Computed<'_> {
        fn obey(&mut self, order: Order) {
            self.steps.obey(order, &mut self.summary);
            while let Ok((_, note)) = self.notes.pop() {
                match note {
                    Note::Entry(entry) => self.text += &format!("{entry}\n"),
                    Note::Located(legs, _) => self.said.push(legs.name().to_owned()),
                    Note::Refused(refusal) => self.said.push(refusal.to_string()),
                    Note::Doubted(..) => self.said.push("doubted".to_owned()),
                    _ => (),
                }
            }
        }

        /// The controller reports these lengths for long enough.
        fn report_at_rest(&mut self, lengths: [f64; 6]) {
            self.obey(Order::Report(lengths));
            (0..300).for_each(|_| _ = self.step());
            self.obey(Order::Report(lengths));
        }

        fn ask(&mut self, event: Event) {
            self.obey(Order::Event(event));
        }

        fn state(&self) -> State {
            self.steps.session.state()
        }

        /// A step, with a vehicle that accelerates and brakes.
        fn step(&mut self) -> moris_live::Commands {
            let now = self.steps.session.time();
            if self.summary.steps.is_multiple_of(10) {
                let mut sample = Sample { motion: Motion::at_rest(), time: Some(now), ..Sample::default() };
                sample.motion.0[0] = 2.0 * (0.8 * now).sin();
                sample.motion.0[9] = 20.0 - 2.5 * (0.8 * now).cos();
                self.steps.record(Happening::Sample(now, sample), &mut self.summary);
                self.steps.session.receive(now, &sample);
            }
            let commands = *self.steps.session.step();
            self.summary.steps += 1;
            self.digest.take(&commands);
            commands
        }

        /// A step, and the lengths on the wire if a frame leaves with it.
        fn frame(&mut self) -> Option<[f64; 6]> {
            let commands = self.step();
            self.steps.frames.take(&commands);
            let mut left = None;
            while let Ok(Sending { message, values, .. }) = self.sent.pop() {
                if message == Message::Begin {
                    self.limiter.forget_last_frame();
                }
                left = Some(self.limiter.pass(Duration::from_millis(self.summary.steps), &values).length);
            }
            left
        }

        fn until(&mut self, state: State) {
            let begin = self.steps.session.time();
            while self.state() != state {
                self.step();
                assert!(self.steps.session.time() - begin < 40.0, "{:?}, not {state:?}", self.state());
            }
        }
    }

    #[test]
    fn a_start_after_a_restart_asks_where_the_legs_are() {
        with_place(place("amc-aasd15a", false), |live| {
            live.ask(Event::Start);
            assert!(
                live.state() == State::Off && live.said[0].contains("start needs the legs' place"),
                "{:?}",
                live.said
            );
            live.obey(Order::Legs(Legs::Settled));
            live.ask(Event::Start);
            assert_eq!((live.state(), live.said[1].as_str()), (State::Homing, "settled"));
            live.until(State::Neutral);
        });
        // A controller that is slow by itself: 0.6 m at 0.15 m/s.
        with_place(place("csv", false), |live| {
            live.ask(Event::Start);
            assert_eq!((live.state(), &live.said[..]), (State::Homing, &["slow".to_owned()][..]));
            for _ in 0..4_000 {
                assert!(live.step().length.iter().all(|length| (length - 1.012).abs() < 1e-9));
            }
            live.until(State::Neutral);
        });
    }

    #[test]
    fn a_report_of_the_controller_is_where_the_way_begins() {
        let reported = [1.35, 1.31, 1.42, 1.38, 1.29, 1.44];
        with_place(place("csv", false), |live| {
            (live.steps.starts, live.steps.engages) = (true, true);
            live.steps.start(&mut live.summary);
            // It waits for the answer.
            assert_eq!(live.state(), State::Off);
            live.report_at_rest(reported);
            live.steps.start(&mut live.summary);
            assert_eq!(live.state(), State::Homing);
            let first = live.step().length;
            assert!((0..6).all(|k| (first[k] - reported[k]).abs() < 1e-6), "{first:?}");
            live.until(State::Neutral);
        });
        with_place(place("csv", false), |live| {
            live.report_at_rest(reported.map(|length| 1000.0 * length));
            live.ask(Event::Start);
            assert_eq!(live.state(), State::Off);
            assert!(live.said[0].contains("check the report's unit"), "{:?}", live.said);
        });
        // Nobody answers.
        with_place(place("csv", false), |live| {
            (live.steps.starts, live.steps.engages) = (true, true);
            while live.state() == State::Off {
                live.steps.start(&mut live.summary);
                live.step();
            }
            assert!((live.steps.session.time() - 0.5).abs() < 2e-3, "{} s", live.steps.session.time());
        });
    }

    fn farthest(one: &[f64; 6], other: &[f64; 6]) -> f64 {
        (0..6).map(|k| (one[k] - other[k]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_controller_that_is_lost_comes_back_without_a_jump() {
        // It has stayed where it was, or has gone down by itself, as the operator has seen.
        for (frames, word) in [("csv", None), ("amc-aasd15a", Some(Legs::Slow)), ("amc-aasd15a", Some(Legs::Settled))] {
            with_place(place(frames, true), |live| {
                live.ask(Event::Start);
                live.until(State::Neutral);
                live.ask(Event::Engage);
                let mut last = [1.012; 6];
                for _ in 0..15_000 {
                    last = live.frame().unwrap_or(last);
                }
                assert_eq!(live.state(), State::Engaged);
                live.limiter.lose();
                live.obey(Order::Lost(Loss::Refused(std::io::ErrorKind::BrokenPipe)));
                assert!(live.state() == State::Fault && live.steps.is_lost && !live.steps.session.is_located());
                for _ in 0..3_000 {
                    let commands = live.step();
                    live.steps.frames.take(&commands);
                    // No frame arrives.
                    while live.sent.pop().is_ok() {}
                }
                if let Some(legs) = word {
                    live.ask(Event::Clear);
                    assert!(live.state() == State::Fault && live.steps.is_lost, "it does not know where the legs are");
                    live.obey(Order::Legs(legs));
                    if legs == Legs::Settled {
                        // The last frames have left them somewhere else: the operator looks again.
                        live.ask(Event::Clear);
                        assert!(live.state() == State::Fault && live.said.iter().any(|line| line == "doubted"));
                        live.obey(Order::Legs(legs));
                    }
                }
                live.ask(Event::Clear);
                assert!(live.state() == State::Homing && !live.steps.is_lost, "{:?}", live.said);
                if word == Some(Legs::Settled) {
                    last = [1.012; 6];
                }
                for k in 0..45_000 {
                    let Some(frame) = live.frame() else { continue };
                    // At most 0.25 m/s: the glide, and the way home.
                    let change = farthest(&frame, &last);
                    assert!(change <= 0.0025, "{frames}: {change} m in a frame, {k} ms after the clear");
                    last = frame;
                }
                assert_eq!(live.state(), State::Neutral);
                assert!(live.summary.loss.is_some());
                // The record has it all.
                live.steps.record(Happening::End(live.digest.0), &mut live.summary);
                live.ask(Event::Stop);
                let replayed = replay(&live.text, |_| ()).unwrap();
                assert_eq!(replayed.recorded, Some(replayed.digest));
            });
        }
    }

    #[test]
    fn a_start_after_a_stop_goes_on_from_the_last_frame() {
        with_place(place("amc-aasd15a", true), |live| {
            live.ask(Event::Start);
            let mut last = [1.012; 6];
            for _ in 0..1_500 {
                last = live.frame().unwrap_or(last);
            }
            live.ask(Event::Stop);
            for _ in 0..500 {
                live.frame();
            }
            live.ask(Event::Start);
            for _ in 0..5_000 {
                let Some(frame) = live.frame() else { continue };
                assert!(farthest(&frame, &last) <= 0.0025, "{frame:?} after {last:?}");
                last = frame;
            }
            assert_eq!(live.state(), State::Neutral);
        });
    }

    /// The operator says settled in the state off, after a stop high above.
    #[test]
    fn settled_is_believed_at_the_second_word_where_the_last_frame_says_otherwise() {
        with_place(place("amc-aasd15a", true), |live| {
            live.ask(Event::Start);
            live.until(State::Neutral);
            let last = live.step().length;
            live.ask(Event::Stop);
            (0..500).for_each(|_| _ = live.frame());
            live.obey(Order::Legs(Legs::Settled));
            assert_eq!(live.said.last().unwrap(), "doubted");
            live.ask(Event::Start);
            // It is not taken: the way begins where the last frame was.
            let first = live.step().length;
            assert!(farthest(&first, &last) < 1e-3, "{first:?} after {last:?}");
            live.ask(Event::Stop);
            (0..2).for_each(|_| live.obey(Order::Legs(Legs::Settled)));
            live.ask(Event::Start);
            assert!(farthest(&live.step().length, &[1.012; 6]) < 1e-3);
        });
        // The controller knows better.
        with_place(place("csv", true), |live| {
            live.ask(Event::Start);
            live.until(State::Neutral);
            let last = live.step().length;
            live.ask(Event::Stop);
            (0..2).for_each(|_| live.obey(Order::Legs(Legs::Settled)));
            live.report_at_rest(last);
            live.ask(Event::Start);
            assert!(farthest(&live.step().length, &last) < 1e-3);
        });
    }

    #[test]
    fn a_gap_as_long_as_the_time_out_is_a_fault_from_which_frames_go_on() {
        with_place(place("csv", true), |live| {
            live.ask(Event::Start);
            live.until(State::Neutral);
            live.obey(Order::Lost(Loss::Gap(0.2)));
            assert!(live.state() == State::Fault && live.steps.session.is_located() && !live.steps.is_lost);
            live.ask(Event::Engage);
            assert_eq!(live.state(), State::Fault);
            live.ask(Event::Clear);
            live.until(State::Neutral);
        });
    }

    #[test]
    fn a_base_that_goes_its_own_way_is_started_again_at_once() {
        with_place(LegPosition::own(), |live| {
            live.ask(Event::Start);
            live.until(State::Neutral);
            live.obey(Order::Lost(Loss::Device));
            assert!(live.state() == State::Fault && live.steps.is_lost);
            live.ask(Event::Clear);
            assert!(live.state() == State::Homing && !live.steps.is_lost);
        });
    }

    /// A fault from which the operator wants no more frames.
    #[test]
    fn stop_ends_a_fault_at_once() {
        with_place(place("csv", true), |live| {
            live.ask(Event::Start);
            live.until(State::Neutral);
            live.obey(Order::Lost(Loss::Gap(0.2)));
            assert_eq!(live.state(), State::Fault);
            live.ask(Event::Stop);
            assert_eq!((live.state(), live.said.len()), (State::Off, 1), "{:?}", live.said);
            // A session that ends, in a fault after which the legs' place is unknown, stops as well.
            live.obey(Order::Legs(Legs::Settled));
            live.obey(Order::Legs(Legs::Settled));
            live.ask(Event::Start);
            live.until(State::Neutral);
            live.obey(Order::Lost(Loss::Device));
            assert!(live.state() == State::Fault && !live.steps.session.is_located());
            live.steps.is_lost = false;
            live.steps.end(&mut live.summary);
            assert_eq!(live.state(), State::Off);
        });
    }

    /// The page has seen a settled platform, which is on its way up when its order comes.
    #[test]
    fn the_page_is_told_the_parameters_in_force_where_its_order_is_refused() {
        with_place(place("csv", true), |live| {
            let (refused, mut told) = RingBuffer::new(2);
            live.steps.refused = refused;
            let strategy = moris_live::log::slot_of("strategy").unwrap() as u16;
            let before = live.steps.session.washout().parameters().structure.strategy;
            live.ask(Event::Start);
            live.until(State::Neutral);
            live.obey(Order::Choose(strategy, 2.0));
            live.obey(Order::Retune);
            assert_eq!(told.pop().unwrap().structure.strategy, before);
            let scale = moris_live::log::slot_of("scale.specificForce.x").unwrap() as u16;
            live.obey(Order::Choose(scale, 0.5));
            live.obey(Order::Retune);
            assert!(told.pop().is_err());
        });
    }
}
