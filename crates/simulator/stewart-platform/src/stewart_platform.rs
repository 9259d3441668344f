//! The whole platform: parameters, state and step.

use moris_interface::{Group, Identity, MOST_INTERNAL_STEPS, Model, ParameterError, SHORTEST_STEP, bounds_of};
use moris_washout::cueing::evaluator::{Felt, felt};
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::platform::LocationFrame;
use moris_washout::platform::{
    Geometry, Legs, PlatformMotion, Pose, inverse_kinematics, leg_accelerations, motion_of_legs,
};
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

use crate::body::Body;
use crate::check::{check, check_change};
use crate::delay::{DelayLine, Ramp};
use crate::drive::{Drive, DriveTarget};
use crate::dynamics::Dynamics;
use crate::identity::IDENTITY;
use crate::interface::{Input, Output, Parameters, neutral_lengths};
use crate::saturation::{Leg, Outcome, solve};

/// A Stewart platform on its actuators.
///
/// ```
/// use moris_stewart_platform::{Input, Model, Parameters, StewartPlatform};
///
/// let mut input = Input::default();
/// let mut platform = StewartPlatform::new(&Parameters::default(), &input)?;
/// input.length = [1.32; 6]; // m: all actuators 2 cm longer
/// for _ in 0..1000 {
///     platform.step(&input, 0.001);
/// }
/// let output = platform.output();
/// assert!((output.length[0] - 1.32).abs() < 1e-6); // they are there,
/// assert!((output.position.z - 1.115).abs() < 1e-3); // the platform rose by a little more,
/// let carried: f64 = output.force.iter().sum();
/// assert!(carried > 330.0 * 9.80665); // and the inclined legs carry its weight.
/// # Ok::<(), moris_stewart_platform::ParameterError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StewartPlatform {
    parameters: Parameters,
    body: Body,
    /// Commands inside the dead time.
    commands: DelayLine,
    /// The last commands inside the stroke \[m\].
    last_command: [f64; 6],
    now: Instant,
    /// State one internal step ago.
    before: Instant,
    /// Length of the last internal step \[s\].
    last_step: f64,
    limited: DriveStatus,
}

/// Motion and forces at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Instant {
    motion: PlatformMotion,
    legs: Legs,
    /// Accelerations of the legs' lengths \[m/s2\].
    acceleration: Vector6<f64>,
    /// Forces of drives and stops together \[N\].
    force: Vector6<f64>,
    /// Lean of the rider \[rad\].
    lean: f64,
}

/// Limits active in any internal step of the last communication step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct DriveStatus {
    command: bool,
    drive: bool,
    force: bool,
    stop: bool,
}

impl Model for StewartPlatform {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = IDENTITY;

