//! Block (1), first half: gravity removal, scaling, limiting and low-pass of what the
//! vehicle model delivers.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use crate::filter::bumpless::GlidingOffset;
use crate::filter::critically_damped::CriticallyDamped;
use crate::interface::{AngularVelocityFrame, ConditioningParameters, GravityRemoval, Input};
use crate::motion::min_max::min;
use crate::motion::orientation::rates_from_reference;

/// The signal to cue: zero at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cue {
    /// Specific force without gravity, in head axes \[m/s2\].
    pub force: Vector3<f64>,
    /// Rates of roll, pitch and yaw \[rad/s\].
    pub rates: Vector3<f64>,
}

impl Cue {
    /// The cue times a factor.
    pub fn scaled(self, factor: f64) -> Self {
        Cue { force: self.force * factor, rates: self.rates * factor }
    }

    /// The difference to another cue.
    pub fn less(&self, other: &Cue) -> Self {
        Cue { force: self.force - other.force, rates: self.rates - other.rates }
    }

    /// Surge, sway and rates times the automatic scale, and all of it limited.
    pub fn limited(&self, factor: f64, parameters: &ConditioningParameters) -> Self {
        Cue {
            force: limited_force(self.force, factor, parameters),
            rates: (factor * self.rates).zip_map(&parameters.rate_limit, soft_limit),
        }
    }

    /// True if force and rates are too small to be felt.
    pub fn asks_for_no_motion(&self) -> bool {
        const FORCE: f64 = 1e-3;
        const RATE: f64 = 1e-4;
        self.force.amax() <= FORCE && self.rates.amax() <= RATE
    }
}

/// Gravity removed, scaled and limited: the cue in the vehicle's motion at one instant, at an
/// automatic scale of 1. Arguments as for [`scaled_cue`].
pub fn cue(input: &Input, parameters: &ConditioningParameters, gravity: f64, lean: f64) -> Cue {
    scaled_cue(input, parameters, gravity, lean).limited(1.0, parameters)
}

/// Gravity removed, and scaled: a [`cue`] without its limits.
///
/// `lean` is the lean of the head's frame relative to the vehicle's \[rad\], `gravity` the
/// magnitude of gravity \[m/s2\].
pub fn scaled_cue(input: &Input, parameters: &ConditioningParameters, gravity: f64, lean: f64) -> Cue {
    let (roll, pitch) = (libm::sincos(input.orientation.roll), libm::sincos(input.orientation.pitch));
    // The rider sits upright for most of the time.
    let leaned = if lean == 0.0 { roll } else { libm::sincos(input.orientation.roll + lean) };
    let force = input.specific_force + gravity * removed_gravity(parameters.gravity_removal, leaned, pitch);
    let rates = conditioned_rates(input, parameters.angular_velocity_frame, roll, pitch);
    Cue { force: force.component_mul(&parameters.force_scale), rates: rates.component_mul(&parameters.rate_scale) }
}

/// The force of a cue from a specific force, if the vehicle is oriented as in `input` and the
/// automatic scale is `factor`.
pub fn cue_force(
    specific_force: Vector3<f64>,
    input: &Input,
    parameters: &ConditioningParameters,
    gravity: f64,
    lean: f64,
    factor: f64,
) -> Vector3<f64> {
    limited_force(scaled_force(specific_force, input, parameters, gravity, lean), factor, parameters)
}

/// The force of a [`scaled_cue`] from a specific force, if the vehicle is oriented as in `input`.
pub fn scaled_force(
    specific_force: Vector3<f64>,
    input: &Input,
    parameters: &ConditioningParameters,
    gravity: f64,
    lean: f64,
) -> Vector3<f64> {
    let (roll, pitch) = (libm::sincos(input.orientation.roll + lean), libm::sincos(input.orientation.pitch));
    let force = specific_force + gravity * removed_gravity(parameters.gravity_removal, roll, pitch);
    force.component_mul(&parameters.force_scale)
}

