//! Speed, loads and the stop.

use moris_motorcycle::longitudinal::Longitudinal;
use moris_motorcycle::suspension::Suspension;
use moris_motorcycle::{Input, Model, Parameters};

use crate::common::{assert_near, at_speed, motorcycle};

#[test]
fn at_rest_nothing_but_gravity_is_felt_and_nothing_moves() {
    let mut resting = motorcycle(&Parameters::default());
    for _ in 0..1000 {
        resting.step(&Input::default(), 0.001);
        let output = resting.output();
        assert_eq!(output.specific_force.as_slice(), [0.0, 0.0, 9.80665]);
        assert_eq!(output.angular_velocity.as_slice(), [0.0; 3]);
        assert_eq!(output.position.as_slice(), [0.0; 3]);
        assert_eq!(output.speed, 0.0);
    }
}

#[test]
fn it_stops_at_exactly_zero_and_never_rolls_back() {
    let mut braking = motorcycle(&at_speed(20.0));
    let input = Input { brake: 0.7, ..Input::default() };
    let mut stopped = None;
    let mut before = braking.output();
    for k in 0..8000 {
        braking.step(&input, 0.001);
        let output = braking.output();
        assert!(output.speed >= 0.0 && output.speed <= before.speed + 1e-12);
        if output.speed == 0.0 && stopped.is_none() {
            stopped = Some(k);
            // The step: of the road's force nothing is left but what holds the rebounding fork.
            assert!(before.acceleration < -6.0 && output.acceleration == 0.0, "{}", before.acceleration);
        }
        before = output;
    }
    assert!(stopped.is_some());
    assert_eq!(before.speed, 0.0);
    for _ in 0..60_000 {
        braking.step(&input, 0.001);
    }
    assert_eq!(braking.output().specific_force.as_slice(), [0.0, 0.0, 9.80665], "a minute after");
    // From 20 m/s, as the mean deceleration says.
    assert!(stopped.unwrap() < 4000, "{stopped:?}");
}

#[test]
fn coasting_comes_to_rest_too() {
    let mut coasting = motorcycle(&at_speed(3.0));
    for _ in 0..40_000 {
        coasting.step(&Input::default(), 0.001);
    }
    assert_eq!(coasting.output().speed, 0.0);
    assert_eq!(coasting.output().acceleration, 0.0);
}

#[test]
fn against_drag_alone_the_speed_is_the_closed_forms() {
    let mut parameters = at_speed(50.0);
    parameters.tyres.rolling_resistance = 0.0;
    parameters.longitudinal.engine_braking = 0.0;
    parameters.longitudinal.aero_height = 0.0;
    let mut coasting = motorcycle(&parameters);
    let p = parameters.longitudinal;
    let mass = 270.0 + 0.8 / (0.299 * 0.299) + 0.6 / (0.294 * 0.294);
    let per_speed2 = 0.5 * p.air_density * p.drag_area / mass;
    for k in 1..=20_000 {
        coasting.step(&Input::default(), 0.001);
        let expected = 50.0 / (1.0 + per_speed2 * 50.0 * 0.001 * f64::from(k));
        // The fork's dive at the beginning moves the centre of mass by some centimetres.
        assert_near(coasting.output().speed / expected, 1.0, 4e-3, "speed");
    }
    let expected = 50.0 / (1.0 + per_speed2 * 50.0 * 20.0);
    assert_near(coasting.output().speed / expected, 1.0, 2e-4, "speed after 20 s");
}

#[test]
fn full_throttle_ends_where_power_and_resistance_balance() {
    let mut parameters = at_speed(60.0);
    parameters.rider.feet_speed = 2.0;
    let mut racing = motorcycle(&parameters);
    for _ in 0..80_000 {
        racing.step(&Input { throttle: 1.0, ..Input::default() }, 0.001);
    }
    let speed = racing.output().speed;
    let p = parameters.longitudinal;
    let resistance = 0.5 * p.air_density * p.drag_area * speed * speed + 0.018 * 270.0 * 9.80665;
    assert_near(resistance * speed / p.power, 1.0, 1e-3, "power");
}

