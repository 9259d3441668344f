//! Lean, steer, lateral velocity and yaw with tyres that slip: four degrees of freedom in the
//! manner of Sharp (1971).
//!
//! The bodies are those of [`crate::whipple`], in its axes: x forward, y to the RIGHT, z DOWN from
//! the rear contact. All angles are positive to the right. The equations are derived from the same
//! kinetic and potential energy, without the constraint that the wheels do not slip sideways. With
//! infinitely stiff tyres they are Whipple's. The equations are linear in the state and their
//! coefficients linear in the speed, so that a model is two matrices.
//!
//! The lean of these linear equations is the TANGENT of the roll angle. In a steady turn, speed
//! times yaw rate equals gravity times lean. With the tangent, such a turn is balanced at any roll
//! angle, and no state rolls beyond 90 degrees.

use nalgebra::{Matrix2, Matrix4, SMatrix, SVector, Vector4};
use serde::{Deserialize, Serialize};

use crate::interface::{BicycleParameters, Parameters};
use crate::whipple::{Bicycle, Body, Totals, Wheel};

/// Indices of the state's variables.
///
/// - lateral velocity of the rear contact, in axes of the heading \[m/s\];
/// - yaw rate, lean rate and steer rate \[rad/s\];
/// - lean (the roll's tangent) and steer angle \[rad\];
/// - lateral forces on the rear and the front tyre \[N\].
pub mod place {
    pub const VELOCITY: usize = 0;
    pub const YAW_RATE: usize = 1;
    pub const LEAN_RATE: usize = 2;
    pub const STEER_RATE: usize = 3;
    pub const LEAN: usize = 4;
    pub const STEER: usize = 5;
    pub const REAR_FORCE: usize = 6;
    pub const FRONT_FORCE: usize = 7;
}
use place::*;

/// Number of lateral states.
pub const STATE_SIZE: usize = 8;
/// The lateral state, or its derivative.
pub type State = SVector<f64, STATE_SIZE>;
/// A matrix that acts on the lateral state.
pub type StateMatrix = SMatrix<f64, STATE_SIZE, STATE_SIZE>;

/// Units in which the variables of a state that begins with the lateral one are of
/// similar size: forces in kN.
pub fn units<const N: usize>() -> SVector<f64, N> {
    let mut units = SVector::repeat(1.0);
    units[place::REAR_FORCE] = 1e3;
    units[place::FRONT_FORCE] = 1e3;
    units
}

/// A tyre: forces for slip and camber, and the relaxation length with which they build up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tyre {
    /// Lateral force for a small slip angle \[N/rad\].
    pub cornering: f64,
    /// Lateral force for a small camber angle \[N/rad\].
    pub camber: f64,
    /// Relaxation length \[m\].
    pub relaxation: f64,
}

/// The rider's torso, which leans to the right about an axis along the motorcycle at the height of
/// the seat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torso {
    pub mass: f64,
    /// Distance of its centre of mass from the axis \[m\].
    pub arm: f64,
    /// Place of its centre of mass: ahead of the rear contact, and height \[m\].
    pub x: f64,
    pub height: f64,
    /// Moment of inertia about its centre of mass, about the axis forward \[kg m2\].
    pub inertia: f64,
}

/// Data of the lateral equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    pub bicycle: Bicycle,
    pub rear: Tyre,
    pub front: Tyre,
    pub steer_damping: f64,
    pub torso: Torso,
    /// Where the wind's force acts: ahead of the rear contact, and height \[m\].
    pub wind_x: f64,
    pub wind_height: f64,
    pub gravity: f64,
}

/// The linear equations: x' = (constant + speed per_speed + feet hold) x + inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lateral {
    pub constant: StateMatrix,
    pub per_speed: StateMatrix,
    /// Feet on the road and hands on the bars at full support, and dampers on both contacts. The
    /// dampers are needed because a tyre at standstill is an undamped spring.
    pub hold: StateMatrix,
    /// Effect of a torque between rider and bars \[N m\], positive to the right.
    pub torque: State,
    /// Effect of the torso's lean \[rad\].
    pub torso: State,
    /// Effect of its second derivative \[rad/s2\].
    pub torso_acceleration: State,
    /// Effect of the wind's force to the right \[N\].
    pub wind: State,
}

