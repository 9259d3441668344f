//! The picture of a rig: itself, three sections through its workspace, and where its legs are
//! closest to each other.

use moris_washout::platform::Pose;

use super::section::{DRAWN_CLEARANCES, SECTION_PLANES, section};
use super::survey::{Singularities, Survey};
use super::svg::{PANEL_SIZE, escaped};
use super::view::view;
use crate::texts::text;
use moris_simulation::clearance::Approach;

const SVG_STYLE: &str = "text{font:13px system-ui,sans-serif;fill:#333}.title{font-size:20px;font-weight:600}.panel{font-size:14px;\
font-weight:600}.frame{fill:none;stroke:#999}.safety{fill:none;stroke:#d95f02;stroke-width:1.5;stroke-dasharray:6 4}\
.neutral{stroke:#111;stroke-width:1.5}.base{fill:#e9e9e9;stroke:#777}.platform{fill:#2171b5;fill-opacity:.25;stroke:#2171b5;\
stroke-width:2}.leg{stroke:#555;stroke-width:4;stroke-linecap:round}.arm{stroke:#d95f02;stroke-width:6;stroke-linecap:round}.number{fill:#fff;stroke:#555}.arrow{stroke:#d95f02;\
stroke-width:2}.torso{stroke:#1b9e77;stroke-width:4;stroke-linecap:round}.head{fill:#1b9e77}.singular{fill:#b2182b}\
.close{stroke:#b2182b}.gap{stroke:#b2182b;stroke-width:2;stroke-dasharray:3 3}.point{fill:#b2182b}.collision{fill:#b2182b;font-weight:600}";

/// The picture as SVG.
pub fn svg(survey: &Survey) -> String {
    // Room above the panels and below them [px].
    const HEADER_HEIGHT: f64 = 64.0;
    const FOOTER_HEIGHT: f64 = 44.0;
    let parameters = &survey.capabilities.parameters;
    let (width, height) = (2.0 * PANEL_SIZE[0], HEADER_HEIGHT + 3.0 * PANEL_SIZE[1] + FOOTER_HEIGHT);
    let mut text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"><title>{0}</title><style>{SVG_STYLE}</style><rect width="{width}" height="{height}" fill="#fff"/><text x="24" y="34" class="title">{0}</text>"##,
        escaped(&survey.name)
    );
    text += &format!(r#"<text x="24" y="56">{}</text>"#, escaped(&verdict_line(survey)));
    let drawn = SECTION_PLANES.iter().map(|plane| {
        let body = section(&parameters.rig, plane, survey.workspace.extent, parameters.safety.position_limit);
        (plane.title.to_owned(), body)
    });
    let closest = &survey.capabilities.clearance.approaches[0];
    let [first, second] = closest.legs.map(|leg| leg + 1);
    let close_title = format!("Legs {first} and {second} where they are closest: {:.0} mm", 1000.0 * closest.distance);
    let panels = [("The rig at neutral".to_owned(), view(parameters, &Pose::neutral(&parameters.rig), None))]
        .into_iter()
        .chain(drawn)
        .chain([
            (close_title, view(parameters, &closest.pose, Some(closest))),
            ("Closest approach of each pair of legs [mm]".to_owned(), distance_table(survey)),
        ]);
    for (index, (title, body)) in panels.enumerate() {
        let (x, y) = ((index % 2) as f64 * PANEL_SIZE[0], HEADER_HEIGHT + (index / 2) as f64 * PANEL_SIZE[1]);
        text +=
            &format!(r#"<g transform="translate({x} {y})"><text x="64" y="30" class="panel">{title}</text>{body}</g>"#);
    }
    text + &colour_legend(height - FOOTER_HEIGHT) + "</svg>\n"
}

/// Table of the closest approach of each pair of legs.
fn distance_table(survey: &Survey) -> String {
    // Height of a row of the table of closest approaches [px].
    const TABLE_ROW_HEIGHT: f64 = 26.0;
    let at = |column: usize, row: usize| [120.0 + 64.0 * column as f64, 80.0 + TABLE_ROW_HEIGHT * row as f64];
    let cell = |[x, y]: [f64; 2], class: &str, text: &str| {
        format!(r#"<text x="{x}" y="{y}" text-anchor="middle" class="{class}">{text}</text>"#)
    };
    let mut text: String = (1..6).map(|leg| cell(at(leg - 1, 0), "", &format!("leg {leg}"))).collect();
    text += &(2..=6).map(|leg| cell([64.0, at(0, leg - 1)[1]], "", &format!("leg {leg}"))).collect::<String>();
    for Approach { legs: [first, second], distance, .. } in &survey.capabilities.clearance.approaches {
        let class = if survey.capabilities.clearance.collides(*distance) { "collision" } else { "" };
        text += &cell(at(*first, *second), class, &format!("{:.0}", 1000.0 * distance));
    }
    let diameter = 1000.0 * survey.capabilities.clearance.diameter;
    let [_, y] = at(0, 7);
    text + &format!(r#"<text x="40" y="{y}">Legs are taken as {diameter:.0} mm thick.</text>"#)
}

fn verdict_line(survey: &Survey) -> String {
    let volume = survey.workspace.level;
    let collision = if survey.capabilities.clearance.collisions().next().is_some() { "; LEGS COLLIDE" } else { "" };
    let regular = match &survey.capabilities.singularities {
        Singularities::None(found) => {
            text!["regular-workspace", size = volume.size, worst = found.worst_condition].to_string()
        }
        Singularities::At(_) => {
            format!("Workspace {:.3} m³ level; singular inside the stroke of its legs", volume.size)
        }
    };
    regular + collision
}

/// Legend of the colours.
fn colour_legend(top: f64) -> String {
    let mut text = format!(r#"<g transform="translate(64 {top})">"#);
    let mut x = 0.0;
    for (clearance, colour) in DRAWN_CLEARANCES {
        let label = if clearance == 0.0 {
            "where the level platform can be".to_owned()
        } else {
            format!("{:.0} mm of stroke left", 1000.0 * clearance)
        };
        text += &format!(
            r#"<rect x="{x}" y="8" width="18" height="14" fill="{colour}"/><text x="{}" y="20">{label}</text>"#,
            x + 26.0
        );
        x += 60.0 + 7.0 * label.len() as f64;
    }
    text += &format!(r#"<path d="M{x} 15h24" class="safety"/><text x="{}" y="20">safety units</text></g>"#, x + 32.0);
    text
}
