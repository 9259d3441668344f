//! A transparent picture to draw on.

use tiny_skia::{Color, FillRule, LineCap, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

/// Width and height \[pixels\].
const SIZE: u16 = 256;

/// A point of the picture: pixels to the right and down.
pub type Point = (f32, f32);

/// A colour: red, green and blue.
pub type Colour = [u8; 3];

/// The picture, with the transformation applied to what is drawn.
pub struct Canvas {
    picture: Pixmap,
    transform: Transform,
}

impl Canvas {
    /// An empty picture, without a transformation.
    pub fn new() -> Self {
        let picture = Pixmap::new(u32::from(SIZE), u32::from(SIZE)).expect("the size is not zero");
        Canvas { picture, transform: Transform::identity() }
    }

    /// From now on, everything is drawn this many times as large about the picture's origin, and
    /// then moved by this.
    pub fn scale_and_move(&mut self, scale: f32, (right, down): Point) {
        self.transform = Transform::from_row(scale, 0.0, 0.0, scale, right, down);
    }

    pub fn line(&mut self, from: Point, to: Point, colour: Colour, width: f32) {
        let mut path = PathBuilder::new();
        path.move_to(from.0, from.1);
        path.line_to(to.0, to.1);
        self.stroke(path.finish(), colour, width);
    }

    pub fn polygon(&mut self, corners: &[Point], colour: Colour, width: f32) {
        self.stroke(closed(corners), colour, width);
    }

    pub fn shape(&mut self, corners: &[Point], colour: Colour) {
        self.fill(closed(corners), colour);
    }

    pub fn ring(&mut self, centre: Point, radius: f32, colour: Colour, width: f32) {
        self.stroke(PathBuilder::from_circle(centre.0, centre.1, radius), colour, width);
    }

    pub fn disc(&mut self, centre: Point, radius: f32, colour: Colour) {
        self.fill(PathBuilder::from_circle(centre.0, centre.1, radius), colour);
    }

    /// Fills a path; there is none where it has no extent.
    fn fill(&mut self, path: Option<Path>, colour: Colour) {
        if let Some(path) = path {
            self.picture.fill_path(&path, &paint(colour), FillRule::Winding, self.transform, None);
        }
    }

    /// Draws a path; there is none where it has no length.
    fn stroke(&mut self, path: Option<Path>, colour: Colour, width: f32) {
        let stroke = Stroke { width, line_cap: LineCap::Round, ..Stroke::default() };
        if let Some(path) = path {
            self.picture.stroke_path(&path, &paint(colour), &stroke, self.transform, None);
        }
    }

    pub fn png(&self) -> Vec<u8> {
        self.picture.encode_png().expect("a picture in memory can be encoded")
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

fn paint([red, green, blue]: Colour) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(Color::from_rgba8(red, green, blue, 255));
    paint
}
