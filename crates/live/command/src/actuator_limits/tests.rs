//! Frames with any gaps, judged by what leaves.

use super::*;

const INTERVAL: f64 = 0.01;
const SPEED: f64 = 1.0;
const ACTUATORS: Actuators = Actuators { speed: SPEED, acceleration: 15.0, stroke: [1.0, 1.6] };

/// A command at a time \[s\]: a sine of 0.1 m and 0.9 m/s at most.
fn commanded(time: f64) -> Values {
    let length = [1.3 + 0.1 * (9.0 * time).sin(); 6];
    Values { time, length, velocity: [0.9 * (9.0 * time).cos(); 6], ..Values::default() }
}

/// Frames that leave at these times \[ms\].
fn passed(limiter: &mut FrameLimiter, times: impl IntoIterator<Item = u32>) -> Vec<Values> {
    times
        .into_iter()
        .map(|time| limiter.pass(Duration::from_millis(time.into()), &commanded(f64::from(time) * 1e-3)))
        .collect()
}

/// Numbers from 0 to 1, the same with each run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Commands within the actuators' limits: full acceleration to and fro, and
/// braking before the ends.
struct Commands {
    actuators: Actuators,
    length: [f64; 6],
    velocity: [f64; 6],
    push: [f64; 6],
}

impl Commands {
    fn step(&mut self, random: &mut Random, step: f64) {
        let Actuators { speed, acceleration, stroke } = self.actuators;
        for k in 0..6 {
            if random.next() < 0.02 {
                self.push[k] = (2.5 * random.next() - 1.25).clamp(-1.0, 1.0) * acceleration;
            }
            let [length, velocity] = [self.length[k], self.velocity[k]];
            let clearance = if velocity > 0.0 { stroke[1] - length } else { length - stroke[0] } - 0.001;
            let brakes = velocity * velocity > 1.8 * acceleration * (clearance - 2.0 * velocity.abs() * step).max(0.0);
            let change =
                if brakes { -acceleration.min(velocity.abs() / step) * velocity.signum() } else { self.push[k] };
            let after = (velocity + step * change).clamp(-speed, speed);
            self.length[k] = (length + step * 0.5 * (velocity + after)).clamp(stroke[0], stroke[1]);
            self.velocity[k] = after;
        }
    }
}

#[test]
fn frames_on_time_pass_as_they_are() {
    let mut limiter = FrameLimiter::new(INTERVAL, ACTUATORS);
    for (k, values) in passed(&mut limiter, (0..3000).step_by(10)).iter().enumerate() {
        assert_eq!(*values, commanded(k as f64 * 10.0 * 1e-3));
    }
}

#[test]
fn the_change_between_frames_stays_within_the_limits_after_any_gap() {
    for gap in [20, 30, 106, 219, 700, 1670, 5000] {
        let mut limiter = FrameLimiter::new(INTERVAL, ACTUATORS);
        let times = (0..500).step_by(10).chain((490 + gap..14_000).step_by(10));
        let frames = passed(&mut limiter, times);
        let steps = frames.windows(2).map(|pair| (pair[1].length[0] - pair[0].length[0]).abs());
        let most = steps.fold(0.0, f64::max);
        assert!(most <= 1.2 * SPEED * INTERVAL, "gap of {gap} ms: {most} m in a frame");
        // It comes back to the commands.
        let last = frames.last().unwrap();
        assert_eq!(last.length, commanded(last.time).length, "gap of {gap} ms");
    }
}

