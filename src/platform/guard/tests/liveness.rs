//! The platform comes home, wherever a ride left it, once the input rests.

use nalgebra::Vector3;

use crate::interface::{Rig, SafetyParameters};
use crate::motion::Motion;
use crate::platform::guard::{ActuatorGuard, CertifiedStop, Deviation, REST_BEFORE_RETURN};
use crate::platform::{Geometry, PlatformCoordinates, PlatformState, Pose, leg_lengths, step_margin};

const STEP: f64 = 0.005;

/// Numbers between -1 and 1, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::new(self.next(), self.next(), self.next()) * size
    }
}

/// A small rig, about which its joints are displaced, with little clearance at neutral.
fn small_rig(numbers: &mut Numbers) -> Rig {
    let size = 0.4 + 0.1 * numbers.next();
    let mut rig = Rig::default();
    for joint in rig.base.iter_mut().chain(&mut rig.platform) {
        *joint = (*joint + numbers.vector(0.1)) * size;
    }
    rig.neutral_height *= size;
    let lengths = leg_lengths(&Geometry::from(&rig), &Pose::neutral(&rig));
    let least = lengths.into_iter().fold(f64::INFINITY, f64::min);
    let most = lengths.into_iter().fold(0.0, f64::max);
    // At neutral, the legs are near one end of the stroke, or near both.
    let clearance = [0.017, 0.3 * size];
    let [below, above] = [[0, 1], [1, 0], [0, 0]][((numbers.next() + 1.0) * 1.5) as usize].map(|k: usize| clearance[k]);
    rig.min_length = least - below;
    rig.max_length = most + above;
    rig.acceleration_limit = 8.3;
    rig.velocity_limit = 0.5;
    rig
}

fn distance(coordinates: &PlatformCoordinates) -> f64 {
    coordinates.linear.position.amax().max(coordinates.angles.position.amax())
}

/// A ride of jumps, and then rest at neutral. Returns the distance from neutral after `rest`
/// seconds.
fn distance_left(seed: u64, rest: f64) -> f64 {
    let mut numbers = Numbers(seed);
    for _ in 0..4 {
        numbers.next();
    }
    let rig = small_rig(&mut numbers);
    let safety =
        SafetyParameters { position_limit: numbers.vector(0.05).abs().add_scalar(0.03), ..SafetyParameters::default() };
    let mut guard = ActuatorGuard::new(&rig, STEP);
    let mut advance = |demand: &PlatformCoordinates, resting: bool, seconds: f64| {
        let demand = guard.state(*demand);
        for _ in 0..(seconds / STEP) as usize {
            guard.advance(&demand, &safety, resting, STEP);
            if resting && distance(&guard.commanded.coordinates) < 1e-6 {
                break;
            }
        }
        distance(&guard.commanded.coordinates)
    };
    for _ in 0..6 {
        let at_rest = |position| Motion { position, ..Motion::default() };
        let demand = PlatformCoordinates { linear: at_rest(numbers.vector(0.3)), angles: at_rest(numbers.vector(0.6)) };
        advance(&demand, false, 1.5);
    }
    advance(&PlatformCoordinates::default(), true, rest)
}

#[test]
fn a_platform_comes_home_from_any_corner_of_its_workspace() {
    let mut left = Vec::new();
    for seed in 0..crate::cases::cases(400, 100) {
        let distance = distance_left(seed, 60.0);
        if distance > 1e-6 {
            left.push((seed, distance));
        }
    }
    assert!(left.is_empty(), "{} not at home: {left:?}", left.len());
}

/// A guard at rest with a leg at the end of its certified stroke and sway at its limit.
fn at_a_corner(seed: u64) -> Option<(ActuatorGuard, SafetyParameters)> {
    let mut numbers = Numbers(seed);
    for _ in 0..4 {
        numbers.next();
    }
    let mut rig = small_rig(&mut numbers);
    let at_rest = |position| Motion { position, ..Motion::default() };
    let rest = PlatformCoordinates { linear: at_rest(numbers.vector(0.25)), angles: at_rest(numbers.vector(0.4)) };
    let geometry = Geometry::from(&rig);
    let now = PlatformState::new(rest, &geometry, rig.neutral_height);
    let legs = now.legs;
    let shortest = legs.position.into_iter().fold(f64::INFINITY, f64::min);
    let neutral = leg_lengths(&geometry, &Pose::neutral(&rig)).into_iter().fold(f64::INFINITY, f64::min);
    rig.min_length = shortest - step_margin(&rig, STEP);
    rig.max_length = rig.max_length.max(legs.position.into_iter().fold(0.0, f64::max) + 0.05);
    let mut safety = SafetyParameters::default();
    safety.position_limit.y = rest.linear.position.y.abs();
    let mut guard = ActuatorGuard::new(&rig, STEP);
    guard.commanded = now;
    guard.plan = CertifiedStop::Straight(0.0);
    guard.deviation = Some(Deviation {
        demand: PlatformCoordinates::default(),
        leg_accelerations: [0.0; 6],
        rest_while_limited: 0.0,
        homing_fraction: None,
    });
    (neutral - shortest > 0.017 && guard.certifier.has_way_home(&rest)).then_some((guard, safety))
}

#[test]
fn a_platform_leaves_a_corner_where_every_pursuit_of_neutral_is_refused() {
    let demand = PlatformCoordinates::default();
    let mut frozen = 0;
    for (mut guard, safety) in (0..20_000).filter_map(at_a_corner) {
        let demand = guard.state(demand);
        let start = guard.commanded().coordinates.linear.position;
        let mut advance = |seconds: f64| {
            for _ in 0..(seconds / STEP) as usize {
                guard.advance(&demand, &safety, true, STEP);
            }
            guard.commanded().coordinates.linear.position
        };
        if advance(STEP) != start || advance(0.5 * REST_BEFORE_RETURN) != start {
            continue;
        }
        frozen += 1;
        advance(60.0);
        let left = distance(&guard.commanded.coordinates);
        assert!(left < 1e-6, "{left} from neutral");
    }
    assert!(frozen > 0);
}
