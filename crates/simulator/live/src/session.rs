//! The whole: telemetry and events in, commands to the actuators out.

use moris_interface::{Group, Reader, Writer, slots_of};
use moris_washout::interface::{AngularVelocityFrame, Output};
use moris_washout::motion::orientation::Orientation;
use moris_washout::platform::{Geometry, Pose, forward_kinematics};
use moris_washout::{ParameterError, Parameters, Washout};
use serde::{Deserialize, Serialize};

use crate::gate::{Change, Gate};
use crate::motion::{Channels, Motion, Sample};
use crate::resampler::{At, Resampler};
use crate::signs::{Check, Signs};
use crate::source::{Health, Source};
use crate::transitions::{Event, State};
use crate::travel::Travel;

/// Length of a step \[s\].
pub const STEP: f64 = 0.001;
/// A leg is at neutral within this part of its stroke, at this part of it per second. A slow
/// wash-out of the yaw goes on for long.
const AT_NEUTRAL: [f64; 2] = [0.03, 0.01];
/// Least time of engaging \[s\], also where the washout has stayed engaged through a pause.
const LEAST_ENGAGING: f64 = 4.0;
/// Part of the way to neutral that is too short to change a pose.
const NO_WAY: f64 = 1e-9;
/// Glide after a gap: twice its length, within these \[s\].
const GAP_GLIDE: [f64; 2] = [0.1, 1.0];

/// Settings of a session.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Delay of the telemetry \[s\]; none: as short as its gaps permit.
    pub delay: Option<f64>,
    /// Part of the stroke at which the legs are at the settled pose.
    pub settled: f64,
    /// Largest speed of a leg on the way to neutral and down \[m/s\].
    pub travel_speed: f64,
    /// Engage although the telemetry's signs contradict each other.
    pub ignore_signs: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { delay: None, settled: 0.02, travel_speed: 0.15, ignore_signs: false }
    }
}

/// Reason for which an event of a person is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The event does nothing in this state.
    #[error("{} does nothing in the state {}", .0.name(), .1.name())]
    State(Event, State),
    /// The source does not run.
    #[error("engage needs telemetry of a running vehicle; the source is {}", .0.name())]
    Source(Health),
    /// The signs contradict each other.
    #[error("the telemetry contradicts itself, expected: {}", .0.text())]
    Signs(Check),
}

/// Commands after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commands {
    /// The state.
    pub state: State,
    /// Time since the session's start \[s\].
    pub time: f64,
    /// Lengths of the actuators \[m\].
    pub length: [f64; 6],
    /// Their velocities \[m/s\].
    pub velocity: [f64; 6],
    /// Pose of the platform.
    pub pose: Pose,
    /// Its height above neutral \[m\].
    pub heave: f64,
    /// All outputs of the washout. Lengths and pose there leave out the way between the lowest pose
    /// and neutral.
    pub washout: Output,
}

/// Puts parameters in force, as [`Session::retune`] in this state.
///
/// # Errors
/// As there.
pub fn retune(washout: &mut Washout, parameters: &Parameters, state: State) -> Result<(), ParameterError> {
    washout.retune(parameters).or_else(|reason| {
        let before = washout.parameters();
        let is_fitting = parameters.rig == before.rig
            && parameters.conditioning.angular_velocity_frame == before.conditioning.angular_velocity_frame;
        if !is_fitting || !matches!(state, State::Off | State::Settled) {
            return Err(reason);
        }
        *washout = Washout::new(parameters)?.starting_with(&Motion::at_rest().input(false));
        Ok(())
    })
}

/// The pose with these lengths of the legs, at this part of the way to the washout's pose; that
/// pose if no other is found.
fn pose_between(geometry: &Geometry, output: &Output, length: &[f64; 6], part: f64) -> Pose {
    let above = Pose { position: output.position, orientation: Orientation::new(output.orientation) };
    if 1.0 - part < NO_WAY { above } else { forward_kinematics(geometry, length, &above).unwrap_or(above) }
}

/// The washout beside a running vehicle. A step allocates nothing.
#[derive(Clone, Debug)]
pub struct Session {
    settings: Settings,
    washout: Washout,
    geometry: Geometry,
    /// The parameters' values, with those that [`Session::retune`] will put in force.
    slots: Vec<f64>,
    state: State,
    steps: u64,
    /// Step at which the state began.
    since: u64,
    source: Source,
    resampler: Resampler,
    signs: Signs,
    /// Delay of the telemetry \[s\].
    delay: f64,
    /// Time from which on the last step's telemetry was held \[s\].
    held_from: Option<f64>,
    gate: Gate,
    /// The source has changed since the last step.
    changed: bool,
    travel: Travel,
    travel_rate: f64,
    goes_up: bool,
    settled: [f64; 6],
    neutral: [f64; 6],
    stroke: f64,
    commands: Commands,
}

