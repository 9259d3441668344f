//! The one table of variables: what goes in, what comes out, what can be set.
//!
//! The structs here are the Rust API, and their rows are the FMU's variables. Names that the washout has too mean the
//! same here, so that its outputs connect and its rig can be given to both.

use moris_interface::units::{ANGULAR_FREQUENCY, KG, KG_M2, M, M_PER_S, M_PER_S2, N, RAD, RAD_PER_S, RAD_PER_S2, S, W};
use moris_interface::{Field, Kind, interface, interface_tree, units};
use moris_washout::Rig;
use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY};
use moris_washout::platform::{Geometry, Pose, leg_lengths};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The matrix of inertia of a body about its centre of mass, as its six different elements \[kg m2\].
///
/// They are the elements of the matrix: off the diagonal xy is minus the integral of x y dm.
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
    /// What the host's clock says.
    pub struct Clock: Independent, Continuous {
        /// Simulation time.
        "time" time: f64 [S] = 0.0;
    }
}

interface! {
    /// What the platform is told, and what the rider does on it.
    pub struct Input: Input, Continuous {
        /// Commanded length of the actuator, from base joint to platform joint; one outside its stroke is refused.
        "command[#].length" length: [f64; 6] [M] { 0.0 ..= 200.0 } = DEFAULT_NEUTRAL_LENGTHS;
        /// Commanded rate of the actuator's length: by it the command goes on during a communication step. It may stay 0; the command is then held.
        "command[#].velocity" velocity: [f64; 6] [M_PER_S] { -100.0 ..= 100.0 } = [0.0; 6];
        /// Lean of the rider's torso relative to the mock-up, positive to the right; it moves his head.
        "rider.lean" lean: f64 [RAD] { -1.5 ..= 1.5 } = 0.0;
    }
}

