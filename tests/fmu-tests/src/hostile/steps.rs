//! Communication steps, with times and steps that are right and wrong.

use super::expected::{ERROR, OK};
use super::palette;
use super::world::World;

/// A step is not divided into more internal ones than this, to get on.
const MOST_HOSTILE_STEPS: f64 = 100.0;
/// The library makes no step longer than a million internal ones.
const LONGEST: f64 = 1e6;
/// Distance from a limit, relative to it, within which a step may be accepted or rejected.
const CLOSE: f64 = 1e-6;

/// A step, wrong in one way or not at all.
pub fn do_step(world: &mut World, who: usize) -> i32 {
    let expected = &world.players[who].expected;
    let present = expected.time;
    let max_step = expected.value("solver.maxStep");
    let stop = expected.experiment.map_or(f64::INFINITY, |(_, stop)| stop);
    let choices = &mut world.choices;
    let mut time = present;
    let mut step = match choices.below(8) {
        0..5 => 1e-3,
        5 => choices.of(&[1e-9, 1e-4, 0.01, 0.004]),
        _ => 0.05 * choices.fraction() + 1e-6,
    };
    step = step.min(MOST_HOSTILE_STEPS * max_step);
    let mut right = vec![OK];
    match choices.below(24) {
        // As a host has it that multiplies where the library adds.
        0..4 => time = f64::from_bits(time.to_bits().wrapping_add_signed(choices.below(3) as i64 - 1)),
        4 => (step, right) = (choices.of(&[0.0, -0.0, -1e-3, f64::MIN, -5e-324]), vec![ERROR]),
        5 => (step, right) = (palette::not_finite(choices), vec![ERROR]),
        6 => (time, right) = (palette::not_finite(choices), vec![ERROR]),
        7 => (time, right) = (time + choices.of(&[1.0, -1.0, 1e300]) * step.max(0.1), vec![ERROR]),
        8 => (step, right) = (2.0 * LONGEST * max_step, vec![ERROR]),
        _ => {}
    }
    // A present of 0 has no neighbour below that is finite.
    if !time.is_finite() && right == [OK] {
        time = present;
    }
    let beyond = time + step - stop;
    if beyond > CLOSE * (stop.abs() + step) {
        right = vec![ERROR];
    } else if beyond > 0.0 && right == [OK] {
        right.push(ERROR);
    }
    // SAFETY: the instance is alive.
    let answer = unsafe { world.functions.do_step(world.players[who].component, time, step) };
    if !world.players[who].expected.allows(answer.0) {
        right = vec![ERROR];
    }
    let status = world.accept(who, answer, &right);
    if status == OK {
        let player = &mut world.players[who];
        player.expected.time = time + step;
        player.check_travel(world.functions, step);
    }
    status
}
