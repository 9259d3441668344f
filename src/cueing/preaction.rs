//! Preaction for an abrupt stop (the paper's section 6).
//!
//! An abrupt stop ends the whole deceleration at once, but the tilt that represents it can only
//! change at its rate limit. Preaction therefore begins before the stop, whose time follows from
//! speed and deceleration.
//!
//! - Tilt: it changes at its rate limit, from before the stop until after it.
//! - Surge: it adds the force that the tilt lacks before the stop, and cancels the rest of the tilt
//!   after it, as far as the stroke reaches. The platform moves backwards ever faster until the
//!   stop, and slows down after it.
//! - Positioning: well before the stop the platform moves forward, too gently to be felt,
//!   to make way for that.

use serde::{Deserialize, Serialize};

use crate::interface::{SafetyParameters, TiltParameters};
use crate::motion::Motion;
use crate::motion::braking_law::Limits;
use crate::motion::square_root::square_root;

/// Preaction with its state: the predicted stop, the tilt ahead of it and the surge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StopPreaction {
    /// The longest step that may ever be taken \[s\].
    max_step: f64,
    /// The vehicle's deceleration, smoothed \[m/s2\].
    deceleration: f64,
    /// Time until standstill \[s\], infinite without braking.
    time_left: f64,
    /// Largest rate of the force represented by the tilt \[m/s3\].
    slew: f64,
    /// Force that the tilt was to represent at the end of the last step \[m/s2\]. `reduced` is true
    /// if that was less than asked for.
    tilted_for: f64,
    reduced: bool,
    /// Tilt left after the stop, as a force \[m/s2\]; never positive.
    carried: f64,
    surge: Motion,
    phase: Phase,
}

/// Motion of the surge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Phase {
    /// Gently forward if a stop is coming, else to neutral.
    Waiting,
    /// Backwards with a growing acceleration, which reaches this one at the stop \[m/s2\].
    Launching { acceleration: f64 },
    /// Slowing down after the stop, from this speed \[m/s\].
    Recovering { from: f64 },
}

/// Time constant of the deceleration's smoothing \[s\].
const SMOOTHING_TIME: f64 = 0.2;
/// Smallest deceleration that counts as braking \[m/s2\].
const LEAST_DECELERATION: f64 = 0.5;
/// Fraction of the force for which the platform is still tilted at the stop. The errors before and
/// after the stop are then about equal.
const FRACTION_AT_STOP: f64 = 0.45;
/// Time from the surge's launch to the stop, and from the stop to the end of its recovery \[s\].
const LAUNCH_TIME: f64 = 1.5;
/// The fractions of the safety limits that the launch uses.
const FRACTION_OF_POSITION: f64 = 0.9;
const FRACTION_OF_VELOCITY: f64 = 0.8;
/// Fraction of the clearance behind the platform for which the launch is planned: the stop may
/// come later than foreseen.
const FRACTION_OF_CLEARANCE: f64 = 0.9;
/// Time before the stop at which the platform begins to move forward \[s\].
const POSITIONING_TIME: f64 = 9.0;
/// Acceleration of this forward motion, which riders hardly perceive \[m/s2\], and its
/// largest speed \[m/s\].
const GENTLE_ACCELERATION: f64 = 0.05;
const GENTLE_VELOCITY: f64 = 0.3;
/// Speed below which the surge has recovered \[m/s\].
const RECOVERED_SPEED: f64 = 1e-3;

impl StopPreaction {
    /// At rest, with no stop ahead.
    pub fn new(max_step: f64) -> Self {
        StopPreaction {
            max_step,
            deceleration: 0.0,
            time_left: f64::INFINITY,
            slew: 0.0,
            tilted_for: 0.0,
            reduced: false,
            carried: 0.0,
            surge: Motion::default(),
            phase: Phase::Waiting,
        }
    }

    /// Advances by `step` seconds. At their end, `force` is the force to be felt along x \[m/s2\].
    /// `acceleration` \[m/s2\] and `speed` \[m/s\] are the vehicle's.
    pub fn advance(
        &mut self,
        [force, acceleration, speed]: [f64; 3],
        gravity: f64,
        tilt: &TiltParameters,
        safety: &SafetyParameters,
        step: f64,
    ) {
        let TiltParameters { rate_limit, acceleration_limit: _, angle_limit: _, tracking: _ } = *tilt;
        self.slew = gravity * rate_limit;
        self.deceleration += (-acceleration - self.deceleration) * (1.0 - libm::exp(-step / SMOOTHING_TIME));
        let braking = -acceleration > LEAST_DECELERATION && self.deceleration > LEAST_DECELERATION && speed > 0.0;
        if braking {
            self.time_left = speed / self.deceleration;
            self.carried = 0.0;
        } else {
            // A stop: the tilt continues at its rate limit.
            let left_over = if self.reduced { self.tilted_for - force } else { self.carried };
            self.time_left = f64::INFINITY;
            self.carried = (left_over + self.slew * step).min(0.0);
        }
        self.tilted_for = self.tilted_force(force);
        self.reduced = braking && self.tilted_for > force;
        self.move_surge(force, safety, step);
    }

