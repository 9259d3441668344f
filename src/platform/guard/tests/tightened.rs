//! Limits of velocity tightened in motion.

use std::cell::Cell;

use nalgebra::Vector3;
use proptest::prelude::*;

use super::{case_count, search, vector};
use crate::interface::{Rig, SafetyParameters};
use crate::motion::Motion;
use crate::platform::PlatformCoordinates;
use crate::platform::guard::ActuatorGuard;

/// Factor by which rounding may exceed a limit.
const ROUNDING: f64 = 1.0 + 1e-9;

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
    step: f64,
}

impl Ride {
    fn advance(&mut self, count: usize, safety: &SafetyParameters) {
        let demand = self.demand.at((count + 1) as f64 * self.step);
        self.guard.advance(&self.guard.state(demand), safety, false, self.step);
    }

    fn speeds(&self) -> Vector3<f64> {
        self.guard.commanded().coordinates.linear.velocity.abs()
    }
}

/// Slow and fast machines at rest, with what is demanded of them.
fn rides() -> impl Strategy<Value = Ride> {
    let sizes = (-0.5..1.5_f64, -1.3..0.5_f64, -3.5..-2.0_f64);
    (sizes, vector(0.4), vector(0.4), [vector(9.0), vector(9.0)]).prop_map(|((a, v, step), p, q, frequencies)| {
        let [acceleration_limit, velocity_limit, step] = [a, v, step].map(|exponent| 10.0_f64.powf(exponent));
        let rig = Rig { acceleration_limit, velocity_limit, ..Rig::default() };
        let demand = Oscillation { amplitudes: [p, q], frequencies };
        Ride { guard: ActuatorGuard::new(&rig, step), demand, step }
    })
}

/// Steps until an axis keeps its limit of velocity if the guard follows the plan that it holds.
fn steps_on_plan(ride: &Ride, axis: usize, limit: f64) -> usize {
    let mut plan = ride.guard.plan();
    let mut steps = 0;
    while plan.coordinates().linear.velocity[axis].abs() > limit * ROUNDING {
        plan = plan.advanced(ride.step);
        steps += 1;
    }
    steps
}

/// Limits of velocity are tightened up to four times in motion, each time on one axis or on all. An
/// axis keeps its limit no later than on the plan held at the change of that limit, whatever
/// happens to the others.
#[test]
fn a_tightened_limit_of_velocity_is_kept_no_later_than_on_the_plan_held() {
    let [tightened, sooner] = [const { Cell::new(0) }; 2];
    let factors = prop_oneof![0.2..0.99_f64, 0.0005..0.01_f64];
    let changes = prop::collection::vec((1..12_usize, 0..5_usize, factors), 1..5);
    search(case_count(1_250))
        .run(&(rides(), 20..400_usize, changes), |(mut ride, before, changes)| {
            let mut safety = SafetyParameters::default();
            for k in 0..before {
                ride.advance(k, &safety);
            }
            let mut speeds = ride.speeds();
            // The last step at which an axis may be faster than its limit, and when that was set.
            let [mut last, mut since] = [[before; 3]; 2];
            let mut due = before;
            let mut changes = changes.into_iter().peekable();
            for now in before..before + 400 {
                if let Some((pause, which, factor)) = changes.next_if(|_| now == due) {
                    due = now + pause;
                    for axis in (0..3).filter(|axis| which == *axis || which > 2) {
                        let limit = (factor * speeds[axis]).max(1e-9);
                        if limit < safety.velocity_limit[axis] {
                            safety.velocity_limit[axis] = limit;
                            since[axis] = now;
                            last[axis] = now + steps_on_plan(&ride, axis, limit);
                        }
                    }
                }
                ride.advance(now, &safety);
                let after = ride.speeds();
                for axis in 0..3 {
                    let limit = safety.velocity_limit[axis];
                    let fastest = limit.max(speeds[axis]);
                    prop_assert!(after[axis] <= fastest * ROUNDING, "axis {}: {} m/s", axis, after[axis]);
                    let complies = after[axis] <= limit * ROUNDING;
                    prop_assert!(
                        complies || now + 1 < last[axis],
                        "axis {} after {} steps",
                        axis,
                        now + 1 - since[axis]
                    );
                    if complies && last[axis] > since[axis] + 2 {
                        let planned = last[axis] - since[axis];
                        tightened.set(tightened.get() + 1);
                        sooner.set(sooner.get() + usize::from(10 * (now + 2 - since[axis]) < 9 * planned));
                        last[axis] = since[axis];
                    }
                }
                speeds = after;
            }
            Ok(())
        })
        .unwrap();
    let (tightened, sooner) = (tightened.get(), sooner.get());
    let all = case_count(1_250) as usize;
    assert!(
        tightened > all / 5 && sooner > all / 25,
        "{tightened} tightened in motion, {sooner} kept sooner than planned"
    );
}
