//! The page: a template with the style, the scripts and the data put in.

use serde::Serialize;

use crate::check::{Unusable, check};
use crate::data::Report;
use crate::events::{Event, events};

const TEMPLATE: &str = include_str!("../page/page.html");
const STYLE: &str = include_str!("../page/style.css");
const ALARM: &str = include_str!("../page/alarm.js");

/// In the order in which they build upon each other.
const SCRIPTS: [&str; 15] = [
    include_str!("../page/data.js"),
    include_str!("../page/format.js"),
    include_str!("../page/dom.js"),
    include_str!("../page/palette.js"),
    include_str!("../page/thin.js"),
    include_str!("../page/chart.js"),
    include_str!("../page/vector.js"),
    include_str!("../page/machine.js"),
    include_str!("../page/camera.js"),
    include_str!("../page/view.js"),
    include_str!("../page/limits.js"),
    include_str!("../page/gauges.js"),
    include_str!("../page/measures.js"),
    include_str!("../page/panels.js"),
    include_str!("../page/main.js"),
];

/// What the scripts read.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report,
    /// Of each run.
    events: Vec<Vec<Event>>,
}

/// The whole page as HTML, which needs no network and no other file.
///
/// # Errors
/// The data do not fit together: see [`check`].
///
/// # Panics
/// Never: plain data always serialise.
pub fn html(report: &Report) -> Result<String, Unusable> {
    check(report)?;
    let page = Page { report, events: report.runs.iter().map(|run| events(run, &report.rig)).collect() };
    // Nothing in the data can end the script element that holds them: a < in JSON stands in a string only.
    let data = serde_json::to_string(&page).expect("plain data serialise").replace('<', "\\u003c");
    Ok(filled(
        TEMPLATE,
        &[
            ("title", &escaped(&report.title)),
            ("subtitle", &escaped(&report.subtitle)),
            ("style", STYLE),
            ("alarm", ALARM),
            ("data", &data),
            ("script", &SCRIPTS.join("\n")),
        ],
    ))
}

/// The template with every `{{name}}` replaced; what is put in is not looked at again.
fn filled(template: &str, texts: &[(&str, &str)]) -> String {
    let mut parts = template.split("{{");
    let mut page = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("}}").expect("the template closes its braces");
        let (_, text) = texts.iter().find(|(known, _)| *known == name).expect("the template names what there is");
        page.push_str(text);
        page.push_str(rest);
    }
    page
}

/// Text as HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
