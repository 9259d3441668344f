//! The bound against closed forms, against motions that keep the limits, and
//! against its own refinement.

use std::f64::consts::TAU;

use moris_simulation::measures::bound::{AxisLimits, Bound, TiltLimits, Trajectory, bound};

const STEP: f64 = 0.01;

const HEAVE: AxisLimits = AxisLimits { min: -0.33, max: 0.33, velocity: 1.0, acceleration: 10.0, tilt: None };

const SURGE: AxisLimits = AxisLimits {
    min: -0.45,
    max: 0.45,
    velocity: 1.0,
    acceleration: 10.0,
    tilt: Some(TiltLimits {
        angle: 0.38,
        rate: 0.052_359_877_559_829_88,
        acceleration: 0.2,
        head_height: 1.2,
        gravity: 9.80665,
    }),
};

/// Little tilt, so that its limit is active.
const LITTLE_TILT: AxisLimits = AxisLimits {
    tilt: Some(TiltLimits { angle: 0.03, rate: 0.3, acceleration: 0.5, head_height: 1.2, gravity: 9.80665 }),
    ..SURGE
};

fn sampled(duration: f64, force: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=(duration / STEP).round() as usize).map(|k| force(k as f64 * STEP)).collect()
}

fn smooth(time: f64, start: f64, length: f64) -> f64 {
    let x = ((time - start) / length).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The paper's third run: brake by 3.5 m/s2, then stop at once.
fn brusque_stop(time: f64) -> f64 {
    let braking = 2.2 * (smooth(time, 1.0, 6.6) - smooth(time, 12.0, 6.6)) - 3.5 * smooth(time, 22.0, 10.5);
    if time < 34.164_285_714 { braking } else { 0.0 }
}

/// The paper's first run with ramps of 2 s.
fn brisk(time: f64) -> f64 {
    2.0 * (smooth(time, 3.0, 2.0) - smooth(time, 15.0, 2.0)) - 2.5 * (smooth(time, 24.0, 2.0) - smooth(time, 33.6, 2.0))
}

/// Numbers between -1 and 1 that look random and are always the same.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    }
}

#[test]
fn a_force_that_asks_for_too_much_travel_has_the_closed_form_s_bound() {
    // Least integral of (p'' - f)^2 with p(0) = p'(0) = 0 and p(D) = X: p'' = f - l (D - t), l = 3 (f D^2/2 - X)/D^3. With
    // X = f D^2/4 the motion is monotonous, so that X is all that binds, and the RMS error is f (3/4)/sqrt(3).
    let (force, duration) = (1.0, 1.0);
    let limits = AxisLimits { min: -0.25, max: 0.25, velocity: 10.0, ..HEAVE };
    let expected = 0.75 / 3.0_f64.sqrt();
    let found = bound(&sampled(duration, |_| force), STEP, &limits, 0.01).unwrap();
    assert!((found.rms_error - expected).abs() < 2e-3, "{} is not {expected}", found.rms_error);
    assert!(found.rms_error <= expected && expected <= found.attained, "{} {}", found.rms_error, found.attained);
}

#[test]
fn a_force_that_only_tilt_can_give_has_the_closed_form_s_bound() {
    // No travel: the tilt goes at its rate r = g * rate from 0 to f, and the squared error's integral is f^3/(3 r).
    let (force, duration) = (1.0, 10.0);
    let tilt = TiltLimits { acceleration: 5.0, head_height: 0.0, ..SURGE.tilt.unwrap() };
    let limits = AxisLimits { min: -1e-6, max: 1e-6, acceleration: 1e-3, tilt: Some(tilt), ..SURGE };
    let expected = (1.0 / (3.0 * 9.80665 * tilt.rate * duration)).sqrt();
    let found = bound(&sampled(duration, |_| force), STEP, &limits, 0.02).unwrap();
    assert!((found.rms_error - expected).abs() < 0.01 * expected, "{} is not {expected}", found.rms_error);
    assert!(found.attained >= expected);
}

#[test]
fn a_force_beyond_the_acceleration_limit_lacks_the_rest() {
    // Quick enough that travel and speed do not matter: of a square wave of 3 m/s2, 2 m/s2 can be made.
    let square = |time: f64| if (time / 0.1) as i64 % 2 == 0 { 3.0 } else { -3.0 };
    let limits = AxisLimits { acceleration: 2.0, ..HEAVE };
    let found = bound(&sampled(5.0, square), STEP, &limits, STEP).unwrap();
    assert!((found.rms_error - 1.0).abs() < 0.06, "{}", found.rms_error);
}

#[test]
fn nothing_desired_costs_nothing() {
    let found = bound(&sampled(3.0, |_| 0.0), STEP, &SURGE, 0.02).unwrap();
    assert_eq!(found.rms_error, 0.0);
    assert!(found.attained < 1e-6);
}

