//! The one table of variables: what goes in, what comes out, what can be set.
//!
//! The structs here are the Rust API, and their rows are the FMU's variables. What the washout reads of a vehicle stands
//! first among the outputs, by the washout's own names, so that the two connect one to one.

use moris_interface::units::{
    ANGULAR_FREQUENCY, KG, KG_M2, KG_PER_M3, M, M_PER_S, M_PER_S2, M2, N, N_M, N_M_S_PER_RAD, N_PER_M, N_S_PER_M,
    PER_RAD, RAD, RAD_PER_S, S, W,
};
use moris_interface::{interface, interface_tree};
use moris_washout::interface::{AngularVelocityFrame, RollPitchYaw, STANDARD_GRAVITY};
use nalgebra::Vector3;

use crate::check::LARGEST_SPEED;
use crate::motorcycle::STRONGEST_WIND;

interface! {
    /// What the host's clock says.
    pub struct Clock: Independent, Continuous {
        /// Simulation time.
        "time" time: f64 [S] = 0.0;
    }
}

interface! {
    /// What the rider is told to do, and the wind.
    pub struct Input: Input, Continuous {
        /// Throttle, from 0 (closed) to 1 (full).
        "command.throttle" throttle: f64 { 0.0 ..= 1.0 } = 0.0;
        /// Brakes, from 0 (off) to 1 (as hard as they can), shared out between the wheels by brake.frontShare.
        "command.brake" brake: f64 { 0.0 ..= 1.0 } = 0.0;
        /// Roll angle that the rider steers the motorcycle to, positive to the right.
        "command.lean" lean: f64 [RAD] { -1.5 ..= 1.5 } = 0.0;
        /// Lean of the rider's torso relative to the motorcycle, positive to the right; added to what rider.bodyLeanShare makes of the commanded lean.
        "command.riderLean" rider_lean: f64 [RAD] { -1.5 ..= 1.5 } = 0.0;
        /// Force of the wind on motorcycle and rider besides the drag of still air, in axes that follow the heading (x forward, y left, z up), midway between the wheels at aero.height.
        "wind.force.@" wind: Vector3<f64> [N] { -STRONGEST_WIND ..= STRONGEST_WIND } = Vector3::new(0.0, 0.0, 0.0);
    }
}

