//! Times of samples. Bursts, a stopped loop, clocks of other rates, the delay and spikes are tried.

use moris_live::{Motion, STEP, Sample, Session, Settings, State};
use moris_washout::Parameters;
use moris_washout::interface::RollPitchYaw;
use nalgebra::Vector3;

use crate::feed::{Course, Packet, course, packets};

/// A car that brakes and turns: forces up to 3 m/s2.
fn car(t: f64) -> Motion {
    let speed = 15.0 + 3.0 * (0.6 * t).sin();
    let rate = 0.15 * (0.7 * t).sin();
    let surge = 3.0 * 0.6 * (0.6 * t).cos();
    let force = Vector3::new(surge, speed * rate, 9.80665);
    let angles = RollPitchYaw::new(0.0, 0.0, -0.15 / 0.7 * (0.7 * t).cos());
    Motion::new(force, Vector3::new(0.0, 0.0, rate), angles, speed)
}

fn sample(t: f64, clock: Option<f64>) -> Sample {
    Sample { time: clock, motion: car(t), ..Sample::default() }
}

fn ride(packets: &[Packet], duration: f64, act: impl FnMut(&mut Session)) -> (Session, Course) {
    course(&Parameters::default(), &Settings::default(), packets, duration, act)
}

/// A ride whose packets are held from 20 s on for this time.
fn held(time: f64, has_clock: bool) -> Course {
    let late = |t: f64| if t >= 20.0 && t < 20.0 + time { 20.0 + time } else { t };
    let all = packets(30.0, |t| Some(Packet { arrival: late(t), sample: sample(t, has_clock.then_some(t)) }));
    ride(&all, 30.0, |_| ()).1
}

#[test]
fn packets_that_were_held_up_are_no_jolt() {
    for has_clock in [true, false] {
        let undisturbed = held(0.0, has_clock).jolt(18.0, 28.0);
        for time in [0.1, 0.3, 0.45, 0.6, 0.9, 1.4] {
            let jolt = held(time, has_clock).jolt(18.0, 28.0);
            println!("clock {has_clock}, held for {time} s: jolt {jolt:.2}, undisturbed {undisturbed:.2} m/s2");
            assert!(jolt <= 1.0, "clock {has_clock}, held for {time} s: {jolt} m/s2");
        }
    }
}

#[test]
fn a_loop_that_was_stopped_is_no_jolt() {
    for has_clock in [true, false] {
        for time in [0.03, 0.1, 0.3, 0.6, 1.0] {
            // The packets go on while no step is made; afterwards all arrivals are earlier.
            let late = |t: f64| if t > 20.0 { t - time } else { t };
            let mut slips = true;
            // The receiver's times of those in between are before those of the last step.
            let mut sent: Vec<Packet> = (0..3000)
                .map(|k| f64::from(k) * 0.01)
                .map(|t| Packet { arrival: late(t), sample: sample(t, has_clock.then_some(t)) })
                .collect();
            sent.iter_mut().for_each(|packet| packet.arrival += 1e-9);
            let (_, course) = ride(&sent, 28.0, |session| {
                if slips && session.time() >= 20.0 {
                    session.slip(time);
                    slips = false;
                }
            });
            let jolt = course.jolt(18.0, 27.0);
            println!("clock {has_clock}, stopped for {time} s: jolt {jolt:.2} m/s2");
            assert!(jolt <= 1.0, "clock {has_clock}, stopped for {time} s: {jolt} m/s2");
        }
    }
}

