//! The whole: parameters, state, and a step.

use moris_interface::{Group, Identity, Model, ParameterError, SHORTEST_STEP};
use moris_washout::interface::AngularVelocityFrame;
use moris_washout::motion::Motion;
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::check::{check, check_change, check_step, design_rider, fastest};
use crate::identity::IDENTITY;
use crate::interface::{Input, Output, Parameters};
use crate::lateral::{self, Actions, Lateral, Wheels, foot_support, place};
use crate::longitudinal::{Accelerations, Forces, Longitudinal, Situation};
use crate::output_rate::{mean_rate, rest_rate};
use crate::path::follower::{Ahead, Follower};
use crate::path::forerun::{Forerun, PREVIEW_STEP, Record};
use crate::path::grip::{self, Friction};
use crate::path::table::Table;
use crate::pose::{Geometry, Head, Moving, Point};
use crate::rider::Rider;
use crate::state::{PathState, RunState, Stage, State};
use crate::suspension::{self, Suspension};

/// Largest number of internal steps in a communication step.
pub const MOST_MOTORCYCLE_STEPS: f64 = 100_000.0;

/// A motorcycle and its rider.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Motorcycle {
    parameters: Parameters,
    lateral: Lateral,
    longitudinal: Longitudinal,
    suspension: Suspension,
    geometry: Geometry,
    rider: Rider,
    run: RunState,
    output: Output,
    output_derivative: Output,
    /// The path and the rider's gains on it; none without a path.
    follower: Option<Box<Follower>>,
    /// True if the rider obeys the commands on the path, too.
    commanded: bool,
    /// The simulation of the next seconds. None without a path, with a commanded rider, or after
    /// the path was left or a fall.
    forerun: Option<Box<Forerun>>,
}

/// A state's derivative with intermediate results.
struct Dynamics {
    derivative: State,
    forces: Forces,
    accelerations: Accelerations,
    loads: Wheels,
    lateral_forces: Wheels,
    torque: f64,
    feet: f64,
    /// Limits of the lateral forces of the front and the rear tyre, on a path.
    grip: Option<(grip::Limits, grip::Limits)>,
    grip_limited: bool,
}

impl Model for Motorcycle {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = IDENTITY;

    fn warnings(parameters: &Parameters) -> Vec<String> {
        Table::unused(&parameters.path).into_iter().collect()
    }