    /// The force along x that replaces `force` in the cue, for tilt and for the
    /// splitter's high-pass.
    pub fn tilted_force(&self, force: f64) -> f64 {
        if self.time_left.is_finite() {
            force.max(FRACTION_AT_STOP * force - self.slew * self.time_left)
        } else {
            force + self.carried
        }
    }

    /// Time until the vehicle stops, infinite while it does not brake \[s\].
    pub fn time_left(&self) -> f64 {
        self.time_left
    }

    /// The surge that is planned beside the filters' \[m\].
    pub fn surge(&self) -> &Motion {
        &self.surge
    }

    fn move_surge(&mut self, force: f64, safety: &SafetyParameters, step: f64) {
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = safety;
        let farthest = FRACTION_OF_POSITION * position_limit.x;
        // The recovery covers a third of its time times the present speed.
        let clearance = (self.surge.position + farthest).max(0.0);
        let launching = self.time_left < LAUNCH_TIME && -self.surge.velocity * LAUNCH_TIME < 3.0 * clearance;
        self.phase = match self.phase {
            // Cancelled before the platform moved backwards: there is nothing to recover from.
            Phase::Launching { .. } if !launching && self.surge.velocity > -RECOVERED_SPEED => Phase::Waiting,
            Phase::Launching { .. } if !launching => Phase::Recovering { from: -self.surge.velocity },
            Phase::Recovering { .. } if self.surge.velocity > -RECOVERED_SPEED => Phase::Waiting,
            Phase::Waiting if launching => {
                // Both halves together cover acceleration * time^2 / 3, at a speed of at most
                // acceleration * time / 2.
                let fastest = FRACTION_OF_VELOCITY * velocity_limit.x;
                let clearance = FRACTION_OF_CLEARANCE * clearance;
                let acceleration = (3.0 * clearance / (LAUNCH_TIME * LAUNCH_TIME)).min(2.0 * fastest / LAUNCH_TIME);
                Phase::Launching { acceleration: acceleration.min(acceleration_limit.x) }
            }
            phase => phase,
        };
        self.surge = match self.phase {
            Phase::Waiting => {
                let goal = if self.time_left < POSITIONING_TIME { farthest } else { 0.0 };
                self.gently_towards(goal, safety, step)
            }
            Phase::Launching { acceleration } => {
                let growing = acceleration * (1.0 - self.time_left / LAUNCH_TIME);
                self.accelerated(-growing.min(self.tilted_for - force), step)
            }
            Phase::Recovering { from } => {
                let deceleration = 2.0 * square_root(from * self.surge.velocity.abs()) / LAUNCH_TIME;
                self.accelerated(deceleration.min(-self.surge.velocity / step), step)
            }
        };
    }

    /// The surge after a step towards a position, too gentle to be felt.
    fn gently_towards(&self, position: f64, safety: &SafetyParameters, step: f64) -> Motion {
        let limits = Limits::symmetric(safety.position_limit.x, GENTLE_VELOCITY, GENTLE_ACCELERATION, self.max_step);
        limits.follow(&self.surge, &Motion::at_rest(position), GENTLE_ACCELERATION, step)
    }

