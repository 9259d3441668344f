//! The drives of the bench: data in `drives.toml`.

use std::sync::LazyLock;

use moris_simulation::Manoeuvre;
use moris_simulation::drives::car::{Course, STEP};
use moris_simulation::drives::runs::{RUN_A, RUN_B, RUN_C};
use moris_simulation::drives::smooth::{Change, changes, rise};
use moris_washout::Input;
use moris_washout::interface::{AngularVelocityFrame, STANDARD_GRAVITY as GRAVITY};
use serde::Deserialize;

/// A drive of the bench.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Name in tables, and of its file.
    pub name: String,
    /// Description.
    pub text: String,
    /// The paper's run; none of a car and a flight.
    run: Option<String>,
    /// A car's course; with neither, the drive is the flight.
    course: Option<Course>,
}

/// Axes of the angular velocities of all drives.
pub const RATE_FRAME: AngularVelocityFrame = AngularVelocityFrame::Body;

/// Every drive, in the bench's order.
pub static BENCH_DRIVES: LazyLock<Vec<Drive>> = LazyLock::new(|| {
    #[derive(Deserialize)]
    struct File {
        drive: Vec<Drive>,
    }
    toml::from_str::<File>(include_str!("drives.toml")).expect("a test reads the drives").drive
});

/// Duration of the flight \[s\].
const FLIGHT_DURATION: f64 = 80.0;

impl Drive {
    /// The inputs of the drive.
    pub fn manoeuvre(&self) -> Manoeuvre {
        if let Some(course) = &self.course {
            return course.manoeuvre();
        }
        let named = |name: &str| [RUN_A, RUN_B, RUN_C].into_iter().find(|run| run.name == name);
        let Some(run) = self.run.as_deref().and_then(named) else {
            return Manoeuvre::sampled(STEP, FLIGHT_DURATION, flight_input);
        };
        Manoeuvre::sampled(STEP, run.duration, |t| {
            let motion = run.motion(t);
            Input {
                specific_force: motion.specific_force().into(),
                angular_velocity: motion.angular_velocity().into(),
                speed: motion.speed,
                ..Input::default()
            }
        })
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
    use moris_simulation::fit::{Aims, Search};
    use moris_washout::Parameters;
    use moris_washout::interface::AutomaticScale;

    fn largest(drive: &str, of: fn(&Input) -> f64) -> f64 {
        let drive = BENCH_DRIVES.iter().find(|other| other.name == drive).unwrap();
        drive.manoeuvre().inputs().iter().map(|input| of(input).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn every_drive_begins_in_rest_or_steady_motion_and_stays_within_what_its_vehicle_can_do() {
        for drive in &*BENCH_DRIVES {
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
        for drive in &*BENCH_DRIVES {
            assert_eq!(drive.manoeuvre().inputs(), drive.manoeuvre().inputs(), "{}", drive.name);
        }
    }

    /// An event that is over before the automatic scale has learned: it begins with what fits.
    #[test]
    fn single_events_have_the_right_shape_with_an_automatic_scale_that_begins_with_the_fit() {
        for name in ["lane-change", "emergency-stop"] {
            let drive = BENCH_DRIVES.iter().find(|drive| drive.name == name).unwrap().manoeuvre();
            let search = Search::new(&drive, 0.0, Aims::default());
            let mut parameters = Parameters::default();
            let factors = search.fit(&parameters).unwrap().best.factors;
            parameters.automatic_scale.automatic = AutomaticScale::On;
            let shape = search.exact(&parameters, factors).unwrap().shape;
            let (least, (_, inverted)) = (shape.least_shape().unwrap(), shape.most_inverted_axis().unwrap());
            assert!(least >= 0.8 && inverted <= 0.03, "{name}: shape {least}, inverted {inverted}");
        }
    }
}