#[test]
fn clocks_of_other_rates_are_followed_without_teleports_and_growing_lag() {
    for rate in [0.5, 0.9, 0.95, 0.99, 0.995, 1.0, 1.005] {
        let jitter = |t: f64| 0.003 * ((t * 100.0).round() * 0.618).fract();
        let all = packets(60.0, |t| Some(Packet { arrival: t + jitter(t), sample: sample(t, Some(rate * t)) }));
        let mut lag = Vec::new();
        let (session, course) = ride(&all, 58.0, |session| {
            if session.time() > 20.0 {
                lag.push((session.time() - session.delay(), session.passed().0[8]));
            }
        });
        assert_eq!(session.source().counts().teleports, 0, "{rate}");
        assert_eq!((course.begins(State::Engaging), course.begins(State::Engaged)), (1, 1), "{rate}");
        assert!(course.jolt(5.0, 57.0) <= 1.0, "{rate}: {} m/s2", course.jolt(5.0, 57.0));
        let worst = lag.iter().map(|(time, yaw)| (yaw - car(*time).0[8]).abs()).fold(0.0, f64::max);
        // 0.15 rad/s times 15 ms.
        assert!(worst < 0.15 * 0.015, "{rate}: {worst} rad");
        assert!(course.delay.last().unwrap() < &0.03, "{rate}: {} s", course.delay.last().unwrap());
    }
}

#[test]
fn slow_motion_in_the_middle_of_a_ride_is_no_teleport() {
    // The game runs at half the speed from 20 to 30 s.
    let game = |t: f64| {
        if t < 20.0 {
            t
        } else if t < 30.0 {
            20.0 + 0.5 * (t - 20.0)
        } else {
            t - 5.0
        }
    };
    let all = packets(45.0, |t| Some(Packet { arrival: t, sample: sample(game(t), Some(game(t))) }));
    let (session, course) = ride(&all, 44.0, |_| ());
    assert_eq!(session.source().counts().teleports, 0);
    assert_eq!(course.begins(State::Engaging), 1);
    assert!(course.jolt(18.0, 43.0) <= 1.0, "{} m/s2", course.jolt(18.0, 43.0));
}

#[test]
fn the_delay_is_that_of_most_gaps_and_goes_down_in_flight() {
    // A loading screen of 0.2 s, 1 s before it engages, and a network of gaps of 45 ms until 20 s.
    let late = |t: f64| match t {
        t if (2.0..2.2).contains(&t) => 2.2,
        t if t < 20.0 => (t / 0.04).ceil() * 0.04,
        t => t,
    };
    let all = packets(60.0, |t| Some(Packet { arrival: late(t), sample: sample(t, Some(t)) }));
    let (session, course) = ride(&all, 59.0, |_| ());
    assert!((0.04..0.06).contains(&course.delay[10_000]), "{} s", course.delay[10_000]);
    assert!(session.delay() < 0.02 && !session.is_delay_long(), "{} s", session.delay());
    assert!(course.delay[5000..].windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 0.021 * STEP));
    assert!(course.jolt(18.0, 58.0) <= 1.0);
    // Gaps of 80 ms are warned of.
    let all = packets(20.0, |t| Some(Packet { arrival: (t / 0.08).ceil() * 0.08, sample: sample(t, Some(t)) }));
    assert!(ride(&all, 15.0, |_| ()).0.is_delay_long());
    // Samples of a source inside that come 10 ms before their time need none.
    let all = packets(20.0, |t| Some(Packet { arrival: t - 0.012, sample: sample(t, Some(t)) }));
    let settings = Settings { is_inside: true, ..Settings::default() };
    let (session, _) = course_inside(&settings, &all);
    assert_eq!(session.delay(), 0.0);
    let expected = car(session.time());
    assert!((session.passed().0 - expected.0).amax() < 2e-3);
}

/// A source inside: its samples have their own time as their arrival, and come before it.
fn course_inside(settings: &Settings, packets: &[Packet]) -> (Session, ()) {
    let mut session = Session::new(&Parameters::default(), settings).unwrap();
    session.handle(moris_live::Event::Start).unwrap();
    let mut next = 0;
    for _ in 0..15_000 {
        while next < packets.len() && packets[next].arrival <= session.time() {
            session.receive(packets[next].sample.time.unwrap(), &packets[next].sample);
            next += 1;
        }
        if session.state() == State::Neutral {
            session.handle(moris_live::Event::Engage).unwrap();
        }
        session.step();
    }
    (session, ())
}

