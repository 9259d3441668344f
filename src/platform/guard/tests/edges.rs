//! The certificate at the edge of each limit, against the conditions of its proof, which are
//! written out once more here.
//!
//! Each case is a random step of a random size. One limit after the other is tightened from far
//! away until the conditions refuse the step. On both sides of that edge the certificate must agree
//! with them, in its answer and in the durations of the stop.

use nalgebra::Vector3;
use proptest::prelude::*;

use super::{JointBounds, search, sum, vector};
use crate::interface::{Rig, SafetyParameters};
use crate::motion::Motion;
use crate::motion::braking_law;
use crate::platform::guard::certifier::{Certifier, step_margin};
use crate::platform::inverse::{LegMotion, leg_motion};
use crate::platform::stop_plan::{StopDurations, StopPlan};
use crate::platform::{Geometry, PlatformCoordinates};

/// Longest step of all machines here \[s\].
const LONGEST_STEP: f64 = 0.004;
/// Relative excess of a limit that is allowed where positions are compared with each other.
const ROUNDING: f64 = 1e-9;
/// Number of limits: shortest and longest leg, its velocity and acceleration, and three each of the
/// safety limits of position, velocity and acceleration.
const LIMITS: usize = 13;

/// Limits in that order.
#[derive(Clone, Copy, Debug)]
struct Limits([f64; LIMITS]);

impl Limits {
    /// Beyond what any step here needs.
    const LOOSE: Limits = Limits([0.7, 3.0, 40.0, 400.0, 3.0, 3.0, 3.0, 40.0, 40.0, 40.0, 400.0, 400.0, 400.0]);
    /// Limits that no step here complies with.
    const TIGHT: [f64; LIMITS] = [2.9, 0.71, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9, 1e-9];

    /// With one of them `fraction` of the way from loose to tight, by factors.
    fn tightened(self, which: usize, fraction: f64) -> Self {
        let mut limits = self;
        limits.0[which] *= (Self::TIGHT[which] / self.0[which]).powf(fraction);
        limits
    }

    /// A rig whose joints are at different distances from its origin.
    fn rig(&self) -> Rig {
        let [min_length, max_length, velocity_limit, acceleration_limit, ..] = self.0;
        let mut rig = Rig { min_length, max_length, velocity_limit, acceleration_limit, ..Rig::default() };
        for (i, joint) in rig.platform.iter_mut().enumerate() {
            *joint *= 1.0 + 0.1 * (i as f64 * 2.0).sin();
        }
        rig
    }

    fn safety(&self) -> SafetyParameters {
        let three = |first: usize| Vector3::new(self.0[first], self.0[first + 1], self.0[first + 2]);
        SafetyParameters { position_limit: three(4), velocity_limit: three(7), acceleration_limit: three(10) }
    }
}

/// A step, from a state to a candidate.
#[derive(Clone, Debug)]
struct Case {
    now: PlatformCoordinates,
    next: PlatformCoordinates,
    step: f64,
}

/// Steps of random directions and speeds, with a gap at their ends.
fn cases(gap: f64) -> impl Strategy<Value = Case> {
    let scales = (-2.5..0.5_f64, -2.5..0.3_f64, -1.0..1.3_f64, -1.0..1.3_f64, -3.5..-2.4_f64)
        .prop_map(|(a, b, c, d, e)| [a, b, c, d, e].map(|exponent| 10.0_f64.powf(exponent)));
    let states = (vector(0.2), vector(0.3), vector(1.0), vector(1.0), vector(1.0), vector(1.0));
    let gaps = (vector(1.0), vector(1.0), vector(1.0));
    (scales, states, gaps).prop_map(move |([v, w, s, e, step], (p, q, pv, qv, ps, qs), (d, angle_gap, shown))| {
        let linear = Motion { position: p, velocity: v * pv, acceleration: s * ps };
        let angles = Motion { position: q, velocity: w * qv, acceleration: e * qs };
        let now = PlatformCoordinates { linear, angles };
        let mut next = PlatformCoordinates { linear: linear.after(step), angles: angles.after(step) };
        next.linear.position += gap * s * step * step * d;
        next.angles.position += gap * e * step * step * angle_gap;
        next.linear.acceleration = s * shown;
        Case { now, next, step }
    })
}

