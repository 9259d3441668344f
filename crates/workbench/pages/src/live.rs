//! The page of a live session: a template with the style, the scripts and the data put in.

use serde::Serialize;

use crate::report::shared;
use crate::ride::page::MOTION_STYLE;

/// The whole page as HTML, with the data of its start. The page asks its own server alone.
///
/// # Panics
/// Never: plain data always serialise.
pub fn html(subtitle: &str, data: &impl Serialize) -> String {
    const PAGE_TEMPLATE: &str = include_str!("../page/live/live.html");
    const PAGE_STYLE: &str = include_str!("../page/live/live.css");
    const ENTRY_MODULE: &str = "live/live.js";
    let style = [MOTION_STYLE, PAGE_STYLE].join("\n");
    let policy = "connect-src 'self'";
    let head = shared::Head { title: "Live", subtitle, style: &style, scripts: "", policy };
    shared::assembled(&head, PAGE_TEMPLATE, data, ENTRY_MODULE)
}
