//! The rider on a path: deviation, speed, stability, preview, and the end of a ride that is too
//! fast.

use crate::cases::cases;
use moris_interface::{Group, Writer, slot_count};
use moris_motorcycle::interface::{PATH_POINTS, Path, PathColumn};
use moris_motorcycle::path::preview_rider::{
    DEVIATION_WEIGHTS, INVERSE_CONTROL_WEIGHT, PREVIEW_INTERVAL, PREVIEW_INTERVALS, Plant, REFERENCE_RATE,
};
use moris_motorcycle::path::table::from_csv;
use moris_motorcycle::{Course, Input, Model, Motorcycle, Output, Parameters};
use nalgebra::{Vector2, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::common::motorcycle;

const STEP: f64 = 0.001;
const GRAVITY: f64 = 9.80665;

/// On one of the shipped paths, at a speed.
fn on(course: Course, speed: f64) -> Parameters {
    let mut parameters = Parameters::default();
    parameters.path.course = course;
    parameters.run.initial_speed = speed;
    parameters
}

/// A custom path of rows (distance, curvature, speed).
fn custom(rows: &[[f64; 3]]) -> Path {
    let column = |k: usize| PathColumn::from_fn(|_, row| rows.get(row).map_or(0.0, |values| values[k]));
    Path {
        course: Course::Custom,
        count: rows.len() as i32,
        distance: column(0),
        curvature: column(1),
        speed_limit: column(2),
        ..Path::default()
    }
}

/// The outputs at each step.
fn ride(motorcycle: &mut Motorcycle, seconds: f64, step: f64, input: impl Fn(f64) -> Input) -> Vec<Output> {
    let outputs = (0..(seconds / step).round() as u32).map(|k| {
        motorcycle.step(&input(f64::from(k) * step), step);
        motorcycle.output()
    });
    outputs.collect()
}

fn calm(_time: f64) -> Input {
    Input::default()
}

fn largest(outputs: &[Output], value: impl Fn(&Output) -> f64) -> f64 {
    outputs.iter().map(|output| value(output).abs()).fold(0.0, f64::max)
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value * value, count + 1));
    assert!(count > 100);
    f64::sqrt(sum / f64::from(count))
}

#[test]
fn a_table_that_the_course_does_not_use_is_a_warning() {
    let rows = [[0.0, 0.0, 10.0], [50.0, 0.0, 10.0]];
    let warnings =
        |course, path| Motorcycle::warnings(&Parameters { path: Path { course, ..path }, ..on(course, 10.0) });
    assert_eq!(warnings(Course::Custom, custom(&rows)), [""; 0]);
    assert_eq!(warnings(Course::Lap, Path::default()), [""; 0]);
    let [warning] = &warnings(Course::Lap, custom(&rows))[..] else { panic!("one warning") };
    for part in ["path.point.count is 2", "path.course is lap (6)", "set path.course to 2 (custom)"] {
        assert!(warning.contains(part), "{warning}");
    }
}

#[test]
fn on_the_shipped_paths_it_keeps_to_the_path_within_the_limits() {
    for (course, seconds, length, deviation) in [
        (Course::LaneChange, 25.0, 240.0, 0.03),
        (Course::Slalom, 30.0, 370.0, 0.03),
        (Course::Hairpin, 35.0, 320.0, 0.1),
        // Into the second round.
        (Course::Lap, 110.0, 1800.0, 0.1),
    ] {
        let parameters = on(course, 0.0);
        let outputs = ride(&mut motorcycle(&parameters), seconds, STEP, calm);
        let end = outputs[outputs.len() - 1];
        assert!(end.path_distance > length, "{course:?}: {}", end.path_distance);
        assert!(largest(&outputs, |o| o.path_deviation) < deviation, "{course:?}");
        let limits = parameters.path;
        // The head feels what is planned, and its own movements.
        let lateral = largest(&outputs, |o| o.speed * o.angular_velocity.z);
        assert!(lateral < 1.2 * limits.lateral_acceleration, "{course:?}: {lateral}");
        for output in &outputs {
            assert!(output.acceleration < 1.1 * limits.forward_acceleration, "{course:?}: {}", output.acceleration);
            assert!(output.acceleration > -1.1 * limits.deceleration, "{course:?}: {}", output.acceleration);
            assert!(output.speed < 1.03 * output.planned_speed + 0.3, "{course:?}: {}", output.speed);
            let limited = output.grip_limited || output.friction_limited || output.wheel_lift_limited;
            assert!(!limited && !output.off_path && !output.fallen);
        }
    }
}

