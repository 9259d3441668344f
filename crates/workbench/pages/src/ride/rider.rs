//! From the player's stick, throttle and brake to the rider's commands.

use moris_motorcycle::path::follower::Follower;
use moris_motorcycle::{Model, Motorcycle, Output};

/// Time by which the help looks ahead: about that in which the rider's lean follows \[s\].
const LOOK_AHEAD_TIME: f64 = 0.5;

/// The commanded lean for a stick from -1 to 1, to the right \[rad\].
///
/// The help is the lean of the bend ahead, and a critically damped return to the middle. Of a
/// motorcycle that leans by φ, the deviation to the left has the second derivative -g φ.
pub fn lean(stick: f64, is_helped: bool, motorcycle: &Motorcycle) -> f64 {
    // Commanded lean of a stick at its end: alone, and beside the help [rad].
    const STICK_LEAN: f64 = 0.65;
    const LEAN_BESIDE_HELP: f64 = 0.3;
    match motorcycle.follower() {
        Some(follower) if is_helped => {
            LEAN_BESIDE_HELP * stick + helped_lean(&motorcycle.output(), follower, motorcycle.parameters().run.gravity)
        }
        _ => STICK_LEAN * stick,
    }
}

/// Throttle and brake of a player. The help closes the throttle at the advised speed, here and
/// where the motorcycle will soon be, and brakes above it.
pub fn pedals([throttle, brake]: [f64; 2], is_helped: bool, motorcycle: &Motorcycle) -> [f64; 2] {
    // Throttle for each m/s below the advised speed, and brake for each above it, at which the help
    // holds the speed [s/m].
    const THROTTLE_GAIN: f64 = 0.3;
    const BRAKE_GAIN: f64 = 0.25;
    // Most of the brake that the help pulls.
    const MOST_BRAKE: f64 = 0.7;
    let Some(follower) = motorcycle.follower().filter(|_| is_helped) else { return [throttle, brake] };
    let now = motorcycle.output();
    let advised = [0.0, LOOK_AHEAD_TIME].map(|time| follower.planned_speed(now.path_distance + time * now.speed));
    let missing = advised[0].min(advised[1]) - now.speed;
    [throttle.min((THROTTLE_GAIN * missing).max(0.0)), brake.max((-BRAKE_GAIN * missing).clamp(0.0, MOST_BRAKE))]
}

fn helped_lean(now: &Output, follower: &Follower, gravity: f64) -> f64 {
    // Natural frequency with which the help returns to the middle of the road [rad/s].
    const RETURN_FREQUENCY: f64 = 0.8;
    let curvature = follower.table().curvature_at(now.path_distance + LOOK_AHEAD_TIME * now.speed);
    let sideways = now.speed * now.path_heading.sin();
    let back = RETURN_FREQUENCY * RETURN_FREQUENCY * now.path_deviation + 2.0 * RETURN_FREQUENCY * sideways;
    ((curvature * now.speed * now.speed + back) / gravity).atan()
}
