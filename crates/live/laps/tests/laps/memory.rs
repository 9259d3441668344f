//! The memory: what it knows, and when it gives no preview.

use moris_laps::{Laps, Sample};

use crate::track::{LAP, STEP, busy_laps, laps, laps_with_pulses, mirrored};

/// Samples per lap.
const PER_LAP: usize = (LAP / STEP) as usize;

/// The memory after these samples.
fn after(samples: &[Sample]) -> Laps {
    let mut memory = Laps::new();
    samples.iter().for_each(|sample| memory.step(sample));
    memory
}

/// RMS of the preview's error 1 s ahead, over RMS of the force, from a sample on; and the fraction
/// of the time with a preview.
fn error_ahead(samples: &[Sample], from: usize) -> (f64, f64) {
    let ahead = (1.0 / STEP) as usize;
    let mut memory = Laps::new();
    let [mut error, mut force, mut given, mut count] = [0.0; 4];
    for k in 0..samples.len() - ahead {
        memory.step(&samples[k]);
        if k < from {
            continue;
        }
        let preview = memory.preview();
        count += 1.0;
        if preview.count > 0 {
            given += 1.0;
            let truth = samples[k + ahead].force;
            error += (preview.surge[4] - truth[0]).powi(2) + (preview.sway[4] - truth[1]).powi(2);
            force += truth[0].powi(2) + truth[1].powi(2);
        }
    }
    ((error / force).sqrt(), given / count)
}

#[test]
fn the_second_lap_is_forecast_through_the_crossing_at_any_rate() {
    let samples = busy_laps(2.5);
    let (error, given) = error_ahead(&samples, PER_LAP + 250);
    assert!(error < 0.2, "{error}");
    assert!(given > 0.97, "{given}");
    // With samples of 0.1 s, and without the speed.
    let mut coarse = Laps::new();
    for sample in samples.iter().step_by(5) {
        coarse.step(&Sample { step: 5.0 * STEP, speed: None, ..*sample });
    }
    let fine = after(&samples[..=(samples.len() - 1) / 5 * 5]);
    let [coarse, fine] = [coarse.preview(), fine.preview()];
    assert_eq!((coarse.count, coarse.step), (20, 0.2));
    for k in 0..20 {
        assert!((coarse.sway[k] - fine.sway[k]).abs() < 0.3, "{k}: {} {}", coarse.sway[k], fine.sway[k]);
    }
}

#[test]
fn a_height_and_any_origin_change_nothing() {
    let samples = busy_laps(1.5);
    let moved = samples.iter().map(|sample| {
        let [x, y, _] = sample.position;
        Sample { position: [x + 4e5, y - 5e6, 0.1 * x], ..*sample }
    });
    let [here, there] = [after(&samples), after(&moved.collect::<Vec<_>>())].map(|memory| memory.preview());
    assert_eq!(there.count, 20);
    for k in 0..20 {
        assert!((here.sway[k] - there.sway[k]).abs() < 0.1, "{k}: {} {}", here.sway[k], there.sway[k]);
    }
}

#[test]
fn a_curve_driven_at_another_pace_has_its_lateral_force_by_the_square() {
    let circle = |k: usize, speed: f64| {
        let angle = speed * STEP * k as f64 / 50.0;
        let position = [50.0 * angle.cos(), 50.0 * angle.sin(), 0.0];
        Sample {
            step: STEP,
            position,
            speed: Some(speed),
            force: [0.0, speed * speed / 50.0 * (1.0 + (6.0 * angle).sin())],
        }
    };
    let turn = |speed: f64| (std::f64::consts::TAU * 50.0 / speed / STEP) as usize;
    let slow = (0..4 * turn(10.0)).map(|k| circle(k, 10.0));
    let fast = (0..turn(13.0) + 300).map(|k| circle(k, 13.0));
    let preview = after(&slow.chain(fast).collect::<Vec<_>>()).preview();
    assert_eq!(preview.count, 20);
    // 1 s ahead of the last sample.
    let expected = circle(turn(13.0) + 299 + 50, 13.0).force[1];
    assert!((preview.sway[4] - expected).abs() < 0.1, "{} {expected}", preview.sway[4]);
}

