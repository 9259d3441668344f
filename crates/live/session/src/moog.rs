//! The motion base MOOG 6DOF2000E by UDP: its packets, and the commands that its states need.
//!
//! | state | sent, if the base is wanted up | sent, if it is wanted down |
//! |---|---|---|
//! | power up | DOF mode, once the packets' pose is neutral | the same |
//! | idle | engage, once the packets' pose is neutral; after a fault only when the operator has started again | new position |
//! | standby | new position | park |
//! | engaged | new position | park |
//! | parking | new position | new position |
//! | a fault, disabled, inhibited | new position; a fault for the session | the same |
//!
//! A state counts once [`CONFIRMING_ANSWERS`] answers in a row have it: a single wrong answer
//! changes nothing. The base itself moves from its home to neutral. Then its pose fades in
//! from neutral, so that it does not matter how long that takes. In all other states it fades
//! out again, as the base may still follow. [`Moog::faded`] has that pose, and the lengths
//! that it asks of the legs. So the limits of the legs' frames hold for packets, too: nothing
//! changes a pose after them.
//!
//! A fault is reset by the operator at the base.
//!
//! Layout, commands and states are those of two public programs for this base. No base has verified
//! them.

use moris_washout::Rig;
use moris_washout::interface::RollPitchYaw;
use moris_washout::motion::orientation::Orientation;
use moris_washout::platform::{Geometry, Pose, leg_lengths};
use nalgebra::Vector3;

use crate::frame::Values;
use crate::transitions::Event;

/// Name among the frames.
pub const FRAME_NAME: &str = "moog-6dof2000e";
/// Description, a sentence.
pub const FRAME_DESCRIPTION: &str = "Motion base MOOG 6DOF2000E by UDP, which answers with its state";
/// Time between packets \[s\].
pub const PACKET_INTERVAL: f64 = 1.0 / 60.0;
/// Packets for which the pose fades in or out: 3 s.
const FADE_PACKETS: u32 = 180;
/// Equal answers in a row with which a state counts: 50 ms.
pub const CONFIRMING_ANSWERS: u32 = 3;
/// Length of a packet \[bytes\].
const PACKET_LENGTH: usize = 32;

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
        // Length of an answer [bytes].
        const ANSWER_LENGTH: usize = 40;
        let word = answer.get(8..12).filter(|_| answer.len() == ANSWER_LENGTH)?;
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moog {
    geometry: Geometry,
    /// Height of neutral in the geometry \[m\].
    neutral_height: f64,
    base: Option<Base>,
    /// State of the last answers, and how many have it.
    answered: Option<(Base, u32)>,
    /// Packets sent since an answer has confirmed a state.
    unanswered: u32,
    /// Packets of the fade that have passed.
    faded_packets: u32,
    /// After a fault the base is not engaged until the operator starts it again.
    waits: bool,
}

impl Moog {
    /// A base with the geometry of this rig.
    pub fn new(rig: &Rig) -> Self {
        Moog {
            geometry: Geometry::from(rig),
            neutral_height: rig.neutral_height,
            base: None,
            answered: None,
            unanswered: 0,
            faded_packets: 0,
            waits: false,
        }
    }

    /// The operator starts the base.
    pub fn start(&mut self) {
        self.waits = false;
    }

    /// Takes an answer. A fault, if the base has failed or left its state by itself, as
    /// [`CONFIRMING_ANSWERS`] say.
    pub fn receive(&mut self, answer: &[u8]) -> Option<Event> {
        let base = Base::of(answer)?;
        let count = self.answered.filter(|(last, _)| *last == base).map_or(1, |(_, count)| count.saturating_add(1));
        self.answered = Some((base, count));
        if count < CONFIRMING_ANSWERS && self.base != Some(base) {
            return None;
        }
        self.unanswered = 0;
        let before = self.base.replace(base);
        // A base that leaves its state by itself is no longer where the session thinks it is.
        let has_left = before == Some(Base::Engaged) && !matches!(base, Base::Engaged | Base::Parking);
        let has_failed = base == Base::Failed && before != Some(Base::Failed);
        self.waits |= has_left || has_failed;
        (has_left || has_failed).then_some(Event::Fault)
    }