    /// The platform at rest at neutral, with the rider leaning as the input says.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    fn new(parameters: &Parameters, input: &Input) -> Result<Self, ParameterError> {
        let now = Instant { lean: lean_or(input.lean, 0.0), ..Instant::at_rest(parameters) };
        check(parameters, &now.force)?;
        let neutral = neutral_lengths(&parameters.rig);
        Ok(StewartPlatform {
            parameters: *parameters,
            body: Body::new(&parameters.masses),
            commands: DelayLine::new(parameters.actuators.dead_time, &neutral),
            last_command: neutral,
            now,
            before: now,
            last_step: 0.0,
            limited: DriveStatus::default(),
        })
    }

    /// Changes tunable parameters. Lengths, pose and their rates do not jump; forces and
    /// accelerations may.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why; fixed ones cannot be changed. Nothing has
    /// changed then.
    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        check_change(&self.parameters, parameters, &Instant::at_rest(parameters).force)?;
        let dead_time = parameters.actuators.dead_time;
        if dead_time != self.parameters.actuators.dead_time {
            self.commands.set_dead_time(dead_time);
        }
        // The drives keep the new limit from now on; the forces of the stops stay.
        let limit = parameters.actuators.force_limit;
        let (now, before) = (self.within_force_limit(self.now.force), self.within_force_limit(self.before.force));
        self.now.force += now.map(|drive| drive.clamp(-limit, limit)) - now;
        self.before.force += before.map(|drive| drive.clamp(-limit, limit)) - before;
        self.body = Body::new(&parameters.masses);
        self.parameters = *parameters;
        Ok(())
    }

    fn max_communication_step(&self) -> f64 {
        MOST_INTERNAL_STEPS * self.parameters.setting.max_step
    }

    /// Advances by `step` seconds with commands that change at the commanded rates.
    ///
    /// Any input is safe: a length or angle outside the stroke is rejected, and the previous
    /// command is kept. A step shorter than [`SHORTEST_STEP`] does nothing; one longer than
    /// [`MOST_INTERNAL_STEPS`] internal steps is cut off there.
    fn step(&mut self, input: &Input, step: f64) {
        // Range of the commanded velocities [m/s], and of the angular ones [rad/s].
        const VELOCITY_RANGE: (f64, f64) = bounds_of(Input::ROWS, "command[#].velocity");
        let after = |from: &[f64; 6], rate: &[f64; 6]| {
            std::array::from_fn(|i| from[i] + step * rate[i].clamp(VELOCITY_RANGE.0, VELOCITY_RANGE.1))
        };
        let (length, angle) = (after(&input.length, &input.velocity), after(&input.angle, &input.angular_velocity));
        self.step_between(input, &Input { length, angle, ..*input }, step);
    }

    /// Advances by `step` seconds. The commands and the rider's lean change linearly from `start`
    /// to `end`; the commanded rates are ignored.
    fn step_between(&mut self, start: &Input, end: &Input, step: f64) {
        if step.is_nan() || step < SHORTEST_STEP {
            return;
        }
        let step = step.min(MOST_INTERNAL_STEPS * self.parameters.setting.max_step);
        self.limited = DriveStatus::default();
        let from = self.possible(start);
        let to = self.possible(end);
        self.commands.push(&Ramp { duration: step, from, to });
        let kept = self.now.lean;
        let (lean, leaning) = (lean_or(start.lean, kept), lean_or(end.lean, kept));
        let mut left = step;
        while left >= SHORTEST_STEP {
            let ramp = self.commands.pop(left.min(self.parameters.setting.max_step));
            left -= ramp.duration;
            self.internal_step(&ramp, leaning - (leaning - lean) * (left / step));
        }
    }

    /// Lengths change at the slopes that the host sets, and at the commanded
    /// rates where it sets none.
    fn input_after(start: &Input, slope: &Input, step: f64) -> Input {
        let rates = |slope: &[f64; 6], rate: &[f64; 6]| {
            std::array::from_fn(|i| if slope[i] != 0.0 { slope[i] } else { rate[i] })
        };
        let (length, angle) = (rates(&slope.length, &start.velocity), rates(&slope.angle, &start.angular_velocity));
        start.extrapolated(&Input { length, velocity: [0.0; 6], angle, angular_velocity: [0.0; 6], ..*slope }, step)
    }

    /// The outputs now.
    fn output(&self) -> Output {
        let output = self.output_at(&self.now);
        Output {
            command_refused: self.limited.command,
            drive_limited: self.limited.drive,
            force_limited: self.limited.force,
            at_stop: self.limited.stop,
            ..output
        }
    }

    /// The rates of the outputs \[their units per second\]: exact for what has its rate among the
    /// outputs, else the mean over the last internal step.
    fn output_derivative(&self) -> Output {
        let (now, before) = (self.output_at(&self.now), self.output_at(&self.before));
        let per_second = if self.last_step > 0.0 { 1.0 / self.last_step } else { 0.0 };
        let rates = |now: &[f64; 6], before: &[f64; 6]| std::array::from_fn(|i| (now[i] - before[i]) * per_second);
        Output {
            position: now.velocity,
            velocity: now.acceleration,
            acceleration: (now.acceleration - before.acceleration) * per_second,
            orientation: self.now.motion.orientation.rates(now.angular_velocity),
            angular_velocity: now.angular_acceleration,
            angular_acceleration: (now.angular_acceleration - before.angular_acceleration) * per_second,
            length: now.leg_velocity,
            leg_velocity: now.leg_acceleration,
            leg_acceleration: rates(&now.leg_acceleration, &before.leg_acceleration),
            force: rates(&now.force, &before.force),
            stop_force: rates(&now.stop_force, &before.stop_force),
            total_power: (now.total_power - before.total_power) * per_second,
            felt_specific_force: (now.felt_specific_force - before.felt_specific_force) * per_second,
            felt_angular_velocity: (now.felt_angular_velocity - before.felt_angular_velocity) * per_second,
            stroke_margin: self.stroke_clearance(&self.now.legs).1,
            angle: now.angular_rate,
            angular_rate: self.angles(&self.now.acceleration.into()),
            ..Output::default()
        }
    }
}

impl StewartPlatform {
    /// The parameters in force.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The commanded lengths or arcs inside the stroke \[m\]; in place of any other, the
    /// last one that was inside.
    fn possible(&mut self, input: &Input) -> [f64; 6] {
        let rig = &self.parameters.rig;
        let [start, end] = rig.stroke();
        let commands = if rig.has_cranks() { input.angle.map(|angle| rig.crank_arm * angle) } else { input.length };
        for (last, command) in self.last_command.iter_mut().zip(commands) {
            if (start..=end).contains(&command) {
                *last = command;
            } else {
                self.limited.command = true;
            }
        }
        self.last_command
    }