/// The points of a path in the world, one every `step` metres: each a heading's step further, which
/// turns by the curvature's integral.
fn points(text: &str, step: f64) -> Vec<Vector2<f64>> {
    let path = from_csv(text).unwrap();
    let (mut point, mut heading) = (Vector2::zeros(), 0.0_f64);
    let mut points = vec![point];
    for row in 1..path.count as usize {
        let length = path.distance[row] - path.distance[row - 1];
        let parts = (length / step).ceil();
        let curvature = |t: f64| path.curvature[row - 1] + t * (path.curvature[row] - path.curvature[row - 1]);
        for part in 0..parts as u32 {
            let turn = curvature((f64::from(part) + 0.5) / parts) * length / parts;
            let middle = heading + 0.5 * turn;
            point += Vector2::new(middle.cos(), middle.sin()) * (length / parts);
            heading += turn;
            points.push(point);
        }
    }
    points
}

#[test]
fn its_deviation_is_the_distance_from_the_path_in_the_world() {
    let lap = points(include_str!("../../paths/lap.csv"), 0.05);
    assert!((lap[0] - lap[lap.len() - 1]).norm() < 0.01, "the lap closes");
    let mut vehicle = motorcycle(&on(Course::Lap, 20.0));
    let mut gusts = calm(0.0);
    let mut deviations = 0.0_f64;
    for k in 0..50_000 {
        gusts.wind.y = if k % 6000 < 1500 { 400.0 } else { 0.0 };
        vehicle.step(&gusts, STEP);
        if k % 500 == 0 {
            let output = vehicle.output();
            let position = output.position.xy();
            let nearest = lap.iter().map(|point| (point - position).norm()).fold(f64::MAX, f64::min);
            assert!((nearest - output.path_deviation.abs()).abs() < 0.03, "{nearest} {}", output.path_deviation);
            deviations = deviations.max(nearest);
        }
    }
    assert!(deviations > 0.1, "the gusts have blown it away, {deviations} m at most");
}

#[test]
fn from_3_to_50_m_s_motorcycle_rider_and_path_are_stable() {
    let vehicle = motorcycle(&on(Course::Lap, 0.0));
    let rider = vehicle.follower().unwrap().rider();
    for k in 30..=500 {
        let speed = 0.1 * f64::from(k);
        let poles = rider.closed_loop(vehicle.lateral(), vehicle.rider(), speed).complex_eigenvalues();
        let slowest = poles.iter().map(|pole| pole.re).fold(f64::MIN, f64::max);
        assert!(slowest < -0.3, "{slowest} 1/s at {speed} m/s");
        for pole in poles.iter() {
            let damping = -pole.re / pole.norm();
            assert!(damping > 0.07, "damping {damping} of {pole} at {speed} m/s");
        }
    }
}

#[test]
fn from_3_to_50_m_s_it_changes_lanes() {
    let speeds = [3.2_f64, 5.0, 8.0, 12.0, 20.0, 30.0, 40.0, 50.0];
    for speed in speeds.into_iter().step_by(cases(1, 3)) {
        // To the left by 3.5 m and back, in a length that costs 2 m/s2, or a curvature of 0.05 1/m.
        let quarter = (f64::sqrt(0.875 * speed * speed / 2.0)).max(f64::sqrt(0.875 / 0.05)).max(0.6 * speed);
        let curvature = 3.5 / (4.0 * quarter * quarter) * 2.0;
        let mut rows = vec![[0.0, 0.0, speed], [3.0 * speed, 0.0, speed]];
        for side in [1.0, -1.0, -1.0, 1.0] {
            let begin = rows[rows.len() - 1][0];
            rows.push([begin + quarter, side * curvature, speed]);
            rows.push([begin + 2.0 * quarter, 0.0, speed]);
        }
        let length = rows[rows.len() - 1][0];
        let parameters = Parameters { path: custom(&rows), ..on(Course::Custom, speed) };
        let mut vehicle = motorcycle(&parameters);
        let outputs = ride(&mut vehicle, 1.15 * length / speed + 8.0, STEP, calm);
        let deviation = largest(&outputs, |o| o.path_deviation);
        assert!(deviation < 0.1, "{deviation} m at {speed} m/s");
        let end = outputs[outputs.len() - 1];
        assert!(end.path_distance > length && (end.speed / speed - 1.0).abs() < 0.02);
        assert!(end.path_deviation.abs() < 0.02 && end.orientation.roll.abs() < 1e-3, "{speed} m/s: {end:?}");
        let side = largest(&outputs, |o| o.position.y);
        assert!((2.0..5.0).contains(&side), "{side} m to the left at {speed} m/s");
    }
}

