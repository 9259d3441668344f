//! Speed and pitch: drive, brakes, drag, rolling resistance, tyre friction, standstill.
//!
//! The whole machine pitches by p, nose down, about the point of the road under its centre of mass.
//! A mass at the height z then moves with the velocity v + z p'. With m' the mass including the
//! wheels' spin, and J the moment of inertia about that point,
//!
//! m' v' + m h p'' = X_f + X_r - D + W,   m h v' + J p'' = Q - (D - W) z_D,
//!
//! with Q the moment of the suspension. The tyres' forces act at the road, which does
//! not move with the pitch.

use serde::{Deserialize, Serialize};

use crate::interface::Parameters;
use crate::lateral::{Wheels, bicycle, static_loads};
use crate::rider::within;
use crate::whipple::Bicycle;

/// Data of the longitudinal equations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Longitudinal {
    parameters: crate::interface::Longitudinal,
    friction: f64,
    rolling_resistance: f64,
    wheelbase: f64,
    /// m': mass with the wheels' spin \[kg\].
    inertia: f64,
    /// m h: static moment about the road \[kg m\].
    static_moment: f64,
    /// J: moment of inertia about the point of the road under the centre of mass \[kg m2\].
    pitch_inertia: f64,
    static_loads: Wheels,
}

/// Arguments of the longitudinal forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Situation {
    /// Speed \[m/s\], not negative.
    pub speed: f64,
    /// Throttle and brakes after their lags, from 0 to 1.
    pub throttle: f64,
    pub brake: f64,
    /// Forward force of the wind \[N\].
    pub wind: f64,
    /// Loads of the tyres \[N\], and their lateral forces \[N\].
    pub loads: Wheels,
    pub lateral: Wheels,
}

/// The forces along the motorcycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces {
    /// Forward forces of the road on the tyres \[N\].
    pub tyres: Wheels,
    /// Drag less the wind's push \[N\].
    pub resistance: f64,
    /// True at standstill, held by brakes, rolling resistance and feet.
    pub held: bool,
    pub friction_limited: bool,
    pub lift_limited: bool,
}

/// Accelerations of speed and pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerations {
    /// Rate of the speed \[m/s2\].
    pub speed: f64,
    /// Second derivative of the pitch, nose down \[rad/s2\].
    pub pitch: f64,
    /// Forward forces of the road on the tyres \[N\].
    pub tyres: Wheels,
}