/// A busy computer leaves frames out while the actuators come in from a standstill.
#[test]
fn frames_left_out_within_a_glide_are_no_jolt() {
    for seed in 0..20 {
        let (mut random, mut limiter) = (Random(seed), FrameLimiter::new(INTERVAL, ACTUATORS));
        let commanded = |time: f64| Values { time, length: [1.3 + 0.08 * (1.6 * time).sin(); 6], ..Values::default() };
        limiter.pass(Duration::ZERO, &commanded(0.0));
        let mut frames = Vec::new();
        for k in 50..1000 {
            // At most every other one.
            let is_left_out = frames.last().is_some_and(|last: &Values| last.time > f64::from(k - 2) * INTERVAL)
                && random.next() < 0.2;
            if !is_left_out {
                let time = f64::from(k) * INTERVAL;
                frames.push(limiter.pass(Duration::from_secs_f64(time), &commanded(time)));
            }
        }
        let speed = |pair: &[Values]| (pair[1].length[0] - pair[0].length[0]) / (pair[1].time - pair[0].time);
        for three in frames.windows(3) {
            let turn = 2.0 * (speed(&three[1..]) - speed(&three[..2])) / (three[2].time - three[0].time);
            // The commands' 0.2 m/s2 and the glide's own.
            assert!(turn.abs() < 0.6, "{seed}, {} s: {turn} m/s2", three[1].time);
        }
    }
}

/// Gaps of any length, losses and stops of the whole computer at any time, also within a glide.
#[test]
fn nothing_that_happens_to_frames_makes_a_jump_or_leaves_the_stroke() {
    let rigs = [ACTUATORS, Actuators { speed: 0.2, acceleration: 1.5, stroke: [0.4, 0.5] }];
    let intervals = [0.001, 0.002, 0.01, 0.017, 0.05];
    let (mut worst, mut kick) = (0.0_f64, 0.0_f64);
    for seed in 0..120 {
        let mut random = Random(seed);
        let actuators = rigs[seed as usize % 2];
        let interval = intervals[seed as usize % 5];
        let every = (interval / 1e-3_f64).round() as u64;
        let mut limiter = FrameLimiter::new(interval, actuators);
        let middle = 0.5 * (actuators.stroke[0] + actuators.stroke[1]);
        let mut commands = Commands { actuators, length: [middle; 6], velocity: [0.0; 6], push: [0.0; 6] };
        let often = [0.0, 0.02, 0.2][seed as usize % 3];
        let (mut until, mut stopped) = (0_u64, 0.0);
        let mut frames: Vec<(bool, Values)> = Vec::new();
        let mut was_late = true;
        for step in 1..=45_000_u64 {
            commands.step(&mut random, 1e-3);
            if step % every > 0 || step < until {
                continue;
            }
            if random.next() < often * interval / 0.05 && step < 20_000 {
                let seconds = [0.02, 0.05, 0.1, 0.3, 0.7, 1.9][(6.0 * random.next()) as usize] * random.next();
                match (3.0 * random.next()) as u32 {
                    0 => until = step + (1000.0 * seconds) as u64,
                    1 => stopped += seconds,
                    _ => limiter.lose(),
                }
                was_late = true;
                if step < until {
                    continue;
                }
            }
            let Commands { length, velocity, .. } = commands;
            let values = Values { time: step as f64 * 1e-3, length, velocity, ..Values::default() };
            frames.push((was_late, limiter.pass(Duration::from_secs_f64(values.time + stopped), &values)));
            was_late = false;
        }
        let inside = |values: &Values| {
            values.length.iter().all(|length| (actuators.stroke[0]..=actuators.stroke[1]).contains(length))
        };
        assert!(frames.iter().all(|(_, values)| inside(values)), "{seed}: beyond the stroke");
        for three in frames.windows(3) {
            let [(_, a), (late, b), (later, c)] = three else { unreachable!() };
            for k in 0..6 {
                let change = (c.length[k] - b.length[k]).abs() / (actuators.speed * interval);
                worst = worst.max(change);
                assert!(change <= 1.2, "{seed}, {} s: {change} times the speed", c.time);
                if !late && !later {
                    let turn = (c.length[k] - 2.0 * b.length[k] + a.length[k]).abs() / interval / interval;
                    kick = kick.max(turn / actuators.acceleration);
                    assert!(turn <= 1.35 * actuators.acceleration, "{seed}, {} s: {turn} m/s2", c.time);
                }
            }
        }
        let (_, last) = frames.last().unwrap();
        assert!(
            (0..6).all(|k| (last.length[k] - commands.length[k]).abs() < 1.01 * actuators.speed * interval),
            "{seed}"
        );
    }
    println!("at most {worst:.3} times the speed, {kick:.3} times the acceleration");
}

