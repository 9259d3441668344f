//! The forward direction of a vehicle in the sensor's axes.
//!
//! Each source gives a horizontal direction with its standard error, over the whole recording:
//!
//! - the change of speed goes with the force along the vehicle;
//! - the yaw rate goes with the force to the left, by v omega, where a vehicle does not lean;
//! - the size of the yaw rate goes with the rate about the axis to the right, where a vehicle leans
//!   into its bends;
//! - forces without yaw rate are along the vehicle, forward or backward.
//!
//! The last is the most precise, and the others tell its sign.

use moris_washout::nalgebra::Vector3;

use super::blocks::{BLOCK_TIME, Blocks};
use super::level::{Estimate, Level, sign};
use crate::message::Message;
use crate::texts::text;

/// The forward direction.
pub struct Forward {
    /// A horizontal unit vector.
    pub direction: Vector3<f64>,
    /// Standard error \[rad\].
    pub error: f64,
    /// Source of the direction, for a sentence.
    pub evidence: String,
    /// True where the sign is that of the first acceleration alone.
    pub may_be_backward: bool,
}

/// The forward direction.
///
/// # Errors
/// No source tells it, or two contradict each other.
pub fn find(blocks: &Blocks, up: &Vector3<f64>) -> Result<Forward, Message> {
    // Largest standard error of a source that is used: it still tells forward from backward [rad].
    const USABLE: f64 = 45f64.to_radians();

    let level = Level::new(blocks, up);
    let sources = [level.along_speed(&blocks.speeds), level.in_bends(), level.in_leaning_bends()];
    let is_usable = |estimate: &Estimate| estimate.error < USABLE;
    let mut estimates: Vec<Estimate> = sources.into_iter().flatten().filter(is_usable).collect();
    estimates.sort_by(|a, b| a.error.total_cmp(&b.error));
    let straight = level.straight_accelerations().filter(is_usable);
    let Some(best) = estimates.first() else {
        let axis = straight.ok_or_else(|| text!["forward-unknown"])?;
        let (start, sign) = level.first_acceleration(blocks.first_rest(), &axis.direction);
        return Ok(Forward {
            direction: sign * axis.direction,
            error: axis.error,
            evidence: format!("the first acceleration, at {:.1} s", start as f64 * BLOCK_TIME),
            may_be_backward: true,
        });
    };
    // Forces without yaw rate do not tell forward from backward.
    let straight =
        straight.map(|axis| Estimate { direction: axis.direction * sign(axis.direction.dot(&best.direction)), ..axis });
    if let Some(other) = estimates[1..].iter().chain(&straight).find(|other| is_contradiction(best, other)) {
        let (one, two, angle) = (best.evidence, other.evidence, best.direction.angle(&other.direction).to_degrees());
        return Err(text!["forward-contradicted", one, two, angle]);
    }
    let (finest, evidence) = match &straight {
        Some(axis) if axis.error <= best.error => (axis, format!("{} and {}", axis.evidence, best.evidence)),
        _ => (best, best.evidence.to_owned()),
    };
    Ok(Forward { direction: finest.direction, error: finest.error, evidence, may_be_backward: false })
}

fn is_contradiction(one: &Estimate, other: &Estimate) -> bool {
    // Angle between two sources beyond their errors that is a contradiction [rad].
    const CONTRADICTION: f64 = 20f64.to_radians();
    one.direction.angle(&other.direction) > CONTRADICTION + 2.0 * (one.error + other.error)
}
