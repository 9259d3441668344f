//! Attempts to refute the certificate: derivatives beyond their bounds, and limits broken between
//! the points looked at.

mod edges;
mod liveness;
mod tightened;

use std::cell::Cell;

use nalgebra::Vector3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

use super::bounds::JointBounds;
use super::certificate;
use super::certifier::Certifier;
use super::cranks::Way;
use super::home::Distance;
use super::*;
use crate::interface::Rig;
use crate::motion::Motion;
use crate::motion::braking_law::Limits;
use crate::platform::inverse::leg_motion;

/// Number of cases of a search: by default a twenty-fifth of all.
fn case_count(all: u32) -> u32 {
    crate::cases::cases(all, all / 25)
}

fn search(cases: u32) -> TestRunner {
    let config = Config { rng_seed: RngSeed::Fixed(11), failure_persistence: None, ..Config::with_cases(cases) };
    TestRunner::new(config)
}

fn vector(scale: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-scale..scale, -scale..scale, -scale..scale].prop_map(Vector3::from)
}

/// Three coordinates that move with a steady acceleration.
fn moving(position: f64, velocity: f64, acceleration: f64) -> impl Strategy<Value = Motion<Vector3<f64>>> {
    (vector(position), vector(velocity), vector(acceleration)).prop_map(|(position, velocity, acceleration)| Motion {
        position,
        velocity,
        acceleration,
    })
}

fn coordinates_after(start: &PlatformCoordinates, time: f64) -> PlatformCoordinates {
    PlatformCoordinates { linear: start.linear.after(time), angles: start.angles.after(time) }
}

fn sum(v: &Vector3<f64>) -> f64 {
    v.abs().sum()
}

/// The first three derivatives of a leg's length at `time`, by central differences of
/// fourth and second order.
fn derivatives(length: impl Fn(f64) -> f64, time: f64, h: f64) -> [f64; 3] {
    let [a, b, c, d, e, f, g] = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(|k| length(time + k * h));
    [
        (b - 8.0 * c + 8.0 * e - f) / (12.0 * h),
        (-b + 16.0 * c - 30.0 * d + 16.0 * e - f) / (12.0 * h * h),
        (a - 8.0 * b + 13.0 * c - 13.0 * e + 8.0 * f - g) / (8.0 * h * h * h),
    ]
}

#[test]
fn no_leg_exceeds_the_bounds_on_its_derivatives() {
    let rig = Rig::default();
    let speeds = (-2.0..0.7_f64, -2.0..0.7_f64, -1.0..1.3_f64, -1.0..1.3_f64)
        .prop_map(|(a, b, c, d)| [a, b, c, d].map(|exponent| 10.0_f64.powf(exponent)));
    let pieces = speeds.prop_flat_map(|[v, w, s, e]| (moving(0.4, v, s), moving(0.8, w, e)));
    let closest = [const { Cell::new(0.0_f64) }; 3];
    search(case_count(500_000))
        .run(&(pieces, 0..6_usize), |((linear, angles), i)| {
            let start = PlatformCoordinates { linear, angles };
            let geometry = crate::platform::Geometry::from(&rig);
            let radius = rig.platform.iter().map(|joint| joint.norm()).fold(0.0, f64::max);
            let length = |time: f64| {
                let motion = coordinates_after(&start, time).motion(rig.neutral_height);
                leg_motion(&geometry, &motion).position[i]
            };
            let [l, h] = [length(0.0), 2e-3];
            if l < 0.4 {
                return Ok(());
            }
            let bounds = JointBounds::new(
                [linear.velocity.norm(), sum(&angles.velocity)],
                [linear.acceleration.norm(), sum(&angles.acceleration)],
                radius,
            );
            let found = derivatives(length, 0.0, h);
            let bound =
                [bounds.velocity, bounds.acceleration + bounds.velocity * bounds.velocity / l, bounds.leg_jerk(l)];
            // Truncation of the differences, with derivatives that grow by the rates of motion.
            let rate = h * (1.0 + bounds.velocity / l + bounds.jerk.cbrt() + bounds.acceleration.sqrt());
            for k in 0..3 {
                let rounding = 1e-14 / h.powi(k as i32 + 1);
                let truncation = bound[k] * rate * rate;
                prop_assert!(found[k].abs() <= bound[k] + rounding + truncation, "{k}: {} > {}", found[k], bound[k]);
                closest[k].set(closest[k].get().max(found[k].abs() / (bound[k] + rounding)));
            }
            Ok(())
        })
        .unwrap();
    // The bounds are not so wide that nothing could refute them.
    assert!(closest.iter().all(|ratio| ratio.get() > 0.4), "{closest:?}");
}

