//! The oracle against motions of which it is known what they keep and break.

use moris_fmu_tests::hunter::oracle::{Breach, Derivative, MachineLimits, Oracle, Quantity, Safety, Sample, Worst};

const MACHINE: MachineLimits =
    MachineLimits { stroke: [1.0, 1.6], velocity: 1.0, acceleration: 15.0, radius: 0.85, size: 3.0, max_step: 1.0 };
const SAFETY: Safety = Safety { position: [0.45; 3], velocity: [1.0; 3], acceleration: [10.0; 3] };
const NEUTRAL: f64 = 1.3;

/// The coordinate in motion; the others are at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mover {
    Leg,
    Surge,
}

fn sample(mover: Mover, position: f64, velocity: f64, acceleration: f64) -> Sample {
    let mut sample = Sample { length: [NEUTRAL; 6], ..Sample::default() };
    match mover {
        Mover::Leg => {
            sample.length[3] += position;
            sample.leg_velocity[3] = velocity;
            sample.derivative.length[3] = velocity;
            sample.derivative.leg_velocity[3] = acceleration;
        }
        Mover::Surge => {
            sample.position[0] = position;
            sample.velocity[0] = velocity;
            sample.acceleration[0] = acceleration;
            sample.derivative.position[0] = velocity;
            sample.derivative.velocity[0] = acceleration;
        }
    }
    sample
}

fn at_rest() -> Sample {
    sample(Mover::Surge, 0.0, 0.0, 0.0)
}

/// A motion of pieces of constant acceleration, sampled irregularly: (time, position,
/// velocity, acceleration).
fn pieces(pieces: &[(f64, f64)]) -> Vec<(f64, f64, f64, f64)> {
    let mut samples = vec![(0.0, 0.0, 0.0, 0.0)];
    let (mut begin, mut from, mut speed) = (0.0, 0.0, 0.0);
    for &(duration, acceleration) in pieces {
        for fraction in [0.001, 0.2, 0.3, 0.7, 0.95, 1.0] {
            let t = fraction * duration;
            let (x, v) = (from + (speed + 0.5 * acceleration * t) * t, speed + acceleration * t);
            samples.push((begin + t, x, v, acceleration));
        }
        from += (speed + 0.5 * acceleration * duration) * duration;
        speed += acceleration * duration;
        begin += duration;
    }
    samples
}

fn check(mover: Mover, samples: &[(f64, f64, f64, f64)]) -> Result<Worst, Breach> {
    let mut oracle = Oracle::new(MACHINE, &SAFETY, &at_rest());
    let mut worst = Worst::default();
    for pair in samples.windows(2) {
        let (time, x, v, a) = pair[1];
        oracle.check(&sample(mover, x, v, a), time - pair[0].0, &mut worst)?;
    }
    Ok(worst)
}

/// Bang-bang at this acceleration, up to this speed and back to rest.
fn bang_bang(acceleration: f64, speed: f64) -> Vec<(f64, f64, f64, f64)> {
    pieces(&[(speed / acceleration, acceleration), (0.1, 0.0), (speed / acceleration, -acceleration)])
}

#[test]
fn a_motion_at_its_limits_is_accepted_and_known_to_be_there() {
    for (mover, acceleration) in [(Mover::Leg, 15.0), (Mover::Surge, 10.0)] {
        let worst = check(mover, &bang_bang(acceleration, 1.0)).unwrap();
        let largest = worst.iter().copied().fold(0.0, f64::max);
        assert!((0.999_999..1.000_001).contains(&largest), "{mover:?}: {largest}");
    }
}

#[test]
fn a_thousandth_of_a_percent_beyond_a_limit_is_seen() {
    for (mover, acceleration) in [(Mover::Leg, 15.0), (Mover::Surge, 10.0)] {
        for (acceleration, speed) in [(acceleration * 1.000_01, 0.9), (acceleration * 0.9, 1.000_01)] {
            check(mover, &bang_bang(acceleration, speed)).expect_err("this breaks a limit");
        }
    }
}

