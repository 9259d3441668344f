//! Rigs with cranks: kinematics, refusals, and the limits of the cranks whatever the input. Angles
//! are computed here by another formula.

use moris_washout::interface::{RollPitchYaw, StrategyKind};
use moris_washout::motion::orientation::Orientation;
use moris_washout::platform::{
    Geometry, PlatformMotion, Pose, forward_kinematics, inverse_kinematics, leg_accelerations, leg_lengths,
    motion_of_legs,
};
use moris_washout::{Input, Output, Parameters, Rig, Washout, check, check_rig};
use nalgebra::{Rotation3, Vector3};

use crate::common::crank_rigs::{hobby, on, person};
use crate::common::random::Random;

/// A rig with cranks of this seed on which a washout runs.
fn random_rig(seed: u64) -> Rig {
    let mut random = Random::new(seed.wrapping_mul(0x5851_f42d));
    for _ in 0..2000 {
        let size = 10f64.powf(random.between(-1.2, 0.1));
        let arm = size * random.between(0.15, 0.5);
        let rod = arm * random.between(2.0, 6.0);
        let [spread, platform_spread] = [random.between(3.0, 28.0), random.between(3.0, 28.0)];
        let ratio = random.between(0.4, 1.0);
        let slant = random.between(-25.0, 25.0);
        let turn = if random.below(2) == 0 { 90.0 } else { -90.0 };
        let disorder = [0.0, 0.02][random.below(2) as usize] * size;
        let mut joint = |degrees: f64, radius: f64| {
            let angle = degrees.to_radians();
            let moved = Vector3::new(random.between(-disorder, disorder), random.between(-disorder, disorder), 0.0);
            Vector3::new(radius * angle.cos(), radius * angle.sin(), 0.0) + moved
        };
        let side = |i: usize| if i.is_multiple_of(2) { -1.0 } else { 1.0 };
        let base = std::array::from_fn(|i| joint(120.0 * (i / 2) as f64 + side(i) * spread, size));
        let platform =
            std::array::from_fn(|i| joint(120.0 * (i / 2) as f64 + side(i) * (60.0 - platform_spread), ratio * size));
        let heading: [f64; 6] =
            std::array::from_fn(|i| (120.0 * (i / 2) as f64 + side(i) * (spread + turn + slant)).to_radians());
        // The height at which the rod of the first crank is about at its best with a level arm.
        let arm_end = base[0] + arm * Vector3::new(heading[0].cos(), heading[0].sin(), 0.0);
        let apart = platform[0] - arm_end;
        let height = (rod * rod - apart.norm_squared()).max(0.0).sqrt() + arm * random.between(-0.3, 0.3);
        let range = random.between(0.6, 1.4);
        let rig = Rig {
            base,
            platform,
            neutral_height: height,
            crank_arm: arm,
            crank_rod: rod,
            crank_heading: heading,
            crank_min_angle: -range,
            crank_max_angle: random.between(0.6, 1.4),
            crank_least_transmission: random.between(0.1, 0.5),
            velocity_limit: arm * 10f64.powf(random.between(0.0, 1.2)),
            acceleration_limit: arm * 10f64.powf(random.between(1.0, 2.3)),
            ..Rig::default()
        };
        if check(&on(rig)).is_ok() {
            return rig;
        }
    }
    panic!("no rig of seed {seed} is accepted");
}

