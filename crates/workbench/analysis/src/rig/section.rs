//! Sections through the workspace of the level platform.
//!
//! With the platform level, each leg restricts the platform's origin to a spherical shell. The
//! shell's centre is the position at which the leg's joints would coincide. Its radii are the leg's
//! shortest and longest length. A plane section of a shell is a ring. So the drawing is exact: the
//! intersection of six discs, less six other discs.

use moris_washout::Rig;
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::Pose;
use moris_washout::platform::reach::stroke_clearance;

use super::svg::Window;

/// Clearances from the ends of the stroke for which the section is drawn \[m\], and their colours.
pub const DRAWN_CLEARANCES: [(f64, &str); 3] = [(0.0, "#c6dbef"), (0.05, "#6baed6"), (0.1, "#2171b5")];

/// A plane through neutral.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Title above the drawing.
    pub title: &'static str,
    /// Coordinates across and upward: 0, 1, 2 for x, y, z.
    pub axes: [usize; 2],
    /// Names of the coordinates.
    pub names: [&'static str; 2],
}

/// The planes seen from above, from the right and from the front.
pub const SECTION_PLANES: [Plane; 3] = [
    Plane { title: "From above, at neutral height", axes: [0, 1], names: ["x: surge", "y: sway"] },
    Plane { title: "From the right, through neutral", axes: [0, 2], names: ["x: surge", "z: heave"] },
    Plane { title: "From the front, through neutral", axes: [1, 2], names: ["y: sway", "z: heave"] },
];

/// The section within `extent`, in coordinates relative to neutral, with the
/// safety units' box dashed.
pub fn section(rig: &Rig, plane: &Plane, extent: [Vector3<f64>; 2], safety: Vector3<f64>) -> String {
    let neutral = Vector3::new(0.0, 0.0, rig.neutral_height);
    let flat = |v: Vector3<f64>| plane.axes.map(|axis| v[axis]);
    let [low, high] = extent.map(|corner| flat((corner - neutral) * 1.08));
    let window = Window::around(low, high);
    let mut text = String::new();
    for (index, (clearance, colour)) in DRAWN_CLEARANCES.into_iter().enumerate() {
        let name = format!("s{}{}m{index}", plane.axes[0], plane.axes[1]);
        if rig.has_cranks() {
            text += &cell_section(rig, plane, clearance, &window, colour);
        } else if let Some(rings) = section_rings(rig, plane, neutral, clearance) {
            text += &filled_rings(&name, &rings, &window, colour);
        }
    }
    let [x0, y1] = window.pixel(flat(-safety));
    let [x1, y0] = window.pixel(flat(safety));
    let [cx, cy] = window.pixel([0.0, 0.0]);
    text += &format!(
        r#"<rect x="{x0:.1}" y="{y0:.1}" width="{:.1}" height="{:.1}" class="safety"/><path d="M{:.1} {cy:.1}h12M{cx:.1} {:.1}v12" class="neutral"/>"#,
        x1 - x0,
        y1 - y0,
        cx - 6.0,
        cy - 6.0
    );
    text + &window.axes(plane.names)
}

/// The section of a rig with cranks as cells, in which the actuators have this clearance.
fn cell_section(rig: &Rig, plane: &Plane, clearance: f64, window: &Window, colour: &str) -> String {
    // Cells across a section of a rig with cranks.
    const CELLS: u32 = 120;
    let [low, high] = window.corners();
    let mut path = String::new();
    let size = [0, 1].map(|k: usize| (high[k] - low[k]) / f64::from(CELLS));
    for (i, j) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))) {
        let at = [low[0] + (f64::from(i) + 0.5) * size[0], low[1] + (f64::from(j) + 0.5) * size[1]];
        let mut pose = Pose::neutral(rig);
        (pose.position[plane.axes[0]], pose.position[plane.axes[1]]) =
            (pose.position[plane.axes[0]] + at[0], pose.position[plane.axes[1]] + at[1]);
        if stroke_clearance(rig, &pose) >= clearance {
            let [x, y] = window.pixel([at[0] - 0.5 * size[0], at[1] + 0.5 * size[1]]);
            let [width, height] = size.map(|size| size * window.scale());
            path += &format!("M{x:.1} {y:.1}h{width:.1}v{height:.1}h-{width:.1}z");
        }
    }
    format!(r#"<path d="{path}" fill="{colour}"/>"#)
}

/// A leg's ring in the plane: centre, inner and outer radius \[m\].
struct Ring {
    centre: [f64; 2],
    inner: f64,
    outer: f64,
}

/// The six rings, or `None` where a leg does not reach the plane.
fn section_rings(rig: &Rig, plane: &Plane, neutral: Vector3<f64>, clearance: f64) -> Option<Vec<Ring>> {
    let across = 3 - plane.axes[0] - plane.axes[1];
    let ring = |leg: usize| {
        let centre = rig.base[leg] - rig.platform[leg] - neutral;
        let distance = centre[across];
        let outer = (rig.max_length - clearance).powi(2) - distance * distance;
        let inner = ((rig.min_length + clearance).powi(2) - distance * distance).max(0.0).sqrt();
        (outer > 0.0).then(|| Ring { centre: plane.axes.map(|axis| centre[axis]), inner, outer: outer.sqrt() })
    };
    (0..6).map(ring).collect()
}

/// The common interior of all rings, filled: nested groups, each clipped by one disc, with the
/// holes masked out. A nested clip path would be equivalent, but not every viewer supports it.
fn filled_rings(name: &str, rings: &[Ring], window: &Window, colour: &str) -> String {
    let circle = |ring: &Ring, radius: f64| {
        let [x, y] = window.pixel(ring.centre);
        format!(r#"<circle cx="{x:.2}" cy="{y:.2}" r="{:.2}"/>"#, radius * window.scale())
    };
    let area = window.area();
    let (mut discs, mut open, mut holes) = (String::new(), String::new(), String::new());
    for (leg, ring) in rings.iter().enumerate() {
        discs += &format!(r#"<clipPath id="{name}c{leg}">{}</clipPath>"#, circle(ring, ring.outer));
        open += &format!(r#"<g clip-path="url(#{name}c{leg})">"#);
        holes += &circle(ring, ring.inner);
    }
    let close = "</g>".repeat(rings.len());
    let mask = format!(
        r##"<mask id="{name}h" maskUnits="userSpaceOnUse" {area}><rect {area} fill="#fff"/><g fill="#000">{holes}</g></mask>"##
    );
    format!(r#"{discs}{mask}<g mask="url(#{name}h)">{open}<rect {area} fill="{colour}"/>{close}</g>"#)
}