/// A motion that breaks one limit, and which.
fn breaks(mover: Mover, change: impl Fn(usize, &mut (f64, f64, f64, f64)), expected: &[Quantity]) {
    let mut samples = bang_bang(5.0, 0.5);
    for (number, sample) in samples.iter_mut().enumerate() {
        change(number, sample);
    }
    let breach = check(mover, &samples).expect_err("this breaks a limit");
    assert!(expected.contains(&breach.quantity), "{breach}");
}

#[test]
fn each_quantity_is_looked_at() {
    use Quantity::{
        Acceleration, LegAcceleration, LegLength, LegPositionAgainstVelocity, LegSecondDifference, LegVelocity,
        NotFinite, Position, PositionAgainstVelocity, SecondDifference, Velocity, VelocityDifference,
    };
    // Positions that contradict the velocities, velocities that contradict the
    // positions, one outlier.
    let jump = |number: usize, value: &mut f64, size: f64| *value += if number == 9 { size } else { 0.0 };
    breaks(Mover::Leg, |n, s| jump(n, &mut s.1, 1e-3), &[LegPositionAgainstVelocity, LegSecondDifference]);
    breaks(Mover::Surge, |n, s| jump(n, &mut s.1, 1e-3), &[PositionAgainstVelocity, SecondDifference]);
    breaks(Mover::Leg, |n, s| jump(n, &mut s.2, 0.4), &[LegAcceleration, LegPositionAgainstVelocity]);
    breaks(Mover::Surge, |n, s| jump(n, &mut s.2, 0.4), &[VelocityDifference, PositionAgainstVelocity]);
    breaks(Mover::Surge, |n, s| jump(n, &mut s.3, 10.1), &[Acceleration]);
    breaks(Mover::Surge, |n, s| jump(n, &mut s.3, f64::NAN), &[NotFinite]);
    // Far away, as slow as it may be: legs end at 0.3 m from here, surge at 0.45 m.
    let far =
        |mover, distance: f64| check(mover, &pieces(&[(0.05, 10.0), (distance / 0.5 - 0.05, 0.0), (0.05, -10.0)]));
    assert!(far(Mover::Leg, 0.3 - 1e-6).is_ok() && far(Mover::Surge, 0.45 - 1e-6).is_ok());
    assert_eq!(far(Mover::Leg, 0.3 + 1e-6).unwrap_err().quantity, LegLength);
    assert_eq!(far(Mover::Surge, 0.45 + 1e-6).unwrap_err().quantity, Position);
    let fast = |mover| check(mover, &pieces(&[(0.11, 10.0), (0.11, -10.0)])).unwrap_err().quantity;
    assert_eq!([fast(Mover::Leg), fast(Mover::Surge)], [LegVelocity, Velocity]);
}

#[test]
fn steps_of_a_microsecond_are_not_judged_by_their_rounding() {
    let mut oracle = Oracle::new(MACHINE, &SAFETY, &at_rest());
    let mut worst = Worst::default();
    for step in 1..100_000 {
        let time = 1e-6 * f64::from(step);
        let (x, v) = (2.5 * time * time, 5.0 * time);
        // The position with the rounding of sums of larger numbers.
        let surge = sample(Mover::Surge, (1.1 + x) - 1.1, v, 5.0);
        let leg = sample(Mover::Leg, x, v, 5.0);
        let both = Sample { length: leg.length, leg_velocity: leg.leg_velocity, ..surge };
        let mut heave = both;
        heave.position.swap(0, 2);
        heave.velocity.swap(0, 2);
        oracle.check(&heave, 1e-6, &mut worst).unwrap_or_else(|breach| panic!("at {time}: {breach}"));
    }
}