/// A scaled force times the automatic scale, but for heave, and limited.
fn limited_force(force: Vector3<f64>, factor: f64, parameters: &ConditioningParameters) -> Vector3<f64> {
    Vector3::new(factor * force.x, factor * force.y, force.z).zip_map(&parameters.force_limit, soft_limit)
}

/// The vehicle's acceleration along the head's x \[m/s2\]: its specific force without gravity,
/// which a pitch brings into it.
pub fn forward_acceleration(input: &Input, parameters: &ConditioningParameters, gravity: f64) -> f64 {
    let pitched = match parameters.gravity_removal {
        GravityRemoval::None => 0.0,
        GravityRemoval::HeadVertical | GravityRemoval::Full => libm::sin(input.orientation.pitch),
    };
    input.specific_force.x + gravity * pitched
}

/// The direction of gravity in head axes, R_D^H (0, 0, -1), or the part of it that is removed.
fn removed_gravity(
    removal: GravityRemoval,
    (sin_roll, cos_roll): SinCos,
    (sin_pitch, cos_pitch): SinCos,
) -> Vector3<f64> {
    match removal {
        GravityRemoval::None => Vector3::zeros(),
        GravityRemoval::HeadVertical => Vector3::new(0.0, 0.0, -cos_pitch * cos_roll),
        GravityRemoval::Full => Vector3::new(sin_pitch, -cos_pitch * sin_roll, -cos_pitch * cos_roll),
    }
}

/// Vertical component of the body's z axis up to which the rates are those in body axes, and from
/// which on they are those of the angles. The component is 0 at the pole of eq. (10), a pitch of 90
/// degrees, and below that upside down.
const UPRIGHT_RANGE: [f64; 2] = [0.1, 0.4];

/// Sine and cosine of an angle.
type SinCos = (f64, f64);

/// Rates of roll, pitch and yaw. Where the vehicle is upright they are those of the angles by the
/// inverse of eq. (10). Else they are the angular velocity in body axes; between, a mean of both.
///
/// Rates depend on the rotation alone, not on the angles that describe it.
fn conditioned_rates(input: &Input, frame: AngularVelocityFrame, roll: SinCos, pitch: SinCos) -> Vector3<f64> {
    let yaw = match frame {
        AngularVelocityFrame::World => libm::sincos(input.orientation.yaw),
        AngularVelocityFrame::Body => (0.0, 1.0),
    };
    // Beyond a pitch of 90 degrees: the other angles of the same rotation, which eq. (10) is for.
    let turned = |(sin, cos): SinCos| if pitch.1 < 0.0 { (-sin, -cos) } else { (sin, cos) };
    let (roll, pitch, yaw) = (turned(roll), (pitch.0, pitch.1.abs()), turned(yaw));
    let weight = smooth_step(pitch.1 * roll.1, UPRIGHT_RANGE);
    let omega = input.angular_velocity;
    let of_angles = || match frame {
        AngularVelocityFrame::World => rates_from_reference(omega, yaw, pitch).to_vector(),
        AngularVelocityFrame::Body => rates_from_body(omega, roll, pitch),
    };
    let in_body = || match frame {
        AngularVelocityFrame::World => to_body(omega, roll, pitch, yaw),
        AngularVelocityFrame::Body => omega,
    };
    match weight {
        1.0 => of_angles(),
        0.0 => in_body(),
        _ => in_body().lerp(&of_angles(), weight),
    }
}