/// The joints of the default rig with cranks between them.
fn crank_rig() -> Rig {
    Rig {
        neutral_height: 0.98,
        crank_arm: 0.2,
        crank_rod: 1.1,
        crank_heading: [-1.6, 1.6, 0.5, 3.7, 2.6, 5.8],
        crank_least_transmission: 0.05,
        ..Rig::default()
    }
}

/// Cranks about neutral, which move at random: derivatives of arcs against their bounds at the real
/// transmission, and the change of the transmission against its slope.
#[test]
fn no_crank_exceeds_the_bounds_on_its_derivatives() {
    let rig = crank_rig();
    let geometry = crate::platform::Geometry::from(&rig);
    let cranks = geometry.cranks.expect("the rig has cranks");
    let radius = rig.platform.iter().map(|joint| joint.norm()).fold(0.0, f64::max);
    let speeds = (-2.0..0.5_f64, -2.0..0.5_f64, -1.0..1.0_f64, -1.0..1.0_f64)
        .prop_map(|(a, b, c, d)| [a, b, c, d].map(|exponent| 10.0_f64.powf(exponent)));
    let pieces = speeds.prop_flat_map(|[v, w, s, e]| (moving(0.15, v, s), moving(0.15, w, e)));
    let closest = [const { Cell::new(0.0_f64) }; 4];
    let checked = Cell::new(0);
    search(case_count(200_000))
        .run(&(pieces, 0..6_usize), |((linear, angles), i)| {
            let start = PlatformCoordinates { linear, angles };
            let h = 1e-4;
            let motion = |time: f64| coordinates_after(&start, time).motion(rig.neutral_height);
            let arms = |time: f64| cranks.arms_in(&geometry, &motion(time).pose());
            let transmission = (-3..=3).map(|k| arms(f64::from(k) * h).transmission[i]).fold(f64::INFINITY, f64::min);
            if transmission < 0.1 {
                return Ok(());
            }
            checked.set(checked.get() + 1);
            let bounds = JointBounds::new(
                [
                    linear.velocity.norm() + 3.0 * h * linear.acceleration.norm(),
                    sum(&angles.velocity) + 3.0 * h * sum(&angles.acceleration),
                ],
                [linear.acceleration.norm(), sum(&angles.acceleration)],
                radius,
            );
            let JointBounds { velocity, acceleration, .. } = bounds;
            let [first, second, third] = derivatives(|time| cranks.arm * arms(time).angles()[i], 0.0, h);
            let slope = (arms(h).transmission[i] - arms(-h).transmission[i]) / (2.0 * h);
            let pairs = [
                (first, velocity / transmission),
                (second, (acceleration + velocity * velocity * cranks.turning(transmission)) / transmission),
                (third, cranks.arc_jerk(&bounds, transmission, first.abs() + 3.0 * h * second.abs())),
                (slope, velocity * cranks.transmission_slope(transmission)),
            ];
            for (k, (found, bound)) in pairs.into_iter().enumerate() {
                let rounding = 1e-14 / h.powi((k % 3) as i32 + 1);
                prop_assert!(found.abs() <= 1.001 * bound + rounding, "{k}: {found} > {bound} at {transmission}");
                closest[k].set(closest[k].get().max(found.abs() / (bound + rounding)));
            }
            Ok(())
        })
        .unwrap();
    let closest = closest.map(|ratio| ratio.get());
    // The bounds are not so wide that nothing could refute them.
    assert!(checked.get() > 1000 && closest[0] > 0.9 && closest[1] > 0.6 && closest[3] > 0.3, "{closest:?}");
}