/// Angle and transmission of crank `i` in a pose: atan2(e, f) - acos(g/sqrt(e^2 + f^2)), and the
/// rod's direction along the arm's tangent.
fn crank(rig: &Rig, i: usize, position: &Vector3<f64>, rotation: &Rotation3<f64>) -> [f64; 2] {
    let heading = rig.crank_heading[i];
    let (u, w) = (Vector3::new(heading.cos(), heading.sin(), 0.0), Vector3::z());
    let joint = position + rotation * rig.platform[i] - rig.base[i];
    let (arm, rod) = (rig.crank_arm, rig.crank_rod);
    let (e, f) = (2.0 * arm * joint.dot(&w), 2.0 * arm * joint.dot(&u));
    let g = joint.norm_squared() + arm * arm - rod * rod;
    let angle = e.atan2(f) - (g / e.hypot(f)).acos();
    let angle = (angle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    let (sin, cos) = angle.sin_cos();
    let along = (joint - arm * (cos * u + sin * w)) / rod;
    assert!((along.norm() - 1.0).abs() < 1e-9 || angle.is_nan(), "the rod has its length: {}", along.norm());
    [angle, along.dot(&(cos * w - sin * u))]
}

/// The rotation of roll, pitch and yaw, by nalgebra.
fn rotation(angles: &RollPitchYaw) -> Rotation3<f64> {
    Rotation3::from_euler_angles(angles.roll, angles.pitch, angles.yaw)
}

fn rigs() -> impl Iterator<Item = Rig> {
    [person(), hobby()].into_iter().chain((0..10).map(random_rig))
}

/// A random pose that keeps the cranks' limits.
fn pose_within(rig: &Rig, random: &mut Random) -> Pose {
    loop {
        let size = rig.crank_arm;
        let mut next = |scale: f64| random.between(-scale, scale);
        let position = Vector3::new(next(size), next(size), rig.neutral_height + next(size));
        let angles = RollPitchYaw::new(next(0.3), next(0.3), next(0.4));
        let keeps = (0..6).all(|i| {
            let [angle, transmission] = crank(rig, i, &position, &rotation(&angles));
            (rig.crank_min_angle..=rig.crank_max_angle).contains(&angle) && transmission >= rig.crank_least_transmission
        });
        if keeps {
            return Pose { position, orientation: Orientation::new(angles) };
        }
    }
}

#[test]
fn angles_are_those_of_the_closed_form_and_lead_back_to_the_pose() {
    let mut random = Random::new(1);
    for rig in rigs() {
        let (geometry, neutral) = (Geometry::from(&rig), Pose::neutral(&rig));
        for _ in 0..crate::cases::cases(4000, 800) {
            let pose = pose_within(&rig, &mut random);
            let arcs = leg_lengths(&geometry, &pose);
            for (i, arc) in arcs.into_iter().enumerate() {
                let [angle, _] = crank(&rig, i, &pose.position, &rotation(&pose.orientation.angles));
                assert!((arc / rig.crank_arm - angle).abs() < 1e-12, "{i}: {} beside {angle}", arc / rig.crank_arm);
            }
            let near = PlatformMotion {
                position: pose.position + Vector3::repeat(1e-3 * rig.crank_arm),
                ..PlatformMotion::at_rest(pose)
            };
            let found = forward_kinematics(&geometry, &arcs, &near.pose()).unwrap();
            assert!((found.position - pose.position).norm() < 1e-9, "{found:?} {pose:?}");
        }
        assert!(forward_kinematics(&geometry, &leg_lengths(&geometry, &neutral), &neutral).is_ok());
    }
}

#[test]
fn rates_and_accelerations_are_the_derivatives_of_the_angles() {
    let mut random = Random::new(2);
    for rig in rigs() {
        let geometry = Geometry::from(&rig);
        for _ in 0..100 {
            let pose = pose_within(&rig, &mut random);
            let mut vector = |size: f64| {
                Vector3::new(random.between(-size, size), random.between(-size, size), random.between(-size, size))
            };
            let size = rig.crank_arm;
            let motion = PlatformMotion {
                velocity: vector(size),
                angular_velocity: vector(0.5),
                acceleration: vector(4.0 * size),
                angular_acceleration: vector(2.0),
                ..PlatformMotion::at_rest(pose)
            };
            // The pose after a short time, to third order.
            let angles = |time: f64| -> [f64; 6] {
                let position = motion.position + time * motion.velocity + 0.5 * time * time * motion.acceleration;
                let turn = time * motion.angular_velocity + 0.5 * time * time * motion.angular_acceleration;
                let turned = Rotation3::new(turn) * rotation(&pose.orientation.angles);
                std::array::from_fn(|i| crank(&rig, i, &position, &turned)[0] * rig.crank_arm)
            };
            let h = 2e-5;
            let [before, now, after] = [-h, 0.0, h].map(angles);
            let (legs, accelerations) = (inverse_kinematics(&geometry, &motion), leg_accelerations(&geometry, &motion));
            for i in 0..6 {
                let [rate, acceleration] =
                    [(after[i] - before[i]) / (2.0 * h), (after[i] - 2.0 * now[i] + before[i]) / (h * h)];
                let apart = (legs.velocity[i] - rate).abs() / (size + rate.abs());
                assert!(apart < 1e-5, "crank {i}: {} beside {rate}", legs.velocity[i]);
                let apart = (accelerations[i] - acceleration).abs() / (4.0 * size + acceleration.abs());
                assert!(apart < 2e-5, "crank {i}: {} beside {acceleration}", accelerations[i]);
            }
            let found = motion_of_legs(&geometry, &legs, &accelerations, &pose).unwrap();
            assert!((found.velocity - motion.velocity).norm() < 1e-9 * (1.0 + size));
            assert!((found.angular_acceleration - motion.angular_acceleration).norm() < 1e-7);
        }
    }
}

/// The variable that a refusal names, parts of its reason, and the change that is refused.
type RefusedChange<'a> = (&'a str, &'a [&'a str], &'a dyn Fn(&mut Rig));

