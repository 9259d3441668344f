//! The whole: parameters, state, and a step.

use moris_interface::{Group, Identity, Model, ParameterError, SHORTEST_STEP};
use moris_washout::interface::AngularVelocityFrame;
use moris_washout::motion::braking_law::Motion;
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::check::{check, check_change, check_step, design_rider, fastest};
use crate::identity::IDENTITY;
use crate::interface::{Input, Output, Parameters};
use crate::lateral::{self, Actions, Lateral, Wheels, foot_support, place};
use crate::longitudinal::{Accelerations, Forces, Longitudinal, Situation};
use crate::output_rate::{mean_rate, rest_rate};
use crate::pose::{Geometry, Head, Moving, Point};
use crate::rider::Rider;
use crate::state::State;
use crate::suspension::{self, Suspension};

/// Largest number of internal steps in a communication step.
pub const MOST_INTERNAL_STEPS: f64 = 100_000.0;

/// Limit of the wind force along each axis \[N\]: about that of 30 m/s from the side.
pub const STRONGEST_WIND: f64 = 600.0;

/// A motorcycle and its rider.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Motorcycle {
    parameters: Parameters,
    lateral: Lateral,
    longitudinal: Longitudinal,
    suspension: Suspension,
    geometry: Geometry,
    rider: Rider,
    state: State,
    output: Output,
    output_derivative: Output,
}

/// A state's derivative with intermediate results.
struct Dynamics {
    derivative: State,
    forces: Forces,
    accelerations: Accelerations,
    loads: Wheels,
    torque: f64,
    feet: f64,
}