impl Session {
    /// A session in the state off. Angular velocities of telemetry are the body's.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    pub fn new(parameters: &Parameters, settings: &Settings) -> Result<Self, ParameterError> {
        let mut parameters = *parameters;
        parameters.conditioning.angular_velocity_frame = AngularVelocityFrame::Body;
        let at_rest = Motion::at_rest();
        let washout = Washout::new(&parameters)?.starting_with(&at_rest.input(false));
        let output = washout.output();
        let rig = &parameters.rig;
        let part = settings.settled.clamp(0.0, 1.0);
        let settled = [rig.min_length + part * (rig.max_length - rig.min_length); 6];
        let way = output.length.iter().zip(settled).map(|(neutral, settled)| (neutral - settled).abs());
        let speed = settings.travel_speed.min(0.25 * rig.velocity_limit);
        let geometry = Geometry::from(rig);
        let pose = pose_between(&geometry, &output, &settled, 0.0);
        let heave = pose.position.z - rig.neutral_height;
        let commands = Commands {
            state: State::Off,
            time: 0.0,
            length: settled,
            velocity: [0.0; 6],
            pose,
            heave,
            washout: output,
        };
        Ok(Session {
            geometry,
            settings: *settings,
            slots: slots_of(&parameters),
            state: State::Off,
            steps: 0,
            since: 0,
            source: Source::default(),
            resampler: Resampler::default(),
            signs: Signs::default(),
            delay: settings.delay.unwrap_or_default(),
            held_from: None,
            gate: Gate::default(),
            changed: false,
            travel: Travel::default(),
            travel_rate: Travel::rate(way.fold(0.0, f64::max), speed),
            goes_up: false,
            settled,
            neutral: output.length,
            stroke: rig.max_length - rig.min_length,
            commands,
            washout,
        })
    }

    /// The time \[s\].
    pub fn time(&self) -> f64 {
        self.steps as f64 * STEP
    }

    /// The state.
    pub fn state(&self) -> State {
        self.state
    }

    /// The source of telemetry.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The test of the signs.
    pub fn signs(&self) -> &Signs {
        &self.signs
    }

    /// The delay of the telemetry \[s\].
    pub fn delay(&self) -> f64 {
        self.delay
    }

    /// The vehicle's motion that the washout has received last.
    pub fn passed(&self) -> &Motion {
        self.gate.output()
    }

    /// The washout.
    pub fn washout(&self) -> &Washout {
        &self.washout
    }

    /// Chooses a value of a parameter by its slot, for [`Session::retune`].
    pub fn choose(&mut self, slot: usize, value: f64) {
        if let Some(chosen) = self.slots.get_mut(slot) {
            *chosen = value;
        }
    }

    /// Puts the chosen parameters in force. Tunable ones change at any time, without a jump. Fixed
    /// ones, such as the strategy, change while the platform is at its lowest pose; those of the
    /// rig never.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why. Nothing has changed then.
    pub fn retune(&mut self) -> Result<(), ParameterError> {
        let parameters = Parameters::read(&mut Reader::new(&self.slots));
        let retuned = retune(&mut self.washout, &parameters, self.state);
        if retuned.is_err() {
            self.washout.parameters().write(&mut Writer::new(&mut self.slots));
        }
        retuned
    }

    /// The commands of the last step.
    pub fn commands(&self) -> &Commands {
        &self.commands
    }

    /// An event of a person or of the device.
    ///
    /// # Errors
    /// The reason for which it has no effect.
    pub fn handle(&mut self, event: Event) -> Result<(), Refusal> {
        let next = self.state.after(event);
        if event.is_external() && next == self.state && event != Event::Fault {
            return Err(Refusal::State(event, self.state));
        }
        if event == Event::Engage {
            if self.source.health() != Health::Running {
                return Err(Refusal::Source(self.source.health()));
            }
            if let Some(check) = self.signs.contradiction().filter(|_| !self.settings.ignore_signs) {
                return Err(Refusal::Signs(check));
            }
        }
        self.enter(next, event);
        Ok(())
    }

    /// The transition of an event, without a person's guards.
    fn enter(&mut self, next: State, event: Event) {
        let before = self.state;
        self.changed |= before.follows_telemetry() != next.follows_telemetry();
        self.changed |= event == Event::Teleport;
        if next != before {
            self.state = next;
            self.since = self.steps;
        }
        match next {
            State::Off => {
                self.goes_up = false;
                self.travel.settle();
            }
            State::Settled | State::Fault => (),
            // Parking goes down once it is at neutral.
            State::Parking => (),
            _ => self.goes_up = true,
        }
    }

    fn follow(&mut self, event: Event) {
        self.enter(self.state.after(event), event);
    }

    /// A sample of telemetry that arrived at this time of the session \[s\].
    pub fn receive(&mut self, arrival: f64, sample: &Sample) {
        let accepted = self.source.receive(arrival, sample);
        if accepted.is_new {
            self.resampler.clear();
            self.held_from = None;
            self.changed = true;
        }
        if let Some(time) = accepted.time {
            self.resampler.push(arrival, time, sample.motion);
            self.signs.take(time, sample);
        }
        for event in accepted.events.into_iter().flatten() {
            self.follow(event);
        }
    }

    /// Advances by [`STEP`].
    pub fn step(&mut self) -> &Commands {
        self.steps += 1;
        let now = self.time();
        if let Some(event) = self.source.listen(now) {
            self.follow(event);
        }
        if !self.settings.ignore_signs && self.state.is_engaged() && self.signs.contradiction().is_some() {
            self.follow(Event::Disengage);
        }
        if !self.state.is_engaged() {
            self.delay = self.settings.delay.unwrap_or_else(|| self.resampler.delay());
        }
        let (at, change) = self.input(now);
        let [start, end] = self.gate.advance(&at.motion, &at.slope, change, STEP);
        let engaged = self.state.is_engaged();
        self.washout.step_between(&start.input(engaged), &end.input(engaged), STEP);
        let output = self.washout.output();
        self.travel.advance(self.goes_up, self.travel_rate, STEP);
        self.arrive(&output);
        self.command(now, output);
        &self.commands
    }

    /// The washout's source at the step's end.
    fn input(&mut self, now: f64) -> (At, Change) {
        let rest = At { motion: Motion::at_rest(), slope: Channels::zeros(), held_from: None };
        let follows = self.state.follows_telemetry();
        let at = self.resampler.at(now - self.delay).filter(|_| follows).unwrap_or(rest);
        let gap = self.held_from.filter(|from| at.held_from != Some(*from));
        let change = if std::mem::take(&mut self.changed) {
            Change::Source
        } else if let Some(from) = gap {
            Change::Gap((2.0 * (now - self.delay - from)).clamp(GAP_GLIDE[0], GAP_GLIDE[1]))
        } else {
            Change::None
        };
        self.held_from = at.held_from;
        (at, change)
    }

    /// The transition that follows if the state's own motion is complete.
    fn arrive(&mut self, output: &Output) {
        let faded = self.washout.engagement() == 0.0;
        let [distance, speed] = AT_NEUTRAL.map(|part| part * self.stroke);
        let near =
            |k: usize| (output.length[k] - self.neutral[k]).abs() < distance && output.leg_velocity[k].abs() < speed;
        let at_neutral = (0..6).all(near);
        let arrived = match self.state {
            State::Homing => at_neutral && self.travel.is_up(),
            State::Engaging => {
                let lasts = (self.steps - self.since) as f64 * STEP >= LEAST_ENGAGING;
                lasts && self.washout.engagement() == 1.0 && self.gate.is_open()
            }
            State::Disengaging => faded && at_neutral,
            State::Parking => {
                self.goes_up &= !(faded && at_neutral);
                !self.goes_up && self.travel.is_down()
            }
            _ => false,
        };
        if arrived {
            self.follow(Event::Arrived);
        }
    }

    fn command(&mut self, now: f64, output: Output) {
        let part = self.travel.fraction();
        let before = self.commands.length;
        let length = std::array::from_fn(|k| self.settled[k] + part * (output.length[k] - self.settled[k]));
        let velocity = std::array::from_fn(|k| (length[k] - before[k]) / STEP);
        let pose = pose_between(&self.geometry, &output, &length, part);
        let heave = pose.position.z - self.washout.parameters().rig.neutral_height;
        self.commands = Commands { state: self.state, time: now, length, velocity, pose, heave, washout: output };
    }
}