/// External actions on the motorcycle, positive to the right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actions {
    pub torque: f64,
    pub torso: f64,
    pub torso_acceleration: f64,
    pub wind: f64,
}

impl Lateral {
    /// The equations, or `None` where the mass matrix is not positive definite.
    ///
    /// With q = (lateral displacement of the rear contact, yaw, lean, steer):
    /// M q'' + v G q' + D q' + g K q = Q.
    ///
    /// M comes from the kinetic energy of bodies displaced by y + x yaw - z lean (+ u steer in
    /// front), G from the wheels' angular momentum. K is Whipple's K0: the potential energy of a
    /// machine with both wheels on the road does not depend on position and heading.
    pub fn new(design: &Design) -> Option<Lateral> {
        let t = design.bicycle.totals();
        let (sin, cos) = libm::sincos(design.bicycle.caster_angle);
        let inverse = mass_matrix(&t).cholesky()?.inverse();
        let k0 = t.gravity_stiffness(sin) * design.gravity;
        let steer_unit = Vector4::new(0.0, 0.0, 0.0, 1.0);
        let torso = design.torso;
        let moment = torso.mass * torso.arm;
        let torso_coupling = Vector4::new(moment, moment * torso.x, moment * torso.height + torso.inertia, 0.0);
        let torso_weight = Vector4::new(0.0, 0.0, moment * design.gravity, 0.0);

        let mut lateral = Lateral {
            constant: StateMatrix::zeros(),
            per_speed: StateMatrix::zeros(),
            hold: StateMatrix::zeros(),
            torque: derivative_of(inverse * steer_unit),
            torso: derivative_of(inverse * torso_weight),
            torso_acceleration: derivative_of(-inverse * torso_coupling),
            wind: derivative_of(inverse * Vector4::new(1.0, design.wind_x, design.wind_height, 0.0)),
        };
        add_accelerations(&mut lateral.per_speed, 0, &(-inverse * gyroscopic_matrix(&t, sin, cos)));
        // The acceleration of the contact is y'' = velocity' + speed yaw rate.
        lateral.per_speed[(VELOCITY, YAW_RATE)] -= 1.0;
        lateral.constant[(LEAN, LEAN_RATE)] = 1.0;
        lateral.constant[(STEER, STEER_RATE)] = 1.0;
        add_accelerations(&mut lateral.constant, STEER_RATE, &(inverse * steer_unit * -design.steer_damping));
        for (place, stiffness) in [(LEAN, k0.column(0)), (STEER, k0.column(1))] {
            let moments = Vector4::new(0.0, 0.0, stiffness[0], stiffness[1]);
            add_accelerations(&mut lateral.constant, place, &(-inverse * moments));
        }
        for contact in design.contacts() {
            lateral.add_tyre(&contact, &inverse);
            // Half of the critical damping of half the mass on the tyre's lateral spring.
            let damping = libm::sqrt(contact.tyre.cornering / contact.tyre.relaxation * 0.5 * t.m_t);
            add_accelerations(&mut lateral.hold, 0, &(-inverse * contact.arms * contact.arms.transpose() * damping));
        }
        lateral.add_feet_and_hands(&t, &k0, &inverse);
        Some(lateral)
    }

    /// Adds a tyre's force F on the motorcycle. The force follows the slip velocity s by
    /// sigma F' = v (C_camber camber - F) - C s.
    fn add_tyre(&mut self, contact: &Contact, inverse: &Matrix4<f64>) {
        let Contact { force, arms, steer_slip, steer_camber, tyre } = contact;
        let force = *force;
        add_accelerations(&mut self.constant, force, &(inverse * arms));
        for (place, arm) in arms.iter().enumerate() {
            self.constant[(force, place)] = -tyre.cornering * arm / tyre.relaxation;
        }
        self.per_speed[(force, force)] = -1.0 / tyre.relaxation;
        self.per_speed[(force, LEAN)] = tyre.camber / tyre.relaxation;
        self.per_speed[(force, STEER)] = (tyre.cornering * steer_slip + tyre.camber * steer_camber) / tyre.relaxation;
    }

