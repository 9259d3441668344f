//! The whole: telemetry and events in, commands to the actuators out.

use moris_interface::{Group, Reader, slots_of};
use moris_laps::Laps;
use moris_washout::interface::{AngularVelocityFrame, Output};
use moris_washout::motion::orientation::Orientation;
use moris_washout::platform::{Geometry, Pose, forward_kinematics};
use moris_washout::{ParameterError, Parameters, Washout};
use serde::{Deserialize, Serialize};

use crate::gliding_source::{Change, GlidingSource};
use crate::legs::{Legs, lengths_within, lowest};
use crate::motion::{Channels, Motion, Sample};
use crate::resampler::{At, Resampler};
use crate::road::Road;
use crate::signs::{Check, Signs};
use crate::source::{Health, Source};
use crate::table_check::{TableCheck, TableFault};
use crate::transitions::{Event, State};
use crate::travel::Travel;
use crate::tuning::{self, Tuning};

/// Length of a step \[s\].
pub const STEP: f64 = 0.001;

/// Settings of a session.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Delay of the telemetry \[s\]; none: as short as its gaps permit.
    pub delay: Option<f64>,
    /// True if the source of telemetry runs inside the program. The delay does not follow from the
    /// gaps that a computer causes, and is zero if its samples come before their time.
    pub is_inside: bool,
    /// True if the legs are at the settled pose at first. Otherwise their place is unknown until
    /// [`Session::locate`].
    pub starts_settled: bool,
    /// Speed of a leg that a controller can follow from any place \[m/s\]: [`Legs::Slow`].
    pub slow_speed: f64,
    /// Engage although the telemetry contradicts itself or its table.
    pub ignore_signs: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { delay: None, is_inside: false, starts_settled: true, slow_speed: 0.02, ignore_signs: false }
    }
}

/// Reason for which telemetry is not cued.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TelemetryFault {
    /// The signs contradict each other.
    #[error("WRONG SIGN: {}. Not engaging until then, except with --ignore-signs", .0.remedy())]
    Sign(Check),
    /// A unit, an axis or the gravity of the table does not fit.
    #[error("WRONG TABLE: {0}. Not engaging until then, except with --ignore-signs")]
    Table(TableFault),
}

/// Reason for which an event of the operator is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The event does nothing in this state.
    #[error("{} does nothing in the state {}", .0.name(), .1.name())]
    State(Event, State),
    /// The source does not run.
    #[error("engage needs telemetry of a running vehicle; the source is {}", .0.name())]
    Source(Health),
    /// The telemetry contradicts itself or its table.
    #[error("{0}")]
    Telemetry(TelemetryFault),
    /// The place of the legs is unknown.
    #[error(
        "{} needs the legs' place, which is unknown: let the controller report it, confirm that the platform is \
         settled, or start slowly", .0.name()
    )]
    Unknown(Event),
    /// The legs' place is given while they follow commands.
    #[error("the legs follow commands in the state {}; their place is given in the state off", .0.name())]
    Commanded(State),
    /// A reported position is none of this rig.
    #[error(
        "actuator {} is reported at {position} {unit}, which is outside its stroke from {least} to {greatest} {unit}; \
         check the report's unit and the rig file", .leg + 1
    )]
    Position {
        /// The actuator, from 0.
        leg: usize,
        /// The reported length, or the angle of the arm.
        position: f64,
        /// The shortest length, or the lowest angle.
        least: f64,
        /// The longest length, or the highest angle.
        greatest: f64,
        /// Unit of the three: m for legs, degrees for cranks.
        unit: &'static str,
    },
}

/// Commands after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commands {
    /// The state.
    pub state: State,
    /// Time since the session's start \[s\].
    pub time: f64,
    /// Lengths of the actuators, or arcs of the cranks' arms above level \[m\].
    pub length: [f64; 6],
    /// Rates of the lengths \[m/s\].
    pub velocity: [f64; 6],
    /// Pose of the platform.
    pub pose: Pose,
    /// Height of the pose above neutral \[m\].
    pub heave: f64,
    /// All outputs of the washout. Lengths and pose there leave out the way between the lowest pose
    /// and neutral.
    pub washout: Output,
}

