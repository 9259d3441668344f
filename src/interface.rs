//! The one table of variables: what goes in, what comes out, what can be set.
//!
//! The structs here are the Rust API, and their rows are the FMU's variables. The names are fixed:
//! users and their scripts rely on them. A new variable goes at the end of its struct.
//!
//! ```
//! use moris_washout::interface::{Input, Parameters, StrategyKind};
//! use moris_washout::{Washout, nalgebra::Vector3};
//!
//! let mut parameters = Parameters::default();
//! parameters.structure.strategy = StrategyKind::Predictive; // the FMU's `strategy`
//! parameters.tilt.rate_limit = 0.04; // `tilt.rateLimit`, in rad/s
//! let mut washout = Washout::new(&parameters)?;
//! let braking = Input { specific_force: Vector3::new(-2.0, 0.0, 9.80665), ..Input::default() };
//! for _ in 0..1000 {
//!     washout.step(&braking, 0.001);
//! }
//! assert!(washout.output().tilt_pitch > 0.0, "nose down");
//! # Ok::<(), moris_washout::ParameterError>(())
//! ```

use core::ops::RangeInclusive;

use moris_interface::units::{ANGULAR_FREQUENCY, M, M_PER_S, M_PER_S2, RAD, RAD_PER_S, RAD_PER_S2, S};
use moris_interface::{enumeration, interface, interface_tree};
use nalgebra::Vector3;

use crate::default_rig;
pub use crate::motion::orientation::RollPitchYaw;

/// Standard gravity \[m/s2\].
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Usual break frequencies \[rad/s\].
const USUAL_FREQUENCIES: RangeInclusive<f64> = 0.05..=20.0;
/// Usual damping ratios.
const USUAL_DAMPING_RATIOS: RangeInclusive<f64> = 0.3..=2.0;
/// Usual scales; one above 1 would exceed the vehicle's motion.
const USUAL_SCALES: RangeInclusive<f64> = 0.01..=1.0;
/// Usual weights of a strategy's cost, and rates at which gains follow its gradient.
const USUAL_WEIGHTS: RangeInclusive<f64> = 1e-5..=1e3;
/// Usual gains of the adaptive strategy: a fraction of the force as travel, and a tilt rate for it.
const USUAL_GAINS: RangeInclusive<f64> = 1e-3..=2.0;
/// Usual time constants that split the force \[s\].
const USUAL_SPLIT_TIMES: RangeInclusive<f64> = 0.01..=2.0;
/// Heading of the parameters that only one strategy has.
const OF_STRATEGY: &str = "The strategy's weights";

interface! {
    /// Inputs from the vehicle model at every communication point.
    pub struct Input: Input, Continuous {
        /// Specific force at the washout location in the rider's head axes (x forward, y left, z up), as an accelerometer measures it: (0, 0, +g) at rest.
        "vehicle.specificForce.@" specific_force: Vector3<f64> [M_PER_S2] { -1e4 ..= 1e4 } = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
        /// Angular velocity of the vehicle, in the axes given by angularVelocityFrame.
        "vehicle.angularVelocity.@" angular_velocity: Vector3<f64> [RAD_PER_S] { -1e3 ..= 1e3 } = Vector3::new(0.0, 0.0, 0.0);
        /// Orientation of the vehicle in its own world (roll about x, pitch about y with nose down positive, yaw about z).
        "vehicle.orientation.@" orientation: RollPitchYaw [RAD] { -1e6 ..= 1e6 } = RollPitchYaw::new(0.0, 0.0, 0.0);
        /// Forward speed of the vehicle; the washout depends on it only with preaction on.
        "vehicle.speed" speed: f64 [M_PER_S] { -1e3 ..= 1e3 } = 0.0;
        /// Lean of the rider's torso relative to the mock-up, positive to the right.
        "rider.lean" lean: f64 [RAD] { -1.5 ..= 1.5 } = 0.0;
        /// True: cue the vehicle's motion. False: return to neutral within the limits, and stay.
        "engaged" engaged: bool = true;
    }
}

/// Number of elements of a preview.
pub const PREVIEW_SAMPLES: usize = 20;

interface! {
    /// Force that is to come, for the predictive strategy: from a recording, a
    /// script or a planned path.
    pub struct Preview: Input, Continuous {
        /// Number of elements of vehicle.preview.specificForce in use; 0 without a preview.
        "vehicle.preview.count" count: i32 { 0 ..= 20 } = 0;
        /// Time from one element of the preview to the next; the first is as far ahead of the present inputs.
        "vehicle.preview.step" step: f64 [S] { 1e-2 ..= 10.0 } = 0.2;
        /// Future specific force along the head's x axis, defined as vehicle.specificForce.x is.
        "vehicle.preview.specificForce.x[#]" surge: [f64; PREVIEW_SAMPLES] [M_PER_S2] { -1e4 ..= 1e4 } = [0.0; PREVIEW_SAMPLES];
        /// Future specific force along the head's y axis, defined as vehicle.specificForce.y is.
        "vehicle.preview.specificForce.y[#]" sway: [f64; PREVIEW_SAMPLES] [M_PER_S2] { -1e4 ..= 1e4 } = [0.0; PREVIEW_SAMPLES];
    }
}