/// The certificate of this case.
fn certified(case: &Case, limits: &Limits, by_bounds: bool) -> Option<StopDurations> {
    let (rig, safety) = (limits.rig(), limits.safety());
    let certifier = Certifier::new(&rig, LONGEST_STEP);
    let [from, to] = [case.now, case.next].map(|coordinates| certifier.state(coordinates));
    if by_bounds {
        return certifier.certify_by_bounds(&from, &to, &safety, case.step).map(StopDurations::common);
    }
    certifier.certify(&from, &to, &safety, case.step).map(|plan| *plan.durations())
}

/// The conditions of the proof, for a case and limits.
struct Conditions {
    case: Case,
    rig: Rig,
    safety: SafetyParameters,
    /// The farthest joint of the platform.
    radius: f64,
    /// Between these, a leg may come to rest.
    shortest: f64,
    longest: f64,
}

/// Size of a difference of positions, less what rounding may have added.
fn size(difference: f64) -> f64 {
    (difference.abs() - f64::EPSILON).max(0.0)
}

/// The larger of two numbers.
fn most(a: f64, b: f64) -> f64 {
    a.max(b)
}

impl Conditions {
    fn new(case: &Case, limits: &Limits) -> Self {
        let rig = limits.rig();
        let margin = (rig.acceleration_limit * LONGEST_STEP.powi(2) / 8.0).min(rig.velocity_limit * LONGEST_STEP / 2.0);
        Conditions {
            case: case.clone(),
            radius: rig.platform.iter().map(|joint| joint.norm()).reduce(f64::max).unwrap(),
            shortest: rig.min_length + margin,
            longest: rig.max_length - margin,
            safety: limits.safety(),
            rig,
        }
    }

    fn legs(&self, coordinates: &PlatformCoordinates) -> LegMotion {
        leg_motion(&Geometry::from(&self.rig), &coordinates.motion(self.rig.neutral_height))
    }

    /// Gap of three coordinates beyond their mean velocity times the step.
    fn gap(&self, now: &Motion<Vector3<f64>>, next: &Motion<Vector3<f64>>) -> Vector3<f64> {
        next.position - now.position - self.case.step * (now.velocity + next.velocity) / 2.0
    }

    /// Duration of the stop, if bounds on the whole way are enough.
    fn by_bounds(&self) -> Option<f64> {
        let (Case { now, next, step: h }, r) = (&self.case, self.radius);
        let (c, d) = ((next.linear.velocity - now.linear.velocity) / *h, self.gap(&now.linear, &next.linear));
        let (e, angle_gap) = ((next.angles.velocity - now.angles.velocity) / *h, self.gap(&now.angles, &next.angles));
        let g = 2.0 * (sum(&d) + r * sum(&angle_gap)) / (h * h);
        let speed = |state: &PlatformCoordinates| state.linear.velocity.norm() + r * sum(&state.angles.velocity);
        let fastest = most(speed(now), speed(next)) + g * h / 2.0;
        let turning = most(sum(&now.angles.velocity), sum(&next.angles.velocity));
        let curvature = fastest.powi(2) / self.shortest + turning.powi(2) * r;
        let needed = c.norm() + r * sum(&e) + g + g * h / 2.0 * (fastest / self.shortest + turning);
        let duration = self.stop_duration(speed(next));
        let time = duration / 2.0 + h;
        let legs = self.legs(next).position;
        let a = self.rig.acceleration_limit;
        let legs_comply = curvature <= 0.4 * a
            && curvature + needed <= a
            && fastest <= self.rig.velocity_limit
            && legs.iter().all(|length| length - fastest * time >= self.shortest)
            && legs.iter().all(|length| length + fastest * time <= self.longest);
        let axes_comply = (0..3).all(|k| {
            let (before, after) = (now.linear.velocity[k].abs(), next.linear.velocity[k].abs());
            let fastest = most(before, after) + d[k].abs() / h;
            c[k].abs() + 2.0 * d[k].abs() / (h * h) <= self.safety.acceleration_limit[k]
                && next.linear.acceleration[k].abs() <= self.safety.acceleration_limit[k]
                && fastest <= self.safety.velocity_limit[k]
                && next.linear.position[k].abs() + fastest * time <= self.safety.position_limit[k]
        });
        (legs_comply && axes_comply).then_some(duration)
    }

