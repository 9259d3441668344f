//! The page: a template with the style, the scripts and the data put in.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use sha2::{Digest as _, Sha256};

use crate::bundle::bundle;
use crate::report::data::Report;
use crate::report::events::{Event, events};

/// The source of scripts for a page with a WebAssembly.
pub const WEBASSEMBLY_SOURCE: &str = "'wasm-unsafe-eval'";

/// Differences between the heads of pages.
#[derive(Clone, Copy, Debug, Default)]
pub struct Head<'a> {
    /// Plain text, as the subtitle.
    pub title: &'a str,
    pub subtitle: &'a str,
    /// Style after that of all pages.
    pub style: &'a str,
    /// Sources of scripts beside those in the page, as a content security policy has them.
    pub scripts: &'a str,
    /// Further directives of the policy.
    pub policy: &'a str,
}

impl Head<'_> {
    /// All up to the body of a page with these scripts. No other script and style can run.
    pub(crate) fn html(&self, scripts: &[&str]) -> String {
        // What stands before the template of every page.
        const HEAD_TEMPLATE: &str = include_str!("../../page/shared/head.html");
        // The style of every page, whose colours the scripts name.
        const SHARED_STYLE: &str = include_str!("../../page/shared/style.css");
        let style = format!("\n{SHARED_STYLE}{}", self.style);
        let sources: String = scripts.iter().map(|script| format!("{} ", element_hash(script))).collect();
        let policy = format!("script-src {sources}{}; {}", self.scripts, self.policy);
        let policy = if scripts.is_empty() { String::new() } else { policy };
        let texts = [
            ("title", escaped(self.title)),
            ("style-hash", element_hash(&style)),
            ("policy", policy),
            ("style", style),
        ];
        filled_template(HEAD_TEMPLATE, &texts)
    }
}

/// The hash of an element's text, as a content security policy has it.
fn element_hash(text: &str) -> String {
    // Line ends as a browser reads them.
    let text = text.replace("\r\n", "\n").replace('\r', "\n");
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)))
}

/// Data for the scripts.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report,
    /// Events of each run.
    events: Vec<Vec<Event>>,
    /// The script of the simulation beside the page; none for a page without simulation.
    worker: Option<String>,
}

/// The whole page as HTML, which needs no network and no other file.
///
/// # Panics
/// Never: plain data always serialise.
pub fn html(report: &Report) -> String {
    const PAGE_TEMPLATE: &str = include_str!("../../page/report/page.html");
    // The modules that a report and its worker begin with.
    const ENTRY_MODULE: &str = "report/main.js";
    const WORKER_MODULE: &str = "report/worker.js";
    let page = Page {
        report,
        events: report.runs.iter().map(|run| events(run, &report.rig)).collect(),
        worker: report.simulator.is_some().then(|| format!("\"use strict\";\n{}", bundle(WORKER_MODULE))),
    };
    let head = Head {
        title: &report.title,
        subtitle: &report.subtitle,
        style: "",
        scripts: WEBASSEMBLY_SOURCE,
        policy: "worker-src blob:",
    };
    assembled(&head, PAGE_TEMPLATE, &page, ENTRY_MODULE)
}

/// A page: a head, a template with the heading, then the data, and the script of the module at
/// `entry` below `page/`.
///
/// # Panics
/// The template names another text than the heading, or there is no such module.
pub fn assembled(head: &Head, template: &str, data: &impl Serialize, entry: &str) -> String {
    // The heading of every page, and what follows its template.
    const HEADING_TEMPLATE: &str = include_str!("../../page/shared/heading.html");
    const END_TEMPLATE: &str = include_str!("../../page/shared/scripts.html");
    // Runs before the other scripts, and says if one of them fails.
    const ALARM_SCRIPT: &str = include_str!("../../page/shared/alarm.js");
    // No data can end the script element: in JSON, a < occurs in strings only, where it is escaped.
    let data = serde_json::to_string(data).expect("plain data serialise").replace('<', "\\u003c");
    let script = format!("\n(async () => {{\n\"use strict\";\n{}\n}})();\n", bundle(entry));
    let head_html = head.html(&[ALARM_SCRIPT, &script]);
    let of_end = [("alarm", ALARM_SCRIPT.to_owned()), ("data", data), ("script", script)];
    let heading =
        filled_template(HEADING_TEMPLATE, &[("title", escaped(head.title)), ("subtitle", escaped(head.subtitle))]);
    head_html
        + &filled_template(template, &[("heading", heading.trim_end().to_owned())])
        + &filled_template(END_TEMPLATE, &of_end)
}

