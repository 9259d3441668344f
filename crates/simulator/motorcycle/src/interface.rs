//! The table of variables: inputs, outputs, parameters.
//!
//! The structs here are the Rust API, and their rows are the FMU's variables. The inputs
//! of the washout stand first among the outputs, under the washout's names, so that the
//! two connect one to one.

use moris_interface::units::{
    ANGULAR_FREQUENCY, KG, KG_M2, KG_PER_M3, M, M_PER_S, M_PER_S2, M2, N, N_M, N_M_S_PER_RAD, N_PER_M, N_S_PER_M,
    PER_M, PER_RAD, RAD, RAD_PER_S, S, W,
};
use moris_interface::{enumeration, interface, interface_tree};
use moris_washout::interface::{AngularVelocityFrame, PREVIEW_SAMPLES, RollPitchYaw, STANDARD_GRAVITY};
use nalgebra::{ArrayStorage, RowSVector, Vector3};

/// Limit of the wind force along each axis \[N\]: about that of 30 m/s from the side.
pub const STRONGEST_WIND: f64 = 600.0;

/// Largest speed for which the rider is designed \[m/s\].
pub const LARGEST_SPEED: f64 = 150.0;

interface! {
    /// Commands to the rider, and the wind.
    pub struct Input: Input, Continuous {
        /// Throttle, from 0 (closed) to 1 (full).
        "command.throttle" throttle: f64 { 0.0 ..= 1.0 } = 0.0;
        /// Brakes, from 0 (off) to 1 (full); brake.frontShare divides them between the wheels.
        "command.brake" brake: f64 { 0.0 ..= 1.0 } = 0.0;
        /// Commanded roll angle of the motorcycle, positive to the right.
        "command.lean" lean: f64 [RAD] { -1.5 ..= 1.5 } = 0.0;
        /// Lean of the rider's torso relative to the motorcycle, positive to the right; added to rider.bodyLeanShare times the commanded roll angle.
        "command.riderLean" rider_lean: f64 [RAD] { -1.5 ..= 1.5 } = 0.0;
        /// Wind force on motorcycle and rider in addition to the drag of still air, in heading axes (x forward, y left, z up); acts midway between the wheels at aero.height.
        "wind.force.@" wind: Vector3<f64> [N] { -STRONGEST_WIND ..= STRONGEST_WIND } = Vector3::new(0.0, 0.0, 0.0);
    }
}

/// Beginnings of the names of what forces depend on before the first step: all
/// but paths and frames.
const DYNAMICS_PREFIXES: &[&str] = &[
    "aero.",
    "brake.",
    "command.",
    "drive.",
    "fork.",
    "frame.",
    "frontWheel.",
    "geometry.",
    "gravity",
    "head.",
    "initial.",
    "rearWheel.",
    "rider.",
    "steer.",
    "suspension.",
    "tyre.",
    "wheelLift.",
    "wind.",
];

