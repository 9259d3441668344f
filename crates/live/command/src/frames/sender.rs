//! The thread that sends frames, and follows what the device answers.

use std::io::ErrorKind;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::time::Duration;

use moris_live::Event;
use moris_live::frame::{Message, Values};
use rtrb::{Consumer, Producer};

use super::super::actuator_limits::{Actuators, FrameLimiter};
use super::super::connection::Connection;
use super::super::lateness::Lateness;
use super::super::lines::Lines;
use super::super::page::Order;
use super::super::signals::Signals;
use super::super::thread_monitor::Part;
use super::super::{Shared, loop_clock};
use super::{Device, Loss, Sending, Sink};

/// Numbers of frames.
#[derive(Clone, Debug, Default)]
pub struct Sent {
    /// Frames that the socket took.
    pub sent: u64,
    /// Frames that the socket refused.
    pub failed: u64,
    /// Frames left out because a newer one was there.
    pub skipped: u64,
    /// Time from a sample's arrival to the next frame.
    pub passage: Lateness,
    /// Time from the loop's step to the frame's leaving.
    pub late: Lateness,
    /// Longest time between two frames.
    pub gap: Duration,
    /// Lengths of the last frame \[m\].
    pub last: Option<[f64; 6]>,
}

/// The thread that sends.
pub struct Sender<'a> {
    pub ring: Consumer<Sending>,
    pub device: Device,
    pub sink: Sink,
    /// Losses of the controller, for the loop.
    pub orders: Producer<Order>,
    pub limiter: FrameLimiter,
    pub connection: Connection,
    /// The controller's own time-out.
    pub time_out: Option<Duration>,
    /// Of the system: the loop has ended while frames go on to the lowest pose.
    pub signals: Signals,
    pub shared: &'a Shared,
    bytes: Vec<u8>,
    running: bool,
    last: Values,
    sent: Sent,
    /// Time of the last question for the legs' lengths.
    asked: Option<Duration>,
    /// Answers on a serial line.
    answers: Lines,
    /// A loss that is not reported yet.
    owed: Option<Loss>,
}

/// Answers of the device that are taken at a time: a flood of them delays no frame.
const MOST_ANSWERS: u32 = 64;

impl<'a> Sender<'a> {
    /// A sender of frames at this interval \[s\] to these actuators.
    pub fn new(
        ring: Consumer<Sending>,
        device: Device,
        sink: Sink,
        orders: Producer<Order>,
        (interval, actuators): (f64, Actuators),
        shared: &'a Shared,
    ) -> Self {
        Sender {
            ring,
            device,
            sink,
            orders,
            limiter: FrameLimiter::new(interval, actuators),
            connection: Connection::new(interval),
            time_out: None,
            signals: Signals::default(),
            shared,
            bytes: Vec::with_capacity(4096),
            running: false,
            last: Values::default(),
            sent: Sent::default(),
            asked: None,
            answers: Lines::default(),
            owed: None,
        }
    }

    /// Sends messages until the loop has ended. If the loop ends without a stop string, by a panic,
    /// sends it. An error of this program costs a message, and is a failure of the session.
    pub fn run(mut self) -> Sent {
        // Errors of this program after which the sending thread ends.
        const MOST_ERRORS: u32 = 10;
        for _ in 0..MOST_ERRORS {
            if catch_unwind(AssertUnwindSafe(|| self.work())).is_ok() {
                break;
            }
            self.shared.failed.add(Part::Frames);
        }
        self.sent
    }

    /// A device that is slower than the frames gets the newest ones.
    fn work(&mut self) {
        let mut packet = [0; 256];
        loop {
            // Seen before the ring is empty: what comes after it has been looked at.
            let ended = self.ring.is_abandoned();
            while let Ok(sending) = self.ring.pop() {
                let Sending { message, values, arrival, made } = sending;
                if message == Message::Frame && self.ring.peek().is_ok_and(|next| next.message == Message::Frame) {
                    self.sent.skipped += 1;
                    continue;
                }
                if message == Message::Park {
                    self.arrive(&values, &mut packet);
                }
                let fault = self.take(message, &values);
                let now = loop_clock::now();
                self.sent.late.take(now.saturating_sub(made));
                self.shared.show_late(now.saturating_sub(made));
                if let Some(arrival) = arrival {
                    self.sent.passage.take(now.saturating_sub(arrival));
                }
                self.listen(fault, &mut packet);
            }
            if let Some(loss) = self.owed {
                self.report(loss);
            }
            if ended {
                return self.end();
            }
            if self.shared.asks.load(Ordering::Relaxed) {
                self.ask(&mut packet);
            }
            std::thread::park_timeout(Duration::from_millis(20));
        }
    }

    /// Goes on with frames until the actuators are where these values have them. Frames that were
    /// late are behind the loop, and a controller that parks takes no more of them. Ends at once if
    /// a person stops, or presses Ctrl-C.
    fn arrive(&mut self, values: &Values, packet: &mut [u8]) {
        // Longest time to the lowest pose: the slowest way over the longest stroke.
        const LONGEST_ARRIVAL: Duration = Duration::from_secs(20);
        let mut values = *values;
        let interval = self.limiter.interval();
        let end = loop_clock::now() + LONGEST_ARRIVAL;
        let mut is_stopped = false;
        while !self.limiter.is_at(&self.device.followed(&values))
            && !self.connection.is_lost()
            && !self.signals.is_interrupted()
            && loop_clock::now() < end
        {
            std::thread::sleep(Duration::from_secs_f64(interval));
            // A loop that ends stops as well, and leaves the ring right after it: seen twice, a person has stopped.
            let stops = self.ring.peek().is_ok_and(|next| next.message == Message::Stop) && !self.ring.is_abandoned();
            if std::mem::replace(&mut is_stopped, stops) && stops {
                break;
            }
            values.time += interval;
            let fault = self.take(Message::Frame, &values);
            self.listen(fault, packet);
        }
    }

