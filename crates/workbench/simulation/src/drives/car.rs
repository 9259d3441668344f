//! A linear single-track car (Riekert and Schunck, 1940) with a body that rolls.
//!
//! The states are the sideslip angle, the yaw rate and the roll. Inputs are the curvature that the
//! driver steers for, which is a steering angle by the car's own characteristic, and the
//! acceleration along the road. Both are functions of time in closed form.

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY as GRAVITY;
use moris_washout::nalgebra::Vector4;
use serde::Deserialize;

use super::smooth::{Change, changes, changes_integral};
use crate::Manoeuvre;
use crate::measures::sickness::runge_kutta;

/// Time between samples \[s\].
pub const STEP: f64 = 0.01;
/// Speed below which the tyres' equations are those at it \[m/s\]; they are singular at rest.
const MIN_TYRE_SPEED: f64 = 3.0;

/// A car.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Car {
    /// Mass of the car \[kg\].
    pub mass: f64,
    /// Moment of inertia about the vertical axis \[kg m2\].
    pub inertia: f64,
    /// Distance of the front axle from the centre of gravity \[m\].
    pub to_front: f64,
    /// Distance of the rear axle from the centre of gravity \[m\].
    pub to_rear: f64,
    /// Cornering stiffness of the front axle \[N/rad\].
    pub front_stiffness: f64,
    /// Cornering stiffness of the rear axle \[N/rad\].
    pub rear_stiffness: f64,
    /// Roll of the body to a lateral acceleration \[rad/(m/s2)\].
    pub roll_gradient: f64,
    /// Natural frequency \[rad/s\] and damping ratio of the roll.
    pub roll: [f64; 2],
}

/// A passenger car.
pub const PASSENGER_CAR: Car = Car {
    mass: 1500.0,
    inertia: 2500.0,
    to_front: 1.2,
    to_rear: 1.5,
    front_stiffness: 100e3,
    rear_stiffness: 120e3,
    roll_gradient: 0.006,
    roll: [9.0, 0.5],
};

/// A drive of a car.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Course {
    /// The car.
    pub car: Car,
    /// Duration of the drive \[s\].
    pub duration: f64,
    /// Speed at the start \[m/s\].
    pub speed: f64,
    /// Changes of the acceleration along the road \[m/s2\].
    pub along: Vec<Change>,
    /// Changes of the curvature that is steered for \[1/m\].
    pub curvature: Vec<Change>,
    /// Waves of the curvature: amplitude \[1/m\], frequency \[Hz\], start and
    /// end of the waves \[s\].
    pub weaving: Option<[f64; 4]>,
    /// Waves of the road, felt as heave: amplitude \[m/s2\] and frequency \[Hz\].
    pub road: Vec<[f64; 2]>,
}

/// A course of the passenger car without bends, braking or waves.
impl Default for Course {
    fn default() -> Self {
        let (along, curvature, road) = (Vec::new(), Vec::new(), Vec::new());
        Course { car: PASSENGER_CAR, duration: 30.0, speed: 20.0, along, curvature, weaving: None, road }
    }
}

/// Sideslip angle, yaw rate, roll and roll rate.
type State = [f64; 4];

impl Course {
    /// Speed \[m/s\]; never below zero.
    pub fn speed_at(&self, t: f64) -> f64 {
        (self.speed + changes_integral(&self.along, t)).max(0.0)
    }

    /// Acceleration along the road \[m/s2\]; none once the car stands.
    fn along_at(&self, t: f64) -> f64 {
        let acceleration = changes(&self.along, t);
        if self.speed_at(t) > 0.0 || acceleration > 0.0 { acceleration } else { 0.0 }
    }

    fn curvature_at(&self, t: f64) -> f64 {
        let weaving = self.weaving.map_or(0.0, |[amplitude, frequency, start, end]| {
            let fade = changes(&[(1.0, start, 2.0), (-1.0, end - 2.0, 2.0)], t);
            amplitude * fade * (std::f64::consts::TAU * frequency * (t - start)).sin()
        });
        changes(&self.curvature, t) + weaving
    }

    /// Derivatives of the state, and the lateral acceleration.
    fn derivative(&self, t: f64, [slip, yaw_rate, roll, roll_rate]: State) -> (State, f64) {
        let Car { mass, inertia, to_front, to_rear, front_stiffness, rear_stiffness, .. } = self.car;
        let speed = self.speed_at(t);
        let v = speed.max(MIN_TYRE_SPEED);
        // The steering angle of a steady bend of this curvature: wheelbase and understeer.
        let base = to_front + to_rear;
        let understeer =
            mass * (to_rear * rear_stiffness - to_front * front_stiffness) / (base * front_stiffness * rear_stiffness);
        let steering = self.curvature_at(t) * (base + understeer * v * v);
        let front = front_stiffness * (steering - slip - to_front * yaw_rate / v);
        let rear = rear_stiffness * (to_rear * yaw_rate / v - slip);
        let lateral = (front + rear) / mass;
        let yaw_acceleration = (to_front * front - to_rear * rear) / inertia;
        let [frequency, damping] = self.car.roll;
        let wanted = self.car.roll_gradient * lateral;
        let roll_acceleration = frequency * frequency * (wanted - roll) - 2.0 * damping * frequency * roll_rate;
        // Below the slowest speed, forces fade with the square of the speed.
        let fade = (speed / v).powi(2);
        ([lateral / v - yaw_rate, yaw_acceleration, roll_rate, roll_acceleration], fade * lateral)
    }