interface_tree! {
    /// All inputs.
    pub struct Inputs {
        vehicle: Input,
        preview: Preview,
    }
}

interface! {
    /// Commands to the platform and its actuators, and the motion felt by the rider.
    pub struct Output: Output, Continuous, start_depends_on(&[]) {
        /// Position of the platform frame's origin in the base frame.
        "platform.position.@" position: Vector3<f64> [M] = Vector3::new(0.0, 0.0, 0.0), start_depends_on(&["rig.neutralHeight"]);
        /// Velocity of the platform frame's origin in the base frame.
        "platform.velocity.@" velocity: Vector3<f64> [M_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// Acceleration of the platform frame's origin in the base frame.
        "platform.acceleration.@" acceleration: Vector3<f64> [M_PER_S2] = Vector3::new(0.0, 0.0, 0.0);
        /// Orientation of the platform in the base frame.
        "platform.orientation.@" orientation: RollPitchYaw [RAD] = RollPitchYaw::new(0.0, 0.0, 0.0);
        /// Angular velocity of the platform in the base frame.
        "platform.angularVelocity.@" angular_velocity: Vector3<f64> [RAD_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// Commanded length of the actuator, from base joint to platform joint; with cranks, the distance from axle to platform joint.
        "actuator[#].length" length: [f64; 6] [M] = [0.0; 6], start_depends_on(&["rig."]);
        /// Commanded rate of the actuator's length.
        "actuator[#].velocity" leg_velocity: [f64; 6] [M_PER_S] = [0.0; 6];
        /// Specific force at the washout location on the commanded motion, in head axes.
        "rider.specificForce.@" felt_specific_force: Vector3<f64> [M_PER_S2] = Vector3::new(0.0, 0.0, 0.0), start_depends_on(&["gravity", "rider.lean", "washoutLocation"]);
        /// Angular velocity at the washout location on the commanded motion, in head axes.
        "rider.angularVelocity.@" felt_angular_velocity: Vector3<f64> [RAD_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// Part of the platform's roll due to tilt coordination.
        "tilt.roll" tilt_roll: f64 [RAD] = 0.0;
        /// Part of the platform's pitch due to tilt coordination.
        "tilt.pitch" tilt_pitch: f64 [RAD] = 0.0;
        /// Rate of tilt coordination's roll.
        "tilt.rollRate" tilt_roll_rate: f64 [RAD_PER_S] = 0.0;
        /// Rate of tilt coordination's pitch.
        "tilt.pitchRate" tilt_pitch_rate: f64 [RAD_PER_S] = 0.0;
        /// True if a limit of rate, acceleration or angle kept tilt coordination from its target during the last communication step.
        "status.tiltLimited" tilt_limited: bool = false;
        /// True if a safety unit limited position, velocity or acceleration of the platform during the last communication step.
        "status.safetyActive" safety_active: bool = false;
        /// True if the actuator guard changed the motion to keep an actuator's or the platform's limits during the last communication step.
        "status.actuatorLimited" actuator_limited: bool = false;
        /// Smallest clearance of an actuator: distance from either end of its stroke; with cranks, of its arc, whatever the transmission.
        "status.strokeMargin" stroke_margin: f64 [M] = 0.0, start_depends_on(&["actuator.", "rig."]);
        /// True if the predictive strategy's last attempt at a new plan failed and the previous plan continues.
        "status.planKept" plan_kept: bool = false;
        /// Time since the plan of the predictive strategy was begun.
        "predictive.planAge" plan_age: f64 [S] = 0.0;
        /// Iterations that the last plan of the predictive strategy took.
        "predictive.iterations" plan_iterations: i32 = 0;
        /// True if the soft limits changed the motion during the last communication step.
        "status.softLimited" soft_limited: bool = false;
        /// Factor by which the automatic scale multiplies surge, sway and rates; 1 while it is off.
        "automaticScale.factor" scale_factor: f64 = 1.0, start_depends_on(&["automaticScale.", "scale.automatic"]);
        /// Commanded angle of the crank's arm above its heading; 0 with legs.
        "actuator[#].angle" angle: [f64; 6] [RAD] = [0.0; 6], start_depends_on(&["crank.", "rig."]);
        /// Commanded angular velocity of the crank's arm; 0 with legs.
        "actuator[#].angularVelocity" angular_rate: [f64; 6] [RAD_PER_S] = [0.0; 6];
    }
}

enumeration! {
    /// Method of removing gravity from the vehicle's specific force.
    pub enum GravityRemoval {
        /// Remove the part along the head's vertical axis only (the paper; right for a motorcycle).
        "head_vertical" HeadVertical,
        /// Remove the whole vector.
        "full" Full,
        /// Remove nothing: the input is the acceleration itself.
        "none" None,
    }
}

enumeration! {
    /// Tilt-induced accelerations at the washout location that linear motion compensates.
    pub enum Compensation {
        /// None of them.
        "none" None,
        /// The centripetal term (the paper).
        "centripetal" Centripetal,
        /// The centripetal and the tangential term.
        "full" Full,
        /// Both, and the part of gravity due to rotation of the platform by the angular channel.
        "gravity" Gravity,
    }
}

enumeration! {
    /// The axes in which the vehicle's angular velocity is given.
    pub enum AngularVelocityFrame {
        /// The axes of the vehicle's world (the paper).
        "world" World,
        /// The axes of the vehicle's body.
        "body" Body,
    }
}

enumeration! {
    /// Reconstruction of inputs within a communication step without input derivatives.
    pub enum Reconstruction {
        /// Hold the input.
        "hold" Hold,
        /// Ramp linearly from the last step's input to this step's, reached at the step's end.
        "ramp" Ramp,
    }
}

enumeration! {
    /// Law by which the classical strategy's tilt follows its target.
    pub enum TiltTracking {
        /// Braking law: steps of the acceleration are compensated by travel (the paper).
        "exact" Exact,
        /// Jerk-limited acceleration, for travel that may reach its limits.
        "smooth" Smooth,
    }
}

enumeration! {
    /// Source of the low-frequency force for tilt coordination.
    pub enum LowPassKind {
        /// Complement of the high-pass, so that the two add up to the input, eq. (6).
        "complementary" Complementary,
        /// A second-order low-pass with its own frequency and damping.
        "independent" Independent,
    }
}

enumeration! {
    /// Preaction ahead of a brusque stop (the paper's section 6).
    pub enum Preaction {
        /// No preaction.
        "off" Off,
        /// The tilt decreases ahead of the stop, and surge provides part of the force meanwhile.
        "on" On,
    }
}

enumeration! {
    /// Choice of the largest factor on surge, sway and rates that the rig can reproduce.
    pub enum AutomaticScale {
        /// A factor of 1.
        "off" Off,
        /// A factor of at most 1 that keeps shape and sign of the felt force.
        "on" On,
    }
}

enumeration! {
    /// Division of the cue between surge, sway and tilt.
    pub enum StrategyKind {
        /// High-pass to travel, low-pass to tilt (the paper).
        "classical" Classical,
        /// A filter whose gains follow the gradient of a cost.
        "adaptive" Adaptive,
        /// A linear-quadratic regulator (LQR).
        "optimal" Optimal,
        /// Model predictive control (MPC): a plan within all limits, renewed 50 times a second.
        "predictive" Predictive,
        /// An H-infinity regulator: least cost for the worst reference.
        "robust" Robust,
    }
}

enumeration! {
    /// Group of parameters that are tuned together.
    pub enum TuningGroup {
        /// The splitter's break frequencies and dampings
        "splitter" Splitter,
        /// The angular channel's break frequencies and dampings
        "angular" Angular,
        /// The scales of specific force and angular velocity
        "scale" Scale,
        /// The low-passes on the input and on its rates, for recordings with strong vibration
        "cutoff" Cutoff,
        /// Limits of the tilt's rate (to 3 deg/s), acceleration and angle
        "tilt" Tilt,
        /// Weights, gains and poles of the strategy in use; the classical one has none
        "strategy" Strategy,
        /// The orders of the splitter's and the angular channel's high-passes, 2 to 4
        "order" Order,
    }
}

enumeration! {
    /// Forecast of the specific force in the predictive strategy.
    pub enum ForecastKind {
        /// A mixture of experts, one of them fitted to past inputs.
        "learned" Learned,
        /// The force decays, with a slow and a fast part.
        "decay" Decay,
        /// The force stays constant.
        "hold" Hold,
    }
}

enumeration! {
    /// The point of the platform at which the vehicle's motion is given,
    /// compensated for and evaluated.
    pub enum WashoutLocation {
        /// The rider's head, which moves with the rider's lean.
        "head" Head,
        /// The origin of the platform frame.
        "platform" Platform,
        /// The point washoutPoint of the platform.
        "custom" Custom,
    }
}

interface! {
    /// Block (1): the high-pass of each axis of the base frame, and the low-pass beside it.
    pub struct SplitterParameters: Parameter, Tunable, tuning_group("splitter"), partly_used_if(&["x", "y"], "strategy", &["classical"]) {
        /// Break frequency of the high-pass filter's first pair of poles.
        "splitter.@.omega1" omega1: Vector3<f64> [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = Vector3::new(0.8, 0.8, 5.0), usual(USUAL_FREQUENCIES), heading("Break frequencies"), importance_rank(4);
        /// Damping ratio of the high-pass filter's first pair of poles.
        "splitter.@.zeta1" zeta1: Vector3<f64> { 1e-3 ..= 100.0 } = Vector3::new(1.3, 1.2, 1.0), usual(USUAL_DAMPING_RATIOS);
        /// Break frequency of the high-pass filter's second pair of poles (order 4), or of its single pole (order 3).
        "splitter.@.omega2" omega2: Vector3<f64> [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = Vector3::new(0.55, 0.35, 0.3), usual(USUAL_FREQUENCIES), heading("Break frequencies"), importance_rank(5), used_if("splitter.order", &["3", "4"]);
        /// Damping ratio of the high-pass filter's second pair of poles (order 4).
        "splitter.@.zeta2" zeta2: Vector3<f64> { 1e-3 ..= 100.0 } = Vector3::new(1.0, 1.0, 1.0), usual(USUAL_DAMPING_RATIOS), used_if("splitter.order", &["4"]);
        /// Break frequency of the low-pass filter when splitter.lowPass is independent.
        "splitter.@.lowPassOmega" low_pass_omega: Vector3<f64> [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = Vector3::new(5.0, 5.0, 5.0), used_if("splitter.lowPass", &["independent"]);
        /// Damping ratio of the low-pass filter when splitter.lowPass is independent.
        "splitter.@.lowPassZeta" low_pass_zeta: Vector3<f64> { 1e-3 ..= 100.0 } = Vector3::new(1.0, 1.0, 1.0), used_if("splitter.lowPass", &["independent"]);
    }
}

interface! {
    /// Block (6): the high-pass of each angle.
    pub struct AngularParameters: Parameter, Tunable, tuning_group("angular") {
        /// Break frequency of the high-pass filter's first pair of poles.
        "angular.@.omega1" omega1: RollPitchYaw [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = RollPitchYaw::new(0.9, 0.6, 1.0), usual(USUAL_FREQUENCIES), heading("Break frequencies"), importance_rank(6);
        /// Damping ratio of the high-pass filter's first pair of poles.
        "angular.@.zeta1" zeta1: RollPitchYaw { 1e-3 ..= 100.0 } = RollPitchYaw::new(1.0, 1.0, 1.0), usual(USUAL_DAMPING_RATIOS);
        /// Break frequency of the high-pass filter's second pair of poles (order 4), or of its single pole (order 3).
        "angular.@.omega2" omega2: RollPitchYaw [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = RollPitchYaw::new(1.0, 1.0, 1.0), usual(USUAL_FREQUENCIES), heading("Break frequencies"), used_if("angular.order", &["3", "4"]);
        /// Damping ratio of the high-pass filter's second pair of poles (order 4).
        "angular.@.zeta2" zeta2: RollPitchYaw { 1e-3 ..= 100.0 } = RollPitchYaw::new(1.0, 1.0, 1.0), usual(USUAL_DAMPING_RATIOS), used_if("angular.order", &["4"]);
    }
}

interface! {
    /// Conditioning of the vehicle's motion ahead of the filters.
    pub struct ConditioningParameters: Parameter, Tunable {
        /// Scale of the specific force after gravity removal; below 0 the cue's sign changes.
        "scale.specificForce.@" force_scale: Vector3<f64> { -10.0 ..= 10.0 } = Vector3::new(1.0, 1.0, 1.0), usual(USUAL_SCALES), tuning_group("scale"), heading("Scales"), importance_rank(2);
        /// Scale of the angular rates (x of roll, y of pitch, z of yaw); below 0 the cue's sign changes.
        "scale.angularVelocity.@" rate_scale: Vector3<f64> { -10.0 ..= 10.0 } = Vector3::new(0.25, 0.3, 0.9), usual(USUAL_SCALES), tuning_group("scale"), heading("Scales"), importance_rank(3);
        /// Largest scaled specific force; the limiter is linear up to 80 % of it and smooth above.
        "limit.specificForce.@" force_limit: Vector3<f64> [M_PER_S2] { 1e-3 ..= 1e6 } = Vector3::new(4.5, 5.0, 8.0);
        /// Largest scaled angular rate (x of roll, y of pitch, z of yaw), limited like the specific force.
        "limit.angularVelocity.@" rate_limit: Vector3<f64> [RAD_PER_S] { 1e-3 ..= 1e6 } = Vector3::new(1.0, 1.0, 1.0);
        /// Break frequency of a first-order low-pass on specific force and angular rates; 0 is off.
        "input.cutoff" cutoff: f64 [ANGULAR_FREQUENCY] { 0.0 ..= 1e4 } = 0.0, usual(5.0 ..= 200.0), tuning_group("cutoff");
        /// Method of removing gravity from the specific force.
        "gravityRemoval" gravity_removal: GravityRemoval = GravityRemoval::HeadVertical;
        /// Tilt-induced accelerations that are compensated.
        "compensation" compensation: Compensation = Compensation::Full;
        /// Axes of vehicle.angularVelocity.
        "angularVelocityFrame" angular_velocity_frame: AngularVelocityFrame = AngularVelocityFrame::World;
        /// Break frequency of a second-order low-pass on the angular rates alone; 0 is off.
        "input.rateCutoff" rate_cutoff: f64 [ANGULAR_FREQUENCY] { 0.0 ..= 1e4 } = 22.0, usual(5.0 ..= 200.0), tuning_group("cutoff");
        /// Reconstruction of inputs within a step without input derivatives.
        "input.reconstruction" reconstruction: Reconstruction = Reconstruction::Ramp;
    }
}

interface! {
    /// Block (2): tilt coordination's limits, for roll and pitch each.
    pub struct TiltParameters: Parameter, Tunable, tuning_group("tilt") {
        /// Largest rate of tilt coordination (3 deg/s: about the threshold of perception).
        "tilt.rateLimit" rate_limit: f64 [RAD_PER_S] { 1e-9 ..= 10.0 } = 0.052_36, usual(0.02 ..= 0.053), heading("Tilt limits"), importance_rank(7);
        /// Largest acceleration of tilt coordination.
        "tilt.accelerationLimit" acceleration_limit: f64 [RAD_PER_S2] { 1e-9 ..= 1e3 } = 0.4, usual(0.05 ..= 0.5), heading("Tilt limits");
        /// Largest angle of tilt coordination.
        "tilt.angleLimit" angle_limit: f64 [RAD] { 1e-9 ..= 1.047_197_551_196_597_6 } = 0.257, usual(0.1 ..= 0.38), heading("Tilt limits"), importance_rank(8);
        /// Law by which the classical strategy's tilt follows its target.
        "tilt.tracking" tracking: TiltTracking = TiltTracking::Smooth, used_if("strategy", &["classical"]);
    }
}

interface! {
    /// Block (3): the safety units, one for each axis of the base frame, about
    /// the neutral position.
    pub struct SafetyParameters: Parameter, Tunable, heading("Rig") {
        /// Largest displacement of the platform from neutral.
        "safety.@.positionLimit" position_limit: Vector3<f64> [M] { 1e-9 ..= 1e9 } = Vector3::new(0.37, 0.37, 0.33), importance_rank(9);
        /// Largest velocity of the platform.
        "safety.@.velocityLimit" velocity_limit: Vector3<f64> [M_PER_S] { 1e-9 ..= 1e9 } = Vector3::new(1.0, 1.0, 1.0);
        /// Largest acceleration of the platform, including braking.
        "safety.@.accelerationLimit" acceleration_limit: Vector3<f64> [M_PER_S2] { 1e-9 ..= 1e9 } = Vector3::new(10.0, 10.0, 10.0);
    }
}

interface! {
    /// The soft limits, in front of the safety units and the actuator guard.
    pub struct SoftLimitParameters: Parameter, Tunable {
        /// Rate of approach to a limit: the speed is at most this rate times the distance to the margin; 0 is off.
        "softLimit.pace" pace: f64 [RAD_PER_S] { 0.0 ..= 9.0 } = 5.0;
        /// Margin kept at either end of an axis and of an actuator's stroke: at most half the distance from neutral, in proportion to a stroke below 0.3 m.
        "softLimit.margin" margin: f64 [M] { 0.0 ..= 1.0 } = 0.01;
    }
}

interface! {
    /// The automatic scale, in front of all limits.
    pub struct AutomaticScaleParameters: Parameter, Tunable {
        /// Automatic scale: the largest factor on surge, sway and rates at which the rig keeps their sign and shape.
        "scale.automatic" automatic: AutomaticScale = AutomaticScale::Off;
        /// Shape error above which the automatic scale falls: RMS of felt force minus cue, relative to the cue.
        "automaticScale.error" error: f64 { 0.05 ..= 2.0 } = 0.62, used_if("scale.automatic", &["on"]);
        /// Time constant of the running means from which the automatic scale is computed.
        "automaticScale.memory" memory: f64 [S] { 1.0 ..= 1e4 } = 25.0, used_if("scale.automatic", &["on"]);
        /// Time constant with which the automatic scale falls.
        "automaticScale.fallTime" fall_time: f64 [S] { 0.1 ..= 1e4 } = 0.6, used_if("scale.automatic", &["on"]);
        /// Time constant with which the automatic scale rises.
        "automaticScale.riseTime" rise_time: f64 [S] { 0.1 ..= 1e4 } = 5.2, used_if("scale.automatic", &["on"]);
        /// Initial value of the automatic scale.
        "automaticScale.start" start: f64 { 0.01 ..= 1.0 } = 0.55, used_if("scale.automatic", &["on"]);
    }
}

interface! {
    /// Structure of the filter; fixed after initialisation.
    pub struct StructureParameters: Parameter, Fixed {
        /// Magnitude of gravity.
        "gravity" gravity: f64 [M_PER_S2] { 0.1 ..= 100.0 } = STANDARD_GRAVITY;
        /// Order of the splitter's high-pass filters.
        "splitter.order" splitter_order: i32 { 2 ..= 4 } = 3, tuning_group("order");
        /// Source of the low-frequency force.
        "splitter.lowPass" low_pass: LowPassKind = LowPassKind::Complementary;
        /// Order of the angular channel's high-pass filters.
        "angular.order" angular_order: i32 { 2 ..= 4 } = 2, tuning_group("order");
        /// Height of the rider's head above the platform (the paper's h).
        "head.height" head_height: f64 [M] { 0.0 ..= 10.0 } = 1.2, importance_rank(10);
        /// Length of the torso from the seat, its lean axis, to the head (the paper's b).
        "head.torsoLength" torso_length: f64 [M] { 0.0 ..= 10.0 } = 0.75;
        /// The point at which the vehicle's motion is given, compensated for and evaluated.
        "washoutLocation" washout_location: WashoutLocation = WashoutLocation::Head;
        /// The washout location in the platform frame when washoutLocation is custom.
        "washoutPoint.@" washout_point: Vector3<f64> [M] { -10.0 ..= 10.0 } = Vector3::new(0.0, 0.0, 1.2), used_if("washoutLocation", &["custom"]);
        /// Longest internal step; a longer communication step is divided.
        "solver.maxStep" max_step: f64 [S] { 1e-6 ..= 0.05 } = 0.001;
        /// Preaction: tilt and surge act ahead of the vehicle's stop, predicted from vehicle.speed and its deceleration.
        "preaction" preaction: Preaction = Preaction::Off;
        /// Strategy that divides the cue between surge, sway and tilt. On recordings the mean error falls in the order classical, adaptive, optimal, robust, predictive. A step of predictive takes 3 us in the mean, of the others 0.3 to 0.5 us.
        "strategy" strategy: StrategyKind = StrategyKind::Predictive, heading("Strategy"), importance_rank(1);
    }
}

interface! {
    /// The Stewart platform: joints and actuator limits.
    pub struct Rig: Parameter, Fixed {
        /// Height of the platform frame's origin above the base frame's at neutral; negative for a hanging platform.
        "rig.neutralHeight" neutral_height: f64 [M] { -100.0 ..= 100.0 } = 1.091, heading("Rig");
        /// Shortest length of an actuator; without effect with cranks.
        "actuator.minLength" min_length: f64 [M] { 1e-3 ..= 100.0 } = 1.0, heading("Rig");
        /// Longest length of an actuator; without effect with cranks.
        "actuator.maxLength" max_length: f64 [M] { 1e-3 ..= 100.0 } = 1.6, heading("Rig");
        /// Largest speed of an actuator; with cranks, of the arms' ends.
        "actuator.velocityLimit" velocity_limit: f64 [M_PER_S] { 1e-3 ..= 100.0 } = 1.0, heading("Rig");
        /// Largest acceleration of an actuator; with cranks, of the arms' ends along their circle.
        "actuator.accelerationLimit" acceleration_limit: f64 [M_PER_S2] { 1e-3 ..= 1e4 } = 15.0, heading("Rig");
        /// Length of a crank's arm, from its axle at the base joint to the rod; 0 for a rig with legs.
        "crank.arm" crank_arm: f64 [M] { 0.0 ..= 100.0 } = 0.0;
        /// Length of a crank's rod, from the arm's end to the platform joint.
        "crank.rod" crank_rod: f64 [M] { 0.0 ..= 100.0 } = 0.0;
        /// Heading of the crank's arm while it is level, from x towards y; the axle is horizontal and across it.
        "crank.heading[#]" crank_heading: [f64; 6] [RAD] { -7.0 ..= 7.0 } = [0.0; 6];
        /// Lowest angle of a crank's arm above its heading.
        "crank.minAngle" crank_min_angle: f64 [RAD] { -2.0 ..= 2.0 } = -1.0;
        /// Highest angle of a crank's arm above its heading.
        "crank.maxAngle" crank_max_angle: f64 [RAD] { -2.0 ..= 2.0 } = 1.0;
        /// Smallest transmission of a crank: the component of the rod's direction along the circle of the arm's end; 0 at a dead centre.
        "crank.leastTransmission" crank_least_transmission: f64 { 0.05 ..= 0.99 } = 0.3;
        /// Joint of the actuator on the base, in the base frame.
        "rig.base[#].@" base: [Vector3<f64>; 6] [M] { -100.0 ..= 100.0 } = default_rig::BASE_JOINTS;
        /// Joint of the actuator on the platform, in the platform frame.
        "rig.platform[#].@" platform: [Vector3<f64>; 6] [M] { -100.0 ..= 100.0 } = default_rig::PLATFORM_JOINTS;
    }
}

impl Output {
    /// Positions of the actuators and their rates, within [`Rig::stroke`] \[m, m/s\]: lengths of
    /// legs, or arcs of the cranks' arms.
    pub fn actuators(&self, rig: &Rig) -> [[f64; 6]; 2] {
        if rig.has_cranks() {
            [self.angle, self.angular_rate].map(|values| values.map(|value| rig.crank_arm * value))
        } else {
            [self.length, self.leg_velocity]
        }
    }
}

impl Rig {
    /// True if the actuators are cranks, and not legs.
    pub fn has_cranks(&self) -> bool {
        self.crank_arm > 0.0
    }

    /// The ends of an actuator's stroke \[m\]: its shortest and longest length, or the arcs of a
    /// crank's arm at its lowest and highest angle.
    pub fn stroke(&self) -> [f64; 2] {
        if self.has_cranks() {
            [self.crank_min_angle, self.crank_max_angle].map(|angle| self.crank_arm * angle)
        } else {
            [self.min_length, self.max_length]
        }
    }

    /// The length of an actuator's stroke \[m\].
    pub fn stroke_length(&self) -> f64 {
        let [start, end] = self.stroke();
        end - start
    }

    /// The farthest that a platform joint can be from its base joint \[m\].
    pub fn farthest_joint(&self) -> f64 {
        if self.has_cranks() { self.crank_arm + self.crank_rod } else { self.max_length }
    }
}

interface! {
    /// The adaptive strategy, for surge and sway each.
    pub struct AdaptiveParameters: Parameter, Tunable, tuning_group("strategy"), used_if("strategy", &["adaptive"]), heading(OF_STRATEGY) {
        /// Break frequency of the adaptive strategy's high-pass from force to travel.
        "adaptive.omega" omega: f64 [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = 0.7, usual(USUAL_FREQUENCIES);
        /// Damping ratio of the adaptive strategy's high-pass from force to travel.
        "adaptive.zeta" zeta: f64 { 1e-3 ..= 100.0 } = 0.7, usual(USUAL_DAMPING_RATIOS);
        /// Rate at which the gain from force to travel follows the gradient of the cost.
        "adaptive.gain1" gain1: f64 { 1e-9 ..= 1e6 } = 0.18, usual(USUAL_WEIGHTS);
        /// Rate at which the gain from force to tilt rate follows the gradient of the cost.
        "adaptive.gain2" gain2: f64 { 1e-9 ..= 1e6 } = 0.16, usual(USUAL_WEIGHTS);
        /// Gain from force to travel to which the adaptation is pulled.
        "adaptive.nominal1" nominal1: f64 { 1e-9 ..= 10.0 } = 0.986, usual(USUAL_GAINS);
        /// Gain from force to tilt rate, in (rad/s)/(m/s2), to which the adaptation is pulled.
        "adaptive.nominal2" nominal2: f64 { 1e-9 ..= 10.0 } = 0.25, usual(USUAL_GAINS);
        /// Weight of travel; the error of the felt force has the weight 1.
        "adaptive.weightPosition" weight_position: f64 { 1e-9 ..= 1e6 } = 4.0, usual(USUAL_WEIGHTS);
        /// Weight of the travel's velocity.
        "adaptive.weightVelocity" weight_velocity: f64 { 1e-9 ..= 1e6 } = 5.13, usual(USUAL_WEIGHTS);
        /// Weight of the tilt rate.
        "adaptive.weightTiltRate" weight_tilt_rate: f64 { 1e-9 ..= 1e6 } = 0.63, usual(USUAL_WEIGHTS);
        /// Weight of the deviation of the gain from force to travel from its nominal value.
        "adaptive.pull1" pull1: f64 { 1e-9 ..= 1e6 } = 0.0115, usual(USUAL_WEIGHTS);
        /// Weight of the deviation of the gain from force to tilt rate from its nominal value.
        "adaptive.pull2" pull2: f64 { 1e-9 ..= 1e6 } = 0.349, usual(USUAL_WEIGHTS);
    }
}

interface! {
    /// The optimal strategy, for surge and sway each.
    pub struct OptimalParameters: Parameter, Tunable, tuning_group("strategy"), used_if("strategy", &["optimal"]), heading(OF_STRATEGY) {
        /// Weight of travel at its limit; a dropped force of 1 m/s2 has the weight 1.
        "optimal.weightPosition" weight_position: f64 { 1e-9 ..= 1e6 } = 0.209, usual(USUAL_WEIGHTS);
        /// Weight of the travel's velocity at its limit.
        "optimal.weightVelocity" weight_velocity: f64 { 1e-9 ..= 1e6 } = 0.0105, usual(USUAL_WEIGHTS);
        /// Weight of the tilt rate at its limit.
        "optimal.weightTiltRate" weight_tilt_rate: f64 { 1e-9 ..= 1e6 } = 0.0033, usual(USUAL_WEIGHTS);
        /// Weight of the tilt acceleration at its limit.
        "optimal.weightTiltAcceleration" weight_tilt_acceleration: f64 { 1e-9 ..= 1e6 } = 0.0242, usual(USUAL_WEIGHTS);
        /// Expected rate of decay of the slow part of the force.
        "optimal.slowPole" slow_pole: f64 [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = 0.345, usual(USUAL_FREQUENCIES);
        /// Expected rate of decay of the fast part of the force.
        "optimal.fastPole" fast_pole: f64 [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = 4.71, usual(USUAL_FREQUENCIES);
        /// Time constant that splits the force into its slow and its fast part.
        "optimal.splitTime" split_time: f64 [S] { 1e-3 ..= 1e3 } = 0.117, usual(USUAL_SPLIT_TIMES);
    }
}

interface! {
    /// The robust strategy, for surge and sway each.
    pub struct RobustParameters: Parameter, Tunable, tuning_group("strategy"), used_if("strategy", &["robust"]), heading(OF_STRATEGY) {
        /// Attenuation level gamma relative to the least possible one; values near 1 weigh the worst disturbance most.
        "robust.attenuation" attenuation: f64 { 1.001 ..= 1e3 } = 1.08, usual(1.01 ..= 10.0);
        /// Disturbance of the force's fast part relative to that of its slow part.
        "robust.fastDisturbance" fast_disturbance: f64 { 1e-3 ..= 1e6 } = 121.0, usual(1.0 ..= 1e4);
        /// Weight of travel at its limit; a dropped force of 1 m/s2 has the weight 1.
        "robust.weightPosition" weight_position: f64 { 1e-9 ..= 1e6 } = 0.02, usual(USUAL_WEIGHTS);
        /// Weight of the travel's velocity at its limit.
        "robust.weightVelocity" weight_velocity: f64 { 1e-9 ..= 1e6 } = 0.0048, usual(USUAL_WEIGHTS);
        /// Weight of the tilt rate at its limit.
        "robust.weightTiltRate" weight_tilt_rate: f64 { 1e-9 ..= 1e6 } = 0.0007, usual(USUAL_WEIGHTS);
        /// Weight of the tilt acceleration at its limit.
        "robust.weightTiltAcceleration" weight_tilt_acceleration: f64 { 1e-9 ..= 1e6 } = 0.0072, usual(USUAL_WEIGHTS);
        /// Expected rate of decay of the slow part of the force.
        "robust.slowPole" slow_pole: f64 [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = 0.115, usual(USUAL_FREQUENCIES);
        /// Expected rate of decay of the fast part of the force.
        "robust.fastPole" fast_pole: f64 [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = 25.5, usual(0.05 ..= 100.0);
        /// Time constant that splits the force into its slow and its fast part.
        "robust.splitTime" split_time: f64 [S] { 1e-3 ..= 1e3 } = 0.245, usual(USUAL_SPLIT_TIMES);
    }
}

interface! {
    /// The predictive strategy, for surge and sway together.
    pub struct PredictiveParameters: Parameter, Tunable, tuning_group("strategy"), used_if("strategy", &["predictive"]) {
        /// Weight of travel at its limit; a dropped force of 1 m/s2 has the weight 1.
        "predictive.weightPosition" weight_position: f64 { 1e-9 ..= 1e6 } = 4e-3, usual(USUAL_WEIGHTS), heading(OF_STRATEGY);
        /// Weight of the travel's velocity at its limit.
        "predictive.weightVelocity" weight_velocity: f64 { 1e-9 ..= 1e6 } = 0.6, usual(USUAL_WEIGHTS), heading(OF_STRATEGY);
        /// Weight of the tilt rate at its limit.
        "predictive.weightTiltRate" weight_tilt_rate: f64 { 1e-9 ..= 1e6 } = 1.9e-3, usual(USUAL_WEIGHTS), heading(OF_STRATEGY);
        /// Weight of the tilt acceleration at its limit.
        "predictive.weightTiltAcceleration" weight_tilt_acceleration: f64 { 1e-9 ..= 1e6 } = 5e-4, usual(USUAL_WEIGHTS), heading(OF_STRATEGY);
        /// Expected rate of decay of the slow part of the force beyond the plan.
        "predictive.slowPole" slow_pole: f64 [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = 0.2, usual(USUAL_FREQUENCIES), heading(OF_STRATEGY);
        /// Expected rate of decay of the fast part of the force beyond the plan.
        "predictive.fastPole" fast_pole: f64 [ANGULAR_FREQUENCY] { 1e-6 ..= 1e3 } = 2.2, usual(USUAL_FREQUENCIES), heading(OF_STRATEGY);
        /// Forecast of the specific force.
        "predictive.forecast" forecast: ForecastKind = ForecastKind::Learned;
        /// Time constant with which the learned forecast forgets past inputs.
        "predictive.memory" memory: f64 [S] { 0.1 ..= 1e6 } = 160.0, used_if("predictive.forecast", &["learned"]);
        /// Time constant over which the learned forecast's experts are compared.
        "predictive.selection" selection: f64 [S] { 0.1 ..= 1e6 } = 14.0, used_if("predictive.forecast", &["learned"]);
        /// Margin that a plan keeps at either end of an actuator's stroke; in proportion to a stroke below 0.3 m.
        "predictive.legMargin" leg_margin: f64 [M] { 1e-9 ..= 1.0 } = 0.015;
    }
}

interface_tree! {
    /// All parameters: the filter's and the rig's.
    pub struct Parameters {
        splitter: SplitterParameters,
        angular: AngularParameters,
        conditioning: ConditioningParameters,
        tilt: TiltParameters,
        safety: SafetyParameters,
        structure: StructureParameters,
        adaptive: AdaptiveParameters,
        optimal: OptimalParameters,
        robust: RobustParameters,
        predictive: PredictiveParameters,
        soft_limit: SoftLimitParameters,
        automatic_scale: AutomaticScaleParameters,
        rig: Rig,
    }
}