/// True if parameters may change at once: the platform does not follow the washout.
fn is_down(state: State) -> bool {
    matches!(state, State::Off | State::Settled)
}

/// Puts parameters in force, as [`Session::retune`] in this state, but at once.
///
/// # Errors
/// As there.
pub fn retune(washout: &mut Washout, parameters: &Parameters, state: State) -> Result<(), ParameterError> {
    if !is_down(state) {
        tuning::check_in_motion(&slots_of(washout.parameters()), &slots_of(parameters))?;
    }
    washout.retune(parameters).or_else(|reason| {
        let before = washout.parameters();
        let is_fitting = parameters.rig == before.rig
            && parameters.conditioning.angular_velocity_frame == before.conditioning.angular_velocity_frame;
        if !is_fitting || !is_down(state) {
            return Err(reason);
        }
        *washout = Washout::new(parameters)?.starting_with(&Motion::at_rest().input(false));
        Ok(())
    })
}

/// The pose with these lengths of the legs, at this part of the way to the washout's pose. The
/// result is that pose if no other is found from there or from the one before.
fn pose_between(geometry: &Geometry, output: &Output, length: &[f64; 6], part: f64, before: &Pose) -> Pose {
    // Part of the way to neutral that is too short to change a pose.
    const NO_WAY: f64 = 1e-9;
    let above = own_pose(output);
    if 1.0 - part < NO_WAY {
        return above;
    }
    forward_kinematics(geometry, length, before)
        .or_else(|_| forward_kinematics(geometry, length, &above))
        .unwrap_or(above)
}

/// The washout's pose.
fn own_pose(output: &Output) -> Pose {
    Pose { position: output.position, orientation: Orientation::new(output.orientation) }
}

/// True if the source has gone on from its motion a step ago as its slopes say.
fn passes((motion, slope): &(Motion, Channels), at: &At) -> bool {
    // Part by which a source may change faster within a step than its slope says.
    const SLOPE_TOLERANCE: f64 = 0.1;
    let change = at.motion.0 - motion.0;
    let most = (slope.abs()).sup(&at.slope.abs()) * (1.0 + SLOPE_TOLERANCE) * STEP;
    change.iter().zip(&most).all(|(change, most)| change.abs() <= most + 1e-9)
}

