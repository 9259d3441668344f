//! The rider on a path: lean, throttle and brakes.

use moris_interface::{ParameterError, refuse};
use serde::{Deserialize, Serialize};

use super::preview_rider::{PREVIEW_INTERVAL, PREVIEW_INTERVALS, PreviewRider, plant_state};
use super::speed_plan::{Limits, SpeedPlan};
use super::table::Table;
use crate::interface::Parameters;
use crate::lateral::{Lateral, place};
use crate::longitudinal::Longitudinal;
use crate::rider::{Rider, SUPPORT_FORGETTING_TIME, within};
use crate::state::{PathState, State};

/// A path, the plan of the speed along it, and the gains of the rider who follows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Follower {
    table: Table,
    plan: SpeedPlan,
    rider: PreviewRider,
    /// Planned limits \[m/s2\].
    forward: f64,
    backward: f64,
    /// Largest lateral force of the tyres over their load, and the hardest braking upright
    /// \[m/s2\].
    friction: f64,
    hardest: f64,
}

/// Actions over an internal step that the path ahead causes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ahead {
    /// Part of the second derivative of the reference lean's tangent \[1/s2\].
    pub lean: f64,
    /// Commands from 0 to 1.
    pub throttle: f64,
    pub brake: f64,
}

impl Follower {
    /// The rider on the path that the parameters choose; `None` without one.
    ///
    /// # Errors
    /// A row of the path cannot be used, or the rider's parameters permit no path following.
    pub fn new(
        parameters: &Parameters,
        lateral: &Lateral,
        rider: &Rider,
        longitudinal: &Longitudinal,
    ) -> Result<Option<Box<Self>>, ParameterError> {
        // Fraction of the friction that the hardest braking takes.
        const HARD_BRAKING_FRACTION: f64 = 0.8;
        let Some(table) = Table::new(&parameters.path)? else { return Ok(None) };
        let limits = Limits::new(parameters);
        let Some(preview) = PreviewRider::new(lateral, rider) else {
            return refuse(
                "rider.torqueWeight",
                format!(
                    "is {} N m; no reference lean keeps this motorcycle on a path; change rider.torqueWeight, the masses or the \
                     tyres",
                    parameters.rider.torque_weight
                ),
            );
        };
        Ok(Some(Box::new(Follower {
            table,
            plan: SpeedPlan::new(&table, &limits, longitudinal),
            rider: preview,
            forward: limits.forward,
            backward: limits.backward,
            friction: parameters.tyres.friction * parameters.path.friction_ratio,
            hardest: HARD_BRAKING_FRACTION * parameters.tyres.friction * parameters.run.gravity,
        })))
    }

    /// The path.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The rider's gains.
    pub fn rider(&self) -> &PreviewRider {
        &self.rider
    }

    /// Planned speed at a distance \[m/s\].
    pub fn planned_speed(&self, distance: f64) -> f64 {
        self.plan_at(distance).0
    }

    /// Planned speed and acceleration at a distance; the last speed beyond the end.
    fn plan_at(&self, distance: f64) -> (f64, f64) {
        let (speed, acceleration) = self.plan.at(self.table.find(distance));
        if self.table.is_over(distance) { (speed, 0.0) } else { (speed, acceleration) }
    }

    /// Acceleration of the speed control \[m/s2\].
    fn acceleration(&self, (planned, acceleration): (f64, f64), speed: f64) -> f64 {
        // Gain of the speed control [1/s].
        const SPEED_GAIN: f64 = 1.5;
        (acceleration + SPEED_GAIN * (planned - speed)).min(self.forward)
    }

    /// The hardest braking that leaves the rear tyre its lateral force: braking takes load from it
    /// \[m/s2\].
    fn hardest(&self, state: &State) -> f64 {
        let used = state.lateral[place::LEAN].abs() / self.friction;
        self.hardest * (1.0 - used).max(0.0)
    }

