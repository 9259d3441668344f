//! The automatic scale, through inputs and outputs.

use std::f64::consts::TAU;

use moris_washout::interface::AutomaticScale;
use moris_washout::{Input, Output, Parameters, Preview, Washout, presets};

use crate::common::accelerating;

const STEP: f64 = 0.01;

/// A set's parameters, with the automatic scale on.
fn automatic(set: &str) -> Parameters {
    presets::with(set, &[("scale.automatic", 2.0)])
}

/// A force that alternates in sway and a little in surge \[m/s2\].
fn slalom(size: f64) -> impl Fn(f64) -> [f64; 2] {
    move |t| {
        let faded = size * (t / 2.0).min(1.0);
        [0.3 * faded * (TAU * 0.13 * t).sin(), faded * (TAU * 0.25 * t).sin()]
    }
}

/// The outputs of a ride, with the forces that the vehicle has.
fn ridden(parameters: &Parameters, duration: f64, force: impl Fn(f64) -> [f64; 2]) -> Vec<([f64; 2], Output)> {
    let mut washout = Washout::new(parameters).unwrap();
    (1..=(duration / STEP) as usize)
        .map(|k| {
            let force = force(k as f64 * STEP);
            washout.step(&accelerating(force[0], force[1], 0.0), STEP);
            (force, washout.output())
        })
        .collect()
}

/// Fraction of the time in which the felt sway exceeds the threshold with the wrong sign.
fn wrong_sign_fraction(ride: &[([f64; 2], Output)]) -> f64 {
    let wrong = |(force, output): &&([f64; 2], Output)| {
        let felt = output.felt_specific_force.y;
        felt.abs() > 0.17 && felt * force[1] < 0.0
    };
    ride.iter().filter(wrong).count() as f64 / ride.len() as f64
}

#[test]
fn what_is_too_hard_is_felt_smaller_with_the_right_sign() {
    for set in ["", presets::OPTIMAL, presets::ROBUST] {
        let off = ridden(&presets::parameters(set), 40.0, slalom(4.5));
        let on = ridden(&automatic(set), 40.0, slalom(4.5));
        let (off, late) = (wrong_sign_fraction(&off[1000..]), &on[1000..]);
        let factor = late.last().unwrap().1.scale_factor;
        assert!(off > 0.03 && wrong_sign_fraction(late) < 0.5 * off, "{set:?}: {off}, {}", wrong_sign_fraction(late));
        assert!((0.1..0.5).contains(&factor), "{set:?}: {factor}");
    }
}

#[test]
fn a_ride_that_fits_keeps_its_size() {
    let ride = ridden(&automatic(""), 40.0, slalom(0.5));
    assert!(ride[..300].iter().all(|(_, output)| output.scale_factor >= 0.54));
    assert!(ride.last().unwrap().1.scale_factor > 0.97);
}

#[test]
fn the_factor_neither_jumps_nor_leaves_its_range() {
    for size in [0.3, 3.0, 20.0, 1e4] {
        let ride = ridden(&automatic(""), 30.0, slalom(size));
        for pair in ride.windows(2) {
            let [before, after] = [0, 1].map(|k: usize| pair[k].1.scale_factor);
            assert!(
                (0.029..=1.0).contains(&after) && (after / before).ln().abs() <= 1.01 * STEP,
                "{size}: {before} {after}"
            );
        }
    }
}

#[test]
fn in_a_pause_the_factor_waits() {
    let pause = |t: f64| if t < 20.0 { slalom(4.5)(t) } else { [0.0; 2] };
    let ride = ridden(&automatic(presets::OPTIMAL), 40.0, pause);
    let at = |t: f64| ride[(t / STEP) as usize - 1].1.scale_factor;
    assert!(at(40.0) < 1.25 * at(21.0), "{} after {}", at(40.0), at(21.0));
}

#[test]
fn after_a_spike_the_scale_comes_back() {
    let spiked = |t: f64| if (10.0..10.05).contains(&t) { [1e4, -1e4] } else { slalom(0.5)(t) };
    let ride = ridden(&automatic(""), 90.0, spiked);
    assert!(ride.last().unwrap().1.scale_factor > 0.9);
}

