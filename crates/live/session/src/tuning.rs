//! Parameters that glide to chosen values within about 2 s.

use moris_interface::{Group as _, Kind, Reader, refuse};
use moris_washout::interface::{SafetyParameters, SoftLimitParameters, TiltParameters};
use moris_washout::{ParameterError, Parameters, Washout};

use crate::log::name_of;

/// Steps from one change to the next.
const INTERVAL: u64 = 40;
/// Part of the way that each of two lags goes in an interval: 98 % are gone after 2 s.
const PART: f64 = 0.108;
/// Parts of new limits within which the platform must be before they come into force.
const INSIDE: f64 = 0.8;
/// Speed below which the platform may come to rest anywhere \[m/s\].
const SLOW: f64 = 0.01;
/// Most by which the soft limits' margin grows in an interval \[m\].
const NARROWER: f64 = 0.007;
/// Least pace with which a limit is approached \[1/s\], where the soft limits have none.
const SLOWEST: f64 = 1.0;

/// Part of a value by which it may still differ when it becomes the chosen one.
const NEAR: f64 = 1e-3;

/// The parameters in force, and those to which they glide. Each value follows through two equal
/// lags, positive ones by factors.
#[derive(Clone, Debug)]
pub struct Tuning {
    target: Vec<f64>,
    middle: Vec<f64>,
    value: Vec<f64>,
    glides: bool,
}

impl Tuning {
    /// At these values of all slots.
    pub fn new(slots: &[f64]) -> Tuning {
        Tuning { target: slots.to_vec(), middle: slots.to_vec(), value: slots.to_vec(), glides: false }
    }

    /// The chosen values.
    pub fn target(&self) -> &[f64] {
        &self.target
    }

    /// At these values at once.
    pub fn set(&mut self, slots: &[f64]) {
        for values in [&mut self.target, &mut self.middle, &mut self.value] {
            values.copy_from_slice(slots);
        }
        self.glides = false;
    }

    /// Glides to these values.
    pub fn glide_to(&mut self, slots: &[f64]) {
        self.target.copy_from_slice(slots);
        self.glides = true;
    }

    /// Goes on, because not all values could come into force.
    pub fn go_on(&mut self) {
        self.glides = true;
    }

    /// The parameters after this step, if they change then.
    pub fn advance(&mut self, step: u64) -> Option<Parameters> {
        if !self.glides || !step.is_multiple_of(INTERVAL) {
            return None;
        }
        let mut arrived = true;
        for slot in 0..self.target.len() {
            let target = self.target[slot];
            let is_real = matches!(Parameters::ROWS[usize::from(Parameters::SLOTS[slot].row)].kind, Kind::Real(_));
            let [middle, value] = if is_real {
                let middle = nearer(self.middle[slot], target);
                [middle, nearer(self.value[slot], middle)]
            } else {
                [target; 2]
            };
            (self.middle[slot], self.value[slot]) = (middle, value);
            let least = NEAR * target.abs().max(1e-3);
            arrived &= (middle - target).abs() <= least && (value - target).abs() <= least;
        }
        if arrived {
            self.middle.copy_from_slice(&self.target);
            self.value.copy_from_slice(&self.target);
            self.glides = false;
        }
        Some(Parameters::read(&mut Reader::new(&self.value)))
    }
}

/// These parameters, with limits in force that the platform can keep gently now.
pub fn with_gentle_limits(parameters: &Parameters, washout: &Washout) -> Parameters {
    let safety = with_room(parameters, washout);
    let tilt = with_tilt(parameters, washout);
    let parameters = Parameters { safety, tilt, ..*parameters };
    Parameters { soft_limit: with_pace(&parameters, washout), ..parameters }
}