interface! {
    /// Inputs of the washout, and further quantities of the simulation.
    pub struct Output: Output, Continuous, start_depends_on(&[]) {
        /// Specific force at the rider's head in head axes (x forward, y left, z up), as an accelerometer measures it: (0, 0, +g) at rest.
        "vehicle.specificForce.@" specific_force: Vector3<f64> [M_PER_S2] = Vector3::new(0.0, 0.0, STANDARD_GRAVITY), start_depends_on(DYNAMICS_PREFIXES);
        /// Angular velocity of the motorcycle, in the axes given by angularVelocityFrame.
        "vehicle.angularVelocity.@" angular_velocity: Vector3<f64> [RAD_PER_S] = Vector3::new(0.0, 0.0, 0.0);
        /// Orientation of the motorcycle in the world (roll about x, pitch about y with nose down positive, yaw about z); yaw is the heading and does not wrap.
        "vehicle.orientation.@" orientation: RollPitchYaw [RAD] = RollPitchYaw::new(0.0, 0.0, 0.0), start_depends_on(&["initial."]);
        /// Forward speed; never negative.
        "vehicle.speed" speed: f64 [M_PER_S] = 0.0, start_depends_on(&["initial."]);
        /// Lean of the rider's torso relative to the motorcycle, positive to the right.
        "rider.lean" lean: f64 [RAD] = 0.0;
        /// Position in the world of the point where the rear tyre touches the road.
        "vehicle.position.@" position: Vector3<f64> [M] = Vector3::new(0.0, 0.0, 0.0);
        /// Rate of the forward speed.
        "vehicle.acceleration" acceleration: f64 [M_PER_S2] = 0.0, start_depends_on(DYNAMICS_PREFIXES);
        /// Velocity to the left of the point where the rear tyre touches the road.
        "vehicle.lateralVelocity" lateral_velocity: f64 [M_PER_S] = 0.0;
        /// Position in the world of the rider's head.
        "head.position.@" head_position: Vector3<f64> [M] = Vector3::new(0.0, 0.0, 0.0), start_depends_on(DYNAMICS_PREFIXES);
        /// Velocity in the world of the rider's head, in the world's axes.
        "head.velocity.@" head_velocity: Vector3<f64> [M_PER_S] = Vector3::new(0.0, 0.0, 0.0), start_depends_on(&["head.", "initial."]);
        /// Steer angle about the steering axis, which points up; positive to the left.
        "steer.angle" steer_angle: f64 [RAD] = 0.0;
        /// Rate of the steer angle.
        "steer.rate" steer_rate: f64 [RAD_PER_S] = 0.0;
        /// Steering torque of the rider, positive to the left; without the torque that holds the bars below feet.speed.
        "steer.torque" steer_torque: f64 [N_M] = 0.0;
        /// Reference roll angle of the rider: command.lean within the rider's limits, low-pass filtered.
        "rider.leanReference" lean_reference: f64 [RAD] = 0.0;
        /// Support by feet on the road and firm hands: 1 at rest, 0 from feet.speed on.
        "rider.feetDown" feet_down: f64 = 1.0, start_depends_on(&["feet.", "initial."]);
        /// Throttle after the lag of the drive, from 0 to 1.
        "drive.throttle" throttle: f64 = 0.0;
        /// Brake application after the lag of the brakes, from 0 to 1.
        "brake.application" brake: f64 = 0.0;
        /// Load of the front tyre on the road.
        "tyre.front.load" front_load: f64 [N] = 0.0, start_depends_on(DYNAMICS_PREFIXES);
        /// Load of the rear tyre on the road.
        "tyre.rear.load" rear_load: f64 [N] = 0.0, start_depends_on(DYNAMICS_PREFIXES);
        /// Forward force of the road on the front tyre.
        "tyre.front.longitudinalForce" front_longitudinal: f64 [N] = 0.0, start_depends_on(DYNAMICS_PREFIXES);
        /// Forward force of the road on the rear tyre.
        "tyre.rear.longitudinalForce" rear_longitudinal: f64 [N] = 0.0, start_depends_on(DYNAMICS_PREFIXES);
        /// Force of the road on the front tyre to the left.
        "tyre.front.lateralForce" front_lateral: f64 [N] = 0.0;
        /// Force of the road on the rear tyre to the left.
        "tyre.rear.lateralForce" rear_lateral: f64 [N] = 0.0;
        /// Compression of the front suspension at the wheel, from its length at rest.
        "suspension.front.travel" front_travel: f64 [M] = 0.0;
        /// Compression of the rear suspension at the wheel, from its length at rest.
        "suspension.rear.travel" rear_travel: f64 [M] = 0.0;
        /// True if tyre friction limited drive or brakes at the end of the last communication step.
        "status.frictionLimited" friction_limited: bool = false, start_depends_on(DYNAMICS_PREFIXES);
        /// True if wheel lift limited drive or brakes at the end of the last communication step.
        "status.wheelLiftLimited" wheel_lift_limited: bool = false, start_depends_on(DYNAMICS_PREFIXES);
        /// Distance covered along the path, including all laps.
        "path.distance" path_distance: f64 [M] = 0.0;
        /// Deviation of the rear tyre's contact from the path, positive to the left.
        "path.deviation" path_deviation: f64 [M] = 0.0;
        /// Heading relative to the path's, positive to the left.
        "path.headingDeviation" path_heading: f64 [RAD] = 0.0;
        /// Speed that the rider plans for this point of the path.
        "path.plannedSpeed" planned_speed: f64 [M_PER_S] = 0.0, start_depends_on(&["gravity", "initial.", "path.", "rider.", "tyre."]);
        /// True if friction limited the lateral force of a tyre at the end of the last communication step; only on a path.
        "status.gripLimited" grip_limited: bool = false;
        /// True once the motorcycle has left the path by more than path.halfWidth; the rider then brakes to a stop.
        "status.offPath" off_path: bool = false;
        /// True once the motorcycle has fallen, by too much roll or slip, and slides to a stop.
        "status.fallen" fallen: bool = false;
        /// Number of elements of vehicle.preview.specificForce in use; 0 without a path.
        "vehicle.preview.count" preview_count: i32 { 0 ..= 20 } = 0;
        /// Time from one element of the preview to the next; the first is as far ahead of the present outputs.
        "vehicle.preview.step" preview_step: f64 [S] = 0.2;
        /// Future specific force along the head's x axis, defined as vehicle.specificForce.x is.
        "vehicle.preview.specificForce.x[#]" preview_surge: [f64; PREVIEW_SAMPLES] [M_PER_S2] = [0.0; PREVIEW_SAMPLES];
        /// Future specific force along the head's y axis, defined as vehicle.specificForce.y is.
        "vehicle.preview.specificForce.y[#]" preview_sway: [f64; PREVIEW_SAMPLES] [M_PER_S2] = [0.0; PREVIEW_SAMPLES];
    }
}

