//! The Whipple-Carvallo bicycle: Meijaard, Papadopoulos, Ruina, Schwab, "Linearized dynamics
//! equations for the balance and steer of a bicycle: a benchmark and review", Proc. R. Soc. A 463
//! (2007), appendix A.
//!
//! The paper's axes: x forward, y to the RIGHT, z DOWN, from the rear contact; lean and steer
//! positive to the right. Names are the paper's, too. This model is the limit of [`crate::lateral`]
//! for stiff tyres; the simulation does not use it.

use nalgebra::Matrix2;

/// A bicycle's 25 parameters but for speed and gravity. Knife-edge wheels, rigid bodies, rider
/// rigid on the rear frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bicycle {
    /// Wheelbase \[m\].
    pub w: f64,
    /// Trail \[m\].
    pub c: f64,
    /// Steer axis tilt from the vertical, the paper's lambda \[rad\].
    pub caster_angle: f64,
    /// Rear wheel.
    pub r: Wheel,
    /// Rear frame with rider.
    pub b: Body,
    /// Front frame: fork and handlebar.
    pub h: Body,
    /// Front wheel.
    pub f: Wheel,
}

/// A wheel: radius \[m\], mass \[kg\], moments of inertia about a diameter and about the axle \[kg
/// m2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel {
    pub r: f64,
    pub m: f64,
    pub xx: f64,
    pub yy: f64,
}

/// A body: place of its centre of mass \[m\], mass \[kg\] and the inertia matrix' elements about it
/// \[kg m2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    pub x: f64,
    pub z: f64,
    pub m: f64,
    pub xx: f64,
    pub xz: f64,
    pub zz: f64,
}

/// Intermediate quantities of appendix A: of the whole (T) and of the front assembly (A).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    pub m_t: f64,
    pub x_t: f64,
    pub z_t: f64,
    pub t_xx: f64,
    pub t_xz: f64,
    pub t_zz: f64,
    pub m_a: f64,
    pub x_a: f64,
    pub z_a: f64,
    /// Distance of the front assembly's centre of mass ahead of the steer axis.
    pub u_a: f64,
    /// Moment of inertia of the front assembly about the steer axis.
    pub a_ll: f64,
    /// Products of inertia of the front assembly relative to the steer axis and the axes through
    /// the rear contact.
    pub a_lx: f64,
    pub a_lz: f64,
    /// Ratio of the mechanical trail to the wheelbase.
    pub mu: f64,
    /// Gyrostatic coefficients of the wheels.
    pub s_r: f64,
    pub s_f: f64,
    /// Static moment term.
    pub s_a: f64,
}

impl Bicycle {
    /// The quantities that appendix A defines before the coefficients.
    pub fn totals(&self) -> Totals {
        let Bicycle { w, c, caster_angle, r, b, h, f } = *self;
        let (sin, cos) = libm::sincos(caster_angle);
        let m_t = r.m + b.m + h.m + f.m;
        let x_t = (b.x * b.m + h.x * h.m + w * f.m) / m_t;
        let z_t = (-r.r * r.m + b.z * b.m + h.z * h.m - f.r * f.m) / m_t;
        let t_xx = r.xx + b.xx + h.xx + f.xx + r.m * r.r * r.r + b.m * b.z * b.z + h.m * h.z * h.z + f.m * f.r * f.r;
        let t_xz = b.xz + h.xz - b.m * b.x * b.z - h.m * h.x * h.z + f.m * w * f.r;
        let t_zz = r.xx + b.zz + h.zz + f.xx + b.m * b.x * b.x + h.m * h.x * h.x + f.m * w * w;
        let m_a = h.m + f.m;
        let x_a = (h.x * h.m + w * f.m) / m_a;
        let z_a = (h.z * h.m - f.r * f.m) / m_a;
        let a_xx = h.xx + f.xx + h.m * square(h.z - z_a) + f.m * square(f.r + z_a);
        let a_xz = h.xz - h.m * (h.x - x_a) * (h.z - z_a) + f.m * (w - x_a) * (f.r + z_a);
        let a_zz = h.zz + f.xx + h.m * square(h.x - x_a) + f.m * square(w - x_a);
        let u_a = (x_a - w - c) * cos - z_a * sin;
        let a_ll = m_a * u_a * u_a + a_xx * sin * sin + 2.0 * a_xz * sin * cos + a_zz * cos * cos;
        let a_lx = -m_a * u_a * z_a + a_xx * sin + a_xz * cos;
        let a_lz = m_a * u_a * x_a + a_xz * sin + a_zz * cos;
        let mu = c / w * cos;
        let (s_r, s_f) = (r.yy / r.r, f.yy / f.r);
        let s_a = m_a * u_a + mu * m_t * x_t;
        Totals { m_t, x_t, z_t, t_xx, t_xz, t_zz, m_a, x_a, z_a, u_a, a_ll, a_lx, a_lz, mu, s_r, s_f, s_a }
    }

    /// The coefficients of the linearised equations of lean and steer, the result of appendix A.
    pub fn equations(&self) -> Equations {
        let t = self.totals();
        let (sin, cos) = libm::sincos(self.caster_angle);
        let s_t = t.s_r + t.s_f;
        let cos_w = cos / self.w;
        let m_lean_steer = t.a_lx + t.mu * t.t_xz;
        let c1_lean_steer = t.mu * s_t + t.s_f * cos + t.t_xz * cos_w - t.mu * t.m_t * t.z_t;
        Equations {
            m: Matrix2::new(t.t_xx, m_lean_steer, m_lean_steer, t.a_ll + 2.0 * t.mu * t.a_lz + t.mu * t.mu * t.t_zz),
            c1: Matrix2::new(
                0.0,
                c1_lean_steer,
                -(t.mu * s_t + t.s_f * cos),
                t.a_lz * cos_w + t.mu * (t.s_a + t.t_zz * cos_w),
            ),
            k0: t.gravity_stiffness(sin),
            k2: Matrix2::new(0.0, (s_t - t.m_t * t.z_t) * cos_w, 0.0, (t.s_a + t.s_f * sin) * cos_w),
        }
    }
}

impl Totals {
    /// K0: the second derivatives, divided by gravity, of the potential energy by lean and steer
    /// with both wheels on the road. `sin` is the sine of the steer axis tilt.
    pub fn gravity_stiffness(&self, sin: f64) -> Matrix2<f64> {
        Matrix2::new(self.m_t * self.z_t, -self.s_a, -self.s_a, -self.s_a * sin)
    }
}

/// M q'' + v C1 q' + (g K0 + v^2 K2) q = f, with q of lean and steer, eq. (5.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equations {
    pub m: Matrix2<f64>,
    pub c1: Matrix2<f64>,
    pub k0: Matrix2<f64>,
    pub k2: Matrix2<f64>,
}

impl Equations {
    /// The matrix of the first-order form, of (lean, steer, lean rate, steer rate), at a speed
    /// \[m/s\].
    pub fn state_matrix(&self, gravity: f64, speed: f64) -> Option<nalgebra::Matrix4<f64>> {
        let inverse = self.m.try_inverse()?;
        let stiffness = -inverse * (self.k0 * gravity + self.k2 * (speed * speed));
        let damping = -inverse * self.c1 * speed;
        let mut a = nalgebra::Matrix4::zeros();
        a[(0, 2)] = 1.0;
        a[(1, 3)] = 1.0;
        a.fixed_view_mut::<2, 2>(2, 0).copy_from(&stiffness);
        a.fixed_view_mut::<2, 2>(2, 2).copy_from(&damping);
        Some(a)
    }
}

fn square(x: f64) -> f64 {
    x * x
}