#[test]
fn a_difference_of_the_present_force_lasts_for_the_next_half_second() {
    let samples = laps_with_pulses(2.0);
    let (past, now) = samples.split_at(samples.len() - 10);
    let pushed = |push: f64| {
        let mut memory = after(past);
        now.iter().for_each(|s| memory.step(&Sample { force: [s.force[0], s.force[1] + push], ..*s }));
        memory.preview()
    };
    let [as_ever, pushed] = [0.0, 1.0].map(pushed);
    let kept: Vec<f64> = pushed.sway.iter().zip(&as_ever.sway).map(|(pushed, as_ever)| pushed - as_ever).collect();
    assert!(kept[0] > 0.4 && kept[2] < kept[0] && kept[10].abs() < 0.1, "{kept:?}");
}

#[test]
fn a_vehicle_much_faster_than_ever_here_is_expected_to_slow_down() {
    let at = |x: f64, beside: f64, speed: f64| Sample {
        step: STEP,
        position: [x, beside, 0.0],
        speed: Some(speed),
        force: [1.2 * (0.4 * x).sin() + 1.2 * (0.11 * x).sin() + (0.27 * x).cos(), 0.0],
    };
    let surge = |last_speed: f64| {
        let mut memory = Laps::new();
        (0..2000).for_each(|k| memory.step(&at(10.0 * STEP * f64::from(k), 0.0, 10.0)));
        memory.interrupt();
        let mut x = 0.0;
        for k in 0..780 {
            let speed = if k < 750 { 10.0 } else { last_speed };
            x += speed * STEP;
            memory.step(&at(x, 1.0, speed));
        }
        let preview = memory.preview();
        assert_eq!(preview.count, 20, "{last_speed}");
        // The force of the place there, where the pace returns with 3 s.
        let excess = last_speed / 10.0 - 1.0;
        let there = x + 10.0 * (1.0 + excess * 3.0 * (1.0 - (-1.0_f64 / 3.0).exp()));
        preview.surge[4] - at(there, 0.0, 10.0).force[0]
    };
    assert!(surge(10.3).abs() < 0.15, "{}", surge(10.3));
    assert!(surge(14.0) < -0.5, "{}", surge(14.0));
}

#[test]
fn nothing_is_known_in_the_first_lap_and_on_another_track() {
    let mut samples = laps(0.9, 1.0);
    // The crossing of the track with itself is passed in another direction.
    let mut memory = Laps::new();
    for sample in &samples {
        memory.step(sample);
        assert_eq!((memory.preview().count, memory.trust()), (0, 0.0));
    }
    samples
        .extend(laps(1.0, 1.0).iter().map(|sample| Sample { position: [2000.0, sample.position[0], 0.0], ..*sample }));
    assert_eq!(after(&samples).preview().count, 0);
    // Back in the other direction.
    let mut samples = laps(1.0, 1.0);
    samples.extend(laps(1.0, 1.0).into_iter().rev());
    let mut memory = Laps::new();
    assert!(samples.iter().all(|sample| {
        memory.step(sample);
        memory.preview().count == 0
    }));
}

#[test]
fn after_a_jump_a_gap_and_values_that_are_no_numbers_it_goes_on() {
    let samples = busy_laps(2.4);
    let half = samples.len() - PER_LAP / 2;
    let wrong = |sample: Sample| {
        [
            Sample { position: [5000.0, 0.0, 0.0], ..sample },
            Sample { step: 3.0, ..sample },
            Sample { force: [f64::NAN, 0.0], ..sample },
            Sample { position: [f64::INFINITY, 0.0, 0.0], ..sample },
            Sample { speed: Some(f64::NAN), ..sample },
            Sample { step: -1.0, ..sample },
        ]
    };
    for wrong in wrong(samples[half]) {
        let mut memory = after(&samples[..half]);
        assert_eq!(memory.preview().count, 20);
        memory.step(&wrong);
        assert!(memory.preview().surge.iter().all(|force| force.is_finite()));
        samples[half..].iter().for_each(|sample| memory.step(sample));
        assert_eq!(memory.preview().count, 20, "{wrong:?}");
    }
    // A jump half a lap on: the place there is found again.
    let mut memory = after(&samples[..half]);
    memory.step(&samples[half - 2000]);
    assert_eq!(memory.preview().count, 0);
    samples[half - 2000..half - 1500].iter().for_each(|sample| memory.step(sample));
    assert_eq!(memory.preview().count, 20, "{}", memory.trust());
}