    /// The rider's actions for the path ahead.
    pub fn ahead(&self, state: &State, longitudinal: &Longitudinal) -> Ahead {
        // Samples of the preview over which the planned acceleration is averaged: the lags of drive
        // and brakes, and less jerk.
        const SMOOTHED_SAMPLES: usize = 4;
        // Planned speed below which the rider stops [m/s].
        const STOPPING_SPEED: f64 = 0.3;
        let (distance, speed) = (state.place.distance, state.speed);
        let gains = self.rider.gains(speed);
        let mut steady_leans = [0.0; PREVIEW_INTERVALS + 1];
        let (mut place, mut pace, mut planned) = (distance, speed, 0.0);
        for (k, steady_lean) in steady_leans.iter_mut().enumerate() {
            let plan = self.plan_at(place);
            *steady_lean = self.table.curvature_at(place) * pace * pace * gains.lean_per_acceleration;
            if k < SMOOTHED_SAMPLES {
                planned += plan.1 / SMOOTHED_SAMPLES as f64;
            }
            let change = self.acceleration(plan, pace) * PREVIEW_INTERVAL;
            place += (pace + 0.5 * change).max(0.0) * PREVIEW_INTERVAL;
            pace = (pace + change).max(0.0);
        }
        let now = self.plan_at(distance).0;
        let demand = if now < STOPPING_SPEED { -self.backward } else { self.acceleration((now, planned), speed) };
        let demand = demand.max(-self.hardest(state));
        let (throttle, brake) = longitudinal.pedals(demand, speed);
        Ahead { lean: gains.feedforward(&steady_leans), throttle, brake }
    }

    /// Throttle and brakes of a rider who has left the path.
    pub fn stop(&self, state: &State, longitudinal: &Longitudinal) -> Ahead {
        let (throttle, brake) = longitudinal.pedals(-self.backward.min(self.hardest(state)), state.speed);
        Ahead { lean: 0.0, throttle, brake }
    }

    /// Second derivative of the reference lean's tangent \[1/s2\].
    pub fn lean_control(&self, state: &State, ahead: &Ahead) -> f64 {
        // Deviation [m] and heading [rad] of which the lean control takes account.
        const LARGEST_DEVIATION: f64 = 1.5;
        const LARGEST_HEADING: f64 = 0.3;
        let gains = self.rider.gains(state.speed);
        let (rider, place) = (&state.rider, &state.place);
        let lean = libm::tan(rider.lean);
        let curvature = self.table.curvature_at(place.distance);
        let steady_lean = curvature * state.speed * state.speed * gains.lean_per_acceleration;
        let others = [
            rider.error,
            lean,
            rider.lean_rate * (1.0 + lean * lean),
            rider.torso,
            rider.torso_rate,
            within(place.deviation, LARGEST_DEVIATION),
            within(place.heading, LARGEST_HEADING),
            place.integral,
        ];
        let plant = plant_state(&state.lateral, others);
        ahead.lean + gains.feedback(&plant, steady_lean)
    }

    /// Rate of the place beside the path: the kinematics of a point beside a curve.
    pub fn place_rate(&self, state: &State, feet: f64) -> PathState {
        // Deviation that accumulates [m].
        const LARGEST_ACCUMULATED: f64 = 0.3;
        // Least distance from the path's centre of curvature, relative to its radius.
        const MIN_RELATIVE_CURVATURE_DISTANCE: f64 = 0.1;
        let PathState { distance, deviation, integral, heading } = state.place;
        let curvature = self.table.curvature_at(distance);
        let (sin, cos) = libm::sincos(heading);
        let to_right = state.lateral[place::VELOCITY];
        let along =
            (state.speed * cos - to_right * sin) / (1.0 - curvature * deviation).max(MIN_RELATIVE_CURVATURE_DISTANCE);
        let accumulated = (1.0 - feet) * within(deviation, LARGEST_ACCUMULATED);
        PathState {
            distance: along,
            deviation: state.speed * sin + to_right * cos,
            integral: accumulated - feet * integral / SUPPORT_FORGETTING_TIME,
            heading: state.lateral[place::YAW_RATE] - curvature * along,
        }
    }
}
