//! Limits of velocity tightened in motion.

use std::cell::Cell;

use nalgebra::Vector3;
use proptest::prelude::*;

use super::{search, vector};
use crate::interface::{Rig, SafetyParameters};
use crate::motion::Motion;
use crate::platform::guard::ActuatorGuard;
use crate::platform::{PlatformCoordinates, PlatformMotion};

/// Six oscillations, in surge, sway, heave, roll, pitch and yaw.
#[derive(Clone, Copy, Debug)]
struct Oscillation {
    amplitudes: [Vector3<f64>; 2],
    frequencies: [Vector3<f64>; 2],
}

impl Oscillation {
    /// The coordinates at `time`.
    fn at(&self, time: f64) -> PlatformCoordinates {
        let motion = |k: usize| {
            let (amplitude, omega) = (self.amplitudes[k], self.frequencies[k]);
            let [sine, cosine] = [omega.map(|omega| (omega * time).sin()), omega.map(|omega| (omega * time).cos())];
            let velocity = amplitude.component_mul(&omega);
            Motion {
                position: amplitude.component_mul(&sine),
                velocity: velocity.component_mul(&cosine),
                acceleration: -velocity.component_mul(&omega).component_mul(&sine),
            }
        };
        PlatformCoordinates { linear: motion(0), angles: motion(1) }
    }
}

/// A guard with what is demanded of it.
#[derive(Clone, Debug)]
struct Ride {
    guard: ActuatorGuard,
    demand: Oscillation,
    neutral_height: f64,
    step: f64,
}

impl Ride {
    fn advance(&mut self, count: usize, safety: &SafetyParameters) {
        let demand = self.demand.at((count + 1) as f64 * self.step);
        let motion: PlatformMotion = demand.motion(self.neutral_height);
        self.guard.advance(&demand, &motion, safety, self.step);
    }

    fn speeds(&self) -> Vector3<f64> {
        self.guard.coordinates().linear.velocity.abs()
    }
}

/// Slow and fast machines at rest, with what is demanded of them.
fn rides() -> impl Strategy<Value = Ride> {
    let sizes = (-0.5..1.5_f64, -1.3..0.5_f64, -3.5..-2.0_f64);
    (sizes, vector(0.4), vector(0.4), [vector(9.0), vector(9.0)]).prop_map(|((a, v, step), p, q, frequencies)| {
        let [acceleration_limit, velocity_limit, step] = [a, v, step].map(|exponent| 10.0_f64.powf(exponent));
        let rig = Rig { acceleration_limit, velocity_limit, ..Rig::default() };
        let demand = Oscillation { amplitudes: [p, q], frequencies };
        Ride { guard: ActuatorGuard::new(&rig, step), demand, neutral_height: rig.neutral_height, step }
    })
}

#[test]
fn a_tightened_limit_of_velocity_is_kept_no_later_than_by_the_plan_held() {
    let [tightened, sooner] = [const { Cell::new(0) }; 2];
    search(1_000)
        .run(&(rides(), 20..400_usize, [-3.0..0.1_f64, -3.0..0.1, -3.0..0.1]), |(mut ride, before, factors)| {
            let mut safety = SafetyParameters::default();
            for k in 0..before {
                ride.advance(k, &safety);
            }
            let mut speeds = ride.speeds();
            let factors = Vector3::from(factors.map(|exponent| 10.0_f64.powf(exponent)));
            safety.velocity_limit = speeds.component_mul(&factors).map(|limit| limit.max(1e-9));
            // Steps on the plan held until it keeps the limits.
            let mut on_plan = ride.guard.plan;
            let mut planned = 0;
            let keeps = |speeds: &Vector3<f64>| {
                speeds.iter().zip(&safety.velocity_limit).all(|(speed, limit)| *speed <= limit * (1.0 + 1e-9))
            };
            while !keeps(&on_plan.now().linear.velocity.abs()) {
                on_plan = on_plan.advanced(ride.step);
                planned += 1;
            }
            let mut kept = None;
            for k in 0..400 {
                ride.advance(before + k, &safety);
                let now = ride.speeds();
                for axis in 0..3 {
                    let fastest = safety.velocity_limit[axis].max(speeds[axis]);
                    prop_assert!(now[axis] <= fastest * (1.0 + 1e-9), "axis {}: {} m/s", axis, now[axis]);
                }
                speeds = now;
                let steps = k + 1;
                prop_assert!(keeps(&now) || steps < planned, "{} steps, {} planned", steps, planned);
                if keeps(&now) {
                    kept.get_or_insert(steps);
                }
            }
            if planned > 2 {
                tightened.set(tightened.get() + 1);
                sooner.set(sooner.get() + usize::from(kept.is_some_and(|kept| kept < planned - planned / 10 - 1)));
            }
            Ok(())
        })
        .unwrap();
    let (tightened, sooner) = (tightened.get(), sooner.get());
    assert!(tightened > 500 && sooner > 100, "{tightened} tightened in motion, {sooner} kept sooner than planned");
}