    fn accelerated(&self, acceleration: f64, step: f64) -> Motion {
        let velocity = self.surge.velocity + acceleration * step;
        let position = self.surge.position + 0.5 * (self.surge.velocity + velocity) * step;
        Motion { position, velocity, acceleration }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAVITY: f64 = 9.81;
    const STEP: f64 = 0.01;
    const DECELERATION: f64 = 3.0;

    /// A vehicle that has braked for long, with this time left to its stop.
    fn braking(time_left: f64, safety: &SafetyParameters) -> StopPreaction {
        let mut preaction = StopPreaction::new(STEP);
        for _ in 0..1000 {
            step(&mut preaction, 1e3, safety);
        }
        step(&mut preaction, time_left, safety);
        preaction
    }

    /// A step of braking with this time left.
    fn step(preaction: &mut StopPreaction, time_left: f64, safety: &SafetyParameters) {
        let felt = [-DECELERATION, -DECELERATION, DECELERATION * time_left];
        preaction.advance(felt, GRAVITY, &TiltParameters::default(), safety, STEP);
    }

    fn safety(position: f64, velocity: f64, acceleration: f64) -> SafetyParameters {
        let mut safety = SafetyParameters::default();
        (safety.position_limit.x, safety.velocity_limit.x, safety.acceleration_limit.x) =
            (position, velocity, acceleration);
        safety
    }

    #[test]
    fn the_time_to_the_stop_is_the_speed_by_the_smoothed_deceleration() {
        let mut preaction = StopPreaction::new(STEP);
        for k in 1..200 {
            let speed = 30.0 - DECELERATION * STEP * f64::from(k);
            let felt = [-DECELERATION, -DECELERATION, speed];
            preaction.advance(felt, GRAVITY, &TiltParameters::default(), &SafetyParameters::default(), STEP);
            let smoothed = DECELERATION * (1.0 - (-STEP * f64::from(k) / 0.2).exp());
            let expected = if smoothed > 0.5 { speed / smoothed } else { f64::INFINITY };
            let found = preaction.time_left();
            assert!(found == expected || (found - expected).abs() < 1e-9 * expected, "{found} s, not {expected} s");
        }
    }

    #[test]
    fn after_a_stop_the_tilt_continues_at_its_rate_limit() {
        let tilt = TiltParameters::default();
        let mut preaction = braking(0.01, &SafetyParameters::default());
        let before = preaction.tilted_force(-DECELERATION);
        assert!(before > -0.5 * DECELERATION, "{before}");
        for k in 1..10 {
            // The vehicle feels a force after its stop, too.
            preaction.advance([0.5, 0.0, 0.0], GRAVITY, &tilt, &SafetyParameters::default(), STEP);
            let expected = before + f64::from(k) * STEP * GRAVITY * tilt.rate_limit;
            assert!((preaction.tilted_force(0.5) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn the_launch_uses_what_the_scarcest_limit_leaves() {
        // By the clearance behind the platform, by the speed, and by the acceleration.
        for (limits, expected) in [
            (safety(0.2, 10.0, 10.0), 3.0 * 0.9 * (0.9 * 0.2) / (1.5 * 1.5)),
            (safety(0.5, 0.3, 10.0), 2.0 * 0.8 * 0.3 / 1.5),
            (safety(0.5, 10.0, 0.1), 0.1),
        ] {
            let preaction = braking(1.49, &limits);
            let Phase::Launching { acceleration } = preaction.phase else { panic!("{:?}", preaction.phase) };
            // The platform was moved forward a little in one step.
            assert!((acceleration - expected).abs() < 1e-4, "{acceleration} m/s2, not {expected} m/s2");
        }
    }

    #[test]
    fn a_launch_without_speed_is_cancelled_and_one_with_speed_recovers() {
        let limits = SafetyParameters::default();
        let mut preaction = braking(1.49, &limits);
        step(&mut preaction, 100.0, &limits);
        assert_eq!(preaction.phase, Phase::Waiting);

        let mut preaction = braking(1.49, &limits);
        for k in 0..100 {
            step(&mut preaction, 1.49 - STEP * f64::from(k), &limits);
        }
        let speed = -preaction.surge().velocity;
        assert!(speed > 0.01, "{speed}");
        step(&mut preaction, 100.0, &limits);
        assert_eq!(preaction.phase, Phase::Recovering { from: speed });
    }

    #[test]
    fn the_surge_takes_no_more_than_the_tilt_leaves_over() {
        let mut preaction = StopPreaction::new(STEP);
        preaction.phase = Phase::Launching { acceleration: 2.0 };
        (preaction.time_left, preaction.tilted_for) = (0.3, -1.0);
        preaction.move_surge(-1.05, &safety(0.5, 1.0, 10.0), STEP);
        assert!((preaction.surge.acceleration + 0.05).abs() < 1e-12, "{:?}", preaction.surge);
        preaction.move_surge(-9.0, &safety(0.5, 1.0, 10.0), STEP);
        let growing = 2.0 * (1.0 - 0.3 / LAUNCH_TIME);
        assert!((preaction.surge.acceleration + growing).abs() < 1e-12, "{:?}", preaction.surge);
    }

    #[test]
    fn a_recovery_eases_out_and_ends_at_rest_within_a_step() {
        let mut preaction = StopPreaction::new(STEP);
        preaction.phase = Phase::Recovering { from: 0.2 };
        preaction.surge.velocity = -0.1;
        preaction.move_surge(0.0, &safety(0.5, 1.0, 10.0), STEP);
        assert!((preaction.surge.acceleration - 2.0 * 0.02_f64.sqrt() / LAUNCH_TIME).abs() < 1e-12);

        const LONG: f64 = 0.2;
        let mut preaction = StopPreaction::new(LONG);
        preaction.phase = Phase::Recovering { from: 0.2 };
        preaction.surge.velocity = -0.0011;
        // Easing out alone would turn the surge round.
        assert!(2.0 * (0.2_f64 * 0.0011).sqrt() / LAUNCH_TIME * LONG > 0.0011);
        preaction.move_surge(0.0, &safety(0.5, 1.0, 10.0), LONG);
        assert!(preaction.surge.velocity.abs() < 1e-15, "{:?}", preaction.surge);
    }
}
