//! Frames on their way to the device.

use std::io::{Write, stdout};
use std::net::UdpSocket;
use std::thread::Thread;
use std::time::Duration;

use anyhow::{Context, Result};
use moris_live::frame::{Encoder, Values};
use moris_live::{Commands, STEP, State};
use rtrb::{Consumer, Producer};

/// A message of the loop to the device.
#[derive(Clone, Copy, Debug)]
pub enum Message {
    /// The start string.
    Start(Values),
    /// A frame.
    Frame(Values),
    /// The park string.
    Park(Values),
    /// The stop string.
    Stop(Values),
}

/// The loop's end of the way.
pub struct Frames {
    ring: Producer<Message>,
    sender: Thread,
    /// Steps from frame to frame.
    every: u64,
    step: u64,
    before: State,
    /// Messages for which there was no room.
    pub lost: u64,
}

impl Frames {
    /// Frames at this interval \[s\], for the thread that sends them.
    pub fn new(ring: Producer<Message>, sender: Thread, interval: f64) -> Self {
        let every = (interval / STEP).round().max(1.0) as u64;
        Frames { ring, sender, every, step: 0, before: State::Off, lost: 0 }
    }

    /// Passes on what follows from a step's commands.
    pub fn take(&mut self, commands: &Commands) {
        let values = Values::from(commands);
        let before = std::mem::replace(&mut self.before, commands.state);
        self.step += 1;
        match (before, commands.state) {
            (State::Off, State::Off) => return,
            (_, State::Off) => self.push(Message::Stop(values)),
            (State::Off, _) => self.push(Message::Start(values)),
            (State::Parking, State::Settled) => {
                self.push(Message::Frame(values));
                self.push(Message::Park(values));
            }
            _ if self.step.is_multiple_of(self.every) => self.push(Message::Frame(values)),
            _ => return,
        }
        self.sender.unpark();
    }

    fn push(&mut self, message: Message) {
        self.lost += u64::from(self.ring.push(message).is_err());
    }
}

/// Place to which frames go.
pub enum Sink {
    /// A device.
    Udp(UdpSocket),
    /// Standard output.
    Dry,
}

impl Sink {
    /// The device at `udp:HOST:PORT`.
    ///
    /// # Errors
    /// There is no such host.
    pub fn open(target: &str) -> Result<Sink> {
        let address = target.strip_prefix("udp:").context("--to is udp:HOST:PORT")?;
        let socket = UdpSocket::bind(("0.0.0.0", 0)).context("cannot open a socket")?;
        socket.connect(address).with_context(|| format!("cannot send to {address}"))?;
        Ok(Sink::Udp(socket))
    }

    fn send(&self, bytes: &[u8]) -> bool {
        match self {
            _ if bytes.is_empty() => true,
            Sink::Udp(socket) => socket.send(bytes).is_ok(),
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
#[derive(Clone, Copy, Debug, Default)]
pub struct Sent {
    /// Taken by the socket.
    pub sent: u64,
    /// Refused by it.
    pub failed: u64,
}

/// Sends messages until the loop has ended. If the loop ends without a stop string, by a panic,
/// sends it.
pub fn send(mut ring: Consumer<Message>, encoder: &Encoder, sink: Sink) -> Sent {
    let mut bytes = Vec::with_capacity(4096);
    let mut sent = Sent::default();
    let mut running = false;
    let mut last = Values::default();
    loop {
        // Seen before the ring is empty: what comes after it has been looked at.
        let ended = ring.is_abandoned();
        while let Ok(message) = ring.pop() {
            running = !matches!(message, Message::Stop(_));
            (match message {
                Message::Start(values) => {
                    last = values;
                    encoder.start(&values, &mut bytes);
                }
                Message::Frame(values) => {
                    last = values;
                    encoder.frame(&values, &mut bytes);
                }
                Message::Park(values) => encoder.park(&values, &mut bytes),
                Message::Stop(values) => encoder.stop(&values, &mut bytes),
            });
            let taken = sink.send(&bytes);
            sent.sent += u64::from(taken && !bytes.is_empty());
            sent.failed += u64::from(!taken);
        }
        if ended {
            if running {
                encoder.stop(&last, &mut bytes);
                sent.sent += u64::from(sink.send(&bytes) && !bytes.is_empty());
            }
            return sent;
        }
        std::thread::park_timeout(Duration::from_millis(20));
    }
}

#[cfg(test)]
mod tests {
    use moris_live::frame;
    use rtrb::RingBuffer;

    use super::*;

    #[test]
    fn a_loop_that_panics_leaves_the_stop_string() {
        let device = UdpSocket::bind("127.0.0.1:0").unwrap();
        let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
        let encoder = Encoder::new(&frame::shipped("csv").unwrap().parse().unwrap(), [1.0, 1.6]).unwrap();
        let (mut ring, messages) = RingBuffer::new(8);
        let sender = std::thread::spawn(move || send(messages, &encoder, sink));
        let panicking = std::thread::spawn(move || {
            ring.push(Message::Start(Values::default())).unwrap();
            ring.push(Message::Frame(Values::default())).unwrap();
            panic!("deliberate");
        });
        assert!(panicking.join().is_err());
        assert_eq!(sender.join().unwrap().sent, 3);
        device.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let mut received = Vec::new();
        for _ in 0..3 {
            let mut packet = [0; 1000];
            let length = device.recv(&mut packet).unwrap();
            received.push(String::from_utf8(packet[..length].to_vec()).unwrap());
        }
        assert_eq!((received[0].as_str(), received[2].as_str()), ("start\n", "stop\n"));
    }
}
