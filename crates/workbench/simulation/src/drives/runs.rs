//! The paper's three runs, a brisk variant of the first, and a town run, as
//! motions of the rider's head.
//!
//! The paper gives no amplitudes; those here are chosen after its figures. All runs are in closed
//! form, so that every value can be checked by hand.

use std::f64::consts::TAU;

use moris_washout::interface::STANDARD_GRAVITY as GRAVITY;

use super::smooth::{Change, changes, changes_integral, rise, rise_rate};

/// Time at which run c stops \[s\].
///
/// The speed gained is that of 2.2 m/s2 for 11 s, from the middle of one ramp to the middle of the
/// next. Braking with 3.5 m/s2, from the middle of its own ramp, loses the same speed.
pub const RUN_C_STOP: f64 = 22.0 + 10.5 / 2.0 + 2.2 * 11.0 / 3.5;

/// The motion of the rider's head at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Acceleration along x (forward), y (left) and z (up), axes that do not roll \[m/s2\].
    pub acceleration: [f64; 3],
    /// Roll \[rad\], positive to the right.
    pub roll: f64,
    /// Time derivative of the roll \[rad/s\].
    pub roll_rate: f64,
    /// Forward speed \[m/s\].
    pub speed: f64,
}

impl Motion {
    /// Specific force at the head \[m/s2\]: acceleration and gravity's reaction, in axes that roll
    /// with the head.
    pub fn specific_force(&self) -> [f64; 3] {
        let [x, y, z] = self.acceleration;
        let (sin, cos) = self.roll.sin_cos();
        [x, cos * y + sin * (z + GRAVITY), cos * (z + GRAVITY) - sin * y]
    }

    /// Angular velocity \[rad/s\]. With roll alone it is the same in the axes of the body and of
    /// the world.
    pub fn angular_velocity(&self) -> [f64; 3] {
        [self.roll_rate, 0.0, 0.0]
    }
}

/// One run: a name, a duration, and the motion as a function of time.
#[derive(Clone, Copy, Debug)]
pub struct Manoeuvre {
    /// The name in tables and figures.
    pub name: &'static str,
    /// Description of the motorcycle's motion.
    pub text: &'static str,
    /// Duration of the run \[s\].
    pub duration: f64,
    motion: fn(f64) -> Motion,
}

impl Manoeuvre {
    /// The head's motion at `time` \[s\].
    pub fn motion(&self, time: f64) -> Motion {
        (self.motion)(time)
    }
}

/// Run a: accelerate, then brake, in a straight line.
pub const RUN_A: Manoeuvre =
    Manoeuvre { name: "a", text: "accelerate, then brake, straight", duration: 55.0, motion: run_a };

/// Run a with every ramp of 2 s.
pub const RUN_A_BRISK: Manoeuvre =
    Manoeuvre { name: "a brisk", text: "run a with faster ramps", duration: 55.0, motion: run_a_brisk };

/// Run b: constant speed in the wake of a truck.
pub const RUN_B: Manoeuvre =
    Manoeuvre { name: "b", text: "constant speed in a truck's wake", duration: 10.0, motion: run_b };

/// Run c: accelerate, then brake to a brusque stop: the deceleration of 3.5 m/s2 ends at once.
pub const RUN_C: Manoeuvre =
    Manoeuvre { name: "c", text: "accelerate, brake to a brusque stop", duration: 50.0, motion: run_c };

/// A car in town: three starts and stops, two bends and a lane change. The run is not the paper's.
/// The strategies are compared by it.
pub const TOWN_RUN: Manoeuvre =
    Manoeuvre { name: "town", text: "a car through town: starts, stops, bends", duration: 90.0, motion: town_motion };

fn run_a(t: f64) -> Motion {
    straight_motion(t, &[(2.0, 3.0, 6.0), (-2.0, 15.0, 6.0), (-2.5, 24.0, 7.5), (2.5, 33.6, 7.5)])
}

fn run_a_brisk(t: f64) -> Motion {
    straight_motion(t, &[(2.0, 3.0, 2.0), (-2.0, 15.0, 2.0), (-2.5, 24.0, 2.0), (2.5, 33.6, 2.0)])
}

fn run_b(t: f64) -> Motion {
    // Constant speed of run b [m/s].
    const SPEED_IN_THE_WAKE: f64 = 25.0;
    /// Waves as amplitude, frequency \[Hz\], phase \[rad\].
    const AX: &[Wave] = &[(0.60, 0.35, 0.0), (0.35, 1.1, 0.7), (0.15, 2.0, 1.9)];
    const AY: &[Wave] = &[(0.80, 0.5, 0.4), (0.40, 1.3, 2.1), (0.20, 2.0, 0.3)];
    const AZ: &[Wave] = &[(0.30, 1.8, 1.0), (0.15, 3.1, 2.2)];
    const ROLL_DEGREES: &[Wave] = &[(3.0, 0.5, 2.0), (1.0, 1.3, 0.6)];

    let window = rise(t, 0.5, 1.5) - rise(t, 8.0, 1.5);
    let window_rate = rise_rate(t, 0.5, 1.5) - rise_rate(t, 8.0, 1.5);
    let roll = wave_sum(ROLL_DEGREES, t).to_radians();
    let roll_rate = sum_rate(ROLL_DEGREES, t).to_radians();
    Motion {
        acceleration: [window * wave_sum(AX, t), window * wave_sum(AY, t), window * wave_sum(AZ, t)],
        roll: window * roll,
        roll_rate: window_rate * roll + window * roll_rate,
        speed: SPEED_IN_THE_WAKE,
    }
}

