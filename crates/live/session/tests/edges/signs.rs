//! Signs of right and of wrong telemetry: climbs, hills, reversing.

use moris_live::signs::{Check, Signs, Verdict};
use moris_live::{Motion, Sample};
use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY};
use nalgebra::Vector3;

const STEP: f64 = 0.01;

fn smooth(t: f64, begin: f64, time: f64) -> f64 {
    let x = ((t - begin) / time).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

fn slope(f: impl Fn(f64) -> f64, t: f64) -> f64 {
    (f(t + 1e-4) - f(t - 1e-4)) / 2e-4
}

fn sample(force: [f64; 3], rates: [f64; 3], angles: RollPitchYaw, speed: f64) -> Sample {
    let motion = Motion::new(Vector3::from(force), Vector3::from(rates), angles, speed);
    Sample { motion, has_angles: true, ..Sample::default() }
}

fn tested(mut ride: impl FnMut(f64) -> Sample) -> Signs {
    let mut signs = Signs::default();
    for k in 0..5500 {
        let t = f64::from(k) * STEP;
        signs.take(t, &ride(t));
        assert_ne!(signs.contradiction(), Some(Check::Yaw));
    }
    signs
}

/// A vehicle without a drive's force of its own on a slope of this nose-up angle, `part` of
/// gravity's pull made up for.
fn on_slope(angle: impl Fn(f64) -> f64, part: f64, has_attitude: bool, sign: f64) -> Signs {
    let mut speed = 40.0;
    tested(|t| {
        let up = angle(t);
        let surge = part * STANDARD_GRAVITY * up.sin();
        speed += (surge - STANDARD_GRAVITY * up.sin()) * STEP;
        let angles = RollPitchYaw::new(0.0, if has_attitude { -up } else { 0.0 }, 0.0);
        let rates = [0.0, -slope(&angle, t), 0.0];
        let mut sample = sample([sign * surge, 0.0, STANDARD_GRAVITY * up.cos()], rates, angles, speed);
        sample.has_angles = has_attitude || part > 0.4;
        sample
    })
}

#[test]
fn climbs_and_hills_are_no_wrong_signs() {
    let climb = |t: f64| 0.35 * (0.5 * (t - 2.0)).sin() * smooth(t, 2.0, 2.0);
    let signs = on_slope(climb, 0.3, true, 1.0);
    assert_eq!((signs.contradiction(), signs.verdict(Check::Braking)), (None, Verdict::Agrees));
    let hills = |t: f64| 0.12 * (0.25 * t).sin();
    for part in [0.3, 0.5, 0.8] {
        assert_eq!(on_slope(hills, part, false, 1.0).contradiction(), None, "{part}");
    }
    // With the attitude a wrong sign is seen on a slope, too.
    assert_eq!(on_slope(climb, 0.3, true, -1.0).contradiction(), Some(Check::Braking));
}

/// A car that leaves a parking place in reverse, then drives for a while.
fn reversing(t: f64) -> (f64, f64, f64) {
    let speed = |t: f64| {
        -3.0 * smooth(t, 2.0, 2.0)
            + 3.0 * smooth(t, 7.0, 2.0)
            + 12.0 * smooth(t, 12.0, 4.0)
            + if t > 18.0 { 2.0 * (0.8 * (t - 18.0)).sin().powi(2) } else { 0.0 }
    };
    let rate = 0.25 * (smooth(t, 3.0, 1.0) - smooth(t, 7.0, 1.0)) + 0.2 * smooth(t, 17.0, 1.0) * (0.7 * t).sin();
    (speed(t), slope(speed, t), rate)
}

#[test]
fn reversing_with_a_speed_without_sign_is_no_wrong_sign() {
    for has_sign in [true, false] {
        let signs = tested(|t| {
            let (speed, surge, rate) = reversing(t);
            let shown = if has_sign { speed } else { speed.abs() };
            sample([surge, speed * rate, 9.8], [0.0, 0.0, rate], RollPitchYaw::default(), shown)
        });
        assert_eq!(signs.contradiction(), None, "{has_sign}");
        assert_eq!(signs.verdict(Check::Braking), Verdict::Agrees, "{has_sign}");
    }
}

#[test]
fn wrong_signs_are_refused_at_once_and_for_good() {
    for (channel, check) in [(0, Check::Braking), (1, Check::LeftTurn)] {
        for has_attitude in [true, false] {
            let signs = tested(|t| {
                let speed = 15.0 + 5.0 * (0.6 * t).sin();
                let rate = 0.3 * (0.7 * t).sin();
                let roll = if has_attitude { 0.03 * (0.3 * t).sin() } else { 0.0 };
                let side = speed * rate + STANDARD_GRAVITY * roll.sin();
                let angles = RollPitchYaw::new(roll, 0.0, -0.3 / 0.7 * (0.7 * t).cos());
                let mut sample = sample([3.0 * (0.6 * t).cos(), side, 9.8], [0.0, 0.0, rate], angles, speed);
                sample.motion.0[channel] *= -1.0;
                sample
            });
            assert_eq!(signs.contradiction(), Some(check), "{has_attitude}");
        }
    }
}

#[test]
fn a_check_that_has_agreed_stays_so() {
    let mut signs = Signs::default();
    let mut speed = 20.0;
    for k in 0..6000 {
        let t = f64::from(k) * STEP;
        let surge = 2.0 * (0.9 * t).sin();
        let up = if t > 15.0 { 0.4 * (0.3 * t).sin() } else { 0.0 };
        let force = if t > 15.0 { 0.3 * STANDARD_GRAVITY * up.sin() } else { surge };
        speed += (force - STANDARD_GRAVITY * up.sin()) * STEP;
        signs.take(t, &sample([force, 0.0, 9.8], [0.0; 3], RollPitchYaw::default(), speed));
        assert!(t < 14.0 || signs.verdict(Check::Braking) == Verdict::Agrees, "{t} s");
    }
}
