//! Motion cueing: the blocks of the paper's Fig. 4.
//!
//! | module | block |
//! |---|---|
//! | [`conditioning`], [`splitter`] | (1) strategy splitter: gravity removal, scale, limit; high and low frequencies |
//! | [`automatic_scale`] | beside (1): a factor on force and rates, as large as the rig can give |
//! | `preaction` | ahead of (1): begin to end the tilt before a stop (the paper's section 6) |
//! | [`gravitational`] | (2) gravitational strategy: tilt |
//! | [`direct_linear`], [`safety`] | (3) direct linear motion with its safety units |
//! | [`compensation`] | (4) compensation of the accelerations that tilting causes |
//! | [`strategy`] | blocks (1) to (3) as the classical strategy, and the strategies beside it |
//! | [`angular`] | (5), (6) angular channel |
//! | [`evaluator`] | specific force and angular velocity at the washout location |

pub mod angular;
pub mod automatic_scale;
pub mod compensation;
pub mod conditioning;
pub mod direct_linear;
pub mod evaluator;
pub mod gravitational;
pub(crate) mod preaction;
pub mod safety;
pub mod soft_limits;
pub mod splitter;
pub mod strategy;