/// The tilt's limits of these parameters. Where a tilt is beyond smaller ones, or could not end
/// within them, those in force stay.
fn with_tilt(parameters: &Parameters, washout: &Washout) -> TiltParameters {
    let (before, mut tilt) = (&washout.parameters().tilt, parameters.tilt);
    let output = washout.output();
    let axes = [(output.tilt_roll, output.tilt_roll_rate), (output.tilt_pitch, output.tilt_pitch_rate)];
    let fits = axes.into_iter().all(|(angle, rate)| {
        let stopping = rate * rate / (2.0 * tilt.acceleration_limit);
        angle.abs() + stopping <= INSIDE * tilt.angle_limit && rate.abs() <= INSIDE * tilt.rate_limit
    });
    let least = if fits { 1.0 - PART } else { 1.0 };
    for (limit, old) in [
        (&mut tilt.angle_limit, before.angle_limit),
        (&mut tilt.rate_limit, before.rate_limit),
        (&mut tilt.acceleration_limit, before.acceleration_limit),
    ] {
        *limit = limit.max(least * old);
    }
    tilt
}

/// The safety units' limits of these parameters. On an axis where the platform is beyond smaller
/// ones, or too fast to stay within them gently, those in force stay.
fn with_room(parameters: &Parameters, washout: &Washout) -> SafetyParameters {
    let (before, mut safety) = (&washout.parameters().safety, parameters.safety);
    let motion = washout.motion();
    let neutral = washout.parameters().rig.neutral_height;
    let pace = parameters.soft_limit.pace.max(SLOWEST);
    for k in 0..3 {
        let far = (motion.position[k] - if k == 2 { neutral } else { 0.0 }).abs();
        let [speed, change] = [motion.velocity[k].abs(), motion.acceleration[k].abs()];
        let fits = far + speed / pace <= INSIDE * safety.position_limit[k]
            && speed <= INSIDE * safety.velocity_limit[k]
            && change.max(pace * speed) <= INSIDE * safety.acceleration_limit[k];
        // Those that have waited glide, too.
        let least = if fits { 1.0 - PART } else { 1.0 };
        for (limit, old) in [
            (&mut safety.position_limit[k], before.position_limit[k]),
            (&mut safety.velocity_limit[k], before.velocity_limit[k]),
            (&mut safety.acceleration_limit[k], before.acceleration_limit[k]),
        ] {
            *limit = limit.max(least * old);
        }
    }
    safety
}

/// The soft limits of these parameters, towards which they change gradually. Those in force stay
/// while the platform is so fast that a lower pace or a larger margin would not stop it in time:
/// the guard would have to.
fn with_pace(parameters: &Parameters, washout: &Washout) -> SoftLimitParameters {
    let before = washout.parameters().soft_limit;
    let SoftLimitParameters { pace, margin } = parameters.soft_limit;
    let soft_limit = SoftLimitParameters {
        pace: pace.max((1.0 - PART) * before.pace),
        margin: margin.min(before.margin + NARROWER),
    };
    let is_gentler = soft_limit.pace < before.pace || soft_limit.margin > before.margin;
    let stops = !is_gentler || washout.soft_limits_stop(&Parameters { soft_limit, ..*parameters }, INSIDE, SLOW);
    if stops { soft_limit } else { before }
}

/// A value that has gone a part of the way to another.
fn nearer(from: f64, to: f64) -> f64 {
    match () {
        () if from == to => to,
        () if from > 0.0 && to > 0.0 => from * libm::pow(to / from, PART),
        () => from + PART * (to - from),
    }
}

/// Checks that values may change in this way while the platform moves: a scale keeps its sign, and
/// a pace is not switched on or off.
///
/// # Errors
/// The first that may not.
pub fn check_in_motion(from: &[f64], to: &[f64]) -> Result<(), ParameterError> {
    for (slot, (before, after)) in from.iter().zip(to).enumerate() {
        let name = || name_of(slot);
        if before == after {
            continue;
        }
        if before * after < 0.0 && name().starts_with("scale.") {
            return refuse(
                name(),
                format!(
                    "is {before}, and {after} has the other sign, which would turn the cue round in motion; park first"
                ),
            );
        }
        if (*before == 0.0) != (*after == 0.0) && name().ends_with(".pace") {
            return refuse(
                name(),
                format!("is {before}, and {after} would switch the soft limits in motion; park first"),
            );
        }
    }
    Ok(())
}