/// A rig whose limits are of the size of what the tested states need.
fn certifiers() -> impl Strategy<Value = (Certifier, SafetyParameters)> {
    (-0.7..1.6_f64, -1.0..0.5_f64, -4.0..-1.3_f64, -0.5..1.3_f64).prop_map(|(a, v, step, safety)| {
        let [acceleration_limit, velocity_limit, step] = [a, v, step].map(|exponent| 10.0_f64.powf(exponent));
        let rig = Rig { acceleration_limit, velocity_limit, ..Rig::default() };
        let most = 10.0_f64.powf(safety);
        let safety = SafetyParameters {
            acceleration_limit: Vector3::new(most, 0.5 * most, 2.0 * most),
            ..SafetyParameters::default()
        };
        (Certifier::new(&rig, step), safety)
    })
}

/// True if leg lengths, rates and accelerations keep the rig's limits.
fn complies_with_limits(certifier: &Certifier, coordinates: &PlatformCoordinates) -> bool {
    let legs = leg_motion(&certifier.geometry, &coordinates.motion(certifier.neutral_height));
    const ROUNDING: f64 = 1.0 + 1e-9;
    (0..6).all(|i| {
        (certifier.limits.min - 1e-12..=certifier.limits.max + 1e-12).contains(&legs.position[i])
            && legs.velocity[i].abs() <= certifier.limits.velocity * ROUNDING
            && legs.acceleration[i].abs() <= certifier.limits.acceleration * ROUNDING
    })
}

#[test]
fn a_certified_way_keeps_every_limit_between_the_points_looked_at() {
    let states = certifiers().prop_flat_map(|(certifier, safety)| {
        let fastest = certifier.limits.velocity;
        let hardest = certifier.limits.acceleration;
        let state = (moving(0.3, fastest, hardest), moving(0.3, fastest, hardest));
        (Just(certifier), Just(safety), state, -4.0..-1.3_f64, 0.01..1.0_f64)
    });
    let [certified, refused] = [const { Cell::new(0) }; 2];
    search(case_count(100_000))
        .run(&states, |(certifier, safety, (linear, angles), step, size)| {
            let step = 10.0_f64.powf(step).min(certifier.limits.max_step);
            let scaled = |motions: &Motion<Vector3<f64>>| Motion {
                position: motions.position,
                velocity: size * motions.velocity,
                acceleration: size * motions.acceleration,
            };
            let start = PlatformCoordinates { linear: scaled(&linear), angles: scaled(&angles) };
            let end = coordinates_after(&start, step);
            let motion = |coordinates: &PlatformCoordinates| coordinates.motion(certifier.neutral_height);
            let Some(plan) = certifier.certify(&certifier.state(start), &certifier.state(end), &safety, step) else {
                refused.set(refused.get() + 1);
                return Ok(());
            };
            certified.set(certified.get() + 1);
            const POINTS: usize = 100;
            for k in 0..=POINTS {
                let fraction = k as f64 / POINTS as f64;
                // The guard cannot have a start outside the stroke: only its end is certified.
                let on_transition = coordinates_after(&start, fraction * step);
                let legs = leg_motion(&certifier.geometry, &motion(&on_transition));
                for i in 0..6 {
                    prop_assert!(legs.velocity[i].abs() <= certifier.limits.velocity * (1.0 + 1e-9));
                    prop_assert!(legs.acceleration[i].abs() <= certifier.limits.acceleration * (1.0 + 1e-9));
                }
                let [.., duration] = plan.durations().breakpoints();
                let stopping = plan.at(fraction * duration);
                prop_assert!(complies_with_limits(&certifier, &stopping), "{stopping:?}");
                for k in 0..3 {
                    let axis = stopping.linear.axis(k);
                    prop_assert!(axis.position.abs() <= safety.position_limit[k] * (1.0 + 1e-9));
                    // From beyond its limit, an axis becomes no faster.
                    let fastest = safety.velocity_limit[k].max(start.linear.velocity[k].abs());
                    prop_assert!(axis.velocity.abs() <= fastest * (1.0 + 1e-9));
                    prop_assert!(axis.acceleration.abs() <= safety.acceleration_limit[k] * (1.0 + 1e-9));
                }
            }
            Ok(())
        })
        .unwrap();
    let (certified, refused) = (certified.get(), refused.get());
    assert!(certified.min(refused) > case_count(100_000) / 20, "{certified} certified, {refused} refused");
}