/// Frames that were left out near the end of the stroke, and commands that come back there.
#[test]
fn no_glide_leaves_the_stroke() {
    let mut limiter = FrameLimiter::new(INTERVAL, ACTUATORS);
    let at = |time: f64, length: f64| Values { time, length: [length; 6], ..Values::default() };
    limiter.pass(Duration::ZERO, &at(0.0, 1.59));
    for k in 20..1000 {
        let time = f64::from(k) * INTERVAL;
        let now = limiter.pass(Duration::from_secs_f64(time), &at(time, (1.4 + 0.2 * (time - 0.2)).min(1.6)));
        assert!((1.0..=1.6).contains(&now.length[0]), "{} m at {time} s", now.length[0]);
    }
}

#[test]
fn a_controller_that_was_lost_is_followed_from_where_it_was() {
    let mut limiter = FrameLimiter::new(INTERVAL, ACTUATORS);
    passed(&mut limiter, (0..500).step_by(10));
    let before = limiter.last.unwrap().1.length[0];
    limiter.lose();
    let first = limiter.pass(Duration::from_secs(9), &Values { time: 9.0, length: [1.0; 6], ..Values::default() });
    assert!((first.length[0] - before).abs() < 1e-9);
    // The commands go up meanwhile: no frame leaves the stroke, and none jumps.
    let mut last = first.length[0];
    for k in 1..4000 {
        let time = 9.0 + 0.01 * f64::from(k);
        let up = [1.0 + 0.6 * (0.2 * (time - 9.0)).min(1.0); 6];
        let now = limiter.pass(Duration::from_secs_f64(time), &Values { time, length: up, ..Values::default() });
        assert!((1.0..=1.6).contains(&now.length[0]) && (now.length[0] - last).abs() < 0.0026, "{time} s");
        last = now.length[0];
    }
    assert_eq!(last, 1.6);
    // Somebody knows where the platform is.
    limiter.forget_last_frame();
    assert_eq!(limiter.pass(Duration::from_secs(50), &commanded(50.0)).length, commanded(50.0).length);
}

/// A person may sit there: 0.25 m/s2, or three tenths of what weak actuators can.
#[test]
fn a_glide_from_rest_is_gentle() {
    for (interval, acceleration, expected) in [(1_u32, 15.0, 0.25), (10, 15.0, 0.25), (10, 0.5, 0.15)] {
        let actuators = Actuators { acceleration, ..ACTUATORS };
        let mut limiter = FrameLimiter::new(f64::from(interval) * 1e-3, actuators);
        let at =
            |time: u32, length: f64| Values { time: f64::from(time) * 1e-3, length: [length; 6], ..commanded(0.0) };
        limiter.pass(Duration::ZERO, &at(0, 1.35));
        limiter.lose();
        let times = (9_000..40_000).step_by(interval as usize);
        let lengths: Vec<f64> =
            times.map(|time| limiter.pass(Duration::from_millis(time.into()), &at(time, 1.012)).length[0]).collect();
        let turns = lengths.windows(3).map(|three| (three[2] - 2.0 * three[1] + three[0]) / limiter.interval.powi(2));
        let most = turns.fold(0.0_f64, |most, turn| most.max(turn.abs()));
        assert!((0.5..1.1).contains(&(most / expected)), "{interval} ms: {most} of {expected} m/s2");
        assert_eq!(*lengths.last().unwrap(), 1.012);
    }
}

