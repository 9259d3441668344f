//! Parameters that are changed in motion.

use moris_interface::{Group as _, Reader};
use moris_live::log::slot_of;
use moris_live::{Motion, STEP, Sample, Settings};
use moris_washout::{Parameters, presets};
use nalgebra::Vector3;

use crate::feed::{Course, Packet, course, packets};

/// The largest pace of the soft limits \[rad/s\].
const FASTEST: f64 = 9.0;

fn car(t: f64) -> Motion {
    let force = Vector3::new(2.0 * (0.6 * t).cos(), 1.5 * (0.7 * t).sin(), 9.80665);
    Motion::new(force, Vector3::zeros(), Default::default(), 15.0 + 3.3 * (0.6 * t).sin())
}

/// The same until 40 s, from where its forces fade over 4 s.
fn car_that_calms(t: f64) -> Motion {
    let part = ((44.0 - t) / 4.0).clamp(0.0, 1.0);
    let force = Vector3::new(2.0 * part * (0.6 * t).cos(), 1.5 * part * (0.7 * t).sin(), 9.80665);
    Motion::new(force, Vector3::zeros(), Default::default(), 15.0)
}

/// A ride with a value of a parameter for each time, chosen at 25 Hz.
fn tuned(parameters: &Parameters, name: &str, value: impl Fn(f64) -> Option<f64>) -> Course {
    let all = packets(40.0, |t| {
        Some(Packet { arrival: t, sample: Sample { time: Some(t), motion: car(t), ..Sample::default() } })
    });
    let slot = slot_of(name).unwrap();
    let (session, course) = course(parameters, &Settings::default(), &all, 39.0, |session| {
        let step = (session.time() / STEP).round() as u64;
        if let Some(value) = value(session.time()).filter(|_| step.is_multiple_of(40)) {
            session.choose(slot, value);
            session.retune().unwrap();
        }
    });
    if let Some(last) = value(30.0) {
        let mut slots = moris_interface::slots_of(session.washout().parameters());
        assert_eq!(slots.swap_remove(slot), last, "{name}");
    }
    course
}

#[test]
fn scales_and_paces_glide_and_sliders_are_no_jolt() {
    for set in ["", presets::OPTIMAL] {
        let parameters = presets::parameters(set);
        for (name, low, high) in
            [("scale.specificForce.x", 0.1, 1.2), ("scale.specificForce.y", 0.1, 1.0), ("softLimit.pace", 3.0, 8.0)]
        {
            let at_once = tuned(&parameters, name, |t| (t > 18.0).then_some(if t < 24.0 { high } else { low }));
            let slider = tuned(&parameters, name, |t| {
                (t > 18.0).then(|| low + (high - low) * (0.5 + 0.5 * (7.0 * t.min(28.0)).sin()))
            });
            let jolts = [at_once.jolt(17.0, 38.0), slider.jolt(17.0, 38.0)];
            println!("{name}: {jolts:.2?} m/s2");
            assert!(jolts.iter().all(|jolt| *jolt <= 1.0), "{name}: {jolts:?}");
        }
    }
}

/// Soft limits that become gentler while the platform is fast would leave it to the guard.
#[test]
fn soft_limits_brake_gently_at_their_extremes_and_between() {
    let all = packets(40.0, |t| {
        Some(Packet { arrival: t, sample: Sample { time: Some(t), motion: car(t), ..Sample::default() } })
    });
    for set in ["", presets::OPTIMAL, presets::ROBUST, presets::CLASSICAL] {
        let parameters = presets::parameters(set);
        for (name, low, high) in
            [("softLimit.pace", 0.5, FASTEST), ("softLimit.pace", 0.5, 8.0), ("softLimit.margin", 0.01, 1.0)]
        {
            let held = [low, high].map(|value| {
                let mut slots = moris_interface::slots_of(&parameters);
                slots[slot_of(name).unwrap()] = value;
                let parameters = Parameters::read(&mut Reader::new(&slots));
                course(&parameters, &Settings::default(), &all, 39.0, |_| ()).1.jolt(17.0, 38.0)
            });
            let slider = |part: &dyn Fn(f64) -> f64| {
                let value = |t: f64| (t > 18.0).then(|| low + (high - low) * part(t.min(28.99)));
                tuned(&parameters, name, value).jolt(17.0, 38.0)
            };
            let moved =
                [slider(&|t| f64::from(t < 24.0)), slider(&|t| 0.5 + 0.5 * (2.0 * t).sin()), slider(&|t| t.fract())];
            println!("{name} {low} to {high}: held {held:.2?}, moved {moved:.2?} m/s2");
            let jolts = || held.iter().chain(&moved);
            assert!(jolts().all(|jolt| *jolt <= 1.0), "{name} {low} to {high}: held {held:?}, moved {moved:?}");
        }
    }
}