/// The control's cost in a change of the steady lean is least: no addition to it saves anything.
#[test]
fn its_preview_minimises_the_cost() {
    let vehicle = motorcycle(&on(Course::Lap, 0.0));
    let rider = vehicle.follower().unwrap().rider();
    for speed in [5.0, 15.0, 30.0] {
        let gains = rider.gains(speed);
        let closed_loop = rider.closed_loop(vehicle.lateral(), vehicle.rider(), speed);
        let size = 1e-3;
        let steps = 14_000;
        // From 6 s to 8 s the steady lean grows by 0.2.
        let steady_lean = |time: f64| 0.1 * (1.0 - (0.5 * std::f64::consts::PI * (time - 6.0).clamp(0.0, 2.0)).cos());
        let bump = |time: f64, at: f64| f64::exp(-((time - at) / 0.4).powi(2));
        let cost = |addition: f64, at: f64| {
            let mut deviation = Plant::zeros();
            let mut cost = 0.0;
            for k in 0..steps {
                let time = f64::from(k) * size;
                let ahead: [f64; PREVIEW_INTERVALS + 1] =
                    std::array::from_fn(|k| steady_lean(time + k as f64 * PREVIEW_INTERVAL));
                let forward = gains.feedforward(&ahead) + addition * bump(time, at);
                let control = forward - gains.gain.dot(&deviation);
                let weighted = DEVIATION_WEIGHTS.map(|(coordinate, unit)| (deviation[coordinate] / unit).powi(2));
                cost += (weighted.iter().sum::<f64>() + control * control / INVERSE_CONTROL_WEIGHT) * size;
                let rate = (steady_lean(time + size) - steady_lean(time)) / size;
                // The middle of the step: the rule of second order.
                let slope = |deviation: &Plant| {
                    let mut slope = closed_loop * deviation - gains.turn * rate;
                    slope[REFERENCE_RATE] += forward;
                    slope
                };
                deviation += slope(&(deviation + slope(&deviation) * (0.5 * size))) * size;
            }
            cost
        };
        for at in [4.0, 5.5, 6.5, 7.5] {
            let (less, least, more) = (cost(-0.05, at), cost(0.0, at), cost(0.05, at));
            // The parabola through the three; gains between two knots are nearly those of the speed.
            let curvature = less + more - 2.0 * least;
            let saving = (more - less) * (more - less) / (8.0 * curvature);
            assert!(curvature > 0.0 && saving < 3e-3 * least, "{speed} m/s, {at} s: {less} {least} {more}");
        }
    }
}

#[test]
fn within_a_second_the_preview_is_what_the_head_feels() {
    // A step of the host's other than the internal one, and without and with gusts.
    let gusts = |time: f64| {
        let mut input = calm(time);
        input.wind = Vector3::new(100.0 * (0.4 * time).sin(), 80.0 * (0.7 * time).sin(), 0.0);
        input
    };
    let rides = [(0.01, &calm as &dyn Fn(f64) -> Input, 0.01), (0.01, &gusts, 0.4)];
    for &(step, input, least) in &rides[..cases(2, 1)] {
        let outputs = ride(&mut motorcycle(&on(Course::Lap, 0.0)), 100.0, step, input);
        let per_element = (0.2 / step).round() as usize;
        for k in 0..5 {
            let later = (k + 1) * per_element;
            let pairs = || outputs.iter().zip(&outputs[later..]).filter(|(now, _)| now.preview_count > k as i32);
            let surge = root_mean_square(pairs().map(|(now, then)| now.preview_surge[k] - then.specific_force.x));
            let sway = root_mean_square(pairs().map(|(now, then)| now.preview_sway[k] - then.specific_force.y));
            assert!(surge < least && sway < least, "{k}: {surge} {sway}");
        }
        // It is whole after the first second.
        let whole = outputs.iter().filter(|output| output.preview_count == 20).count();
        assert!(whole as f64 * step > 90.0, "{whole}");
    }
}