impl Model for Motorcycle {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = IDENTITY;

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
        let state = State {
            position: Vector2::zeros(),
            heading: parameters.run.initial_heading,
            speed: parameters.run.initial_speed,
            lateral: lateral::State::zeros(),
            suspension: suspension::State { position: Vector2::zeros(), velocity: Vector2::zeros() },
            rider: crate::rider::State::default(),
            throttle: 0.0,
            brake: 0.0,
        };
        let mut motorcycle = Motorcycle {
            parameters: *parameters,
            lateral,
            longitudinal,
            suspension,
            geometry: Geometry::new(parameters),
            rider,
            state,
            output: Output::default(),
            output_derivative: rest_rate(),
        };
        motorcycle.output = motorcycle.output_for(&input.sanitized());
        Ok(motorcycle)
    }

    /// Changes tunable parameters. Positions, angles, their rates and the rider's torque on the
    /// bars do not jump; accelerations may.
    ///
    /// The rider's gains are designed again if `rider.torqueWeight` changes or the top speed
    /// exceeds their range. This takes some milliseconds.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why; fixed ones cannot be changed. Nothing has
    /// changed then.
    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        check_change(&self.parameters, parameters)?;
        let longitudinal = Longitudinal::new(parameters);
        let suspension = Suspension::new(parameters);
        let fastest = fastest(parameters, &longitudinal)?;
        let same_gains = parameters.rider.torque_weight == self.parameters.rider.torque_weight;
        if same_gains && fastest <= self.rider.fastest() {
            check_step(parameters, &suspension)?;
            self.rider.set_limits(parameters);
        } else {
            let (_, rider) = design_rider(parameters, &suspension, fastest.max(self.state.speed))?;
            let State { rider: state, lateral, speed, .. } = &self.state;
            let error = rider.error_for_torque_of(&self.rider, state, lateral, *speed);
            self.state.rider.error = error;
            self.rider = rider;
        }
        self.longitudinal = longitudinal;
        self.suspension = suspension;
        self.parameters = *parameters;
        Ok(())
    }

    fn longest_step(&self) -> f64 {
        MOST_INTERNAL_STEPS * self.parameters.run.max_step
    }

    /// In equal internal steps of solver.maxStep at most. Any step is safe: one shorter than
    /// [`SHORTEST_STEP`] does nothing, and one longer than [`MOST_INTERNAL_STEPS`] internal
    /// steps is cut off there.
    fn step_between(&mut self, start: &Input, end: &Input, step: f64) {
        if step.is_nan() || step < SHORTEST_STEP {
            return;
        }
        let longest = self.parameters.run.max_step;
        let step = step.min(MOST_INTERNAL_STEPS * longest);
        let (start, end) = (start.sanitized(), end.sanitized());
        let steps = libm::ceil((step / longest - 1e-6).max(1.0));
        let size = step / steps;
        for k in 0..steps as u32 {
            let at = |t: f64| between(&start, &end, (f64::from(k) + t) / steps);
            self.advance([at(0.0), at(0.5), at(1.0)], size);
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
        &self.state
    }

    /// One step by the classical Runge-Kutta rule. A speed below zero becomes zero.
    fn advance(&mut self, [start, middle, end]: [Input; 3], size: f64) {
        let state = self.state;
        let k1 = self.motion(&state, &start).derivative;
        let k2 = self.motion(&state.plus(&k1, 0.5 * size), &middle).derivative;
        let k3 = self.motion(&state.plus(&k2, 0.5 * size), &middle).derivative;
        let k4 = self.motion(&state.plus(&k3, size), &end).derivative;
        let end = state.plus(&k1, size / 6.0).plus(&k2, size / 3.0).plus(&k3, size / 3.0).plus(&k4, size / 6.0);
        self.state = end.flush_small();
        self.state.speed = self.state.speed.max(0.0);
    }

    /// The equations of motion.
    fn motion(&self, state: &State, input: &Input) -> Dynamics {
        let p = &self.parameters;
        let speed = state.speed.max(0.0);
        let feet = foot_support(speed, p.rider.feet_speed);
        let gains = self.rider.gains(speed);
        let command = (input.lean, input.rider_lean);
        let rider = self.rider.derivative(&state.rider, &state.lateral, &gains, feet, command);

        let torque = self.rider.torque(&state.rider, &state.lateral, &gains, feet);
        let actions =
            Actions { torque, torso: state.rider.torso, torso_acceleration: rider.torso_rate, wind: -input.wind.y };
        let lateral = self.lateral.derivative(&state.lateral, speed, feet, &actions);

        let extra_weight = self.extra_weight(&state.lateral, &lateral, speed);
        let loads = self.suspension.loads(&state.suspension, extra_weight);
        let forces = self.longitudinal.forces(&Situation {
            speed,
            throttle: state.throttle,
            brake: state.brake,
            wind: input.wind.x,
            loads,
            lateral: Wheels { front: state.lateral[place::FRONT_FORCE], rear: state.lateral[place::REAR_FORCE] },
        });
        let (heave, moment) = self.suspension.push(&state.suspension, extra_weight, input.wind.z);
        let accelerations = self.longitudinal.accelerations(&forces, moment);

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
            throttle: (input.throttle - state.throttle) / p.longitudinal.drive_time,
            brake: (input.brake - state.brake) / p.longitudinal.brake_time,
        };
        Dynamics { derivative, forces, accelerations, loads, torque, feet }
    }

    /// Addition of leaning and cornering to gravity along the vertical of the motorcycle's plane
    /// \[m/s2\].
    fn extra_weight(&self, state: &lateral::State, derivative: &lateral::State, speed: f64) -> f64 {
        let roll = roll(state, derivative);
        let (sin, cos) = libm::sincos(roll.position);
        let to_right = derivative[place::VELOCITY] + speed * state[place::YAW_RATE];
        self.parameters.run.gravity * (cos - 1.0) + to_right * sin
            - self.geometry.centre_height() * roll.velocity * roll.velocity
    }

    /// The outputs in the present state with these inputs.
    fn output_for(&self, input: &Input) -> Output {
        let state = &self.state;
        let motion = self.motion(state, input);
        let head = self.head(&motion.derivative);
        let lateral = &state.lateral;
        let travel = self.suspension.travel(&state.suspension.position);
        let angular_velocity = match self.parameters.run.angular_velocity_frame {
            AngularVelocityFrame::World => head.angular_velocity,
            AngularVelocityFrame::Body => head.orientation.rotation.transpose() * head.angular_velocity,
        };
        Output {
            specific_force: head.specific_force,
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
            front_lateral: -lateral[place::FRONT_FORCE],
            rear_lateral: -lateral[place::REAR_FORCE],
            front_travel: travel.front,
            rear_travel: travel.rear,
            friction_limited: motion.forces.friction_limited,
            wheel_lift_limited: motion.forces.lift_limited,
        }
    }

    /// The head's motion, from the state and its derivative.
    fn head(&self, derivative: &State) -> Head {
        let state = &self.state;
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
            roll: roll(&state.lateral, &derivative.lateral),
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

/// The roll angle, whose tangent the lateral equations' lean is, and its derivatives.
fn roll(state: &lateral::State, derivative: &lateral::State) -> Motion {
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
fn between(start: &Input, end: &Input, t: f64) -> Input {
    let number = |from: f64, to: f64| from + t * (to - from);
    Input {
        throttle: number(start.throttle, end.throttle),
        brake: number(start.brake, end.brake),
        lean: number(start.lean, end.lean),
        rider_lean: number(start.rider_lean, end.rider_lean),
        wind: start.wind.zip_map(&end.wind, number),
    }
}
