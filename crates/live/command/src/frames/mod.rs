//! Frames on their way to the device.

mod device;
mod sender;
mod sink;

use std::io::ErrorKind;
use std::thread::Thread;
use std::time::Duration;

use moris_live::frame::{Message, Values};
use moris_live::motion::turns;
use moris_live::{Commands, STEP, State};
use rtrb::Producer;

use super::loop_clock;
pub use device::Device;
pub use sender::{Sender, Sent};
pub use sink::{Sink, shown};

/// A message on its way with its values, and the arrival of the sample that it is the first to
/// follow.
#[derive(Clone, Copy, Debug)]
pub struct Sending {
    pub message: Message,
    pub values: Values,
    pub arrival: Option<Duration>,
    /// Time of [`loop_clock::now`] at which the loop passed it on.
    pub made: Duration,
}

/// Reason for which the controller does not follow any more.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Loss {
    /// The receiver refuses frames, or the line is gone.
    #[error("CONTROLLER LOST: it takes no frames: {0}. Repair it, then clear")]
    Refused(ErrorKind),
    /// No frame has left for this time \[s\], its own time-out or longer.
    #[error("CONTROLLER LOST: no frame has left for {0:.2} s, its time-out. Clear it")]
    Gap(f64),
    /// The same for so long that it may have gone anywhere, whatever its time-out.
    #[error("CONTROLLER LOST: no frame has left for {0:.0} s. Look where the legs are, then clear")]
    LongGap(f64),
    /// The device answers with a fault, or no more.
    #[error("CONTROLLER LOST: it reports a fault, or does not answer. Repair it, then clear")]
    Device,
}

/// The interval between frames in whole steps \[s\]: a frame follows a step.
pub fn whole_steps(interval: f64) -> f64 {
    (interval / STEP).round().max(1.0) * STEP
}

/// The loop's end of the way.
pub struct Frames {
    ring: Producer<Sending>,
    sender: Thread,
    /// Steps from frame to frame.
    every: u64,
    step: u64,
    before: State,
    /// Arrival of the newest sample that no frame has followed.
    pub newest: Option<Duration>,
    /// Frames for which there was no room.
    pub lost: u64,
    /// A message that is no frame, and had no room: it goes first.
    owed: Option<Sending>,
    /// The session ends: no start string any more.
    pub ends: bool,
    /// The actuators are where the next start begins, as the operator or the controller has said.
    pub is_placed: bool,
    /// Time by which poses are ahead of now \[s\], and the poses before.
    ahead: Option<Ahead>,
}

impl Frames {
    /// Frames at this interval \[s\], for the thread that sends them.
    pub fn new(ring: Producer<Sending>, sender: Thread, interval: f64, ahead: f64) -> Self {
        let every = (whole_steps(interval) / STEP).round() as u64;
        Frames {
            ring,
            sender,
            every,
            step: 0,
            before: State::Off,
            newest: None,
            lost: 0,
            owed: None,
            ends: false,
            is_placed: false,
            ahead: Ahead::by(ahead),
        }
    }

    /// Passes on what follows from a step's commands.
    pub fn take(&mut self, commands: &Commands) {
        let mut values = Values::from(commands);
        if let Some(ahead) = &mut self.ahead {
            ahead.apply(&mut values);
        }
        let before = std::mem::replace(&mut self.before, commands.state);
        self.step += 1;
        if let Some(owed) = self.owed.take() {
            self.push_sending(owed);
        }
        match (before, commands.state) {
            (State::Off, State::Off) => return,
            (_, State::Off) => self.push(Message::Stop, values),
            (State::Off, _) => self.push_start(values),
            // A fault that is cleared at neutral leaves no time for homing.
            (State::Settled | State::Fault, State::Homing | State::Neutral) if !self.ends => {
                self.push_start(values);
            }
            (State::Parking, State::Settled) => {
                self.push(Message::Frame, values);
                self.push(Message::Park, values);
            }
            _ if self.step.is_multiple_of(self.every) => self.push(Message::Frame, values),
            _ => return,
        }
        self.sender.unpark();
    }

    fn push_start(&mut self, values: Values) {
        let message = if std::mem::take(&mut self.is_placed) { Message::Begin } else { Message::Start };
        self.push(message, values);
    }

    fn push(&mut self, message: Message, values: Values) {
        let sending = Sending { message, values, arrival: self.newest.take(), made: loop_clock::now() };
        self.push_sending(sending);
    }