fn run_c(t: f64) -> Motion {
    if t < RUN_C_STOP {
        straight_motion(t, &[(2.2, 1.0, 6.6), (-2.2, 12.0, 6.6), (-3.5, 22.0, 10.5)])
    } else {
        Motion::default()
    }
}

fn town_motion(t: f64) -> Motion {
    let starts_and_stops = [
        [(1.8, 2.0, 1.0), (-1.8, 8.0, 1.5), (-2.5, 16.0, 0.8), (2.5, 20.1, 0.8)],
        [(1.5, 24.0, 1.0), (-1.5, 29.0, 1.5), (-1.5, 38.0, 1.0), (1.5, 43.0, 1.0)],
        // The last braking ends at rest: from 9.575 m/s, at 3 m/s2.
        [(2.0, 47.0, 0.8), (-2.0, 51.0, 1.0), (-3.0, 58.0, 0.6), (3.0, 58.0 + 9.575 / 3.0, 0.6)],
    ];
    let bends = [(2.0, 20.5, 0.8), (-2.0, 23.5, 0.8), (-1.8, 31.0, 1.0), (1.8, 34.5, 1.0)];
    let lane_change = [(1.2, 52.5, 0.6), (-2.4, 54.0, 0.8), (1.2, 55.7, 0.6)];
    let mut motion = straight_motion(t, starts_and_stops.as_flattened());
    motion.acceleration[1] = changes(&[&bends[..], &lane_change].concat(), t);
    motion
}

/// A run in a straight line from rest with these changes of the acceleration \[m/s2\].
fn straight_motion(t: f64, along: &[Change]) -> Motion {
    // At the end, rounding may leave a speed slightly below zero.
    let speed = changes_integral(along, t).max(0.0);
    Motion { acceleration: [changes(along, t), 0.0, 0.0], speed, ..Motion::default() }
}

/// Amplitude, frequency \[Hz\], phase \[rad\].
type Wave = (f64, f64, f64);

/// The waves' sum.
fn wave_sum(waves: &[Wave], t: f64) -> f64 {
    waves.iter().map(|(amplitude, frequency, phase)| amplitude * (TAU * frequency * t + phase).sin()).sum()
}

