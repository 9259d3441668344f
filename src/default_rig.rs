//! The default rig's joints, of actuators 1 to 6 in order.
//!
//! | joints on the | radius | angles |
//! |---|---|---|
//! | base | 1.00 m | -8, 8, 112, 128, 232, 248 deg |
//! | platform | 0.85 m | -52, 52, 68, 172, 188, 292 deg |
//!
//! The paper publishes no joint coordinates. The joints here are free of singularities over the
//! whole box of leg lengths. Coordinates are written out, and not computed from the angles, so that
//! every platform's binary starts from the same bits.

use nalgebra::Vector3;

/// Joints on the base \[m\].
pub const BASE_JOINTS: [Vector3<f64>; 6] = [
    Vector3::new(0.9902680687415704, -0.13917310096006544, 0.0),
    Vector3::new(0.9902680687415704, 0.13917310096006544, 0.0),
    Vector3::new(-0.37460659341591207, 0.9271838545667874, 0.0),
    Vector3::new(-0.6156614753256583, 0.788010753606722, 0.0),
    Vector3::new(-0.6156614753256581, -0.7880107536067221, 0.0),
    Vector3::new(-0.3746065934159123, -0.9271838545667873, 0.0),
];

/// Joints on the platform \[m\].
pub const PLATFORM_JOINTS: [Vector3<f64>; 6] = [
    Vector3::new(0.5233122540268096, -0.6698091405657137, 0.0),
    Vector3::new(0.5233122540268096, 0.6698091405657137, 0.0),
    Vector3::new(0.3184156044035252, 0.7881062763817693, 0.0),
    Vector3::new(-0.8417278584303348, 0.11829713581605553, 0.0),
    Vector3::new(-0.8417278584303347, -0.11829713581605569, 0.0),
    Vector3::new(0.3184156044035252, -0.7881062763817693, 0.0),
];
