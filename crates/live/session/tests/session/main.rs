//! A session: any events at any time, with telemetry of a smooth ride.

#[path = "../../../../../tests/cases/mod.rs"]
mod cases;
mod ride;
mod road;

use std::sync::Mutex;

use moris_live::log::{self, Digest, Entry, Happening};
use moris_live::{Commands, Event, STEP, Sample, Session, Settings, State};
use moris_simulation::measures::comfort::comfort;
use moris_washout::interface::StrategyKind;
use moris_washout::platform::{Geometry, leg_lengths};
use moris_washout::{Parameters, presets};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use ride::{Ride, RideEvent};

/// Steps a session with these events, each with the time since the one before it \[s\].
fn run(session: &mut Session, ride: &mut Ride, events: &[(f64, RideEvent)], mut observe: impl FnMut(&Session)) {
    for (after, event) in events {
        ride.apply(*event, session);
        for _ in 0..(after / STEP) as u64 {
            ride.send(session);
            session.step();
            observe(session);
        }
    }
}

/// At neutral with a running source.
fn at_neutral(parameters: &Parameters) -> (Session, Ride) {
    at_neutral_with(parameters, Ride::default())
}

/// As [`at_neutral`], with telemetry of this kind.
fn at_neutral_with(parameters: &Parameters, mut ride: Ride) -> (Session, Ride) {
    let mut session = Session::new(parameters, &Settings::default()).unwrap();
    run(&mut session, &mut ride, &[(12.0, RideEvent::Person(Event::Start))], |_| ());
    assert_eq!(session.state(), State::Neutral);
    (session, ride)
}

#[test]
fn a_ride_from_off_to_off() {
    let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
    let mut ride = Ride::default();
    let mut states = vec![State::Off];
    let person = RideEvent::Person;
    let plan = [
        (12.0, person(Event::Start)),
        (15.0, person(Event::Engage)),
        (3.0, RideEvent::Pause),
        (15.0, RideEvent::Run),
        (1.0, RideEvent::Silence),
        (15.0, RideEvent::Run),
        (15.0, RideEvent::Teleport),
        (40.0, RideEvent::Silence),
        (5.0, RideEvent::Run),
        (15.0, person(Event::Engage)),
        (60.0, person(Event::Park)),
        (0.1, person(Event::Stop)),
    ];
    let mut before = session.commands().length;
    run(&mut session, &mut ride, &plan, |session| {
        if session.state() != *states.last().unwrap() {
            states.push(session.state());
        }
        let now = session.commands().length;
        if session.state() != State::Off {
            assert!(now.iter().zip(before).all(|(now, before)| (now - before).abs() < 1e-3), "{:?}", session.state());
        }
        before = now;
    });
    use State::*;
    let resumed = [Frozen, Engaging, Engaged];
    let expected = [
        &[Off, Homing, Neutral, Engaging, Engaged][..],
        &resumed,
        &resumed,
        &[Engaging, Engaged],
        &[Frozen, Disengaging, Neutral, Engaging, Engaged],
        &[Parking, Settled, Off],
    ]
    .concat();
    assert_eq!(states, expected);
}

#[test]
fn engaged_telemetry_passes_as_it_is_with_the_delay() {
    let (mut session, mut ride) = at_neutral(&Parameters::default());
    run(&mut session, &mut ride, &[(20.0, RideEvent::Person(Event::Engage))], |_| ());
    assert_eq!(session.state(), State::Engaged);
    let mut count = 0;
    run(&mut session, &mut ride, &[(5.0, RideEvent::Run)], |session| {
        let expected = Ride::motion(session.time() - session.delay());
        let error = (session.passed().0 - expected.0).amax();
        // Linear interpolation between samples 1/60 s apart.
        assert!(error < 2e-3, "{error}");
        count += 1;
    });
    assert_eq!(count, 5000);
    assert!((0.015..0.04).contains(&session.delay()), "{} s", session.delay());
}

#[test]
fn tunable_parameters_change_at_any_time_and_fixed_ones_at_the_lowest_pose() {
    let (mut session, mut ride) = at_neutral(&Parameters::default());
    run(&mut session, &mut ride, &[(20.0, RideEvent::Person(Event::Engage)), (5.0, RideEvent::Scale(0.25))], |_| ());
    assert_eq!(session.washout().parameters().conditioning.force_scale.x, 0.25);
    let choose = |session: &mut Session, name: &str, value: f64| {
        session.choose(log::slot_of(name).unwrap(), value);
        session.retune()
    };
    let strategy = |session: &Session| session.washout().parameters().structure.strategy;
    let optimal = StrategyKind::ALL.iter().position(|kind| *kind == StrategyKind::Optimal).unwrap() as f64 + 1.0;
    for (name, value) in [("tilt.angleLimit", f64::NAN), ("strategy", optimal), ("actuator.maxLength", 2.0)] {
        let before = *session.washout().parameters();
        assert!(choose(&mut session, name, value).is_err(), "{name}");
        assert_eq!(*session.washout().parameters(), before);
    }
    run(&mut session, &mut ride, &[(40.0, RideEvent::Person(Event::Park))], |_| ());
    assert_eq!(session.state(), State::Settled);
    let before = session.commands().length;
    choose(&mut session, "strategy", optimal).unwrap();
    assert_eq!(strategy(&session), StrategyKind::Optimal);
    assert!(choose(&mut session, "actuator.maxLength", 2.0).is_err());
    let now = session.step().length;
    assert!(now.iter().zip(before).all(|(now, before)| (now - before).abs() < 1e-3), "{now:?} {before:?}");
}

