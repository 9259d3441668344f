//! From the player's stick to the commanded lean.

use moris_motorcycle::path::follower::Follower;
use moris_motorcycle::{Model, Motorcycle, Output};

/// Commanded lean of a stick at its end: alone, and beside the help \[rad\].
const LEAN: f64 = 0.65;
const LEAN_BESIDE_HELP: f64 = 0.3;
/// Time by which the help looks ahead: about that in which the rider's lean follows \[s\].
const AHEAD: f64 = 0.5;
/// Natural frequency with which the help returns to the middle of the road \[rad/s\].
const RETURN: f64 = 0.8;

/// The commanded lean for a stick from -1 to 1, to the right \[rad\].
///
/// The help is the lean of the bend ahead, and a critically damped return to the middle. Of a
/// motorcycle that leans by φ, the deviation to the left has the second derivative -g φ.
pub fn lean(stick: f64, is_helped: bool, motorcycle: &Motorcycle) -> f64 {
    match motorcycle.follower() {
        Some(follower) if is_helped => {
            LEAN_BESIDE_HELP * stick + help(&motorcycle.output(), follower, motorcycle.parameters().run.gravity)
        }
        _ => LEAN * stick,
    }
}

fn help(now: &Output, follower: &Follower, gravity: f64) -> f64 {
    let curvature = follower.table().curvature_at(now.path_distance + AHEAD * now.speed);
    let sideways = now.speed * now.path_heading.sin();
    let back = RETURN * RETURN * now.path_deviation + 2.0 * RETURN * sideways;
    ((curvature * now.speed * now.speed + back) / gravity).atan()
}
