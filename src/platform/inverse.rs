//! Inverse kinematics: L_i = |v_p + R a_i - b_i| and its derivatives; those of cranks are in
//! [`Cranks`](super::Cranks).

use serde::{Deserialize, Serialize};

use super::{Geometry, PlatformMotion, Pose};
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;

/// The six actuators: position \[m\] and rate \[m/s\]. A leg's position is its length; a crank's is
/// the arc of the arm's end from its heading, positive up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Legs {
    pub position: [f64; 6],
    pub velocity: [f64; 6],
}

impl Legs {
    /// The least and the greatest position \[m\], of positions that are numbers.
    #[inline(always)]
    pub fn extremes(&self) -> [f64; 2] {
        let [a, b, c, d, e, f] = self.position;
        [min(min(min(a, c), e), min(min(b, d), f)), max(max(max(a, c), e), max(max(b, d), f))]
    }
}

/// A leg shorter than this has no direction; no rig that is accepted comes near it \[m\].
const MIN_LEG_LENGTH: f64 = 1e-9;

/// Positions and rates of the actuators for a motion of the platform.
///
/// ```
/// use moris_washout::Rig;
/// use moris_washout::nalgebra::Vector3;
/// use moris_washout::platform::{Geometry, PlatformMotion, Pose, inverse_kinematics};
///
/// let rig = Rig::default();
/// // The platform rises through neutral at 0.1 m/s; all legs lengthen alike.
/// let rising = PlatformMotion {
///     velocity: Vector3::new(0.0, 0.0, 0.1),
///     ..PlatformMotion::at_rest(Pose::neutral(&rig))
/// };
/// let legs = inverse_kinematics(&Geometry::from(&rig), &rising);
/// assert!(legs.velocity.iter().all(|rate| (rate - legs.velocity[0]).abs() < 1e-3 && *rate > 0.05));
/// ```
#[inline(always)]
pub fn inverse_kinematics(geometry: &Geometry, motion: &PlatformMotion) -> Legs {
    match &geometry.cranks {
        None => joint_distances(geometry, motion),
        Some(cranks) => cranks.inverse(geometry, motion),
    }
}

/// Distances of the joints as positions, and their rates, whether legs or cranks are between them.
#[inline(always)]
pub(crate) fn joint_distances(geometry: &Geometry, motion: &PlatformMotion) -> Legs {
    let Geometry { base, platform, .. } = geometry;
    let arm = platform.turned(&motion.orientation.rotation);
    let (p, v, w) = (motion.position, motion.velocity, motion.angular_velocity);
    let mut legs = Legs::default();
    // Written out and not in vectors, so that the processor does two legs at a time.
    for i in 0..6 {
        let (x, y, z) = (p.x + arm.x[i] - base.x[i], p.y + arm.y[i] - base.y[i], p.z + arm.z[i] - base.z[i]);
        let along = x * (v.x + (w.y * arm.z[i] - w.z * arm.y[i]))
            + y * (v.y + (w.z * arm.x[i] - w.x * arm.z[i]))
            + z * (v.z + (w.x * arm.y[i] - w.y * arm.x[i]));
        let length = square_root(x * x + y * y + z * z);
        legs.position[i] = length;
        legs.velocity[i] = along / length.max(MIN_LEG_LENGTH);
    }
    legs
}

/// As [`Legs`], with accelerations \[m/s2\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LegMotion {
    pub position: [f64; 6],
    pub velocity: [f64; 6],
    pub acceleration: [f64; 6],
    /// The smallest transmission of the cranks; 1 with legs.
    pub transmission: f64,
}

/// Positions, rates and accelerations of the actuators for a motion of the platform.
#[inline]
pub fn leg_motion(geometry: &Geometry, motion: &PlatformMotion) -> LegMotion {
    let Geometry { base, platform, cranks } = geometry;
    if let Some(cranks) = cranks {
        return cranks.motion(geometry, motion);
    }
    let arm = platform.turned(&motion.orientation.rotation);
    let PlatformMotion { position: p, velocity: v, acceleration: a, .. } = motion;
    let (w, turn) = (motion.angular_velocity, motion.angular_acceleration);
    let mut legs = LegMotion { transmission: 1.0, ..LegMotion::default() };
    // Written out and not in vectors, so that the processor does two legs at a time.
    for i in 0..6 {
        let (ax, ay, az) = (arm.x[i], arm.y[i], arm.z[i]);
        let (x, y, z) = (p.x + ax - base.x[i], p.y + ay - base.y[i], p.z + az - base.z[i]);
        let length = square_root(x * x + y * y + z * z).max(MIN_LEG_LENGTH);
        let (nx, ny, nz) = (x / length, y / length, z / length);
        // The joint's velocity and acceleration as the platform turns about its origin.
        let (tx, ty, tz) = (w.y * az - w.z * ay, w.z * ax - w.x * az, w.x * ay - w.y * ax);
        let (vx, vy, vz) = (v.x + tx, v.y + ty, v.z + tz);
        let bx = a.x + (turn.y * az - turn.z * ay) + (w.y * tz - w.z * ty);
        let by = a.y + (turn.z * ax - turn.x * az) + (w.z * tx - w.x * tz);
        let bz = a.z + (turn.x * ay - turn.y * ax) + (w.x * ty - w.y * tx);
        let rate = nx * vx + ny * vy + nz * vz;
        legs.position[i] = length;
        legs.velocity[i] = rate;
        // The part of the joint's velocity across the leg turns it, which lengthens it as well.
        let turning = (vx * vx + vy * vy + vz * vz - rate * rate) / length;
        legs.acceleration[i] = nx * bx + ny * by + nz * bz + turning;
    }
    legs
}

