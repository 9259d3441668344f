//! The conditions of a safety unit, each at its edge while all others hold.

use nalgebra::Vector3;

use super::SafetyUnits;
use crate::interface::SafetyParameters;
use crate::motion::Motion;
use crate::motion::braking_law::{Limits, REJOIN_TOLERANCE};

const STEP: f64 = 0.001;
const LONGEST_STEP: f64 = 0.004;
/// Largest rounding error of a difference of positions \[m\].
const ROUNDING: f64 = f64::EPSILON;

/// Different on each axis.
fn limits() -> SafetyParameters {
    SafetyParameters {
        position_limit: Vector3::new(0.3, 0.4, 0.5),
        velocity_limit: Vector3::new(0.7, 0.8, 0.9),
        acceleration_limit: Vector3::new(3.0, 4.0, 5.0),
    }
}

/// A motion at rest at neutral, but on one axis.
fn on_axis(k: usize, motion: Motion) -> Motion<Vector3<f64>> {
    Motion::from_axes(|axis| if axis == k { motion } else { Motion::default() })
}

fn motion(position: f64, velocity: f64, acceleration: f64) -> Motion {
    Motion { position, velocity, acceleration }
}

/// Units that move as `before` says and are not behind a demand.
fn moving(before: Motion<Vector3<f64>>) -> SafetyUnits {
    SafetyUnits { motion: before, ..SafetyUnits::new(LONGEST_STEP) }
}

/// True if a demand on one axis is kept as it is. The mirrored demand must be treated alike, and
/// the other axes must not change that.
fn complies(k: usize, before: Motion, demand: Motion, step: f64) -> bool {
    let kept = [1.0, -1.0].map(|sign| {
        let mirrored = |motion: Motion| {
            on_axis(
                k,
                Motion {
                    position: sign * motion.position,
                    velocity: sign * motion.velocity,
                    acceleration: sign * motion.acceleration,
                },
            )
        };
        let complies_by_axis = moving(mirrored(before)).complies_with_limits(&mirrored(demand), &limits(), step);
        assert!((0..3).all(|axis| axis == k || complies_by_axis[axis]), "{complies_by_axis:?}");
        complies_by_axis[k]
    });
    assert_eq!(kept[0], kept[1], "axis {k}: {before:?} to {demand:?}");
    kept[0]
}

/// A demand that is reached from `before` at a constant acceleration, and `gap` further \[m\].
fn reached(before: Motion, velocity: f64, gap: f64, step: f64) -> Motion {
    motion(before.position + 0.5 * (before.velocity + velocity) * step + gap, velocity, 0.0)
}

#[test]
fn a_demand_beyond_the_position_limit_is_not_kept_even_on_its_way_back() {
    for k in 0..3 {
        let limit = limits().position_limit[k];
        for (ratio, inside) in [(1.0 - 1e-12, true), (1.0 + 1e-12, false)] {
            let before = motion(limit * ratio + 0.1 * STEP, -0.1, 0.0);
            assert_eq!(complies(k, before, reached(before, -0.1, 0.0, STEP), STEP), inside, "axis {k}, {ratio}");
        }
    }
}

#[test]
fn a_demand_beyond_the_velocity_limit_is_not_kept() {
    for k in 0..3 {
        let limit = limits().velocity_limit[k];
        for (ratio, inside) in [(1.0, true), (1.0 + 1e-9, false)] {
            let before = motion(0.0, limit - 1e-4, 0.0);
            assert_eq!(
                complies(k, before, reached(before, limit * ratio, 0.0, STEP), STEP),
                inside,
                "axis {k}, {ratio}"
            );
        }
    }
}

