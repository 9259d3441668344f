//! The ride, natively: what a player's commands do.

use moris_interface::Group;
use moris_motorcycle::{Model, Output};
use moris_pages::ride::page::{Page, html};
use moris_pages::ride::{HALF_WIDTH, Lap, Ride, RiderCommand, STEP, Stage};
use moris_washout::interface::StrategyKind;
use moris_washout::{Input, Parameters, Washout, presets};

fn ride() -> Ride {
    Ride::new(&Parameters::default()).unwrap()
}

/// Rides for so many seconds; `command` is asked every 20 ms.
fn go(ride: &mut Ride, seconds: f64, mut command: impl FnMut(&Ride) -> RiderCommand) {
    for _ in 0..(seconds / 0.02).round() as usize {
        let command = command(ride);
        for _ in 0..20 {
            ride.step(&command);
        }
    }
}

/// Throttle and brakes of a player who keeps a speed.
fn at_speed(ride: &Ride, speed: f64) -> RiderCommand {
    let missing = speed - output(ride).speed;
    RiderCommand {
        throttle: (0.1 * missing).clamp(0.0, 0.25),
        brake: (-0.1 * missing).clamp(0.0, 0.6),
        stick: 0.0,
        is_helped: true,
    }
}

fn output(ride: &Ride) -> Output {
    ride.motorcycle().output()
}

/// A lap at nine tenths of the advised speed.
fn lap() -> (Ride, Lap) {
    let mut ride = ride();
    while ride.laps().is_empty() {
        go(&mut ride, 1.0, |ride| at_speed(ride, (0.9 * output(ride).planned_speed).max(3.0)));
        assert_eq!(ride.stage(), Stage::Riding, "at {} m", output(&ride).path_distance);
    }
    let lap = ride.laps()[0];
    (ride, lap)
}

#[test]
fn nothing_moves_before_the_throttle_opens() {
    let mut ride = ride();
    go(&mut ride, 2.0, |_| RiderCommand { brake: 1.0, stick: 1.0, ..RiderCommand::default() });
    assert_eq!((ride.stage(), output(&ride).speed, ride.recording().samples()), (Stage::Ready, 0.0, 1));
    go(&mut ride, 2.0, |_| RiderCommand { throttle: 0.5, ..RiderCommand::default() });
    assert_eq!(ride.stage(), Stage::Riding);
    assert!(output(&ride).speed > 3.0);
}

#[test]
fn the_stick_to_the_right_leans_and_turns_to_the_right() {
    let mut ride = ride();
    go(&mut ride, 5.0, |ride| at_speed(ride, 12.0));
    go(&mut ride, 1.0, |ride| RiderCommand { stick: 0.3, is_helped: false, ..at_speed(ride, 12.0) });
    let now = output(&ride);
    assert!(now.orientation.roll > 0.1 && now.orientation.yaw < -0.02 && now.angular_velocity.x.abs() < 0.8);
}

#[test]
fn a_lap_with_help_stays_on_the_road_and_has_ratings() {
    let (ride, lap) = lap();
    assert!((100.0..200.0).contains(&lap.time), "{lap:?}");
    let seconds = (lap.samples[1] - lap.samples[0]) as f64 * 0.01;
    assert!((seconds - lap.time).abs() < 0.03, "{lap:?}");
    let [surge, sway] = ride.ratings(&lap).unwrap();
    for rating in [surge, sway] {
        assert!(rating.rms_error > 0.01 && rating.rms_error < 1.5, "{rating:?}");
        assert!(rating.jolt >= 0.0 && rating.jolt < 5.0 && rating.peak < 3.0, "{rating:?}");
    }
}

/// A rider who only holds the throttle stays on the road with help, and leaves it without.
#[test]
fn a_held_throttle_with_help_stays_on_the_road() {
    for is_helped in [true, false] {
        let mut ride = ride();
        go(&mut ride, 200.0, |_| RiderCommand { throttle: 1.0, is_helped, ..RiderCommand::default() });
        let expected = if is_helped { Stage::Riding } else { Stage::OffRoad };
        assert_eq!(ride.stage(), expected, "at {} m", output(&ride).path_distance);
        assert!(!is_helped || !ride.laps().is_empty());
    }
}

