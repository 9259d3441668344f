//! Closest approach of the legs to each other within the platform's reach.
//!
//! A leg is the straight segment between its joints. The distance of two segments is exact at each
//! pose. The poses are those of a grid of leg lengths, and from the closest of them a pattern
//! search goes on to a smallest distance.
//!
//! Two legs may share a joint, where such legs meet. Their closest approach is therefore
//! taken beyond a few diameters from it: legs at a wide angle pass, and legs that fold
//! onto each other touch.

use std::array;
use std::fmt;

use moris_washout::Rig;
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::numbering::{NUMBERING_ADVICE, is_opposite};
use moris_washout::platform::{Geometry, Pose, forward_kinematics, jacobian};

use crate::sentence;

/// Lengths tried for each leg, evenly from the shortest to the longest.
const LENGTH_LEVELS: usize = 4;

/// Two legs where they are closest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// The legs, counted from 0.
    pub legs: [usize; 2],
    /// Between their axes \[m\].
    pub distance: f64,
    /// The closest points of the two axes in the base frame \[m\].
    pub points: [Vector3<f64>; 2],
    /// Pose of the platform.
    pub pose: Pose,
}

/// Least distances between the legs.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearance {
    /// The closest approach of each pair of legs, the closest pair first.
    pub approaches: Vec<Approach>,
    /// Diameter of a leg \[m\].
    pub diameter: f64,
    /// True if the rig file gives the diameter.
    is_given: bool,
    /// True if the joints of the base and the platform are numbered in opposite directions.
    is_opposite: bool,
    /// True for the rods of cranks.
    has_cranks: bool,
}

impl Clearance {
    /// Clearance of a rig with legs, or rods of cranks, of this diameter \[m\].
    pub fn of(rig: &Rig, diameter: Option<f64>) -> Self {
        // Diameter of a leg of which none is given [m]: thinner than actuators of this size are. Of
        // a rod as a part of its length.
        const ASSUMED_DIAMETER: f64 = 0.05;
        const ASSUMED_ROD_PART: f64 = 0.03;
        let has_cranks = rig.has_cranks();
        let assumed =
            if has_cranks { ASSUMED_DIAMETER.min(ASSUMED_ROD_PART * rig.crank_rod) } else { ASSUMED_DIAMETER };
        let is_given = diameter.is_some();
        let diameter = diameter.unwrap_or(assumed);
        let is_opposite = is_opposite(rig);
        Clearance { approaches: approaches(rig, diameter), diameter, is_given, is_opposite, has_cranks }
    }

    /// True if legs whose axes are this close touch each other \[m\].
    pub fn collides(&self, distance: f64) -> bool {
        distance < self.diameter
    }

    /// The pairs of legs that touch each other somewhere, the closest first.
    pub fn collisions(&self) -> impl Iterator<Item = &Approach> {
        self.approaches.iter().filter(|approach| self.collides(approach.distance))
    }

    /// Where the diameter comes from, as the end of a sentence.
    pub fn source(&self) -> &'static str {
        match (self.is_given, self.has_cranks) {
            (true, _) => "",
            (_, true) => " (assumed; crank.diameter in the rig file gives it)",
            _ => " (assumed; actuator.diameter in the rig file gives it)",
        }
    }
}

impl fmt::Display for Clearance {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [kind, title, capital] = if self.has_cranks { ["rods", "Rods", "RODS"] } else { ["legs", "Legs", "LEGS"] };
        let line = |approach: &Approach| {
            let [first, second] = approach.legs.map(|leg| leg + 1);
            format!("{kind} {first} and {second} come within {:.3} m of each other", approach.distance)
        };
        let diameter = format!("taken as {:.3} m thick{}", self.diameter, self.source());
        if self.collisions().next().is_none() {
            let closest = line(&self.approaches[0]);
            return f.write_str(&sentence!["legs-apart", kind, closest, diameter]);
        }
        writeln!(f, "{capital} COLLIDE within their stroke, axis to axis:")?;
        self.collisions().try_for_each(|approach| writeln!(f, "  {}", line(approach)))?;
        writeln!(f, "  {title} are {diameter}.")?;
        writeln!(f, "  Choose other joints: those of two {kind} may be exchanged, or too close together.")?;
        if self.is_opposite { writeln!(f, "  {NUMBERING_ADVICE}.") } else { Ok(()) }
    }
}