#[test]
fn heave_keeps_its_size() {
    let bump = |washout: &mut Washout| {
        let mut highest = 0.0_f64;
        for k in 0..300 {
            washout.step(&accelerating(0.0, 0.0, 2.0 * (0.05 * f64::from(k)).sin()), STEP);
            highest = highest.max(washout.output().position.z);
        }
        highest
    };
    let [on, off] = [automatic(presets::OPTIMAL), presets::parameters(presets::OPTIMAL)]
        .map(|parameters| bump(&mut Washout::new(&parameters).unwrap()));
    assert!(off > 0.02 && (on - off).abs() < 1e-12, "{on} m and {off} m");
}

#[test]
fn rates_follow_the_force() {
    let turned = |parameters: &Parameters| {
        let mut washout = Washout::new(parameters).unwrap();
        let mut yaw = 0.0_f64;
        for k in 0..100 {
            let mut input = Input::default();
            input.angular_velocity.z = 0.2 * (f64::from(k) * STEP * TAU).sin();
            washout.step(&input, STEP);
            yaw = yaw.max(washout.output().orientation.yaw.abs());
        }
        yaw
    };
    let ratio = turned(&automatic(presets::OPTIMAL)) / turned(&presets::parameters(presets::OPTIMAL));
    assert!((ratio - 0.55).abs() < 0.01, "{ratio}");
}

#[test]
fn a_preview_is_scaled_like_the_cue() {
    let tilted = |parameters: &Parameters| {
        let mut washout = Washout::new(parameters).unwrap();
        for _ in 0..50 {
            washout.preview(&Preview { count: 10, sway: [0.05; 20], ..Preview::default() });
            washout.step(&Input::default(), STEP);
        }
        washout.output().tilt_roll
    };
    let ratio = tilted(&automatic("")) / tilted(&presets::parameters(""));
    assert!((0.45..0.65).contains(&ratio), "{ratio}");
}

/// Brakes and bends of no common period \[m/s2\].
fn bends(t: f64) -> [f64; 2] {
    let faded = (t / 2.0).min(1.0);
    let surge = 2.0 * (3.0 * (0.9 * t + 1.2 * (0.31 * t).sin()).sin()).tanh();
    [faded * surge, faded * 3.0 * (3.0 * (1.4 * t + 1.5 * (0.37 * t).sin()).sin()).tanh()]
}

/// The preview of a force at a time, times a factor.
fn preview(force: impl Fn(f64) -> [f64; 2], t: f64, factor: f64) -> Preview {
    let ahead = |axis: usize| std::array::from_fn(|k| factor * force(t + 0.2 * (k + 1) as f64)[axis]);
    Preview { count: 20, surge: ahead(0), sway: ahead(1), ..Preview::default() }
}

/// The outputs of [`bends`], previewed times a factor, and the mean scale from 30 s on.
fn previewed(factor: f64) -> (Vec<([f64; 2], Output)>, f64) {
    let mut washout = Washout::new(&automatic(presets::PREVIEW)).unwrap();
    let mut ride = Vec::with_capacity(7000);
    let allocated = allocation_counter::measure(|| {
        for k in 1..=7000 {
            let t = f64::from(k) * STEP;
            washout.preview(&preview(bends, t, factor));
            let force = bends(t);
            washout.step(&accelerating(force[0], force[1], 0.0), STEP);
            ride.push((force, washout.output()));
        }
    });
    assert_eq!(allocated.count_total, 0);
    let late = ride.split_off(3000);
    let mean = late.iter().map(|(_, output)| output.scale_factor).sum::<f64>() / late.len() as f64;
    (late, mean)
}

#[test]
fn what_is_foreseen_is_felt_larger_and_what_is_foreseen_wrong_smaller() {
    let unknown = ridden(&automatic(presets::PREVIEW), 70.0, bends).split_off(3000);
    let without = unknown.iter().map(|(_, output)| output.scale_factor).sum::<f64>() / unknown.len() as f64;
    let (ride, known) = previewed(1.0);
    assert!(known > 1.5 * without, "{known} {without}");
    assert!(wrong_sign_fraction(&ride) < 0.06, "{}", wrong_sign_fraction(&ride));
    let (_, wrong) = previewed(-1.0);
    assert!(wrong < 0.7 * without, "{wrong} {without}");
}