/// Cranks whose stops and ways home are certified, by bounds or by points: their limits are kept at
/// all points of both.
#[test]
fn certified_ways_of_cranks_keep_every_limit_between_the_points_looked_at() {
    // At neutral the transmission is 0.774: a rig that must keep more is refused.
    let cases = (-1.0..0.7_f64, 0.3..1.4_f64, 0.05..0.77_f64, -2.3..-0.7_f64, -2.0..-0.3_f64);
    let states = cases.prop_flat_map(|(fastest, range, least, far, size)| {
        let [far, size] = [far, size].map(|exponent| 10.0_f64.powf(exponent));
        let acceleration_limit = 10.0_f64.powf(fastest + 0.7);
        let rig = Rig {
            velocity_limit: 10.0_f64.powf(fastest),
            acceleration_limit,
            crank_min_angle: -range,
            crank_max_angle: 1.1 * range,
            crank_least_transmission: least,
            ..crank_rig()
        };
        let certifier = Certifier::new(&rig, 4e-3);
        let motions = (moving(far, size, size), moving(far, size, size));
        (Just(certifier), motions)
    });
    let [by_bounds, by_ends, by_points, refused] = [const { Cell::new(0) }; 4];
    let count = |cell: &Cell<u32>| cell.set(cell.get() + 1);
    search(case_count(100_000))
        .run(&states, |(certifier, (linear, angles))| {
            let (step, safety) = (2e-3, SafetyParameters::default());
            let cranks = certifier.geometry.cranks.expect("the rig has cranks");
            let start = PlatformCoordinates { linear, angles };
            let end = coordinates_after(&start, step);
            let [from, to] = [start, end].map(|coordinates| certifier.state(coordinates));
            let plan = certifier.certify(&from, &to, &safety, step);
            let duration = plan.map(|plan| plan.durations().breakpoints()[3]);
            let bounds = certifier.certify_home_by_bounds(&from, &to, &safety, step).is_some();
            let home = |(plan, duration): &(StopPlan, f64)| bounds || certifier.has_way_home(&plan.at(*duration));
            let Some((plan, duration)) = plan.zip(duration).filter(home) else {
                count(&refused);
                return Ok(());
            };
            let ends = certifier
                .stop_plan(&to, &safety)
                .is_some_and(|stop| stop == plan && certifier.ends_certify_stop(&cranks, &from, &to, &stop, step));
            let by = match (bounds, ends) {
                (true, _) => &by_bounds,
                (false, true) => &by_ends,
                (false, false) => &by_points,
            };
            count(by);
            let complies = |coordinates: &PlatformCoordinates| {
                let legs = leg_motion(&certifier.geometry, &coordinates.motion(certifier.neutral_height));
                complies_with_limits(&certifier, coordinates)
                    && legs.transmission >= cranks.least_transmission * (1.0 - 1e-9)
            };
            const POINTS: usize = 100;
            for k in 0..=POINTS {
                let fraction = k as f64 / POINTS as f64;
                let on_transition = coordinates_after(&start, fraction * step).motion(certifier.neutral_height);
                let legs = leg_motion(&certifier.geometry, &on_transition);
                let largest = |values: [f64; 6]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                prop_assert!(largest(legs.velocity) <= certifier.limits.velocity * (1.0 + 1e-9), "{from:?}");
                prop_assert!(largest(legs.acceleration) <= certifier.limits.acceleration * (1.0 + 1e-9), "{from:?}");
                prop_assert!(complies(&plan.at(fraction * duration)), "{fraction} of the stop from {to:?}");
                let rest = plan.at(duration);
                let home = |motion: Motion<Vector3<f64>>| Motion {
                    position: (1.0 - fraction) * motion.position,
                    ..Motion::default()
                };
                let on_way = PlatformCoordinates { linear: home(rest.linear), angles: home(rest.angles) };
                prop_assert!(complies(&on_way), "{fraction} of the way home from {rest:?}");
            }
            Ok(())
        })
        .unwrap();
    let counts = [by_bounds, by_ends, by_points, refused].map(|cell| cell.get());
    assert!(counts.iter().all(|count| *count > case_count(100_000) / 50), "{counts:?}");
}