enumeration! {
    /// Path that the rider follows.
    pub enum Course {
        /// None: the rider obeys command.throttle, command.brake and command.lean.
        "none" None,
        /// The table path.point.
        "custom" Custom,
        /// A change of lane by 3.5 m at 20 m/s.
        "lane_change" LaneChange,
        /// A slalom with a period of 60 m at 15 m/s.
        "slalom" Slalom,
        /// A bend of 180 degrees with a radius of 12 m between straights of 150 m.
        "hairpin" Hairpin,
        /// A closed circuit of 1634 m with eight bends, repeated endlessly.
        "lap" Lap,
    }
}

/// Most rows of a path.
pub const PATH_POINTS: usize = 64;

/// A column of a path's table.
pub type PathColumn = RowSVector<f64, PATH_POINTS>;

const NO_ROWS: PathColumn = PathColumn::from_array_storage(ArrayStorage([[0.0]; PATH_POINTS]));

interface! {
    /// Masses and geometry: the parameters of a bicycle in Meijaard et al. (2007), and a
    /// steering damper. Lengths are measured from the rear tyre's contact, x forward;
    /// heights above the road.
    pub struct BicycleParameters: Parameter, Fixed {
        /// Distance between the two tyre contacts.
        "geometry.wheelbase" wheelbase: f64 [M] { 0.1 ..= 10.0 } = 1.448;
        /// Trail: distance of the front tyre contact behind the intersection of steering axis and road.
        "geometry.trail" trail: f64 [M] { -2.0 ..= 2.0 } = 0.1176;
        /// Caster angle: angle of the steering axis from the vertical, leaning back.
        "geometry.casterAngle" caster_angle: f64 [RAD] { -1.0 ..= 1.2 } = 0.467_748_239_534_480_3;
        /// Radius of the rear wheel.
        "rearWheel.radius" rear_wheel_radius: f64 [M] { 0.01 ..= 2.0 } = 0.299;
        /// Mass of the rear wheel.
        "rearWheel.mass" rear_wheel_mass: f64 [KG] { 1e-3 ..= 1e3 } = 15.0;
        /// Moment of inertia of the rear wheel about a diameter.
        "rearWheel.inertia.xx" rear_wheel_xx: f64 [KG_M2] { 1e-6 ..= 1e3 } = 0.42;
        /// Moment of inertia of the rear wheel about its axle, rotating parts of the drive included.
        "rearWheel.inertia.yy" rear_wheel_yy: f64 [KG_M2] { 1e-6 ..= 1e3 } = 0.8;
        /// Distance of the rear frame's centre of mass, rider included, ahead of the rear contact.
        "frame.centre.x" frame_x: f64 [M] { 1e-3 ..= 10.0 } = 0.642;
        /// Height of the rear frame's centre of mass, rider included.
        "frame.centre.height" frame_height: f64 [M] { 1e-3 ..= 10.0 } = 0.669;
        /// Mass of the rear frame with engine and rider.
        "frame.mass" frame_mass: f64 [KG] { 1e-3 ..= 1e4 } = 221.0, importance_rank(10);
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
        /// Steering damper: torque divided by the rate of the steer angle.
        "steer.damping" steer_damping: f64 [N_M_S_PER_RAD] { 0.0 ..= 1e4 } = 7.4;
        /// Largest steer angle commanded by the rider.
        "steer.lock" steer_lock: f64 [RAD] { 1e-3 ..= 1.5 } = 0.5;
    }
}

