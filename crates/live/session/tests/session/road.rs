//! A session that learns the road.

use std::f64::consts::TAU;

use moris_laps::Laps;
use moris_live::log::{self, Digest, Entry, Happening};
use moris_live::{Event, Motion, STEP, Sample, Session, Settings};
use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY};
use moris_washout::presets;
use nalgebra::Vector3;

/// Time of a round \[s\].
const ROUND: f64 = 25.0;
/// Radius of the road \[m\].
const RADIUS: f64 = 70.0;

/// A vehicle on a round road, at an angle of it. Its forces belong to their places.
fn on_road(angle: f64) -> Sample {
    // Brakes and chicanes: pulses of no common period.
    let surge = 0.8 * (4.0 * ((3.0 * angle).sin() + (2.0 * angle).cos())).tanh();
    let sway = 1.0 * (4.0 * (4.0 * (angle + 0.7 * angle.sin())).sin()).tanh();
    let force = Vector3::new(surge, sway, STANDARD_GRAVITY);
    let speed = TAU * RADIUS / ROUND;
    Sample {
        motion: Motion::new(force, Vector3::zeros(), RollPitchYaw::default(), speed),
        position: Some(Vector3::new(RADIUS * angle.cos(), RADIUS * angle.sin(), 0.0)),
        ..Sample::default()
    }
}

/// A session of so many rounds at 60 Hz, and what happens to it.
struct Driven {
    session: Session,
    digest: Digest,
    text: String,
    next: f64,
}

impl Driven {
    fn new(laps: Option<Laps>) -> Self {
        let parameters = presets::parameters(presets::PREVIEW);
        let settings = Settings { ignore_signs: true, ..Settings::default() };
        let mut session = Session::new(&parameters, &settings).unwrap();
        let text = log::header(&parameters, &settings, laps.as_ref());
        if let Some(laps) = laps {
            session.learn(laps);
        }
        let mut driven = Driven { session, digest: Digest::default(), text, next: 0.0 };
        driven.handle(Event::Start);
        driven.drive(10.0, 0.0, |_, _| ());
        driven.handle(Event::Engage);
        driven
    }

    fn note(&mut self, happening: Happening) {
        let step = (self.session.time() / STEP).round() as u64;
        self.text += &format!("{}\n", Entry { step, happening });
    }

    fn handle(&mut self, event: Event) {
        self.note(Happening::Event(event));
        self.session.handle(event).unwrap();
    }

    /// Drives for some seconds from an angle on; `observe` receives the time in them.
    fn drive(&mut self, seconds: f64, from: f64, mut observe: impl FnMut(f64, &Session)) {
        let begin = self.session.time();
        for _ in 0..(seconds / STEP) as u64 {
            let now = self.session.time();
            if now >= self.next {
                self.next = now.max(self.next + 1.0 / 60.0 - STEP);
                let sample = Sample { time: Some(now), ..on_road(from + TAU * (now - begin) / ROUND) };
                self.note(Happening::Sample(now, sample));
                self.session.receive(now, &sample);
            }
            self.digest.take(self.session.step());
            observe(now - begin, &self.session);
        }
    }

    /// RMS error of the felt surge and sway of each round.
    fn errors(&mut self, rounds: usize) -> Vec<f64> {
        let mut squares = vec![0.0; rounds];
        self.drive(rounds as f64 * ROUND, 0.0, |time, session| {
            let error = session.commands().washout.felt_specific_force - session.passed().force();
            let round = ((time / ROUND) as usize).min(rounds - 1);
            squares[round] += (error.x * error.x + error.y * error.y) * STEP / ROUND;
        });
        squares.into_iter().map(f64::sqrt).collect()
    }
}

#[test]
fn the_second_round_is_felt_better_and_a_kept_road_the_first_one_too() {
    let plain = Driven::new(None).errors(2);
    let mut first = Driven::new(Some(Laps::new()));
    let learned = first.errors(2);
    assert!(learned[1] <= 0.7 * plain[1], "{learned:?} {plain:?}");
    let road = first.session.road().unwrap();
    assert!(road.laps().trust() > 0.8 && road.laps().passes() > 0);
    let text = road.laps().text();
    let known = Driven::new(Some(Laps::of_text(&text).unwrap())).errors(1);
    assert!(known[0] <= 0.9 * learned[0], "{known:?} {learned:?}");
}

#[test]
fn a_session_that_learns_repeats_to_the_bit_and_allocates_nothing() {
    let mut known = Driven::new(Some(Laps::new()));
    known.drive(30.0, 0.0, |_, _| ());
    let laps = known.session.road().unwrap().laps().text();
    let mut driven = Driven::new(Some(Laps::of_text(&laps).unwrap()));
    let mut given = 0;
    driven.drive(20.0, 0.0, |_, session| given += u32::from(session.road().unwrap().laps().trust() > 0.0));
    assert!(given > 10_000, "{given}");
    // A teleport.
    driven.drive(6.0, 2.5, |_, _| ());
    driven.session.slip(0.03);
    driven.note(Happening::Slip(0.03));
    driven.drive(6.0, 2.5 + TAU * 6.0 / ROUND, |_, _| ());
    assert!(driven.session.source().counts().teleports >= 1);
    driven.note(Happening::End(driven.digest.0));
    let replayed = log::replay(&driven.text, |_| ()).unwrap();
    assert_eq!(replayed.recorded, Some(replayed.digest));
    let allocated = allocation_counter::measure(|| {
        for k in 0..3_000 {
            if k % 16 == 0 {
                let now = driven.session.time();
                driven.session.receive(now, &Sample { time: Some(now), ..on_road(TAU * now / ROUND) });
            }
            driven.session.step();
        }
    });
    assert_eq!(allocated.count_total, 0);
    assert!(driven.session.without_road().road().is_none() && driven.session.road().is_some());
}
