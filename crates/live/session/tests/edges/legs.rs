//! Places of the legs: stop and start, restarts, a lost controller, parking.

use moris_live::{Commands, Event, Legs, Motion, Refusal, STEP, Sample, Session, Settings, State};
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::{Geometry, leg_lengths};
use moris_washout::{Parameters, Rig};

/// A session that is stepped, with the legs' speeds and accelerations judged.
struct Judged {
    session: Session,
    before: [[f64; 6]; 2],
}

impl Judged {
    fn new(settings: &Settings) -> Judged {
        Self::on(&Parameters::default(), settings)
    }

    fn on(parameters: &Parameters, settings: &Settings) -> Judged {
        let session = Session::new(parameters, settings).unwrap();
        let before = [session.commands().length; 2];
        Judged { session, before }
    }

    /// Steps for this time with a vehicle's telemetry, and judges each change of the legs.
    fn run(&mut self, time: f64) {
        for _ in 0..(time / STEP).round() as u64 {
            let now = self.session.time();
            if ((now / STEP).round() as u64).is_multiple_of(10) {
                let mut sample = Sample { motion: Motion::at_rest(), time: Some(now), ..Sample::default() };
                sample.motion.0[0] = 2.0 * (0.8 * now).sin();
                sample.motion.0[9] = 20.0 - 2.5 * (0.8 * now).cos();
                self.session.receive(now, &sample);
            }
            let length = self.session.step().length;
            let rig = self.session.washout().parameters().rig;
            let [old, before] = self.before;
            for k in 0..6 {
                let speed = (length[k] - before[k]) / STEP;
                let acceleration = (length[k] - 2.0 * before[k] + old[k]) / STEP / STEP;
                assert!(speed.abs() <= 1.2 * rig.velocity_limit, "{speed} m/s at {now} s");
                let ends_at_once = self.session.state() == State::Off;
                assert!(
                    ends_at_once || acceleration.abs() <= 1.2 * rig.acceleration_limit,
                    "{acceleration} m/s2 at {now} s"
                );
            }
            self.before = [before, length];
        }
    }

    fn until(&mut self, state: State, most: f64) -> f64 {
        let begin = self.session.time();
        while self.session.state() != state {
            self.run(STEP);
            assert!(self.session.time() - begin < most, "{:?} after {most} s", self.session.state());
        }
        self.session.time() - begin
    }
}

#[test]
fn start_after_stop_begins_where_the_legs_are() {
    // Stops on the way up, while engaged, and on the way down.
    for (engaged, parks, after) in [(0.0, false, 0.0), (6.0, false, 0.0), (25.3, false, 3.0), (20.0, true, 5.0)] {
        let mut judged = Judged::new(&Settings::default());
        judged.session.handle(Event::Start).unwrap();
        if engaged > 0.0 {
            judged.until(State::Neutral, 10.0);
            judged.session.handle(Event::Engage).unwrap();
        }
        judged.run(f64::max(engaged, 1.0));
        if parks {
            judged.session.handle(Event::Park).unwrap();
            judged.run(2.5);
        }
        let last = judged.session.commands().length;
        judged.session.handle(Event::Stop).unwrap();
        // The controller holds the legs at once.
        judged.before = [last; 2];
        judged.run(after);
        judged.session.handle(Event::Start).unwrap();
        judged.run(STEP);
        let first = judged.session.commands().length;
        assert!((0..6).all(|k| (first[k] - last[k]).abs() < 1e-4), "{first:?} after {last:?}");
        judged.until(State::Neutral, 40.0);
        judged.session.handle(Event::Park).unwrap();
        judged.until(State::Settled, 10.0);
        assert!(judged.session.commands().length.iter().all(|length| (length - 1.012).abs() < 1e-9));
    }
}

#[test]
fn parking_after_a_stop_goes_to_neutral_and_then_to_the_settled_pose() {
    let mut judged = Judged::new(&Settings::default());
    judged.session.handle(Event::Start).unwrap();
    judged.run(1.5);
    judged.session.handle(Event::Stop).unwrap();
    judged.before = [judged.session.commands().length; 2];
    judged.session.handle(Event::Start).unwrap();
    judged.run(0.3);
    judged.session.handle(Event::Park).unwrap();
    judged.until(State::Settled, 20.0);
    assert!(judged.session.commands().length.iter().all(|length| (length - 1.012).abs() < 1e-9));
}

#[test]
fn legs_of_unknown_place_do_not_start() {
    let unknown = Settings { starts_settled: false, ..Settings::default() };
    let mut judged = Judged::new(&unknown);
    assert!(!judged.session.is_located());
    let refusal = judged.session.handle(Event::Start).unwrap_err();
    assert_eq!(refusal, Refusal::Unknown(Event::Start));
    assert_eq!(
        refusal.to_string(),
        "start needs the legs' place, which is unknown: let the controller report it, confirm that the platform is \
         settled, or start slowly"
    );
    // The operator has seen it settled.
    judged.session.locate(Legs::Settled).unwrap();
    judged.session.handle(Event::Start).unwrap();
    assert_eq!(judged.session.locate(Legs::Settled), Err(Refusal::Commanded(State::Homing)));
    judged.until(State::Neutral, 10.0);
}