#[test]
fn the_mean_velocity_of_a_step_counts_as_velocity() {
    for k in 0..3 {
        let limit = limits().velocity_limit[k];
        for (ratio, inside) in [(1.0 + 0.5e-9, true), (1.0 + 2e-9, false)] {
            // The velocity falls from beyond the limit to below it.
            let before = motion(0.0, limit * ratio + 1e-3, 0.0);
            let demand = reached(before, limit * ratio - 1e-3, 0.0, STEP);
            assert_eq!(complies(k, before, demand, STEP), inside, "axis {k}, {ratio}");
            // A position further ahead than the velocities account for.
            let before = motion(0.0, limit - 5e-4, 0.0);
            let demand = reached(before, limit - 5e-4, (limit * (ratio - 1.0) + 5e-4) * STEP, STEP);
            assert_eq!(complies(k, before, demand, STEP), inside, "axis {k}, gap, {ratio}");
        }
    }
}

#[test]
fn a_demand_beyond_the_acceleration_limit_is_not_kept() {
    for k in 0..3 {
        let limit = limits().acceleration_limit[k];
        for (ratio, inside) in [(1.0, true), (1.0 + 1e-12, false)] {
            assert_eq!(
                complies(k, Motion::default(), motion(0.0, 0.0, limit * ratio), STEP),
                inside,
                "axis {k}, {ratio}"
            );
        }
    }
}

#[test]
fn a_demand_must_be_able_to_stop_before_the_position_limit() {
    for k in 0..3 {
        let (farthest, most) = (limits().position_limit[k], limits().acceleration_limit[k]);
        let velocity = 0.6;
        // The braking distance v^2/(2 a) + v h/2.
        let distance = velocity * velocity / (2.0 * most) + 0.5 * velocity * LONGEST_STEP;
        for (ratio, inside) in [(1.0 + 1e-9, true), (1.0 - 1e-9, false)] {
            let position = farthest - distance * ratio;
            let before = motion(position - velocity * STEP, velocity, 0.0);
            assert_eq!(complies(k, before, motion(position, velocity, 0.0), STEP), inside, "axis {k}, {ratio}");
            // Away from the limit there is room.
            let before = motion(position + velocity * STEP, -velocity, 0.0);
            assert!(complies(k, before, motion(position, -velocity, 0.0), STEP));
        }
    }
}

#[test]
fn a_demand_must_be_reached_at_the_acceleration_limit() {
    for k in 0..3 {
        let most = limits().acceleration_limit[k];
        for (ratio, inside) in [(1.0 + 0.5e-9, true), (1.0 + 2e-9, false)] {
            for (change, gap) in [(1.0, 0.0), (-1.0, 0.0), (0.5, 0.25), (0.5, -0.25), (0.0, 0.5)] {
                let velocity = 0.1 + change * ratio * most * STEP;
                let demand = reached(motion(0.0, 0.1, 0.0), velocity, gap * ratio * most * STEP * STEP, STEP);
                assert_eq!(
                    complies(k, motion(0.0, 0.1, 0.0), demand, STEP),
                    inside,
                    "axis {k}, {change}, {gap}, {ratio}"
                );
            }
        }
    }
}

/// In a very short step, rounding is all there is.
#[test]
fn positions_that_differ_by_rounding_are_no_acceleration() {
    const SHORT: f64 = 1e-11;
    for k in 0..3 {
        for (rounding, inside) in [(0.9, true), (1.1, false)] {
            let demand = reached(Motion::default(), 0.0, rounding * ROUNDING, SHORT);
            assert_eq!(complies(k, Motion::default(), demand, SHORT), inside, "axis {k}, {rounding}");
            let limit = limits().velocity_limit[k];
            let before = motion(0.0, limit, 0.0);
            let demand = reached(before, limit, rounding * ROUNDING, SHORT);
            assert_eq!(complies(k, before, demand, SHORT), inside, "axis {k} at full speed, {rounding}");
        }
    }
}

/// A demand that jumps by 0.2 m on one axis and stays there.
fn jump(k: usize) -> Motion<Vector3<f64>> {
    on_axis(k, motion(0.2, 0.0, 0.0))
}

