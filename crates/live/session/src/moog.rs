//! The motion base MOOG 6DOF2000E by UDP: its packets, and the commands that its states need.
//!
//! | state | sent, if the base is wanted up | sent, if it is wanted down |
//! |---|---|---|
//! | power up | DOF mode | DOF mode |
//! | idle | engage, at neutral; after a fault only when a person has started again | new position, at neutral |
//! | standby | new position, at neutral | park |
//! | engaged | new position | park |
//! | parking | new position, at neutral | new position, at neutral |
//! | a fault, disabled, inhibited | new position, at neutral; a fault for the session | the same |
//!
//! The base itself moves from its home to neutral. Then its pose fades in from neutral, so that it
//! does not matter how long that takes. A fault is reset by a person at the base.
//!
//! Layout, commands and states are those of two public programs for this base. No base has verified
//! them.

use crate::frame::Values;
use crate::transitions::Event;

/// Name among the frames.
pub const NAME: &str = "moog-6dof2000e";
/// Description, a sentence.
pub const ABOUT: &str = "Motion base MOOG 6DOF2000E by UDP, which answers with its state";
/// Time between packets \[s\].
pub const INTERVAL: f64 = 1.0 / 60.0;
/// Packets for which the pose fades in: 3 s.
const FADE: u32 = 180;
/// Packets without an answer after which the base counts as lost: 0.5 s.
const PATIENCE: u32 = 30;
/// Length of an answer, and of a packet \[bytes\].
const ANSWER: usize = 40;
const PACKET: usize = 32;

/// Word of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Provides a position.
    NewPosition = 130,
    /// Takes degrees of freedom, not lengths.
    DofMode = 170,
    /// Goes up to neutral.
    Engage = 180,
    /// Goes down to its home.
    Park = 210,
}

/// State of the base, from an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// The motion base starts.
    PowerUp,
    /// The motion base is at home, without power.
    Idle,
    /// The motion base goes to neutral.
    Standby,
    /// The motion base follows the commanded positions.
    Engaged,
    /// The motion base goes home.
    Parking,
    /// A fault, disabled or inhibited.
    Failed,
}

impl Base {
    /// The state in an answer; none in other packets.
    pub fn of(answer: &[u8]) -> Option<Base> {
        let word = answer.get(8..12).filter(|_| answer.len() == ANSWER)?;
        Some(match word[3] & 0x0F {
            0x0 => Base::PowerUp,
            0x1 => Base::Idle,
            0x2 => Base::Standby,
            0x3 => Base::Engaged,
            0x7 => Base::Parking,
            _ => Base::Failed,
        })
    }
}

/// The program's side of the connection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moog {
    base: Option<Base>,
    /// Packets sent since the last answer.
    unanswered: u32,
    /// Packets sent since the base is engaged.
    engaged: u32,
    /// After a fault the base is not engaged until a person starts it again.
    waits: bool,
}

impl Moog {
    /// A person starts the base.
    pub fn start(&mut self) {
        self.waits = false;
    }

    /// Takes an answer. A fault, if the base has failed or left its state by itself.
    pub fn receive(&mut self, answer: &[u8]) -> Option<Event> {
        let base = Base::of(answer)?;
        self.unanswered = 0;
        let before = self.base.replace(base);
        if base != Base::Engaged {
            self.engaged = 0;
        }
        // A base that leaves its state by itself is no longer where the session thinks it is.
        let has_left = before == Some(Base::Engaged) && !matches!(base, Base::Engaged | Base::Parking);
        let has_failed = base == Base::Failed && before != Some(Base::Failed);
        self.waits |= has_left || has_failed;
        (has_left || has_failed).then_some(Event::Fault)
    }

    /// The next packet, and a fault if the base is silent. `is_up`: the base is wanted at neutral
    /// or moving.
    pub fn send(&mut self, is_up: bool, values: &Values) -> ([u8; PACKET], Option<Event>) {
        self.unanswered = self.unanswered.saturating_add(1);
        let silent = self.unanswered == PATIENCE;
        if silent {
            (self.base, self.waits) = (None, true);
        }
        let (command, moves) = match (self.base, is_up) {
            (Some(Base::PowerUp), _) => (Command::DofMode, false),
            (Some(Base::Idle), true) if !self.waits => (Command::Engage, false),
            (Some(Base::Standby | Base::Engaged), false) => (Command::Park, false),
            (Some(Base::Engaged), true) => (Command::NewPosition, true),
            _ => (Command::NewPosition, false),
        };
        self.engaged = match self.base {
            _ if moves => (self.engaged + 1).min(FADE),
            // It may receive, and follow, although its answers are lost.
            None => self.engaged.saturating_sub(1),
            Some(_) => 0,
        };
        let part = f64::from(self.engaged) / f64::from(FADE);
        let part = part * part * (3.0 - 2.0 * part);
        (packet(command, part, values), silent.then_some(Event::Fault))
    }

    /// The packet at the end: home, under power.
    pub fn last() -> [u8; PACKET] {
        packet(Command::Park, 0.0, &Values::default())
    }

    /// The state of the base, if it answers.
    pub fn base(&self) -> Option<Base> {
        self.base
    }
}