/// The template with every `{{name}}` replaced. The inserted text is not expanded again.
fn filled_template(template: &str, texts: &[(&str, String)]) -> String {
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
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::data::{Cues, LimitHistory, Rig, Run};
    use crate::report::encode::tests::decoded;
    use crate::report::simulator::Simulator;

    /// The smallest report that there can be: two samples of one run.
    fn smallest() -> Report {
        fn zeros<const N: usize>() -> [Vec<f64>; N] {
            std::array::from_fn(|_| vec![0.0; 2])
        }
        let cues = || Cues { specific_force: zeros(), angular_velocity: zeros() };
        let run = Run {
            name: "default".into(),
            times: vec![0.0, 0.1],
            desired: cues(),
            felt: cues(),
            position: zeros(),
            orientation: zeros(),
            legs: zeros(),
            tilt: zeros(),
            tilt_rate: zeros(),
            limited: LimitHistory {
                tilt: vec![false; 2],
                soft: vec![false; 2],
                safety: vec![false; 2],
                actuator: vec![false; 2],
                ..LimitHistory::default()
            },
            ..Run::default()
        };
        Report { rig: Rig { stroke: [1.0, 1.6], ..Rig::default() }, runs: vec![run], ..Report::default() }
    }

    /// The part of the page from after `start` to before `end`.
    fn between<'a>(page: &'a str, start: &str, end: &str) -> &'a str {
        let rest = page.split_once(start).expect(start).1;
        rest.split_once(end).expect(end).0
    }

    fn data(page: &str) -> serde_json::Value {
        let json = between(page, "<script type=\"application/json\" id=\"data\">", "</script>");
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn everything_is_in_the_page() {
        let page = html(&smallest());
        for outside in ["http:", "https:", "src=", "href=\"/", "@import", "url(", "import ", "fetch(", "XMLHttp"] {
            assert!(!page.contains(outside), "the page holds {outside}");
        }
        assert!(!page.contains("{{"));
        assert!(page.contains("default-src 'none'") && !page.contains("unsafe-inline"));
    }

    #[test]
    fn a_page_without_simulator_has_no_worker() {
        let mut report = smallest();
        assert!(data(&html(&report))["worker"].is_null());
        report.simulator = Some(Simulator { inputs: vec![vec![1.0]], ..Simulator::default() });
        let page = html(&report);
        assert!(data(&page)["worker"].as_str().unwrap().contains("WebAssembly"));
        assert_eq!(page.matches("</script>").count(), 3);
    }

    #[test]
    fn text_that_looks_like_markup_stays_text() {
        let hostile = "</script><b>\"&{{data}}\u{2028}";
        let mut report = smallest();
        report.title = hostile.into();
        report.runs[0].name = hostile.into();
        let page = html(&report);
        assert_eq!(between(&page, "<title>", "</title>"), "&lt;/script&gt;&lt;b&gt;&quot;&amp;{{data}}\u{2028}");
        assert_eq!(data(&page)["report"]["runs"][0]["name"], hostile);
        assert_eq!(page.matches("</script>").count(), 3);
    }

    #[test]
    fn numbers_travel_in_the_page_and_gaps_stay_gaps() {
        let mut report = smallest();
        report.runs[0].times = vec![0.25, 100_000.125];
        report.runs[0].legs[2] = vec![1.5, f64::NAN];
        let data = data(&html(&report));
        let run = &data["report"]["runs"][0];
        let times = decoded(&run["times"]);
        assert_eq!(times, [0.25, 100_000.125]);
        let leg = decoded(&run["legs"][2]);
        assert_eq!(leg[0], 1.5);
        assert!(leg[1].is_nan());
    }
}
