//! The drives of the bench. Their list is part of the bench's version: a change is a new version.

use moris_washout::Input;
use moris_washout::interface::{AngularVelocityFrame, STANDARD_GRAVITY as GRAVITY};

use super::car::{Course, KART, PASSENGER_CAR, STEP};
use super::runs;
use super::smooth::{Change, changes, rise};
use crate::Manoeuvre;

/// A drive of the bench.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Name in tables, and of its file.
    pub name: &'static str,
    /// Description.
    pub text: &'static str,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Run(runs::Manoeuvre),
    Car(Course),
    Flight,
}

/// Axes of the angular velocities of all drives.
pub const RATE_FRAME: AngularVelocityFrame = AngularVelocityFrame::Body;

/// A course of the passenger car without bends, braking or waves.
const STRAIGHT_COURSE: Course =
    Course { car: PASSENGER_CAR, duration: 30.0, speed: 20.0, along: &[], curvature: &[], weaving: None, road: &[] };

/// Every drive, in the bench's order.
pub const BENCH_DRIVES: [Drive; 10] = [
    Drive { name: "paper-a", text: "motorcycle: accelerate, then brake", kind: Kind::Run(runs::RUN_A) },
    Drive { name: "paper-b", text: "motorcycle: in a truck's wake", kind: Kind::Run(runs::RUN_B) },
    Drive { name: "paper-c", text: "motorcycle: brake to a brusque stop", kind: Kind::Run(runs::RUN_C) },
    Drive {
        name: "lane-change",
        text: "car: double lane change at 80 km/h",
        kind: Kind::Car(Course {
            duration: 20.0,
            speed: 22.2,
            // To the left and straight, and back: as much left as right in each.
            curvature: &[
                (0.008, 5.0, 0.6),
                (-0.016, 6.0, 0.8),
                (0.008, 7.2, 0.6),
                (-0.008, 9.2, 0.6),
                (0.016, 10.2, 0.8),
                (-0.008, 11.4, 0.6),
            ],
            ..STRAIGHT_COURSE
        }),
    },
    Drive {
        name: "slalom",
        text: "car: slalom at 60 km/h, 4 m/s² at 0.35 Hz",
        kind: Kind::Car(Course { speed: 16.7, weaving: Some([0.0144, 0.35, 3.0, 26.0]), ..STRAIGHT_COURSE }),
    },
    Drive {
        name: "emergency-stop",
        text: "car: from 100 km/h at 9 m/s² to rest",
        kind: Kind::Car(Course {
            duration: 20.0,
            speed: 27.8,
            along: &[(-9.0, 8.0, 0.3), (9.0, 8.0 + 27.8 / 9.0, 0.3)],
            ..STRAIGHT_COURSE
        }),
    },
    Drive {
        name: "roundabout",
        text: "car: brake, half round a roundabout, accelerate",
        kind: Kind::Car(Course {
            duration: 40.0,
            speed: 14.0,
            along: &[(-2.0, 4.0, 1.0), (2.0, 7.5, 1.0), (1.6, 20.0, 1.5), (-1.6, 24.4, 1.5)],
            curvature: &[(-0.04, 8.5, 1.2), (0.10, 10.5, 1.5), (-0.10, 16.5, 1.5), (0.04, 18.8, 1.2)],
            ..STRAIGHT_COURSE
        }),
    },
    Drive {
        name: "motorway",
        text: "car: bends, lane changes and a queue at 120 km/h",
        kind: Kind::Car(Course {
            duration: 90.0,
            speed: 33.3,
            along: &[(-1.5, 50.0, 1.5), (1.5, 56.0, 1.5), (0.8, 62.0, 2.0), (-0.8, 72.0, 2.0)],
            curvature: &[
                (0.0008, 5.0, 4.0),
                (-0.0008, 20.0, 4.0),
                (0.0011, 30.0, 1.5),
                (-0.0022, 31.9, 2.0),
                (0.0011, 34.3, 1.5),
                (-0.0010, 40.0, 4.0),
                (0.0010, 74.0, 4.0),
            ],
            road: &[[0.25, 1.3], [0.12, 2.1], [0.06, 5.3]],
            ..STRAIGHT_COURSE
        }),
    },
    Drive {
        name: "kart-lap",
        text: "kart: eight bends of up to 1.5 g",
        kind: Kind::Car(Course {
            car: KART,
            duration: 50.0,
            speed: 0.0,
            along: &[
                (4.0, 2.0, 0.5),
                (-4.0, 6.0, 0.3),
                (-7.0, 7.0, 0.3),
                (7.0, 8.0, 0.3),
                (3.0, 11.0, 0.4),
                (-3.0, 14.0, 0.4),
                (-6.0, 15.0, 0.3),
                (6.0, 16.2, 0.3),
                (3.5, 24.0, 0.4),
                (-3.5, 27.0, 0.4),
                (-7.0, 28.0, 0.3),
                (7.0, 29.4, 0.3),
                (2.5, 36.0, 0.4),
                (-2.5, 39.0, 0.4),
                (-4.5, 44.0, 0.4),
                (4.5, 46.8, 0.4),
            ],
            curvature: &[
                (0.12, 8.3, 0.5),
                (-0.12, 10.6, 0.5),
                (-0.05, 12.0, 0.5),
                (0.05, 13.6, 0.5),
                (0.09, 16.5, 0.5),
                (-0.18, 18.6, 0.8),
                (0.18, 20.6, 0.8),
                (-0.09, 22.8, 0.5),
                (-0.10, 29.6, 0.5),
                (0.10, 32.4, 0.5),
                (0.08, 33.2, 0.5),
                (-0.08, 35.4, 0.5),
                (-0.05, 40.0, 0.5),
                (0.05, 42.5, 0.5),
            ],
            road: &[[0.5, 6.0], [0.4, 9.0]],
            ..STRAIGHT_COURSE
        }),
    },
    Drive { name: "flight", text: "aircraft: take-off, coordinated turns, turbulence", kind: Kind::Flight },
];

