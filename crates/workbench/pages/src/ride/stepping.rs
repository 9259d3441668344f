//! The ride: motorcycle, washout and platform, a step at a time.

use moris_interface::{Model, ParameterError};
use moris_laps::{Laps, Preview, Sample};
use moris_motorcycle::Motorcycle;
use moris_washout::interface::AngularVelocityFrame;
use moris_washout::{Input, Parameters, Washout};

use crate::ride::course::Circuit;
use crate::ride::lamps;
use crate::ride::recording::{Rating, Recording, STEPS_PER_SAMPLE};
use crate::ride::ridden::{Ridden, RiderCommand};

/// Time of a step \[s\].
pub const STEP: f64 = 0.001;
/// Half of the road's width \[m\].
pub const HALF_WIDTH: f64 = 4.0;

/// Where a ride is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// At the start, until the throttle opens.
    Ready,
    Riding,
    OffRoad,
    Fallen,
    /// The platform goes back to neutral for the next ride.
    Returning,
}

/// A whole lap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lap {
    /// Lap time \[s\].
    pub time: f64,
    /// Samples of the recording between which it was.
    pub samples: [usize; 2],
    /// True if parameters were changed in it.
    pub is_mixed: bool,
}

/// Motorcycle, washout and platform.
#[derive(Clone, Debug)]
pub struct Ride {
    ridden: Ridden,
    parameters: Parameters,
    washout: Washout,
    /// The washout that follows as soon as the platform is at neutral.
    next: Option<Box<Washout>>,
    /// Time since the washout was disengaged \[s\].
    disengaged: f64,
    input: Input,
    stage: Stage,
    recording: Recording,
    road: Laps,
    /// The washout gets the preview by earlier laps.
    learns: bool,
    /// Steps since the ride has begun.
    steps: u64,
    laps: Vec<Lap>,
    /// Steps at the beginning of the lap, and whether parameters were changed since.
    lap_start: u64,
    is_mixed: bool,
    lamps: [bool; lamps::LAMP_NAMES.len()],
}

impl Ride {
    /// A motorcycle at rest at the beginning of the course, with the platform at neutral.
    ///
    /// # Errors
    /// The washout's parameters cannot be used.
    pub fn new(parameters: &Parameters) -> Result<Ride, ParameterError> {
        let parameters = in_body_axes(parameters);
        let ridden = Ridden::new()?;
        let input = ridden.input(true);
        let washout = Washout::new(&parameters)?.starting_with(&input);
        let felt = washout.output().felt_specific_force;
        Ok(Ride {
            ridden,
            parameters,
            next: None,
            disengaged: 0.0,
            input,
            stage: Stage::Ready,
            recording: Recording::new(STEP, input, [felt.x, felt.y]),
            road: Laps::new(),
            learns: true,
            steps: 0,
            laps: Vec::new(),
            lap_start: 0,
            is_mixed: false,
            lamps: [false; lamps::LAMP_NAMES.len()],
            washout,
        })
    }

    /// Advances by [`STEP`].
    pub fn step(&mut self, command: &RiderCommand) {
        if self.stage == Stage::Ready && command.throttle > 0.0 && self.next.is_none() {
            self.begin();
        }
        if !matches!(self.stage, Stage::Ready | Stage::Returning) {
            self.ride(command);
        }
        let is_engaged = matches!(self.stage, Stage::Ready | Stage::Riding) && self.next.is_none();
        // A ride that is given up ends in the middle of a motion: its last force fades.
        self.input = match self.stage {
            Stage::Returning => Input { engaged: false, ..self.input },
            _ => self.ridden.input(is_engaged),
        };
        if self.stage == Stage::Riding && self.steps.is_multiple_of(STEPS_PER_SAMPLE as u64) {
            self.remember();
        }
        self.washout.step(&self.input, STEP);
        self.disengaged = if is_engaged { 0.0 } else { self.disengaged + STEP };
        self.update_lamps();
        if self.stage == Stage::Riding {
            self.record();
        }
        self.exchange_washout();
    }

