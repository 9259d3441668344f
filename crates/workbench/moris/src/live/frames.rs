//! Frames on their way to the device.

#[cfg(feature = "serial")]
use std::cell::RefCell;
use std::io::{Write, stdout};
use std::net::UdpSocket;
use std::thread::Thread;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use moris_live::frame::{Encoder, Values};
use moris_live::moog::Moog;
use moris_live::{Commands, Event, STEP, State};
use rtrb::{Consumer, Producer};

use super::lateness::Lateness;
use super::pace;
use super::page::Order;

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
    /// A frame.
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
    /// Messages for which there was no room.
    pub lost: u64,
}

impl Frames {
    /// Frames at this interval \[s\], for the thread that sends them.
    pub fn new(ring: Producer<Sending>, sender: Thread, interval: f64) -> Self {
        let every = (interval / STEP).round().max(1.0) as u64;
        Frames { ring, sender, every, step: 0, before: State::Off, newest: None, lost: 0 }
    }

    /// Passes on what follows from a step's commands.
    pub fn take(&mut self, commands: &Commands) {
        let values = Values::from(commands);
        let before = std::mem::replace(&mut self.before, commands.state);
        self.step += 1;
        match (before, commands.state) {
            (State::Off, State::Off) => return,
            (_, State::Off) => self.push(Message::Stop, values),
            (State::Off, _) => self.push(Message::Start, values),
            // A fault that is cleared at neutral leaves no time for homing.
            (State::Settled | State::Fault, State::Homing | State::Neutral) => self.push(Message::Start, values),
            (State::Parking, State::Settled) => {
                self.push(Message::Frame, values);
                self.push(Message::Park, values);
            }
            _ if self.step.is_multiple_of(self.every) => self.push(Message::Frame, values),
            _ => return,
        }
        self.sender.unpark();
    }

    fn push(&mut self, message: Message, values: Values) {
        let sending = Sending { message, values, arrival: self.newest.take() };
        self.lost += u64::from(self.ring.push(sending).is_err());
    }
}

/// Place to which frames go.
pub enum Sink {
    /// A device.
    Udp(UdpSocket),
    /// A serial line.
    #[cfg(feature = "serial")]
    Serial(RefCell<Line>),
    /// Standard output.
    Dry,
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

    /// A packet that a device has sent, if there is one; only after [`Sink::listen`].
    fn receive<'a>(&self, packet: &'a mut [u8]) -> Option<&'a [u8]> {
        let Sink::Udp(socket) = self else { return None };
        let length = socket.recv(packet).ok()?;
        Some(&packet[..length])
    }

    /// Lets [`Sink::receive`] not wait.
    ///
    /// # Errors
    /// The device cannot be asked.
    pub fn listen(&self) -> Result<()> {
        match self {
            Sink::Udp(socket) => Ok(socket.set_nonblocking(true)?),
            Sink::Dry => Ok(()),
            #[cfg(feature = "serial")]
            Sink::Serial(_) => bail!("this device answers by UDP: --to udp:HOST:PORT"),
        }
    }

    fn send(&self, bytes: &[u8]) -> bool {
        match self {
            _ if bytes.is_empty() => true,
            Sink::Udp(socket) => socket.send(bytes).is_ok(),
            #[cfg(feature = "serial")]
            Sink::Serial(port) => port.borrow_mut().write_all(bytes).is_ok(),
            // The reader of the output may be gone.
            Sink::Dry => stdout().write_all(shown(bytes).as_bytes()).is_ok(),
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
                    Message::Start => encoder.start(values, out),
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
                    if message == Message::Start {
                        moog.start();
                    }
                    *is_up = (*is_up || message == Message::Start) && message != Message::Park;
                    moog.send(*is_up, values)
                };
                out.extend(packet);
                fault
            }
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