#[test]
fn the_commands_do_nothing_on_a_path_and_the_wind_does() {
    let commands = Input { throttle: 1.0, brake: 0.7, lean: -0.6, ..Input::default() };
    let [mut calmly, mut commanded, mut blown] = [(); 3].map(|()| motorcycle(&on(Course::Lap, 10.0)));
    let mut wind = calm(0.0);
    wind.wind.y = 200.0;
    for _ in 0..3000 {
        calmly.step(&calm(0.0), STEP);
        commanded.step(&commands, STEP);
        blown.step(&wind, STEP);
    }
    assert_eq!(calmly.output(), commanded.output());
    assert!(blown.output().path_deviation > 0.01);
}

#[test]
fn without_a_path_there_is_no_preview_and_no_place() {
    let mut vehicle = motorcycle(&Parameters { path: Path::default(), ..on(Course::None, 20.0) });
    vehicle.step(&Input { lean: 0.3, ..Input::default() }, 1.0);
    let output = vehicle.output();
    assert_eq!((output.preview_count, output.preview_step, output.path_distance), (0, 0.2, 0.0));
    assert!(output.preview_surge.iter().chain(&output.preview_sway).all(|&force| force == 0.0));
}

/// The forces of both tyres within the friction ellipse.
fn assert_within_friction(output: &Output, friction: f64, ratio: f64) {
    for (longitudinal, lateral, load) in [
        (output.front_longitudinal, output.front_lateral, output.front_load),
        (output.rear_longitudinal, output.rear_lateral, output.rear_load),
    ] {
        // Rolling resistance comes on top of drive and brakes.
        let along = (longitudinal.abs() - 0.018 * load).max(0.0);
        let used = (along / (friction * load)).powi(2) + (lateral / (ratio * friction * load)).powi(2);
        assert!(load < 1.0 || used < 1.02, "{used}: {longitudinal} {lateral} {load}");
    }
}

/// Ends the ride: within 30 s the motorcycle has stopped, and then feels gravity alone.
fn assert_comes_to_rest(vehicle: &mut Motorcycle) {
    ride(vehicle, 40.0, STEP, calm);
    let output = vehicle.output();
    assert_eq!(output.speed, 0.0);
    assert!((output.specific_force.norm() - GRAVITY).abs() < 1e-2, "{}", output.specific_force);
    assert_eq!(output.preview_count, 0);
}

#[test]
fn a_bend_that_is_much_too_fast_ends_beside_the_path() {
    let rows = [[0.0, 0.0, 50.0], [30.0, 0.0, 50.0], [40.0, 0.08, 50.0], [80.0, 0.08, 50.0], [90.0, 0.0, 50.0]];
    let parameters = Parameters { path: custom(&rows), ..on(Course::Custom, 40.0) };
    let mut vehicle = motorcycle(&parameters);
    let outputs = ride(&mut vehicle, 4.0, STEP, calm);
    let end = outputs[outputs.len() - 1];
    assert!(end.off_path && !end.fallen, "{end:?}");
    assert!(outputs.iter().any(|output| output.friction_limited || output.wheel_lift_limited || output.grip_limited));
    for output in &outputs {
        assert_within_friction(output, 1.2, 1.0);
        assert!(output.orientation.roll.abs() < 0.9 && output.specific_force.norm() < 40.0);
    }
    assert_comes_to_rest(&mut vehicle);
    let output = vehicle.output();
    assert!(output.off_path && output.orientation.roll.abs() < 0.01);
}

/// While the tyres hold, the path changes next to nothing about a motorcycle whose rider obeys
/// commands: rolling resistance is that of the load normal to the road.
#[test]
fn a_commanded_rider_moves_as_without_a_path_until_the_path_is_left() {
    let command = |time: f64| Input { throttle: 0.2, lean: 0.02 * (3.0 * time).sin(), ..Input::default() };
    let mut on_path = motorcycle(&on(Course::Lap, 10.0)).commanded();
    let mut free = motorcycle(&on(Course::None, 10.0));
    for (with, without) in ride(&mut on_path, 6.0, STEP, command).iter().zip(ride(&mut free, 6.0, STEP, command)) {
        let difference = (with.specific_force - without.specific_force).norm();
        assert!(difference < 1e-3, "{difference}");
        assert!(
            (with.path_deviation - without.position.y).abs() < 1e-3,
            "{} {}",
            with.path_deviation,
            without.position
        );
        assert_eq!((with.preview_count, with.off_path), (0, false));
    }
    let to_the_left = |_| Input { throttle: 0.2, lean: -0.2, ..Input::default() };
    ride(&mut on_path, 3.0, STEP, to_the_left);
    assert!(on_path.output().off_path);
    assert_comes_to_rest(&mut on_path);
}