interface! {
    /// The tyres; forces relative to the load at rest.
    pub struct Tyres: Parameter, Fixed {
        /// Lateral force for a small slip angle of the front tyre, divided by its load.
        "tyre.front.corneringStiffness" front_cornering: f64 [PER_RAD] { 0.1 ..= 1e3 } = 16.0;
        /// Lateral force for a small camber angle of the front tyre, divided by its load.
        "tyre.front.camberStiffness" front_camber: f64 [PER_RAD] { 0.0 ..= 100.0 } = 0.85;
        /// Relaxation length of the front tyre.
        "tyre.front.relaxationLength" front_relaxation: f64 [M] { 1e-4 ..= 10.0 } = 0.126;
        /// Lateral force for a small slip angle of the rear tyre, divided by its load.
        "tyre.rear.corneringStiffness" rear_cornering: f64 [PER_RAD] { 0.1 ..= 1e3 } = 14.5;
        /// Lateral force for a small camber angle of the rear tyre, divided by its load.
        "tyre.rear.camberStiffness" rear_camber: f64 [PER_RAD] { 0.0 ..= 100.0 } = 0.95;
        /// Relaxation length of the rear tyre.
        "tyre.rear.relaxationLength" rear_relaxation: f64 [M] { 1e-4 ..= 10.0 } = 0.144;
        /// Friction of the tyres on the road: the largest force along the road divided by the load.
        Tunable "tyre.friction" friction: f64 { 0.05 ..= 3.0 } = 1.2, importance_rank(7);
        /// Rolling resistance divided by the load.
        Tunable "tyre.rollingResistance" rolling_resistance: f64 { 0.0 ..= 1.0 } = 0.018;
    }
}

interface! {
    /// Drive, brakes and air.
    pub struct Longitudinal: Parameter, Tunable {
        /// Largest power at the rear wheel.
        "drive.power" power: f64 [W] { 1.0 ..= 1e7 } = 85e3, importance_rank(2);
        /// Largest force at the rear wheel, in the lowest gear.
        "drive.forceLimit" drive_force: f64 [N] { 1.0 ..= 1e6 } = 3500.0, importance_rank(3);
        /// Drag of the engine at the rear wheel with the throttle closed.
        "drive.engineBraking" engine_braking: f64 [N] { 0.0 ..= 1e5 } = 150.0;
        /// Time constant with which the drive follows the throttle.
        "drive.timeConstant" drive_time: f64 [S] { 1e-3 ..= 100.0 } = 0.15;
        /// Force of both brakes together when fully applied.
        "brake.forceLimit" brake_force: f64 [N] { 0.0 ..= 1e6 } = 3000.0, importance_rank(4);
        /// Fraction of the front brake in brake.forceLimit.
        "brake.frontShare" brake_front_share: f64 { 0.0 ..= 1.0 } = 0.7, importance_rank(5);
        /// Time constant with which the brakes follow the lever.
        "brake.timeConstant" brake_time: f64 [S] { 1e-3 ..= 100.0 } = 0.1;
        /// Fraction of the weight that drive and brakes leave on either wheel.
        "wheelLift.reserve" lift_reserve: f64 { 0.0 ..= 0.3 } = 0.05;
        /// Drag coefficient times frontal area.
        "aero.dragArea" drag_area: f64 [M2] { 1e-6 ..= 100.0 } = 0.467, importance_rank(6);
        /// Density of the air.
        "aero.density" air_density: f64 [KG_PER_M3] { 1e-6 ..= 100.0 } = 1.2;
        /// Height of the point at which drag and wind act.
        Fixed "aero.height" aero_height: f64 [M] { 0.0 ..= 3.0 } = 0.582;
    }
}