    /// Duration in which 0.6 of the legs' acceleration stops this speed of a leg, and the safety
    /// limits of acceleration stop the candidate.
    fn stop_duration(&self, speed: f64) -> f64 {
        let legs = speed / (0.6 * self.rig.acceleration_limit);
        (0..3).fold(legs, |duration, k| {
            most(duration, self.case.next.linear.velocity[k].abs() / self.safety.acceleration_limit[k])
        })
    }

    /// Durations of the stop, by bounds or by points on the way.
    fn durations(&self) -> Option<StopDurations> {
        if let Some(duration) = self.by_bounds() {
            return Some(StopDurations::common(duration));
        }
        let durations = self.stop()?;
        (self.axes_comply() && self.transition_complies() && self.stop_complies(durations)).then_some(durations)
    }

    /// The lowest and the highest position that an axis may have from a state on.
    fn reachable(&self, from: &PlatformCoordinates, k: usize) -> [f64; 2] {
        let (position, limit) = (from.linear.position[k], self.safety.position_limit[k]);
        // But for the rounding of their difference.
        let rounding = 4.0 * f64::EPSILON * most(position.abs(), limit);
        [position.min(-limit) - rounding, position.max(limit) + rounding]
    }

    /// Each axis stops in the common duration, or sooner where it has less clearance.
    fn stop(&self) -> Option<StopDurations> {
        let next = &self.case.next;
        let fastest = self.legs(next).velocity.iter().fold(0.0, |fastest, velocity| most(fastest, velocity.abs()));
        let mut durations = StopDurations::common(self.stop_duration(fastest));
        for k in 0..3 {
            let (position, velocity) = (next.linear.position[k], next.linear.velocity[k]);
            let [lowest, highest] = self.reachable(next, k);
            let clearance = if velocity > 0.0 { highest - position } else { position - lowest };
            // It stops half its speed times the duration farther on.
            if velocity.abs() * durations.linear[k] / 2.0 > clearance {
                durations.linear[k] = 2.0 * clearance / velocity.abs();
            }
            if velocity.abs() / durations.linear[k] > self.safety.acceleration_limit[k] * (1.0 + ROUNDING) {
                return None;
            }
        }
        Some(durations)
    }

    /// Surge, sway and heave keep their limits on the way to the candidate.
    fn axes_comply(&self) -> bool {
        let Case { now, next, step: h } = &self.case;
        (0..3).all(|k| {
            // The trajectory ends a gap before the candidate.
            let arrived = next.linear.position[k] - self.gap(&now.linear, &next.linear)[k];
            let gap = size(self.gap(&now.linear, &next.linear)[k]);
            let (before, after) = (now.linear.velocity[k], next.linear.velocity[k]);
            let acceleration = (after - before) / h;
            let allowed = self.safety.acceleration_limit[k] * (1.0 + ROUNDING);
            // Where the velocity changes its sign, the axis is farther out than at both ends.
            let turned = if before * after < 0.0 {
                now.linear.position[k] - before * before / (2.0 * acceleration)
            } else {
                now.linear.position[k]
            };
            let [lowest, highest] = self.reachable(now, k);
            let fastest = most(self.safety.velocity_limit[k] * (1.0 + ROUNDING), before.abs());
            acceleration.abs() + 2.0 * gap / (h * h) <= allowed
                && next.linear.acceleration[k].abs() <= allowed
                && most(before.abs(), after.abs()) + gap / h <= fastest
                && [next.linear.position[k], arrived, turned]
                    .iter()
                    .all(|position| (lowest..=highest).contains(position))
        })
    }