/// The second lap of the predictive strategy is felt better by what the first one taught, and a
/// ride that begins anew knows the road.
#[test]
fn laps_are_learned_from_the_first_one_on() {
    let laps = |learns: bool| {
        let mut ride = Ride::new(&Parameters::default()).unwrap();
        ride.learn(learns);
        while ride.laps().len() < 2 {
            go(&mut ride, 1.0, |ride| at_speed(ride, (0.9 * output(ride).planned_speed).max(3.0)));
        }
        let errors = ride.laps().iter().map(|lap| ride.ratings(lap).unwrap().map(|rating| rating.rms_error));
        (errors.collect::<Vec<_>>(), ride)
    };
    let ((plain, _), (learned, mut ride)) = (laps(false), laps(true));
    assert_eq!(plain[0], learned[0], "nothing is known in the first lap");
    assert!(learned[1][0] < 0.6 * plain[1][0], "{learned:?} {plain:?}");

    let trust = |ride: &mut Ride| ride.view().into_iter().find(|(name, _)| *name == "trust").unwrap().1;
    assert!(trust(&mut ride) > 0.5, "{}", trust(&mut ride));
    ride.restart().unwrap();
    assert_eq!(trust(&mut ride), 0.0);
    go(&mut ride, 30.0, |_| RiderCommand::default());
    assert_eq!(ride.stage(), Stage::Ready);
    go(&mut ride, 15.0, |ride| at_speed(ride, (0.9 * output(ride).planned_speed).max(3.0)));
    assert!(trust(&mut ride) > 0.5, "{}", trust(&mut ride));
    ride.learn(false);
    assert_eq!(trust(&mut ride), 0.0);
}

/// The file's samples through a washout of its own give what was felt in the ride.
#[test]
fn the_file_of_a_ride_gives_the_same_cues() {
    // A plan is made at other instants where the file's steps are longer.
    let mut ride = Ride::new(&presets::parameters(presets::CLASSICAL)).unwrap();
    go(&mut ride, 30.0, |ride| at_speed(ride, output(ride).planned_speed.min(15.0)));
    let csv = ride.recording().csv();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("time,ax,ay,az,wx,wy,wz,roll,pitch,yaw,speed,lean"));
    let inputs: Vec<Input> = lines
        .map(|line| {
            let v: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let mut input = Input { speed: v[10], lean: v[11], ..Input::default() };
            input.specific_force = [v[1], v[2], v[3]].into();
            input.angular_velocity = [v[4], v[5], v[6]].into();
            (input.orientation.roll, input.orientation.pitch, input.orientation.yaw) = (v[7], v[8], v[9]);
            input
        })
        .collect();
    assert_eq!(inputs.len(), ride.recording().samples());
    let mut washout = Washout::new(ride.washout().parameters()).unwrap().starting_with(&inputs[0]);
    for pair in inputs.windows(2) {
        washout.step_between(&pair[0], &pair[1], 0.01);
    }
    let (again, live) = (washout.output(), ride.washout().output());
    assert!((again.felt_specific_force - live.felt_specific_force).norm() < 0.01, "{again:?} {live:?}");
    assert!((again.position - live.position).norm() < 1e-3);
}

#[test]
fn leaving_the_road_ends_the_ride_and_a_restart_begins_the_next_one() {
    let mut ride = ride();
    go(&mut ride, 6.0, |ride| at_speed(ride, 15.0));
    let recorded = |ride: &Ride| ride.recording().samples();
    go(&mut ride, 4.0, |ride| RiderCommand { stick: -1.0, is_helped: false, ..at_speed(ride, 15.0) });
    assert_eq!(ride.stage(), Stage::OffRoad);
    let samples = recorded(&ride);
    go(&mut ride, 8.0, |_| RiderCommand { throttle: 1.0, ..RiderCommand::default() });
    assert!(output(&ride).speed < 0.1, "the rider stops beside the road");
    assert_eq!(recorded(&ride), samples);

    ride.restart().unwrap();
    assert_eq!(ride.stage(), Stage::Returning);
    go(&mut ride, 15.0, |_| RiderCommand::default());
    assert_eq!((ride.stage(), output(&ride).speed), (Stage::Ready, 0.0));
    go(&mut ride, 2.0, |ride| at_speed(ride, 15.0));
    assert_eq!(ride.stage(), Stage::Riding);
    assert!(recorded(&ride) < samples);
}