#[test]
fn steady_loads_shift_by_the_moment_of_what_acts_above_the_road() {
    let mut braking = motorcycle(&at_speed(40.0));
    for _ in 0..3000 {
        braking.step(&Input { brake: 0.3, ..Input::default() }, 0.001);
    }
    let output = braking.output();
    let p = braking.parameters().longitudinal;
    let drag = 0.5 * p.air_density * p.drag_area * output.speed * output.speed;
    let static_moment = 221.0 * 0.669 + 22.0 * 0.767 + 12.0 * 0.294 + 15.0 * 0.299;
    let shift = (static_moment * output.acceleration + drag * p.aero_height) / 1.448;
    let at_rest = 270.0 * 9.80665;
    assert_near(output.front_load + output.rear_load, at_rest, 1e-3, "whole load");
    let front_at_rest = (221.0 * 0.642 + 22.0 * 1.205 + 12.0 * 1.448) / 1.448 * 9.80665;
    assert!((output.front_load - front_at_rest + shift).abs() < 5.0, "{}", output.front_load);
}

#[test]
fn neither_full_throttle_nor_full_brakes_lift_a_wheel_or_slide_a_tyre() {
    for (speed, throttle, brake) in [(0.0, 1.0, 0.0), (10.0, 1.0, 0.0), (30.0, 0.0, 1.0), (60.0, 0.0, 1.0)] {
        for friction in [0.3, 0.8, 1.2, 2.5] {
            let mut parameters = at_speed(speed);
            parameters.tyres.friction = friction;
            parameters.longitudinal.brake_force = 6000.0;
            let mut pushed = motorcycle(&parameters);
            let mut limited = false;
            for k in 0..2500 {
                pushed.step(&Input { throttle, brake, ..Input::default() }, 0.001);
                let output = pushed.output();
                limited |= output.friction_limited || output.wheel_lift_limited;
                for (force, load) in
                    [(output.front_longitudinal, output.front_load), (output.rear_longitudinal, output.rear_load)]
                {
                    let moving = output.speed > 0.0;
                    assert!(!moving || force.abs() <= (friction + 0.018) * load + 1e-6, "{force} N at {load} N");
                }
                // The springs swing for a while: what is promised is the steady state.
                if k > 1000 && output.speed > 5.0 {
                    assert!(output.front_load > 60.0 && output.rear_load > 60.0, "{output:?}");
                }
            }
            assert!(limited, "at {speed} m/s on {friction}");
        }
    }
}

#[test]
fn braking_in_a_turn_leaves_the_tyres_what_they_need_sideways() {
    let mut vehicle = motorcycle(&at_speed(25.0));
    for k in 0..4000 {
        let brake = if k < 2500 { 0.0 } else { 1.0 };
        vehicle.step(&Input { lean: 0.6, brake, ..Input::default() }, 0.001);
        let o = vehicle.output();
        for (along, sideways, load) in
            [(o.front_longitudinal, o.front_lateral, o.front_load), (o.rear_longitudinal, o.rear_lateral, o.rear_load)]
        {
            let rolling = 0.018 * load;
            assert!(
                o.speed == 0.0
                    || along.abs() <= rolling + (1.44 * load * load - sideways * sideways).max(0.0).sqrt() + 1e-6
            );
        }
    }
}

#[test]
fn energy_is_what_forces_put_in_and_dampers_and_drag_take_out() {
    let parameters = at_speed(15.0);
    let longitudinal = Longitudinal::new(&parameters);
    let suspension = Suspension::new(&parameters);
    let mut vehicle = motorcycle(&parameters);
    let p = parameters.longitudinal;
    let step = 1e-4;
    let energy = |vehicle: &moris_motorcycle::Motorcycle| {
        let state = vehicle.state();
        longitudinal.kinetic_energy(state.speed, state.suspension.velocity.y) + suspension.energy(&state.suspension)
    };
    let power = |vehicle: &moris_motorcycle::Motorcycle| {
        let (state, output) = (vehicle.state(), vehicle.output());
        let drag = 0.5 * p.air_density * p.drag_area * state.speed * state.speed;
        (output.front_longitudinal + output.rear_longitudinal) * state.speed
            - drag * (state.speed + p.aero_height * state.suspension.velocity.y)
            - suspension.damping_power(&state.suspension)
    };
    let begin = energy(&vehicle);
    let (mut work, mut largest) = (0.0, 0.0_f64);
    let mut before = power(&vehicle);
    for k in 0..40_000 {
        let input = match k {
            0..15_000 => Input { throttle: 0.8, ..Input::default() },
            15_000..20_000 => Input::default(),
            _ => Input { brake: 0.5, ..Input::default() },
        };
        vehicle.step(&input, step);
        let after = power(&vehicle);
        work += 0.5 * step * (before + after);
        before = after;
        largest = largest.max((energy(&vehicle) - begin - work).abs());
    }
    assert!(vehicle.output().speed > 1.0, "the ride is meant to go on to the end");
    assert!(largest < 1e-4 * energy(&vehicle).max(begin), "{largest} J of {begin} J");
}