    /// One step with commands that are linear after the dead time; `lean` is the rider's at its
    /// end.
    fn internal_step(&mut self, command: &Ramp, lean: f64) {
        let step = command.duration;
        let Instant { motion, legs, .. } = self.now;
        let drive = Drive::new(&self.parameters, step);
        let targets: [DriveTarget; 6] =
            std::array::from_fn(|i| drive.target(legs.position[i], legs.velocity[i], command.from[i], command.to[i]));
        let next = self.free_step(&targets, step).unwrap_or_else(|| self.constrained_step(&targets, step));

        let geometry = Geometry::from(&self.parameters.rig);
        let guess = motion_ahead(&motion, step).pose();
        // A valid rig has a pose for every combination of leg lengths.
        let reached = motion_of_legs(&geometry, &next.legs, &[0.0; 6], &guess)
            .unwrap_or_else(|_| PlatformMotion::at_rest(motion.pose()));
        let dynamics = self.dynamics(&reached);
        let force = match next.force {
            Some(force) => force,
            None => {
                let demand = Vector6::from_fn(|i, _| targets[i].motion.acceleration);
                self.within_force_limit(dynamics.forces(&demand))
            }
        };
        let acceleration = dynamics.acceleration(&force);
        self.before = self.now;
        self.last_step = step;
        self.now = Instant {
            motion: PlatformMotion {
                acceleration: acceleration.fixed_rows::<3>(0).into(),
                angular_acceleration: acceleration.fixed_rows::<3>(3).into(),
                ..reached
            },
            legs: next.legs,
            acceleration: dynamics.leg_accelerations(&force),
            force,
            lean,
        };
        self.limited.drive |= targets.iter().any(|target| target.limited);
        self.limited.force |= next.force_limited;
        self.limited.stop |= next.at_stop;
    }

    /// The step in which every leg reaches its target, if the drives have the force for it; their
    /// forces follow from the motion.
    fn free_step(&self, targets: &[DriveTarget; 6], step: f64) -> Option<Next> {
        let [start, end] = self.parameters.rig.stroke();
        if targets.iter().any(|target| !(start..=end).contains(&target.motion.position)) {
            return None;
        }
        let mean = Vector6::from_fn(|i, _| (targets[i].motion.velocity - self.now.legs.velocity[i]) / step);
        let force = self.dynamics(&motion_ahead(&self.now.motion, 0.5 * step)).forces(&mean);
        (force.amax() <= self.parameters.actuators.force_limit).then(|| Next {
            legs: Legs {
                position: targets.map(|target| target.motion.position),
                velocity: targets.map(|target| target.motion.velocity),
            },
            force: None,
            force_limited: false,
            at_stop: false,
        })
    }

    /// The step with limited forces, or with legs at a stop: the legs' motion follows from the
    /// body's.
    fn constrained_step(&self, targets: &[DriveTarget; 6], step: f64) -> Next {
        let ([start, end], limit) = (self.parameters.rig.stroke(), self.parameters.actuators.force_limit);
        let Legs { position, velocity } = self.now.legs;
        let dynamics = self.dynamics(&motion_ahead(&self.now.motion, 0.5 * step));
        let free = Vector6::from(velocity) + step * dynamics.leg_accelerations(&Vector6::zeros());
        let demand: [Leg; 6] = std::array::from_fn(|i| Leg {
            demand: targets[i].motion.velocity,
            // A stop is inelastic: the leg ends the step at rest there.
            slowest: (2.0 * (start - position[i]) / step - velocity[i]).min(0.0),
            fastest: (2.0 * (end - position[i]) / step - velocity[i]).max(0.0),
        });
        let Outcome { velocity: reached, force } = solve(&free, &(step * dynamics.leg_mobility()), &demand, limit);
        let position =
            std::array::from_fn(|i| (position[i] + 0.5 * step * (velocity[i] + reached[i])).clamp(start, end));
        Next {
            legs: Legs { position, velocity: reached.into() },
            force: Some(force),
            force_limited: force.amax() >= limit,
            at_stop: force.amax() > limit,
        }
    }

    fn dynamics(&self, motion: &PlatformMotion) -> Dynamics {
        Dynamics::new(&Geometry::from(&self.parameters.rig), &self.body, motion, self.parameters.setting.gravity)
    }

    fn within_force_limit(&self, force: Vector6<f64>) -> Vector6<f64> {
        let limit = self.parameters.actuators.force_limit;
        force.map(|force| force.clamp(-limit, limit))
    }