    /// The values of the next packet: this part of the pose, and the lengths of the legs for it.
    pub fn faded(&self, values: &Values) -> Values {
        let part = f64::from(self.faded_packets) / f64::from(FADE_PACKETS);
        let part = part * part * (3.0 - 2.0 * part);
        let mut faded = *values;
        faded.pose = values.pose.map(|number| part * number);
        faded.heave_above = part * values.heave_above;
        faded.velocity = values.velocity.map(|speed| part * speed);
        let [x, y, _, roll, pitch, yaw] = faded.pose;
        let pose = Pose {
            position: Vector3::new(x, y, self.neutral_height + faded.heave_above),
            orientation: Orientation::new(RollPitchYaw::new(roll, pitch, yaw)),
        };
        faded.length = leg_lengths(&self.geometry, &pose);
        faded
    }

    /// The next packet, and a fault if the base is silent. `is_up`: the base is wanted at neutral
    /// or moving. The values are those of [`Moog::faded`] within the limits of the legs.
    pub fn send(&mut self, is_up: bool, values: &Values) -> ([u8; PACKET_LENGTH], Option<Event>) {
        // Packets without an answer that confirms a state, after which the base counts as lost: 0.5
        // s.
        const ANSWER_TIMEOUT_PACKETS: u32 = 30;
        // Largest number of a packet's pose that counts as neutral [m, rad].
        const NEUTRAL_TOLERANCE: f64 = 1e-4;
        self.unanswered = self.unanswered.saturating_add(1);
        let silent = self.unanswered == ANSWER_TIMEOUT_PACKETS;
        if silent {
            (self.base, self.answered, self.waits) = (None, None, true);
        }
        let is_neutral = pose_numbers(values).iter().all(|number| number.abs() < NEUTRAL_TOLERANCE);
        let command = match (self.base, is_up) {
            (Some(Base::PowerUp), _) if is_neutral => Command::DofMode,
            (Some(Base::Idle), true) if is_neutral && !self.waits => Command::Engage,
            (Some(Base::Standby | Base::Engaged), false) => Command::Park,
            _ => Command::NewPosition,
        };
        // A base that follows no more, as its answers say, may follow all the same.
        self.faded_packets = if self.base == Some(Base::Engaged) && is_up {
            (self.faded_packets + 1).min(FADE_PACKETS)
        } else {
            self.faded_packets.saturating_sub(1)
        };
        (packet(command, values), silent.then_some(Event::Fault))
    }

    /// The packet at the end: home, under power, from the last packet's pose.
    pub fn last(values: &Values) -> [u8; PACKET_LENGTH] {
        packet(Command::Park, values)
    }
}

/// The numbers of a packet: roll, pitch, heave, surge, yaw and lateral. The base has x forward, y
/// right, z down.
fn pose_numbers(values: &Values) -> [f64; 6] {
    let [x, y, _, roll, pitch, yaw] = values.pose;
    [roll, -pitch, -values.heave_above, x, -yaw, -y]
}