interface! {
    /// The suspension, as springs and dampers upright at the wheels.
    pub struct Suspension: Parameter, Fixed {
        /// Stiffness of the front suspension at the wheel.
        "suspension.front.stiffness" front_stiffness: f64 [N_PER_M] { 1.0 ..= 1e7 } = 9e3;
        /// Damping of the front suspension at the wheel.
        Tunable "suspension.front.damping" front_damping: f64 [N_S_PER_M] { 0.0 ..= 1e7 } = 550.0;
        /// Stiffness of the rear suspension at the wheel.
        "suspension.rear.stiffness" rear_stiffness: f64 [N_PER_M] { 1.0 ..= 1e7 } = 25.7e3;
        /// Damping of the rear suspension at the wheel.
        Tunable "suspension.rear.damping" rear_damping: f64 [N_S_PER_M] { 0.0 ..= 1e7 } = 1100.0;
    }
}

interface! {
    /// The rider: limits, lean control, torso and head.
    pub struct Rider: Parameter, Fixed {
        /// Largest reference roll angle of the rider.
        Tunable "rider.leanLimit" lean_limit: f64 [RAD] { 1e-3 ..= 1.2 } = 0.698_131_700_797_731_8, importance_rank(8);
        /// Natural frequency of the rider's reference filter for a commanded roll angle.
        Tunable "rider.leanFrequency" lean_frequency: f64 [ANGULAR_FREQUENCY] { 0.1 ..= 50.0 } = 4.0;
        /// Largest roll rate of the rider's reference.
        Tunable "rider.leanRateLimit" lean_rate_limit: f64 [RAD_PER_S] { 1e-3 ..= 10.0 } = 0.8;
        /// Weight of the steering torque in the rider's quadratic cost: this torque costs as much as a lean error of 0.1 rad. Small values give firm control.
        Tunable "rider.torqueWeight" torque_weight: f64 [N_M] { 1e-3 ..= 1e6 } = 30.0, importance_rank(9);
        /// Lean of the rider's torso as a fraction of the reference roll angle.
        Tunable "rider.bodyLeanShare" body_lean_share: f64 { -1.0 ..= 1.0 } = 0.1;
        /// Natural frequency of the rider's torso lean.
        Tunable "rider.bodyLeanFrequency" body_lean_frequency: f64 [ANGULAR_FREQUENCY] { 0.1 ..= 50.0 } = 8.0;
        /// Largest lean of the rider's torso relative to the motorcycle.
        Tunable "rider.bodyLeanLimit" body_lean_limit: f64 [RAD] { 0.0 ..= 1.5 } = 0.35;
        /// Mass of the leaning torso with head and arms; part of frame.mass.
        "rider.torsoMass" torso_mass: f64 [KG] { 0.0 ..= 1e3 } = 44.5;
        /// Distance of the torso's centre of mass from the seat, its lean axis.
        "rider.torsoCentre" torso_centre: f64 [M] { 0.0 ..= 3.0 } = 0.4;
        /// Moment of inertia of the torso about its centre of mass, about the axis forward.
        "rider.torsoInertia" torso_inertia: f64 [KG_M2] { 0.0 ..= 100.0 } = 1.3;
        /// Speed below which feet on the road and firm hands support the motorcycle, increasingly towards rest.
        "feet.speed" feet_speed: f64 [M_PER_S] { 0.5 ..= 10.0 } = 3.0;
        /// Distance of the rider's head ahead of the rear contact.
        "head.x" head_x: f64 [M] { -5.0 ..= 5.0 } = 0.65;
        /// Height of the rider's head above the road.
        "head.height" head_height: f64 [M] { 1e-3 ..= 5.0 } = 1.5;
        /// Length of the torso from the seat, its lean axis, to the head.
        "head.torsoLength" torso_length: f64 [M] { 0.0 ..= 5.0 } = 0.75;
    }
}