    /// The legs keep velocity and acceleration on the way to the candidate.
    fn transition_complies(&self) -> bool {
        let Case { now, next, step: h } = &self.case;
        // The way with a steady acceleration, which ends short of the candidate by the gap.
        let steady = |now: &Motion<Vector3<f64>>, next: &Motion<Vector3<f64>>| Motion {
            position: now.position,
            velocity: now.velocity,
            acceleration: (next.velocity - now.velocity) / *h,
        };
        let start = PlatformCoordinates {
            linear: steady(&now.linear, &next.linear),
            angles: steady(&now.angles, &next.angles),
        };
        let end = PlatformCoordinates { linear: start.linear.after(*h), angles: start.angles.after(*h) };
        let ends = [self.legs(&start), self.legs(&end)];
        let reached = self.legs(next);
        let gaps = std::array::from_fn(|i| {
            2.0 * size(reached.position[i] - ends[1].position[i]) / (h * h)
                + size(reached.velocity[i] - ends[1].velocity[i]) / h
        });
        self.interval_complies(&ends, &self.bounds(&start, &end), *h, None, gaps)
    }

    /// The legs keep stroke, velocity and acceleration until they rest.
    fn stop_complies(&self, durations: StopDurations) -> bool {
        let plan = StopPlan::new(&self.case.next, durations);
        let stops = durations.breakpoints();
        let speed = self.case.next.linear.velocity.norm() + self.radius * sum(&self.case.next.angles.velocity);
        // Enough cells for a bound of a twentieth of the acceleration limit
        // between points; 12 at most.
        let cells =
            (1.5 * speed * speed / (0.05 * self.shortest * self.rig.acceleration_limit)).ceil().clamp(1.0, 12.0);
        let mut begin = 0.0;
        for end in stops {
            let count = (cells * ((end - begin) / stops[3])).ceil() as usize;
            for k in 0..count {
                let at = |k: usize| begin + (end - begin) * k as f64 / count as f64;
                let [mut left, mut right] = [plan.at(at(k)), plan.at(at(k + 1))];
                // One acceleration for the whole piece; at its end the plan goes over to the next.
                let steady = plan.at(begin);
                for state in [&mut left, &mut right] {
                    state.linear.acceleration = steady.linear.acceleration;
                    state.angles.acceleration = steady.angles.acceleration;
                }
                let stroke = Some((self.shortest, self.longest));
                let ends = [self.legs(&left), self.legs(&right)];
                if !self.interval_complies(&ends, &self.bounds(&left, &right), at(k + 1) - at(k), stroke, [0.0; 6]) {
                    return false;
                }
            }
            begin = end;
        }
        true
    }

    /// Bounds on the joints' derivatives between two states with the same steady acceleration.
    fn bounds(&self, left: &PlatformCoordinates, right: &PlatformCoordinates) -> [f64; 3] {
        let v = most(left.linear.velocity.norm(), right.linear.velocity.norm());
        let w = most(sum(&left.angles.velocity), sum(&right.angles.velocity));
        let (s, e, r) = (left.linear.acceleration.norm(), sum(&left.angles.acceleration), self.radius);
        [v + w * r, s + (w.powi(2) + e) * r, (w.powi(3) + 3.0 * w * e) * r]
    }

