//! The rig in a pose, seen from the front right and above.

use moris_washout::interface::Parameters;
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::{Geometry, LocationFrame, Pose};

use super::svg::Window;
use moris_simulation::clearance::Approach;

/// The base, the platform in this pose, the six legs with their numbers, the rider's head, and the
/// axes of the base. The two closest legs have a colour of their own.
pub fn view(parameters: &Parameters, pose: &Pose, closest: Option<&Approach>) -> String {
    // Radius of the head [m].
    const HEAD_RADIUS: f64 = 0.12;
    // Length of the arrows along the base's axes, as a fraction of its radius.
    const ARROW_LENGTH_FRACTION: f64 = 0.4;
    let rig = &parameters.rig;
    let in_base = |point: &Vector3<f64>| pose.position + pose.orientation.rotation * point;
    let platform = rig.platform.map(|joint| in_base(&joint));
    let above_platform = LocationFrame::new(&parameters.structure, 0.0).point;
    let head = in_base(&above_platform);
    let seat = in_base(&(above_platform - Vector3::new(0.0, 0.0, parameters.structure.torso_length)));
    let radius = rig.base.iter().map(Vector3::norm).fold(0.0, f64::max);
    let arrows = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| ARROW_LENGTH_FRACTION * radius * axis);

    let above = head + Vector3::new(0.0, 0.0, HEAD_RADIUS);
    let seen: Vec<[f64; 2]> =
        rig.base.iter().chain(&platform).chain(&arrows).chain([&above]).map(projected_point).collect();
    let low = [0, 1].map(|axis| seen.iter().map(|point| point[axis]).fold(f64::INFINITY, f64::min) - 0.1 * radius);
    let high = [0, 1].map(|axis| seen.iter().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max) + 0.1 * radius);
    let window = Window::around(low, high);
    let at = |point: &Vector3<f64>| window.pixel(projected_point(point));
    let polygon = |joints: &[Vector3<f64>; 6], class: &str| {
        let points: Vec<String> =
            joints_in_order(joints).iter().map(&at).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        format!(r#"<polygon points="{}" class="{class}"/>"#, points.join(" "))
    };
    let line = |from: &Vector3<f64>, to: &Vector3<f64>, class: &str| {
        let ([x0, y0], [x1, y1]) = (at(from), at(to));
        format!(r#"<path d="M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}" class="{class}"/>"#)
    };

    let mut text = polygon(&rig.base, "base");
    for (arrow, name) in arrows.iter().zip(["x", "y", "z"]) {
        let [x, y] = at(&(arrow * 1.12));
        text += &line(&Vector3::zeros(), arrow, "arrow");
        text += &format!(r#"<text x="{x:.1}" y="{:.1}" text-anchor="middle">{name}</text>"#, y + 4.0);
    }
    let ends = Geometry::from(rig).rods(pose).base;
    for (leg, (from, to)) in (0..6).map(|leg| ends.joint(leg)).zip(&platform).enumerate() {
        let from = &from;
        if rig.has_cranks() {
            text += &line(&rig.base[leg], from, "arm");
        }
        let is_close = closest.is_some_and(|approach| approach.legs.contains(&leg));
        text += &line(from, to, if is_close { "leg close" } else { "leg" });
    }
    text += &polygon(&platform, "platform");
    for (leg, (from, to)) in rig.base.iter().zip(&platform).enumerate() {
        let [x, y] = at(&(from + 0.35 * (to - from)));
        text += &format!(
            r#"<circle cx="{x:.1}" cy="{y:.1}" r="9" class="number"/><text x="{x:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
            y + 4.0,
            leg + 1
        );
    }
    if let Some(Approach { points: [from, to], .. }) = closest {
        text += &line(from, to, "gap");
        for [x, y] in [at(from), at(to)] {
            text += &format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="4" class="point"/>"#);
        }
    }
    let [x, y] = at(&head);
    text += &line(&seat, &head, "torso");
    text += &format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="{:.1}" class="head"/>"#, HEAD_RADIUS * window.scale());
    text
}

/// Across and up in the picture, for someone who looks from afar.
fn projected_point(point: &Vector3<f64>) -> [f64; 2] {
    // Where it is seen from: turned about the vertical, then from above [rad].
    const VIEW_AZIMUTH: f64 = 0.6;
    const VIEW_ELEVATION: f64 = 0.35;
    let (sin, cos) = VIEW_AZIMUTH.sin_cos();
    let (nearer, across) = (cos * point.x - sin * point.y, sin * point.x + cos * point.y);
    [across, VIEW_ELEVATION.cos() * point.z - VIEW_ELEVATION.sin() * nearer]
}

/// The joints in the order in which they go round their centre.
fn joints_in_order(joints: &[Vector3<f64>; 6]) -> [Vector3<f64>; 6] {
    let centre = joints.iter().sum::<Vector3<f64>>() / 6.0;
    let mut sorted = *joints;
    sorted.sort_by(|a, b| {
        let angle = |joint: &Vector3<f64>| (joint.y - centre.y).atan2(joint.x - centre.x);
        angle(a).total_cmp(&angle(b))
    });
    sorted
}