#[test]
fn the_way_home_begins_at_reported_lengths() {
    let mut judged = Judged::new(&Settings { starts_settled: false, ..Settings::default() });
    let geometry = Geometry::from(&judged.session.washout().parameters().rig);
    let reported = [1.35, 1.31, 1.42, 1.38, 1.29, 1.44];
    let wrong = judged.session.locate(Legs::Reported([1.3, 1.3, 1300.0, 1.3, 1.3, 1.3])).unwrap_err().to_string();
    assert!(wrong.starts_with("actuator 3 is reported at 1300 m, ") && wrong.contains("unit"), "{wrong}");
    assert!(judged.session.locate(Legs::Reported([f64::NAN; 6])).is_err() && !judged.session.is_located());
    judged.session.locate(Legs::Reported(reported)).unwrap();
    judged.before = [reported; 2];
    judged.session.handle(Event::Start).unwrap();
    judged.run(STEP);
    let commands = judged.session.commands();
    assert!((0..6).all(|k| (commands.length[k] - reported[k]).abs() < 1e-6), "{:?}", commands.length);
    let found = leg_lengths(&geometry, &commands.pose);
    assert!((0..6).all(|k| (found[k] - commands.length[k]).abs() < 1e-9), "{found:?}");
    judged.until(State::Neutral, 10.0);
}

#[test]
fn a_slow_start_holds_the_settled_lengths_for_as_long_as_any_way_takes() {
    let mut judged = Judged::new(&Settings { starts_settled: false, slow_speed: 0.05, ..Settings::default() });
    judged.session.locate(Legs::Slow).unwrap();
    judged.session.handle(Event::Start).unwrap();
    // A stroke of 0.6 m at 0.05 m/s.
    judged.run(12.0);
    assert!(judged.session.commands().length.iter().all(|length| (length - 1.012).abs() < 1e-9));
    judged.until(State::Neutral, 10.0);
}

#[test]
fn a_lost_controller_is_a_fault_after_which_the_place_is_unknown() {
    let mut judged = Judged::new(&Settings::default());
    judged.session.handle(Event::Start).unwrap();
    judged.until(State::Neutral, 10.0);
    judged.session.handle(Event::Engage).unwrap();
    judged.run(20.0);
    judged.session.handle(Event::Lost).unwrap();
    assert_eq!(judged.session.state(), State::Fault);
    judged.run(40.0);
    assert_eq!(judged.session.state(), State::Fault);
    assert!(judged.session.commands().velocity.iter().all(|speed| speed.abs() < 1e-3));
    assert_eq!(judged.session.handle(Event::Clear), Err(Refusal::Unknown(Event::Clear)));
    judged.session.locate(Legs::Settled).unwrap();
    assert!(judged.session.commands().length.iter().all(|length| (length - 1.012).abs() < 1e-9));
    judged.before = [judged.session.commands().length; 2];
    judged.session.handle(Event::Clear).unwrap();
    judged.until(State::Neutral, 10.0);
}

#[test]
fn parking_is_short() {
    for (name, set) in [("default", ""), ("optimal", moris_washout::presets::OPTIMAL)] {
        let mut judged = Judged::new(&Settings::default());
        judged.session = Session::new(&moris_washout::presets::parameters(set), &Settings::default()).unwrap();
        judged.session.handle(Event::Start).unwrap();
        judged.until(State::Neutral, 10.0);
        judged.session.handle(Event::Park).unwrap();
        judged.until(State::Settled, 4.0);
        judged.session.handle(Event::Start).unwrap();
        judged.until(State::Neutral, 10.0);
        judged.session.handle(Event::Engage).unwrap();
        judged.run(23.0);
        judged.session.handle(Event::Park).unwrap();
        let lasted = judged.until(State::Settled, 9.0);
        println!("{name}: parks within {lasted:.2} s");
    }
}

#[test]
fn the_settled_pose_of_a_platform_that_hangs_is_its_lowest() {
    let mut parameters = Parameters::default();
    let rig = &mut parameters.rig;
    // The default's rig upside down.
    rig.base.iter_mut().for_each(|joint| joint.z = 2.0);
    rig.neutral_height = 2.0 - rig.neutral_height;
    let session = Session::new(&parameters, &Settings::default()).unwrap();
    let commands = session.commands();
    assert!(commands.heave < -0.1, "{} m", commands.heave);
    assert!(commands.length.iter().all(|length| (length - 1.588).abs() < 1e-9), "{:?}", commands.length);
}