/// 0 up to the first limit, 1 from the second on, between them without a corner.
fn smooth_step(value: f64, [low, high]: [f64; 2]) -> f64 {
    let x = ((value - low) / (high - low)).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// A vector of the reference frame in body axes: R' v, eq. (2).
fn to_body(
    v: Vector3<f64>,
    (sin_roll, cos_roll): SinCos,
    (sin_pitch, cos_pitch): SinCos,
    (sin_yaw, cos_yaw): SinCos,
) -> Vector3<f64> {
    let (ahead, across) = (cos_yaw * v.x + sin_yaw * v.y, cos_yaw * v.y - sin_yaw * v.x);
    let up = sin_pitch * ahead + cos_pitch * v.z;
    Vector3::new(
        cos_pitch * ahead - sin_pitch * v.z,
        cos_roll * across + sin_roll * up,
        cos_roll * up - sin_roll * across,
    )
}

/// Rates of roll, pitch and yaw from an angular velocity in body axes: eq. (10) with omega = R
/// omega_body, inverted.
fn rates_from_body(omega: Vector3<f64>, (sin_roll, cos_roll): SinCos, (sin_pitch, cos_pitch): SinCos) -> Vector3<f64> {
    let yaw = (sin_roll * omega.y + cos_roll * omega.z) / cos_pitch;
    Vector3::new(omega.x + sin_pitch * yaw, cos_roll * omega.y - sin_roll * omega.z, yaw)
}

/// The fraction of a limit up to which [`soft_limit`] changes nothing.
const SOFT_LIMIT_KNEE: f64 = 0.8;

/// A smooth limit: the value itself up to 80 % of the limit, then bent towards the
/// limit without a corner.
pub fn soft_limit(value: f64, limit: f64) -> f64 {
    let knee = SOFT_LIMIT_KNEE * limit;
    if value.abs() <= knee {
        return value;
    }
    let span = limit - knee;
    (knee + span * libm::tanh((value.abs() - knee) / span)).copysign(value)
}

/// Conditioning that changes in motion: scales, limits and cutoffs glide to new values, and what
/// the other parameters change at once is a correction of the cue that fades.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ConditioningGlide {
    /// Of scales, logarithms of limits, and time constants of the low-passes.
    numbers: GlidingOffset<GLIDING_COUNT>,
    /// Of force \[m/s2\] and rates \[rad/s\].
    cue: GlidingOffset<6>,
}

impl ConditioningGlide {
    /// Glides from these parameters to those, whose cue is less by `jump` at the same numbers.
    pub fn begin(&mut self, before: &ConditioningParameters, after: &ConditioningParameters, jump: &Cue) {
        self.numbers.add(&(gliding_numbers(before) - gliding_numbers(after)));
        self.cue.add(&stacked(&jump.force, &jump.rates));
    }

    /// Ends the glide of the numbers, where nothing is cued.
    pub fn end(&mut self) {
        self.numbers = GlidingOffset::default();
    }

    /// True if nothing glides.
    #[inline(always)]
    pub fn is_over(&self) -> bool {
        self.numbers.is_over() && self.cue.is_over()
    }

    /// Advances by `step` seconds.
    pub fn advance(&mut self, step: f64) {
        self.numbers.advance(step);
        self.cue.advance(step);
    }

    /// The parameters in force on the way to these.
    pub fn in_force(&self, target: &ConditioningParameters) -> ConditioningParameters {
        if self.numbers.is_over() {
            return *target;
        }
        let values = gliding_numbers(target) + self.numbers.values();
        let [force_scale, rate_scale, force_limit, rate_limit] =
            core::array::from_fn(|k| values.fixed_rows::<3>(3 * k).into_owned());
        let vectors = [force_scale, rate_scale, force_limit.map(libm::exp), rate_limit.map(libm::exp)];
        let cutoff = |time: f64| if time > SHORTEST_TIME { 1.0 / time } else { 0.0 };
        with_gliding(target, (vectors, core::array::from_fn(|k| cutoff(values[3 * VECTOR_COUNT + k]))))
    }

    /// The cue with the correction.
    pub fn corrected(&self, cue: Cue) -> Cue {
        let by = self.cue.values();
        Cue { force: cue.force + by.fixed_rows::<3>(0), rates: cue.rates + by.fixed_rows::<3>(3) }
    }
}

/// Time constants of a low-pass up to this are none \[s\].
const SHORTEST_TIME: f64 = 1e-6;
/// Longer ones glide as this one \[s\].
const LONGEST_TIME: f64 = 1e6;

