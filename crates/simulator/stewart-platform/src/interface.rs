//! The table of variables: inputs, outputs, parameters.
//!
//! The structs here are the Rust API, and their rows are the FMU's variables. A name of the washout
//! means the same here, so that its outputs connect and both accept the same rig.

use moris_interface::units::{ANGULAR_FREQUENCY, KG, KG_M2, M, M_PER_S, M_PER_S2, N, RAD, RAD_PER_S, RAD_PER_S2, S, W};
use moris_interface::{Field, Kind, interface, interface_tree, units};
use moris_washout::Rig;
use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY};
use moris_washout::platform::{Geometry, Pose, leg_lengths};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The matrix of inertia of a body about its centre of mass, as its six
/// different elements \[kg m2\].
///
/// The fields are the elements of the matrix: off the diagonal xy is minus the integral of x y dm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inertia {
    pub xx: f64,
    pub yy: f64,
    pub zz: f64,
    pub xy: f64,
    pub xz: f64,
    pub yz: f64,
}

impl Inertia {
    /// Of a body whose axes of symmetry are those of the frame.
    pub const fn diagonal(xx: f64, yy: f64, zz: f64) -> Self {
        Inertia { xx, yy, zz, xy: 0.0, xz: 0.0, yz: 0.0 }
    }