/// The loop has ended by an error while legs move towards their ends, which they could just reach.
#[test]
fn actuators_without_a_loop_come_to_rest_within_the_stroke() {
    for (length, velocity) in [(1.3, 0.4), (1.56, 0.99), (1.04, -0.99), (1.6, 0.0)] {
        let mut limiter = FrameLimiter::new(INTERVAL, ACTUATORS);
        let values = Values { length: [length; 6], velocity: [velocity; 6], ..Values::default() };
        limiter.pass(Duration::ZERO, &values);
        let mut before = values;
        for k in 1..=100 {
            let now = limiter.at_rest_after(0.01 * f64::from(k)).unwrap();
            assert!((1.0..=1.6).contains(&now.length[0]), "{} m", now.length[0]);
            assert!((now.length[0] - before.length[0]).abs() <= velocity.abs() * 0.01);
            before = now;
        }
        assert!(before.velocity[0].abs() < 2e-3);
        let clearance = if velocity > 0.0 { 1.6 - length } else { length - 1.0 };
        assert!((before.length[0] - length).abs() <= 0.9 * clearance, "{length} m: nothing is left of the stroke");
    }
}

/// The first frame after a gap \[s\], from where the last one was \[m\].
fn first_after(interval: f64, gap: f64) -> f64 {
    let mut limiter = FrameLimiter::new(interval, ACTUATORS);
    let last = 500.0 * interval;
    (0..=500).for_each(|k| _ = pass(&mut limiter, f64::from(k) * interval));
    let before = limiter.last.unwrap().1.length[0];
    pass(&mut limiter, last + gap) - before
}

/// The length that leaves at a time \[s\].
fn pass(limiter: &mut FrameLimiter, time: f64) -> f64 {
    limiter.pass(Duration::from_secs_f64(time), &commanded(time)).length[0]
}

/// 50 ms, or three intervals: up to there they go on at their own speed.
#[test]
fn actuators_stand_after_a_gap_and_go_on_after_a_shorter_one() {
    for (interval, longest) in [(0.01, 0.05), (0.002, 0.05), (0.02, 0.06), (0.05, 0.15)] {
        for (gap, stands) in [(0.95 * longest, false), (1.05 * longest, true)] {
            let found = first_after(interval, gap);
            assert_eq!(found == 0.0, stands, "{interval} s, gap of {gap} s: {found} m");
        }
    }
}

/// Largest speed \[m/s\] on the way to a place that is 0.4 m away, after a gap.
fn glide_speed(gap: f64, is_lost: bool) -> f64 {
    let mut limiter = FrameLimiter::new(INTERVAL, ACTUATORS);
    let at = |time: f64, length: f64| Values { time, length: [length; 6], ..Values::default() };
    limiter.pass(Duration::ZERO, &at(0.0, 1.1));
    if is_lost {
        limiter.lose();
    }
    let (mut before, mut fastest) = (1.1, 0.0_f64);
    for k in 0..3000 {
        let time = gap + f64::from(k) * INTERVAL;
        let now = limiter.pass(Duration::from_secs_f64(time), &at(time, 1.5)).length[0];
        fastest = fastest.max((now - before) / INTERVAL);
        before = now;
    }
    assert!((before - 1.5).abs() < 1e-3, "{before} m");
    fastest
}

/// A tenth of the actuators' speed; 0.05 m/s to a controller that was lost, or without frames for
/// half a second.
#[test]
fn a_glide_has_its_speed() {
    for (gap, is_lost, expected) in
        [(0.01, false, 0.1), (0.1, false, 0.1), (0.49, false, 0.1), (0.51, false, 0.05), (0.01, true, 0.05)]
    {
        let found = glide_speed(gap, is_lost);
        assert!((0.9 * expected..1.01 * expected).contains(&found), "{gap} s, {is_lost}: {found} m/s");
    }
}

/// Frames come as ever: only the controller was away.
#[test]
fn a_loss_holds_for_one_frame() {
    let mut limiter = FrameLimiter::new(INTERVAL, ACTUATORS);
    let mut before = 0.0;
    for k in 0..100 {
        if k == 50 {
            limiter.lose();
        }
        let now = pass(&mut limiter, f64::from(k) * INTERVAL);
        assert_eq!(now == before, k == 50, "{k}");
        before = now;
    }
}