/// The closest approach of each pair of legs of this diameter \[m\], the closest pair first.
pub fn approaches(rig: &Rig, diameter: f64) -> Vec<Approach> {
    // Part of a leg next to a shared joint that may be within the other leg [diameters].
    const SHARED_JOINT_CLEARANCE: f64 = 3.0;
    let geometry = Geometry::from(rig);
    let neutral = Pose::neutral(rig);
    let sign = jacobian(&geometry, &neutral).determinant().signum();
    let reach = Reach { rig, geometry: &geometry, neutral, sign, free: SHARED_JOINT_CLEARANCE * diameter };
    let grid: Vec<([f64; 6], Pose)> = (0..LENGTH_LEVELS.pow(6))
        .filter_map(|index| {
            let lengths =
                array::from_fn(|leg| reach.level_length(index / LENGTH_LEVELS.pow(leg as u32) % LENGTH_LEVELS));
            Some((lengths, reach.pose(&lengths, &neutral)?))
        })
        .collect();
    let pairs: Vec<[usize; 2]> = (0..6).flat_map(|a| (a + 1..6).map(move |b| [a, b])).collect();
    let mut found: Vec<Approach> = pairs.into_iter().map(|legs| reach.closest(legs, &grid)).collect();
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found
}

/// The poses with all legs inside their stroke.
struct Reach<'a> {
    rig: &'a Rig,
    geometry: &'a Geometry,
    neutral: Pose,
    /// Sign of the Jacobian's determinant at neutral. The other sign is that of a mirror image.
    sign: f64,
    /// Length of a leg next to a shared joint that is left out \[m\].
    free: f64,
}

impl Reach<'_> {
    fn stroke(&self) -> f64 {
        self.rig.stroke_length()
    }

    fn level_length(&self, level: usize) -> f64 {
        self.rig.stroke()[0] + self.stroke() * level as f64 / (LENGTH_LEVELS - 1) as f64
    }

    /// The pose with these lengths of the legs; none if it is not found.
    fn pose(&self, lengths: &[f64; 6], guess: &Pose) -> Option<Pose> {
        let pose = forward_kinematics(self.geometry, lengths, guess).ok()?;
        (jacobian(self.geometry, &pose).determinant().signum() == self.sign).then_some(pose)
    }

    fn approach(&self, legs: [usize; 2], pose: &Pose) -> Approach {
        // Two joints closer than this are one that two legs share [m].
        const SHARED_JOINT_DISTANCE: f64 = 1e-3;
        // Cranks have rods from the ends of their arms.
        let ends = self.geometry.rods(pose).base;
        let segment = |leg: usize| {
            let end = pose.position + pose.orientation.rotation * self.rig.platform[leg];
            [ends.joint(leg), end]
        };
        let [a, b] = legs.map(segment);
        // A leg has its free parts at most up to its middle.
        let is_shared = |joints: &[Vector3<f64>; 6]| (joints[legs[0]] - joints[legs[1]]).norm() < SHARED_JOINT_DISTANCE;
        let bases = array::from_fn(|leg| ends.joint(leg));
        let [at_base, at_platform] = [&bases, &self.rig.platform].map(is_shared);
        let beyond = |[from, to]: [Vector3<f64>; 2]| {
            let free = (to - from) * (self.free / (to - from).norm().max(2.0 * self.free));
            [if at_base { from + free } else { from }, if at_platform { to - free } else { to }]
        };
        let points = closest_points(&beyond(a), &beyond(b));
        Approach { legs, distance: (points[0] - points[1]).norm(), points, pose: *pose }
    }

    /// The smallest distance, from the grid's closest pose on, leg length by leg length.
    fn closest(&self, legs: [usize; 2], grid: &[([f64; 6], Pose)]) -> Approach {
        // Step at which the search for the smallest distance ends, as a fraction of the stroke.
        const MIN_SEARCH_STEP: f64 = 1e-3;
        let mut best = self.approach(legs, &self.neutral);
        let mut lengths = moris_washout::platform::leg_lengths(self.geometry, &self.neutral);
        for (candidate, pose) in grid {
            let approach = self.approach(legs, pose);
            if approach.distance < best.distance {
                (best, lengths) = (approach, *candidate);
            }
        }
        let mut step = 0.5 * self.stroke() / (LENGTH_LEVELS - 1) as f64;
        while step > MIN_SEARCH_STEP * self.stroke() {
            let moves = (0..12).filter_map(|index| {
                let mut moved = lengths;
                let signed = if index % 2 == 0 { step } else { -step };
                let [start, end] = self.rig.stroke();
                moved[index / 2] = (moved[index / 2] + signed).clamp(start, end);
                Some((moved, self.approach(legs, &self.pose(&moved, &best.pose)?)))
            });
            match moves.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance)) {
                Some((moved, approach)) if approach.distance < best.distance => (lengths, best) = (moved, approach),
                _ => step *= 0.5,
            }
        }
        best
    }
}

