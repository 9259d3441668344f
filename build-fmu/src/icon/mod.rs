//! `model.png`: the picture by which a tool shows a model.

mod canvas;

use canvas::{Canvas, Colour, Point};
use moris_washout::Rig;
use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
use moris_washout::platform::Pose;
use nalgebra::Vector3;

const INK: Colour = [0x1d, 0x27, 0x33];
const STEEL: Colour = [0x6b, 0x7b, 0x8c];
const RAM: Colour = [0x2f, 0x7e, 0xb8];
const MOTORCYCLE: Colour = [0xd9, 0x50, 0x14];

/// A motorcycle on a platform: the washout brings the one onto the other.
pub fn motorcycle_on_platform() -> Vec<u8> {
    let mut canvas = Canvas::new();
    draw_platform(&mut canvas, &Pose::neutral(&Rig::default()));
    draw_motorcycle(&mut canvas);
    canvas.png()
}

/// A platform in motion: raised, rolled and nose up.
pub fn stewart_platform() -> Vec<u8> {
    let mut canvas = Canvas::new();
    canvas.scale_and_move(1.1, (-13.0, -22.0));
    let pose = Pose {
        position: Vector3::new(0.0, 0.0, 1.2),
        orientation: Orientation::new(RollPitchYaw::new(-0.1, -0.18, 0.0)),
    };
    draw_platform(&mut canvas, &pose);
    canvas.png()
}

/// A motorcycle.
pub fn motorcycle() -> Vec<u8> {
    let mut canvas = Canvas::new();
    canvas.scale_and_move(1.75, (-96.0, 28.0));
    draw_motorcycle(&mut canvas);
    canvas.png()
}

/// The default rig with its platform in this pose, seen from its right side and from above.
fn draw_platform(canvas: &mut Canvas, pose: &Pose) {
    let rig = Rig::default();
    let base = rig.base.map(project);
    let platform = rig.platform.map(|joint| project(pose.position + pose.orientation.rotation * joint));
    canvas.polygon(&base, STEEL, 5.0);
    for (&foot, &head) in base.iter().zip(&platform) {
        canvas.line(foot, between(foot, head, 0.55), INK, 8.0);
        canvas.line(between(foot, head, 0.5), head, RAM, 5.0);
    }
    canvas.polygon(&platform, INK, 6.0);
    for joint in base.into_iter().chain(platform) {
        canvas.disc(joint, 5.5, INK);
    }
}

/// Wheels, engine, tank, seat, fork and handlebar, from the side, facing right.
fn draw_motorcycle(canvas: &mut Canvas) {
    let (rear, front) = ((82.0, 78.0), (176.0, 78.0));
    for wheel in [rear, front] {
        canvas.ring(wheel, 19.0, INK, 10.0);
        canvas.disc(wheel, 6.0, MOTORCYCLE);
    }
    let (engine, steering, bar) = ((126.0, 76.0), (155.0, 42.0), (143.0, 20.0));
    canvas.line(rear, engine, MOTORCYCLE, 8.0);
    canvas.line(front, steering, MOTORCYCLE, 8.0);
    canvas.line(steering, bar, MOTORCYCLE, 6.0);
    canvas.line(bar, (129.0, 24.0), MOTORCYCLE, 6.0);
    canvas.shape(
        &[
            (64.0, 40.0),
            (104.0, 50.0),
            (118.0, 36.0),
            (152.0, 34.0),
            (158.0, 50.0),
            (142.0, 84.0),
            (112.0, 84.0),
            (98.0, 60.0),
        ],
        MOTORCYCLE,
    );
}

/// A point of the rig in the picture; the view is from the right, with x to the right, and from
/// above.
fn project(point: Vector3<f64>) -> Point {
    const SCALE: f64 = 104.0;
    const SEEN_FROM_ABOVE: f64 = 0.34;
    let right = SCALE * point.x;
    let up = SCALE * (0.93 * point.z + SEEN_FROM_ABOVE * point.y);
    (128.0 + right as f32, 208.0 - up as f32)
}

fn between(from: Point, to: Point, fraction: f32) -> Point {
    (from.0 + fraction * (to.0 - from.0), from.1 + fraction * (to.1 - from.1))
}