/// The refusal of the person's rig with a change.
fn refusal(change: impl Fn(&mut Rig)) -> [String; 2] {
    let mut rig = person();
    change(&mut rig);
    let error = check_rig(&rig, 0.001).expect_err(&format!("{rig:?}"));
    [error.variable.to_string(), error.reason.to_string()]
}

#[test]
fn cranks_that_cannot_work_are_refused_with_the_reason() {
    assert_eq!(check_rig(&person(), 0.001), Ok(()));
    let cases: [RefusedChange; 9] = [
        ("crank.minAngle", &["below crank.maxAngle"], &|rig| rig.crank_min_angle = 1.5),
        ("crank.rod", &["longer than crank.arm"], &|rig| rig.crank_rod = 0.1),
        // sqrt(0.648134^2 + the distance in plan) less and plus the arm.
        ("crank.rod", &["rod of crank 1 needs", "neutralHeight"], &|rig| rig.crank_rod = 0.45),
        ("crank.rod", &["rod of crank 1 needs"], &|rig| rig.neutral_height = 1.2),
        ("rig.neutralHeight", &["arm of crank 1 would stand at", "-60.00 to 60.00"], &|rig| rig.neutral_height = 0.86),
        ("crank.leastTransmission", &["dead centre"], &|rig| rig.crank_least_transmission = 0.9),
        ("crank.arm", &["arms of cranks 1 and 2 meet"], &|rig| {
            rig.crank_heading[0] = -1.047;
            rig.crank_heading[1] = 2.094;
            rig.base[1] = rig.base[0] + Vector3::new(0.1, -0.1732, 0.0);
        }),
        ("rig.base, rig.platform", &["singular", "angles of", "order of crank.heading"], &|rig| {
            rig.crank_heading.reverse();
        }),
        ("rig.base, rig.platform", &["singular", "order of crank.heading"], &|rig| {
            *rig = hobby();
            rig.crank_heading = std::array::from_fn(|i| hobby().crank_heading[i ^ 1]);
        }),
    ];
    for (variable, parts, change) in cases {
        let [found, reason] = refusal(change);
        assert!(found == variable, "{found}: {reason}");
        assert!(parts.iter().all(|part| reason.contains(part)), "{found}: {reason}");
    }
}