interface! {
    /// What the washout takes in, and what else there is to see of the ride.
    pub struct Output: Output, Continuous {
        /// Specific force at the rider's head in its axes (x forward, y left, z up): what an accelerometer there reads, (0, 0, +g) at rest.
        "vehicle.specificForce.@" specific_force: Vector3<f64> [M_PER_S2] = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
        /// Angular velocity of the motorcycle, in the axes that angularVelocityFrame says.
        "vehicle.angularVelocity.@" angular_velocity: Vector3<f64> [RAD_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// Orientation of the motorcycle in the world (roll about x, pitch about y with nose down positive, yaw about z); the yaw is the heading and goes on past a full turn.
        "vehicle.orientation.@" orientation: RollPitchYaw [RAD] = RollPitchYaw::new(0.0, 0.0, 0.0);
        /// Forward speed; never negative.
        "vehicle.speed" speed: f64 [M_PER_S] = 0.0;
        /// Lean of the rider's torso relative to the motorcycle, positive to the right.
        "rider.lean" lean: f64 [RAD] = 0.0;
        /// Position in the world of the point where the rear tyre touches the road.
        "vehicle.position.@" position: Vector3<f64> [M] = Vector3::new(0.0, 0.0, 0.0);
        /// Rate of the forward speed.
        "vehicle.acceleration" acceleration: f64 [M_PER_S2] = 0.0;
        /// Velocity to the left of the point where the rear tyre touches the road.
        "vehicle.lateralVelocity" lateral_velocity: f64 [M_PER_S] = 0.0;
        /// Position in the world of the rider's head.
        "head.position.@" head_position: Vector3<f64> [M] = Vector3::new(0.0, 0.0, 0.0);
        /// Velocity in the world of the rider's head, in the world's axes.
        "head.velocity.@" head_velocity: Vector3<f64> [M_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// Steer angle about the steering axis, which points up; positive to the left.
        "steer.angle" steer_angle: f64 [RAD] = 0.0;
        /// Rate of the steer angle.
        "steer.rate" steer_rate: f64 [RAD_PER_S] = 0.0;
        /// Torque with which the rider steers, positive to the left; what holds the bars still below feet.speed is not in it.
        "steer.torque" steer_torque: f64 [N_M] = 0.0;
        /// Roll angle that the rider is steering to just now: command.lean within his limits, taken up smoothly.
        "rider.leanReference" lean_reference: f64 [RAD] = 0.0;
        /// How much feet on the road and firm hands hold the motorcycle upright: from 1 at rest to 0 from feet.speed on.
        "rider.feetDown" feet_down: f64 = 1.0;
        /// Share of the throttle that has come through to the rear wheel's force.
        "drive.throttle" throttle: f64 = 0.0;
        /// Share of the brakes that has come through to the discs.
        "brake.application" brake: f64 = 0.0;
        /// Load of the front tyre on the road.
        "tyre.front.load" front_load: f64 [N] = 0.0;
        /// Load of the rear tyre on the road.
        "tyre.rear.load" rear_load: f64 [N] = 0.0;
        /// Forward force of the road on the front tyre.
        "tyre.front.longitudinalForce" front_longitudinal: f64 [N] = 0.0;
        /// Forward force of the road on the rear tyre.
        "tyre.rear.longitudinalForce" rear_longitudinal: f64 [N] = 0.0;
        /// Force of the road on the front tyre to the left.
        "tyre.front.lateralForce" front_lateral: f64 [N] = 0.0;
        /// Force of the road on the rear tyre to the left.
        "tyre.rear.lateralForce" rear_lateral: f64 [N] = 0.0;
        /// Compression of the front suspension at the wheel, from its length at rest.
        "suspension.front.travel" front_travel: f64 [M] = 0.0;
        /// Compression of the rear suspension at the wheel, from its length at rest.
        "suspension.rear.travel" rear_travel: f64 [M] = 0.0;
        /// Whether, at the end of the last communication step, drive or brakes were held back so that no tyre slides.
        "status.frictionLimited" friction_limited: bool = false;
        /// Whether, at the end of the last communication step, drive or brakes were held back so that no wheel lifts off.
        "status.wheelLiftLimited" wheel_lift_limited: bool = false;
    }
}

interface! {
    /// Masses and geometry: the parameters of a bicycle in Meijaard et al. (2007), and a steering damper. Lengths are
    /// measured from the rear tyre's contact, x forward; heights above the road.
    pub struct Machine: Parameter, Fixed {
        /// Distance of the two tyres' contacts.
        "geometry.wheelbase" wheelbase: f64 [M] { 0.1 ..= 10.0 } = 1.448;
        /// Trail: how far the front tyre's contact is behind the point where the steering axis meets the road.
        "geometry.trail" trail: f64 [M] { -2.0 ..= 2.0 } = 0.1176;
        /// Angle of the steering axis from the vertical, leaning back.
        "geometry.casterAngle" caster_angle: f64 [RAD] { -1.0 ..= 1.2 } = 0.467_748_239_534_480_3;
        /// Radius of the rear wheel.
        "rearWheel.radius" rear_wheel_radius: f64 [M] { 0.01 ..= 2.0 } = 0.299;
        /// Mass of the rear wheel.
        "rearWheel.mass" rear_wheel_mass: f64 [KG] { 1e-3 ..= 1e3 } = 15.0;
        /// Moment of inertia of the rear wheel about a diameter.
        "rearWheel.inertia.xx" rear_wheel_xx: f64 [KG_M2] { 1e-6 ..= 1e3 } = 0.42;
        /// Moment of inertia of the rear wheel about its axle, with what of the drive turns with it.
        "rearWheel.inertia.yy" rear_wheel_yy: f64 [KG_M2] { 1e-6 ..= 1e3 } = 0.8;
        /// Distance of the rear frame's centre of mass, rider included, ahead of the rear contact.
        "frame.centre.x" frame_x: f64 [M] { 1e-3 ..= 10.0 } = 0.642;
        /// Height of the rear frame's centre of mass, rider included.
        "frame.centre.height" frame_height: f64 [M] { 1e-3 ..= 10.0 } = 0.669;
        /// Mass of the rear frame with engine and rider.
        "frame.mass" frame_mass: f64 [KG] { 1e-3 ..= 1e4 } = 221.0;
        /// Moment of inertia of the rear frame about its centre of mass, about the axis forward.
        "frame.inertia.xx" frame_xx: f64 [KG_M2] { 1e-6 ..= 1e5 } = 29.7;
        /// Moment of inertia of the rear frame about its centre of mass, about the axis to the left: of pitch.
        "frame.inertia.yy" frame_yy: f64 [KG_M2] { 1e-6 ..= 1e5 } = 48.0;
        /// Moment of inertia of the rear frame about its centre of mass, about the axis upwards.
        "frame.inertia.zz" frame_zz: f64 [KG_M2] { 1e-6 ..= 1e5 } = 37.5;
        /// Product of inertia of the rear frame, minus the integral of x z dm about its centre of mass, x forward and z up.
        "frame.inertia.xz" frame_xz: f64 [KG_M2] { -1e5 ..= 1e5 } = 2.8;
        /// Distance of the front assembly's centre of mass (fork and bars, without the wheel) ahead of the rear contact.
        "fork.centre.x" fork_x: f64 [M] { -10.0 ..= 10.0 } = 1.205;
        /// Height of the front assembly's centre of mass.
        "fork.centre.height" fork_height: f64 [M] { 1e-3 ..= 10.0 } = 0.767;
        /// Mass of the front assembly.
        "fork.mass" fork_mass: f64 [KG] { 1e-3 ..= 1e3 } = 22.0;
        /// Moment of inertia of the front assembly about its centre of mass, about the axis forward.
        "fork.inertia.xx" fork_xx: f64 [KG_M2] { 1e-6 ..= 1e4 } = 1.3;
        /// Moment of inertia of the front assembly about its centre of mass, about the axis upwards.
        "fork.inertia.zz" fork_zz: f64 [KG_M2] { 1e-6 ..= 1e4 } = 0.71;
        /// Product of inertia of the front assembly, minus the integral of x z dm about its centre of mass, x forward and z up.
        "fork.inertia.xz" fork_xz: f64 [KG_M2] { -1e4 ..= 1e4 } = 0.4;
        /// Radius of the front wheel.
        "frontWheel.radius" front_wheel_radius: f64 [M] { 0.01 ..= 2.0 } = 0.294;
        /// Mass of the front wheel.
        "frontWheel.mass" front_wheel_mass: f64 [KG] { 1e-3 ..= 1e3 } = 12.0;
        /// Moment of inertia of the front wheel about a diameter.
        "frontWheel.inertia.xx" front_wheel_xx: f64 [KG_M2] { 1e-6 ..= 1e3 } = 0.32;
        /// Moment of inertia of the front wheel about its axle.
        "frontWheel.inertia.yy" front_wheel_yy: f64 [KG_M2] { 1e-6 ..= 1e3 } = 0.6;
        /// Steering damper: torque for a rate of steer.
        "steer.damping" steer_damping: f64 [N_M_S_PER_RAD] { 0.0 ..= 1e4 } = 7.4;
        /// Largest steer angle that the rider asks for.
        "steer.lock" steer_lock: f64 [RAD] { 1e-3 ..= 1.5 } = 0.5;
    }
}

interface! {
    /// The tyres, by their load at rest.
    pub struct Tyres: Parameter, Fixed {
        /// Lateral force for a small slip angle of the front tyre, divided by its load.
        "tyre.front.corneringStiffness" front_cornering: f64 [PER_RAD] { 0.1 ..= 1e3 } = 16.0;
        /// Lateral force for a small camber angle of the front tyre, divided by its load.
        "tyre.front.camberStiffness" front_camber: f64 [PER_RAD] { 0.0 ..= 100.0 } = 0.85;
        /// Distance that the front tyre rolls while its lateral force builds up.
        "tyre.front.relaxationLength" front_relaxation: f64 [M] { 1e-4 ..= 10.0 } = 0.126;
        /// Lateral force for a small slip angle of the rear tyre, divided by its load.
        "tyre.rear.corneringStiffness" rear_cornering: f64 [PER_RAD] { 0.1 ..= 1e3 } = 14.5;
        /// Lateral force for a small camber angle of the rear tyre, divided by its load.
        "tyre.rear.camberStiffness" rear_camber: f64 [PER_RAD] { 0.0 ..= 100.0 } = 0.95;
        /// Distance that the rear tyre rolls while its lateral force builds up.
        "tyre.rear.relaxationLength" rear_relaxation: f64 [M] { 1e-4 ..= 10.0 } = 0.144;
        /// Friction of the tyres on the road: the largest force along the road divided by the load.
        "tyre.friction" friction: f64 { 0.05 ..= 3.0 } = 1.2;
        /// Rolling resistance divided by the load.
        "tyre.rollingResistance" rolling_resistance: f64 { 0.0 ..= 1.0 } = 0.018;
    }
}

interface! {
    /// Drive, brakes and air.
    pub struct Longitudinal: Parameter, Fixed {
        /// Largest power at the rear wheel.
        "drive.power" power: f64 [W] { 1.0 ..= 1e7 } = 85e3;
        /// Largest force at the rear wheel, in the lowest gear.
        "drive.forceLimit" drive_force: f64 [N] { 1.0 ..= 1e6 } = 3500.0;
        /// Drag of the engine at the rear wheel with the throttle closed.
        "drive.engineBraking" engine_braking: f64 [N] { 0.0 ..= 1e5 } = 150.0;
        /// Time constant with which the drive follows the throttle.
        "drive.timeConstant" drive_time: f64 [S] { 1e-3 ..= 100.0 } = 0.15;
        /// Force of both brakes together when fully applied.
        "brake.forceLimit" brake_force: f64 [N] { 0.0 ..= 1e6 } = 3000.0;
        /// Share of the front brake in it.
        "brake.frontShare" brake_front_share: f64 { 0.0 ..= 1.0 } = 0.7;
        /// Time constant with which the brakes follow the lever.
        "brake.timeConstant" brake_time: f64 [S] { 1e-3 ..= 100.0 } = 0.1;
        /// Share of the weight that drive and brakes always leave on either wheel.
        "wheelLift.reserve" lift_reserve: f64 { 0.0 ..= 0.3 } = 0.05;
        /// Drag coefficient times frontal area.
        "aero.dragArea" drag_area: f64 [M2] { 1e-6 ..= 100.0 } = 0.467;
        /// Density of the air.
        "aero.density" air_density: f64 [KG_PER_M3] { 1e-6 ..= 100.0 } = 1.2;
        /// Height of the point at which drag and wind act.
        "aero.height" aero_height: f64 [M] { 0.0 ..= 3.0 } = 0.582;
    }
}

interface! {
    /// The suspension, as springs and dampers upright at the wheels.
    pub struct Suspension: Parameter, Fixed {
        /// Stiffness of the front suspension at the wheel.
        "suspension.front.stiffness" front_stiffness: f64 [N_PER_M] { 1.0 ..= 1e7 } = 9e3;
        /// Damping of the front suspension at the wheel.
        "suspension.front.damping" front_damping: f64 [N_S_PER_M] { 0.0 ..= 1e7 } = 550.0;
        /// Stiffness of the rear suspension at the wheel.
        "suspension.rear.stiffness" rear_stiffness: f64 [N_PER_M] { 1.0 ..= 1e7 } = 25.7e3;
        /// Damping of the rear suspension at the wheel.
        "suspension.rear.damping" rear_damping: f64 [N_S_PER_M] { 0.0 ..= 1e7 } = 1100.0;
    }
}

interface! {
    /// The rider: his limits, how he follows a lean, his torso and his head.
    pub struct Rider: Parameter, Fixed {
        /// Largest roll angle that the rider steers to.
        "rider.leanLimit" lean_limit: f64 [RAD] { 1e-3 ..= 1.2 } = 0.698_131_700_797_731_8;
        /// Natural frequency with which the rider takes up a commanded lean.
        "rider.leanFrequency" lean_frequency: f64 [ANGULAR_FREQUENCY] { 0.1 ..= 50.0 } = 4.0;
        /// Largest rate of roll that the rider asks for.
        "rider.leanRateLimit" lean_rate_limit: f64 [RAD_PER_S] { 1e-3 ..= 10.0 } = 0.8;
        /// Torque on the bars that the rider spares as much as an error of 0.1 rad of lean: small is firm, large is gentle.
        "rider.torqueWeight" torque_weight: f64 [N_M] { 1e-3 ..= 1e6 } = 30.0;
        /// Lean of the rider's torso as a share of the lean that he steers to.
        "rider.bodyLeanShare" body_lean_share: f64 { -1.0 ..= 1.0 } = 0.1;
        /// Natural frequency with which the rider's torso takes up its lean.
        "rider.bodyLeanFrequency" body_lean_frequency: f64 [ANGULAR_FREQUENCY] { 0.1 ..= 50.0 } = 8.0;
        /// Largest lean of the rider's torso relative to the motorcycle.
        "rider.bodyLeanLimit" body_lean_limit: f64 [RAD] { 0.0 ..= 1.5 } = 0.35;
        /// Mass of the torso that leans, with head and arms; part of frame.mass.
        "rider.torsoMass" torso_mass: f64 [KG] { 0.0 ..= 1e3 } = 44.5;
        /// Distance of the torso's centre of mass from the seat, about which it leans.
        "rider.torsoCentre" torso_centre: f64 [M] { 0.0 ..= 3.0 } = 0.4;
        /// Moment of inertia of the torso about its centre of mass, about the axis forward.
        "rider.torsoInertia" torso_inertia: f64 [KG_M2] { 0.0 ..= 100.0 } = 1.3;
        /// Speed below which feet on the road and firm hands hold the motorcycle upright, the more the slower.
        "feet.speed" feet_speed: f64 [M_PER_S] { 0.5 ..= 10.0 } = 3.0;
        /// Distance of the rider's head ahead of the rear contact.
        "head.x" head_x: f64 [M] { -5.0 ..= 5.0 } = 0.65;
        /// Height of the rider's head above the road.
        "head.height" head_height: f64 [M] { 1e-3 ..= 5.0 } = 1.5;
        /// Length of the torso from seat to head, about whose lower end the rider leans.
        "head.torsoLength" torso_length: f64 [M] { 0.0 ..= 5.0 } = 0.75;
    }
}

interface! {
    /// Where the ride begins, and how it is computed.
    pub struct Run: Parameter, Fixed {
        /// Magnitude of gravity.
        "gravity" gravity: f64 [M_PER_S2] { 0.1 ..= 100.0 } = STANDARD_GRAVITY;
        /// The axes of vehicle.angularVelocity, the same as in the washout.
        "angularVelocityFrame" angular_velocity_frame: AngularVelocityFrame = AngularVelocityFrame::World;
        /// Speed at the beginning.
        "initial.speed" initial_speed: f64 [M_PER_S] { 0.0 ..= LARGEST_SPEED } = 0.0;
        /// Heading at the beginning.
        "initial.heading" initial_heading: f64 [RAD] { -1e6 ..= 1e6 } = 0.0;
        /// Longest internal step; a longer communication step is divided.
        "solver.maxStep" max_step: f64 [S] { 1e-6 ..= 0.01 } = 0.001;
    }
}

interface_tree! {
    /// Everything that can be set.
    pub struct Parameters {
        machine: Machine,
        tyres: Tyres,
        longitudinal: Longitudinal,
        suspension: Suspension,
        rider: Rider,
        run: Run,
    }
}
