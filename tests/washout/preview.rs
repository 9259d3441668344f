//! A preview of the force: what a right one gains, and what a wrong one costs.

use moris_interface::{Model, SlotModel};
use moris_washout::interface::PREVIEW_SAMPLES;
use moris_washout::{Input, Preview, Washout};

use crate::common::limits::Watch;
use crate::common::manoeuvres::*;
use crate::common::random::Random;
use crate::common::{rms_difference, washout};

const STEP: f64 = 0.01;
/// Time between the preview's elements \[s\].
const APART: f64 = 0.2;

/// The force at each element's time after `time`, as `force` has it there.
fn preview(seconds: f64, time: f64, force: impl Fn(f64) -> [f64; 2]) -> Preview {
    let element = |k: usize| force(time + (k + 1) as f64 * APART);
    Preview {
        count: (seconds / APART).round() as i32,
        step: APART,
        surge: std::array::from_fn(|k| element(k)[0]),
        sway: std::array::from_fn(|k| element(k)[1]),
    }
}

fn predictive() -> Washout {
    washout(&[
        ("strategy", 4.0),
        ("scale.angularVelocity.x", 0.0),
        ("scale.angularVelocity.y", 0.0),
        ("scale.angularVelocity.z", 0.0),
    ])
}

/// RMS error of the felt force along x and y \[m/s2\] on a run with these
/// previews. No limit breaks.
fn errors(duration: f64, input: &dyn Fn(f64) -> Input, mut preview: impl FnMut(f64) -> Preview) -> [f64; 2] {
    let mut washout = predictive();
    let mut watch = Watch::new(washout.parameters(), &washout.output());
    let (mut felt, mut desired) = ([vec![], vec![]], [vec![], vec![]]);
    for k in 0..(duration / STEP).round() as usize {
        let (start, end) = (input(k as f64 * STEP), input((k + 1) as f64 * STEP));
        washout.preview(&preview(k as f64 * STEP));
        washout.step_between(&start, &end, STEP);
        let output = washout.output();
        watch.check(&output, STEP);
        for axis in 0..2 {
            felt[axis].push(output.felt_specific_force[axis]);
            desired[axis].push(end.specific_force[axis]);
        }
    }
    [0, 1].map(|axis| rms_difference(&felt[axis], &desired[axis]))
}

/// The force of a run at a time.
fn force(input: &dyn Fn(f64) -> Input, time: f64) -> [f64; 2] {
    let force = input(time).specific_force;
    [force.x, force.y]
}

type Run = (f64, Box<dyn Fn(f64) -> Input>);

fn runs() -> [Run; 3] {
    [
        (ACCELERATE_AND_BRAKE_TIME, Box::new(surging(accelerate_and_brake_briskly))),
        (WAKE_TIME, Box::new(wake)),
        (BRUSQUE_STOP_TIME, Box::new(surging(brusque_stop))),
    ]
}

#[test]
fn a_preview_brings_the_errors_near_the_bound() {
    // Errors along x and y at most, with 1 s and with 4 s; the bound on the last run is 0.18 m/s2.
    let most = [[[0.29, 0.01], [0.06, 0.02]], [[0.05, 0.06], [0.01, 0.02]], [[0.62, 0.01], [0.275, 0.01]]];
    for ((duration, input), most) in runs().iter().zip(most) {
        for (seconds, most) in [1.0, 4.0].into_iter().zip(most) {
            let error = errors(*duration, input, |time| preview(seconds, time, |time| force(input, time)));
            assert!(error[0] <= most[0] && error[1] <= most[1], "{seconds} s: {error:?}, at most {most:?}");
        }
    }
}

