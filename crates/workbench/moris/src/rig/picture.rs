//! The picture of a rig: itself, and three sections through its workspace.

use super::section::{MARGINS, PLANES, section};
use super::survey::{Singularities, Survey};
use super::svg::{PANEL, escaped};
use super::view::view;

/// Room above the panels and below them \[px\].
const HEADER: f64 = 64.0;
const FOOTER: f64 = 44.0;

const STYLE: &str = "text{font:13px system-ui,sans-serif;fill:#333}.title{font-size:20px;font-weight:600}.panel{font-size:14px;\
font-weight:600}.frame{fill:none;stroke:#999}.safety{fill:none;stroke:#d95f02;stroke-width:1.5;stroke-dasharray:6 4}\
.neutral{stroke:#111;stroke-width:1.5}.base{fill:#e9e9e9;stroke:#777}.platform{fill:#2171b5;fill-opacity:.25;stroke:#2171b5;\
stroke-width:2}.leg{stroke:#555;stroke-width:4;stroke-linecap:round}.number{fill:#fff;stroke:#555}.arrow{stroke:#d95f02;\
stroke-width:2}.torso{stroke:#1b9e77;stroke-width:4;stroke-linecap:round}.head{fill:#1b9e77}.singular{fill:#b2182b}";

/// The picture as SVG.
pub fn svg(survey: &Survey) -> String {
    let parameters = &survey.parameters;
    let (width, height) = (2.0 * PANEL[0], HEADER + 2.0 * PANEL[1] + FOOTER);
    let mut text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"><title>{0}</title><style>{STYLE}</style><rect width="{width}" height="{height}" fill="#fff"/><text x="24" y="34" class="title">{0}</text>"##,
        escaped(&survey.name)
    );
    text += &format!(r#"<text x="24" y="56">{}</text>"#, escaped(&verdict(survey)));
    let drawn = PLANES.iter().map(|plane| {
        (plane.title, section(&parameters.rig, plane, survey.workspace.extent, parameters.safety.position_limit))
    });
    let panels = [("The rig at neutral", view(parameters))].into_iter().chain(drawn);
    for (index, (title, body)) in panels.enumerate() {
        let (x, y) = ((index % 2) as f64 * PANEL[0], HEADER + (index / 2) as f64 * PANEL[1]);
        text +=
            &format!(r#"<g transform="translate({x} {y})"><text x="64" y="30" class="panel">{title}</text>{body}</g>"#);
    }
    text + &legend(height - FOOTER) + "</svg>\n"
}

fn verdict(survey: &Survey) -> String {
    let volume = survey.workspace.level;
    match &survey.singularities {
        Singularities::None(found) => format!(
            "Workspace {:.3} m³ level; free of singularities: condition number at most {:.1}",
            volume.size, found.worst_condition
        ),
        Singularities::At(_) => {
            format!("Workspace {:.3} m³ level; SINGULAR inside the stroke of its legs", volume.size)
        }
    }
}

/// Legend of the colours.
fn legend(top: f64) -> String {
    let mut text = format!(r#"<g transform="translate(64 {top})">"#);
    let mut x = 0.0;
    for (margin, colour) in MARGINS {
        let label = if margin == 0.0 {
            "where the level platform can be".to_owned()
        } else {
            format!("{:.0} mm of stroke left", 1000.0 * margin)
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
