//! Telemetry of a computed vehicle, delivered at given times, and what is felt.

use moris_live::{Event, STEP, Sample, Session, Settings, State};
use moris_simulation::measures::comfort::comfort;
use moris_washout::Parameters;

/// A packet: when it arrives, and its content.
pub struct Packet {
    pub arrival: f64,
    pub sample: Sample,
}

/// Packets 100 times a second, changed by `change`; none: lost.
pub fn packets(duration: f64, mut change: impl FnMut(f64) -> Option<Packet>) -> Vec<Packet> {
    let mut all: Vec<Packet> = (0..(duration * 100.0) as usize).filter_map(|k| change(k as f64 * 0.01)).collect();
    all.sort_by(|one, other| one.arrival.total_cmp(&other.arrival));
    all
}

/// Course of a session.
#[derive(Default)]
pub struct Course {
    pub states: Vec<(f64, State)>,
    /// Felt force of each axis, from the time on at which the vehicle's motion begins.
    pub felt: [Vec<f64>; 3],
    pub length: Vec<[f64; 6]>,
    pub delay: Vec<f64>,
}

impl Course {
    /// Largest change of the felt force within 20 ms beyond the input's, from a time on \[m/s2\].
    pub fn jolt(&self, from: f64, to: f64) -> f64 {
        let range = (from / STEP) as usize..((to / STEP) as usize).min(self.felt[0].len());
        let jolt = |felt: &Vec<f64>| {
            let felt = &felt[range.clone()];
            comfort(&vec![0.0; felt.len()], felt, 0.0, STEP).values()[1]
        };
        self.felt.iter().map(jolt).fold(0.0, f64::max)
    }

    /// Number of times that this state began.
    pub fn begins(&self, state: State) -> usize {
        self.states.iter().filter(|(_, found)| *found == state).count()
    }
}

/// Steps a session with these packets, and engages it once it is at neutral. `act` may do more
/// before each step.
pub fn course(
    parameters: &Parameters,
    settings: &Settings,
    packets: &[Packet],
    duration: f64,
    mut act: impl FnMut(&mut Session),
) -> (Session, Course) {
    let mut session = Session::new(parameters, settings).unwrap();
    let mut course = Course::default();
    let mut next = 0;
    let mut slipped = 0.0;
    session.handle(Event::Start).unwrap();
    let mut engages = true;
    for _ in 0..(duration / STEP) as usize {
        while next < packets.len() && packets[next].arrival - slipped <= session.time() {
            session.receive(packets[next].arrival - slipped, &packets[next].sample);
            next += 1;
        }
        if engages && session.state() == State::Neutral {
            engages = session.handle(Event::Engage).is_err();
        }
        let before = session.time();
        act(&mut session);
        slipped += session.time() - before;
        let commands = *session.step();
        if course.states.last().is_none_or(|(_, state)| *state != commands.state) {
            course.states.push((commands.time, commands.state));
        }
        let felt = commands.washout.felt_specific_force;
        course.felt.iter_mut().zip(felt.iter()).for_each(|(axis, value)| axis.push(*value));
        course.length.push(commands.length);
        course.delay.push(session.delay());
    }
    (session, course)
}