impl Longitudinal {
    /// From the parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let machine = &parameters.machine;
        let bicycle = bicycle(machine);
        let t = bicycle.totals();
        Longitudinal {
            parameters: parameters.longitudinal,
            friction: parameters.tyres.friction,
            rolling_resistance: parameters.tyres.rolling_resistance,
            wheelbase: machine.wheelbase,
            inertia: t.m_t + t.s_r / bicycle.r.r + t.s_f / bicycle.f.r,
            static_moment: -t.m_t * t.z_t,
            pitch_inertia: pitch_inertia(&bicycle, machine.frame_yy),
            static_loads: static_loads(&bicycle, parameters.run.gravity),
        }
    }

    /// Drag at a speed \[N\].
    pub fn drag(&self, speed: f64) -> f64 {
        0.5 * self.parameters.air_density * self.parameters.drag_area * speed * speed
    }

    /// The speed that full power and this wind from behind \[N\] hold \[m/s\], or infinity.
    pub fn top_speed(&self, wind: f64) -> f64 {
        let pushed = |speed: f64| wind + (self.parameters.power / speed).min(self.parameters.drive_force);
        let (mut low, mut high) = (1e-3, 1e6);
        if pushed(high) > self.drag(high) {
            return f64::INFINITY;
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if pushed(middle) > self.drag(middle) { low = middle } else { high = middle }
        }
        high
    }

    /// Largest acceleration on a level road without wind \[m/s2\]; friction and wheel lift not
    /// counted.
    pub fn largest_acceleration(&self, speed: f64) -> f64 {
        (self.largest_drive(speed) - self.resistance(speed)) / self.inertia
    }

    /// Throttle and brakes, from 0 to 1, for an acceleration \[m/s2\] on a level road without wind.
    pub fn pedals(&self, acceleration: f64, speed: f64) -> (f64, f64) {
        let p = &self.parameters;
        let force = self.inertia * acceleration + self.resistance(speed);
        let engine = p.engine_braking * (speed / CLUTCH_SPEED).min(1.0);
        let throttle = (force + engine) / (self.largest_drive(speed) + engine);
        let brake = (-engine - force) / p.brake_force.max(1e-3);
        (throttle.clamp(0.0, 1.0), brake.clamp(0.0, 1.0))
    }

    /// Force of the fully open throttle \[N\].
    fn largest_drive(&self, speed: f64) -> f64 {
        self.parameters.drive_force.min(self.parameters.power / speed.max(1e-3))
    }

    /// Drag and rolling resistance \[N\].
    fn resistance(&self, speed: f64) -> f64 {
        self.drag(speed) + self.rolling_resistance * (self.static_loads.front + self.static_loads.rear)
    }

    /// The forces. At rest brakes, rolling resistance and feet hold whatever does not drive
    /// forward.
    pub fn forces(&self, now: &Situation) -> Forces {
        let p = &self.parameters;
        let resistance = self.drag(now.speed) - now.wind;
        let drive = now.throttle * self.largest_drive(now.speed)
            - (1.0 - now.throttle) * p.engine_braking * (now.speed / CLUTCH_SPEED).min(1.0);
        let brake = now.brake * p.brake_force;

        let held = Wheels {
            front: held_friction(self.friction * now.loads.front, now.lateral.front),
            rear: held_friction(self.friction * now.loads.rear, now.lateral.rear),
        };
        let demand = Wheels { front: -p.brake_front_share * brake, rear: drive - (1.0 - p.brake_front_share) * brake };
        let on_tyres = Wheels { front: within(demand.front, held.front), rear: within(demand.rear, held.rear) };
        let (on_tyres, lift_limited) = self.keep_wheels_down(on_tyres, &now.loads, resistance);
        let tyres = Wheels {
            front: on_tyres.front - self.rolling_resistance * now.loads.front,
            rear: on_tyres.rear - self.rolling_resistance * now.loads.rear,
        };
        Forces {
            tyres,
            resistance,
            held: now.speed <= 0.0 && tyres.front + tyres.rear <= resistance,
            friction_limited: demand.front.abs() > held.front || demand.rear.abs() > held.rear,
            lift_limited,
        }
    }

    /// Speed and pitch under these forces and the suspension's moment Q about the road, nose down
    /// \[N m\].
    pub fn accelerations(&self, forces: &Forces, suspension: f64) -> Accelerations {
        let p = &self.parameters;
        let (m, mh, j) = (self.inertia, self.static_moment, self.pitch_inertia);
        let moment = suspension - forces.resistance * p.aero_height;
        if forces.held {
            let pitch = moment / j;
            let hold = mh * pitch + forces.resistance;
            let tyres = Wheels { front: p.brake_front_share * hold, rear: (1.0 - p.brake_front_share) * hold };
            return Accelerations { speed: 0.0, pitch, tyres };
        }
        let force = forces.tyres.front + forces.tyres.rear - forces.resistance;
        let determinant = m * j - mh * mh;
        Accelerations {
            speed: (j * force - mh * moment) / determinant,
            pitch: (m * moment - mh * force) / determinant,
            tyres: forces.tyres,
        }
    }

    /// Kinetic energy of speed and pitch rate \[J\].
    pub fn kinetic_energy(&self, speed: f64, pitch_rate: f64) -> f64 {
        0.5 * (self.inertia * speed * speed + self.pitch_inertia * pitch_rate * pitch_rate)
            + self.static_moment * speed * pitch_rate
    }

    /// Drive or brakes, reduced so that a fraction of the weight stays on either wheel. The limit
    /// is that of the balance of moments in a steady acceleration. While the springs still move,
    /// the present load also limits the forces.
    fn keep_wheels_down(&self, forces: Wheels, loads: &Wheels, resistance: f64) -> (Wheels, bool) {
        let p = &self.parameters;
        let reserve = p.lift_reserve * (self.static_loads.front + self.static_loads.rear);
        // The tyres' total force that shifts this load to the rear wheel.
        let force_for = |shift: f64| {
            let acceleration = (shift * self.wheelbase - resistance * p.aero_height) / self.static_moment;
            self.inertia * acceleration + resistance
        };
        let whole = forces.front + forces.rear;
        if whole > 0.0 {
            let most = force_for(self.static_loads.front - reserve).max(0.0);
            let fraction = (most / whole).min(load_fraction(loads.front, reserve));
            return (Wheels { rear: forces.rear - (1.0 - fraction.min(1.0)) * whole, ..forces }, fraction < 1.0);
        }
        if whole < 0.0 {
            let least = force_for(reserve - self.static_loads.rear).min(0.0);
            let fraction = (least / whole).min(load_fraction(loads.rear, reserve)).min(1.0);
            return (Wheels { front: fraction * forces.front, rear: fraction * forces.rear }, fraction < 1.0);
        }
        (forces, false)
    }
}

/// Fraction of a force that a load permits: 1 above the reserve, decreasing to 0 with the load.
fn load_fraction(load: f64, reserve: f64) -> f64 {
    if load < reserve { load / reserve } else { 1.0 }
}

/// The speed up to which the clutch slips when the throttle is closed, so that the engine's drag
/// ends at standstill \[m/s\].
const CLUTCH_SPEED: f64 = 3.0;

/// Moment of inertia of all bodies about the point of the road under the centre of mass; the
/// wheels' spin is not in it.
fn pitch_inertia(bicycle: &Bicycle, frame_yy: f64) -> f64 {
    let x = bicycle.totals().x_t;
    let about = |x_body: f64, z_body: f64, mass: f64| mass * ((x_body - x) * (x_body - x) + z_body * z_body);
    frame_yy
        + about(bicycle.b.x, bicycle.b.z, bicycle.b.m)
        + about(bicycle.h.x, bicycle.h.z, bicycle.h.m)
        + about(0.0, bicycle.r.r, bicycle.r.m)
        + about(bicycle.w, bicycle.f.r, bicycle.f.m)
}

/// Longitudinal friction left by a lateral force: the friction circle.
fn held_friction(friction: f64, lateral: f64) -> f64 {
    libm::sqrt((friction * friction - lateral * lateral).max(0.0))
}