    /// The motorcycle at its initial speed, upright and straight ahead, with throttle closed and
    /// brakes off; in the wind of the input.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    fn new(parameters: &Parameters, input: &Input) -> Result<Self, ParameterError> {
        check(parameters)?;
        let longitudinal = Longitudinal::new(parameters);
        let suspension = Suspension::new(parameters);
        let (lateral, rider) = design_rider(parameters, &suspension, fastest(parameters, &longitudinal)?)?;
        let (heading, speed) = (parameters.run.initial_heading, parameters.run.initial_speed);
        let state = State { heading, speed, ..State::default() };
        let follower = Follower::new(parameters, &lateral, &rider, &longitudinal)?;
        let mut motorcycle = Motorcycle {
            parameters: *parameters,
            lateral,
            longitudinal,
            suspension,
            geometry: Geometry::new(parameters),
            rider,
            run: RunState { state, stage: Stage::Riding, grip_limited: false },
            output: Output::default(),
            output_derivative: rest_rate(),
            follower,
            commanded: false,
            forerun: None,
        };
        let input = input.sanitized();
        motorcycle.output = motorcycle.output_for(&input);
        motorcycle.begin_forerun(&input);
        Ok(motorcycle)
    }

    /// Changes tunable parameters. Positions, angles, their rates and the rider's torque on the
    /// bars do not jump; accelerations may.
    ///
    /// The rider's gains are designed again if `rider.torqueWeight` changes or the top speed
    /// exceeds their range. The design takes some milliseconds.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why; fixed ones cannot be changed. Nothing has
    /// changed then.
    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        check_change(&self.parameters, parameters)?;
        let longitudinal = Longitudinal::new(parameters);
        let suspension = Suspension::new(parameters);
        let fastest = fastest(parameters, &longitudinal)?;
        let State { rider: state, lateral, speed, .. } = &self.run.state;
        let same_gains = parameters.rider.torque_weight == self.parameters.rider.torque_weight;
        let (rider, error) = if same_gains && fastest <= self.rider.fastest() {
            check_step(parameters, &suspension)?;
            let mut rider = self.rider.clone();
            rider.set_limits(parameters);
            (rider, state.error)
        } else {
            let (_, rider) = design_rider(parameters, &suspension, fastest.max(*speed))?;
            let error = rider.error_for_torque_of(&self.rider, state, lateral, *speed);
            (rider, error)
        };
        let follower = Follower::new(parameters, &self.lateral, &rider, &longitudinal)?;
        self.run.state.rider.error = error;
        self.rider = rider;
        self.longitudinal = longitudinal;
        self.suspension = suspension;
        self.parameters = *parameters;
        self.follower = follower;
        // The simulation of the next seconds is no longer valid.
        self.forerun = None;
        Ok(())
    }

    fn max_communication_step(&self) -> f64 {
        MOST_MOTORCYCLE_STEPS * self.parameters.run.max_step
    }

    /// In equal internal steps of solver.maxStep at most. Any step is safe: one shorter than
    /// [`SHORTEST_STEP`] does nothing, and one longer than [`MOST_MOTORCYCLE_STEPS`] internal
    /// steps is cut off there.
    fn step_between(&mut self, start: &Input, end: &Input, step: f64) {
        if step.is_nan() || step < SHORTEST_STEP {
            return;
        }
        let longest = self.parameters.run.max_step;
        let step = step.min(MOST_MOTORCYCLE_STEPS * longest);
        let (start, end) = (start.sanitized(), end.sanitized());
        let steps = libm::ceil((step / longest - 1e-6).max(1.0));
        let size = step / steps;
        for k in 0..steps as u32 {
            let at = |t: f64| input_between(&start, &end, (f64::from(k) + t) / steps);
            let inputs = [at(0.0), at(0.5), at(1.0)];
            self.run = self.advanced(&self.run, &inputs, size);
            self.look_ahead(&inputs[2], size);
        }
        let before = self.output;
        self.output = self.output_for(&end);
        self.output_derivative = mean_rate(&before, &self.output, step);
    }

    /// The outputs now.
    fn output(&self) -> Output {
        self.output
    }

    /// The outputs' time derivatives: their means over the last step, and zero before the first.
    fn output_derivative(&self) -> Output {
        self.output_derivative
    }
}

impl Motorcycle {
    /// The motorcycle with a rider who obeys the commands on the path, too. The path has no effect
    /// but on the place beside it, the friction across the road and the end of the ride. There is
    /// no preview, because the commands to come are not known.
    pub fn commanded(self) -> Self {
        Motorcycle { commanded: true, forerun: None, ..self }
    }

    /// The parameters in force.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The lateral equations.
    pub fn lateral(&self) -> &Lateral {
        &self.lateral
    }

    /// The rider.
    pub fn rider(&self) -> &Rider {
        &self.rider
    }

    /// The state now.
    pub fn state(&self) -> &State {
        &self.run.state
    }

    /// The rider on the path; `None` without one.
    pub fn follower(&self) -> Option<&Follower> {
        self.follower.as_deref()
    }