    /// Sends a message. A fault, if the device reports one.
    fn take(&mut self, message: Message, values: &Values) -> Option<Event> {
        // Time without frames after which a controller may have gone anywhere, whatever its time-out.
        const LONG_GAP: Duration = Duration::from_secs(2);
        self.running = message != Message::Stop;
        let now = loop_clock::now();
        if matches!(message, Message::Start | Message::Begin) {
            self.connection.renew();
            self.sink.reopen();
        }
        if message == Message::Begin {
            self.limiter.forget_last_frame();
        }
        if self.connection.is_lost() && message != Message::Stop {
            // What comes back without the operator who clears it would jump.
            return None;
        }
        let mut values = *values;
        if message == Message::Stop {
            // The legs stay where the last frame has them.
            values = if self.limiter.gap(now).is_some() { self.last } else { values };
        } else {
            if message == Message::Frame
                && let Some(gap) = self.limiter.gap(now)
            {
                self.sent.gap = self.sent.gap.max(gap);
                let seconds = gap.as_secs_f64();
                let loss = if gap >= LONG_GAP { Loss::LongGap(seconds) } else { Loss::Gap(seconds) };
                let is_long = gap >= LONG_GAP && !matches!(self.sink, Sink::Dry);
                if is_long || self.time_out.is_some_and(|time_out| gap >= time_out) {
                    self.limiter.lose();
                    self.report(loss);
                }
                if is_long {
                    self.connection.lose();
                    return None;
                }
            }
            let commanded = values.length;
            // Whatever changes values does so before their limits.
            values = self.limiter.pass(now, &self.device.followed(&values));
            self.last = values;
            // A base that goes its own way parks where the commands do.
            self.sent.last = Some(if self.device.answers() { commanded } else { values.length });
        }
        self.deliver(message, &values)
    }

    fn deliver(&mut self, message: Message, values: &Values) -> Option<Event> {
        let fault = self.device.bytes(message, values, &mut self.bytes);
        let mut taken = Ok(());
        // An answering base has no time-out that is known, and a packet may be lost.
        let copies = if self.device.answers() && message == Message::Stop { 3 } else { 1 };
        for _ in 0..copies {
            taken = taken.and(self.sink.send(&self.bytes));
        }
        self.sent.sent += u64::from(taken.is_ok() && !self.bytes.is_empty());
        self.sent.failed += u64::from(taken.is_err());
        // Nobody follows what is printed.
        if !matches!(self.sink, Sink::Dry)
            && let Some(kind) = self.connection.take(&taken, loop_clock::now())
        {
            self.limiter.lose();
            // A line that is only slow stays open: opening one resets many controllers.
            if kind != ErrorKind::TimedOut {
                self.sink.close();
            }
            self.report(Loss::Refused(kind));
        }
        fault
    }

    /// Asks for the legs' lengths now and then, and passes answers on.
    fn ask(&mut self, packet: &mut [u8]) {
        // Time between questions for the legs' lengths.
        const POSITION_REQUEST_INTERVAL: Duration = Duration::from_millis(200);
        let Device::Template(encoder, _) = &self.device else { return };
        if !encoder.asks() {
            return;
        }
        let now = loop_clock::now();
        if self.asked.is_none_or(|asked| now.saturating_sub(asked) >= POSITION_REQUEST_INTERVAL) {
            self.asked = Some(now);
            self.sink.reopen();
            encoder.write(Message::Ask, &Values::default(), &mut self.bytes);
            // A controller that is not there is seen by its frames.
            let _ = self.sink.send(&self.bytes);
        }
        let is_line = self.sink.is_line();
        let mut newest = None;
        for _ in 0..MOST_ANSWERS {
            let Some(answer) = self.sink.receive(packet) else { break };
            let mut take = |answer: &[u8]| newest = encoder.reported(answer).or(newest);
            if is_line { self.answers.take(answer, take) } else { take(answer) }
        }
        if let Some(lengths) = newest {
            // A later answer follows where there is no room.
            let _ = self.orders.push(Order::Report(lengths));
        }
    }

    /// Takes what the device answers.
    fn listen(&mut self, mut fault: Option<Event>, packet: &mut [u8]) {
        // Only a sink that answers does not wait for one.
        let most = if self.device.answers() { MOST_ANSWERS } else { 0 };
        for _ in 0..most {
            let Some(answer) = self.sink.receive(packet) else { break };
            fault = self.device.receive(answer).or(fault);
        }
        // Nobody answers what is printed.
        if fault.is_some() && !matches!(self.sink, Sink::Dry) {
            self.report(Loss::Device);
        }
    }

    /// Reports a loss, later if the loop has not taken what was reported before.
    fn report(&mut self, loss: Loss) {
        self.owed = self.orders.push(Order::Lost(loss)).is_err().then_some(loss);
    }

    fn end(&mut self) {
        // Time between frames of a platform that comes to rest, and their number.
        const REST_INTERVAL: Duration = Duration::from_millis(10);
        const REST_FRAMES: u32 = 100;
        if self.running {
            let mut last = self.last;
            for frame in 1..=REST_FRAMES {
                let Some(values) = self.limiter.at_rest_after(f64::from(frame) * REST_INTERVAL.as_secs_f64()) else {
                    break;
                };
                self.deliver(Message::Frame, &values);
                self.sent.last = Some(values.length);
                last = Values { velocity: [0.0; 6], ..values };
                std::thread::sleep(REST_INTERVAL);
            }
            self.deliver(Message::Stop, &last);
            self.running = false;
        }
    }
}

#[cfg(test)]
mod tests;