#[test]
fn a_vehicle_at_rest_has_no_preview() {
    let mut samples = laps(2.0, 1.0);
    let last = samples[samples.len() - 1];
    samples.extend(std::iter::repeat_n(Sample { speed: Some(0.0), force: [0.0; 2], ..last }, 100));
    assert_eq!(after(&samples).preview().count, 0);
}

#[test]
fn a_saved_memory_goes_on_to_the_bit() {
    let samples = busy_laps(2.0);
    let (past, future) = samples.split_at(PER_LAP + 1234);
    let mut memory = after(past);
    let mut restored: Laps = postcard::from_bytes(&postcard::to_allocvec(&memory).unwrap()).unwrap();
    assert_eq!(memory, restored);
    for sample in future {
        memory.step(sample);
        restored.step(sample);
        assert_eq!((memory.preview(), memory.trust()), (restored.preview(), restored.trust()));
    }
    assert!(memory.trust() > 0.5);
}

#[test]
fn steps_allocate_nothing_and_the_memory_does_not_grow() {
    let samples = laps(1.0, 1.0);
    let mut memory = Laps::new();
    let allocated = allocation_counter::measure(|| {
        // Half an hour, which is more than is kept.
        for _ in 0..23 {
            for sample in &samples {
                memory.step(sample);
                std::hint::black_box(memory.preview());
            }
        }
    });
    assert_eq!(allocated.count_total, 0);
    assert!(memory.trust() > 0.9, "{}", memory.trust());
}

#[test]
fn a_mirrored_track_is_another_one() {
    let mut samples = laps(1.0, 1.0);
    samples.extend(laps(1.0, 1.0).into_iter().map(mirrored));
    let mut memory = Laps::new();
    let given = samples.iter().filter(|sample| {
        memory.step(sample);
        memory.preview().count > 0
    });
    let given = given.count();
    assert!(given < PER_LAP / 20, "{given}");
}

#[test]
fn a_memory_of_a_text_knows_the_road_from_the_first_lap_on() {
    let learned = after(&laps_with_pulses(1.5));
    let text = learned.text();
    let mut memory = Laps::of_text(&text).unwrap();
    assert!(memory.text() == text);
    assert_eq!((memory.preview().count, memory.trust()), (0, 0.0));
    let (error, given) = {
        let samples = laps_with_pulses(1.0);
        let ahead = (1.0 / STEP) as usize;
        let [mut error, mut force, mut given] = [0.0; 3];
        for k in 0..samples.len() - ahead {
            memory.step(&samples[k]);
            let preview = memory.preview();
            if preview.count > 0 {
                given += 1.0 / (samples.len() - ahead) as f64;
                let truth = samples[k + ahead].force;
                error += (preview.sway[4] - truth[1]).powi(2);
                force += truth[1].powi(2);
            }
        }
        (f64::sqrt(error / force), given)
    };
    assert!(error < 0.25 && given > 0.9, "{error} {given}");
    // Another track is not known.
    let mut elsewhere = Laps::of_text(&text).unwrap();
    laps(0.5, 1.0).into_iter().map(mirrored).for_each(|sample| elsewhere.step(&sample));
    assert_eq!(elsewhere.preview().count, 0);
}

#[test]
fn a_text_that_is_no_memory_is_refused_with_its_line() {
    let text = after(&laps(0.1, 1.0)).text();
    let refused = |text: &str| Laps::of_text(text).unwrap_err().line;
    assert_eq!(refused(""), 1);
    assert_eq!(refused("moris-laps,2\n"), 1);
    let second = text.lines().nth(2).unwrap().to_owned();
    for wrong in ["", "0,1", "0,nan,0,0,1,0,0,1,0,0", "0,1e99,0,0,1,0,0,1,0,0", "0,0,0,0,1,0,0,1,0,0,0"] {
        assert_eq!(refused(&text.replacen(&second, wrong, 1)), 3, "{wrong}");
    }
}

#[test]
fn an_interruption_forgets_the_present_place_alone() {
    let samples = busy_laps(2.4);
    let half = samples.len() - PER_LAP / 2;
    let mut memory = after(&samples[..half]);
    assert!(memory.preview().count == 20 && memory.passes() > 0);
    memory.interrupt();
    assert_eq!((memory.preview().count, memory.passes()), (0, 0));
    samples[half..].iter().for_each(|sample| memory.step(sample));
    assert_eq!(memory.preview().count, 20);
}