    /// One step by the classical Runge-Kutta rule. A speed below zero becomes zero.
    fn advanced(&self, run: &RunState, [start, middle, end]: &[Input; 3], size: f64) -> RunState {
        let RunState { state, stage, .. } = *run;
        let ahead = self.ahead(&state, stage);
        let motion = |state: &State, input: &Input| self.motion(state, input, stage, &ahead);
        let k1 = motion(&state, start).derivative;
        let k2 = motion(&state.plus(&k1, 0.5 * size), middle).derivative;
        let k3 = motion(&state.plus(&k2, 0.5 * size), middle).derivative;
        let last = motion(&state.plus(&k3, size), end);
        let k4 = last.derivative;
        let end = state.plus(&k1, size / 6.0).plus(&k2, size / 3.0).plus(&k3, size / 3.0).plus(&k4, size / 6.0);
        let mut run = RunState { state: end.flush_small(), ..*run };
        run.state.speed = run.state.speed.max(0.0);
        if let Some(limits) = last.grip {
            (run.state.lateral, _) = held_state(&run.state.lateral, limits);
            run.grip_limited = last.grip_limited;
            run.stage = self.stage(&run);
        }
        run
    }

    /// True if the rider obeys the commands: without a path, and on it if commanded.
    fn obeys(&self, stage: Stage) -> bool {
        self.follower.is_none() || self.commanded && stage == Stage::Riding
    }

    /// The rider's actions for the path ahead; none for a rider who obeys the commands.
    fn ahead(&self, state: &State, stage: Stage) -> Ahead {
        match &self.follower {
            Some(_) if self.obeys(stage) => Ahead::default(),
            Some(follower) if stage == Stage::Riding => follower.ahead(state, &self.longitudinal),
            Some(follower) => follower.stop(state, &self.longitudinal),
            None => Ahead::default(),
        }
    }

    /// Stage on a path.
    fn stage(&self, run: &RunState) -> Stage {
        let Parameters { rider, path, .. } = &self.parameters;
        let state = &run.state;
        let roll = libm::atan(state.lateral[place::LEAN]);
        if grip::has_fallen(roll, rider.lean_limit, state.speed, state.lateral[place::VELOCITY]) {
            return Stage::Fallen;
        }
        match run.stage {
            Stage::Riding if state.place.deviation.abs() > path.half_width => Stage::OffPath,
            stage => stage,
        }
    }

