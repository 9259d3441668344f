//! Frames on their way to the device.

#[cfg(feature = "serial")]
use std::cell::RefCell;
use std::fmt::{self, Display, Formatter};
#[cfg(feature = "serial")]
use std::io::Read as _;
use std::io::{self, ErrorKind, Write, stdout};
use std::net::UdpSocket;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::thread::Thread;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use moris_live::frame::{Encoder, Values, reported};
use moris_live::moog::Moog;
use moris_live::motion::turns;
use moris_live::{Commands, Event, STEP, State};
use rtrb::{Consumer, Producer};
#[cfg(feature = "serial")]
use serialport::SerialPort as _;

use super::contact::Contact;
use super::lateness::Lateness;
use super::lines::Lines;
use super::page::Order;
use super::watch::Part;
use super::wire::{Actuators, Wire};
use super::{Shared, pace};

/// Time in which a serial line must take a frame.
#[cfg(feature = "serial")]
const LINE_TIME: Duration = Duration::from_millis(100);

/// A serial line.
#[cfg(all(feature = "serial", unix))]
type Line = serialport::TTYPort;
#[cfg(all(feature = "serial", not(unix)))]
type Line = serialport::COMPort;

/// A message of the loop to the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message {
    /// The start string.
    Start,
    /// The same to actuators that are where the first frame has them, as is known.
    Begin,
    /// A frame of actuator positions.
    Frame,
    /// The park string.
    Park,
    /// The stop string.
    Stop,
}

/// A message on its way with its values, and the arrival of the sample that it is the first to
/// follow.
#[derive(Clone, Copy, Debug)]
pub struct Sending {
    pub message: Message,
    pub values: Values,
    pub arrival: Option<Duration>,
    /// Time of [`pace::now`] at which the loop passed it on.
    pub made: Duration,
}

/// Reason for which the controller does not follow any more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loss {
    /// The receiver refuses frames, or the line is gone.
    Refused(ErrorKind),
    /// No frame has left for this time \[s\], its own time-out or longer.
    Gap(f64),
    /// The device answers with a fault, or no more.
    Device,
}

/// Time without frames after which a controller may have gone anywhere, whatever its time-out
/// \[s\].
const LONG_GAP: f64 = 2.0;

impl Loss {
    /// True if the legs may be anywhere after it.
    pub fn is_of_place(self) -> bool {
        !matches!(self, Loss::Gap(time) if time < LONG_GAP)
    }
}

impl Display for Loss {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Loss::Refused(kind) => write!(f, "CONTROLLER LOST: it takes no frames: {kind}. Repair it, then clear"),
            Loss::Gap(time) if *time >= LONG_GAP => {
                write!(f, "CONTROLLER LOST: no frame has left for {time:.0} s. Look where the legs are, then clear")
            }
            Loss::Gap(time) => write!(f, "CONTROLLER LOST: no frame has left for {time:.2} s, its time-out. Clear it"),
            Loss::Device => write!(f, "CONTROLLER LOST: it reports a fault, or does not answer. Repair it, then clear"),
        }
    }
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
    /// The actuators are where the next start begins, as a person or the controller has said.
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
        let sending = Sending { message, values, arrival: self.newest.take(), made: pace::now() };
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
/// They go on with their velocity and acceleration, from differences over [`Ahead::STEPS`] steps.
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

/// Place to which frames go.
pub enum Sink {
    /// Address of a device.
    Udp(UdpSocket),
    /// A serial line.
    #[cfg(feature = "serial")]
    Serial(RefCell<Line>),
    /// Standard output.
    Dry,
    /// One with an error of this program in its third and fifth message.
    #[cfg(test)]
    Panicking(std::cell::Cell<u32>),
}

impl Sink {
    /// The device at `udp:HOST:PORT` or `serial:LINE:BAUD`.
    ///
    /// # Errors
    /// There is no such host or line.
    pub fn open(target: &str) -> Result<Sink> {
        if let Some(line) = target.strip_prefix("serial:") {
            return Sink::open_serial(line);
        }
        let address = target.strip_prefix("udp:").context("--to is udp:HOST:PORT or serial:LINE:BAUD")?;
        let socket = UdpSocket::bind(("0.0.0.0", 0)).context("cannot open a socket")?;
        socket.connect(address).with_context(|| format!("cannot send to {address}"))?;
        Ok(Sink::Udp(socket))
    }

