//! Bytes to a device: a template that is filled in, or packets of a motion base that answers.

use moris_live::Event;
use moris_live::frame::{Encoder, Message, Values};
use moris_live::moog::Moog;
use moris_washout::Rig;

/// Bytes to the device for a message.
#[derive(Clone, Debug)]
pub enum Device {
    /// A template, filled in, and the number of the next frame.
    Template(Box<Encoder>, u32),
    /// Packets of a motion base that answers.
    Moog { moog: Box<Moog>, is_up: bool },
}

impl Device {
    /// A device that a template describes.
    pub fn of_template(encoder: Encoder) -> Self {
        Device::Template(Box::new(encoder), 0)
    }

    /// The motion base, with the geometry of this rig.
    pub fn moog(rig: &Rig) -> Self {
        Device::Moog { moog: Box::new(Moog::new(rig)), is_up: false }
    }

    /// The values that the device is to follow, before the limits of the legs' frames.
    pub fn followed(&self, values: &Values) -> Values {
        match self {
            Device::Template(..) => *values,
            Device::Moog { moog, .. } => moog.faded(values),
        }
    }

    /// Replaces `out` by the bytes for a message. A fault, if the device is silent.
    pub fn bytes(&mut self, message: Message, values: &Values, out: &mut Vec<u8>) -> Option<Event> {
        match self {
            Device::Template(encoder, count) => {
                let values = &Values { count: *count, ..*values };
                encoder.write(message, values, out);
                *count = count.wrapping_add(u32::from(message == Message::Frame));
                None
            }
            Device::Moog { moog, is_up } => {
                out.clear();
                let (packet, fault) = if message == Message::Stop {
                    (Moog::last(values), None)
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

    /// True for a device that answers.
    pub fn answers(&self) -> bool {
        matches!(self, Device::Moog { .. })
    }

    /// Takes what the device has answered.
    pub fn receive(&mut self, answer: &[u8]) -> Option<Event> {
        match self {
            Device::Template(..) => None,
            Device::Moog { moog, .. } => moog.receive(answer),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use moris_live::moog::PACKET_INTERVAL;

    use super::*;
    use crate::actuator_limits::{Actuators, FrameLimiter};

    /// Commands that jump by 0.3 m, as by an error somewhere before: what the base is sent.
    #[test]
    fn a_pose_is_under_the_limit_of_the_legs() {
        let rig = Rig::default();
        let mut device = Device::moog(&rig);
        let stroke = [rig.min_length, rig.max_length];
        let actuators = Actuators { speed: rig.velocity_limit, acceleration: rig.acceleration_limit, stroke };
        let mut limiter = FrameLimiter::new(PACKET_INTERVAL, actuators);
        let mut answer = [0; 40];
        answer[11] = 0x23;
        let (mut bytes, mut before, mut fastest) = (Vec::new(), 0.0, 0.0_f64);
        device.bytes(Message::Start, &Values::default(), &mut bytes);
        for k in 0..1200 {
            device.receive(&answer);
            let heave_above = if k / 300 % 2 == 0 { 0.15 } else { -0.15 };
            let commanded = Values { time: f64::from(k) * PACKET_INTERVAL, heave_above, ..Values::default() };
            let now = Duration::from_secs_f64(commanded.time);
            let values = limiter.pass(now, &device.followed(&commanded));
            device.bytes(Message::Frame, &values, &mut bytes);
            let heave = f64::from(f32::from_be_bytes(bytes[12..16].try_into().unwrap()));
            fastest = fastest.max((heave - before).abs() / PACKET_INTERVAL);
            before = heave;
        }
        // The legs of the default rig are steep: a heave is nearly their own way.
        assert!(fastest <= 1.2 * rig.velocity_limit, "{fastest} m/s");
        assert!((before - 0.15).abs() < 1e-3, "{before} m");
    }
}
