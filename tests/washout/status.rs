//! The outputs that report limits.

use moris_washout::interface::{RollPitchYaw, StrategyKind};
use moris_washout::{Input, Output, Washout};
use nalgebra::Vector3;

use crate::common::{G, parameters, ride, washout};

#[test]
fn the_stroke_margin_is_the_distance_to_the_nearer_end_of_any_stroke() {
    let rig = parameters(&[]).rig;
    let mut washout = washout(&[("splitter.z.omega1", 0.5), ("splitter.z.omega2", 0.5)]);
    let heaving =
        |t: f64| Input { specific_force: Vector3::new(0.5, 0.0, G + 4.0 * (4.0 * t).cos()), ..Input::default() };
    let (mut near_short, mut near_long) = (0, 0);
    ride(&mut washout, 10.0, 0.001, heaving, |t, output| {
        let shortest = output.length.iter().copied().fold(f64::INFINITY, f64::min);
        let longest = output.length.iter().copied().fold(0.0, f64::max);
        let (short, long) = (shortest - rig.min_length, rig.max_length - longest);
        assert_eq!(output.stroke_margin, short.min(long), "at {t}");
        if short < long - 0.02 {
            near_short += 1;
        }
        if long < short - 0.02 {
            near_long += 1;
        }
    });
    assert!(near_short > 100 && near_long > 100, "{near_short} {near_long}");
}

/// Blows and rests. Each blow makes a limit act for a while.
fn blows(k: usize, force: f64, rate: f64) -> Input {
    let blow = |period: usize, value: f64| if (k / period).is_multiple_of(5) { value } else { 0.0 };
    Input {
        specific_force: force * Vector3::new(blow(23, 0.9), blow(61, -0.5), blow(17, 0.8)) + Vector3::new(0.0, 0.0, G),
        angular_velocity: rate * Vector3::new(blow(29, 1.0), blow(31, -0.8), blow(37, 0.5)),
        orientation: RollPitchYaw::default(),
        ..Input::default()
    }
}

/// The derivatives of the legs' velocities, which a host may ask for, are differences over a step.
#[test]
fn a_limited_platform_has_the_accelerations_of_its_velocities() {
    const STEP: f64 = 0.001;
    let slow = ("actuator.accelerationLimit", 3.0);
    // With limits that become too tight for the motion the platform follows its plan to rest.
    let tight = [("safety.x.accelerationLimit", 0.2), ("safety.y.accelerationLimit", 0.2)];
    for (set, tightened) in [(&[][..], &[][..]), (&[slow], &[slow]), (&[], &tight)] {
        let mut washout = washout(set);
        let mut limited = 0;
        for k in 0..4000 {
            if k % 400 == 300 {
                washout.retune(&parameters(tightened)).unwrap();
            } else if k % 400 == 0 {
                washout.retune(&parameters(set)).unwrap();
            }
            let (before, legs_before) = (*washout.motion(), washout.output().leg_velocity);
            washout.step(&blows(k, 60.0, 6.0), STEP);
            let (after, output) = (*washout.motion(), washout.output());
            if output.actuator_limited {
                limited += 1;
                let given = washout.output_derivative().leg_velocity;
                for i in 0..6 {
                    let difference = (output.leg_velocity[i] - legs_before[i]) / STEP;
                    assert!((given[i] - difference).abs() < 1e-6, "{} and {difference} m/s2 at step {k}", given[i]);
                }
                let difference = (after.velocity - before.velocity) / STEP;
                assert!((after.acceleration - difference).amax() < 1e-9, "{difference} at step {k}");
            }
        }
        assert!(limited > 100, "{limited}");
    }
}

fn flags(output: &Output) -> [bool; 3] {
    [output.tilt_limited, output.safety_active, output.actuator_limited]
}

/// Number of communication steps in which each flag's cause ended before the last internal step. A
/// communication step's flags cover all its internal steps.
fn ended_within_a_step(set: &[(&str, f64)], force: f64, rate: f64) -> [usize; 3] {
    const INTERNAL: usize = 8;
    const STEP: f64 = 0.001;
    let (mut fine, mut coarse) = (washout(set), washout(set));
    let mut count = [0; 3];
    for k in 0..4000 {
        let input = blows(k, force, rate);
        let (mut any, mut last) = ([false; 3], [false; 3]);
        for _ in 0..INTERNAL {
            fine.step(&input, STEP);
            last = flags(&fine.output());
            any = std::array::from_fn(|i| any[i] || last[i]);
        }
        coarse.step(&input, INTERNAL as f64 * STEP);
        assert_eq!(coarse.output().position, fine.output().position, "at {k}");
        assert_eq!(flags(&coarse.output()), any, "at {k}");
        for i in 0..3 {
            count[i] += usize::from(any[i] && !last[i]);
        }
    }
    count
}

#[test]
fn the_flags_tell_of_every_internal_step() {
    let quick_tilt = [("tilt.rateLimit", 1.0), ("tilt.accelerationLimit", 20.0)];
    let [tilt, ..] = ended_within_a_step(&quick_tilt, 10.0, 0.0);
    let narrow = [("safety.z.positionLimit", 0.1), ("safety.x.positionLimit", 0.1)];
    let [_, safety, _] = ended_within_a_step(&[narrow, quick_tilt].concat(), 10.0, 2.0);
    let slow_legs = [("actuator.accelerationLimit", 3.0)];
    let [.., actuator] = ended_within_a_step(&slow_legs, 0.0, 0.5);
    assert!(tilt > 1 && safety > 1 && actuator > 1, "{tilt} {safety} {actuator}");
}

/// A limit of velocity tightened in motion shows in the status until it is kept,
/// whatever the strategy.
#[test]
fn a_speed_above_a_tightened_limit_shows() {
    for &strategy in StrategyKind::ALL {
        let mut beyond = 0;
        for (change, limit) in
            (100..1500).step_by(crate::cases::cases(23, 69)).zip([0.3, 0.1, 0.01].into_iter().cycle())
        {
            let mut parameters = parameters(&[]);
            parameters.structure.strategy = strategy;
            let mut washout = Washout::new(&parameters).unwrap();
            for step in 0..change + 200 {
                if step == change {
                    parameters.safety.velocity_limit = Vector3::repeat(limit);
                    washout.retune(&parameters).unwrap();
                }
                let square = |amplitude: f64, omega: f64| amplitude.copysign((0.001 * omega * f64::from(step)).sin());
                let force = Vector3::new(square(8.0, 5.0), square(8.0, 7.0), G + square(6.0, 9.0));
                washout.step(&Input { specific_force: force, ..Input::default() }, 0.001);
                let output = washout.output();
                if step >= change && output.velocity.amax() > 1.0001 * limit {
                    let shows = output.safety_active || output.actuator_limited;
                    assert!(shows, "{strategy:?}, {limit} m/s before step {change}: {step}");
                    beyond += 1;
                }
            }
        }
        assert!(beyond > crate::cases::cases(500, 150), "{strategy:?}: {beyond}");
    }
}