/// Surge in motion at this position and velocity, then other limits.
fn changed(position: f64, velocity: f64, safety: &Safety) -> Oracle {
    let mut oracle = Oracle::new(MACHINE, &SAFETY, &at_rest());
    let mut worst = Worst::default();
    let time = 2.0 * position / velocity;
    for step in 1..=100 {
        let t = 0.01 * f64::from(step) * time;
        let v = velocity * t / time;
        oracle.check(&sample(Mover::Surge, 0.5 * v * t, v, velocity / time), 0.01 * time, &mut worst).unwrap();
    }
    oracle.change(safety);
    oracle
}

/// Goes on from there with pieces of constant acceleration.
fn go_on(oracle: &mut Oracle, mut position: f64, mut velocity: f64, pieces: &[(f64, f64)]) -> Result<(), Breach> {
    let mut worst = Worst::default();
    for &(duration, acceleration) in pieces {
        const PARTS: u32 = 20;
        let step = duration / f64::from(PARTS);
        for _ in 0..PARTS {
            position += (velocity + 0.5 * acceleration * step) * step;
            velocity += acceleration * step;
            let velocity = if velocity.abs() < 1e-12 { 0.0 } else { velocity };
            oracle.check(&sample(Mover::Surge, position, velocity, acceleration), step, &mut worst)?;
        }
    }
    Ok(())
}

/// The guard's stop from 0.8 m/s, with 0.6 of the legs' acceleration: its acceleration, its
/// duration and its length.
const STOP: f64 = -0.6 * MACHINE.acceleration;
const STOP_TIME: f64 = -0.8 / STOP;
const STOP_LENGTH: f64 = 0.5 * 0.8 * STOP_TIME;

#[test]
fn a_stop_under_the_old_limits_is_accepted_after_a_change() {
    let tight = Safety { position: [0.05; 3], velocity: [0.1; 3], acceleration: [0.2; 3] };
    let mut oracle = changed(0.2, 0.8, &tight);
    go_on(&mut oracle, 0.2, 0.8, &[(STOP_TIME, STOP), (0.5, 0.0)]).unwrap();
    // Back within the new limits.
    go_on(&mut oracle, 0.2 + STOP_LENGTH, 0.0, &[(0.4, -0.2), (1.0, 0.0), (0.4, 0.2)]).unwrap();
}

#[test]
fn after_a_change_a_speed_above_the_new_limit_does_not_grow() {
    let tight = Safety { velocity: [0.1; 3], ..SAFETY };
    let mut oracle = changed(0.1, 0.5, &tight);
    let breach = go_on(&mut oracle, 0.1, 0.5, &[(0.01, -5.0), (0.01, 0.0), (0.01, 1.0)]).unwrap_err();
    assert!(matches!(breach.quantity, Quantity::Velocity | Quantity::MeanVelocity), "{breach}");
}

#[test]
fn after_a_change_a_speed_above_the_new_limit_does_not_grow_in_the_first_step() {
    let mut oracle = changed(0.1, 0.5, &Safety { velocity: [0.1; 3], ..SAFETY });
    let (step, acceleration, mut worst) = (0.02, 8.0, Worst::default());
    let (position, velocity) = (0.1 + (0.5 + 0.5 * acceleration * step) * step, 0.5 + acceleration * step);
    let grown = sample(Mover::Surge, position, velocity, acceleration);
    let breach = oracle.check(&grown, step, &mut worst).unwrap_err();
    assert!(matches!(breach.quantity, Quantity::Velocity | Quantity::MeanVelocity), "{breach}");
}