    /// The whole matrix.
    pub fn matrix(&self) -> Matrix3<f64> {
        let Inertia { xx, yy, zz, xy, xz, yz } = *self;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

impl Field for Inertia {
    const COMPONENTS: &'static [&'static str] = &["xx", "yy", "zz", "xy", "xz", "yz"];
    const KIND: Kind = Kind::Real(&units::ONE);
    fn read(slots: &[f64]) -> Self {
        let [xx, yy, zz, xy, xz, yz] = std::array::from_fn(|i| slots[i]);
        Inertia { xx, yy, zz, xy, xz, yz }
    }
    fn write(self, slots: &mut [f64]) {
        slots.copy_from_slice(&[self.xx, self.yy, self.zz, self.xy, self.xz, self.yz]);
    }
}

interface! {
    /// Commands to the actuators, and the rider's lean.
    pub struct Input: Input, Continuous {
        /// Commanded length of the actuator, from base joint to platform joint; a length outside the stroke is rejected. Without effect with cranks.
        "command[#].length" length: [f64; 6] [M] { 0.0 ..= 200.0 } = DEFAULT_NEUTRAL_LENGTHS;
        /// Commanded rate of the actuator's length, which extrapolates the command during a communication step; 0 holds the command.
        "command[#].velocity" velocity: [f64; 6] [M_PER_S] { -100.0 ..= 100.0 } = [0.0; 6];
        /// Lean of the rider's torso relative to the mock-up, positive to the right; it moves the head.
        "rider.lean" lean: f64 [RAD] { -1.5 ..= 1.5 } = 0.0;
        /// Commanded angle of the crank's arm above its heading; an angle outside crank.minAngle to crank.maxAngle is rejected. Without effect with legs.
        "command[#].angle" angle: [f64; 6] [RAD] { -7.0 ..= 7.0 } = [0.0; 6];
        /// Commanded angular velocity of the crank's arm, which extrapolates the angle as command[#].velocity does the length.
        "command[#].angularVelocity" angular_velocity: [f64; 6] [RAD_PER_S] { -100.0 ..= 100.0 } = [0.0; 6];
    }
}

interface! {
    /// Real motion of the platform and its actuators, and the motion felt by the rider.
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
        /// Angular acceleration of the platform in the base frame.
        "platform.angularAcceleration.@" angular_acceleration: Vector3<f64> [RAD_PER_S2] = Vector3::new(0.0, 0.0, 0.0);
        /// Length of the actuator, from base joint to platform joint; with cranks, the distance from axle to platform joint.
        "actuator[#].length" length: [f64; 6] [M] = [0.0; 6], start_depends_on(&["rig."]);
        /// Rate of the actuator's length.
        "actuator[#].velocity" leg_velocity: [f64; 6] [M_PER_S] = [0.0; 6];
        /// Acceleration of the actuator's length.
        "actuator[#].acceleration" leg_acceleration: [f64; 6] [M_PER_S2] = [0.0; 6];
        /// Force of the actuator's drive along the actuator, positive where it pushes; with cranks, of the arm's end along its circle, positive upward. Within actuator.forceLimit.
        "actuator[#].force" force: [f64; 6] [N] = [0.0; 6], start_depends_on(&["gravity", "payload.", "platform.", "rider.", "rig."]);
        /// Force of the stop at an end of the actuator's stroke, positive where it pushes; in an impact its mean over an internal step.
        "actuator[#].stopForce" stop_force: [f64; 6] [N] = [0.0; 6];
        /// Total mechanical power of the actuators.
        "actuator.totalPower" total_power: f64 [W] = 0.0;
        /// Specific force at the rider's head on the real motion, in head axes.
        "rider.specificForce.@" felt_specific_force: Vector3<f64> [M_PER_S2] = Vector3::new(0.0, 0.0, 0.0), start_depends_on(&["gravity", "rider.lean"]);
        /// Angular velocity of the rider's head on the real motion, in head axes.
        "rider.angularVelocity.@" felt_angular_velocity: Vector3<f64> [RAD_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// True if a commanded length or angle was outside the stroke during the last communication step; the previous command is then kept.
        "status.commandRefused" command_refused: bool = false;
        /// True if a drive was limited by speed or acceleration, or braked ahead of an end of the stroke, during the last communication step.
        "status.driveLimited" drive_limited: bool = false;
        /// True if a drive was limited by force during the last communication step.
        "status.forceLimited" force_limited: bool = false;
        /// True if a stop at an end of the stroke held an actuator during the last communication step.
        "status.atStop" at_stop: bool = false;
        /// Smallest clearance of an actuator from either end of its stroke; with cranks, along the circle of the arm's end.
        "status.strokeMargin" stroke_margin: f64 [M] = 0.0, start_depends_on(&["actuator.", "rig."]);
        /// Angle of the crank's arm above its heading; 0 with legs.
        "actuator[#].angle" angle: [f64; 6] [RAD] = [0.0; 6], start_depends_on(&["crank.", "rig."]);
        /// Angular velocity of the crank's arm; 0 with legs.
        "actuator[#].angularVelocity" angular_rate: [f64; 6] [RAD_PER_S] = [0.0; 6];
    }
}

interface! {
    /// Response of the actuators; their limits of stroke, speed and acceleration are the rig's.
    pub struct Actuators: Parameter, Tunable {
        /// Undamped natural frequency of an actuator's response to its command; at the default damping the response is -3 dB there.
        "actuator.bandwidth" bandwidth: f64 [ANGULAR_FREQUENCY] { 0.1 ..= 1e3 } = 62.831_853_071_795_86, importance_rank(4);
        /// Damping ratio of an actuator's response.
        "actuator.damping" damping: f64 { 0.05 ..= 10.0 } = std::f64::consts::FRAC_1_SQRT_2, importance_rank(5);
        /// Dead time between a command and the drive's response.
        "actuator.deadTime" dead_time: f64 [S] { 0.0 ..= 10.0 } = 0.004, importance_rank(6);
        /// Largest force of an actuator's drive, in both directions; with cranks, the torque divided by crank.arm.
        "actuator.forceLimit" force_limit: f64 [N] { 1e-3 ..= 1e9 } = 4000.0, importance_rank(7);
    }
}

interface! {
    /// Moving masses: platform with mock-up, rider and payload, as one rigid body. The
    /// actuators are massless.
    pub struct Masses: Parameter, Tunable {
        /// Mass of the platform with the motorcycle's mock-up.
        "platform.mass" platform_mass: f64 [KG] { 1e-3 ..= 1e6 } = 250.0, importance_rank(1);
        /// Centre of mass of the platform with the mock-up, in the platform frame.
        "platform.centreOfMass.@" platform_centre: Vector3<f64> [M] { -100.0 ..= 100.0 } = Vector3::new(0.0, 0.0, 0.26);
        /// Matrix of inertia of the platform with the mock-up about its centre of mass.
        "platform.inertia.@" platform_inertia: Inertia [KG_M2] { -1e8 ..= 1e8 } = Inertia::diagonal(49.0, 89.0, 89.0);
        /// Mass of the rider; 0 without a rider.
        "rider.mass" rider_mass: f64 [KG] { 0.0 ..= 1e6 } = 80.0, importance_rank(2);
        /// Centre of mass of the upright rider, in the platform frame.
        "rider.centreOfMass.@" rider_centre: Vector3<f64> [M] { -100.0 ..= 100.0 } = Vector3::new(0.0, 0.0, 0.70);
        /// Matrix of inertia of the upright rider about the rider's centre of mass.
        "rider.inertia.@" rider_inertia: Inertia [KG_M2] { -1e8 ..= 1e8 } = Inertia::diagonal(6.0, 7.0, 3.0);
        /// Mass of a payload, as a point mass; 0 without one.
        "payload.mass" payload_mass: f64 [KG] { 0.0 ..= 1e6 } = 0.0, importance_rank(3);
        /// Position of the payload in the platform frame.
        "payload.centreOfMass.@" payload_centre: Vector3<f64> [M] { -100.0 ..= 100.0 } = Vector3::new(0.0, 0.0, 0.0);
    }
}

interface! {
    /// Gravity, the rider's head, and the solver.
    pub struct Setting: Parameter, Fixed {
        /// Magnitude of gravity.
        "gravity" gravity: f64 [M_PER_S2] { 0.1 ..= 100.0 } = STANDARD_GRAVITY;
        /// Height of the rider's head above the platform.
        "head.height" head_height: f64 [M] { 0.0 ..= 10.0 } = 1.2, importance_rank(10);
        /// Length of the torso from the seat, its lean axis, to the head.
        "head.torsoLength" torso_length: f64 [M] { 0.0 ..= 10.0 } = 0.75;
        /// Longest internal step; a longer communication step is divided.
        "solver.maxStep" max_step: f64 [S] { 1e-6 ..= 0.01 } = 0.001;
    }
}

interface_tree! {
    /// All parameters.
    pub struct Parameters {
        actuators: Actuators,
        masses: Masses,
        setting: Setting,
        rig: Rig,
    }
}

/// Lengths of the default rig's legs at neutral \[m\]: [`neutral_lengths`] as round-to-nearest
/// gives them. The lengths are written out, because a start value must not depend on how a host has
/// set the processor to round.
const DEFAULT_NEUTRAL_LENGTHS: [f64; 6] = [
    1.299_962_822_323_889_7,
    1.299_962_822_323_889_7,
    1.299_962_822_323_889_7,
    1.299_962_822_323_89,
    1.299_962_822_323_89,
    1.299_962_822_323_89,
];

/// Lengths of a rig's legs, or arcs of its cranks, at neutral \[m\].
pub fn neutral_lengths(rig: &Rig) -> [f64; 6] {
    leg_lengths(&Geometry::from(rig), &Pose::neutral(rig))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_neutral_lengths_are_the_default_rigs() {
        assert_eq!(DEFAULT_NEUTRAL_LENGTHS, neutral_lengths(&Rig::default()));
    }
}