#[test]
fn a_preview_without_elements_changes_nothing() {
    let parameters = automatic(presets::PREVIEW);
    let [mut none, mut empty] = [0; 2].map(|_| Washout::new(&parameters).unwrap());
    for k in 1..=1000 {
        let [surge, sway] = bends(f64::from(k) * STEP);
        empty.preview(&Preview::default());
        for washout in [&mut none, &mut empty] {
            washout.step(&accelerating(surge, sway, 0.0), STEP);
        }
        assert_eq!(none.output(), empty.output());
    }
}

/// The largest change of the felt force per second in the second after each of two switches, if
/// they switch at all.
fn felt_after_switches(switches: bool) -> (f64, Output) {
    let (on, off) = (automatic(presets::OPTIMAL), presets::parameters(presets::OPTIMAL));
    let mut washout = Washout::new(&off).unwrap();
    let mut before = washout.output();
    let mut largest = 0.0_f64;
    for k in 0..8000 {
        if switches && k == 1000 {
            washout.retune(&on).unwrap();
        }
        if switches && k == 4000 {
            washout.retune(&off).unwrap();
        }
        let [surge, sway] = slalom(2.0)(f64::from(k) * STEP);
        washout.step(&accelerating(surge, sway, 0.0), STEP);
        let after = washout.output();
        if (1000..1100).contains(&k) || (4000..4100).contains(&k) {
            largest = largest.max((after.felt_specific_force - before.felt_specific_force).xy().amax() / STEP);
        }
        before = after;
    }
    (largest, before)
}

#[test]
fn switched_in_flight_it_glides_and_off_is_off() {
    let ((switched, end), (undisturbed, _)) = (felt_after_switches(true), felt_after_switches(false));
    assert!(switched < undisturbed + 1.0, "{switched} m/s3, {undisturbed} without a switch");
    assert_eq!(end.scale_factor, 1.0);
}

#[test]
fn switched_on_or_off_at_rest_is_as_made_so() {
    let (on, off) = (automatic(""), presets::parameters(""));
    for (from, to) in [(on, off), (off, on)] {
        let mut retuned = Washout::new(&from).unwrap();
        retuned.retune(&to).unwrap();
        let mut made = Washout::new(&to).unwrap();
        for k in 0..1000 {
            let [surge, sway] = slalom(3.0)(f64::from(k) * STEP);
            for washout in [&mut retuned, &mut made] {
                washout.step(&accelerating(surge, sway, 0.0), STEP);
            }
            assert_eq!(retuned.output(), made.output());
        }
    }
}

#[test]
fn a_copy_of_its_state_continues_to_the_bit() {
    let mut washout = Washout::new(&automatic(presets::ROBUST)).unwrap();
    let input = |k: i32| {
        let [surge, sway] = slalom(4.0)(f64::from(k) * STEP);
        accelerating(surge, sway, 0.0)
    };
    for k in 0..777 {
        washout.step(&input(k), STEP);
    }
    let bytes = postcard::to_allocvec(&washout).unwrap();
    let mut copy: Washout = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(copy.parameters().automatic_scale.automatic, AutomaticScale::On);
    for k in 777..2000 {
        washout.step(&input(k), STEP);
        copy.step(&input(k), STEP);
        assert_eq!(washout.output(), copy.output());
    }
}

#[test]
fn disengaged_the_factor_stays() {
    let mut washout = Washout::new(&automatic(presets::OPTIMAL)).unwrap();
    let step = |washout: &mut Washout, k: i32, engaged: bool| {
        let [surge, sway] = slalom(4.5)(f64::from(k) * STEP);
        washout.step(&Input { engaged, ..accelerating(surge, sway, 0.0) }, STEP);
        washout.output().scale_factor
    };
    let mut factor = 0.0;
    for k in 0..2000 {
        factor = step(&mut washout, k, true);
    }
    for k in 2000..3200 {
        step(&mut washout, k, false);
    }
    let off = step(&mut washout, 3200, false);
    for k in 3201..6000 {
        assert_eq!(step(&mut washout, k, false), off);
    }
    assert!(factor < 0.5 && off < 0.6);
}