#[test]
fn the_optimum_of_the_paper_s_runs_is_enclosed_ever_more_tightly() {
    for (run, duration, coarse, fine) in
        [(brusque_stop as fn(f64) -> f64, 50.0, 0.0335, 0.0018), (brisk as fn(f64) -> f64, 55.0, 0.03, 0.003)]
    {
        let desired = sampled(duration, run);
        let at = |interval| bound(&desired, STEP, &SURGE, interval).unwrap();
        let (rough, middling, sharp) = (at(0.2), at(0.1), at(0.02));
        assert!(rough.rms_error <= middling.rms_error + 1e-6 && middling.rms_error <= sharp.rms_error + 1e-6);
        assert!(sharp.attained <= middling.attained && middling.attained <= rough.attained);
        assert!(rough.attained - rough.rms_error < coarse, "{} {}", rough.rms_error, rough.attained);
        assert!(sharp.attained - sharp.rms_error < fine, "{} {}", sharp.rms_error, sharp.attained);
    }
}

#[test]
fn the_brusque_stop_cannot_be_felt_better_than_this() {
    let found = bound(&sampled(50.0, brusque_stop), STEP, &SURGE, 0.02).unwrap();
    assert!((0.1765..0.1775).contains(&found.rms_error), "{}", found.rms_error);
    assert!((0.1775..0.1790).contains(&found.attained), "{}", found.attained);
}

#[test]
fn the_motion_that_attains_it_keeps_every_limit() {
    let found = bound(&sampled(50.0, brusque_stop), STEP, &SURGE, 0.05).unwrap();
    assert_keeps(&found.trajectory, &SURGE);
    // Intervals in which the motion turns round as well.
    for interval in [0.05, 0.2, 0.5] {
        let heave = bound(&sampled(20.0, |t| 2.0 * (0.8 * t).sin()), STEP, &HEAVE, interval).unwrap();
        assert_keeps(&heave.trajectory, &HEAVE);
        let quick = bound(&sampled(20.0, |t| 4.0 * (2.0 * t).sin()), STEP, &SURGE, interval).unwrap();
        assert_keeps(&quick.trajectory, &SURGE);
        let stopped = bound(&sampled(50.0, brusque_stop), STEP, &LITTLE_TILT, interval).unwrap();
        assert_keeps(&stopped.trajectory, &LITTLE_TILT);
    }
}

/// Steps through a trajectory and compares what comes with its own knots and, at all
/// times, with the limits.
fn assert_keeps(trajectory: &Trajectory, limits: &AxisLimits) {
    const ROUNDING: f64 = 1e-5;
    let t = trajectory.interval;
    let within =
        |value: f64, limit: f64, what: &str| assert!(value.abs() <= limit * (1.0 + ROUNDING) + ROUNDING, "{what}");
    let [mut p, mut v, mut tilt_force, mut tilt_force_rate] = [0.0; 4];
    for pair in trajectory.knots.windows(2) {
        let a = (pair[1].velocity - pair[0].velocity) / t;
        let b = (pair[1].tilt_force_rate - pair[0].tilt_force_rate) / t;
        let position_within =
            |p: f64| within(p - 0.5 * (limits.max + limits.min), 0.5 * (limits.max - limits.min), "position");
        position_within(p + turning_point(v, a, t));
        let turned_tilt_force = tilt_force + turning_point(tilt_force_rate, b, t);
        p += t * (v + 0.5 * t * a);
        v += t * a;
        tilt_force += t * (tilt_force_rate + 0.5 * t * b);
        tilt_force_rate += t * b;
        assert!((p - pair[1].position).abs() < ROUNDING && (tilt_force - pair[1].tilt_force).abs() < ROUNDING);
        position_within(p);
        within(v, limits.velocity, "velocity");
        within(a, limits.acceleration, "acceleration");
        match &limits.tilt {
            None => assert!(tilt_force.abs() < ROUNDING),
            Some(tilt) => {
                within((tilt_force / tilt.gravity).asin(), tilt.angle, "tilt");
                within((turned_tilt_force / tilt.gravity).asin(), tilt.angle, "tilt within an interval");
                within(tilt_force_rate / tilt.gravity, tilt.rate, "tilt rate");
                within(b / tilt.gravity, tilt.acceleration + tilt.angle.sin() * tilt.rate.powi(2), "tilt acceleration");
            }
        }
    }
}

/// Distance to the turning point within a time `t`; 0 without one.
fn turning_point(rate: f64, acceleration: f64, t: f64) -> f64 {
    let time = -rate / acceleration;
    if (0.0..t).contains(&time) { 0.5 * rate * time } else { 0.0 }
}

#[test]
fn no_motion_within_the_limits_does_better() {
    let mut random = noise(7);
    for _ in 0..10 {
        let felt = felt_on_random_motion(&mut random);
        // Something that has to do with the motion, so that the motion is not a bad one.
        let mut drift = 0.0;
        let desired: Vec<f64> = felt
            .iter()
            .map(|f| {
                drift += 0.02 * random();
                f + drift
            })
            .collect();
        let error = (felt.iter().zip(&desired).map(|(f, d)| (f - d).powi(2)).sum::<f64>() / felt.len() as f64).sqrt();
        let Bound { rms_error, .. } = bound(&desired, STEP, &SURGE, 0.05).unwrap();
        assert!(rms_error <= error, "{rms_error} is more than {error}");
        let own = bound(&felt, STEP, &SURGE, 0.05).unwrap();
        assert!(own.rms_error < 2e-3, "a motion within the limits is felt as itself, not {} off", own.rms_error);
    }
}