interface! {
    /// Initial values and solver.
    pub struct Run: Parameter, Fixed {
        /// Magnitude of gravity.
        "gravity" gravity: f64 [M_PER_S2] { 0.1 ..= 100.0 } = STANDARD_GRAVITY;
        /// Axes of vehicle.angularVelocity, as in the washout.
        "angularVelocityFrame" angular_velocity_frame: AngularVelocityFrame = AngularVelocityFrame::World;
        /// Initial speed.
        "initial.speed" initial_speed: f64 [M_PER_S] { 0.0 ..= LARGEST_SPEED } = 0.0, importance_rank(1);
        /// Initial heading.
        "initial.heading" initial_heading: f64 [RAD] { -1e6 ..= 1e6 } = 0.0;
        /// Longest internal step; a longer communication step is divided.
        "solver.maxStep" max_step: f64 [S] { 1e-6 ..= 0.01 } = 0.001;
    }
}

interface! {
    /// The path, and the limits within which the rider follows it.
    pub struct Path: Parameter, Fixed {
        /// Path that the rider follows.
        "path.course" course: Course = Course::None;
        /// True to begin the custom path again at its end; otherwise the rider continues straight ahead.
        "path.repeat" repeat: bool = false;
        /// Deviation beyond which the motorcycle has left the path.
        Tunable "path.halfWidth" half_width: f64 [M] { 0.1 ..= 20.0 } = 3.0;
        /// Largest lateral acceleration that the rider plans.
        Tunable "rider.lateralAcceleration" lateral_acceleration: f64 [M_PER_S2] { 0.1 ..= 30.0 } = 4.5;
        /// Largest forward acceleration that the rider plans.
        Tunable "rider.forwardAcceleration" forward_acceleration: f64 [M_PER_S2] { 0.1 ..= 30.0 } = 2.0;
        /// Largest deceleration that the rider plans.
        Tunable "rider.deceleration" deceleration: f64 [M_PER_S2] { 0.1 ..= 30.0 } = 2.5;
        /// Largest lateral force of a tyre divided by the largest force along the road; only on a path.
        Tunable "tyre.frictionRatio" friction_ratio: f64 { 0.1 ..= 3.0 } = 1.0;
        /// Number of rows of the custom path.
        "path.point.count" count: i32 { 0 ..= 64 } = 0;
        /// Distance along the path from its beginning; ascending, the first is 0.
        "path.point.distance[#]" distance: PathColumn [M] { 0.0 ..= 1e6 } = NO_ROWS;
        /// Curvature of the path there, positive to the left; linear between rows.
        "path.point.curvature[#]" curvature: PathColumn [PER_M] { -0.5 ..= 0.5 } = NO_ROWS;
        /// Speed limit there; linear between rows.
        "path.point.speed[#]" speed_limit: PathColumn [M_PER_S] { 0.0 ..= LARGEST_SPEED } = NO_ROWS;
    }
}

interface_tree! {
    /// All parameters.
    pub struct Parameters {
        machine: BicycleParameters,
        tyres: Tyres,
        longitudinal: Longitudinal,
        suspension: Suspension,
        rider: Rider,
        run: Run,
        path: Path,
    }
}