    /// The legs keep their limits between two points, by the bound on their jerk.
    fn interval_complies(
        &self,
        [left, right]: &[LegMotion; 2],
        [g1, g2, g3]: &[f64; 3],
        duration: f64,
        stroke: Option<(f64, f64)>,
        gaps: [f64; 6],
    ) -> bool {
        let half = duration / 2.0;
        let shortest = left.position.iter().chain(&right.position).copied().reduce(f64::min).unwrap() - g1 * half;
        if shortest <= 0.0 {
            return false;
        }
        let product = 2.0 / (3.0 * 3.0_f64.sqrt());
        let jerk = 3.0 * g1 * (g2 + product * g1 * g1 / shortest) / shortest + g3;
        (0..6).all(|i| {
            let acceleration = most(left.acceleration[i].abs(), right.acceleration[i].abs()) + jerk * half;
            let middle =
                [left.velocity[i] + left.acceleration[i] * half, right.velocity[i] - right.acceleration[i] * half];
            let inside = most(middle[0].abs(), middle[1].abs()) + jerk * half * half;
            let velocity = most(inside, most(left.velocity[i].abs(), right.velocity[i].abs()));
            let beyond = acceleration * half * half / 2.0;
            let lengths = [left.position[i], right.position[i]];
            acceleration + gaps[i] <= self.rig.acceleration_limit
                && velocity + gaps[i] * half <= self.rig.velocity_limit
                && stroke.is_none_or(|(shortest, longest)| {
                    lengths.iter().all(|length| length - beyond >= shortest && length + beyond <= longest)
                })
        })
    }
}

/// Clearance of an axis beyond its position, as a fraction of what its stop in the
/// common duration takes.
#[derive(Clone, Copy, PartialEq)]
enum Clearance {
    Enough,
    Less,
}

/// The limits with so little clearance for one axis that it has to stop sooner than the others.
fn hurried(case: &Case, limits: &Limits, axis: usize, fraction: f64) -> Option<Limits> {
    let Motion { position, velocity, .. } = case.next.linear.axis(axis);
    let clearance = fraction * 0.5 * velocity.abs() * Conditions::new(case, limits).stop()?.angular;
    let limit = position * velocity.signum() + clearance;
    let mut limits = *limits;
    limits.0[4 + axis] = limit;
    (limit > position.abs()).then_some(limits)
}

/// Finds the edge of each limit, where the conditions change their answer, and compares both sides.
/// Returns how many edges each limit had.
fn compare(count: u32, gap: f64, by_bounds: bool, clearance: Clearance) -> [u32; LIMITS] {
    let found = std::cell::Cell::new([0; LIMITS]);
    search(count)
        .run(&(cases(gap), 0.0..0.6_f64, 0.0..0.6_f64, 0..3_usize), |(case, slower, softer, axis)| {
            let mut start = Limits::LOOSE.tightened(2, 0.1 * slower).tightened(3, 0.2 * softer);
            if clearance == Clearance::Less {
                let Some(limits) = hurried(&case, &start, axis, 0.2 + slower) else { return Ok(()) };
                start = limits;
            }
            let expected = |limits: &Limits| {
                let conditions = Conditions::new(&case, limits);
                if by_bounds { conditions.by_bounds().map(StopDurations::common) } else { conditions.durations() }
            };
            if expected(&start).is_none() {
                return Ok(());
            }
            for which in 0..LIMITS {
                let [mut passes, mut fails] = [0.0, 1.0];
                while fails - passes > 1e-15 {
                    let middle = 0.5 * (passes + fails);
                    if middle == passes || middle == fails {
                        break;
                    }
                    *(if expected(&start.tightened(which, middle)).is_some() { &mut passes } else { &mut fails }) =
                        middle;
                }
                let mut counts = found.get();
                counts[which] += 1;
                found.set(counts);
                for side in [passes - 1e-11, fails + 1e-11] {
                    let limits = start.tightened(which, side.clamp(0.0, 1.0));
                    let (expected, actual) = (expected(&limits), certified(&case, &limits, by_bounds));
                    prop_assert_eq!(
                        actual.is_some(),
                        expected.is_some(),
                        "limit {} at {:?}: {:?}",
                        which,
                        limits,
                        case
                    );
                    if let (Some(actual), Some(expected)) = (actual, expected) {
                        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b;
                        prop_assert!(close(actual.angular, expected.angular), "{:?}, not {:?}", actual, expected);
                        for k in 0..3 {
                            prop_assert!(
                                close(actual.linear[k], expected.linear[k]),
                                "{:?}, not {:?}",
                                actual,
                                expected
                            );
                        }
                    }
                }
            }
            Ok(())
        })
        .unwrap();
    found.get()
}

