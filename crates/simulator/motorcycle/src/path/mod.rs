//! A path, and the rider who follows it.
//!
//! | module | contents |
//! |---|---|
//! | [`table`] | curvature and speed limit by distance, and the paths that come with the model |
//! | [`speed_plan`] | speed by distance within the limits of tyres and comfort |
//! | [`preview_rider`] | lean control with preview: a linear-quadratic regulator |
//! | [`follower`] | the three together: what the rider does now |
//! | [`grip`] | limits of the tyres' forces, and the end of a ride that exceeds them |
//! | [`forerun`] | the motion of the next seconds, for the preview |
//!
//! Distances are along the path. Deviations, headings and curvatures are positive to the RIGHT
//! here, as in [`crate::lateral`]; the interface has them positive to the left.

pub mod follower;
pub mod forerun;
pub mod grip;
pub mod preview_rider;
pub mod speed_plan;
pub mod table;