#[test]
fn spikes_that_no_vehicle_causes_are_left_out() {
    for spike in [999.0, 200.0, 90.0, 30.0, -15.0] {
        let all = packets(30.0, |t| {
            let mut sample = sample(t, Some(t));
            let k = (t * 100.0).round() as u64;
            if t > 15.0 && k.is_multiple_of(37) {
                sample.motion.0[(k / 37) as usize % 3] += spike;
            }
            Some(Packet { arrival: t, sample })
        });
        let (session, course) = ride(&all, 29.0, |_| ());
        assert!(session.source().counts().bad >= 37, "{}", session.source().counts().bad);
        assert!(course.jolt(14.0, 29.0) <= 0.3, "{spike}: {} m/s2", course.jolt(14.0, 29.0));
    }
}

/// Spikes that a vehicle could just make, many of them side by side. An attitude swings by
/// less than a teleport.
#[test]
fn what_no_vehicle_does_over_a_window_is_not_felt() {
    type Fault = fn(&mut Sample, u64, f64);
    // The first of many spikes may stand side by side, as in a blow, and are felt as one.
    let faults: [(&str, f64, Fault); 4] = [
        ("90 m/s2 in a tenth", 0.3, |sample, k, random| {
            sample.motion.0[k as usize % 2] += if random < 0.1 { 90.0 } else { 0.0 };
        }),
        ("40 m/s2 in a half", 2.5, |sample, _, random| sample.motion.0[0] += if random < 0.5 { 40.0 } else { 0.0 }),
        ("pitch by 0.69 rad", 0.5, |sample, k, _| sample.motion.0[7] += if k.is_multiple_of(2) { 0.69 } else { 0.0 }),
        ("roll by 0.69 rad", 0.5, |sample, _, random| sample.motion.0[6] += if random < 0.5 { 0.69 } else { 0.0 }),
    ];
    for (name, bound, fault) in faults {
        let all = packets(40.0, |t| {
            let mut sample = sample(t, Some(t));
            let k = (t * 100.0).round() as u64;
            if t > 15.0 {
                fault(&mut sample, k, ((k as f64 * 12.9898).sin() * 43_758.545).rem_euclid(1.0));
            }
            Some(Packet { arrival: t, sample })
        });
        let (_, course) = ride(&all, 39.0, |_| ());
        let jolt = course.jolt(14.0, 39.0);
        assert!(jolt <= bound, "{name}: {jolt} m/s2");
    }
}

#[test]
fn a_loop_through_the_verticals_is_no_teleport() {
    use std::f64::consts::PI;
    let all = packets(40.0, |t| {
        let angle: f64 = if t > 12.0 { 0.6 * (t - 12.0) } else { 0.0 };
        let rate = if t > 12.0 { 0.6 } else { 0.0 };
        let half = if angle.cos() < 0.0 { PI } else { 0.0 };
        let angles = RollPitchYaw::new(half, -angle.sin().asin(), half);
        // Numbers that stay the same at 60 m/s would be a pause.
        let force = Vector3::new(0.0, 0.0, 9.80665 * angle.cos() + 60.0 * rate + 0.01 * (31.0 * t).sin());
        let motion = Motion::new(force, Vector3::new(0.0, -rate, 0.0), angles, 60.0);
        Some(Packet { arrival: t, sample: Sample { time: Some(t), motion, has_angles: true, ..Sample::default() } })
    });
    let mut before: Option<Motion> = None;
    let (session, course) = ride(&all, 39.0, |session| {
        let now = *session.passed();
        if session.time() > 13.0 {
            let change = before.map_or(0.0, |before| (now.angles().to_vector() - before.angles().to_vector()).amax());
            assert!(change < 2e-3, "{change} rad at {} s", session.time());
        }
        before = Some(now);
    });
    assert_eq!((session.source().counts().teleports, course.begins(State::Engaging)), (0, 1));
    // A roll of 1 rad at once is one.
    let mut all = all;
    all.iter_mut().filter(|packet| packet.arrival > 11.0).for_each(|packet| packet.sample.motion.0[6] += 1.0);
    assert_eq!(ride(&all[..1150], 11.4, |_| ()).0.source().counts().teleports, 1);
}