#[test]
fn engage_is_refused_with_the_reason() {
    let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
    let refused = |session: &mut Session| session.handle(Event::Engage).unwrap_err().to_string();
    assert_eq!(refused(&mut session), "engage does nothing in the state off");
    session.handle(Event::Start).unwrap();
    for _ in 0..20_000 {
        session.step();
    }
    assert_eq!(refused(&mut session), "engage needs telemetry of a running vehicle; the source is waiting");
    // A source whose surge has the wrong sign.
    for k in 0..40_000 {
        if k % 10 == 0 {
            let mut sample = Sample { motion: Ride::motion(session.time()), ..Sample::default() };
            sample.motion.0[0] *= -1.0;
            session.receive(session.time(), &sample);
        }
        session.step();
    }
    assert!(refused(&mut session).contains("ax and the change of speed differ in sign"), "{}", refused(&mut session));
}

#[test]
fn a_fault_brings_the_platform_to_neutral_and_stays() {
    let (mut session, mut ride) = at_neutral(&Parameters::default());
    let person = RideEvent::Person;
    run(&mut session, &mut ride, &[(20.0, person(Event::Engage)), (40.0, person(Event::Fault))], |_| ());
    assert_eq!(session.state(), State::Fault);
    let felt = session.commands().washout.felt_specific_force;
    assert!(felt.xy().amax() < 0.05, "{felt}");
    assert!(session.handle(Event::Engage).is_err() && session.state() == State::Fault);
    run(&mut session, &mut ride, &[(10.0, person(Event::Clear))], |_| ());
    assert_eq!(session.state(), State::Neutral);
}

#[test]
fn parking_on_the_way_up_turns_round_at_once() {
    let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
    let mut ride = Ride::default();
    let mut highest = 0.0_f64;
    let person = RideEvent::Person;
    run(&mut session, &mut ride, &[(1.0, person(Event::Start)), (8.0, person(Event::Park))], |session| {
        highest = highest.max(session.commands().length[0]);
    });
    assert_eq!(session.state(), State::Settled);
    // A ramp to 0.15 m and back, averaged twice over 0.4 s: 0.15 (1 - 0.4 / 3) m above 1.012 m.
    assert!((highest - 1.142).abs() < 0.002, "{highest} m");
}

#[test]
fn a_step_and_a_new_scale_allocate_nothing() {
    // A plan is on the heap, and a new scale is tried on a copy of the washout first.
    let allocations = [(Parameters::default(), false), (presets::parameters(presets::CLASSICAL), true)]
        .map(|(parameters, is_tuned)| allocations(&parameters, is_tuned));
    assert_eq!(allocations, [0, 0]);
}

/// Allocations of a session in all states, with new scales or without.
fn allocations(parameters: &Parameters, is_tuned: bool) -> u64 {
    let (mut session, _) = at_neutral(parameters);
    let sample = Sample { motion: Ride::motion(1.0), ..Sample::default() };
    session.receive(session.time(), &sample);
    let scale = log::slot_of("scale.specificForce.x").unwrap();
    let count = allocation_counter::measure(|| {
        for event in [Event::Engage, Event::Disengage, Event::Engage, Event::Park, Event::Fault, Event::Clear] {
            let _ = session.handle(event);
            if is_tuned {
                session.choose(scale, 0.5 + 0.1 * f64::from(event as u8));
                session.retune().unwrap();
            }
            for k in 0..3000 {
                if k % 7 == 0 && k < 1000 {
                    session.receive(session.time(), &Sample { motion: Ride::motion(session.time()), ..sample });
                }
                session.step();
            }
        }
    });
    count.count_total
}

