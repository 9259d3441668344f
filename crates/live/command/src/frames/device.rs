//! Bytes to a device: a template that is filled in, or packets of a motion base that answers.

use moris_live::Event;
use moris_live::frame::{Encoder, Values};
use moris_live::moog::Moog;

use super::Message;

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
    pub fn copies(&self, message: Message) -> usize {
        if self.answers() && message == Message::Stop { 3 } else { 1 }
    }

    /// Replaces `out` by the bytes for a message. A fault, if the device is silent.
    pub fn bytes(&mut self, message: Message, values: &Values, out: &mut Vec<u8>) -> Option<Event> {
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
    pub fn asks(&self) -> bool {
        matches!(self, Device::Template(encoder) if encoder.asks())
    }

    /// Replaces `out` by the question for the legs' lengths; nothing if it has none.
    pub fn ask(&self, out: &mut Vec<u8>) {
        out.clear();
        if let Device::Template(encoder) = self {
            encoder.ask(out);
        }
    }

    /// True for a device that answers.
    pub fn answers(&self) -> bool {
        matches!(self, Device::Moog { .. })
    }

    /// Takes what the device has answered.
    pub fn receive(&mut self, answer: &[u8]) -> Option<Event> {
        match self {
            Device::Template(_) => None,
            Device::Moog { moog, .. } => moog.receive(answer),
        }
    }
}