    /// Adds feet and hands at full support: a stiffness against roll, with critical damping. Hands
    /// have the same on the bars, which would otherwise turn to a side by their own weight.
    fn add_feet_and_hands(&mut self, t: &Totals, k0: &Matrix2<f64>, inverse: &Matrix4<f64>) {
        // Stiffness of foot support relative to the toppling stiffness of gravity.
        const FEET_STIFFNESS: f64 = 4.0;
        // Stiffness of the hands on the bars relative to the turning stiffness of gravity.
        const HANDS_STIFFNESS: f64 = 5.0;
        let feet = (2, LEAN, LEAN_RATE, FEET_STIFFNESS * k0[(0, 0)].abs(), t.t_xx);
        let hands = (3, STEER, STEER_RATE, HANDS_STIFFNESS * k0[(1, 1)].abs(), t.a_ll);
        for (row, angle, rate, stiffness, inertia) in [feet, hands] {
            let damping = 2.0 * libm::sqrt(stiffness * inertia);
            add_accelerations(&mut self.hold, angle, &(inverse.column(row) * -stiffness));
            add_accelerations(&mut self.hold, rate, &(inverse.column(row) * -damping));
        }
    }

    /// The matrix of the free motion at a speed \[m/s\], with foot support from 0 to 1.
    pub fn state_matrix(&self, speed: f64, feet: f64) -> StateMatrix {
        self.constant + self.per_speed * speed + self.hold * feet
    }

    /// Derivative of the lateral state, at this forward speed \[m/s\].
    pub fn derivative(&self, state: &State, speed: f64, feet: f64, actions: &Actions) -> State {
        self.constant * state
            + self.per_speed * state * speed
            + self.hold * state * feet
            + self.torque * actions.torque
            + self.torso * actions.torso
            + self.torso_acceleration * actions.torso_acceleration
            + self.wind * actions.wind
    }
}

/// A tyre on the road.
struct Contact {
    /// Index of its force in the state.
    force: usize,
    /// Lateral displacement of the contact per coordinate of q. The same numbers are the
    /// generalised force of a unit lateral force.
    arms: Vector4<f64>,
    /// Fraction of the steer angle that turns the wheel in the road's plane, and fraction that
    /// cambers it.
    steer_slip: f64,
    steer_camber: f64,
    tyre: Tyre,
}

impl Design {
    /// The rear and the front contact; the front one trails the steer axis.
    fn contacts(&self) -> [Contact; 2] {
        let Bicycle { w, c, caster_angle, .. } = self.bicycle;
        let (sin, cos) = libm::sincos(caster_angle);
        [
            Contact {
                force: REAR_FORCE,
                arms: Vector4::new(1.0, 0.0, 0.0, 0.0),
                steer_slip: 0.0,
                steer_camber: 0.0,
                tyre: self.rear,
            },
            Contact {
                force: FRONT_FORCE,
                arms: Vector4::new(1.0, w, 0.0, -c * cos),
                steer_slip: cos,
                steer_camber: sin,
                tyre: self.front,
            },
        ]
    }
}

/// The mass matrix of (lateral displacement, yaw, lean, steer).
#[rustfmt::skip]
fn mass_matrix(t: &Totals) -> Matrix4<f64> {
    Matrix4::new(
        t.m_t,           t.m_t * t.x_t, -t.m_t * t.z_t, t.m_a * t.u_a,
        t.m_t * t.x_t,   t.t_zz,         t.t_xz,        t.a_lz,
        -t.m_t * t.z_t,  t.t_xz,         t.t_xx,        t.a_lx,
        t.m_a * t.u_a,   t.a_lz,         t.a_lx,        t.a_ll,
    )
}