#[test]
fn braking_in_a_bend_on_a_slippery_road_ends_in_a_fall() {
    let mut ride = ride();
    while output(&ride).orientation.roll < 0.3 {
        go(&mut ride, 0.1, |ride| at_speed(ride, 14.0));
    }
    let mut dry = ride.clone();
    ride.set_friction(0.4).unwrap();
    for ride in [&mut ride, &mut dry] {
        go(ride, 4.0, |ride| RiderCommand { brake: 0.4, throttle: 0.0, ..at_speed(ride, 14.0) });
    }
    assert_eq!((ride.stage(), dry.stage()), (Stage::Fallen, Stage::Riding));
}

/// No command and no change of parameters, at any time, makes the platform jump.
#[test]
fn falls_restarts_and_new_strategies_are_gentle() {
    let mut ride = ride();
    let rig = Parameters::default().rig;
    let mut last = ride.washout().output().length;
    let mut check = |ride: &Ride| {
        let now = ride.washout().output().length;
        let fastest = now.iter().zip(last).map(|(now, last)| (now - last).abs() / STEP).fold(0.0, f64::max);
        // At neutral an exchange may move the platform by two millimetres.
        assert!(fastest < rig.velocity_limit + 4.0, "{fastest} m/s");
        last = now;
        fastest
    };
    let mut exchanged = 0;
    for k in 0..90_000_usize {
        let command = match k {
            0..20_000 => RiderCommand { stick: 0.2, ..at_speed(&ride, 13.0) },
            20_000..40_000 => at_speed(&ride, 9.0),
            _ => RiderCommand { stick: 1.0, is_helped: false, ..at_speed(&ride, 16.0) },
        };
        if k == 10_000 {
            let mut parameters = presets::parameters(presets::OPTIMAL);
            parameters.structure.strategy = StrategyKind::Optimal;
            assert_eq!(ride.retune(&parameters), Ok(true));
        }
        if k == 70_000 {
            assert!(matches!(ride.stage(), Stage::OffRoad | Stage::Fallen), "{:?}", ride.stage());
            ride.restart().unwrap();
        }
        ride.step(&command);
        if check(&ride) > rig.velocity_limit {
            exchanged += 1;
        }
    }
    assert!(exchanged <= 2, "{exchanged} jumps at neutral, of the two exchanges");
    assert_eq!(ride.washout().parameters().structure.strategy, StrategyKind::Optimal);
    assert!(
        ride.retune(&Parameters {
            conditioning: {
                let mut c = Parameters::default().conditioning;
                c.force_scale.x = 1e9;
                c
            },
            ..Parameters::default()
        })
        .is_err()
    );
}

#[test]
fn the_page_holds_all_that_it_needs() {
    let page = html(&Page {
        subtitle: "</script><b>".into(),
        module: vec![0; 100],
        rig: (&Parameters::default()).into(),
        parameters: Vec::new(),
        half_width: HALF_WIDTH,
    });
    for outside in ["http:", "https:", "src=", "@import", "url(", "import ", "fetch(", "{{", "<b>"] {
        assert!(!page.contains(outside), "the page holds {outside}");
    }
    assert_eq!(page.matches("</script>").count(), 3);
}

#[test]
fn the_panel_shows_parameters_that_exist() {
    let script = include_str!("../page/ride/panel.js");
    let (_, list) = script.split_once("const PROMINENT = [").unwrap();
    let names: Vec<&str> = list.split_once(']').unwrap().0.split('"').skip(1).step_by(2).collect();
    let rows = Parameters::ROWS;
    let known = rows.iter().flat_map(|row| (0..row.slots()).map(|element| row.variable_name(element)));
    let known: Vec<String> = known.collect();
    assert!(names.len() > 3 && names.iter().all(|name| known.iter().any(|known| known == name)), "{names:?}");
}