#[test]
fn a_demand_that_is_not_kept_is_followed_by_the_braking_law_on_its_axis() {
    for k in 0..3 {
        let (limits, demand) = (limits(), jump(k));
        let mut units = SafetyUnits::new(LONGEST_STEP);
        let law = Limits {
            min: -limits.position_limit[k],
            max: limits.position_limit[k],
            velocity: limits.velocity_limit[k],
            acceleration: limits.acceleration_limit[k],
            max_step: LONGEST_STEP,
        };
        assert!(!units.limited());
        let mut steps = 0;
        while *units.motion() != demand {
            let expected = law.follow(&units.motion().axis(k), &demand.axis(k), 0.5 * law.acceleration, STEP);
            units.advance(&demand, &limits, STEP);
            steps += 1;
            assert!(steps < 2000, "{:?}", units.motion());
            let joined = *units.motion() == demand;
            assert!(joined || units.motion().axis(k) == expected, "{:?}, not {expected:?}", units.motion());
            // The other axes have their demand, and the flag lasts until the axis has its own.
            assert!((0..3).all(|axis| axis == k || units.motion().axis(axis) == Motion::default()));
            assert_eq!(units.limited(), !joined);
        }
        assert!(steps > 100);
    }
}

#[test]
fn an_axis_joins_its_demand_within_a_hundredth_of_a_step_s_acceleration() {
    for k in 0..3 {
        let (most, velocity) = (limits().acceleration_limit[k], 0.2);
        for (factor, joins) in [(0.9, true), (1.1, false)] {
            for sign in [1.0, -1.0] {
                let mut units = SafetyUnits::new(LONGEST_STEP);
                units.continue_from(&on_axis(k, motion(0.05, velocity, 0.0)));
                let changed = velocity + 0.3 * most * STEP;
                let apart = sign * factor * REJOIN_TOLERANCE * most * STEP * STEP;
                let demand = on_axis(k, reached(motion(0.05, velocity, 0.0), changed, apart, STEP));
                units.advance(&demand, &limits(), STEP);
                assert_eq!(*units.motion() == demand, joins, "axis {k}, {factor}");
            }
        }
    }
}

#[test]
fn going_on_from_the_real_motion_is_not_a_limit_of_the_units() {
    let real = Motion::from_axes(|k| motion(0.1 + 0.05 * k as f64, 0.02, 0.0));
    let mut units = SafetyUnits::new(LONGEST_STEP);
    units.continue_from(&real);
    assert_eq!(*units.motion(), real);
    units.advance(&Motion::default(), &limits(), STEP);
    assert!(!units.limited());
    for k in 0..3 {
        let law = Limits::safety(&limits(), k, LONGEST_STEP);
        let expected = law.follow(&real.axis(k), &Motion::default(), 0.5 * law.acceleration, STEP);
        assert_eq!(units.motion().axis(k), expected);
    }
    // An axis that was limited stays so while it catches up.
    let mut units = SafetyUnits::new(LONGEST_STEP);
    units.advance(&jump(0), &limits(), STEP);
    let limited = *units.motion();
    units.continue_from(&limited);
    units.advance(&jump(0), &limits(), STEP);
    assert!(units.limited());
}

#[test]
fn a_motion_is_beyond_tightened_limits_by_its_velocity_or_by_its_braking_distance() {
    for k in 0..3 {
        let (farthest, fastest, most) =
            (limits().position_limit[k], limits().velocity_limit[k], limits().acceleration_limit[k]);
        let beyond = |position: f64, velocity: f64| {
            let found = [1.0, -1.0]
                .map(|sign| moving(on_axis(k, motion(sign * position, sign * velocity, 0.0))).beyond_limits(&limits()));
            assert_eq!(found[0], found[1]);
            found[0]
        };
        assert!(!beyond(0.0, fastest) && beyond(0.0, fastest * (1.0 + 1e-12)));
        assert!(!beyond(farthest, 0.0) && beyond(farthest * (1.0 + 1e-12), 0.0));
        let velocity = 0.6;
        let distance = velocity * velocity / (2.0 * most);
        // A rounding error is allowed for.
        assert!(!beyond(farthest - distance * (1.0 - 0.5e-9), velocity));
        assert!(beyond(farthest - distance * (1.0 - 2e-9), velocity));
        // On its way back it can stop.
        assert!(!beyond(farthest - distance * 0.5, -velocity));
    }
}
