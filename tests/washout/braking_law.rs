//! The braking law: its limits always hold, inside them it changes nothing, and
//! it acts without a jump.

use moris_washout::cueing::direct_linear::DirectLinearMotion;
use moris_washout::cueing::safety::SafetyUnits;
use moris_washout::filter::chain::Denominator;
use moris_washout::interface::SafetyParameters;
use moris_washout::motion::Motion;
use moris_washout::motion::braking_law::approach_velocity;
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::chain::Chain;
use crate::common::random::Random;
use crate::common::{cases, parameters};

/// A target that often jumps, to numbers of any size or none, and otherwise moves as a body can.
fn hostile_target(random: &mut Random, last: &Motion, step: f64) -> Motion {
    match random.below(8) {
        0 => Motion {
            position: random.between(-2.0, 2.0),
            velocity: random.between(-5.0, 5.0),
            acceleration: random.between(-50.0, 50.0),
        },
        1 => Motion { position: f64::NAN, velocity: f64::INFINITY, acceleration: 0.0 },
        2 => Motion { position: 1e300, velocity: -1e300, acceleration: 1e300 },
        _ => {
            let acceleration = random.between(-12.0, 12.0);
            let velocity = last.velocity + acceleration * step;
            Motion { position: last.position + 0.5 * (last.velocity + velocity) * step, velocity, acceleration }
        }
    }
}

/// Next demand on the units, different on each axis.
fn hostile_targets(random: &mut Random, last: &Motion<Vector3<f64>>, step: f64) -> Motion<Vector3<f64>> {
    let targets = [0, 1, 2].map(|k| hostile_target(random, &last.axis(k), step));
    Motion::from_axes(|k| targets[k])
}

#[test]
fn the_units_continue_from_the_real_motion_always_or_beyond_tightened_limits() {
    let (wide, step) = (parameters(&[]).safety, 0.001);
    let narrow = SafetyParameters { position_limit: Vector3::repeat(0.01), ..wide };
    let splitter = parameters(&[]).splitter;
    let real = Motion { position: Vector3::new(0.2, 0.0, 0.0), ..Motion::default() };
    let mut linear = DirectLinearMotion::new(&splitter, 4, step);

    linear.stay_within(&wide, &real);
    assert_eq!(*linear.motion(), Motion::default());
    linear.continue_from(&real);
    assert_eq!(*linear.motion(), real);
    let elsewhere = Motion { position: Vector3::new(0.1, 0.0, 0.0), ..real };
    linear.stay_within(&wide, &elsewhere);
    assert_eq!(*linear.motion(), real);
    linear.stay_within(&narrow, &elsewhere);
    assert_eq!(*linear.motion(), elsewhere);
}