#[test]
fn a_wrong_preview_costs_little_and_no_limit() {
    type Wrong = (&'static str, Box<dyn Fn(f64, &dyn Fn(f64) -> Input) -> Preview>);
    let wrong: [Wrong; 6] = [
        ("1 s late", Box::new(|now, run| preview(4.0, now, |time| force(run, time - 1.0)))),
        ("1 s early", Box::new(|now, run| preview(4.0, now, |time| force(run, time + 1.0)))),
        ("doubled", Box::new(|now, run| preview(4.0, now, |time| force(run, time).map(|force| 2.0 * force)))),
        ("reversed", Box::new(|now, run| preview(4.0, now, |time| force(run, time).map(|force| -force)))),
        ("backwards", Box::new(|now, run| preview(4.0, now, |time| force(run, 2.0 * now - time)))),
        (
            "large",
            Box::new(|now, _| preview(4.0, now, |time| if time - now < 1.0 { [0.0; 2] } else { [1e300, -1e300] })),
        ),
    ];
    let runs = runs();
    for (duration, input) in &runs[..crate::cases::cases(runs.len(), 1)] {
        let without = errors(*duration, input, |_| Preview::default());
        let costs_little = |name: &str, with: [f64; 2]| {
            for axis in 0..2 {
                // Where little is wrong without a preview, 0.15 m/s2 may be with it.
                assert!(with[axis] <= 1.3 * without[axis] + 0.15, "{name}, axis {axis}: {with:?}, {without:?}");
            }
        };
        for (name, wrong) in &wrong {
            costs_little(name, errors(*duration, input, |time| wrong(time, input)));
        }
        let mut random = Random::new(3);
        let noise = |_: f64| Preview {
            count: PREVIEW_SAMPLES as i32,
            surge: [0.0; PREVIEW_SAMPLES].map(|_| random.between(-5.0, 5.0)),
            sway: [0.0; PREVIEW_SAMPLES].map(|_| random.between(-5.0, 5.0)),
            ..Preview::default()
        };
        costs_little("random", errors(*duration, input, noise));
    }
}

#[test]
fn what_is_not_a_number_ends_a_preview() {
    let (duration, input) = &runs()[1];
    let right = |time: f64| preview(4.0, time, |time| force(input, time));
    let cut = |time: f64| Preview { count: 5, ..right(time) };
    let poisoned = |time: f64| {
        let mut preview = right(time);
        (preview.surge[5], preview.sway[5]) = (f64::NAN, f64::NAN);
        preview
    };
    assert_eq!(errors(*duration, input, poisoned), errors(*duration, input, cut));
    let none = errors(*duration, input, |_| Preview::default());
    assert_eq!(errors(*duration, input, |time| Preview { step: f64::NAN, ..right(time) }), none);
    assert_eq!(errors(*duration, input, |time| Preview { count: i32::MIN, ..right(time) }), none);
    assert_eq!(
        errors(*duration, input, |time| Preview { count: i32::MAX, ..right(time) }),
        errors(*duration, input, right)
    );
}

#[test]
fn a_preview_holds_until_the_next_however_the_host_divides_its_steps() {
    let (_, input) = &runs()[0];
    let (mut coarse, mut fine) = (predictive(), predictive());
    for k in 0..1000 {
        let now = k as f64 * STEP;
        let (start, end) = (input(now), input(now + STEP));
        if k % 7 == 0 {
            let preview = preview(2.0, now, |time| force(input, time));
            coarse.preview(&preview);
            fine.preview(&preview);
        }
        coarse.step_between(&start, &end, STEP);
        for j in 0..10 {
            let at = |j: i32| start.towards(&end, f64::from(j) / 10.0);
            fine.step_between(&at(j), &at(j + 1), STEP / 10.0);
        }
    }
    let apart = (coarse.motion().position - fine.motion().position).amax();
    assert!(apart < 1e-9, "{apart}");
    assert!(coarse.motion().position.x.abs() > 0.01);
}

#[test]
fn a_ramped_input_takes_its_preview_a_step_later() {
    // A host without slopes: the same run, late by a step, with the same error but for that.
    let (duration, input) = &runs()[0];
    let preview = |time: f64| preview(4.0, time, |time| force(input, time));
    let mut washout = washout(&[("strategy", 4.0), ("input.reconstruction", 2.0)]);
    let (mut felt, mut desired) = (vec![], vec![]);
    for k in 0..(duration / STEP).round() as usize {
        let now = k as f64 * STEP;
        washout.preview(&preview(now));
        washout.step(&input(now), STEP);
        felt.push(washout.output().felt_specific_force.x);
        desired.push(input(now).specific_force.x);
    }
    let ramped = rms_difference(&felt, &desired);
    let sloped = errors(*duration, input, preview)[0];
    assert!((ramped - sloped).abs() < 0.01, "{ramped}, {sloped}");
}

#[test]
fn the_other_strategies_take_no_notice_of_a_preview() {
    for strategy in [1.0, 2.0, 3.0] {
        let mut with = washout(&[("strategy", strategy)]);
        let mut without = with.clone();
        for k in 0..500 {
            with.preview(&preview(4.0, 0.0, |time| [time, -time]));
            let input = wake(f64::from(k) * STEP);
            with.step(&input, STEP);
            without.step(&input, STEP);
        }
        assert!(with == without, "strategy {strategy}");
    }
    assert_eq!(Preview::default().surge.len(), PREVIEW_SAMPLES);
}

#[test]
fn a_host_gives_the_preview_among_the_inputs() {
    let (_, input) = &runs()[0];
    let mut slots = vec![0.0; Washout::IDENTITY.slots.len()];
    Washout::start_slots(&mut slots);
    let slot = |name: &str| Washout::IDENTITY.slot(name).unwrap();
    slots[slot("strategy")] = 4.0;
    let mut hosted = Washout::from_slots(&slots).unwrap();
    let mut own = hosted.clone();
    let mut without = hosted.clone();
    for k in 0..300 {
        let now = f64::from(k) * STEP;
        let preview = preview(4.0, now + 5.0, |time| force(input, time));
        slots[slot("vehicle.preview.count")] = f64::from(preview.count);
        for element in 0..PREVIEW_SAMPLES {
            slots[slot(&format!("vehicle.preview.specificForce.x[{}]", element + 1))] = preview.surge[element];
            slots[slot(&format!("vehicle.preview.specificForce.y[{}]", element + 1))] = preview.sway[element];
        }
        hosted.step_slots(&slots, None, STEP);
        own.preview(&preview);
        own.step(&Input::default(), STEP);
        without.step(&Input::default(), STEP);
    }
    assert!(hosted == own);
    assert!(hosted.motion() != without.motion());
}