#[test]
fn the_pose_is_that_of_the_lengths_on_the_way_up_and_down() {
    let (mut session, mut ride) = at_neutral(&Parameters::default());
    let person = RideEvent::Person;
    let geometry = Geometry::from(&session.washout().parameters().rig);
    let mut range = [0.0_f64; 2];
    let ways = [(30.0, person(Event::Park)), (10.0, person(Event::Start)), (20.0, person(Event::Engage))];
    run(&mut session, &mut ride, &ways, |session| {
        let Commands { length, pose, heave, .. } = session.commands();
        let found = leg_lengths(&geometry, pose);
        assert!((0..6).all(|k| (found[k] - length[k]).abs() < 1e-9), "{found:?}, not {length:?}");
        range = [range[0].min(*heave), range[1].max(*heave)];
    });
    assert!(range[0] < -0.25 && range[1] < 0.2, "{range:?} m");
}

/// An event, and the time after it.
fn any_event() -> impl Strategy<Value = (f64, RideEvent)> {
    use RideEvent::*;
    // Without `stop`: it leaves the platform to the device at once.
    let person = prop::sample::select(vec![
        Event::Start,
        Event::Engage,
        Event::Disengage,
        Event::Park,
        Event::Fault,
        Event::Clear,
    ]);
    let event = prop_oneof![
        4 => Just(Person(Event::Engage)),
        2 => person.prop_map(Person),
        3 => Just(Run),
        2 => Just(Pause),
        2 => Just(Silence),
        2 => Just(Teleport),
        1 => prop::sample::select(vec![0.4, 0.5, 0.6]).prop_map(Scale),
        1 => Just(NotANumber),
        1 => Just(Repeat),
    ];
    // Most within a glide, some long enough for a new state.
    (prop_oneof![3 => 0.05..1.0, 2 => 1.0..8.0], event)
}

/// Worst shake and jolt of the felt force on any axis \[m/s2\], beyond those of a force that does
/// not change at all.
fn discomfort(parameters: &Parameters, ride: Ride, events: &[(f64, RideEvent)]) -> [f64; 2] {
    let (mut session, mut ride) = at_neutral_with(parameters, ride);
    let mut felt: [Vec<f64>; 3] = Default::default();
    run(&mut session, &mut ride, events, |session| {
        let Commands { washout, .. } = session.commands();
        felt.iter_mut().zip(washout.felt_specific_force.iter()).for_each(|(axis, value)| axis.push(*value));
    });
    let mut worst = [0.0_f64; 2];
    for axis in &felt {
        let found = comfort(&vec![0.0; axis.len()], axis, 0.0, STEP).values();
        worst = [worst[0].max(found[0]), worst[1].max(found[1])];
    }
    worst
}

const MOST: [f64; 2] = [0.1, 1.0];

/// The sets whose soft limits are on.
const SETS: &[(&str, &str)] =
    &[("default", ""), ("adaptive", presets::ADAPTIVE), ("optimal", presets::OPTIMAL), ("robust", presets::ROBUST)];

/// Telemetry of 20 to 400 Hz, with samples left out, with a clock or without.
fn any_ride() -> impl Strategy<Value = Ride> {
    (prop::sample::select(vec![20.0, 60.0, 100.0, 400.0]), 1..4_u64, any::<bool>()).prop_map(
        |(rate, most, has_clock)| {
            let mut ride = Ride::default();
            (ride.rate, ride.most, ride.has_clock) = (rate, if rate > 20.0 { most } else { 1 }, has_clock);
            ride
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::cases::cases(24, 12), rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_sequence_of_events_is_felt_as_a_jolt(
        events in prop::collection::vec(any_event(), 20..40),
        set in prop::sample::select(SETS),
        ride in any_ride(),
    ) {
        let [shake, jolt] = discomfort(&presets::parameters(set.1), ride, &events);
        prop_assert!(shake <= MOST[0] && jolt <= MOST[1], "{}: shake {shake}, jolt {jolt} m/s2", set.0);
    }

    #[test]
    fn a_recorded_session_repeats_to_the_bit(events in prop::collection::vec(any_event(), 1..12)) {
        let (parameters, settings) = (presets::parameters(presets::CLASSICAL), Settings::default());
        let mut text = log::header(&parameters, &settings, None);
        let mut session = Session::new(&parameters, &settings).unwrap();
        let mut ride = Ride::default();
        ride.log = Some(String::new());
        let mut digest = Digest::default();
        run(&mut session, &mut ride, &[(6.0, RideEvent::Person(Event::Start))], |s| digest.take(s.commands()));
        run(&mut session, &mut ride, &events, |session| digest.take(session.commands()));
        let step = (session.time() / STEP).round() as u64;
        text += &ride.log.unwrap();
        text += &format!("{}\n", Entry { step, happening: Happening::End(digest.0) });
        let replayed = log::replay(&text, |_| ()).unwrap();
        prop_assert_eq!(replayed.recorded, Some(digest.0));
        prop_assert_eq!((replayed.steps, replayed.digest), (step, digest.0));
    }

    #[test]
    fn no_text_is_replayed_with_a_panic(text in "(moris-live-session,1\nsettings,\\{\\}\n)?[0-9a-z,.\n]*") {
        let _ = log::replay(&text, |_| ());
    }
}

/// A million events, in sequences of hundreds, on all cores:
/// `MORIS_ALL_CASES=1 cargo test -p moris-live -- --ignored million`.
#[test]
#[ignore = "takes an hour"]
fn no_sequence_of_a_million_events_is_felt_as_a_jolt() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let count: usize = crate::cases::cases(10_000, 100);
    let runner = Mutex::new((0..count, TestRunner::deterministic()));
    let sequences = prop::collection::vec(any_event(), 100);
    let next = || {
        let (left, runner) = &mut *runner.lock().unwrap();
        left.next().map(|case| (case, sequences.new_tree(runner).unwrap().current()))
    };
    let found = Mutex::new(([0.0_f64; 2], 0));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((case, events)) = next() {
                    let [shake, jolt] = discomfort(&Parameters::default(), Ride::default(), &events);
                    let (worst, violations) = &mut *found.lock().unwrap();
                    if shake > worst[0] || jolt > worst[1] || case % 500 == 499 {
                        *worst = [worst[0].max(shake), worst[1].max(jolt)];
                        println!("sequence {case}: shake {shake:.3}, jolt {jolt:.3}; worst {worst:.3?}");
                    }
                    *violations += usize::from(shake > MOST[0] || jolt > MOST[1]);
                }
            });
        }
    });
    let (worst, violations) = found.into_inner().unwrap();
    assert_eq!(violations, 0, "of {count} sequences, worst {worst:?}");
}