    #[cfg(feature = "serial")]
    fn open_serial(line: &str) -> Result<Sink> {
        let (line, baud) = line.rsplit_once(':').context("--to is serial:LINE:BAUD")?;
        let baud = baud.parse().context("--to is serial:LINE:BAUD")?;
        let port = serialport::new(line, baud).timeout(LINE_TIME).open_native();
        Ok(Sink::Serial(RefCell::new(port.with_context(|| format!("cannot open {line}"))?)))
    }

    #[cfg(not(feature = "serial"))]
    fn open_serial(_: &str) -> Result<Sink> {
        bail!("moris was built without serial lines; build it with --features serial")
    }

    /// A packet that a device has sent, if there is one; only after [`Sink::listen`]. Of a line,
    /// some bytes.
    fn receive<'a>(&self, packet: &'a mut [u8]) -> Option<&'a [u8]> {
        let length = match self {
            Sink::Udp(socket) => socket.recv(packet).ok()?,
            #[cfg(feature = "serial")]
            Sink::Serial(port) => {
                let mut port = port.borrow_mut();
                // A read of nothing would wait.
                let waiting = port.bytes_to_read().ok()?.min(packet.len() as u32) as usize;
                port.read(&mut packet[..waiting]).ok().filter(|length| *length > 0)?
            }
            _ => return None,
        };
        Some(&packet[..length])
    }

    /// True for a way on which answers are lines, in parts as they come.
    fn is_line(&self) -> bool {
        #[cfg(feature = "serial")]
        return matches!(self, Sink::Serial(_));
        #[cfg(not(feature = "serial"))]
        false
    }

    /// Lets [`Sink::receive`] not wait.
    ///
    /// # Errors
    /// The device cannot be asked.
    pub fn listen(&self) -> Result<()> {
        match self {
            Sink::Udp(socket) => Ok(socket.set_nonblocking(true)?),
            Sink::Dry => Ok(()),
            #[cfg(test)]
            Sink::Panicking(_) => Ok(()),
            #[cfg(feature = "serial")]
            Sink::Serial(_) => bail!("this device answers by UDP: --to udp:HOST:PORT"),
        }
    }

    /// As [`Sink::listen`], on a way that has answers.
    ///
    /// # Errors
    /// The device cannot be asked.
    pub fn listen_if_it_can(&self) -> Result<()> {
        match self {
            Sink::Udp(_) => self.listen(),
            _ => Ok(()),
        }
    }

    fn send(&self, bytes: &[u8]) -> io::Result<()> {
        match self {
            _ if bytes.is_empty() => Ok(()),
            Sink::Udp(socket) => socket.send(bytes).map(drop),
            #[cfg(feature = "serial")]
            Sink::Serial(port) => port.borrow_mut().write_all(bytes),
            // The reader of the output may be gone.
            Sink::Dry => stdout().write_all(shown(bytes).as_bytes()),
            #[cfg(test)]
            Sink::Panicking(sends) => {
                sends.set(sends.get() + 1);
                assert!(!matches!(sends.get(), 3 | 5), "deliberate");
                Ok(())
            }
        }
    }
}

/// A frame as a line: text as it is, other bytes in hexadecimal digits.
pub fn shown(bytes: &[u8]) -> String {
    match str::from_utf8(bytes) {
        Ok(text) if text.chars().all(|c| !c.is_control() || c == '\n') => format!("{}\n", text.trim_end()),
        _ => bytes.iter().map(|byte| format!("{byte:02X} ")).collect::<String>().trim_end().to_owned() + "\n",
    }
}