fn packet(command: Command, values: &Values) -> [u8; PACKET_LENGTH] {
    let mut packet = [0; PACKET_LENGTH];
    packet[..4].copy_from_slice(&(command as u32).to_be_bytes());
    for (place, value) in packet[4..28].chunks_exact_mut(4).zip(pose_numbers(values)) {
        // Zero of either sign is neutral.
        place.copy_from_slice(&(value as f32 + 0.0).to_be_bytes());
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

    fn base() -> Moog {
        Moog::new(&Rig::default())
    }

    fn values() -> Values {
        Values { pose: [0.1, 0.2, 9.0, 0.01, 0.02, 0.03], heave_above: 0.3, ..Values::default() }
    }

    /// As many answers as confirm a state: what they cause.
    fn confirm(moog: &mut Moog, state: u8) -> Option<Event> {
        (0..CONFIRMING_ANSWERS).fold(None, |event, _| moog.receive(&answer(state)).or(event))
    }

    fn sent(moog: &mut Moog, is_up: bool) -> [u8; PACKET_LENGTH] {
        let faded = moog.faded(&values());
        moog.send(is_up, &faded).0
    }

    fn heave(moog: &mut Moog) -> f32 {
        numbers(&sent(moog, true))[2]
    }

    fn command(packet: &[u8]) -> u32 {
        u32::from_be_bytes(packet[..4].try_into().unwrap())
    }

    fn numbers(packet: &[u8]) -> Vec<f32> {
        packet[4..28].chunks(4).map(|bytes| f32::from_be_bytes(bytes.try_into().unwrap())).collect()
    }

    #[test]
    fn a_packet_has_the_layout_of_the_base() {
        let packet = packet(Command::NewPosition, &values());
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
                let mut moog = base();
                confirm(&mut moog, state);
                let packet = sent(&mut moog, is_up);
                assert_eq!(command(&packet), expected, "{state:#x} {is_up}");
                assert!(numbers(&packet).iter().all(|number| *number == 0.0), "{state:#x}");
            }
        }
    }

    /// The lengths of a pose on the default rig, from the formula of the inverse kinematics.
    #[test]
    fn the_lengths_are_those_of_the_faded_pose() {
        let mut moog = base();
        confirm(&mut moog, 0x3);
        for _ in 0..FADE_PACKETS {
            confirm(&mut moog, 0x3);
            sent(&mut moog, true);
        }
        let rig = Rig::default();
        let faded = moog.faded(&values());
        let pose = Pose {
            position: Vector3::new(0.1, 0.2, rig.neutral_height + 0.3),
            orientation: Orientation::new(RollPitchYaw::new(0.01, 0.02, 0.03)),
        };
        assert_eq!(faded.length, leg_lengths(&Geometry::from(&rig), &pose));
        assert_eq!(base().faded(&values()).length, leg_lengths(&Geometry::from(&rig), &Pose::neutral(&rig)));
    }

    #[test]
    fn the_pose_fades_in_once_the_base_is_engaged() {
        let mut moog = base();
        let mut before = 0.0;
        for _ in 0..183 {
            moog.receive(&answer(0x3));
            let heave = heave(&mut moog);
            // At most 0.15 m/s for 0.3 m.
            assert!((0.0..0.0026).contains(&(before - heave)), "{before} {heave}");
            before = heave;
        }
        assert_eq!(before, -0.3);
    }

    /// Times at the rate of the packets, which the base expects 60 times a second.
    #[test]
    fn the_pose_takes_three_seconds_and_silence_half_a_second() {
        assert_eq!((1.0 / PACKET_INTERVAL).round(), 60.0);
        let mut moog = base();
        confirm(&mut moog, 0x3);
        let mut time = 0.0;
        while heave(&mut moog) > -0.3 {
            moog.receive(&answer(0x3));
            time += PACKET_INTERVAL;
        }
        assert!((time - 3.0).abs() < 0.05, "{time} s");
        let mut silent = 0.0;
        while moog.send(true, &values()).1.is_none() {
            silent += PACKET_INTERVAL;
        }
        assert!((silent - 0.5).abs() < 0.05, "{silent} s");
    }

    /// Whatever the base answers, no packet is far from the one before it: at most 0.15 m/s.
    fn assert_no_jump(before: &mut f32, heave: f32) {
        assert!((heave - *before).abs() < 0.0026, "{before} {heave}");
        *before = heave;
    }

    #[test]
    fn a_base_whose_answers_are_lost_gets_no_jump() {
        let mut moog = base();
        let mut before = 0.0;
        for _ in 0..200 {
            moog.receive(&answer(0x3));
            assert_no_jump(&mut before, heave(&mut moog));
        }
        let mut heaves = Vec::new();
        for k in 0..400 {
            // They come back after 2 s.
            if k > 120 {
                moog.receive(&answer(0x3));
            }
            assert_no_jump(&mut before, heave(&mut moog));
            heaves.push(before);
        }
        assert!(heaves[120] > -0.2 && before == -0.3, "{heaves:?}");
    }

    /// One wrong answer at each moment of the fade and after it, and two alike.
    #[test]
    fn a_single_wrong_answer_changes_nothing() {
        for wrong in (0x0..=0xF).filter(|state| *state != 0x3) {
            for moment in (3..240).step_by(13) {
                for count in 1..CONFIRMING_ANSWERS {
                    let (mut moog, mut right) = (base(), base());
                    for k in 0..260 {
                        let is_wrong = (moment..moment + count).contains(&k);
                        let event = moog.receive(&answer(if is_wrong { wrong } else { 0x3 }));
                        right.receive(&answer(0x3));
                        assert_eq!(event, None, "{wrong:#x}");
                        assert_eq!(sent(&mut moog, true), sent(&mut right, true), "{wrong:#x} at {moment}");
                    }
                }
            }
        }
    }

    /// A base that really leaves its state: the pose fades out, and no mode command precedes that.
    #[test]
    fn every_other_state_fades_the_pose_out() {
        for state in (0x0..=0xF).filter(|state| *state != 0x3) {
            let (mut moog, mut before) = (base(), 0.0);
            for _ in 0..200 {
                moog.receive(&answer(0x3));
                assert_no_jump(&mut before, heave(&mut moog));
            }
            assert_eq!(before, -0.3);
            let mut events = Vec::new();
            for _ in 0..200 {
                events.extend(moog.receive(&answer(state)));
                let packet = sent(&mut moog, true);
                assert!(command(&packet) == 130 || numbers(&packet).iter().all(|number| number.abs() < 1e-3));
                assert_no_jump(&mut before, numbers(&packet)[2]);
            }
            assert_eq!(before, 0.0, "{state:#x}");
            // Parking is what the operator asks for at the base.
            assert_eq!(events.len(), usize::from(state != 0x7), "{state:#x}");
        }
    }

    /// Answers that never agree are no answers.
    #[test]
    fn answers_that_change_each_time_are_silence() {
        let mut moog = base();
        confirm(&mut moog, 0x3);
        let mut faults = 0;
        for k in 0..60 {
            moog.receive(&answer(if k % 2 == 0 { 0x1 } else { 0x8 }));
            faults += usize::from(moog.send(true, &values()).1.is_some());
        }
        assert_eq!((faults, moog.base), (1, None));
    }

    #[test]
    fn faults_and_silence_are_reported_once() {
        let mut moog = base();
        assert_eq!(confirm(&mut moog, 0x3), None);
        assert_eq!(confirm(&mut moog, 0x8), Some(Event::Fault));
        assert_eq!(confirm(&mut moog, 0x9), None);
        assert_eq!(confirm(&mut moog, 0x3), None);
        assert_eq!(confirm(&mut moog, 0x1), Some(Event::Fault));
        let faults = (0..200).filter_map(|_| moog.send(true, &Values::default()).1).count();
        assert_eq!((faults, moog.base), (1, None));
        assert_eq!(moog.receive(&[0; 39]), None);
        // After a fault only the operator makes it engage again.
        confirm(&mut moog, 0x1);
        assert_eq!(command(&sent(&mut moog, true)), 130);
        moog.start();
        assert_eq!(command(&sent(&mut moog, true)), 180);
        assert_eq!(moog.receive(&[]), None);
    }

    #[test]
    fn the_last_packet_has_the_pose_of_the_one_before_it() {
        let packet = Moog::last(&values());
        assert_eq!(command(&packet), 210);
        assert_eq!(numbers(&packet), [0.01, -0.02, -0.3, 0.1, -0.03, -0.2]);
    }
}