    /// A frame without room is lost; another message waits for it, or gives way to the next one.
    fn push_sending(&mut self, sending: Sending) {
        let is_frame = sending.message == Message::Frame;
        if is_frame && self.owed.is_some() {
            self.lost += 1;
        } else if self.ring.push(sending).is_err() {
            self.lost += u64::from(is_frame);
            self.owed = (!is_frame).then_some(sending);
        }
    }
}

/// Poses ahead of now, for a display that shows them later.
///
/// Values that continue with their velocity and acceleration, from differences over
/// [`Ahead::STEPS`] steps.
#[derive(Clone, Debug)]
struct Ahead {
    time: f64,
    /// Numbers of the pose of the last steps, the latest first.
    before: [Option<[f64; 10]>; 2 * Ahead::STEPS],
}

impl Ahead {
    const STEPS: usize = 5;

    /// Poses ahead by this time \[s\]; none at 0.
    fn by(time: f64) -> Option<Self> {
        (time > 0.0).then_some(Ahead { time, before: [None; 2 * Self::STEPS] })
    }

    fn apply(&mut self, values: &mut Values) {
        let mut numbers = values.pose.iter().chain(&values.own).chain([&values.heave]).copied();
        let now: [f64; 10] = std::array::from_fn(|_| numbers.next().unwrap_or_default());
        drop(numbers);
        let far = self.before[2 * Self::STEPS - 1];
        let near = self.before[Self::STEPS - 1];
        self.before.rotate_right(1);
        self.before[0] = Some(now);
        let (Some(near), Some(far)) = (near, far) else { return };
        let span = Self::STEPS as f64 * STEP;
        let Values { pose, own, heave, .. } = values;
        for (k, place) in pose.iter_mut().chain(own).chain([heave]).enumerate() {
            let change =
                |from: f64, to: f64| if (3..6).contains(&k) { to - from - turns(to - from) } else { to - from };
            let [earlier, later] = [change(far[k], near[k]), change(near[k], now[k])].map(|change| change / span);
            let acceleration = (later - earlier) / span;
            let speed = later + 0.5 * span * acceleration;
            *place += self.time * speed + 0.5 * self.time * self.time * acceleration;
        }
    }
}

#[cfg(test)]
mod tests {
    use moris_live::{Event, Session, Settings};
    use moris_washout::Parameters;
    use rtrb::RingBuffer;

    use super::*;

    /// The sending thread stands still while frames pile up, and the operator stops.
    #[test]
    fn a_stop_without_room_leaves_as_soon_as_there_is_room() {
        let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
        let (ring, mut sent) = RingBuffer::new(8);
        let mut frames = Frames::new(ring, std::thread::current(), 0.001, 0.0);
        session.handle(Event::Start).unwrap();
        (0..20).for_each(|_| frames.take(session.step()));
        session.handle(Event::Stop).unwrap();
        (0..5).for_each(|_| frames.take(session.step()));
        let mut messages = |frames: &mut Frames, session: &mut Session| {
            let all: Vec<Message> = std::iter::from_fn(|| sent.pop().ok()).map(|sending| sending.message).collect();
            frames.take(session.step());
            all
        };
        let piled = messages(&mut frames, &mut session);
        assert_eq!((piled[0], piled[7]), (Message::Start, Message::Frame));
        assert_eq!(messages(&mut frames, &mut session), [Message::Stop]);
        assert_eq!(frames.lost, 12);
    }

    #[test]
    fn a_pose_ahead_is_that_of_the_time_to_come() {
        // An oscillation of 2 Hz, 50 ms ahead: within a tenth of what it is off without.
        let (time, rate) = (0.05, 2.0 * std::f64::consts::TAU);
        let mut ahead = Ahead::by(time).unwrap();
        let (mut with, mut without) = (0.0_f64, 0.0_f64);
        for k in 0..2000 {
            let now = f64::from(k) * STEP;
            let mut values = Values { pose: [0.1 * (rate * now).sin(); 6], ..Values::default() };
            let expected = 0.1 * (rate * (now + time)).sin();
            without = without.max((values.pose[0] - expected).abs());
            ahead.apply(&mut values);
            if k > 10 {
                with = with.max((values.pose[0] - expected).abs());
            }
        }
        assert!(with < 0.1 * without, "{with} {without}");
        assert!(Ahead::by(0.0).is_none());
    }
}