#[test]
fn ice_in_a_bend_ends_in_a_fall() {
    let mut vehicle = motorcycle(&on(Course::Hairpin, 0.0));
    ride(&mut vehicle, 15.8, STEP, calm);
    assert!(vehicle.output().orientation.roll > 0.4);
    let mut ice = *vehicle.parameters();
    ice.tyres.friction = 0.1;
    vehicle.retune(&ice).unwrap();
    let outputs = ride(&mut vehicle, 4.0, STEP, calm);
    let first = outputs.iter().position(|output| output.grip_limited).unwrap();
    let fall = outputs.iter().position(|output| output.fallen).unwrap();
    assert!(first < fall, "{first} {fall}");
    for output in &outputs {
        assert!(output.orientation.roll.abs() < 1.5 && output.specific_force.norm() < 100.0, "{output:?}");
    }
    outputs[..fall].iter().for_each(|output| assert_within_friction(output, 0.1, 1.0));
    assert_comes_to_rest(&mut vehicle);
    assert!(vehicle.output().fallen);
}

#[test]
fn rain_from_the_beginning_makes_it_slower() {
    let time = |friction: f64| {
        let mut parameters = on(Course::Hairpin, 0.0);
        parameters.tyres.friction = friction;
        let outputs = ride(&mut motorcycle(&parameters), 40.0, 0.01, calm);
        assert!(largest(&outputs, |o| o.path_deviation) < 0.3, "friction {friction}");
        assert!(outputs.iter().all(|o| !o.off_path && !o.fallen));
        outputs.iter().position(|output| output.path_distance > 250.0).unwrap()
    };
    assert!(time(0.4) > time(1.2) + 100);
}

#[test]
fn a_path_that_ends_with_speed_0_ends_there() {
    let rows = [[0.0, 0.0, 20.0], [100.0, 0.0, 20.0], [130.0, 0.02, 20.0], [160.0, 0.0, 20.0], [260.0, 0.0, 0.0]];
    let mut vehicle = motorcycle(&Parameters { path: custom(&rows), ..on(Course::Custom, 0.0) });
    ride(&mut vehicle, 60.0, STEP, calm);
    let output = vehicle.output();
    assert_eq!(output.speed, 0.0);
    assert!((output.path_distance - 260.0).abs() < 1.0, "{}", output.path_distance);
    assert!((output.specific_force - Vector3::new(0.0, 0.0, GRAVITY)).norm() < 1e-3);
}

#[test]
fn limits_change_in_flight_and_the_path_does_not() {
    let mut vehicle = motorcycle(&on(Course::Lap, 20.0));
    ride(&mut vehicle, 12.0, STEP, calm);
    let changes: [fn(&mut Parameters); 5] = [
        |p| p.path.lateral_acceleration = 3.0,
        |p| p.path.deceleration = 4.0,
        |p| p.path.forward_acceleration = 1.0,
        |p| p.rider.torque_weight = 20.0,
        |p| p.tyres.friction = 0.8,
    ];
    for change in changes {
        let mut parameters = *vehicle.parameters();
        change(&mut parameters);
        let before = vehicle.output();
        vehicle.retune(&parameters).unwrap();
        let outputs = ride(&mut vehicle, 5.0, STEP, calm);
        // The reference's acceleration jumps with the plan.
        assert!((outputs[0].steer_torque - before.steer_torque).abs() < 2.0);
        assert!((outputs[0].orientation.roll - before.orientation.roll).abs() < 2e-3);
        assert!(largest(&outputs, |o| o.path_deviation) < 0.5);
        assert_eq!(outputs[1500].preview_count, 20);
    }
    let mut parameters = *vehicle.parameters();
    parameters.path.course = Course::Slalom;
    assert_eq!(vehicle.retune(&parameters).unwrap_err().variable, "path.course");
}