/// Duration of the flight \[s\].
const FLIGHT_DURATION: f64 = 80.0;

impl Drive {
    /// The inputs of the drive.
    pub fn manoeuvre(&self) -> Manoeuvre {
        match self.kind {
            Kind::Car(course) => course.manoeuvre(),
            Kind::Flight => Manoeuvre::sampled(STEP, FLIGHT_DURATION, flight_input),
            Kind::Run(run) => Manoeuvre::sampled(STEP, run.duration, |t| {
                let motion = run.motion(t);
                Input {
                    specific_force: motion.specific_force().into(),
                    angular_velocity: motion.angular_velocity().into(),
                    speed: motion.speed,
                    ..Input::default()
                }
            }),
        }
    }
}

/// A light aircraft: take-off run, rotation and climb, two turns without sideslip, gusts.
fn flight_input(t: f64) -> Input {
    /// Changes of the bank, positive to the right, and of the pitch, nose down \[rad\].
    const BANK: [Change; 4] = [(0.45, 30.0, 3.0), (-0.45, 42.0, 3.0), (-0.35, 50.0, 3.0), (0.35, 64.0, 3.0)];
    const PITCH: [Change; 2] = [(-0.14, 16.0, 2.5), (0.10, 26.0, 3.0)];
    const SPEED: f64 = 55.0;
    let step = 1e-4;
    let rate = |of: &[Change]| (changes(of, t + step) - changes(of, t - step)) / (2.0 * step);
    let (bank, pitch) = (changes(&BANK, t), changes(&PITCH, t));
    // The engine's and the brakes' force; a climb at steady speed feels gravity along the axis.
    let thrust = 2.6 * (rise(t, 3.0, 1.5) - rise(t, 17.0, 3.0));
    let turn_rate = -GRAVITY * bank.tan() / SPEED;
    let gusts = rise(t, 20.0, 2.0) - rise(t, FLIGHT_DURATION - 4.0, 2.0);
    let wave = |amplitude: f64, frequency: f64, phase: f64| {
        amplitude * gusts * (std::f64::consts::TAU * frequency * t + phase).sin()
    };
    let mut input = Input { speed: SPEED * rise(t, 3.0, 18.0), ..Input::default() };
    input.specific_force.x = thrust - GRAVITY * pitch.sin() + wave(0.15, 0.6, 0.0);
    input.specific_force.y = wave(0.25, 0.45, 1.0) + wave(0.15, 1.1, 2.0);
    input.specific_force.z = GRAVITY / bank.cos() * pitch.cos() + wave(0.6, 0.8, 0.5) + wave(0.3, 1.7, 2.5);
    input.angular_velocity.x = rate(&BANK);
    input.angular_velocity.y = rate(&PITCH) - turn_rate * bank.sin();
    input.angular_velocity.z = turn_rate * bank.cos();
    input
}

#[cfg(test)]
mod tests {
    use super::*;

    fn largest(drive: &str, of: fn(&Input) -> f64) -> f64 {
        let drive = BENCH_DRIVES.iter().find(|other| other.name == drive).unwrap();
        drive.manoeuvre().inputs().iter().map(|input| of(input).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn every_drive_begins_in_rest_or_steady_motion_and_stays_within_what_its_vehicle_can_do() {
        for drive in BENCH_DRIVES {
            let manoeuvre = drive.manoeuvre();
            let [first, last] = [manoeuvre.inputs()[0], *manoeuvre.inputs().last().unwrap()];
            for input in [first, last] {
                assert!(input.specific_force.xy().norm() < 0.45, "{}: {input:?}", drive.name);
                assert!(input.angular_velocity.norm() < 0.01, "{}: {input:?}", drive.name);
            }
            let limit = if drive.name == "kart-lap" { 20.0 } else { 11.0 };
            assert!(manoeuvre.inputs().iter().all(|input| input.specific_force.xy().norm() < limit), "{}", drive.name);
        }
    }

    #[test]
    fn the_drives_have_the_accelerations_that_their_names_promise() {
        let sideways = |drive| largest(drive, |input| input.specific_force.y);
        let along = |drive| largest(drive, |input| input.specific_force.x);
        assert!((3.0..6.0).contains(&sideways("lane-change")), "{}", sideways("lane-change"));
        assert!((3.5..5.0).contains(&sideways("slalom")), "{}", sideways("slalom"));
        assert!((8.9..9.1).contains(&along("emergency-stop")));
        assert!((3.0..6.5).contains(&sideways("roundabout")), "{}", sideways("roundabout"));
        assert!((1.0..2.5).contains(&sideways("motorway")), "{}", sideways("motorway"));
        assert!((10.0..19.0).contains(&sideways("kart-lap")), "{}", sideways("kart-lap"));
        // A turn without sideslip has no lateral force but the gusts'.
        assert!(sideways("flight") < 0.45);
    }

    #[test]
    fn a_drive_is_the_same_each_time() {
        for drive in BENCH_DRIVES {
            assert_eq!(drive.manoeuvre().inputs(), drive.manoeuvre().inputs(), "{}", drive.name);
        }
    }
}