/// The generalised forces, per speed, with which the spinning wheels resist being turned.
#[rustfmt::skip]
fn gyroscopic_matrix(t: &Totals, sin: f64, cos: f64) -> Matrix4<f64> {
    let s_t = t.s_r + t.s_f;
    Matrix4::new(
        0.0, 0.0,          0.0,         0.0,
        0.0, 0.0,         -s_t,        -t.s_f * sin,
        0.0, s_t,          0.0,         t.s_f * cos,
        0.0, t.s_f * sin, -t.s_f * cos, 0.0,
    )
}

/// Foot support: 1 at rest, falling smoothly to 0 at `fastest` \[m/s\].
pub fn foot_support(speed: f64, fastest: f64) -> f64 {
    let ratio = speed / fastest;
    if ratio < 1.0 { (1.0 - ratio * ratio) * (1.0 - ratio * ratio) } else { 0.0 }
}

impl Design {
    /// From the interface's parameters, where z is up.
    pub fn new(parameters: &Parameters) -> Design {
        let Parameters { machine, tyres, rider, longitudinal, run, .. } = parameters;
        let bicycle = bicycle(machine);
        let loads = static_loads(&bicycle, run.gravity);
        let tyre = |load: f64, cornering: f64, camber: f64, relaxation: f64| Tyre {
            cornering: load * cornering,
            camber: load * camber,
            relaxation,
        };
        let seat = rider.head_height - rider.torso_length;
        Design {
            bicycle,
            rear: tyre(loads.rear, tyres.rear_cornering, tyres.rear_camber, tyres.rear_relaxation),
            front: tyre(loads.front, tyres.front_cornering, tyres.front_camber, tyres.front_relaxation),
            steer_damping: machine.steer_damping,
            torso: Torso {
                mass: rider.torso_mass,
                arm: rider.torso_centre,
                x: rider.head_x,
                height: seat + rider.torso_centre,
                inertia: rider.torso_inertia,
            },
            wind_x: 0.5 * machine.wheelbase,
            wind_height: longitudinal.aero_height,
            gravity: run.gravity,
        }
    }
}

/// The bicycle with the machine's parameters.
pub fn bicycle(machine: &BicycleParameters) -> Bicycle {
    Bicycle {
        w: machine.wheelbase,
        c: machine.trail,
        caster_angle: machine.caster_angle,
        r: Wheel {
            r: machine.rear_wheel_radius,
            m: machine.rear_wheel_mass,
            xx: machine.rear_wheel_xx,
            yy: machine.rear_wheel_yy,
        },
        b: Body {
            x: machine.frame_x,
            z: -machine.frame_height,
            m: machine.frame_mass,
            xx: machine.frame_xx,
            xz: -machine.frame_xz,
            zz: machine.frame_zz,
        },
        h: Body {
            x: machine.fork_x,
            z: -machine.fork_height,
            m: machine.fork_mass,
            xx: machine.fork_xx,
            xz: -machine.fork_xz,
            zz: machine.fork_zz,
        },
        f: Wheel {
            r: machine.front_wheel_radius,
            m: machine.front_wheel_mass,
            xx: machine.front_wheel_xx,
            yy: machine.front_wheel_yy,
        },
    }
}

/// A number for each wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wheels {
    pub front: f64,
    pub rear: f64,
}

/// The tyres' loads at rest \[N\].
pub fn static_loads(bicycle: &Bicycle, gravity: f64) -> Wheels {
    let t = bicycle.totals();
    let front = t.m_t * gravity * t.x_t / bicycle.w;
    Wheels { front, rear: t.m_t * gravity - front }
}

/// Adds accelerations to the first four rows of columns from this one on.
fn add_accelerations<const COLUMNS: usize>(
    matrix: &mut StateMatrix,
    column: usize,
    accelerations: &SMatrix<f64, 4, COLUMNS>,
) {
    let mut place = matrix.fixed_view_mut::<4, COLUMNS>(0, column);
    place += accelerations;
}

/// Accelerations as a derivative of the state.
fn derivative_of(accelerations: Vector4<f64>) -> State {
    accelerations.fixed_resize::<STATE_SIZE, 1>(0.0)
}