    /// Takes the parameters. Those that cannot change in flight make a new washout, which follows
    /// when the cue has faded and the platform is at neutral. True for such ones.
    ///
    /// # Errors
    /// The parameters cannot be used; nothing has changed then.
    pub fn retune(&mut self, parameters: &Parameters) -> Result<bool, ParameterError> {
        let parameters = in_body_axes(parameters);
        if parameters == self.parameters {
            return Ok(self.next.is_some());
        }
        if self.next.is_some() || self.washout.retune(&parameters).is_err() {
            self.next = Some(Box::new(Washout::new(&parameters)?));
        }
        self.parameters = parameters;
        self.is_mixed = true;
        Ok(self.next.is_some())
    }

    /// Sets the friction of the road.
    ///
    /// # Errors
    /// The friction is out of range.
    pub fn set_friction(&mut self, friction: f64) -> Result<(), ParameterError> {
        self.ridden.set_friction(friction)
    }

    /// Ends the ride; the next one is ready when the platform is at neutral.
    ///
    /// # Errors
    /// Never, because the parameters are in use.
    pub fn restart(&mut self) -> Result<(), ParameterError> {
        if !matches!(self.stage, Stage::Ready | Stage::Returning) {
            self.interrupt();
            self.next = Some(Box::new(Washout::new(&self.parameters)?));
            self.ridden = self.ridden.restarted()?;
            self.stage = Stage::Returning;
        }
        Ok(())
    }

    fn begin(&mut self) {
        self.stage = Stage::Riding;
        let felt = self.washout.output().felt_specific_force;
        self.recording = Recording::new(STEP, self.input, [felt.x, felt.y]);
        self.laps.clear();
        (self.steps, self.lap_start, self.is_mixed) = (0, 0, false);
    }

    fn ride(&mut self, command: &RiderCommand) {
        self.ridden.step(command);
        let (before, now) = (self.stage, self.motorcycle().output());
        self.stage = match self.stage {
            _ if now.fallen => Stage::Fallen,
            Stage::Riding if now.off_path => Stage::OffRoad,
            stage => stage,
        };
        if self.stage != before {
            self.interrupt();
        }
    }

    /// Takes the place on the road, and gives the washout the preview.
    fn remember(&mut self) {
        let (place, force) = (self.ridden.place(), self.input.specific_force);
        self.road.step(&Sample {
            step: STEP * STEPS_PER_SAMPLE as f64,
            position: [place.x, place.y, 0.0],
            speed: Some(self.input.speed),
            force: [force.x, force.y],
        });
        if self.learns {
            self.washout.preview(&self.road.preview());
        }
    }

    /// Starts a new road, without relation to the last one.
    fn interrupt(&mut self) {
        self.road.interrupt();
        self.washout.preview(&Preview::default());
    }

    /// Gives the washout the preview by earlier laps from now on, or none. The road is learned
    /// without it, too.
    pub fn learn(&mut self, is_on: bool) {
        self.learns = is_on;
        if !is_on {
            self.washout.preview(&Preview::default());
        }
    }

    fn record(&mut self) {
        let felt = self.washout.output().felt_specific_force;
        self.recording.push(&self.input, [felt.x, felt.y]);
        self.steps += 1;
        let laps = self.motorcycle().output().path_distance / self.course().length();
        if laps as usize > self.laps.len() {
            let from = self.laps.last().map_or(0, |lap| lap.samples[1] - 1);
            self.laps.push(Lap {
                time: (self.steps - self.lap_start) as f64 * STEP,
                samples: [from, self.recording.samples()],
                is_mixed: self.is_mixed,
            });
            (self.lap_start, self.is_mixed) = (self.steps, false);
        }
    }

    /// Puts the next washout in place at neutral. The cue fades in, or begins with a ride at rest.
    fn exchange_washout(&mut self) {
        // Longest time to wait for the platform at neutral [s].
        const NEUTRAL_TIMEOUT: f64 = 20.0;
        let at_rest = matches!(self.stage, Stage::Ready | Stage::Returning);
        let has_faded = self.washout.engagement() == 0.0 || self.stage == Stage::Ready;
        if self.next.is_none() || !(has_faded && self.is_neutral() || self.disengaged > NEUTRAL_TIMEOUT) {
            return;
        }
        let Some(next) = self.next.take() else { return };
        if at_rest {
            self.stage = Stage::Ready;
        }
        self.input = self.ridden.input(at_rest);
        self.washout = next.starting_with(&self.input);
    }

