//! Heave and pitch: the sprung mass on two upright springs and dampers, in the motorcycle's leaning plane.
//!
//! m h'' = F_f + F_r + W_z - m n, I p'' = -M - l_f F_f + l_r F_r - x_w W_z, with heave h upwards and pitch p nose down
//! from rest, F the springs' and dampers' change since rest, n what gravity and motion add to the specific force in the plane, and M
//! the moment of drive, brakes and drag.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use crate::interface::Parameters;
use crate::lateral::{Wheels, bicycle, static_loads};

/// Masses, springs and dampers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Suspension {
    parameters: crate::interface::Suspension,
    /// Sprung mass \[kg\] and its moment of inertia of pitch \[kg m2\].
    mass: f64,
    inertia: f64,
    /// Unsprung masses \[kg\].
    wheels: Wheels,
    static_loads: Wheels,
    /// Distances of the wheels from the centre of mass, along the road \[m\].
    arms: Wheels,
    /// Distance of the wind's centre of pressure ahead of the centre of mass \[m\].
    wind_arm: f64,
}

/// Heave and pitch (nose down) and their rates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    pub position: Vector2<f64>,
    pub velocity: Vector2<f64>,
}

/// What acts on the sprung mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actions {
    /// See [`crate::longitudinal::Outcome::pitching_moment`] \[N m\].
    pub pitching_moment: f64,
    /// Specific force along the plane's vertical, less gravity: what leaning and cornering add \[m/s2\].
    pub extra_weight: f64,
    /// Upward force of the wind \[N\].
    pub wind: f64,
}

impl Suspension {
    /// From the parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let machine = &parameters.machine;
        let bicycle = bicycle(machine);
        let t = bicycle.totals();
        let (frame, fork) = (bicycle.b, bicycle.h);
        let about_centre = |x: f64, z: f64, mass: f64| mass * ((x - t.x_t) * (x - t.x_t) + (z - t.z_t) * (z - t.z_t));
        Suspension {
            parameters: parameters.suspension,
            mass: frame.m + fork.m,
            inertia: machine.frame_yy + about_centre(frame.x, frame.z, frame.m) + about_centre(fork.x, fork.z, fork.m),
            wheels: Wheels { front: bicycle.f.m, rear: bicycle.r.m },
            static_loads: static_loads(&bicycle, parameters.run.gravity),
            arms: Wheels { front: bicycle.w - t.x_t, rear: t.x_t },
            wind_arm: 0.5 * bicycle.w - t.x_t,
        }
    }

    /// Compressions since rest from heave and pitch, or their rates from those rates.
    pub fn travel(&self, motion: &Vector2<f64>) -> Wheels {
        let (heave, pitch) = (motion.x, motion.y);
        Wheels { front: self.arms.front * pitch - heave, rear: -self.arms.rear * pitch - heave }
    }

    /// Loads of the tyres on the road \[N\]. A tyre does not pull: where its load would be negative it is zero.
    pub fn loads(&self, state: &State, extra_weight: f64) -> Wheels {
        let forces = self.forces(state, extra_weight);
        let load = |at_rest: f64, wheel: f64, force: f64| (at_rest + wheel * extra_weight + force).max(0.0);
        Wheels {
            front: load(self.static_loads.front, self.wheels.front, forces.front),
            rear: load(self.static_loads.rear, self.wheels.rear, forces.rear),
        }
    }

    /// What springs and dampers push upwards more than at rest; not less than a tyre that does not pull lets them.
    fn forces(&self, state: &State, extra_weight: f64) -> Wheels {
        let p = &self.parameters;
        let (travel, rate) = (self.travel(&state.position), self.travel(&state.velocity));
        let least = |at_rest: f64, wheel: f64| -at_rest - wheel * extra_weight;
        Wheels {
            front: (p.front_stiffness * travel.front + p.front_damping * rate.front)
                .max(least(self.static_loads.front, self.wheels.front)),
            rear: (p.rear_stiffness * travel.rear + p.rear_damping * rate.rear)
                .max(least(self.static_loads.rear, self.wheels.rear)),
        }
    }

    /// Accelerations of heave and pitch.
    pub fn acceleration(&self, state: &State, actions: &Actions) -> Vector2<f64> {
        let forces = self.forces(state, actions.extra_weight);
        Vector2::new(
            (forces.front + forces.rear + actions.wind) / self.mass - actions.extra_weight,
            (self.arms.rear * forces.rear
                - self.arms.front * forces.front
                - actions.pitching_moment
                - self.wind_arm * actions.wind)
                / self.inertia,
        )
    }

    /// The largest magnitude of the free motion's poles \[rad/s\], or an upper bound of it.
    pub fn fastest_pole(&self) -> f64 {
        let p = &self.parameters;
        // Each axle alone, carrying no more than its share of mass and inertia lets it feel.
        let axle = |stiffness: f64, damping: f64, arm: f64| {
            let compliance = 1.0 / self.mass + arm * arm / self.inertia;
            libm::sqrt(stiffness * compliance) + damping * compliance
        };
        axle(p.front_stiffness, p.front_damping, self.arms.front)
            + axle(p.rear_stiffness, p.rear_damping, self.arms.rear)
    }
}