#[test]
fn bounds_on_the_whole_way_certify_what_their_conditions_say() {
    for gap in [0.0, 0.2] {
        let edges = compare(300, gap, true, Clearance::Enough);
        assert!(edges.iter().all(|&count| count > 50), "{edges:?}");
    }
}

#[test]
fn points_on_the_way_certify_what_their_conditions_say() {
    for gap in [0.0, 0.2] {
        let edges = compare(300, gap, false, Clearance::Enough);
        assert!(edges.iter().all(|&count| count > 50), "{edges:?}");
    }
}

#[test]
fn points_on_the_way_certify_a_stop_in_pieces_as_their_conditions_say() {
    for gap in [0.0, 0.2] {
        let edges = compare(600, gap, false, Clearance::Less);
        assert!(edges.iter().all(|&count| count > 50), "{edges:?}");
    }
}

#[test]
fn an_interval_in_which_a_leg_could_vanish_is_refused() {
    let certifier =
        Certifier::new(&Limits([1e-9, 1e9, 1e9, 1e9, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]).rig(), 1e-9);
    let legs = LegMotion { position: [1.0; 6], velocity: [0.0; 6], acceleration: [0.0; 6], transmission: 1.0 };
    let complies = |speed: f64, length: f64| {
        let bounds = JointBounds { velocity: speed, acceleration: 0.0, jerk: 0.0 };
        let legs = LegMotion { position: [length; 6], ..legs };
        certifier.interval_complies_with_leg_limits(
            &legs,
            &legs,
            &bounds,
            1.0,
            (f64::NEG_INFINITY, f64::INFINITY),
            &[0.0; 6],
        )
    };
    // In half a second, a joint at 2 m/s is where the other one may be.
    assert!(complies(1.9, 1.0) && !complies(2.0, 1.0) && !complies(3.0, 1.0) && !complies(1.9, f64::NAN));
}

#[test]
fn the_bounds_of_a_joint_are_the_written_out_ones() {
    let bounds = JointBounds::new([2.0, 3.0], [5.0, 7.0], 0.5);
    // v + W r, s + (W² + e) r, (W³ + 3 W e) r.
    assert_eq!((bounds.velocity, bounds.acceleration, bounds.jerk), (3.5, 13.0, 45.0));
    let jerk = 3.0 * 3.5 * (13.0 + 2.0 / (3.0 * 3.0_f64.sqrt()) * 3.5 * 3.5 / 1.25) / 1.25 + 45.0;
    assert!((bounds.leg_jerk(1.25) - jerk).abs() < 1e-12 * jerk);
}

#[test]
fn the_stroke_keeps_a_margin_for_what_a_leg_does_within_a_step() {
    let rig = |acceleration_limit, velocity_limit| Rig { acceleration_limit, velocity_limit, ..Rig::default() };
    // A h²/8, the farthest that a leg gets beyond both ends of a step; V h/2 if it is too slow for that.
    assert_eq!(step_margin(&rig(8.0, 1.0), 0.25), 0.0625);
    assert_eq!(step_margin(&rig(8.0, 0.25), 0.25), 0.03125);
}

#[test]
fn a_leg_pursues_its_demand_a_little_inside_the_certified_stroke() {
    let rig = Rig { min_length: 1.0, max_length: 3.0, ..Rig::default() };
    let certifier = Certifier::new(&rig, 0.0);
    let inside = certifier.pursuit_limits();
    assert!((inside.min - 1.00002).abs() < 1e-12 && (inside.max - 2.99998).abs() < 1e-12, "{inside:?}");
    let whole = braking_law::Limits { min: inside.min, max: inside.max, ..certifier.limits };
    assert_eq!(inside, whole);
}