    /// The equations of motion.
    fn motion(&self, state: &State, input: &Input, stage: Stage, ahead: &Ahead) -> Dynamics {
        // Limit of the rider's torque on the bars on a path [N m].
        const STRONGEST_TORQUE: f64 = 120.0;
        // Passes in which limits of lateral forces and loads are found together.
        const GRIP_PASSES: usize = 3;
        let p = &self.parameters;
        let speed = state.speed.max(0.0);
        let feet = foot_support(speed, p.rider.feet_speed);
        let gains = self.rider.gains(speed);
        let command = (input.lean, input.rider_lean);
        let mut rider = self.rider.derivative(&state.rider, &state.lateral, &gains, feet, command);
        let (mut throttle, mut brake, mut place) = (input.throttle, input.brake, PathState::default());
        if let Some(follower) = &self.follower {
            if !self.obeys(stage) {
                let (control, feet) = match stage {
                    Stage::Riding => (follower.lean_control(state, ahead), feet),
                    Stage::OffPath | Stage::Fallen => (0.0, 1.0),
                };
                rider.lean_rate = self.rider.lean_acceleration(&state.rider, &gains, feet, control);
                (throttle, brake) = (ahead.throttle, ahead.brake);
            }
            if stage == Stage::Riding {
                place = follower.place_rate(state, feet);
            }
        }

        let mut torque = self.rider.torque(&state.rider, &state.lateral, &gains, feet);
        if self.follower.is_some() {
            torque = torque.clamp(-STRONGEST_TORQUE, STRONGEST_TORQUE);
        }
        let actions =
            Actions { torque, torso: state.rider.torso, torso_acceleration: rider.torso_rate, wind: -input.wind.y };
        let mut lateral = self.lateral.derivative(&state.lateral, speed, feet, &actions);

        let mut extra_weight = self.extra_weight(&state.lateral, &lateral, speed);
        let mut loads = self.suspension.loads(&state.suspension, extra_weight);
        let (mut limits, mut grip_limited, mut on_tyres) = (None, false, state.lateral);
        if self.follower.is_some() {
            // Limits depend on loads, and these on the acceleration within the limits.
            for _ in 0..GRIP_PASSES {
                let limited = self.grip_limits(&state.lateral, &loads);
                let (within, any) = held_state(&state.lateral, limited);
                (limits, grip_limited, on_tyres) = (Some(limited), any, within);
                if !any {
                    break;
                }
                lateral = self.lateral.derivative(&on_tyres, speed, feet, &actions);
                extra_weight = self.extra_weight(&state.lateral, &lateral, speed);
                loads = self.suspension.loads(&state.suspension, extra_weight);
            }
            if stage == Stage::Fallen {
                lateral = fallen_derivative(&state.lateral);
                extra_weight = self.extra_weight(&state.lateral, &lateral, speed);
            }
            loads = self.normal_loads(&on_tyres, &loads);
        }
        let lateral_forces = Wheels { front: on_tyres[place::FRONT_FORCE], rear: on_tyres[place::REAR_FORCE] };
        let forces = self.longitudinal.forces(&Situation {
            speed,
            throttle: state.throttle,
            brake: state.brake,
            wind: input.wind.x,
            loads,
            lateral: lateral_forces,
        });
        let (mut heave, moment) = self.suspension.push(&state.suspension, extra_weight, input.wind.z);
        let mut accelerations = self.longitudinal.accelerations(&forces, moment);
        if stage == Stage::Fallen {
            accelerations.speed =
                if speed > 0.0 { -grip::SLIDING_FRICTION_FRACTION * p.tyres.friction * p.run.gravity } else { 0.0 };
            (heave, accelerations.pitch) = settling_accelerations(&state.suspension);
        }

        let (sin, cos) = libm::sincos(state.heading);
        let to_left = -state.lateral[place::VELOCITY];
        let derivative = State {
            position: Vector2::new(speed * cos - to_left * sin, speed * sin + to_left * cos),
            heading: -state.lateral[place::YAW_RATE],
            speed: accelerations.speed,
            lateral,
            suspension: suspension::State {
                position: state.suspension.velocity,
                velocity: Vector2::new(heave, accelerations.pitch),
            },
            rider,
            throttle: (throttle - state.throttle) / p.longitudinal.drive_time,
            brake: (brake - state.brake) / p.longitudinal.brake_time,
            place,
        };
        Dynamics { derivative, forces, accelerations, loads, lateral_forces, torque, feet, grip: limits, grip_limited }
    }

    /// Friction of the tyres.
    fn friction(&self) -> Friction {
        Friction { along: self.parameters.tyres.friction, ratio: self.parameters.path.friction_ratio }
    }

    /// Limits of the lateral forces of the front and the rear tyre, for loads along the
    /// motorcycle's plane.
    fn grip_limits(&self, state: &lateral::State, loads: &Wheels) -> (grip::Limits, grip::Limits) {
        let of = |load: f64| self.friction().lateral(load, state[place::LEAN]);
        (of(loads.front), of(loads.rear))
    }

    /// Loads normal to the road.
    fn normal_loads(&self, state: &lateral::State, loads: &Wheels) -> Wheels {
        let of = |load: f64, force: f64| self.friction().normal(load, force, state[place::LEAN]);
        Wheels { front: of(loads.front, state[place::FRONT_FORCE]), rear: of(loads.rear, state[place::REAR_FORCE]) }
    }

    /// Starts the simulation of the next seconds at the motorcycle's state. None without a path, or
    /// after the path was left or a fall.
    fn begin_forerun(&mut self, input: &Input) {
        let on_path = self.follower.is_some() && !self.commanded && self.run.stage == Stage::Riding;
        self.forerun = on_path.then(|| Box::new(Forerun::new(self.run, self.record(&self.run, input))));
    }

