//! Emulator of a vehicle's telemetry: a smooth ride, and what games do to it.

use moris_live::log::{Entry, Happening, slot_of};
use moris_live::{Event, Motion, STEP, Sample, Session};
use moris_washout::interface::RollPitchYaw;
use nalgebra::Vector3;

/// An event of the ride.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RideEvent {
    /// The operator's.
    Person(Event),
    /// The operator chooses the scale of the surge.
    Scale(f64),
    /// Samples of the running vehicle.
    Run,
    /// Samples of the paused vehicle: all zero.
    Pause,
    /// No samples.
    Silence,
    /// The vehicle goes on elsewhere, in another motion.
    Teleport,
    /// Samples that are not numbers.
    NotANumber,
    /// The same sample again and again.
    Repeat,
}

#[derive(Clone, Debug)]
pub struct Ride {
    kind: RideEvent,
    /// Time by which the ride is ahead of the session \[s\].
    ahead: f64,
    place: f64,
    next: f64,
    /// Samples a second, and most intervals from one to the next: a game leaves some out.
    pub rate: f64,
    pub most: u64,
    /// True if the packets have a clock.
    pub has_clock: bool,
    random: u64,
    /// The clock of the last sample that is not repeated \[s\].
    stopped: f64,
    /// The recorded session.
    pub log: Option<String>,
}

impl Default for Ride {
    fn default() -> Self {
        Ride {
            kind: RideEvent::Run,
            ahead: 0.0,
            place: 0.0,
            next: 0.0,
            rate: 60.0,
            most: 1,
            has_clock: true,
            random: 1,
            stopped: 0.0,
            log: None,
        }
    }
}

impl Ride {
    /// The motion at a time: surge and sway up to 2.3 m/s2, smooth to 0.4 Hz, with the speed that
    /// belongs to it.
    pub fn motion(t: f64) -> Motion {
        let surge = 1.5 * (0.9 * t).sin() + 0.8 * (2.3 * t).sin();
        let speed = 20.0 - 1.5 / 0.9 * (0.9 * t).cos() - 0.8 / 2.3 * (2.3 * t).cos();
        let yaw_rate = 0.04 * (1.3 * t).sin();
        let force = Vector3::new(surge, speed * yaw_rate, 9.80665 + 0.3 * (2.0 * t).sin());
        let rates = Vector3::new(0.02 * (1.1 * t).cos(), 0.03 * (0.8 * t).cos(), yaw_rate);
        let angles = RollPitchYaw::new(
            0.02 / 1.1 * (1.1 * t).sin(),
            0.03 / 0.8 * (0.8 * t).sin(),
            -0.04 / 1.3 * (1.3 * t).cos(),
        );
        Motion::new(force, rates, angles, speed)
    }

    pub fn apply(&mut self, event: RideEvent, session: &mut Session) {
        match event {
            RideEvent::Person(event) => {
                self.record(session, Happening::Event(event));
                let _ = session.handle(event);
            }
            RideEvent::Scale(value) => {
                self.retune(session, &[(slot_of("scale.specificForce.x").unwrap(), value)]);
            }
            RideEvent::Teleport => {
                self.ahead += 7.3;
                self.place += 500.0;
            }
            kind => self.kind = kind,
        }
    }

    fn retune(&mut self, session: &mut Session, values: &[(usize, f64)]) {
        for (slot, value) in values {
            self.record(session, Happening::Choice(*slot as u16, *value));
            session.choose(*slot, *value);
        }
        self.record(session, Happening::Retune);
        session.retune().unwrap();
    }

    /// Sends a sample if its time has come.
    pub fn send(&mut self, session: &mut Session) {
        let now = session.time();
        if now < self.next || self.kind == RideEvent::Silence {
            return;
        }
        // Knuth's generator: its high bits are random enough.
        self.random = self.random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let intervals = 1 + (self.random >> 33) % self.most;
        self.next = now.max(self.next + intervals as f64 / self.rate - STEP);
        let time = now + self.ahead;
        let position = Some(Vector3::new(20.0 * time, 0.0, self.place));
        let mut sample = Sample {
            time: self.has_clock.then_some(now),
            motion: Self::motion(time),
            position,
            paused: false,
            has_angles: true,
        };
        if self.kind != RideEvent::Repeat {
            self.stopped = now;
        }
        match self.kind {
            RideEvent::Pause => {
                sample.paused = true;
                sample.motion.0.fill(0.0);
            }
            RideEvent::NotANumber => sample.motion.0[(now * 1e3) as usize % 10] = f64::NAN,
            RideEvent::Repeat => sample.time = sample.time.and(Some(self.stopped)),
            _ => (),
        }
        self.record(session, Happening::Sample(now, sample));
        session.receive(now, &sample);
    }

    fn record(&mut self, session: &Session, happening: Happening) {
        if let Some(log) = &mut self.log {
            let step = (session.time() / STEP).round() as u64;
            log.push_str(&format!("{}\n", Entry { step, happening }));
        }
    }
}
