//! `model.png`: the picture by which a tool shows the model.

use moris_washout::Rig;
use nalgebra::Vector3;
use tiny_skia::{Color, FillRule, LineCap, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

/// Width and height \[pixels\].
const SIZE: u16 = 256;

const INK: [u8; 3] = [0x1d, 0x27, 0x33];
const STEEL: [u8; 3] = [0x6b, 0x7b, 0x8c];
const RAM: [u8; 3] = [0x2f, 0x7e, 0xb8];
const MOTORCYCLE: [u8; 3] = [0xd9, 0x50, 0x14];

/// The default rig at neutral with its six legs, seen from its right side and from above, and a motorcycle on it.
pub fn stewart_platform() -> Vec<u8> {
    let rig = Rig::default();
    let base = rig.base.map(project);
    let platform = rig.platform.map(|joint| project(joint + Vector3::new(0.0, 0.0, rig.neutral_height)));
    let mut canvas = Canvas::new();
    canvas.polygon(&base, STEEL, 5.0);
    for (&foot, &head) in base.iter().zip(&platform) {
        canvas.line(foot, between(foot, head, 0.55), INK, 8.0);
        canvas.line(between(foot, head, 0.5), head, RAM, 5.0);
    }
    canvas.polygon(&platform, INK, 6.0);
    for joint in base.into_iter().chain(platform) {
        canvas.disc(joint, 5.5, INK);
    }
    draw_motorcycle(&mut canvas);
    canvas.png()
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

/// A point of the picture: pixels to the right and down.
type Point = (f32, f32);

/// A point of the rig in the picture; the view is from the right, with x to the right, and from above.
fn project(point: Vector3<f64>) -> Point {
    const SCALE: f64 = 104.0;
    const SEEN_FROM_ABOVE: f64 = 0.34;
    let right = SCALE * point.x;
    let up = SCALE * (0.93 * point.z + SEEN_FROM_ABOVE * point.y);
    (128.0 + right as f32, 208.0 - up as f32)
}

fn between(from: Point, to: Point, share: f32) -> Point {
    (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1))
}

/// A transparent picture to draw on.
struct Canvas(Pixmap);

impl Canvas {
    fn new() -> Self {
        Canvas(Pixmap::new(u32::from(SIZE), u32::from(SIZE)).expect("the size is not zero"))
    }

    fn line(&mut self, from: Point, to: Point, colour: [u8; 3], width: f32) {
        let mut path = PathBuilder::new();
        path.move_to(from.0, from.1);
        path.line_to(to.0, to.1);
        self.stroke(path.finish(), colour, width);
    }

    fn polygon(&mut self, corners: &[Point], colour: [u8; 3], width: f32) {
        self.stroke(closed(corners), colour, width);
    }

    fn shape(&mut self, corners: &[Point], colour: [u8; 3]) {
        self.fill(closed(corners), colour);
    }

    fn ring(&mut self, centre: Point, radius: f32, colour: [u8; 3], width: f32) {
        self.stroke(PathBuilder::from_circle(centre.0, centre.1, radius), colour, width);
    }

    fn disc(&mut self, centre: Point, radius: f32, colour: [u8; 3]) {
        self.fill(PathBuilder::from_circle(centre.0, centre.1, radius), colour);
    }

    /// Fills a path; there is none where it has no extent.
    fn fill(&mut self, path: Option<Path>, colour: [u8; 3]) {
        if let Some(path) = path {
            self.0.fill_path(&path, &paint(colour), FillRule::Winding, Transform::identity(), None);
        }
    }

    /// Draws a path; there is none where it has no length.
    fn stroke(&mut self, path: Option<Path>, colour: [u8; 3], width: f32) {
        let stroke = Stroke { width, line_cap: LineCap::Round, ..Stroke::default() };
        if let Some(path) = path {
            self.0.stroke_path(&path, &paint(colour), &stroke, Transform::identity(), None);
        }
    }

    fn png(&self) -> Vec<u8> {
        self.0.encode_png().expect("a picture in memory can be encoded")
    }
}

/// The corners one after another and back to the first.
fn closed(corners: &[Point]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (n, &(x, y)) in corners.iter().enumerate() {
        if n == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    path.close();
    path.finish()
}

fn paint([red, green, blue]: [u8; 3]) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(Color::from_rgba8(red, green, blue, 255));
    paint
}
