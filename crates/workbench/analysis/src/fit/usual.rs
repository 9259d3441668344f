//! Drives computed from a vehicle's usual accelerations.

use moris_simulation::Manoeuvre;
use moris_washout::Input;
use moris_washout::interface::{AngularVelocityFrame, STANDARD_GRAVITY};

use crate::recording::Recording;

/// A vehicle whose usual accelerations are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Vehicle {
    /// A car in town: 0.35 g in bends, 0.35 g of braking
    TownCar,
    /// A race car: 2 g in bends, 1.5 g of braking
    RaceCar,
    /// A kart: 2 g in bends, 1 g of braking
    Kart,
    /// A motorcycle, whose rider leans: 0.1 g to the side, 0.7 g of braking
    Motorcycle,
    /// An aircraft in coordinated flight: 0.1 g to the side, 0.25 g along
    Aircraft,
}

/// The usual largest accelerations of a vehicle \[m/s2\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Usual {
    /// Acceleration to the side.
    pub sideways: f64,
    /// Deceleration of braking.
    pub braking: f64,
    /// Of accelerating; 0: half of the braking.
    pub accelerating: f64,
}

impl Vehicle {
    /// The vehicle's usual accelerations.
    pub fn usual(self) -> Usual {
        let of = |sideways: f64, braking: f64, accelerating: f64| Usual {
            sideways: sideways * STANDARD_GRAVITY,
            braking: braking * STANDARD_GRAVITY,
            accelerating: accelerating * STANDARD_GRAVITY,
        };
        match self {
            Vehicle::TownCar => of(0.35, 0.35, 0.2),
            Vehicle::RaceCar => of(2.0, 1.5, 0.7),
            Vehicle::Kart => of(2.0, 1.0, 0.5),
            Vehicle::Motorcycle => of(0.1, 0.7, 0.5),
            Vehicle::Aircraft => of(0.1, 0.2, 0.25),
        }
    }
}

impl Usual {
    /// Accelerations written as `2 g sideways, 1 g braking`.
    ///
    /// # Errors
    /// A part is not a number, a unit and a direction.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut usual = Usual::default();
        for part in text.split(',') {
            let wrong = || {
                format!(
                    "\"{}\" is no acceleration; write a number, g or m/s2, and sideways, braking or accelerating, as in \"2 g \
                     sideways, 1 g braking\"",
                    part.trim()
                )
            };
            let words: Vec<&str> = part.split_whitespace().collect();
            let [value, unit, direction] = words[..] else { return Err(wrong()) };
            let factor = match unit {
                "g" => STANDARD_GRAVITY,
                "m/s2" | "m/s²" => 1.0,
                _ => return Err(wrong()),
            };
            let value: f64 = value.parse().ok().filter(|value| (0.0..=100.0).contains(value)).ok_or_else(wrong)?;
            match direction {
                "sideways" => usual.sideways = value * factor,
                "braking" => usual.braking = value * factor,
                "accelerating" => usual.accelerating = value * factor,
                _ => return Err(wrong()),
            }
        }
        Ok(usual)
    }

    /// Drive of a minute: accelerate, bends to both sides, brake before each, and stop. Every
    /// change takes its time as the driver's hands and feet do: half a second for the pedals, one
    /// for the wheel. The car turns at the rate of its lateral acceleration at 15 m/s.
    pub fn drive(&self) -> Manoeuvre {
        let Usual { sideways, braking, accelerating } = *self;
        let accelerating = if accelerating > 0.0 { accelerating } else { 0.5 * braking };
        // Begin, duration and acceleration of each phase.
        let along = [
            (2.0, 4.0, accelerating),
            (8.0, 2.0, -braking),
            (16.0, 3.0, accelerating),
            (22.0, 1.5, -braking),
            (32.0, 4.0, 0.6 * accelerating),
            (40.0, 2.0, -0.5 * braking),
            (52.0, 3.0, -0.7 * braking),
        ];
        let aside =
            [(10.0, 5.0, sideways), (24.0, 3.0, -sideways), (27.0, 3.0, 0.8 * sideways), (42.0, 6.0, -0.6 * sideways)];
        let at = |phases: &[(f64, f64, f64)], t: f64, rise: f64| -> f64 {
            let smooth = |u: f64| {
                let u = u.clamp(0.0, 1.0);
                u * u * (3.0 - 2.0 * u)
            };
            phases
                .iter()
                .map(|(begin, time, value)| value * (smooth((t - begin) / rise) - smooth((t - begin - time) / rise)))
                .sum()
        };
        const SPEED: f64 = 15.0;
        Manoeuvre::sampled(0.01, 60.0, |t| {
            let mut input = Input::default();
            input.specific_force.x = at(&along, t, 0.5);
            input.specific_force.y = at(&aside, t, 1.0);
            input.angular_velocity.z = input.specific_force.y / SPEED;
            input
        })
    }

    /// The drive as a recording.
    pub fn recording(&self, name: &str) -> Recording {
        Recording::computed(name, self.drive(), AngularVelocityFrame::Body)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_accelerations_are_read_and_driven() {
        let usual = Usual::parse("2 g sideways, 9.80665 m/s2 braking").unwrap();
        assert!((usual.sideways - 19.6133).abs() < 1e-9 && (usual.braking - STANDARD_GRAVITY).abs() < 1e-9);
        let drive = usual.drive();
        let of = |axis: usize| drive.inputs().iter().map(move |input| input.specific_force[axis]);
        assert!((of(1).fold(0.0, f64::max) - 19.6133).abs() < 1e-9);
        assert!((of(0).fold(0.0, f64::min) + STANDARD_GRAVITY).abs() < 1e-9);
        for wrong in ["2 g", "g sideways", "2 stone sideways", "2 g upwards", "-1 g braking", ""] {
            assert!(Usual::parse(wrong).unwrap_err().contains("as in \"2 g sideways"), "{wrong}");
        }
    }
}