#[test]
fn a_position_beyond_a_changed_limit_only_comes_nearer_once_it_rests() {
    let tight = Safety { position: [0.05; 3], ..SAFETY };
    let mut oracle = changed(0.2, 0.8, &tight);
    go_on(&mut oracle, 0.2, 0.8, &[(STOP_TIME, STOP), (0.1, 0.0)]).unwrap();
    let rest = 0.2 + STOP_LENGTH;
    let outward = go_on(&mut oracle.clone(), rest, 0.0, &[(0.01, 1.0)]).unwrap_err();
    assert_eq!(outward.quantity, Quantity::PositionMovesAway);
    go_on(&mut oracle, rest, 0.0, &[(0.1, -2.0), (0.1, 2.0)]).unwrap();
    let nearer = rest - 0.02;
    let back = go_on(&mut oracle.clone(), nearer, 0.0, &[(0.01, 1.0)]).unwrap_err();
    assert_eq!(back.quantity, Quantity::PositionMovesAway);
    // Inside again, the limit is the new one on the other side, too.
    let through = go_on(&mut oracle, nearer, 0.0, &[(0.3, -3.2), (0.3, 3.2)]).unwrap_err();
    assert_eq!(through.quantity, Quantity::Position);
}

#[test]
fn a_stop_under_the_old_limits_may_pass_neutral_and_leave_the_new_limits_on_the_other_side() {
    let tight = Safety { position: [0.05; 3], ..SAFETY };
    // Out, and back with a speed that carries it through.
    let mut oracle = changed(0.1, 0.5, &SAFETY);
    let coast = (0.0805 + 0.03) / 0.8;
    go_on(&mut oracle, 0.1, 0.5, &[(0.05, -10.0), (0.08, -10.0), (coast, 0.0)]).unwrap();
    oracle.change(&tight);
    go_on(&mut oracle.clone(), -0.03, -0.8, &[(STOP_TIME, -STOP), (0.5, 0.0)]).unwrap();
    // Not for longer than a stop takes.
    go_on(&mut oracle, -0.03, -0.8, &[(1.1 * STOP_TIME, -STOP / 1.1), (0.1, 0.0)]).unwrap_err();
}

#[test]
fn a_stop_that_began_faster_may_go_on() {
    let tight = Safety { velocity: [0.001; 3], ..SAFETY };
    let mut oracle = changed(0.1, 0.8, &SAFETY);
    go_on(&mut oracle, 0.1, 0.8, &[(0.07, -10.0)]).unwrap();
    oracle.change(&tight);
    let (position, left) = (0.1 + 0.5 * (0.8 + 0.1) * 0.07, STOP_TIME - 0.07);
    // Longer than a stop from the present speed.
    assert!(left > 1.5 * 0.1 / -STOP);
    go_on(&mut oracle.clone(), position, 0.1, &[(left, -0.1 / left)]).unwrap();
    go_on(&mut oracle, position, 0.1, &[(1.2 * left, -0.1 / (1.2 * left))]).unwrap_err();
}

#[test]
fn the_legs_stop_counts_the_rates_of_all_angles() {
    let mut turning = at_rest();
    turning.derivative.orientation = [0.1, -0.2, 0.1];
    let settles = |wait: f64| {
        let mut oracle = Oracle::new(MACHINE, &SAFETY, &at_rest());
        let mut worst = Worst::default();
        oracle.check(&turning, 0.01, &mut worst).unwrap();
        oracle.change(&Safety { acceleration: [0.2; 3], ..SAFETY });
        oracle.check(&turning, wait, &mut worst).unwrap();
        // An acceleration that only the old limits allow.
        let accelerates = Sample { acceleration: [5.0, 0.0, 0.0], ..at_rest() };
        oracle.check(&accelerates, 1e-4, &mut worst)
    };
    let stop = 0.4 * MACHINE.radius / (0.6 * MACHINE.acceleration);
    settles(0.999 * stop).unwrap();
    assert_eq!(settles(1.001 * stop).unwrap_err().quantity, Quantity::Acceleration);
}