#[test]
fn derivatives_of_outputs_are_those_of_angles_and_distances() {
    let parameters = on(person());
    let mut washout = Washout::new(&parameters).unwrap();
    let step = 1e-3;
    let input = |time: f64| Input {
        specific_force: Vector3::new(0.8 * (2.0 * time).sin(), 0.5 * (3.0 * time).sin(), 9.80665),
        ..Input::default()
    };
    let mut outputs = Vec::new();
    for k in 0..2000 {
        let time = k as f64 * step;
        washout.step_between(&input(time), &input(time + step), step);
        outputs.push((washout.output(), washout.output_derivative()));
    }
    for three in outputs[500..].windows(3) {
        let [before, now, after] = [three[0].0, three[1].0, three[2].0];
        let derivative = three[1].1;
        for i in 0..6 {
            assert_eq!((derivative.angle[i], derivative.length[i]), (now.angular_rate[i], now.leg_velocity[i]));
            for (before, after, rate) in [
                (before.angle[i], after.angle[i], now.angular_rate[i]),
                (before.length[i], after.length[i], now.leg_velocity[i]),
                (before.angular_rate[i], after.angular_rate[i], derivative.angular_rate[i]),
                (before.leg_velocity[i], after.leg_velocity[i], derivative.leg_velocity[i]),
            ] {
                let found = (after - before) / (2.0 * step);
                assert!((found - rate).abs() < 0.03 + 0.01 * rate.abs(), "{i}: {found} beside {rate}");
            }
        }
    }
}

/// Looks at the outputs for cranks beyond their limits, from the platform's pose.
struct Watch {
    parameters: Parameters,
    last: Option<([f64; 6], [f64; 6])>,
    extremes: Extremes,
}

/// How near the limits a motion came.
#[derive(Clone, Copy, Debug)]
struct Extremes {
    /// Least distance of an angle from either end \[rad\], and of a transmission from its limit.
    angle_room: f64,
    transmission_room: f64,
    /// Largest speed and acceleration, as a fraction of the limits.
    speed: f64,
    acceleration: f64,
}

impl Extremes {
    const NONE: Self =
        Extremes { angle_room: f64::INFINITY, transmission_room: f64::INFINITY, speed: 0.0, acceleration: 0.0 };

    fn with(&self, other: &Self) -> Self {
        Extremes {
            angle_room: self.angle_room.min(other.angle_room),
            transmission_room: self.transmission_room.min(other.transmission_room),
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
        }
    }
}

impl Watch {
    fn check(&mut self, output: &Output, step: f64) {
        let rig = &self.parameters.rig;
        let pose = rotation(&output.orientation);
        let angles: [[f64; 2]; 6] = std::array::from_fn(|i| crank(rig, i, &output.position, &pose));
        let mut mean = [0.0; 6];
        let [speed, acceleration] = [rig.velocity_limit, rig.acceleration_limit].map(|limit| limit / rig.crank_arm);
        for (i, [angle, transmission]) in angles.into_iter().enumerate() {
            assert!((output.angle[i] - angle).abs() < 1e-11, "{} beside {angle}", output.angle[i]);
            let joint = output.position + pose * rig.platform[i] - rig.base[i];
            assert!((output.length[i] - joint.norm()).abs() < 1e-12);
            let (lowest, highest) = (rig.crank_min_angle - 1e-9, rig.crank_max_angle + 1e-9);
            assert!((lowest..=highest).contains(&angle), "crank {i} at {angle} rad");
            assert!(transmission >= rig.crank_least_transmission - 1e-9, "crank {i} has {transmission}");
            let mut now = Extremes {
                angle_room: (angle - rig.crank_min_angle).min(rig.crank_max_angle - angle),
                transmission_room: transmission - rig.crank_least_transmission,
                ..Extremes::NONE
            };
            let rate = output.angular_rate[i];
            assert!(rate.abs() <= speed * (1.0 + 1e-6), "crank {i} at {rate} rad/s");
            if let Some((before, last_mean)) = self.last {
                mean[i] = (angle - before[i]) / step;
                let rounding = 1e-13 / step;
                assert!(mean[i].abs() <= speed * (1.0 + 1e-6) + rounding, "crank {i} turns at {} rad/s", mean[i]);
                let second = ((mean[i] - last_mean[i]).abs() - 2.0 * rounding) / step;
                assert!(second <= acceleration * (1.0 + 1e-6), "crank {i}: {second} rad/s2 beyond {acceleration}");
                (now.speed, now.acceleration) = ((mean[i].abs() - rounding) / speed, second / acceleration);
            }
            self.extremes = self.extremes.with(&now);
        }
        self.last = Some((angles.map(|[angle, _]| angle), mean));
    }
}