    fn is_neutral(&self) -> bool {
        // The platform counts as neutral within these distances and speeds, in m, rad and s.
        const NEUTRAL_TOLERANCE: f64 = 2e-3;
        const STANDSTILL_TOLERANCE: f64 = 5e-3;
        let now = self.washout.output();
        let height = self.parameters.rig.neutral_height;
        let moved = [now.position.x, now.position.y, now.position.z - height];
        let turn = now.orientation;
        moved.into_iter().chain([turn.roll, turn.pitch, turn.yaw]).all(|value| value.abs() < NEUTRAL_TOLERANCE)
            && now.velocity.norm() < STANDSTILL_TOLERANCE
            && now.angular_velocity.norm() < STANDSTILL_TOLERANCE
    }

    fn update_lamps(&mut self) {
        let lit = lamps::lit(&self.washout);
        for (lamp, lit) in self.lamps.iter_mut().zip(lit) {
            *lamp |= lit;
        }
    }

    pub fn stage(&self) -> Stage {
        self.stage
    }

    pub fn course(&self) -> &Circuit {
        self.ridden.course()
    }

    pub fn motorcycle(&self) -> &Motorcycle {
        self.ridden.motorcycle()
    }

    pub fn washout(&self) -> &Washout {
        &self.washout
    }

    /// The ride so far, or the last one.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// The whole laps of the ride so far, or of the last one.
    pub fn laps(&self) -> &[Lap] {
        &self.laps
    }

    /// Measures of surge and sway of a lap.
    pub fn ratings(&self, lap: &Lap) -> Option<[Rating; 2]> {
        self.recording.ratings(lap.samples[0], lap.samples[1])
    }

    /// Values that the page shows, by names. Lamps are lit if a limit was near since the last call.
    pub fn view(&mut self) -> Vec<(&'static str, f64)> {
        let (bike, out) = (self.motorcycle().output(), self.washout.output());
        let lamps = std::mem::take(&mut self.lamps).map(f64::from);
        let desired = self.input.specific_force;
        let felt = out.felt_specific_force;
        let mut view = vec![
            ("stage", f64::from(self.stage as u8)),
            ("time", self.steps as f64 * STEP),
            ("lap_time", (self.steps - self.lap_start) as f64 * STEP),
            ("laps", self.laps.len() as f64),
            ("is_exchanging", f64::from(self.next.is_some() && self.stage != Stage::Returning)),
            ("trust", if self.learns { self.road.trust() } else { 0.0 }),
            ("passes", self.road.passes() as f64),
            ("distance", bike.path_distance),
            ("deviation", bike.path_deviation),
            ("x", self.ridden.place().x),
            ("y", self.ridden.place().y),
            ("yaw", self.ridden.place().yaw),
            ("roll", bike.orientation.roll),
            ("pitch", bike.orientation.pitch),
            ("speed", bike.speed),
            ("advised", bike.planned_speed),
            ("steer", bike.steer_angle),
            ("throttle", bike.throttle),
            ("brake", bike.brake),
            ("lean", self.input.lean),
        ];
        view.extend(["desired_x", "desired_y", "desired_z"].into_iter().zip([desired.x, desired.y, desired.z]));
        view.extend(["felt_x", "felt_y", "felt_z"].into_iter().zip([felt.x, felt.y, felt.z]));
        let turn = out.orientation;
        view.extend(["platform_x", "platform_y", "platform_z"].into_iter().zip(out.position.iter().copied()));
        view.extend(
            ["platform_roll", "platform_pitch", "platform_yaw"].into_iter().zip([turn.roll, turn.pitch, turn.yaw]),
        );
        let [legs, _] = out.actuators(&self.washout.parameters().rig);
        view.extend(["leg1", "leg2", "leg3", "leg4", "leg5", "leg6"].into_iter().zip(legs));
        view.extend(lamps::LAMP_NAMES.into_iter().zip(lamps));
        view.push(("scale", out.scale_factor));
        view
    }
}

/// Recordings have the rates of a gyroscope; so has the ride.
fn in_body_axes(parameters: &Parameters) -> Parameters {
    let mut parameters = *parameters;
    parameters.conditioning.angular_velocity_frame = AngularVelocityFrame::Body;
    parameters
}
