//! The page.

use crate::check::{Unusable, check};
use crate::data::Report;

/// The whole page as HTML.
///
/// # Errors
/// The data do not fit together: see [`check`].
///
/// # Panics
/// Never: plain data always serialise.
pub fn html(report: &Report) -> Result<String, Unusable> {
    check(report)?;
    let data = serde_json::to_string(report).expect("plain data serialise").replace('<', "\\u003c");
    Ok(format!("<!doctype html>\n<script type=\"application/json\" id=\"data\">{data}</script>\n"))
}