/// Counts of the vectors and cutoffs that glide, and of the numbers in them.
const VECTOR_COUNT: usize = 4;
const CUTOFF_COUNT: usize = 2;
const GLIDING_COUNT: usize = 3 * VECTOR_COUNT + CUTOFF_COUNT;
/// The parameters that glide.
type Gliding = ([Vector3<f64>; VECTOR_COUNT], [f64; CUTOFF_COUNT]);

/// The parameters that glide. The others are choices and change at once.
pub fn gliding(parameters: &ConditioningParameters) -> Gliding {
    #[rustfmt::skip]
    let ConditioningParameters {
        force_scale, rate_scale, force_limit, rate_limit, cutoff, rate_cutoff,
        gravity_removal: _, compensation: _, angular_velocity_frame: _, reconstruction: _,
    } = *parameters;
    ([force_scale, rate_scale, force_limit, rate_limit], [cutoff, rate_cutoff])
}

/// Choices of these parameters, with the given ones that glide.
pub fn with_gliding(choices: &ConditioningParameters, (vectors, cutoffs): Gliding) -> ConditioningParameters {
    let mut changed = *choices;
    [changed.force_scale, changed.rate_scale, changed.force_limit, changed.rate_limit] = vectors;
    [changed.cutoff, changed.rate_cutoff] = cutoffs;
    changed
}

/// Numbers that glide linearly.
fn gliding_numbers(parameters: &ConditioningParameters) -> SVector<f64, GLIDING_COUNT> {
    let ([force_scale, rate_scale, force_limit, rate_limit], cutoffs) = gliding(parameters);
    let vectors = [force_scale, rate_scale, force_limit.map(libm::log), rate_limit.map(libm::log)];
    let times = cutoffs.map(|cutoff| if cutoff > 0.0 { min(1.0 / cutoff, LONGEST_TIME) } else { 0.0 });
    SVector::from_iterator(vectors.iter().flatten().copied().chain(times))
}

fn stacked(first: &Vector3<f64>, second: &Vector3<f64>) -> SVector<f64, 6> {
    SVector::from([first.x, first.y, first.z, second.x, second.y, second.z])
}

/// The optional low-passes: of first order on the whole cue, and of second order on its rates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InputFilter {
    /// The output of the first.
    cue: Cue,
    /// Second low-pass, on the rates.
    rates: CriticallyDamped,
}

impl InputFilter {
    /// The output now.
    pub fn cue(&self) -> Cue {
        Cue { rates: self.rates.value(), ..self.cue }
    }

    /// Advances by `step` seconds while the cue goes linearly from `start` to `end`. Returns the
    /// filtered cue at the step's start and end. A cutoff of 0 passes the cue on unchanged.
    pub fn advance(&mut self, start: Cue, end: Cue, parameters: &ConditioningParameters, step: f64) -> (Cue, Cue) {
        let (start, end) = self.low_passed(start, end, parameters.cutoff, step);
        if parameters.rate_cutoff == 0.0 {
            self.rates.set(end.rates);
            return (start, end);
        }
        let before = self.rates.value();
        self.rates.advance(start.rates, end.rates, parameters.rate_cutoff, step);
        (Cue { rates: before, ..start }, Cue { rates: self.rates.value(), ..end })
    }

    /// The first low-pass.
    fn low_passed(&mut self, start: Cue, end: Cue, cutoff: f64, step: f64) -> (Cue, Cue) {
        if cutoff == 0.0 {
            self.cue = end;
            return (start, end);
        }
        let before = self.cue;
        let decay = libm::exp(-cutoff * step);
        // The exact response of y' = cutoff (u - y) to a ramp: it lags by slope/cutoff, and the rest decays.
        let ramp = |y: Vector3<f64>, u0: Vector3<f64>, u1: Vector3<f64>| {
            let lag = (u1 - u0) / (cutoff * step);
            u1 - lag + (y - u0 + lag) * decay
        };
        self.cue = Cue {
            force: ramp(before.force, start.force, end.force),
            rates: ramp(before.rates, start.rates, end.rates),
        };
        (before, self.cue)
    }
}