#[test]
fn unusable_paths_are_refused_by_name() {
    let straight = [[0.0, 0.0, 20.0], [100.0, 0.0, 20.0], [200.0, 0.0, 20.0]];
    type Change = fn(&mut Path);
    let cases: [(&str, Change); 7] = [
        ("path.point.count", |path| path.count = 1),
        ("path.point.count", |path| path.count = 65),
        ("path.point.distance[1]", |path| path.distance[0] = 1.0),
        ("path.point.distance[3]", |path| path.distance[2] = 100.05),
        ("path.point.curvature[2]", |path| path.curvature[1] = f64::NAN),
        ("path.point.speed[2]", |path| path.speed_limit[1] = 0.0),
        ("path.point.curvature[3]", |path| {
            path.repeat = true;
            path.curvature[2] = 0.01;
        }),
    ];
    for (variable, change) in cases {
        let mut path = custom(&straight);
        change(&mut path);
        let refusal = Motorcycle::new(&Parameters { path, ..Parameters::default() }, &Input::default()).unwrap_err();
        assert_eq!(refusal.variable, variable, "{refusal}");
    }
}

#[test]
fn csv_files_are_read_or_refused_with_the_line() {
    let path = from_csv("# a bend\nspeed, distance ,curvature\n20,0,0\n\n15,30.5,-0.02\n").unwrap();
    assert_eq!((path.count, path.distance[1], path.curvature[1], path.speed_limit[0]), (2, 30.5, -0.02, 20.0));
    let rows: String = (0..65).map(|k| format!("{k},0,10\n")).collect();
    for (text, named) in [
        ("", "is empty"),
        ("distance,speed\n0,1\n", "no column curvature"),
        ("distance,curvature,speed\n0,0,20\n10,x,20\n", "line 3: curvature is \"x\""),
        ("distance,curvature,speed\n0,0\n", "line 2: has no speed"),
        (&format!("distance,curvature,speed\n{rows}"), "has 65 rows, and a path has 64 at most"),
    ] {
        let refused = from_csv(text).unwrap_err();
        assert!(refused.contains(named), "{refused}");
    }
}

#[test]
fn steps_on_a_path_allocate_nothing_and_go_on_from_saved_bytes() {
    let mut vehicle = motorcycle(&on(Course::Lap, 25.0));
    ride(&mut vehicle, 8.0, STEP, calm);
    let bytes = postcard::to_allocvec(&vehicle).unwrap();
    let mut restored: Motorcycle = postcard::from_bytes(&bytes).unwrap();
    let counted = allocation_counter::measure(|| (0..3000).for_each(|_| vehicle.step(&calm(0.0), STEP)));
    assert_eq!(counted.count_total, 0);
    (0..3000).for_each(|_| restored.step(&calm(0.0), STEP));
    assert_eq!(vehicle.output(), restored.output());
}

fn assert_sane(output: &Output) {
    let mut values = [0.0; slot_count(Output::ROWS)];
    output.write(&mut Writer::new(&mut values));
    assert!(values.iter().all(|value| value.is_finite()), "{output:?}");
    assert!(output.speed >= 0.0 && output.speed < 150.0, "{}", output.speed);
    assert!(output.orientation.roll.abs() < 1.57, "roll {}", output.orientation.roll);
    assert!(output.specific_force.norm() < 2e3, "{}", output.specific_force);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24, 8), rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn no_path_makes_nonsense(
        rows in prop::collection::vec((0.2..80.0_f64, -0.5..0.5_f64, 1.0..100.0_f64), 2..PATH_POINTS),
        speed in 0.0..80.0_f64,
        friction in 0.1..1.5_f64,
        lateral in 0.5..30.0_f64,
        ratio in 0.1..2.0_f64,
        repeat: bool,
        wind in -600.0..600.0_f64,
    ) {
        let mut distance = 0.0;
        let mut table: Vec<[f64; 3]> = rows.iter().map(|&(further, curvature, speed)| {
            distance += further;
            [distance - rows[0].0, curvature * curvature * curvature, speed]
        }).collect();
        let last = table.len() - 1;
        table[last][1] = table[0][1];
        let mut parameters = Parameters { path: custom(&table), ..on(Course::Custom, speed) };
        parameters.path.repeat = repeat;
        parameters.path.lateral_acceleration = lateral;
        parameters.path.friction_ratio = ratio;
        parameters.tyres.friction = friction;
        let mut vehicle = motorcycle(&parameters);
        for k in 0..4000 {
            let mut input = calm(0.0);
            input.wind.y = if k % 3000 > 2000 { wind } else { 0.0 };
            vehicle.step(&input, 0.002);
            assert_sane(&vehicle.output());
        }
    }
}