/// Numbers of frames.
#[derive(Clone, Debug, Default)]
pub struct Sent {
    /// Taken by the socket.
    pub sent: u64,
    /// Refused by it.
    pub failed: u64,
    /// Left out because a newer one was there.
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

/// Bytes to the device for a message.
#[derive(Clone, Debug)]
pub enum Device {
    /// A template, filled in.
    Template(Box<Encoder>),
    /// Packets of a motion base that answers.
    Moog { moog: Moog, is_up: bool },
}

impl Device {
    /// The motion base.
    pub fn moog() -> Self {
        Device::Moog { moog: Moog::default(), is_up: false }
    }

    /// Number of times that a message is sent: an answering base has no time-out that is known,
    /// and a packet may be lost.
    fn copies(&self, message: Message) -> usize {
        if self.answers() && message == Message::Stop { 3 } else { 1 }
    }

    /// Replaces `out` by the bytes for a message. A fault, if the device is silent.
    fn bytes(&mut self, message: Message, values: &Values, out: &mut Vec<u8>) -> Option<Event> {
        match self {
            Device::Template(encoder) => {
                match message {
                    Message::Start | Message::Begin => encoder.start(values, out),
                    Message::Frame => encoder.frame(values, out),
                    Message::Park => encoder.park(values, out),
                    Message::Stop => encoder.stop(values, out),
                }
                None
            }
            Device::Moog { moog, is_up } => {
                out.clear();
                let (packet, fault) = if message == Message::Stop {
                    (Moog::last(), None)
                } else {
                    let starts = matches!(message, Message::Start | Message::Begin);
                    if starts {
                        moog.start();
                    }
                    *is_up = (*is_up || starts) && message != Message::Park;
                    moog.send(*is_up, values)
                };
                out.extend(packet);
                fault
            }
        }
    }

    /// True if it can be asked for the legs' lengths.
    fn asks(&self) -> bool {
        matches!(self, Device::Template(encoder) if encoder.asks())
    }

    /// Replaces `out` by the question for the legs' lengths; nothing if it has none.
    fn ask(&self, out: &mut Vec<u8>) {
        out.clear();
        if let Device::Template(encoder) = self {
            encoder.ask(out);
        }
    }

    /// True for a device that answers.
    fn answers(&self) -> bool {
        matches!(self, Device::Moog { .. })
    }

    /// Takes what the device has answered.
    fn receive(&mut self, answer: &[u8]) -> Option<Event> {
        match self {
            Device::Template(_) => None,
            Device::Moog { moog, .. } => moog.receive(answer),
        }
    }
}

/// The thread that sends.
pub struct Sender<'a> {
    pub ring: Consumer<Sending>,
    pub device: Device,
    pub sink: Sink,
    /// Losses of the controller, for the loop.
    pub orders: Producer<Order>,
    pub wire: Wire,
    pub contact: Contact,
    /// The controller's own time-out.
    pub time_out: Option<Duration>,
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

/// Time between questions for the legs' lengths.
const ASKS: Duration = Duration::from_millis(200);

/// Errors of this program after which the sending thread ends.
const MOST_ERRORS: u32 = 10;

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
            wire: Wire::new(interval, actuators),
            contact: Contact::new(interval),
            time_out: None,
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
                let fault = self.take(message, &values);
                let now = pace::now();
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

    /// Sends a message. A fault, if the device reports one.
    fn take(&mut self, message: Message, values: &Values) -> Option<Event> {
        self.running = message != Message::Stop;
        let now = pace::now();
        if matches!(message, Message::Start | Message::Begin) {
            self.contact.renew();
        }
        if message == Message::Begin {
            self.wire.begin_anew();
        }
        if self.contact.is_lost() && message != Message::Stop {
            // What comes back without a person who clears it would jump.
            return None;
        }
        let mut values = *values;
        if message == Message::Stop {
            // The legs stay where the last frame has them.
            values = if self.wire.gap(now).is_some() { self.last } else { values };
        } else {
            if message == Message::Frame
                && let Some(gap) = self.wire.gap(now)
            {
                self.sent.gap = self.sent.gap.max(gap);
                let loss = Loss::Gap(gap.as_secs_f64());
                let is_long = loss.is_of_place() && !matches!(self.sink, Sink::Dry);
                if is_long || self.time_out.is_some_and(|time_out| gap >= time_out) {
                    self.wire.lose();
                    self.report(loss);
                }
                if is_long {
                    self.contact.lose();
                    return None;
                }
            }
            values = self.wire.pass(now, &values);
            self.last = values;
            self.sent.last = Some(values.length);
        }
        self.deliver(message, &values)
    }

