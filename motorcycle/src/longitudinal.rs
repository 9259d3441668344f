//! Speed: drive, brakes, drag and rolling resistance, what the tyres hold, and a stop that is one.
//!
//! (m + I_r / R_r^2 + I_f / R_f^2) v' = X_f + X_r - D + W, with the wheels' spin in the mass.

use serde::{Deserialize, Serialize};

use crate::interface::Parameters;
use crate::lateral::{Wheels, bicycle, static_loads};

/// What of the motorcycle matters to its speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Longitudinal {
    parameters: crate::interface::Longitudinal,
    friction: f64,
    rolling_resistance: f64,
    wheelbase: f64,
    /// Mass with the wheels' spin \[kg\].
    inertia: f64,
    /// Pitching moment of the inertia forces about the road, per acceleration: m h and the wheels' spin \[kg m\].
    pitching: f64,
    static_loads: Wheels,
}

/// What acts along the motorcycle now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Situation {
    /// Speed \[m/s\], not negative.
    pub speed: f64,
    /// What has come through of throttle and brakes, from 0 to 1.
    pub throttle: f64,
    pub brake: f64,
    /// Forward force of the wind \[N\].
    pub wind: f64,
    /// Loads of the tyres \[N\], and how much of their friction the lateral forces use \[N\].
    pub loads: Wheels,
    pub lateral: Wheels,
}

/// What comes of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Rate of the speed \[m/s2\].
    pub acceleration: f64,
    /// Forward forces of the road on the tyres \[N\].
    pub forces: Wheels,
    /// Moment that shifts load to the rear wheel, about the road: load shifted times wheelbase \[N m\].
    pub pitching_moment: f64,
    pub friction_limited: bool,
    pub lift_limited: bool,
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
            pitching: t.s_r + t.s_f - t.m_t * t.z_t,
            static_loads: static_loads(&bicycle, parameters.run.gravity),
        }
    }

    /// Mass with the wheels' spin \[kg\]: twice the kinetic energy at 1 m/s.
    pub fn inertia(&self) -> f64 {
        self.inertia
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

    /// Forces and acceleration. At rest the brakes, rolling resistance and feet hold whatever does not drive forward.
    pub fn motion(&self, now: &Situation) -> Outcome {
        let p = &self.parameters;
        let drag = self.drag(now.speed);
        let drive = now.throttle * p.drive_force.min(p.power / now.speed.max(1e-3))
            - (1.0 - now.throttle) * p.engine_braking * (now.speed / CLUTCH_SPEED).min(1.0);
        let brake = now.brake * p.brake_force;
        let rolling = |load: f64| self.rolling_resistance * load;

        let held = Wheels {
            front: held(self.friction * now.loads.front, now.lateral.front),
            rear: held(self.friction * now.loads.rear, now.lateral.rear),
        };
        let wanted = Wheels {
            front: -p.brake_front_share * brake,
            rear: drive - (1.0 - p.brake_front_share) * brake,
        };
        let on_tyres = Wheels { front: within(wanted.front, held.front), rear: within(wanted.rear, held.rear) };
        let (on_tyres, lift_limited) = self.keep_wheels_down(on_tyres, drag - now.wind);
        let forces = Wheels {
            front: on_tyres.front - rolling(now.loads.front),
            rear: on_tyres.rear - rolling(now.loads.rear),
        };

        let net = forces.front + forces.rear - drag + now.wind;
        if now.speed <= 0.0 && net <= 0.0 {
            return self.at_rest(now.wind);
        }
        let acceleration = net / self.inertia;
        Outcome {
            acceleration,
            forces,
            pitching_moment: self.pitching * acceleration + (drag - now.wind) * p.aero_height,
            friction_limited: wanted.front.abs() > held.front || wanted.rear.abs() > held.rear,
            lift_limited,
        }
    }

    /// Held: the brakes take the wind.
    fn at_rest(&self, wind: f64) -> Outcome {
        let p = &self.parameters;
        Outcome {
            forces: Wheels { front: -p.brake_front_share * wind, rear: -(1.0 - p.brake_front_share) * wind },
            pitching_moment: -wind * p.aero_height,
            ..Outcome::default()
        }
    }

    /// Drive or brakes eased so that, in a steady acceleration, a share of the weight stays on either wheel.
    fn keep_wheels_down(&self, forces: Wheels, resistance: f64) -> (Wheels, bool) {
        let p = &self.parameters;
        let reserve = p.lift_reserve * (self.static_loads.front + self.static_loads.rear);
        // The tyres' whole force that shifts this much load to the rear wheel.
        let force_for = |shift: f64| {
            let acceleration = (shift * self.wheelbase - resistance * p.aero_height) / self.pitching;
            self.inertia * acceleration + resistance
        };
        let most = force_for(self.static_loads.front - reserve);
        let least = force_for(reserve - self.static_loads.rear);
        let whole = forces.front + forces.rear;
        if whole > most && forces.rear > 0.0 {
            return (Wheels { rear: (most - forces.front).max(0.0), ..forces }, true);
        }
        if whole < least && whole < 0.0 {
            let share = (least / whole).max(0.0);
            return (Wheels { front: share * forces.front, rear: share * forces.rear }, true);
        }
        (forces, false)
    }
}

/// The speed up to which the clutch slips when the throttle is closed, so that the engine's drag ends with the ride
/// \[m/s\].
const CLUTCH_SPEED: f64 = 3.0;

/// What of a tyre's friction its lateral force leaves: the friction circle.
fn held(friction: f64, lateral: f64) -> f64 {
    libm::sqrt((friction * friction - lateral * lateral).max(0.0))
}

/// The limited value: at most `limit` to either side.
fn within(value: f64, limit: f64) -> f64 {
    value.max(-limit).min(limit)
}