/// Squares of transmissions on the straight way home lie beneath their chords by no more than the
/// bound has.
#[test]
fn squares_of_transmissions_keep_near_their_chords() {
    let certifier = Certifier::new(&crank_rig(), 1e-3);
    let cranks = certifier.geometry.cranks.expect("the rig has cranks");
    let closest = Cell::new(0.0_f64);
    let risen = Cell::new(0);
    search(case_count(100_000))
        .run(&(vector(0.3), vector(0.3), -4.0..0.0_f64), |(position, angles, exponent)| {
            let angles = 10.0_f64.powf(exponent) * angles;
            let arms = |s: f64| {
                let at = |position: &Vector3<f64>| Motion { position: (1.0 - s) * position, ..Motion::default() };
                let coordinates = PlatformCoordinates { linear: at(&position), angles: at(&angles) };
                cranks.arms_in(&certifier.geometry, &coordinates.motion(certifier.neutral_height).pose())
            };
            let angular = sum(&angles);
            let distance = Distance { joint: position.norm() + angular * certifier.radius, angular };
            let (first, neutral) = (arms(0.0), certifier.home.arms.expect("the rig has cranks"));
            let (bend, farthest) = (angular * angular * certifier.radius, certifier.home.joints[1] + distance.joint);
            let bends = Way::new(&cranks, [&first, &neutral], bend, farthest, 0.0).square_bends;
            let [start, middle, end] = [0.0, 0.5, 1.0].map(|s| arms(s).transmission.map(|k| k * k));
            for i in 0..6 {
                // Zero stands for rods that do not reach: then nothing is known of the square.
                if start[i] > 0.0 && middle[i] > 0.0 {
                    let beneath = 0.5 * (start[i] + end[i]) - middle[i];
                    let bound = 0.125 * bends[i];
                    prop_assert!(beneath <= bound + 1e-12, "{beneath} beneath, bound {bound}");
                    if bound < -1e-6 {
                        closest.set(closest.get().max(bound / beneath));
                        risen.set(risen.get() + 1);
                    }
                }
            }
            Ok(())
        })
        .unwrap();
    // It is not so wide that nothing could refute it: on many ways the squares lie above the chords.
    assert!(closest.get() > 0.3 && risen.get() > 100, "{closest:?} {risen:?}");
}

/// A certifier without limits.
fn unlimited() -> Certifier {
    let mut certifier = Certifier::new(&Rig::default(), 1e-3);
    certifier.limits = Limits { min: 0.0, max: 1e9, velocity: 1e9, acceleration: 1e9, max_step: 1e-3 };
    certifier
}

#[test]
fn an_interval_is_refused_if_a_limit_is_exceeded_anywhere_in_it() {
    let speeds = (-1.5..0.3_f64, -1.5..0.3_f64, -1.0..1.3_f64, -1.0..1.3_f64)
        .prop_map(|(a, b, c, d)| [a, b, c, d].map(|exponent| 10.0_f64.powf(exponent)));
    let pieces = speeds.prop_flat_map(|[v, w, s, e]| (moving(0.3, v, s), moving(0.5, w, e)));
    let inside = [const { Cell::new(0) }; 4];
    search(crate::cases::cases(15_000, 6_000))
        .run(&(pieces, -2.5..-1.0_f64), |((linear, angles), duration)| {
            let start = PlatformCoordinates { linear, angles };
            let duration = 10.0_f64.powf(duration);
            let certifier = unlimited();
            let at = |time: f64| certifier.leg_motion_of(&coordinates_after(&start, time));
            let end = coordinates_after(&start, duration);
            let faster = |a: &Vector3<f64>, b: &Vector3<f64>| a.norm().max(b.norm());
            let bounds = JointBounds::new(
                [faster(&linear.velocity, &end.linear.velocity), sum(&angles.velocity).max(sum(&end.angles.velocity))],
                [linear.acceleration.norm(), sum(&angles.acceleration)],
                Rig::default().platform.iter().map(|joint| joint.norm()).fold(0.0, f64::max),
            );
            let complies = |certifier: &Certifier| {
                let stroke = (certifier.limits.min, certifier.limits.max);
                certifier.interval_complies_with_leg_limits(
                    &at(0.0),
                    &at(duration),
                    &bounds,
                    duration,
                    stroke,
                    &[0.0; 6],
                )
            };
            let largest = |points: usize| {
                (0..=points).fold([f64::MIN; 4], |largest, k| {
                    let legs = at(k as f64 / points as f64 * duration);
                    (0..6).fold(largest, |[a, v, short, long], i| {
                        let longer = long.max(legs.position[i]);
                        let shorter = short.max(-legs.position[i]);
                        [a.max(legs.acceleration[i].abs()), v.max(legs.velocity[i].abs()), shorter, longer]
                    })
                })
            };
            let [reached, at_ends] = [largest(64), largest(1)];
            for k in 0..4 {
                // As much as any instant exceeds both ends by, and hardly more than that.
                let limit = reached[k] - 1e-9;
                let mut certifier = unlimited();
                match k {
                    0 => certifier.limits.acceleration = limit,
                    1 => certifier.limits.velocity = limit,
                    2 => certifier.limits.min = -limit,
                    _ => certifier.limits.max = limit,
                }
                prop_assert!(!complies(&certifier), "{k}: {limit} kept, but {} reached", reached[k]);
                inside[k].set(inside[k].get() + u32::from(reached[k] > at_ends[k] + 1e-6));
            }
            Ok(())
        })
        .unwrap();
    // In many cases the ends alone do not show it.
    assert!(inside.iter().all(|count| count.get() > crate::cases::cases(50, 10)), "{inside:?}");
}