    fn deliver(&mut self, message: Message, values: &Values) -> Option<Event> {
        let fault = self.device.bytes(message, values, &mut self.bytes);
        let mut taken = Ok(());
        for _ in 0..self.device.copies(message) {
            taken = taken.and(self.sink.send(&self.bytes));
        }
        self.sent.sent += u64::from(taken.is_ok() && !self.bytes.is_empty());
        self.sent.failed += u64::from(taken.is_err());
        // Nobody follows what is printed.
        if !matches!(self.sink, Sink::Dry)
            && let Some(kind) = self.contact.take(&taken, pace::now())
        {
            self.wire.lose();
            self.report(Loss::Refused(kind));
        }
        fault
    }

    /// Asks for the legs' lengths now and then, and passes answers on.
    fn ask(&mut self, packet: &mut [u8]) {
        if !self.device.asks() {
            return;
        }
        let now = pace::now();
        if self.asked.is_none_or(|asked| now.saturating_sub(asked) >= ASKS) {
            self.asked = Some(now);
            self.device.ask(&mut self.bytes);
            // A controller that is not there is seen by its frames.
            let _ = self.sink.send(&self.bytes);
        }
        let is_line = self.sink.is_line();
        let mut newest = None;
        for _ in 0..MOST_ANSWERS {
            let Some(answer) = self.sink.receive(packet) else { break };
            let mut take = |answer: &[u8]| newest = reported(answer).or(newest);
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
        if self.running {
            let mut last = self.last;
            for frame in 1..=REST_FRAMES {
                let Some(values) = self.wire.at_rest_after(f64::from(frame) * REST_INTERVAL.as_secs_f64()) else {
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

/// Time between frames of a platform that comes to rest, and their number.
const REST_INTERVAL: Duration = Duration::from_millis(10);
const REST_FRAMES: u32 = 100;

#[cfg(test)]
mod tests {
    use moris_live::{Session, Settings, frame};
    use moris_washout::Parameters;
    use rtrb::RingBuffer;

    use super::*;

    #[test]
    fn a_loop_that_panics_leaves_a_platform_at_rest_and_the_stop_string() {
        let device = UdpSocket::bind("127.0.0.1:0").unwrap();
        let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
        let encoder = Encoder::new(&frame::shipped("csv").unwrap().parse().unwrap(), [1.0, 1.6]).unwrap();
        let (mut ring, messages) = RingBuffer::new(8);
        let (orders, _) = RingBuffer::new(4);
        let sender = std::thread::spawn(move || {
            let device = Device::Template(Box::new(encoder));
            Sender::new(
                messages,
                device,
                sink,
                orders,
                (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
                &Shared::default(),
            )
            .run()
        });
        let panicking = std::thread::spawn(move || {
            let moving = Values { length: [1.3; 6], velocity: [0.4; 6], ..Values::default() };
            for message in [Message::Start, Message::Frame] {
                ring.push(Sending { message, values: moving, arrival: None, made: pace::now() }).unwrap();
            }
            panic!("deliberate");
        });
        assert!(panicking.join().is_err());
        device.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let mut received = Vec::new();
        while received.last().is_none_or(|line| line != "stop\n") {
            let mut packet = [0; 1000];
            let length = device.recv(&mut packet).unwrap();
            received.push(String::from_utf8(packet[..length].to_vec()).unwrap());
        }
        assert_eq!(sender.join().unwrap().sent, received.len() as u64);
        assert_eq!(received[0], "start\n");
        let frames = &received[1..received.len() - 1];
        let length = |line: &String| line.split(',').nth(1).unwrap().parse::<f64>().unwrap();
        let speeds: Vec<f64> = frames.windows(2).map(|pair| (length(&pair[1]) - length(&pair[0])) / 0.01).collect();
        // From 0.4 m/s to rest, at 0.4 / 0.15 m/s2 at most.
        assert!(speeds[0] > 0.3 && speeds.last().unwrap().abs() < 1e-3, "{speeds:?}");
        assert!(speeds.windows(2).all(|pair| (-1e-3..0.03).contains(&(pair[0] - pair[1]))), "{speeds:?}");
    }

    /// The loop is busy, and a report waits for it.
    #[test]
    fn a_loss_that_the_loop_has_no_room_for_is_reported_later() {
        let (mut orders, mut reported) = RingBuffer::new(1);
        orders.push(Order::Report([1.3; 6])).unwrap();
        let shared = Shared::default();
        let actuators = Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] };
        let (ring, messages) = RingBuffer::new(1);
        let mut sender = Sender::new(messages, Device::moog(), Sink::Dry, orders, (0.01, actuators), &shared);
        sender.report(Loss::Device);
        drop(ring);
        assert!(matches!(reported.pop(), Ok(Order::Report(_))));
        sender.run();
        assert!(matches!(reported.pop(), Ok(Order::Lost(Loss::Device))));
    }

    /// Whoever sends to the controller's socket without end.
    #[test]
    fn a_flood_of_answers_delays_no_frame() {
        let device = UdpSocket::bind("127.0.0.1:0").unwrap();
        let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
        sink.listen_if_it_can().unwrap();
        let Sink::Udp(socket) = &sink else { unreachable!() };
        let address = format!("127.0.0.1:{}", socket.local_addr().unwrap().port());
        (0..200).for_each(|_| _ = device.send_to(b"legs,1.3,1.3,1.3,1.3,1.3,1.3\n", &address).unwrap());
        let encoder = Encoder::new(&frame::shipped("csv").unwrap().parse().unwrap(), [1.0, 1.6]).unwrap();
        let (orders, mut reported) = RingBuffer::new(64);
        let shared = Shared::default();
        let actuators = Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] };
        let device_of = Device::Template(Box::new(encoder));
        let mut sender = Sender::new(RingBuffer::new(1).1, device_of, sink, orders, (0.01, actuators), &shared);
        let mut packet = [0; 256];
        sender.ask(&mut packet);
        // One report of many, and most of the flood is left for later.
        assert!(reported.pop().is_ok() && reported.pop().is_err());
        let left = (0..200).take_while(|_| sender.sink.receive(&mut packet).is_some()).count();
        assert!(left >= 100, "{left}");
    }

    /// The sender's counts and what it reports, after so many frames to this sink.
    fn sent_to(sink: Sink, device: Device, frames: u32, shared: &Shared) -> (Sent, Vec<Order>) {
        let (mut ring, messages) = RingBuffer::new(256);
        let (orders, mut reported) = RingBuffer::new(64);
        let sent = std::thread::scope(|scope| {
            let sender = scope.spawn(move || {
                Sender::new(
                    messages,
                    device,
                    sink,
                    orders,
                    (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
                    shared,
                )
                .run()
            });
            let send = |ring: &mut Producer<Sending>, message| {
                ring.push(Sending { message, values: Values::default(), arrival: None, made: pace::now() }).unwrap();
                sender.thread().unpark();
                std::thread::sleep(Duration::from_millis(10));
                // On a busy computer a frame that waits would be skipped for the next.
                while ring.slots() < 256 {
                    std::thread::sleep(Duration::from_millis(1));
                }
            };
            send(&mut ring, Message::Start);
            (0..frames).for_each(|_| send(&mut ring, Message::Frame));
            send(&mut ring, Message::Stop);
            drop(ring);
            sender.join().unwrap()
        });
        (sent, std::iter::from_fn(|| reported.pop().ok()).collect())
    }

    fn csv() -> Device {
        Device::Template(Box::new(Encoder::new(&frame::shipped("csv").unwrap().parse().unwrap(), [1.0, 1.6]).unwrap()))
    }

    #[test]
    fn an_error_while_sending_costs_a_frame_and_fails_the_session() {
        for device in [csv(), Device::moog()] {
            let shared = Shared::default();
            let (sent, _) = sent_to(Sink::Panicking(std::cell::Cell::new(0)), device, 20, &shared);
            assert!(shared.failed.has(Part::Frames));
            assert!((19..=22).contains(&sent.sent), "{}", sent.sent);
        }
    }

    #[test]
    fn a_controller_that_is_gone_is_reported_once() {
        let gone = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let sink = Sink::open(&format!("udp:{gone}")).unwrap();
        let (sent, reported) = sent_to(sink, csv(), 40, &Shared::default());
        assert_eq!(reported, [Order::Lost(Loss::Refused(ErrorKind::ConnectionRefused))]);
        assert!(sent.sent < 10, "frames go on to a controller that is lost: {}", sent.sent);
    }

    #[test]
    fn a_gap_on_the_wire_is_reported_from_the_time_out_of_the_controller_on() {
        for (pause, is_fault) in [(20, false), (250, true)] {
            let device = UdpSocket::bind("127.0.0.1:0").unwrap();
            let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
            let (mut ring, messages) = RingBuffer::new(256);
            let (orders, mut reported) = RingBuffer::new(64);
            let shared = Shared::default();
            let mut sender = Sender::new(
                messages,
                csv(),
                sink,
                orders,
                (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
                &shared,
            );
            sender.time_out = Some(Duration::from_millis(200));
            let sent = std::thread::scope(|scope| {
                let sender = scope.spawn(move || sender.run());
                for (message, wait) in [(Message::Start, 1), (Message::Frame, pause), (Message::Frame, 1)] {
                    let made = pace::now();
                    ring.push(Sending { message, values: Values::default(), arrival: None, made }).unwrap();
                    sender.thread().unpark();
                    std::thread::sleep(Duration::from_millis(wait));
                }
                ring.push(Sending {
                    message: Message::Stop,
                    values: Values::default(),
                    arrival: None,
                    made: pace::now(),
                })
                .unwrap();
                drop(ring);
                sender.join().unwrap()
            });
            let orders: Vec<Order> = std::iter::from_fn(|| reported.pop().ok()).collect();
            if is_fault {
                assert!(matches!(orders[..], [Order::Lost(Loss::Gap(gap))] if gap >= 0.2), "{orders:?}");
                assert!(sent.gap >= Duration::from_millis(200));
            } else if sent.gap < Duration::from_millis(200) {
                // Unless the computer itself made the gap.
                assert!(orders.is_empty(), "{orders:?}");
            }
        }
    }

    #[test]
    fn the_controller_is_asked_where_the_legs_are_while_that_is_unknown() {
        let device = UdpSocket::bind("127.0.0.1:0").unwrap();
        device.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
        sink.listen().unwrap();
        let (ring, messages) = RingBuffer::new(256);
        let (orders, mut reported) = RingBuffer::new(64);
        let shared = Shared::default();
        shared.asks.store(true, Ordering::Relaxed);
        std::thread::scope(|scope| {
            let shared = &shared;
            let sender = scope.spawn(move || {
                Sender::new(
                    messages,
                    csv(),
                    sink,
                    orders,
                    (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
                    shared,
                )
                .run()
            });
            let mut packet = [0; 100];
            let (length, from) = device.recv_from(&mut packet).unwrap();
            assert_eq!(&packet[..length], b"legs?\n");
            device.send_to(b"what?\n", from).unwrap();
            device.send_to(b"legs,1.1,1.2,1.3,1.4,1.5,1.6\n", from).unwrap();
            let begin = pace::now();
            let order = loop {
                if let Ok(order) = reported.pop() {
                    break order;
                }
                assert!(pace::now() - begin < Duration::from_secs(10));
                std::thread::sleep(Duration::from_millis(5));
            };
            assert_eq!(order, Order::Report([1.1, 1.2, 1.3, 1.4, 1.5, 1.6]));
            shared.asks.store(false, Ordering::Relaxed);
            drop(ring);
            sender.join().unwrap();
        });
    }

    /// The sending thread stands still while frames pile up, and a person stops.
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