    /// Keeps the simulation of the next seconds ahead of a motorcycle that has
    /// advanced by `step` seconds.
    fn look_ahead(&mut self, input: &Input, step: f64) {
        if self.follower.is_none() || self.commanded {
            return;
        }
        let here = self.run.state;
        let ended = self.run.stage != Stage::Riding;
        if ended || self.forerun.as_ref().is_none_or(|forerun| forerun.is_wrong(&here)) {
            self.begin_forerun(input);
        }
        if let Some(mut forerun) = self.forerun.take() {
            let inputs = [*input; 3];
            let advanced = |run: &RunState, size: f64| self.advanced(run, &inputs, size);
            forerun.follow(step, self.parameters.run.max_step, &here, advanced, |run| self.record(run, input));
            self.forerun = Some(forerun);
        }
    }

    /// A record of a ride.
    fn record(&self, run: &RunState, input: &Input) -> Record {
        let RunState { state, stage, .. } = run;
        let motion = self.motion(state, input, *stage, &self.ahead(state, *stage));
        let force = self.head(state, &motion.derivative).specific_force;
        let place = state.place;
        Record {
            distance: place.distance,
            speed: state.speed,
            deviation: place.deviation,
            surge: force.x,
            sway: force.y,
        }
    }

    /// Addition of leaning and cornering to gravity along the vertical of the motorcycle's plane
    /// \[m/s2\].
    fn extra_weight(&self, state: &lateral::State, derivative: &lateral::State, speed: f64) -> f64 {
        let roll = roll_motion(state, derivative);
        let (sin, cos) = libm::sincos(roll.position);
        let to_right = derivative[place::VELOCITY] + speed * state[place::YAW_RATE];
        self.parameters.run.gravity * (cos - 1.0) + to_right * sin
            - self.geometry.centre_height() * roll.velocity * roll.velocity
    }

    /// The outputs in the present state with these inputs.
    fn output_for(&self, input: &Input) -> Output {
        let RunState { state, stage, .. } = &self.run;
        let motion = self.motion(state, input, *stage, &self.ahead(state, *stage));
        let head = self.head(state, &motion.derivative);
        let felt = head.specific_force;
        let (preview_count, preview_surge, preview_sway) =
            self.forerun.as_ref().map_or((0, [0.0; _], [0.0; _]), |forerun| forerun.preview([felt.x, felt.y]));
        let lateral = &state.lateral;
        let travel = self.suspension.travel(&state.suspension.position);
        let angular_velocity = match self.parameters.run.angular_velocity_frame {
            AngularVelocityFrame::World => head.angular_velocity,
            AngularVelocityFrame::Body => head.orientation.rotation.transpose() * head.angular_velocity,
        };
        Output {
            specific_force: felt,
            angular_velocity,
            orientation: head.orientation.angles,
            speed: state.speed,
            lean: state.rider.torso,
            position: Vector3::new(state.position.x, state.position.y, 0.0),
            acceleration: motion.derivative.speed,
            lateral_velocity: -lateral[place::VELOCITY],
            head_position: head.point.position,
            head_velocity: head.point.velocity,
            steer_angle: -lateral[place::STEER],
            steer_rate: -lateral[place::STEER_RATE],
            steer_torque: -motion.torque,
            lean_reference: state.rider.lean,
            feet_down: motion.feet,
            throttle: state.throttle,
            brake: state.brake,
            front_load: motion.loads.front,
            rear_load: motion.loads.rear,
            front_longitudinal: motion.accelerations.tyres.front,
            rear_longitudinal: motion.accelerations.tyres.rear,
            front_lateral: -motion.lateral_forces.front,
            rear_lateral: -motion.lateral_forces.rear,
            front_travel: travel.front,
            rear_travel: travel.rear,
            friction_limited: motion.forces.friction_limited,
            wheel_lift_limited: motion.forces.lift_limited,
            path_distance: state.place.distance,
            path_deviation: -state.place.deviation,
            path_heading: -state.place.heading,
            planned_speed: self.follower.as_ref().map_or(0.0, |on| on.planned_speed(state.place.distance)),
            grip_limited: self.run.grip_limited,
            off_path: *stage == Stage::OffPath,
            fallen: *stage == Stage::Fallen,
            preview_count,
            preview_step: PREVIEW_STEP,
            preview_surge,
            preview_sway,
        }
    }