interface! {
    /// What the platform and its actuators really do, and what the rider feels on it.
    pub struct Output: Output, Continuous {
        /// Position of the platform frame's origin in the base frame.
        "platform.position.@" position: Vector3<f64> [M] = Vector3::new(0.0, 0.0, 0.0);
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
        /// Length of the actuator, from base joint to platform joint.
        "actuator[#].length" length: [f64; 6] [M] = [0.0; 6];
        /// Rate of the actuator's length.
        "actuator[#].velocity" leg_velocity: [f64; 6] [M_PER_S] = [0.0; 6];
        /// Acceleration of the actuator's length.
        "actuator[#].acceleration" leg_acceleration: [f64; 6] [M_PER_S2] = [0.0; 6];
        /// Force of the actuator's drive along the actuator, positive where it pushes; within actuator.forceLimit.
        "actuator[#].force" force: [f64; 6] [N] = [0.0; 6];
        /// Force of the stop at an end of the actuator's stroke, positive where it pushes; of an impact the mean over an internal step.
        "actuator[#].stopForce" stop_force: [f64; 6] [N] = [0.0; 6];
        /// Mechanical power that all actuators together deliver.
        "actuator.totalPower" total_power: f64 [W] = 0.0;
        /// Specific force that the rider feels at his head on the real motion, in head axes.
        "rider.specificForce.@" felt_specific_force: Vector3<f64> [M_PER_S2] = Vector3::new(0.0, 0.0, 0.0);
        /// Angular velocity that the rider feels on the real motion, in head axes.
        "rider.angularVelocity.@" felt_angular_velocity: Vector3<f64> [RAD_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// Whether, during the last communication step, a commanded length was one that no actuator can have; the one before it stayed.
        "status.commandRefused" command_refused: bool = false;
        /// Whether, during the last communication step, a drive kept its actuator to its speed or acceleration limit, or braked it ahead of an end of its stroke.
        "status.driveLimited" drive_limited: bool = false;
        /// Whether, during the last communication step, a drive had not the force to follow its command.
        "status.forceLimited" force_limited: bool = false;
        /// Whether, during the last communication step, an actuator was held by a stop at an end of its stroke.
        "status.atStop" at_stop: bool = false;
        /// Smallest distance of an actuator from either end of its stroke.
        "status.strokeMargin" stroke_margin: f64 [M] = 0.0;
    }
}

interface! {
    /// How each actuator follows its command; its stroke, speed and acceleration limits are the rig's.
    pub struct Actuators: Parameter, Fixed {
        /// Undamped natural frequency of an actuator's response to its command; at the default damping 3 dB are lost there.
        "actuator.bandwidth" bandwidth: f64 [ANGULAR_FREQUENCY] { 0.1 ..= 1e3 } = 62.831_853_071_795_86;
        /// Damping ratio of an actuator's response.
        "actuator.damping" damping: f64 { 0.05 ..= 10.0 } = std::f64::consts::FRAC_1_SQRT_2;
        /// Time that passes before an actuator's drive sees a command.
        "actuator.deadTime" dead_time: f64 [S] { 0.0 ..= 10.0 } = 0.004;
        /// Largest force of an actuator's drive, either way.
        "actuator.forceLimit" force_limit: f64 [N] { 1e-3 ..= 1e9 } = 4000.0;
    }
}

interface! {
    /// What moves: the platform with the mock-up, the rider, and a payload, together one rigid body. The actuators have no mass of their own.
    pub struct Masses: Parameter, Fixed {
        /// Mass of the platform with the motorcycle's mock-up.
        "platform.mass" platform_mass: f64 [KG] { 1e-3 ..= 1e6 } = 250.0;
        /// Centre of mass of the platform with the mock-up, in the platform frame.
        "platform.centreOfMass.@" platform_centre: Vector3<f64> [M] { -100.0 ..= 100.0 } = Vector3::new(0.0, 0.0, 0.26);
        /// Matrix of inertia of the platform with the mock-up about its centre of mass.
        "platform.inertia.@" platform_inertia: Inertia [KG_M2] { -1e8 ..= 1e8 } = Inertia::diagonal(49.0, 89.0, 89.0);
        /// Mass of the rider; 0 where there is none.
        "rider.mass" rider_mass: f64 [KG] { 0.0 ..= 1e6 } = 80.0;
        /// Centre of mass of the upright rider, in the platform frame.
        "rider.centreOfMass.@" rider_centre: Vector3<f64> [M] { -100.0 ..= 100.0 } = Vector3::new(0.0, 0.0, 0.70);
        /// Matrix of inertia of the upright rider about his centre of mass.
        "rider.inertia.@" rider_inertia: Inertia [KG_M2] { -1e8 ..= 1e8 } = Inertia::diagonal(6.0, 7.0, 3.0);
        /// Mass of a payload, taken as a point; 0 where there is none.
        "payload.mass" payload_mass: f64 [KG] { 0.0 ..= 1e6 } = 0.0;
        /// Where the payload is, in the platform frame.
        "payload.centreOfMass.@" payload_centre: Vector3<f64> [M] { -100.0 ..= 100.0 } = Vector3::new(0.0, 0.0, 0.0);
    }
}

interface! {
    /// Where the platform is, who is on it, and how it is computed.
    pub struct Setting: Parameter, Fixed {
        /// Magnitude of gravity.
        "gravity" gravity: f64 [M_PER_S2] { 0.1 ..= 100.0 } = STANDARD_GRAVITY;
        /// Height of the rider's head above the platform.
        "head.height" head_height: f64 [M] { 0.0 ..= 10.0 } = 1.2;
        /// Length of the torso from seat to head, about whose lower end the rider leans.
        "head.torsoLength" torso_length: f64 [M] { 0.0 ..= 10.0 } = 0.75;
        /// Longest internal step; a longer communication step is divided.
        "solver.maxStep" max_step: f64 [S] { 1e-6 ..= 0.01 } = 0.001;
    }
}

interface_tree! {
    /// Everything that can be set. All of it is fixed once initialised.
    pub struct Parameters {
        actuators: Actuators,
        masses: Masses,
        setting: Setting,
        rig: Rig,
    }
}

/// Lengths of the default rig's legs at neutral \[m\]: [`neutral_lengths`] as round-to-nearest gives them. They are written
/// out, because a start value must not depend on how a host has set the processor to round.
const DEFAULT_NEUTRAL_LENGTHS: [f64; 6] = [
    1.299_962_822_323_889_7,
    1.299_962_822_323_889_7,
    1.299_962_822_323_889_7,
    1.299_962_822_323_89,
    1.299_962_822_323_89,
    1.299_962_822_323_89,
];

/// Lengths of a rig's legs at neutral \[m\].
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
