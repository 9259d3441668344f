//! Reconstruction of inputs within a step without input derivatives.

use std::f64::consts::TAU;

use moris_washout::interface::{AngularVelocityFrame, RollPitchYaw};
use moris_washout::{Input, Washout};
use nalgebra::Vector3;

use crate::common::{ride, washout};

const HOLD: f64 = 1.0;
const RAMP: f64 = 2.0;

fn reconstructing(item: f64) -> Washout {
    washout(&[("input.reconstruction", item)])
}

/// Everything at once, with a heading that goes round.
fn input(t: f64) -> Input {
    let mut input = Input::default();
    input.specific_force += Vector3::new((0.7 * t).sin(), 0.5 * (1.1 * t).sin(), 0.4 * (3.0 * t).sin());
    input.angular_velocity = Vector3::new(0.05 * (2.0 * t).sin(), 0.03 * (3.0 * t).sin(), 0.1);
    input.orientation = RollPitchYaw::new(0.2 * t.sin(), 0.1 * (1.3 * t).sin(), 1.5 * t);
    input.lean = 0.1 * (0.9 * t).sin();
    input
}

#[test]
fn a_ramp_is_the_linear_course_from_the_last_step_s_input() {
    let (mut ramp, mut between) = (reconstructing(RAMP), reconstructing(RAMP));
    let mut last = Input::default();
    for k in 0..2000 {
        let (now, step) = (input(0.01 * f64::from(k)), [0.01, 0.001, 0.0037][k as usize % 3]);
        ramp.step(&now, step);
        between.step_between(&last, &now, step);
        last = now;
        // But for rounding: a step ends at its start's input plus the whole of the difference.
        let (a, b) = (ramp.output(), between.output());
        assert!((a.position - b.position).amax() < 1e-14, "step {k}");
        assert!((a.felt_specific_force - b.felt_specific_force).amax() < 1e-10, "step {k}");
    }
}

#[test]
fn held_inputs_and_ramps_come_to_the_same_in_short_steps() {
    let course = |item| {
        let mut outputs = Vec::new();
        ride(&mut reconstructing(item), 10.0, 1e-3, input, |_, output| outputs.push(*output));
        outputs
    };
    let differences =
        course(HOLD).into_iter().zip(course(RAMP)).map(|(hold, ramp)| (hold.position - ramp.position).amax());
    let largest = differences.fold(0.0, f64::max);
    assert!(largest > 0.0 && largest < 2e-4, "{largest}");
}

#[test]
fn a_step_of_the_host_is_no_jump_of_the_rate() {
    // A staircase of a roll rate: the angular acceleration that the platform makes of it in 1 ms, and in the whole step.
    let rate = |t: f64| Input { angular_velocity: Vector3::new(0.3 * (2.0 * t).sin(), 0.0, 0.0), ..Input::default() };
    let largest = |item| {
        let mut washout = reconstructing(item);
        let mut largest = 0.0_f64;
        for k in 0..200 {
            let now = rate(0.01 * f64::from(k));
            let mut roll_rate = washout.output().angular_velocity.x;
            // The internal steps of one step of the host, seen one by one.
            let mut trial = washout.clone();
            for part in 1..=10 {
                match item {
                    HOLD => trial.step(&now, 0.001),
                    _ => {
                        let (last, share) = (rate(0.01 * f64::from((k - 1).max(0))), 0.1 * f64::from(part));
                        trial.step_between(&last.towards(&now, share - 0.1), &last.towards(&now, share), 0.001);
                    }
                }
                let next = trial.output().angular_velocity.x;
                largest = largest.max((next - roll_rate).abs() / 0.001);
                roll_rate = next;
            }
            washout.step(&now, 0.01);
        }
        largest
    };
    let (hold, ramp) = (largest(HOLD), largest(RAMP));
    assert!(hold > 8.0 * ramp && ramp < 0.7, "{hold} and {ramp} rad/s2");
}

#[test]
fn an_angle_that_starts_again_is_not_turned_back_through() {
    // World rates about the vertical: their conversion to roll and pitch rates would see the heading turn back.
    let spinning = |wrapped: bool| {
        let mut washout = washout(&[("input.reconstruction", RAMP), ("gravityRemoval", 2.0)]);
        let mut outputs = Vec::new();
        for k in 0..1000 {
            let mut input = Input::default();
            let yaw = 0.05 * f64::from(k);
            input.orientation = RollPitchYaw::new(0.2, 0.1, if wrapped { yaw.rem_euclid(TAU) } else { yaw });
            input.angular_velocity = Vector3::new(0.05, 0.02, 0.1);
            washout.step(&input, 0.01);
            outputs.push(washout.output());
        }
        outputs
    };
    for (k, (a, b)) in spinning(true).iter().zip(&spinning(false)).enumerate() {
        assert!((a.position - b.position).amax() < 1e-9, "step {k}");
        assert!((a.orientation.to_vector() - b.orientation.to_vector()).amax() < 1e-9, "step {k}");
    }
}

#[test]
fn engaging_and_the_first_step_are_as_with_held_inputs() {
    let mut washout = washout(&[
        ("input.reconstruction", RAMP),
        ("angularVelocityFrame", 1.0 + f64::from(AngularVelocityFrame::Body as i32)),
    ]);
    let cue = Input { specific_force: Vector3::new(1.0, 0.0, 9.80665), engaged: false, ..Input::default() };
    // Disengaged with the step that says so, not with the next one.
    for _ in 0..1000 {
        washout.step(&cue, 0.001);
    }
    let faded = washout.clone();
    washout.step(&Input { engaged: true, ..cue }, 0.001);
    let mut still = faded;
    still.step(&cue, 0.001);
    assert_ne!(washout, still);
    // From a start with an input, the first step is a ramp from that input to itself.
    let mut started = reconstructing(RAMP).starting_with(&Input { engaged: true, ..cue });
    let mut held = reconstructing(HOLD).starting_with(&Input { engaged: true, ..cue });
    for _ in 0..100 {
        started.step(&Input { engaged: true, ..cue }, 0.01);
        held.step(&Input { engaged: true, ..cue }, 0.01);
        assert_eq!(started.output(), held.output());
    }
}