    /// Arcs of cranks, or their derivatives, as those of the arms' angles \[rad\]; 0 with legs.
    fn angles(&self, arcs: &[f64; 6]) -> [f64; 6] {
        let rig = &self.parameters.rig;
        if rig.has_cranks() { arcs.map(|arc| arc / rig.crank_arm) } else { [0.0; 6] }
    }

    /// The lengths of the legs with their rates and accelerations; with cranks, the distances from
    /// axle to platform joint.
    fn lengths(&self, instant: &Instant) -> (Legs, [f64; 6]) {
        let geometry = Geometry::from(&self.parameters.rig);
        if geometry.cranks.is_none() {
            return (instant.legs, instant.acceleration.into());
        }
        let distances = geometry.with_legs();
        (inverse_kinematics(&distances, &instant.motion), leg_accelerations(&distances, &instant.motion))
    }

    /// The outputs at an instant, with nothing limited.
    fn output_at(&self, instant: &Instant) -> Output {
        let Instant { motion, legs, force, lean, .. } = instant;
        let (lengths, leg_acceleration) = self.lengths(instant);
        let drive = self.within_force_limit(*force);
        let felt = self.felt(motion, *lean);
        let PlatformMotion { position, velocity, acceleration, orientation, angular_velocity, angular_acceleration } =
            *motion;
        Output {
            position,
            velocity,
            acceleration,
            orientation: orientation.angles,
            angular_velocity,
            angular_acceleration,
            length: lengths.position,
            leg_velocity: lengths.velocity,
            leg_acceleration,
            force: drive.into(),
            stop_force: (force - drive).into(),
            total_power: drive.dot(&Vector6::from(legs.velocity)),
            felt_specific_force: felt.specific_force,
            felt_angular_velocity: felt.angular_velocity,
            stroke_margin: self.stroke_clearance(legs).0,
            angle: self.angles(&legs.position),
            angular_rate: self.angles(&legs.velocity),
            ..Output::default()
        }
    }

    /// Specific force and angular velocity at the rider's head for this lean.
    fn felt(&self, motion: &PlatformMotion, lean: f64) -> Felt {
        let setting = &self.parameters.setting;
        let head = LocationFrame::leaning(setting.head_height, setting.torso_length, lean);
        felt(motion, &head, setting.gravity)
    }

    /// The smallest distance of a leg from an end of its stroke \[m\], and its rate \[m/s\].
    fn stroke_clearance(&self, legs: &Legs) -> (f64, f64) {
        let [start, end] = self.parameters.rig.stroke();
        let clearances = legs.position.iter().zip(&legs.velocity);
        let clearances = clearances.flat_map(|(&at, &rate)| [(at - start, rate), (end - at, -rate)]);
        clearances.fold((f64::INFINITY, 0.0), |nearest, next| if next.0 < nearest.0 { next } else { nearest })
    }
}

/// The legs at a step's end.
struct Next {
    legs: Legs,
    /// Forces over the step \[N\]; none where nothing but the motion decides them.
    force: Option<Vector6<f64>>,
    force_limited: bool,
    at_stop: bool,
}

impl Instant {
    /// At rest at neutral, with the forces that carry the weight.
    fn at_rest(parameters: &Parameters) -> Self {
        let motion = PlatformMotion::at_rest(Pose::neutral(&parameters.rig));
        let geometry = Geometry::from(&parameters.rig);
        let dynamics = Dynamics::new(&geometry, &Body::new(&parameters.masses), &motion, parameters.setting.gravity);
        Instant {
            motion,
            legs: Legs { position: neutral_lengths(&parameters.rig), velocity: [0.0; 6] },
            acceleration: Vector6::zeros(),
            force: dynamics.forces(&Vector6::zeros()),
            lean: 0.0,
        }
    }
}

/// The motion `time` seconds later if its accelerations stay: a guess of the second order.
fn motion_ahead(motion: &PlatformMotion, time: f64) -> PlatformMotion {
    let turning = motion.angular_velocity + 0.5 * time * motion.angular_acceleration;
    let angles = motion.orientation.angles.to_vector() + time * motion.orientation.rates(turning).to_vector();
    PlatformMotion {
        position: motion.position + time * (motion.velocity + 0.5 * time * motion.acceleration),
        orientation: Orientation::new(RollPitchYaw::from_vector(angles)),
        velocity: motion.velocity + time * motion.acceleration,
        angular_velocity: motion.angular_velocity + time * motion.angular_acceleration,
        ..*motion
    }
}

/// The lean within its range, or another where it is not a number.
fn lean_or(lean: f64, other: f64) -> f64 {
    // Range of the lean [rad].
    const LEAN_RANGE: (f64, f64) = bounds_of(Input::ROWS, "rider.lean");
    if lean.is_nan() { other } else { lean.clamp(LEAN_RANGE.0, LEAN_RANGE.1) }
}