/// The time derivative of [`wave_sum`].
fn sum_rate(waves: &[Wave], t: f64) -> f64 {
    waves.iter().map(|(amplitude, f, phase)| amplitude * TAU * f * (TAU * f * t + phase).cos()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    fn surge(run: Manoeuvre, time: f64) -> f64 {
        run.motion(time).acceleration[0]
    }

    #[test]
    fn run_a_passes_through_values_worked_out_by_hand() {
        assert_eq!(surge(RUN_A, 3.0), 0.0);
        assert_near(surge(RUN_A, 4.5), 2.0 * 0.15625, 1e-15); // A quarter of the rise: 1/16 (3 - 1/2).
        assert_near(surge(RUN_A, 6.0), 1.0, 1e-15);
        assert_eq!(surge(RUN_A, 12.0), 2.0);
        assert_eq!(surge(RUN_A, 22.0), 0.0);
        assert_near(surge(RUN_A, 27.75), -1.25, 1e-15);
        assert_eq!(surge(RUN_A, 32.0), -2.5);
        assert_near(surge(RUN_A, 54.9), 0.0, 1e-15);
    }

    #[test]
    fn the_brisk_run_has_the_amplitudes_of_run_a_and_ramps_of_two_seconds() {
        assert_near(surge(RUN_A_BRISK, 4.0), 1.0, 1e-15);
        assert_eq!(surge(RUN_A_BRISK, 5.0), 2.0);
        assert_eq!(surge(RUN_A_BRISK, 17.0), 0.0);
        assert_eq!(surge(RUN_A_BRISK, 26.0), -2.5);
        assert_near(surge(RUN_A_BRISK, 35.6), 0.0, 1e-15);
    }

    #[test]
    fn run_b_is_still_at_both_ends_and_is_its_waves_in_the_middle() {
        for time in [0.0, 0.5, 9.5, 10.0] {
            assert_eq!(RUN_B.motion(time), Motion { speed: 25.0, ..Motion::default() });
        }
        // At 4 s the window is 1, and 0.35, 1.1, 0.5 and 1.3 Hz are 1.4, 4.4, 2 and 5.2 turns.
        let Motion { acceleration: [ax, ay, az], roll, .. } = RUN_B.motion(4.0);
        assert_near(ax, 0.6 * (0.4 * TAU).sin() + 0.35 * (0.4 * TAU + 0.7).sin() + 0.15 * 1.9_f64.sin(), 1e-13);
        assert_near(ay, 0.8 * 0.4_f64.sin() + 0.4 * (0.2 * TAU + 2.1).sin() + 0.2 * 0.3_f64.sin(), 1e-13);
        assert_near(az, 0.3 * (0.2 * TAU + 1.0).sin() + 0.15 * (0.4 * TAU + 2.2).sin(), 1e-13);
        assert_near(roll.to_degrees(), 3.0 * 2.0_f64.sin() + (0.2 * TAU + 0.6).sin(), 1e-12);
    }

    #[test]
    fn the_ride_through_town_ends_at_rest_after_its_bends() {
        assert_near(TOWN_RUN.motion(12.0).speed, 1.8 * 6.25, 1e-12);
        let Motion { acceleration, speed, .. } = TOWN_RUN.motion(22.0);
        assert_near(acceleration[1], 2.0, 1e-15);
        assert_near(speed, 1.0, 1e-12);
        assert_near(TOWN_RUN.motion(90.0).speed, 0.0, 1e-12);
        assert!(TOWN_RUN.motion(90.0).acceleration.iter().all(|value| value.abs() < 1e-14));
        // A lane change: the lateral velocity is zero again after it.
        let step = 1e-3;
        let drift: f64 = (52_000..57_000).map(|k| step * TOWN_RUN.motion(f64::from(k) * step).acceleration[1]).sum();
        assert_near(drift, 0.0, 0.05);
    }

    #[test]
    fn the_roll_rate_is_the_roll_s_derivative() {
        for k in 1..1000 {
            let time = 0.01 * f64::from(k) + 0.0033;
            let difference = (RUN_B.motion(time + 1e-5).roll - RUN_B.motion(time - 1e-5).roll) / 2e-5;
            assert_near(RUN_B.motion(time).roll_rate, difference, 1e-8);
        }
    }

    #[test]
    fn run_c_stops_when_its_speed_is_zero() {
        let step = 1e-4;
        let before = (0..(RUN_C_STOP / step) as usize).map(|k| surge(RUN_C, (k as f64 + 0.5) * step));
        assert_near(before.sum::<f64>() * step, 0.0, 4e-4); // Half a step at 3.5 m/s2, rounded up.
        assert_near(RUN_C_STOP, 34.164_285_714, 1e-9);
        assert_eq!(surge(RUN_C, RUN_C_STOP - 1e-9), -3.5);
        assert_eq!(surge(RUN_C, RUN_C_STOP), 0.0);
    }

    #[test]
    fn the_speed_is_the_integral_of_the_acceleration() {
        for run in [RUN_A, RUN_A_BRISK, RUN_C] {
            for k in 1..500 {
                let time = 0.1 * f64::from(k) + 0.0033;
                let difference = (run.motion(time + 1e-5).speed - run.motion(time - 1e-5).speed) / 2e-5;
                assert_near(surge(run, time), difference, 1e-6);
            }
        }
        assert_near(RUN_A.motion(22.0).speed, 24.0, 1e-12);
        assert_near(RUN_C.motion(RUN_C_STOP - 1e-6).speed, 3.5e-6, 1e-9);
        assert_eq!(RUN_C.motion(RUN_C_STOP).speed, 0.0);
    }

    #[test]
    fn a_head_that_rolls_feels_gravity_from_the_side() {
        let upright = Motion { acceleration: [1.0, 2.0, 3.0], ..Motion::default() };
        assert_eq!(upright.specific_force(), [1.0, 2.0, 3.0 + GRAVITY]);
        // 30 degrees to the right: half of gravity's reaction points to the left.
        let rolled = Motion { roll: 30_f64.to_radians(), ..Motion::default() };
        let [x, y, z] = rolled.specific_force();
        assert_eq!(x, 0.0);
        assert_near(y, GRAVITY / 2.0, 1e-14);
        assert_near(z, GRAVITY * 0.75_f64.sqrt(), 1e-14);
    }

    #[test]
    fn a_balanced_turn_has_no_lateral_force() {
        // Leaning to the left (negative roll) into a turn that accelerates to the left.
        let roll = -0.3_f64;
        let turn = Motion { acceleration: [0.0, -GRAVITY * roll.tan(), 0.0], roll, ..Motion::default() };
        assert_near(turn.specific_force()[1], 0.0, 1e-14);
    }

    #[test]
    fn the_specific_force_at_rest_is_gravity_s_reaction() {
        for run in [RUN_A, RUN_A_BRISK, RUN_B, RUN_C] {
            assert_eq!(run.motion(0.0).specific_force(), [0.0, 0.0, GRAVITY]);
            assert_eq!(run.motion(0.0).angular_velocity(), [0.0; 3]);
        }
    }
}