/// A packet with this part of the pose. The base has x forward, y right, z down.
fn packet(command: Command, part: f64, values: &Values) -> [u8; PACKET] {
    let [x, y, _, roll, pitch, yaw] = values.pose;
    let pose = [roll, -pitch, -values.heave_above, x, -yaw, -y].map(|value| ((part * value) as f32).to_be_bytes());
    let mut packet = [0; PACKET];
    packet[..4].copy_from_slice(&(command as u32).to_be_bytes());
    for (place, value) in packet[4..28].chunks_exact_mut(4).zip(pose) {
        place.copy_from_slice(&value);
    }
    packet
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An answer by hand: faults, inputs and outputs, state, six positions, a spare.
    fn answer(state: u8) -> Vec<u8> {
        let mut answer = vec![0; 40];
        answer[11] = 0x20 | state;
        answer
    }

    fn values() -> Values {
        Values { pose: [0.1, 0.2, 9.0, 0.01, 0.02, 0.03], heave_above: 0.3, ..Values::default() }
    }

    fn command(packet: &[u8]) -> u32 {
        u32::from_be_bytes(packet[..4].try_into().unwrap())
    }

    fn numbers(packet: &[u8]) -> Vec<f32> {
        packet[4..28].chunks(4).map(|bytes| f32::from_be_bytes(bytes.try_into().unwrap())).collect()
    }

    #[test]
    fn a_packet_has_the_layout_of_the_base() {
        let packet = packet(Command::NewPosition, 1.0, &values());
        assert_eq!(command(&packet), 130);
        assert_eq!(packet[28..], [0; 4]);
        // Roll, pitch, heave, surge, yaw, lateral; z down and y right.
        assert_eq!(numbers(&packet), [0.01, -0.02, -0.3, 0.1, -0.03, -0.2]);
    }

    #[test]
    fn the_command_follows_from_the_state() {
        // The words of the public tables: DOF mode 170, engage 180, new position 130, park 210.
        for (state, up, down) in [
            (0x0, 170, 170),
            (0x1, 180, 130),
            (0x2, 130, 210),
            (0x3, 130, 210),
            (0x7, 130, 130),
            (0x8, 130, 130),
            (0xB, 130, 130),
        ] {
            for (is_up, expected) in [(true, up), (false, down)] {
                let mut moog = Moog::default();
                moog.receive(&answer(state));
                let (packet, _) = moog.send(is_up, &values());
                assert_eq!(command(&packet), expected, "{state:#x} {is_up}");
                if state != 0x3 {
                    assert!(numbers(&packet).iter().all(|number| *number == 0.0), "{state:#x}");
                }
            }
        }
    }

    #[test]
    fn the_pose_fades_in_once_the_base_is_engaged() {
        let mut moog = Moog::default();
        moog.receive(&answer(0x3));
        let mut before = 0.0;
        for _ in 0..180 {
            moog.receive(&answer(0x3));
            let heave = numbers(&moog.send(true, &values()).0)[2];
            // At most 0.15 m/s for 0.3 m.
            assert!((0.0..0.0026).contains(&(before - heave)), "{before} {heave}");
            before = heave;
        }
        assert_eq!(before, -0.3);
    }

    /// Times at the rate of the packets, which the base expects 60 times a second.
    #[test]
    fn the_pose_takes_three_seconds_and_silence_half_a_second() {
        assert_eq!((1.0 / INTERVAL).round(), 60.0);
        let mut moog = Moog::default();
        moog.receive(&answer(0x3));
        let mut time = 0.0;
        while numbers(&moog.send(true, &values()).0)[2] > -0.3 {
            moog.receive(&answer(0x3));
            time += INTERVAL;
        }
        assert!((time - 3.0).abs() < 0.05, "{time} s");
        let mut silent = 0.0;
        while moog.send(true, &values()).1.is_none() {
            silent += INTERVAL;
        }
        assert!((silent - 0.5).abs() < 0.05, "{silent} s");
    }

    #[test]
    fn a_base_whose_answers_are_lost_gets_no_jump() {
        let mut moog = Moog::default();
        for _ in 0..200 {
            moog.receive(&answer(0x3));
            moog.send(true, &values());
        }
        let mut before = -0.3;
        let mut heaves = Vec::new();
        for k in 0..400 {
            // They come back after 2 s.
            if k > 120 {
                moog.receive(&answer(0x3));
            }
            let heave = numbers(&moog.send(true, &values()).0)[2];
            assert!((heave - before).abs() < 0.0026, "{before} {heave}");
            before = heave;
            heaves.push(heave);
        }
        assert!(heaves[120] > -0.2 && before == -0.3, "{heaves:?}");
    }

    #[test]
    fn faults_and_silence_are_reported_once() {
        let mut moog = Moog::default();
        assert_eq!(moog.receive(&answer(0x3)), None);
        assert_eq!(moog.receive(&answer(0x8)), Some(Event::Fault));
        assert_eq!(moog.receive(&answer(0x9)), None);
        assert_eq!(moog.receive(&answer(0x3)), None);
        assert_eq!(moog.receive(&answer(0x1)), Some(Event::Fault));
        let faults = (0..200).filter_map(|_| moog.send(true, &values()).1).count();
        assert_eq!((faults, moog.base()), (1, None));
        assert_eq!(moog.receive(&[0; 39]), None);
        // After a fault only a person makes it engage again.
        moog.receive(&answer(0x1));
        assert_eq!(command(&moog.send(true, &values()).0), 130);
        moog.start();
        assert_eq!(command(&moog.send(true, &values()).0), 180);
        assert_eq!(moog.receive(&[]), None);
    }
}