/// A day of engaging, driving, pauses and parking: `cargo test -p moris-live -- --ignored day`.
#[test]
#[cfg(target_os = "linux")]
#[ignore = "takes minutes"]
fn a_day_needs_no_more_memory_at_its_end() {
    /// Resident memory [kB].
    fn resident() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        status.lines().find_map(|line| line.strip_prefix("VmRSS:")?.trim().strip_suffix(" kB")?.parse().ok()).unwrap()
    }
    let (mut session, mut ride) = at_neutral(&presets::parameters(presets::CLASSICAL));
    let person = RideEvent::Person;
    let hour = [
        (1000.0, person(Event::Engage)),
        (200.0, RideEvent::Scale(0.6)),
        (200.0, RideEvent::Pause),
        (200.0, RideEvent::Run),
        (200.0, RideEvent::Teleport),
        (200.0, RideEvent::Silence),
        (200.0, RideEvent::Run),
        (1000.0, person(Event::Engage)),
        (200.0, RideEvent::Scale(0.4)),
        (150.0, person(Event::Park)),
        (50.0, person(Event::Start)),
    ];
    run(&mut session, &mut ride, &hour, |_| ());
    let begin = resident();
    for _ in 0..24 {
        run(&mut session, &mut ride, &hour, |_| ());
    }
    let (hours, end) = (session.time() / 3600.0, resident());
    println!("{begin} kB, and {end} kB at {hours:.1} hours");
    assert!(hours > 25.0 && end <= begin + 256, "{begin} kB, and {end} kB at {hours} hours");
}

#[test]
fn the_state_after_any_event_is_that_of_the_table() {
    for state in State::ALL {
        for event in Event::ALL.iter().filter(|event| event.is_external()) {
            let Some(mut session) = in_state(*state) else { panic!("{state:?} is not reached") };
            let result = session.handle(*event);
            assert_eq!(session.state(), state.after(*event), "{state:?} {event:?}");
            assert_eq!(result.is_err(), state.after(*event) == *state && !event.is_of_device(), "{state:?} {event:?}");
        }
    }
}

/// A session in this state, with a running source.
fn in_state(state: State) -> Option<Session> {
    let person = RideEvent::Person;
    let (mut session, mut ride) = at_neutral(&Parameters::default());
    let way: &[(f64, RideEvent)] = match state {
        State::Off => &[(0.1, person(Event::Stop))],
        State::Settled => &[(30.0, person(Event::Park))],
        State::Homing => &[(30.0, person(Event::Park)), (0.1, person(Event::Start))],
        State::Neutral => &[],
        State::Engaging => &[(0.1, person(Event::Engage))],
        State::Engaged => &[(20.0, person(Event::Engage))],
        State::Frozen => &[(0.1, person(Event::Engage)), (0.1, RideEvent::Pause)],
        State::Disengaging => &[(5.0, person(Event::Engage)), (0.1, person(Event::Disengage))],
        State::Parking => &[(0.1, person(Event::Park))],
        State::Fault => &[(0.1, person(Event::Fault))],
    };
    run(&mut session, &mut ride, way, |_| ());
    // Whatever the state, the source runs.
    if state != State::Frozen {
        assert_eq!(session.source().health(), moris_live::source::Health::Running);
    }
    (session.state() == state).then_some(session)
}