#[test]
fn a_plan_followed_in_parts_is_the_plan() {
    let start = PlatformCoordinates {
        linear: Motion { velocity: Vector3::new(0.3, -0.2, 0.0), ..Motion::default() },
        angles: Motion { velocity: Vector3::new(0.0, 0.1, -0.1), ..Motion::default() },
    };
    let durations = StopDurations { linear: Vector3::new(0.1, 0.05, 0.1), angular: 0.1 };
    let plan = StopPlan::new(&start, durations);
    let mut held_plan = plan;
    for _ in 0..30 {
        held_plan = held_plan.advanced(0.003);
    }
    let expected = plan.at(0.09);
    assert!((held_plan.coordinates().linear.position - expected.linear.position).amax() < 1e-15);
    for _ in 0..30 {
        held_plan = held_plan.advanced(0.003);
    }
    // 0.3 m/s in 0.1 s, 0.2 m/s in 0.05 s, 0.1 rad/s in 0.1 s.
    let rest = held_plan.coordinates();
    assert!((rest.linear.position - Vector3::new(0.015, -0.005, 0.0)).amax() < 1e-15);
    assert!((rest.angles.position - Vector3::new(0.0, 0.005, -0.005)).amax() < 1e-15);
    assert_eq!((rest.linear.velocity, rest.angles.velocity), (Vector3::zeros(), Vector3::zeros()));
}

/// A leg at the end of its certified stroke is drawn back by a hundred-thousandth of it.
#[test]
fn legs_pursue_their_demands_a_little_inside_the_certified_stroke() {
    let certifier = Certifier::new(&Rig::default(), 1e-3);
    let (certified, pursued) = (certifier.limits, certifier.pursuit_limits());
    let margin = 1e-5 * (certified.max - certified.min);
    assert!(
        (pursued.min - certified.min - margin).abs() < 1e-12 && (certified.max - pursued.max - margin).abs() < 1e-12
    );
    assert_eq!(pursued.acceleration, certified.acceleration);
}

/// The platform joins a demand that is at most 0.01 a h² away, with the limit of acceleration a and
/// the step h. The same holds for each leg and for each axis.
#[test]
fn the_platform_joins_its_demand_where_neither_legs_nor_axes_are_apart() {
    let (rig, step) = (Rig::default(), 0.002);
    let guard = ActuatorGuard::new(&rig, step);
    let joins = |surge: f64, most: f64| {
        let mut demand = PlatformCoordinates::default();
        demand.linear.position.x = surge;
        let safety = SafetyParameters { acceleration_limit: Vector3::repeat(most), ..SafetyParameters::default() };
        guard.has_caught_up(&guard.state(demand), &safety, step)
    };
    // Surge changes the leg that lies along it most by this much a metre.
    let neutral = guard.commanded.legs.position;
    let mut moved = PlatformCoordinates::default();
    moved.linear.position.x = 1e-6;
    let moved = guard.state(moved).legs.position;
    let leg = (0..6).map(|i| (moved[i] - neutral[i]).abs() / 1e-6).fold(0.0, f64::max);
    let of_legs = 0.01 * rig.acceleration_limit * step * step / leg;
    assert!(joins(0.999 * of_legs, 1e3) && !joins(1.001 * of_legs, 1e3));
    let of_axes = |most: f64| 0.01 * most * step * step;
    for most in [0.03, 2.0] {
        assert!(joins(0.999 * of_axes(most), most) && !joins(1.001 * of_axes(most), most));
    }
}