    fn advanced(&self, t: f64, state: State, step: f64) -> State {
        let slope = |&state: &Vector4<f64>, fraction| self.derivative(t + fraction * step, state.into()).0.into();
        runge_kutta(state.into(), step, slope).into()
    }

    /// The motion of the driver's head, in axes that roll with the body.
    pub fn manoeuvre(&self) -> Manoeuvre {
        // Integration steps to a sample.
        const STEPS_PER_SAMPLE: usize = 10;
        let count = (self.duration / STEP).round() as usize;
        let mut state = State::default();
        let inputs = (0..=count).map(|k| {
            let t = k as f64 * STEP;
            let (_, lateral) = self.derivative(t, state);
            let input = self.input(t, lateral, &state);
            for substep in 0..STEPS_PER_SAMPLE {
                let step = STEP / STEPS_PER_SAMPLE as f64;
                state = self.advanced(t + substep as f64 * step, state, step);
            }
            input
        });
        Manoeuvre::new(STEP, inputs.collect())
    }

    fn input(&self, t: f64, lateral: f64, &[_, yaw_rate, roll, roll_rate]: &State) -> Input {
        let waves =
            self.road.iter().enumerate().map(|(k, [amplitude, frequency])| {
                amplitude * (std::f64::consts::TAU * frequency * t + k as f64).sin()
            });
        let fade = changes(&[(1.0, 0.5, 1.5), (-1.0, self.duration - 2.0, 1.5)], t);
        let vertical = GRAVITY + fade * waves.sum::<f64>();
        let (sin, cos) = roll.sin_cos();
        let speed = self.speed_at(t);
        let yaw_rate = yaw_rate * (speed / speed.max(MIN_TYRE_SPEED)).powi(2);
        let mut input = Input { speed, ..Input::default() };
        input.specific_force.x = self.along_at(t);
        input.specific_force.y = cos * lateral + sin * vertical;
        input.specific_force.z = cos * vertical - sin * lateral;
        input.angular_velocity.x = roll_rate;
        input.angular_velocity.y = sin * yaw_rate;
        input.angular_velocity.z = cos * yaw_rate;
        input
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bend of constant speed and curvature, long enough to be steady.
    fn bend() -> Course {
        Course { duration: 20.0, curvature: vec![(0.01, 2.0, 2.0)], ..Course::default() }
    }

    #[test]
    fn a_steady_bend_has_the_curvature_that_is_steered_for() {
        let manoeuvre = bend().manoeuvre();
        let last = manoeuvre.inputs().last().unwrap();
        let lateral = 20.0 * 20.0 * 0.01;
        let roll = PASSENGER_CAR.roll_gradient * lateral;
        assert!((last.angular_velocity.z - 20.0 * 0.01 * roll.cos()).abs() < 1e-6, "{last:?}");
        let expected = lateral * roll.cos() + GRAVITY * roll.sin();
        assert!((last.specific_force.y - expected).abs() < 1e-5, "{last:?}");
    }

    /// The yaw response to a small step has the natural frequency of the textbook's formula.
    #[test]
    fn the_yaw_rate_overshoots_as_the_characteristic_equation_says() {
        let course = Course { speed: 40.0, curvature: vec![(1e-3, 1.0, 1e-6)], ..bend() };
        let rates: Vec<f64> = course.manoeuvre().inputs().iter().map(|input| input.angular_velocity.z).collect();
        let Car { mass: m, inertia: j, to_front: a, to_rear: b, front_stiffness: f, rear_stiffness: r, .. } =
            PASSENGER_CAR;
        let v = 40.0;
        let damping = (f + r) / (m * v) + (a * a * f + b * b * r) / (j * v);
        let stiffness = f * r * (a + b).powi(2) / (m * j * v * v) + (b * r - a * f) / j;
        let damped = (stiffness - 0.25 * damping * damping).sqrt();
        let deviation: Vec<f64> = rates.iter().map(|rate| rate / rates[2000] - 1.0).collect();
        let crossings: Vec<usize> = (101..700).filter(|&k| deviation[k] * deviation[k + 1] < 0.0).collect();
        let half_period = STEP * (crossings[1] - crossings[0]) as f64;
        assert!((half_period - std::f64::consts::PI / damped).abs() < 0.03, "{half_period} {damped}");
    }

    #[test]
    fn a_car_at_rest_feels_gravity_alone() {
        let stop = Course { speed: 10.0, along: vec![(-5.0, 2.0, 0.2)], ..bend() };
        let manoeuvre = stop.manoeuvre();
        let last = manoeuvre.inputs().last().unwrap();
        assert_eq!((last.speed, last.specific_force.x, last.angular_velocity.z), (0.0, 0.0, 0.0));
        assert!((last.specific_force.z - GRAVITY).abs() < 0.03);
    }
}