/// Oscillation at the intervals' frequency, about a fixed position. Its velocity at the intervals'
/// ends is always the largest, so that the trapezoidal rule has it drift out of the travel.
#[test]
fn a_motion_that_oscillates_within_each_interval_does_not_do_better() {
    let limits = AxisLimits { acceleration: 4.0, ..HEAVE };
    for steps in [4.0, 8.0, 20.0] {
        let interval = steps * STEP;
        let phase = |t: f64| TAU * t / interval;
        // At rest up to the quarter period that brings the speed to its largest value.
        let felt = sampled(20.0, |t| if t < 0.75 * interval { 0.0 } else { -limits.acceleration * phase(t).sin() });
        let found = bound(&felt, STEP, &limits, interval).unwrap();
        assert!(found.rms_error < 1e-3, "{} m/s2 off a motion within the limits, {interval} s", found.rms_error);

        let tilt = SURGE.tilt.unwrap();
        let (arm, largest) = (tilt.head_height / tilt.gravity, tilt.gravity * tilt.acceleration);
        let amplitude = largest * (interval / TAU).powi(2);
        // The tilt moves by the amplitude up to the first interval's end, and oscillates from there.
        let felt = sampled(20.0, |t| match t < 0.75 * interval {
            true => 0.0,
            false => arm * largest * phase(t).sin() + amplitude * (phase(t).sin() + 1.0),
        });
        let found = bound(&felt, STEP, &SURGE, interval).unwrap();
        assert!(found.rms_error < 5e-3, "{} m/s2 off a tilt within the limits, {interval} s", found.rms_error);
    }
}

/// Felt signal in 20 s of a random smooth motion on [`SURGE`], which is asserted to keep the
/// limits.
fn felt_on_random_motion(random: &mut impl FnMut() -> f64) -> Vec<f64> {
    let tilt = SURGE.tilt.unwrap();
    let waves: Vec<[f64; 3]> = (0..4).map(|_| [random(), 0.2 + random().abs(), 3.0 * random()]).collect();
    let wave = |t: f64, slower: f64| waves.iter().map(|[a, w, p]| a * (slower * w * t + p).sin()).sum::<f64>();
    let scale = 0.02;
    let height = tilt.head_height;
    let [p0, v0] = [wave(0.0, 3.0), wave(STEP, 3.0) - wave(0.0, 3.0)];
    let from_rest = |t: f64| smooth(t, 0.0, 5.0);
    // Twice differentiated by differences: a motion in every sense that matters here.
    let position = |t: f64| from_rest(t) * scale * (wave(t, 3.0) - p0 - v0 * t);
    let angle = |t: f64| from_rest(t) * 0.02 * wave(t, 0.3);
    let second = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + STEP) - 2.0 * f(t) + f(t - STEP)) / STEP.powi(2);
    let first = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + STEP) - f(t - STEP)) / (2.0 * STEP);
    (0..2000)
        .map(|k| {
            let t = k as f64 * STEP;
            assert!(position(t).abs() < SURGE.max && first(&position, t).abs() < SURGE.velocity);
            assert!(second(&position, t).abs() < SURGE.acceleration);
            assert!(angle(t).abs() < tilt.angle && first(&angle, t).abs() < tilt.rate);
            assert!(second(&angle, t).abs() < tilt.acceleration);
            let s = |t: f64| tilt.gravity * angle(t).sin();
            second(&position, t) - height / tilt.gravity * second(&s, t) + s(t)
        })
        .collect()
}

#[test]
fn what_cannot_be_bounded_is_refused_with_the_reason() {
    let desired = sampled(1.0, |t| t);
    let refusal =
        |desired: &[f64], step, limits: &AxisLimits| bound(desired, step, limits, 0.02).unwrap_err().to_string();
    assert_eq!(refusal(&desired, 0.0, &SURGE), "the time between samples is 0 s; it must be above 0");
    assert_eq!(refusal(&desired[..1], STEP, &SURGE), "the recording has 1 samples; a bound needs at least 3");
    assert_eq!(
        refusal(&[0.0, f64::NAN, 0.0], STEP, &SURGE),
        "sample 1 of the desired specific force is NaN; it must be a finite number"
    );
    let limits = AxisLimits { velocity: -1.0, ..SURGE };
    assert_eq!(refusal(&desired, STEP, &limits), "the velocity limit is -1; it must be above 0");
    let limits = AxisLimits { min: 0.0, ..SURGE };
    assert_eq!(refusal(&desired, STEP, &limits), "the least position limit is 0; it must be below 0");
}