/// Accelerations of the actuators \[m/s2\] for a motion of the platform.
///
/// ```
/// use moris_washout::Rig;
/// use moris_washout::nalgebra::Vector3;
/// use moris_washout::platform::{Geometry, PlatformMotion, Pose, leg_accelerations};
///
/// let rig = Rig::default();
/// // The platform yaws through neutral at a constant rate: the joints' centripetal acceleration and
/// // the legs' turning lengthen the legs.
/// let yawing = PlatformMotion {
///     angular_velocity: Vector3::new(0.0, 0.0, 0.5),
///     ..PlatformMotion::at_rest(Pose::neutral(&rig))
/// };
/// assert!(leg_accelerations(&Geometry::from(&rig), &yawing).iter().all(|of_a_leg| *of_a_leg > 0.0));
/// ```
pub fn leg_accelerations(geometry: &Geometry, motion: &PlatformMotion) -> [f64; 6] {
    leg_motion(geometry, motion).acceleration
}

/// Lengths of the legs, or arcs of the cranks, in a pose \[m\].
///
/// ```
/// use moris_washout::Rig;
/// use moris_washout::platform::{Geometry, Pose, leg_lengths};
///
/// let rig = Rig::default();
/// let lengths = leg_lengths(&Geometry::from(&rig), &Pose::neutral(&rig));
/// assert!(lengths.iter().all(|length| (length - 1.3).abs() < 1e-3));
/// ```
pub fn leg_lengths(geometry: &Geometry, pose: &Pose) -> [f64; 6] {
    match &geometry.cranks {
        None => core::array::from_fn(|i| geometry.between(i, pose).norm()),
        Some(cranks) => cranks.arcs(&cranks.arms_in(geometry, pose)),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::interface::Rig;
    use crate::motion::Motion;
    use crate::platform::PlatformCoordinates;

    /// Coordinates that move with a steady acceleration, at `time`.
    fn moving(time: f64) -> PlatformCoordinates {
        let steady = |position: [f64; 3], velocity: [f64; 3], acceleration: [f64; 3]| {
            let [position, velocity, acceleration] = [position, velocity, acceleration].map(Vector3::from);
            Motion { position, velocity, acceleration }.after(time)
        };
        PlatformCoordinates {
            linear: steady([0.08, -0.05, 0.03], [0.3, 0.2, -0.4], [1.0, -2.0, 1.5]),
            angles: steady([0.1, -0.2, 0.15], [0.5, -0.7, 0.6], [-1.0, 2.0, 1.2]),
        }
    }

    #[test]
    fn rates_and_accelerations_are_the_derivatives_of_the_lengths() {
        let mut rig = Rig::default();
        for i in 0..6 {
            // No two joints at the same height, and none on a circle.
            rig.base[i] += Vector3::new(0.02, -0.01, 0.03) * i as f64;
            rig.platform[i] += Vector3::new(-0.01, 0.02, -0.025) * i as f64;
        }
        let geometry = Geometry::from(&rig);
        let motion = |time: f64| moving(time).motion(rig.neutral_height);
        let lengths = |time: f64| leg_lengths(&geometry, &motion(time).pose());
        const H: f64 = 1e-4;
        for time in [-0.2, 0.0, 0.3] {
            let legs = inverse_kinematics(&geometry, &motion(time));
            let all = leg_motion(&geometry, &motion(time));
            let [before, now, after] = [time - H, time, time + H].map(lengths);
            for i in 0..6 {
                let rate = (after[i] - before[i]) / (2.0 * H);
                let acceleration = (after[i] - 2.0 * now[i] + before[i]) / (H * H);
                for length in [legs.position[i], all.position[i]] {
                    assert!((length - now[i]).abs() < 1e-15, "leg {i}: {length} m, not {} m", now[i]);
                }
                for velocity in [legs.velocity[i], all.velocity[i]] {
                    assert!((velocity - rate).abs() < 1e-7, "leg {i}: {velocity} m/s, not {rate} m/s");
                }
                let found = all.acceleration[i];
                assert!((found - acceleration).abs() < 1e-6, "leg {i}: {found} m/s², not {acceleration} m/s²");
            }
            assert_eq!(leg_accelerations(&geometry, &motion(time)), all.acceleration);
        }
    }
}
