//! The page: a template with the style, the scripts, the module and the data put in.

use crate::report::{Parameter, Rig, shared};
use serde::Serialize;

/// The style of a page with curves, a platform and lamps.
pub(crate) const MOTION_STYLE: &str = include_str!("../../page/shared/motion.css");

/// The WebAssembly of the ride, `modules/ride.rs`; empty where it was not compiled.
pub const RIDE_MODULE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/page_ride.wasm"));

/// Parts of the page.
#[derive(Clone, Debug, Serialize)]
pub struct Page {
    /// One line below the heading.
    pub subtitle: String,
    /// The compiled WebAssembly.
    #[serde(serialize_with = "shared::bytes")]
    pub module: Vec<u8>,
    pub rig: Rig,
    /// Slot by slot of the washout's parameters.
    pub parameters: Vec<Parameter>,
    /// Half the width of the road \[m\].
    pub half_width: f64,
}

/// The whole page as HTML, which needs no network and no other file.
///
/// # Panics
/// Never: plain data always serialise.
pub fn html(page: &Page) -> String {
    const PAGE_TEMPLATE: &str = include_str!("../../page/ride/ride.html");
    const ENTRY_MODULE: &str = "ride/main.js";
    let head = shared::Head {
        title: "Ride",
        subtitle: &page.subtitle,
        style: MOTION_STYLE,
        scripts: shared::WEBASSEMBLY_SOURCE,
        policy: "",
    };
    shared::assembled(&head, PAGE_TEMPLATE, page, ENTRY_MODULE)
}