#[test]
fn other_signs_and_switches_are_refused_in_motion_with_the_reason() {
    let all = packets(20.0, |t| {
        Some(Packet { arrival: t, sample: Sample { time: Some(t), motion: car(t), ..Sample::default() } })
    });
    let (mut session, _) = course(&Parameters::default(), &Settings::default(), &all, 15.0, |_| ());
    for (name, value, reason) in [
        (
            "scale.specificForce.x",
            -10.0,
            "is 1, and -10 has the other sign, which would turn the cue round in motion; park first",
        ),
        ("softLimit.pace", 0.0, "is 5, and 0 would switch the soft limits in motion; park first"),
    ] {
        session.choose(slot_of(name).unwrap(), value);
        let error = session.retune().unwrap_err();
        assert_eq!((error.variable.as_str(), error.reason.as_str()), (name, reason));
        session.retune().unwrap();
    }
}

/// Coins, the same with each run.
fn coin(mut seed: u64) -> impl FnMut() -> bool {
    move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        seed.is_multiple_of(2)
    }
}

#[test]
fn smaller_limits_of_the_safety_units_wait_for_the_platform() {
    let all = packets(70.0, |t| {
        Some(Packet { arrival: t, sample: Sample { time: Some(t), motion: car_that_calms(t), ..Sample::default() } })
    });
    let limits = [("position", 0.074, 0.74), ("velocity", 0.2, 2.0), ("acceleration", 2.0, 20.0)];
    let limits = limits.map(|(name, low, high)| {
        let slots = ["x", "y", "z"].map(|axis| slot_of(&format!("safety.{axis}.{name}Limit")).unwrap());
        (slots, low, high)
    });
    let mut coin = coin(1);
    for ride in 0..8 {
        let (session, course) = course(&Parameters::default(), &Settings::default(), &all, 69.0, |session| {
            let step = (session.time() / STEP).round() as u64;
            if session.time() < 18.0 || !step.is_multiple_of(40) {
                return;
            }
            for (slots, low, high) in &limits {
                for slot in slots {
                    if coin() {
                        continue;
                    }
                    let is_low = session.time() > 26.0 || coin();
                    session.choose(*slot, if is_low { *low } else { *high });
                }
            }
            session.retune().unwrap();
        });
        let jolt = course.jolt(17.0, 68.0);
        assert!(jolt <= 1.0, "ride {ride}: {jolt:.2} m/s2");
        // In hard driving the platform may be nowhere where it could keep them.
        let safety = session.washout().parameters().safety;
        let sums = [safety.position_limit, safety.velocity_limit, safety.acceleration_limit].map(|limit| limit.sum());
        assert!(sums.iter().zip(&limits).all(|(sum, (_, low, _))| (sum - 3.0 * low).abs() < 1e-9), "{safety:?}");
    }
}

/// Sliders of several parameters at random, each from one end to the other at 25 Hz.
#[test]
fn sliders_moved_at_random_are_no_jolt() {
    const SLIDERS: [(&str, f64, f64); 6] = [
        ("scale.specificForce.x", 0.1, 1.0),
        ("softLimit.pace", 1.0, FASTEST),
        ("softLimit.margin", 0.01, 0.1),
        ("tilt.angleLimit", 0.05, 0.3),
        ("tilt.rateLimit", 0.02, 0.3),
        ("tilt.accelerationLimit", 0.1, 1.0),
    ];
    let all = packets(40.0, |t| {
        Some(Packet { arrival: t, sample: Sample { time: Some(t), motion: car(t), ..Sample::default() } })
    });
    let slots = SLIDERS.map(|(name, ..)| slot_of(name).unwrap());
    for set in ["", presets::ADAPTIVE, presets::OPTIMAL, presets::ROBUST, presets::CLASSICAL] {
        let parameters = presets::parameters(set);
        for moved in [0b000001_u32, 0b001000, 0b010000, 0b001010, 0b111111] {
            let mut coin = coin(u64::from(moved));
            let (_, course) = course(&parameters, &Settings::default(), &all, 39.0, |session| {
                let step = (session.time() / STEP).round() as u64;
                if !(18.0..30.0).contains(&session.time()) || !step.is_multiple_of(40) {
                    return;
                }
                for (k, (_, low, high)) in SLIDERS.iter().enumerate().filter(|(k, _)| moved >> k & 1 == 1) {
                    session.choose(slots[k], if coin() { *low } else { *high });
                }
                session.retune().unwrap();
            });
            let jolt = course.jolt(17.0, 38.0);
            assert!(jolt <= 1.0, "{set}, sliders {moved:06b}: {jolt:.2} m/s2");
        }
    }
}