#[test]
fn the_stop_of_an_axis_that_no_sample_shows_counts() {
    let settles = |max_step: f64, wait: f64| {
        // Steady sway, and surge and heave that are at rest whenever they are seen.
        let sways = |time: f64| Sample { velocity: [0.0, 0.05, 0.0], position: [0.0, 0.05 * time, 0.0], ..at_rest() };
        let mut oracle = Oracle::new(MachineLimits { max_step, ..MACHINE }, &SAFETY, &sways(0.0));
        let mut worst = Worst::default();
        oracle.check(&sways(0.02), 0.02, &mut worst).unwrap();
        oracle.change(&Safety { acceleration: [0.2; 3], ..SAFETY });
        oracle.check(&sways(0.02 + wait), wait, &mut worst).unwrap();
        let accelerates = Sample { acceleration: [5.0, 0.0, 0.0], ..sways(0.0201 + wait) };
        oracle.check(&accelerates, 1e-4, &mut worst).map_err(|breach| breach.quantity)
    };
    let seen = 0.05 / -STOP;
    // Surge and heave may each have stopped from 10 m/s2 times 0.02 s.
    let unseen = 0.05_f64.hypot(0.2_f64.hypot(0.2)) / -STOP;
    for (max_step, stop) in [(0.02, seen), (0.01, unseen)] {
        assert_eq!(settles(max_step, 0.999 * stop), Ok(()));
        assert_eq!(settles(max_step, 1.001 * stop), Err(Quantity::Acceleration));
    }
}

#[test]
fn output_derivatives_keep_the_limits() {
    let breach = |change: fn(&mut Derivative)| {
        let mut now = at_rest();
        change(&mut now.derivative);
        let judged = Oracle::new(MACHINE, &SAFETY, &at_rest()).check(&now, 0.01, &mut Worst::default());
        judged.err().map(|breach| (breach.quantity, breach.index))
    };
    assert_eq!(breach(|derivative| derivative.leg_velocity[4] = 14.999), None);
    assert_eq!(breach(|derivative| derivative.leg_velocity[4] = -15.001), Some((Quantity::LegVelocityDerivative, 5)));
    assert_eq!(breach(|derivative| derivative.length[0] = 0.999), None);
    assert_eq!(breach(|derivative| derivative.length[0] = 1.001), Some((Quantity::LegLengthDerivative, 1)));
    assert_eq!(breach(|derivative| derivative.velocity[2] = 10.001), Some((Quantity::VelocityDerivative, 3)));
    assert_eq!(breach(|derivative| derivative.position[1] = -1.001), Some((Quantity::PositionDerivative, 2)));
    assert_eq!(breach(|derivative| derivative.position[1] = f64::NAN), Some((Quantity::NotFinite, 0)));
}

#[test]
fn an_axis_has_to_settle() {
    let tight = Safety { acceleration: [0.2; 3], velocity: [0.1; 3], ..SAFETY };
    let mut oracle = changed(0.1, 0.5, &tight);
    // Much slower than the old limits allow, and still above the new ones when it must have settled.
    let breach = go_on(&mut oracle, 0.1, 0.5, &[(1.0, -0.21)]).unwrap_err();
    assert!(matches!(breach.quantity, Quantity::Velocity | Quantity::MeanVelocity), "{breach}");
}

#[test]
fn the_old_limits_stay_for_whoever_is_beyond_the_new_ones() {
    let tight = Safety { acceleration: [0.2; 3], ..SAFETY };
    let mut oracle = changed(0.1, 0.5, &tight);
    let breach = go_on(&mut oracle, 0.1, 0.5, &[(0.01, -10.1)]).unwrap_err();
    assert!(matches!(breach.quantity, Quantity::Acceleration | Quantity::VelocityDifference), "{breach}");
    let mut oracle = changed(0.3, 1.0, &Safety { position: [0.01; 3], ..SAFETY });
    // The old position limit is kept on the way out.
    let breach = go_on(&mut oracle, 0.3, 1.0, &[(0.2, -1.0)]).unwrap_err();
    assert_eq!(breach.quantity, Quantity::PositionMovesAway, "{breach}");
}
