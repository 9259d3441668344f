//! Springs, dampers, heave and the tyres' loads, in the motorcycle's leaning plane.
//!
//! The sprung mass m rests on two upright springs and dampers. Heave u (up) and pitch p (nose down)
//! are relative to rest. F is the upward force of spring and damper beyond that at rest, W_z the
//! wind's upward force. Leaning and cornering add n to gravity along the plane. Then
//!
//! m u'' = F_f + F_r + W_z - m n,
//!
//! and the moment of springs and dampers about the centre of mass is l_r F_r - l_f F_f. The
//! equation of the pitch is coupled with that of the speed, see [`crate::longitudinal`].

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use crate::interface::Parameters;
use crate::lateral::{Wheels, bicycle, static_loads};

/// Masses, springs and dampers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Suspension {
    parameters: crate::interface::Suspension,
    /// Sprung mass \[kg\].
    mass: f64,
    /// Moment of inertia of pitch about the centre of mass \[kg m2\], to bound the poles.
    pitch_inertia: f64,
    /// Unsprung masses \[kg\].
    wheels: Wheels,
    static_loads: Wheels,
    /// Distances of the wheels from the centre of mass, along the road \[m\].
    arms: Wheels,
    /// Distance of the wind's centre of pressure ahead of the centre of mass \[m\].
    wind_arm: f64,
}

/// Heave and pitch (nose down) and their rates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    pub position: Vector2<f64>,
    pub velocity: Vector2<f64>,
}

impl Suspension {
    /// From the parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let machine = &parameters.machine;
        let bicycle = bicycle(machine);
        let t = bicycle.totals();
        Suspension {
            parameters: parameters.suspension,
            mass: bicycle.b.m + bicycle.h.m,
            pitch_inertia: machine.frame_yy,
            wheels: Wheels { front: bicycle.f.m, rear: bicycle.r.m },
            static_loads: static_loads(&bicycle, parameters.run.gravity),
            arms: Wheels { front: bicycle.w - t.x_t, rear: t.x_t },
            wind_arm: 0.5 * bicycle.w - t.x_t,
        }
    }

    /// Compressions relative to rest from heave and pitch, or their rates from those rates.
    pub fn travel(&self, motion: &Vector2<f64>) -> Wheels {
        let (heave, pitch) = (motion.x, motion.y);
        Wheels { front: self.arms.front * pitch - heave, rear: -self.arms.rear * pitch - heave }
    }

    /// Loads of the tyres on the road \[N\]. A tyre does not pull: where its load would be negative
    /// it is zero.
    pub fn loads(&self, state: &State, extra_weight: f64) -> Wheels {
        let forces = self.forces(state, extra_weight);
        let load = |at_rest: f64, wheel: f64, force: f64| (at_rest + wheel * extra_weight + force).max(0.0);
        Wheels {
            front: load(self.static_loads.front, self.wheels.front, forces.front),
            rear: load(self.static_loads.rear, self.wheels.rear, forces.rear),
        }
    }

    /// Upward forces of springs and dampers beyond those at rest, limited where a tyre would have
    /// to pull.
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

    /// Acceleration of heave, and the moment about the centre of mass, nose down \[N m\].
    /// `extra_weight` is the addition of leaning and cornering to gravity along the plane \[m/s2\],
    /// `wind` the wind's upward force \[N\].
    pub fn push(&self, state: &State, extra_weight: f64, wind: f64) -> (f64, f64) {
        let forces = self.forces(state, extra_weight);
        (
            (forces.front + forces.rear + wind) / self.mass - extra_weight,
            self.arms.rear * forces.rear - self.arms.front * forces.front - self.wind_arm * wind,
        )
    }

    /// Energy in springs and in heaving \[J\].
    pub fn energy(&self, state: &State) -> f64 {
        let p = &self.parameters;
        let travel = self.travel(&state.position);
        0.5 * (p.front_stiffness * travel.front * travel.front
            + p.rear_stiffness * travel.rear * travel.rear
            + self.mass * state.velocity.x * state.velocity.x)
    }

    /// Power dissipated by the dampers \[W\].
    pub fn damping_power(&self, state: &State) -> f64 {
        let p = &self.parameters;
        let rate = self.travel(&state.velocity);
        p.front_damping * rate.front * rate.front + p.rear_damping * rate.rear * rate.rear
    }

    /// The largest magnitude of the free motion's poles \[rad/s\], or an upper bound of it.
    pub fn fastest_pole(&self) -> f64 {
        let p = &self.parameters;
        // Each axle alone, with the compliance of mass and inertia at its arm.
        let axle = |stiffness: f64, damping: f64, arm: f64| {
            let compliance = 1.0 / self.mass + arm * arm / self.pitch_inertia;
            libm::sqrt(stiffness * compliance) + damping * compliance
        };
        axle(p.front_stiffness, p.front_damping, self.arms.front)
            + axle(p.rear_stiffness, p.rear_damping, self.arms.rear)
    }
}