/// Distance from neutral, in m and rad.
fn displacement(parameters: &Parameters, output: &Output) -> f64 {
    let neutral = Vector3::new(0.0, 0.0, parameters.rig.neutral_height);
    (output.position - neutral).amax().max(output.orientation.to_vector().amax())
}

/// An episode of hostile input of constant steps, and then rest until the platform is neutral.
/// Returns the farthest that it was from neutral, relative to an arm, and how near the limits.
fn survive(parameters: &Parameters, seed: u64, count: usize, step: f64) -> (f64, Extremes) {
    let mut washout = Washout::new(parameters).unwrap();
    let mut watch = Watch { parameters: *parameters, last: None, extremes: Extremes::NONE };
    watch.check(&washout.output(), step);
    let mut random = Random::new(seed);
    let mut input = Input::default();
    let mut farthest = 0.0f64;
    let scale = 10f64.powf(random.between(-1.0, 1.5));
    for k in 0..count {
        let hold = [1, 3, 40, 300][(k / 400 + seed as usize) % 4];
        if k.is_multiple_of(hold) {
            let mut value = |size: f64| scale * random.between(-size, size);
            input = Input {
                specific_force: Vector3::new(value(3.0), value(3.0), 9.80665 + value(2.0)),
                angular_velocity: Vector3::new(value(0.5), value(0.5), value(0.5)),
                orientation: RollPitchYaw::new(value(0.1), value(0.1), value(0.1)),
                engaged: random.below(60) != 0,
                ..Input::default()
            };
        }
        washout.step(&input, step);
        watch.check(&washout.output(), step);
        farthest = farthest.max(displacement(parameters, &washout.output()));
    }
    for _ in 0..(200.0 / step) as usize {
        if displacement(parameters, &washout.output()) < 1e-6 {
            return (farthest / parameters.rig.crank_arm, watch.extremes);
        }
        washout.step(&Input::default(), step);
        watch.check(&washout.output(), step);
    }
    panic!("not neutral: {:?}", washout.output());
}

#[test]
fn limits_of_cranks_hold_whatever_the_input_and_the_platform_comes_home() {
    let strategies = StrategyKind::ALL;
    let (mut moved, mut extremes) = (0, Extremes::NONE);
    for seed in 0..crate::cases::cases(75, 12) {
        let rig = match seed % 6 {
            0 => person(),
            1 => hobby(),
            _ => random_rig(100 + seed),
        };
        let mut parameters = on(rig);
        parameters.structure.strategy = strategies[seed as usize % strategies.len()];
        if seed % 4 == 3 {
            parameters.soft_limit.pace = 0.0;
        }
        let step = [0.001, 0.004, 0.002][seed as usize % 3];
        parameters.structure.max_step = step;
        let Ok(()) = check(&parameters) else { continue };
        let (farthest, near) = survive(&parameters, seed, crate::cases::cases(20_000, 4_000), step);
        moved += usize::from(farthest > 0.1);
        extremes = extremes.with(&near);
    }
    println!("{moved} platforms moved; {extremes:?}");
    assert!(moved >= 6, "the platforms move: {moved}");
}