/// A demand whose acceleration jumps: the legs keep their limit with the mean over the step.
#[test]
fn reported_accelerations_of_the_legs_keep_their_limit() {
    let rig = Rig { acceleration_limit: 5.0, ..Rig::default() };
    let mut guard = ActuatorGuard::new(&rig, 0.001);
    for (acceleration, expected) in [(1.0, None), (-1.0, None), (9.0, Some(5.0)), (-9.0, Some(-5.0))] {
        let mut demand = PlatformCoordinates::default();
        demand.linear.acceleration.z = acceleration;
        guard.advance(&guard.state(demand), &SafetyParameters::default(), false, 0.001);
        assert!(!guard.limited());
        let exact = leg_accelerations(&guard.certifier.geometry, &guard.commanded.motion);
        assert!(exact.iter().all(|exact| exact.abs() > 5.0) == expected.is_some());
        assert_eq!(guard.leg_accelerations(), exact.map(|exact| expected.unwrap_or(exact)));
    }
}

/// The trajectory of a candidate that falls short of it is looked at where it ends, too.
#[test]
fn a_trajectory_that_ends_beyond_a_position_limit_is_refused() {
    let safety = SafetyParameters { position_limit: Vector3::repeat(0.1), ..SafetyParameters::default() };
    let state = |position: f64, velocity: f64| {
        let mut state = PlatformCoordinates::default();
        state.linear.position.y = position;
        state.linear.velocity.y = velocity;
        state
    };
    let step = 0.01;
    for (shown, accepted) in [(0.099_99, false), (0.1, false), (0.099_85, true)] {
        // The trajectory ends 1e-4 m on from its start.
        let start = if accepted { 0.099_85 } else { 0.099_95 };
        let [from, to] = [state(start, 0.02), state(shown, 0.0)];
        assert_eq!(certificate::axes_comply_with_limits(&from, &to, &safety, step), accepted, "{shown} m");
    }
}

#[test]
fn the_rate_of_the_actuator_clearance_is_its_derivative() {
    let (rig, step) = (Rig::default(), 1e-4);
    let mut guard = ActuatorGuard::new(&rig, step);
    let at = |time: f64| {
        let axis = |amplitude: f64, omega: f64| Motion {
            position: amplitude * (1.0 - (omega * time).cos()),
            velocity: amplitude * omega * (omega * time).sin(),
            acceleration: amplitude * omega * omega * (omega * time).cos(),
        };
        let linear = Motion::from_axes(|k| axis([0.05, -0.04, 0.06][k], [3.0, 4.0, 5.0][k]));
        PlatformCoordinates { linear, angles: Motion::from_axes(|k| axis([0.04, 0.03, -0.05][k], 2.0)) }
    };
    let (mut clearances, mut rates) = (Vec::new(), Vec::new());
    for k in 1..=15_000 {
        let demand = at(f64::from(k) * step);
        guard.advance(&guard.state(demand), &SafetyParameters::default(), false, step);
        clearances.push(guard.actuator_clearance());
        rates.push(guard.actuator_clearance_rate());
    }
    assert!(!guard.limited());
    let wrong = (1..clearances.len() - 1)
        .filter(|&k| ((clearances[k + 1] - clearances[k - 1]) / (2.0 * step) - rates[k]).abs() > 1e-5)
        .count();
    // At some instants another leg becomes the nearest to its end.
    assert!(wrong < 60, "{wrong} of {}", clearances.len());
    let [least, most] = [f64::min, f64::max].map(|of| rates.iter().copied().reduce(of).unwrap());
    assert!(least < -0.05 && most > 0.05, "{least} to {most} m/s");
}
