//! Forward kinematics: from leg lengths or arcs of cranks to the pose, by Newton's
//! method from a pose nearby.

use nalgebra::{Vector3, Vector6};

use super::{Geometry, Legs, PlatformMotion, Pose, jacobian, leg_accelerations, leg_lengths};
use crate::motion::orientation::{Orientation, RollPitchYaw};

/// Newton's method is given up after this many iterations. From a pose one step away
/// it takes two or three.
pub const MAX_ITERATIONS: usize = 20;

/// Legs that fit their lengths to this are found \[m\].
const LENGTH_TOLERANCE: f64 = 1e-13;
/// Accepted residual where rounding keeps Newton's method from [`LENGTH_TOLERANCE`] \[m\].
const ROUNDING_TOLERANCE: f64 = 1e-10;

/// Newton's method did not find a pose with these leg lengths; they belong to none, or the platform
/// is near a singularity.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("no pose found for these leg lengths: off by {residual} m after {MAX_ITERATIONS} iterations")]
pub struct NotConverged {
    /// The largest difference from the lengths asked for, in the last pose tried \[m\].
    pub residual: f64,
}

/// The pose in which the legs have these lengths \[m\], on the branch of the pose
/// `guess`. With cranks they are the arcs of the arms; the rods from the arms' ends are
/// then legs of a fixed length.
///
/// ```
/// use moris_washout::Rig;
/// use moris_washout::platform::{Geometry, Pose, forward_kinematics};
///
/// let rig = Rig::default();
/// let (geometry, neutral) = (Geometry::from(&rig), Pose::neutral(&rig));
/// // All legs as long as they can be: the platform is at its highest, and level.
/// let highest = forward_kinematics(&geometry, &[rig.max_length; 6], &neutral)?;
/// assert!(highest.position.z > neutral.position.z + 0.3);
/// assert!(highest.orientation.angles.roll.abs() < 1e-9);
/// // No pose has a leg of 10 m beside five of 1.3 m.
/// assert!(forward_kinematics(&geometry, &[10.0, 1.3, 1.3, 1.3, 1.3, 1.3], &neutral).is_err());
/// # Ok::<(), moris_washout::platform::NotConverged>(())
/// ```
///
/// # Errors
/// If Newton's method does not converge within [`MAX_ITERATIONS`].
pub fn forward_kinematics(geometry: &Geometry, lengths: &[f64; 6], guess: &Pose) -> Result<Pose, NotConverged> {
    if let Some(cranks) = &geometry.cranks {
        return forward_kinematics(&cranks.rods(geometry, lengths), &[cranks.rod; 6], guess);
    }
    let target = Vector6::from(*lengths);
    let mut pose = *guess;
    let mut residual = f64::INFINITY;
    for _ in 0..MAX_ITERATIONS {
        let error = target - Vector6::from(leg_lengths(geometry, &pose));
        let previous = residual;
        residual = error.amax();
        let stalled = residual >= 0.5 * previous;
        if residual <= LENGTH_TOLERANCE || (stalled && residual <= ROUNDING_TOLERANCE) {
            return Ok(pose);
        }
        let Some(twist) = jacobian(geometry, &pose).lu().solve(&error) else { break };
        pose = pose_after_twist(&pose, &twist);
    }
    Err(NotConverged { residual })
}

/// The largest change of an angle in one iteration \[rad\] and of the position \[m\]: keeps a bad
/// guess from jumping to another branch.
const LARGEST_CHANGE: f64 = 0.3;

/// The pose moved by a small twist: a translation, and a rotation, which eq. (10) turns into
/// changes of the angles.
fn pose_after_twist(pose: &Pose, twist: &Vector6<f64>) -> Pose {
    let angles = pose.orientation.changes(twist.fixed_rows::<3>(3).into()).to_vector();
    let position: Vector3<f64> = twist.fixed_rows::<3>(0).into();
    let fraction = (LARGEST_CHANGE / position.amax().max(angles.amax())).min(1.0);
    Pose {
        position: pose.position + fraction * position,
        orientation: Orientation::new(RollPitchYaw::from_vector(
            pose.orientation.angles.to_vector() + fraction * angles,
        )),
    }
}

/// The platform's motion from the legs' motion, `accelerations` of their lengths included: pose by
/// [`forward_kinematics`] from `guess`, velocities and accelerations by the Jacobian.
///
/// ```
/// use moris_washout::Rig;
/// use moris_washout::nalgebra::Vector3;
/// use moris_washout::platform::{
///     Geometry, PlatformMotion, Pose, inverse_kinematics, leg_accelerations, motion_of_legs,
/// };
///
/// let rig = Rig::default();
/// let (geometry, neutral) = (Geometry::from(&rig), Pose::neutral(&rig));
/// let surging = PlatformMotion {
///     velocity: Vector3::new(0.4, 0.0, 0.0),
///     acceleration: Vector3::new(-2.0, 0.0, 0.0),
///     ..PlatformMotion::at_rest(neutral)
/// };
/// let legs = inverse_kinematics(&geometry, &surging);
/// let found = motion_of_legs(&geometry, &legs, &leg_accelerations(&geometry, &surging), &neutral)?;
/// assert!((found.velocity - surging.velocity).norm() < 1e-9);
/// assert!((found.acceleration - surging.acceleration).norm() < 1e-9);
/// # Ok::<(), moris_washout::platform::NotConverged>(())
/// ```
///
/// # Errors
/// As [`forward_kinematics`].
pub fn motion_of_legs(
    geometry: &Geometry,
    legs: &Legs,
    accelerations: &[f64; 6],
    guess: &Pose,
) -> Result<PlatformMotion, NotConverged> {
    let pose = forward_kinematics(geometry, &legs.position, guess)?;
    let lu = jacobian(geometry, &pose).lu();
    let solve = |rates: &[f64; 6]| lu.solve(&Vector6::from(*rates)).unwrap_or_else(Vector6::zeros);
    let velocity = solve(&legs.velocity);
    let mut motion = PlatformMotion {
        velocity: velocity.fixed_rows::<3>(0).into(),
        angular_velocity: velocity.fixed_rows::<3>(3).into(),
        ..PlatformMotion::at_rest(pose)
    };
    // The legs' accelerations are J (p'', alpha) plus what they are while (p'', alpha) is zero.
    let without = leg_accelerations(geometry, &motion);
    let acceleration = solve(&core::array::from_fn(|i| accelerations[i] - without[i]));
    motion.acceleration = acceleration.fixed_rows::<3>(0).into();
    motion.angular_acceleration = Vector3::from(acceleration.fixed_rows::<3>(3));
    Ok(motion)
}