#[test]
fn a_steady_acceleration_leads_to_the_velocity_demanded() {
    let start =
        Motion { position: Vector3::new(0.1, 0.2, 0.3), velocity: Vector3::new(1.0, -2.0, 0.5), ..Motion::default() };
    let end = start.at_velocity(Vector3::new(1.5, -1.0, 0.25), 0.25);
    assert_eq!(end.velocity, Vector3::new(1.5, -1.0, 0.25));
    assert_eq!(end.acceleration, Vector3::new(2.0, 4.0, -1.0));
    assert!((end.position - start.position - Vector3::new(0.3125, -0.375, 0.09375)).amax() < 1e-15);
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn limits_hold_whatever_the_target(
        seed: u64, velocity in 0.1..3.0, acceleration in 1.0..30.0, range in 0.01..1.0, longest in 1e-4..0.05, kept in 1..30_u64,
    ) {
        // Different limits on each axis.
        let limits = SafetyParameters {
            position_limit: range * Vector3::new(1.0, 0.3, 2.0),
            velocity_limit: velocity * Vector3::new(1.0, 2.0, 0.5),
            acceleration_limit: acceleration * Vector3::new(1.0, 0.4, 1.5),
        };
        let mut units = SafetyUnits::new(longest);
        let mut random = Random::new(seed);
        let mut target = Motion::default();
        let mut last_mean: Option<(Vector3<f64>, f64)> = None;
        for k in 0..2000 {
            let step = random.between(0.01, 1.0) * longest;
            if k % kept == 0 {
                target = *units.motion();
            }
            target = hostile_targets(&mut random, &target, step);
            let before = *units.motion();
            units.advance(&target, &limits, step);
            let now = units.motion();
            let mean = (now.position - before.position) / step;
            for k in 0..3 {
                let most = limits.acceleration_limit[k];
                let rounding = 1.0 + 1e-9;
                prop_assert!(now.position[k].abs() <= limits.position_limit[k]);
                prop_assert!(now.velocity[k].abs() <= limits.velocity_limit[k] * rounding);
                prop_assert!(now.acceleration[k].abs() <= most * rounding);
                prop_assert!((now.velocity[k] - before.velocity[k]).abs() <= most * step * rounding);
                if let Some((last_mean, last_step)) = last_mean {
                    let noise = 1e-14 * (1.0 / step + 1.0 / last_step);
                    let change = (mean[k] - last_mean[k]).abs() - noise;
                    prop_assert!(change <= most * 0.5 * (step + last_step) * rounding, "{change}");
                }
            }
            last_mean = Some((mean, step));
        }
    }

    #[test]
    fn a_target_at_rest_is_reached_and_kept(seed: u64, goal in -0.35..0.35, step in 0.0005..0.01) {
        let limits = SafetyParameters::default();
        let mut units = SafetyUnits::new(0.01);
        let (mut random, mut target) = (Random::new(seed), Motion::default());
        for _ in 0..500 {
            target = hostile_targets(&mut random, &target, step);
            units.advance(&target, &limits, step);
        }
        let rest = Motion { position: goal * Vector3::new(1.0, -1.0, 0.5), ..Motion::default() };
        for _ in 0..(4.0 / step) as usize {
            units.advance(&rest, &limits, step);
        }
        prop_assert_eq!(*units.motion(), rest);
        prop_assert!(!units.limited());
    }

    #[test]
    fn the_approach_velocity_stops_in_its_distance(distance in 1e-9..1.0, acceleration in 0.1..20.0, step in 1e-4..0.02) {
        let velocity = approach_velocity(distance, acceleration, step);
        prop_assert!((velocity * velocity / (2.0 * acceleration) + velocity * step - distance).abs() < 1e-12);
        prop_assert_eq!(approach_velocity(-distance, acceleration, step), -velocity);
    }

    #[test]
    fn inside_its_limits_the_output_is_the_filters(seed: u64, step in 0.0005..0.005) {
        let (splitter, safety) = (parameters(&[]).splitter, SafetyParameters::default());
        let mut unit = DirectLinearMotion::new(&splitter, 4, step);
        let mut chain = Chain::new(Denominator::new(4, 2.5, 1.0, 2.5, 1.0));
        let mut random = Random::new(seed);
        let mut last = 0.0;
        for k in 0..1000 {
            let force = if k % 100 == 0 { random.between(-2.0, 2.0) } else { last };
            chain.advance(force, force, step);
            let demand = unit.advance_filters([Vector3::repeat(force); 2], step);
            let motion = unit.advance_within_limits(&demand, &safety, step);
            // Bit by bit.
            prop_assert_eq!(motion.position, Vector3::repeat(chain.second_integral()));
            prop_assert_eq!(motion.velocity, Vector3::repeat(chain.first_integral()));
            prop_assert_eq!(motion.acceleration, Vector3::repeat(chain.high_pass(force)));
            prop_assert!(!unit.limited());
            last = force;
        }
    }
}

#[test]
fn the_limit_is_reached_and_left_without_a_jump() {
    let safety = SafetyParameters { position_limit: Vector3::repeat(0.1), ..SafetyParameters::default() };
    let mut unit = DirectLinearMotion::new(&parameters(&[]).splitter, 4, 0.001);
    let (mut acted, mut free_again, mut farthest) = (false, 0, 0.0_f64);
    let mut before = *unit.motion();
    for k in 0..20_000 {
        let force = Vector3::repeat(if k < 5000 { 8.0 } else { 0.0 });
        let demand = unit.advance_filters([force; 2], 0.001);
        let now = *unit.advance_within_limits(&demand, &safety, 0.001);
        let moved = now.position - before.position - 0.0005 * (now.velocity + before.velocity);
        // A jump is a displacement beyond the mean velocity times the step. It
        // is at most 0.01 a h^2.
        assert!(moved.amax() <= 0.0101 * 10.0 * 1e-6, "at {k}: {moved}");
        assert!((now.velocity - before.velocity).amax() <= 10.0 * 0.001 * (1.0 + 1e-9));
        farthest = farthest.max(now.position.amax());
        acted |= unit.limited();
        free_again = if unit.limited() { 0 } else { free_again + 1 };
        before = now;
    }
    assert!(acted && farthest > 0.099 && farthest <= 0.1);
    assert!(free_again > 5000, "acts no more once the filter is back inside");
    assert!(before.position.amax() < 1e-9);
}