/// The points of two segments that are closest to each other.
///
/// On the lines, the squared distance is a quadratic function of both parameters. Its smallest
/// value over the unit square is inside or on an edge, where one of the points is an end.
pub fn closest_points(a: &[Vector3<f64>; 2], b: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let (uu, uv, vv, uw, vw) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let along = |numerator: f64, square: f64| if square > 0.0 { (numerator / square).clamp(0.0, 1.0) } else { 0.0 };
    // Closest to a point of one segment on the other.
    let on_a = |t: f64| along(uw + t * uv, uu);
    let on_b = |s: f64| along(s * uv - vw, vv);
    let edges = [(0.0, on_b(0.0)), (1.0, on_b(1.0)), (on_a(0.0), 0.0), (on_a(1.0), 1.0)];
    let determinant = uu * vv - uv * uv;
    let inside = (determinant > 0.0).then(|| [(vv * uw - uv * vw) / determinant, (uv * uw - uu * vw) / determinant]);
    let inside = inside.filter(|point| point.iter().all(|value| (0.0..=1.0).contains(value))).map(|[s, t]| (s, t));
    let points = |(s, t): (f64, f64)| [a[0] + s * u, b[0] + t * v];
    let candidates = edges.into_iter().chain(inside).map(points);
    let distance = |[p, q]: &[Vector3<f64>; 2]| (p - q).norm_squared();
    candidates.min_by(|p, q| distance(p).total_cmp(&distance(q))).unwrap_or([a[0], b[0]])
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// A number from 0 to 1.
    fn unit(random: &mut ChaCha8Rng) -> f64 {
        f64::from(random.next_u32()) / f64::from(u32::MAX)
    }

    /// A fine net of points on both segments has nothing closer, and comes as
    /// near as its mesh allows.
    #[test]
    fn no_points_of_two_segments_are_closer() {
        const N: u32 = 200;
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut point = || Vector3::from_fn(|_, _| 2.0 * unit(&mut random) - 1.0);
        for _ in 0..200 {
            let (a, b) = ([point(), point()], [point(), point()]);
            let [p, q] = closest_points(&a, &b);
            let at = |segment: &[Vector3<f64>; 2], k: u32| {
                segment[0] + f64::from(k) / f64::from(N) * (segment[1] - segment[0])
            };
            let net = (0..=N).flat_map(|i| (0..=N).map(move |j| (i, j)));
            let least = net.map(|(i, j)| (at(&a, i) - at(&b, j)).norm()).fold(f64::INFINITY, f64::min);
            let mesh = ((a[1] - a[0]).norm() + (b[1] - b[0]).norm()) / f64::from(N);
            let found = (p - q).norm();
            assert!(found <= least + 1e-12 && least <= found + mesh, "{found} {least} {a:?} {b:?}");
        }
    }

    #[test]
    fn segments_that_cross_touch_or_are_parallel_have_their_distance() {
        let v = |x: f64, y: f64, z: f64| Vector3::new(x, y, z);
        let distance = |a: [Vector3<f64>; 2], b: [Vector3<f64>; 2]| {
            let [p, q] = closest_points(&a, &b);
            (p - q).norm()
        };
        let along_x = [v(-1.0, 0.0, 0.0), v(1.0, 0.0, 0.0)];
        assert!(distance(along_x, [v(0.3, -1.0, 0.0), v(0.2, 1.0, 0.0)]) < 1e-12);
        assert!((distance(along_x, [v(0.0, 0.0, 0.2), v(0.5, 0.0, 0.2)]) - 0.2).abs() < 1e-12);
        assert!((distance(along_x, [v(1.3, 0.0, 0.4), v(2.0, 0.0, 0.4)]) - 0.5).abs() < 1e-12);
        assert!((distance([v(0.0, 0.0, 0.0); 2], [v(3.0, 4.0, 0.0); 2]) - 5.0).abs() < 1e-12);
    }

    /// Random poses within the stroke have no legs closer than the search has found.
    #[test]
    fn no_random_pose_of_the_default_rig_brings_legs_closer() {
        let rig = Rig::default();
        let geometry = Geometry::from(&rig);
        let neutral = Pose::neutral(&rig);
        let found = approaches(&rig, 0.05);
        assert_eq!(found.len(), 15);
        let reach = Reach {
            rig: &rig,
            geometry: &geometry,
            neutral,
            sign: jacobian(&geometry, &neutral).determinant().signum(),
            free: 0.15,
        };
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut poses = 0;
        for _ in 0..3000 {
            let lengths = array::from_fn(|_| 1.0 + 0.6 * unit(&mut random));
            let Some(pose) = reach.pose(&lengths, &neutral) else { continue };
            poses += 1;
            for approach in &found {
                let distance = reach.approach(approach.legs, &pose).distance;
                assert!(distance >= approach.distance - 1e-3, "{:?}: {distance} at {lengths:?}", approach.legs);
            }
        }
        assert!(poses > 2900, "{poses}");
        // Joints 0.237 m apart are the closest that legs come.
        assert!((0.1..0.24).contains(&found[0].distance), "{:?}", found[0]);
    }

    #[test]
    fn two_joints_exchanged_let_their_legs_cross() {
        let mut rig = Rig::default();
        rig.platform.swap(0, 1);
        let closest = approaches(&rig, 0.05)[0];
        assert_eq!((closest.legs, closest.distance < 1e-3), ([0, 1], true), "{closest:?}");
    }

    /// Joints in pairs: six on the base and three on the platform, or three and three.
    fn on_shared_joints(base: bool) -> Rig {
        let around = |radius: f64, degrees: [f64; 6]| {
            degrees.map(|angle: f64| radius * Vector3::new(angle.to_radians().cos(), angle.to_radians().sin(), 0.0))
        };
        let platform = around(0.6, [-60.0, 60.0, 60.0, 180.0, 180.0, 300.0]);
        let base = around(
            1.0,
            if base { [0.0, 0.0, 120.0, 120.0, 240.0, 240.0] } else { [-8.0, 8.0, 112.0, 128.0, 232.0, 248.0] },
        );
        let rig = Rig { base, platform, ..Rig::default() };
        let lengths = moris_washout::platform::leg_lengths(&Geometry::from(&rig), &Pose::neutral(&rig));
        Rig { min_length: lengths[0] - 0.15, max_length: lengths[0] + 0.15, ..rig }
    }

    #[test]
    fn legs_on_one_joint_do_not_collide_where_they_meet() {
        for rig in [on_shared_joints(true), on_shared_joints(false)] {
            let clearance = Clearance::of(&rig, None);
            assert_eq!(clearance.collisions().next(), None, "{clearance}");
        }
        // Legs that fold onto each other touch beyond the joint, too.
        let mut narrow = on_shared_joints(false);
        narrow.base[1] = narrow.base[2] + Vector3::new(0.04, 0.0, 0.0);
        let clearance = Clearance::of(&narrow, None);
        assert_eq!(clearance.collisions().next().map(|approach| approach.legs), Some([1, 2]), "{clearance}");
    }

    #[test]
    fn legs_that_share_both_joints_collide() {
        let mut rig = on_shared_joints(true);
        rig.platform[1] = rig.platform[0];
        let clearance = Clearance::of(&rig, None);
        assert!(clearance.collisions().any(|approach| approach.legs == [0, 1]), "{clearance}");
    }

    #[test]
    fn joints_numbered_in_opposite_directions_are_named() {
        let rig = Rig::default();
        let reversed = Rig { platform: array::from_fn(|leg| rig.platform[(7 - leg) % 6]), ..rig };
        let text = Clearance::of(&reversed, None).to_string();
        assert!(text.contains("LEGS COLLIDE") && text.contains("numbered one way round"), "{text}");
    }
}