/// A platform with arms of 184 mm at -60 to 60 degrees; joints 6, 5 and 4 mirror 1, 2 and 3.
fn with_cranks() -> Parameters {
    let joints = |half: [[f64; 2]; 3]| {
        std::array::from_fn(|i| {
            let [x, y] = half[i.min(5 - i)];
            Vector3::new(if i < 3 { x } else { -x }, y, 0.0)
        })
    };
    let arm = 0.184_15;
    let rig = Rig {
        base: joints([[0.2032, 0.351_953], [0.4064, 0.0], [0.2032, -0.351_953]]),
        platform: joints([[0.306_456, 0.257_147], [0.375_924, 0.136_825], [0.069_468, -0.393_972]]),
        neutral_height: 0.648_134,
        crank_arm: arm,
        crank_rod: 0.7239,
        crank_heading: [150.0, -90.0, 30.0, 150.0, -90.0, 30.0].map(f64::to_radians),
        crank_min_angle: -60f64.to_radians(),
        crank_max_angle: 60f64.to_radians(),
        velocity_limit: 6.0 * arm,
        acceleration_limit: 60.0 * arm,
        ..Rig::default()
    };
    let mut parameters = Parameters { rig, ..Parameters::default() };
    parameters.safety.position_limit = Vector3::new(0.29, 0.28, 0.1);
    parameters
}

/// Rods and arms as they are in each pose: |p + R a - b - arm| = rod.
#[test]
fn cranks_go_from_their_lowest_arms_to_neutral_and_back() {
    let parameters = with_cranks();
    let rig = parameters.rig;
    let geometry = Geometry::from(&rig);
    let mut judged = Judged::on(&parameters, &Settings::default());
    let closes = |session: &Session| {
        let Commands { length, pose, .. } = session.commands();
        let rotation = pose.orientation.rotation;
        for (k, arc) in length.iter().enumerate() {
            let (sin, cos) = (arc / rig.crank_arm).sin_cos();
            let (across, along) = rig.crank_heading[k].sin_cos();
            let arm = rig.crank_arm * Vector3::new(cos * along, cos * across, sin);
            let rod = pose.position + rotation * rig.platform[k] - rig.base[k] - arm;
            assert!((rod.norm() - rig.crank_rod).abs() < 1e-9, "{} m", rod.norm());
        }
        assert!(geometry.transmission(pose) >= 0.3 - 1e-9, "{}", geometry.transmission(pose));
    };
    // With a numerical search of the heave in numpy the transmission is 0.3 at -52.37 degrees.
    let lowest = judged.session.commands().length;
    let degrees = lowest.map(|arc| (arc / rig.crank_arm).to_degrees());
    assert!(degrees.iter().all(|angle| (-52.4..-52.0).contains(angle)), "{degrees:?}");
    judged.session.handle(Event::Start).unwrap();
    while judged.session.state() != State::Neutral {
        judged.run(STEP);
        closes(&judged.session);
        assert!(judged.session.time() < 10.0);
    }
    assert!(judged.session.commands().length.iter().all(|arc| arc.abs() < 0.03 * 0.386), "level arms");
    judged.session.handle(Event::Engage).unwrap();
    judged.run(20.0);
    assert!(judged.session.commands().washout.felt_specific_force.x.abs() > 0.05, "no cue");
    judged.session.handle(Event::Park).unwrap();
    judged.until(State::Settled, 9.0);
    closes(&judged.session);
    let parked = judged.session.commands().length;
    assert!((0..6).all(|k| (parked[k] - lowest[k]).abs() < 1e-9), "{parked:?}");
}

#[test]
fn cranks_begin_at_reported_angles_within_their_arc() {
    let mut judged = Judged::on(&with_cranks(), &Settings { starts_settled: false, ..Settings::default() });
    let arm = judged.session.washout().parameters().rig.crank_arm;
    let arcs = [10.0, -12.0, 5.0, 0.0, -20.0, 8.0].map(|degrees: f64| arm * degrees.to_radians());
    let wrong = judged.session.locate(Legs::Reported([arm * 1.5; 6])).unwrap_err().to_string();
    assert!(wrong.starts_with("actuator 1 is reported at 85.943669 degrees"), "{wrong}");
    assert!(wrong.contains("from -60 to 60 degrees"), "{wrong}");
    judged.session.locate(Legs::Reported(arcs)).unwrap();
    judged.before = [arcs; 2];
    judged.session.handle(Event::Start).unwrap();
    judged.run(STEP);
    let commands = judged.session.commands();
    assert!((0..6).all(|k| (commands.length[k] - arcs[k]).abs() < 1e-6), "{:?}", commands.length);
    let found = leg_lengths(&Geometry::from(&judged.session.washout().parameters().rig), &commands.pose);
    assert!((0..6).all(|k| (found[k] - commands.length[k]).abs() < 1e-9), "{found:?}");
    judged.until(State::Neutral, 10.0);
}
