//! Parameters that are chosen in motion.
//!
//! The washout fades changes in. Tighter limits of tilt and of the safety units would be in force
//! at once, and wait here until the platform keeps them gently.

use moris_interface::{Group as _, Reader, refuse};
use moris_washout::interface::{SafetyParameters, TiltParameters};
use moris_washout::platform::reach::pace_within_stroke;
use moris_washout::{ParameterError, Parameters, Washout};

use crate::log::name_of;

/// Part by which a limit becomes tighter in an interval.
const TIGHTENING_FRACTION: f64 = 0.108;
/// Parts of new limits within which the platform must be before they come into force.
const INSIDE_FRACTIONS: f64 = 0.8;

/// The chosen parameters.
#[derive(Clone, Debug)]
pub struct Tuning {
    target: Vec<f64>,
    /// Not all of them are in force.
    waits: bool,
}

impl Tuning {
    /// Tuning from these values of all slots, which are in force.
    pub fn new(slots: &[f64]) -> Tuning {
        Tuning { target: slots.to_vec(), waits: false }
    }

    /// The chosen values.
    pub fn target(&self) -> &[f64] {
        &self.target
    }

    /// Sets the values, which come into force by and by if this waits.
    pub fn choose(&mut self, slots: &[f64], waits: bool) {
        self.target.copy_from_slice(slots);
        self.waits = waits;
    }

    /// Puts the chosen values into force as far as the platform keeps them gently, if this step is
    /// one for that.
    pub fn apply(&mut self, washout: &mut Washout, step: u64) {
        // Steps from one change to the next.
        const CHANGE_INTERVAL_STEPS: u64 = 40;
        if !self.waits || !step.is_multiple_of(CHANGE_INTERVAL_STEPS) {
            return;
        }
        let parameters = Parameters::read(&mut Reader::new(&self.target));
        let (safety, tilt) = (safety_in_motion(&parameters, washout), tilt_in_motion(&parameters, washout));
        let gentle = Parameters { safety, tilt, ..parameters };
        self.waits = gentle != parameters;
        // Limits on the way may be refused where both ends are not: the next ones follow.
        self.waits |= washout.retune(&gentle).is_err();
    }
}

/// The tilt's limits of these parameters. Where a tilt is beyond smaller ones, or could not end
/// within them, those in force stay.
fn tilt_in_motion(parameters: &Parameters, washout: &Washout) -> TiltParameters {
    let (before, mut tilt) = (&washout.parameters().tilt, parameters.tilt);
    let output = washout.output();
    let axes = [(output.tilt_roll, output.tilt_roll_rate), (output.tilt_pitch, output.tilt_pitch_rate)];
    let fits = axes.into_iter().all(|(angle, rate)| {
        let stopping = rate * rate / (2.0 * tilt.acceleration_limit);
        angle.abs() + stopping <= INSIDE_FRACTIONS * tilt.angle_limit
            && rate.abs() <= INSIDE_FRACTIONS * tilt.rate_limit
    });
    let TiltParameters { angle_limit, rate_limit, acceleration_limit, .. } = &mut tilt;
    tighten(
        fits,
        [angle_limit, rate_limit, acceleration_limit],
        [before.angle_limit, before.rate_limit, before.acceleration_limit],
    );
    tilt
}

/// Keeps limits from what they were, or close to it where the motion fits within the new ones.
fn tighten(fits: bool, limits: [&mut f64; 3], before: [f64; 3]) {
    let least = if fits { 1.0 - TIGHTENING_FRACTION } else { 1.0 };
    for (limit, old) in limits.into_iter().zip(before) {
        *limit = limit.max(least * old);
    }
}

/// The safety units' limits of these parameters. On an axis where the platform is beyond smaller
/// ones, or too fast to stay within them gently, those in force stay.
fn safety_in_motion(parameters: &Parameters, washout: &Washout) -> SafetyParameters {
    // Least pace with which a limit is approached [1/s], where the soft limits have none.
    const MIN_PACE: f64 = 1.0;
    let (before, mut safety) = (&washout.parameters().safety, parameters.safety);
    let motion = washout.motion();
    let neutral = washout.parameters().rig.neutral_height;
    let pace = pace_within_stroke(parameters.soft_limit.pace, &parameters.rig).max(MIN_PACE);
    for k in 0..3 {
        let far = (motion.position[k] - if k == 2 { neutral } else { 0.0 }).abs();
        let [speed, change] = [motion.velocity[k].abs(), motion.acceleration[k].abs()];
        let fits = far + speed / pace <= INSIDE_FRACTIONS * safety.position_limit[k]
            && speed <= INSIDE_FRACTIONS * safety.velocity_limit[k]
            && change.max(pace * speed) <= INSIDE_FRACTIONS * safety.acceleration_limit[k];
        // Those that have waited glide, too.
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit, .. } = &mut safety;
        let limits = [&mut position_limit[k], &mut velocity_limit[k], &mut acceleration_limit[k]];
        tighten(fits, limits, [before.position_limit[k], before.velocity_limit[k], before.acceleration_limit[k]]);
    }
    safety
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