/// The washout beside a running vehicle. A step allocates nothing.
#[derive(Clone, Debug)]
pub struct Session {
    settings: Settings,
    washout: Washout,
    geometry: Geometry,
    /// The parameters' values, with those that [`Session::retune`] will put in force.
    slots: Vec<f64>,
    tuning: Tuning,
    state: State,
    steps: u64,
    /// Step at which the state began.
    since: u64,
    source: Source,
    resampler: Resampler,
    signs: Signs,
    table_check: TableCheck,
    /// Delay of the telemetry \[s\].
    delay: f64,
    /// Time from which on the last step's telemetry was held \[s\].
    held_from: Option<f64>,
    /// The source's motion and slope at the last step.
    last: Option<(Motion, Channels)>,
    gliding_source: GlidingSource,
    /// None if no road is learned.
    road: Option<Road>,
    /// The source has changed since the last step.
    changed: bool,
    /// Time by which the clock has slipped since the last step \[s\].
    slipped: f64,
    travel: Travel,
    /// Part of the way in a step.
    travel_part: f64,
    goes_up: bool,
    /// Steps to wait at the way's beginning before it goes up.
    holds: u64,
    /// The way up waits for the washout to be at neutral.
    waits: bool,
    /// True if the legs are where they are commanded to be.
    located: bool,
    /// The lengths at the beginning of the way to neutral.
    begin: [f64; 6],
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
        // Part of the stroke that the legs keep from their ends at the settled pose.
        const SETTLED_FRACTION: f64 = 0.02;
        let mut parameters = *parameters;
        parameters.conditioning.angular_velocity_frame = AngularVelocityFrame::Body;
        let at_rest = Motion::at_rest();
        let washout = Washout::new(&parameters)?.starting_with(&at_rest.input(false));
        let output = washout.output();
        let rig = &parameters.rig;
        let geometry = Geometry::from(rig);
        let settled = lowest(rig, &geometry, SETTLED_FRACTION);
        let commands = Commands {
            state: State::Off,
            time: 0.0,
            length: settled,
            velocity: [0.0; 6],
            pose: own_pose(&output),
            heave: 0.0,
            washout: output,
        };
        let mut session = Session {
            geometry,
            settings: *settings,
            slots: slots_of(&parameters),
            tuning: Tuning::new(&slots_of(&parameters)),
            state: State::Off,
            steps: 0,
            since: 0,
            source: Source::new(settings.is_inside),
            resampler: Resampler::default(),
            signs: Signs::default(),
            table_check: TableCheck::default(),
            delay: settings.delay.unwrap_or_default(),
            held_from: None,
            last: None,
            gliding_source: GlidingSource::default(),
            road: None,
            changed: false,
            slipped: 0.0,
            travel: Travel::default(),
            travel_part: 0.0,
            goes_up: false,
            holds: 0,
            waits: false,
            located: settings.starts_settled,
            begin: settled,
            settled,
            neutral: output.actuators(rig)[0],
            stroke: rig.stroke_length(),
            commands,
            washout,
        };
        session.begin_at(settled);
        session.place_legs(settled, [0.0; 6], 0.0);
        Ok(session)
    }

    /// The way to neutral begins at these lengths.
    fn begin_at(&mut self, lengths: [f64; 6]) {
        // Largest speed of a leg on the way to neutral and down [m/s].
        const TRAVEL_SPEED: f64 = 0.15;
        // Largest speed and acceleration of the legs on the way home, in those of the actuators.
        const HOMING_LIMIT_FRACTION: f64 = 0.25;
        let rig = &self.washout.parameters().rig;
        let [speed, acceleration] =
            [rig.velocity_limit, rig.acceleration_limit].map(|limit| HOMING_LIMIT_FRACTION * limit);
        let speed = TRAVEL_SPEED.min(speed).min(acceleration * Travel::SMOOTHING);
        let way = self.neutral.iter().zip(lengths).map(|(neutral, length)| (neutral - length).abs());
        self.begin = lengths;
        self.travel_part = speed * STEP / way.fold(1e-3, f64::max);
    }

    /// Time since the session's start \[s\].
    pub fn time(&self) -> f64 {
        self.steps as f64 * STEP
    }

    /// The state.
    pub fn state(&self) -> State {
        self.state
    }

    /// True if the legs are where [`Session::commands`] has them. Otherwise frames would move them
    /// there from an unknown place, and `start` and `clear` are refused.
    pub fn is_located(&self) -> bool {
        self.located
    }

    /// Way of the leg that is farthest with these lengths from the lowest pose \[m\].
    pub fn way_from_settled(&self, lengths: &[f64; 6]) -> f64 {
        lengths.iter().zip(self.settled).map(|(length, settled)| (length - settled).abs()).fold(0.0, f64::max)
    }

    /// The source of telemetry.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The test of the signs.
    pub fn signs(&self) -> &Signs {
        &self.signs
    }

    /// The reason for which the telemetry is not cued, whether or not the settings ignore it.
    pub fn telemetry_fault(&self) -> Option<TelemetryFault> {
        let pace = self.source.wrong_pace().map(TableFault::of_pace);
        let table = pace.or_else(|| self.table_check.fault()).map(TelemetryFault::Table);
        table.or_else(|| self.signs.contradiction().map(TelemetryFault::Sign))
    }

    /// The reason for which the telemetry lets nobody engage now.
    pub fn telemetry_refusal(&self) -> Option<Refusal> {
        let fault = self.telemetry_fault().filter(|_| !self.settings.ignore_signs).map(Refusal::Telemetry);
        let health = self.source.health();
        fault.or_else(|| (health != Health::Running).then_some(Refusal::Source(health)))
    }

    /// The parameters in force, or those to which they glide.
    pub fn target_parameters(&self) -> Parameters {
        Parameters::read(&mut Reader::new(self.tuning.target()))
    }

    /// The delay of the telemetry \[s\].
    pub fn delay(&self) -> f64 {
        self.delay
    }

    /// True if the delay is long enough to be noticed: [`LONG`](crate::resampler::WARNED_DELAY).
    pub fn is_delay_long(&self) -> bool {
        self.delay >= crate::resampler::WARNED_DELAY
    }

    /// The vehicle's motion that the washout has received last.
    pub fn passed(&self) -> &Motion {
        self.gliding_source.output()
    }

    /// Learns the road from here on. These laps of it are known.
    pub fn learn(&mut self, laps: Laps) {
        self.road = Some(Road::new(laps));
    }

    /// The road that is learned.
    pub fn road(&self) -> Option<&Road> {
        self.road.as_ref()
    }

    /// A copy that knows no road.
    pub fn without_road(&mut self) -> Session {
        let road = self.road.take();
        let copy = self.clone();
        self.road = road;
        copy
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

    /// Puts the chosen parameters in force. Tunable ones change at any time, within 2 s in motion.
    /// A scale keeps its sign there, and a pace is not switched on or off. Fixed ones, such as the
    /// strategy, change while the platform is at its lowest pose; those of the rig never.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why. Nothing has changed then.
    pub fn retune(&mut self) -> Result<(), ParameterError> {
        let parameters = Parameters::read(&mut Reader::new(&self.slots));
        let retuned = self.retune_to(&parameters);
        if retuned.is_err() {
            self.slots.copy_from_slice(self.tuning.target());
        }
        retuned
    }

    fn retune_to(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        if is_down(self.state) {
            retune(&mut self.washout, parameters, self.state)?;
            self.tuning.choose(&self.slots, false);
            return Ok(());
        }
        tuning::check_in_motion(self.tuning.target(), &self.slots)?;
        self.washout.clone().retune(parameters)?;
        self.tuning.choose(&self.slots, true);
        Ok(())
    }

    /// The commands of the last step.
    pub fn commands(&self) -> &Commands {
        &self.commands
    }

    /// An event of the operator or of the device.
    ///
    /// # Errors
    /// The reason for which it has no effect.
    pub fn handle(&mut self, event: Event) -> Result<(), Refusal> {
        let next = self.state.after(event);
        if event.is_external() && next == self.state && !event.is_of_device() {
            return Err(Refusal::State(event, self.state));
        }
        if matches!(event, Event::Start | Event::Clear) && !self.located {
            return Err(Refusal::Unknown(event));
        }
        if event == Event::Engage {
            self.telemetry_refusal().map_or(Ok(()), Err)?;
        }
        self.enter(next, event);
        Ok(())
    }

    /// Takes the place of the legs, in the state off or after the controller was lost. The way to
    /// neutral begins there.
    ///
    /// # Errors
    /// The legs follow commands, or a reported length is outside the stroke.
    pub fn locate(&mut self, legs: Legs) -> Result<(), Refusal> {
        if self.state != State::Off && self.located {
            return Err(Refusal::Commanded(self.state));
        }
        let lengths = match legs {
            Legs::Unknown => {
                self.located = false;
                return Ok(());
            }
            Legs::Settled | Legs::Slow => self.settled,
            Legs::Reported(lengths) => lengths_within(&self.washout.parameters().rig, lengths)?,
        };
        let slow_steps = self.stroke / self.settings.slow_speed.max(1e-3) / STEP;
        self.holds = if legs == Legs::Slow { slow_steps as u64 } else { 0 };
        self.located = true;
        self.goes_up = false;
        self.travel.settle();
        self.begin_at(lengths);
        self.place_legs(self.begin, [0.0; 6], 0.0);
        Ok(())
    }

    /// Commands these lengths and speeds, which are this part of the way to the output's own.
    fn place_legs(&mut self, length: [f64; 6], velocity: [f64; 6], part: f64) {
        let Commands { pose, washout, .. } = &self.commands;
        let pose = pose_between(&self.geometry, washout, &length, part, pose);
        let heave = pose.position.z - self.washout.parameters().rig.neutral_height;
        self.commands = Commands { length, velocity, pose, heave, ..self.commands };
    }

    /// The transition of an event, without the operator's guards.
    fn enter(&mut self, next: State, event: Event) {
        let before = self.state;
        self.changed |= before.follows_telemetry() != next.follows_telemetry();
        self.changed |= event == Event::Teleport;
        self.located &= event != Event::Lost;
        if next != before {
            self.state = next;
            self.since = self.steps;
        }
        match next {
            // The controller holds the legs where they are.
            State::Off if before != State::Off => {
                self.goes_up = false;
                self.travel.settle();
                self.begin_at(self.commands.length);
            }
            State::Off | State::Settled | State::Fault => (),
            // To neutral first, if the way has begun at other lengths than the settled ones.
            State::Parking => self.goes_up |= self.begin != self.settled,
            _ => {
                self.waits |= before == State::Off;
                self.goes_up = true;
            }
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
            self.road.as_mut().map(Road::interrupt);
            self.held_from = None;
            self.changed = true;
        }
        if let Some(time) = accepted.time {
            let arrival = if self.settings.is_inside { self.time() } else { arrival };
            for (time, sample) in accepted.confirmed.iter().chain([&(time, *sample)]) {
                if accepted.instead {
                    self.resampler.replace(sample.motion);
                } else {
                    self.resampler.push(arrival, *time, sample.motion, sample.position);
                    self.signs.take(*time, sample);
                    self.table_check.take(*time, sample);
                }
            }
        }
        for event in accepted.events.into_iter().flatten() {
            self.follow(event);
        }
    }

    /// The session's clock has slipped: so much time \[s\] has passed in which no step was made.
    /// Arrivals from now on are earlier by it.
    pub fn slip(&mut self, time: f64) {
        if time > 0.0 && time.is_finite() {
            self.source.slip(time);
            self.resampler.slip(time);
            self.held_from = self.held_from.map(|from| from - time);
            if let Some(road) = &mut self.road {
                road.slip(time);
            }
            self.slipped += time;
        }
    }

    /// Advances by [`STEP`].
    pub fn step(&mut self) -> &Commands {
        self.steps += 1;
        let now = self.time();
        if let Some(event) = self.source.listen(now) {
            self.follow(event);
        }
        if !self.settings.ignore_signs && self.state.is_engaged() && self.telemetry_fault().is_some() {
            self.follow(Event::Disengage);
        }
        self.adjust_delay();
        self.tuning.apply(&mut self.washout, self.steps);
        self.learn_road(now - STEP - self.delay);
        let (at, change) = self.input(now);
        let [start, end] = self.gliding_source.advance(&at.motion, &at.slope, change, STEP);
        let engaged = self.state.is_engaged();
        self.washout.step_between(&start.input(engaged), &end.input(engaged), STEP);
        let output = self.washout.output();
        self.travel(&output);
        self.arrive(&output);
        self.command(now, output);
        &self.commands
    }

    /// The delay that is given, or that covers most gaps; slowly while the vehicle is cued.
    fn adjust_delay(&mut self) {
        // Part of the gaps between samples that the delay covers; of those of a source inside the
        // program.
        const COVERED_GAP_FRACTIONS: [f64; 2] = [0.99, 0.5];
        // Speed at which the delay changes while the vehicle is cued.
        const DELAY_CHANGE: f64 = 0.02;
        let part = COVERED_GAP_FRACTIONS[usize::from(self.settings.is_inside)];
        let target = self.settings.delay.unwrap_or_else(|| self.resampler.delay(part));
        let most = if self.state.is_engaged() { DELAY_CHANGE * STEP } else { f64::INFINITY };
        self.delay += (target - self.delay).clamp(-most, most);
    }

    /// Takes the samples up to the washout's present into the road, and previews what is to come.
    fn learn_road(&mut self, present: f64) {
        let Some(road) = &mut self.road else { return };
        let mut is_new = false;
        while let Some(sample) = self.resampler.reached(present) {
            road.take(&sample);
            is_new = true;
        }
        if !self.state.follows_telemetry() {
            road.take_back(&mut self.washout);
        } else if is_new {
            road.give(&mut self.washout, &self.gliding_source);
        }
    }

    /// The washout's source at the step's end.
    fn input(&mut self, now: f64) -> (At, Change) {
        // Glide after a gap: twice its length, within these [s].
        const GAP_GLIDE: [f64; 2] = [0.1, 1.0];
        let rest = At { motion: Motion::at_rest(), slope: Channels::zeros(), held_from: None };
        let follows = self.state.follows_telemetry();
        let at = self.resampler.at(now - self.delay).filter(|_| follows).unwrap_or(rest);
        let slipped = std::mem::take(&mut self.slipped);
        let gap = self.held_from.filter(|from| at.held_from != Some(*from));
        let before = self.last.replace((at.motion, at.slope));
        let passes = before.is_some_and(|before| passes(&before, &at));
        let change = if std::mem::take(&mut self.changed) {
            Change::Source
        } else if passes {
            Change::None
        } else {
            let lasted = gap.map_or(0.0, |from| now - self.delay - from).max(slipped);
            Change::Gap((2.0 * lasted).clamp(GAP_GLIDE[0], GAP_GLIDE[1]))
        };
        self.held_from = at.held_from;
        (at, change)
    }

    /// True if the legs of the washout are at neutral and slow.
    fn is_at_neutral(&self, output: &Output) -> bool {
        // A leg is at neutral within this part of its stroke, at this part of it per second. A slow
        // wash-out of the yaw goes on for long.
        const AT_NEUTRAL: [f64; 2] = [0.03, 0.01];
        let [distance, speed] = AT_NEUTRAL.map(|part| part * self.stroke);
        let [position, rate] = output.actuators(&self.washout.parameters().rig);
        (0..6).all(|k| (position[k] - self.neutral[k]).abs() < distance && rate[k].abs() < speed)
    }

    /// True if the way down can begin: the cue is nearly out, and the legs are slow.
    fn may_descend(&self, output: &Output) -> bool {
        // Part of the cue, and of the actuators' speed, below which the way down may begin.
        const DESCENT_CUE: f64 = 0.2;
        const DESCENT_SPEED: f64 = 0.25;
        let rig = &self.washout.parameters().rig;
        let slow = DESCENT_SPEED * rig.velocity_limit;
        self.washout.engagement() < DESCENT_CUE && output.actuators(rig)[1].iter().all(|speed| speed.abs() < slow)
    }

    /// Advances on the way between the lengths at rest and neutral.
    fn travel(&mut self, output: &Output) {
        if self.state == State::Off {
            return;
        }
        let is_up = self.travel.is_up();
        if is_up && self.begin != self.settled {
            self.begin_at(self.settled);
        }
        if self.state == State::Parking && self.begin == self.settled {
            self.goes_up &= !self.may_descend(output);
        }
        self.holds = self.holds.saturating_sub(1);
        self.waits &= !(self.washout.engagement() == 0.0 && self.is_at_neutral(output));
        let goes_up = self.goes_up && !(self.waits || self.holds > 0);
        self.travel.advance(goes_up, self.travel_part);
    }

    /// The transition that follows if the state's own motion is complete.
    fn arrive(&mut self, output: &Output) {
        // Least time of engaging [s], also where the washout has stayed engaged through a pause.
        const LEAST_ENGAGING: f64 = 4.0;
        let at_neutral = self.is_at_neutral(output);
        let arrived = match self.state {
            State::Homing => at_neutral && self.travel.is_up(),
            State::Engaging => {
                let lasts = (self.steps - self.since) as f64 * STEP >= LEAST_ENGAGING;
                lasts && self.washout.engagement() == 1.0 && self.gliding_source.is_settled()
            }
            State::Disengaging => self.washout.engagement() == 0.0 && at_neutral,
            State::Parking => !self.goes_up && self.travel.is_down(),
            _ => false,
        };
        if arrived {
            self.follow(Event::Arrived);
        }
    }

    fn command(&mut self, now: f64, output: Output) {
        let part = self.travel.fraction();
        let before = self.commands.length;
        let [position, _] = output.actuators(&self.washout.parameters().rig);
        let length = std::array::from_fn(|k| self.begin[k] + part * (position[k] - self.begin[k]));
        let velocity = std::array::from_fn(|k| (length[k] - before[k]) / STEP);
        self.commands = Commands { state: self.state, time: now, washout: output, ..self.commands };
        self.place_legs(length, velocity, part);
    }
}