/// Sends messages until the loop has ended. If the loop ends without a stop string, by a panic,
/// sends it. A device that is slower than the frames gets the newest ones. Its faults go to the
/// loop.
pub fn send(mut ring: Consumer<Sending>, mut device: Device, sink: &Sink, mut orders: Producer<Order>) -> Sent {
    let mut bytes = Vec::with_capacity(4096);
    let mut packet = [0; 256];
    let mut sent = Sent::default();
    let mut running = false;
    let mut last = Values::default();
    let mut deliver = |device: &mut Device, sent: &mut Sent, message: Message, values: &Values| {
        let fault = device.bytes(message, values, &mut bytes);
        let taken = (0..device.copies(message)).all(|_| sink.send(&bytes));
        sent.sent += u64::from(taken && !bytes.is_empty());
        sent.failed += u64::from(!taken);
        fault
    };
    loop {
        // Seen before the ring is empty: what comes after it has been looked at.
        let ended = ring.is_abandoned();
        while let Ok(Sending { message, values, arrival }) = ring.pop() {
            if message == Message::Frame && ring.peek().is_ok_and(|next| next.message == Message::Frame) {
                sent.skipped += 1;
                continue;
            }
            running = message != Message::Stop;
            if matches!(message, Message::Start | Message::Frame) {
                last = values;
            }
            let mut fault = deliver(&mut device, &mut sent, message, &values);
            if let Some(arrival) = arrival {
                sent.passage.take(pace::now().saturating_sub(arrival));
            }
            while device.answers()
                && let Some(answer) = sink.receive(&mut packet)
            {
                fault = device.receive(answer).or(fault);
            }
            // Nobody answers what is printed.
            if let Some(event) = fault.filter(|_| !matches!(sink, Sink::Dry)) {
                eprintln!("device: a fault, or no answer");
                let _ = orders.push(Order::Event(event));
            }
        }
        if ended {
            if running {
                rest(&mut last, |values| {
                    deliver(&mut device, &mut sent, Message::Frame, values);
                });
                deliver(&mut device, &mut sent, Message::Stop, &last);
            }
            return sent;
        }
        std::thread::park_timeout(Duration::from_millis(20));
    }
}

/// Time between frames of a platform that comes to rest, their number, and the time in which its
/// speed falls to a third \[s\].
const REST_INTERVAL: Duration = Duration::from_millis(10);
const REST_FRAMES: u32 = 100;
const REST_TIME: f64 = 0.15;

/// Brings the actuators to rest where they are: there is no washout any more that knows a way.
fn rest(values: &mut Values, mut send: impl FnMut(&Values)) {
    let step = REST_INTERVAL.as_secs_f64();
    for _ in 0..REST_FRAMES {
        values.time += step;
        for (length, velocity) in values.length.iter_mut().zip(&mut values.velocity) {
            *velocity *= 1.0 - step / REST_TIME;
            *length += step * *velocity;
        }
        send(values);
        std::thread::sleep(REST_INTERVAL);
    }
    values.velocity = [0.0; 6];
}

#[cfg(test)]
mod tests {
    use moris_live::frame;
    use rtrb::RingBuffer;

    use super::*;

    #[test]
    fn a_loop_that_panics_leaves_a_platform_at_rest_and_the_stop_string() {
        let device = UdpSocket::bind("127.0.0.1:0").unwrap();
        let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
        let encoder = Encoder::new(&frame::shipped("csv").unwrap().parse().unwrap(), [1.0, 1.6]).unwrap();
        let (mut ring, messages) = RingBuffer::new(8);
        let (orders, _) = RingBuffer::new(4);
        let sender = std::thread::spawn(move || send(messages, Device::Template(Box::new(encoder)), &sink, orders));
        let panicking = std::thread::spawn(move || {
            let moving = Values { length: [1.3; 6], velocity: [0.4; 6], ..Values::default() };
            for message in [Message::Start, Message::Frame] {
                ring.push(Sending { message, values: moving, arrival: None }).unwrap();
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
}