    /// The head's motion, from a state and its derivative.
    fn head(&self, state: &State, derivative: &State) -> Head {
        let (rider, suspension) = (&state.rider, &state.suspension);
        let yaw_rate = -state.lateral[place::YAW_RATE];
        let to_left = -state.lateral[place::VELOCITY];
        let axes = libm::sincos(state.heading);
        let along_heading = |x: f64, y: f64| Vector3::new(x * axes.1 - y * axes.0, x * axes.0 + y * axes.1, 0.0);
        let component = |k: usize| Motion {
            position: suspension.position[k],
            velocity: suspension.velocity[k],
            acceleration: derivative.suspension.velocity[k],
        };
        self.geometry.head(&Moving {
            roll: roll_motion(&state.lateral, &derivative.lateral),
            pitch: component(1),
            yaw: Motion {
                position: state.heading,
                velocity: yaw_rate,
                acceleration: -derivative.lateral[place::YAW_RATE],
            },
            heave: component(0),
            torso: Motion {
                position: rider.torso,
                velocity: rider.torso_rate,
                acceleration: derivative.rider.torso_rate,
            },
            contact: Point {
                position: Vector3::new(state.position.x, state.position.y, 0.0),
                velocity: along_heading(state.speed, to_left),
                acceleration: along_heading(
                    derivative.speed - yaw_rate * to_left,
                    yaw_rate * state.speed - derivative.lateral[place::VELOCITY],
                ),
            },
        })
    }
}

/// A lateral state with the tyres' forces within these limits, and whether any was beyond.
fn held_state(state: &lateral::State, limits: (grip::Limits, grip::Limits)) -> (lateral::State, bool) {
    let (mut held, mut any) = (*state, false);
    for (tyre, (least, most)) in [(place::FRONT_FORCE, limits.0), (place::REAR_FORCE, limits.1)] {
        held[tyre] = held[tyre].max(least).min(most);
        any |= held[tyre] != state[tyre];
    }
    (held, any)
}

/// The derivative of a fallen motorcycle's lateral state: all rates end, and the tyres' forces.
fn fallen_derivative(state: &lateral::State) -> lateral::State {
    let mut derivative = -state / grip::FALLEN_SETTLING_TIME;
    derivative[place::LEAN] = state[place::LEAN_RATE];
    derivative[place::STEER] = state[place::STEER_RATE];
    derivative
}

/// Accelerations of a fallen motorcycle's heave and pitch: back to rest, without overshoot.
fn settling_accelerations(state: &suspension::State) -> (f64, f64) {
    let rate = 1.0 / grip::FALLEN_SETTLING_TIME;
    let back = -(state.velocity * 2.0 + state.position * rate) * rate;
    (back.x, back.y)
}

/// The roll angle, whose tangent the lateral equations' lean is, and its derivatives.
fn roll_motion(state: &lateral::State, derivative: &lateral::State) -> Motion {
    let tangent = state[place::LEAN];
    let cos2 = 1.0 / (1.0 + tangent * tangent);
    let velocity = cos2 * state[place::LEAN_RATE];
    Motion {
        position: libm::atan(tangent),
        velocity,
        acceleration: cos2 * derivative[place::LEAN_RATE] - 2.0 * tangent * velocity * velocity,
    }
}

/// Linear interpolation between two inputs, `t` from 0 to 1.
fn input_between(start: &Input, end: &Input, t: f64) -> Input {
    let number = |from: f64, to: f64| from + t * (to - from);
    Input {
        throttle: number(start.throttle, end.throttle),
        brake: number(start.brake, end.brake),
        lean: number(start.lean, end.lean),
        rider_lean: number(start.rider_lean, end.rider_lean),
        wind: start.wind.zip_map(&end.wind, number),
    }
}
