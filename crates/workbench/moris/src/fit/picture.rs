//! Curves of size against shape, as SVG.

use moris_analysis::fit::{Fitted, Strategy};
use moris_pages::report::escaped;
use moris_simulation::fit::Fit;
use moris_simulation::measures::shape::Shape;

const CURVE_COLOURS: [&str; 6] = ["#1f6fb4", "#c2571a", "#2c8c4a", "#8a4fb0", "#b03a5b", "#6b6b6b"];
/// Size of a panel and its margins \[px\].
const PANEL_SIZE: [f64; 2] = [360.0, 240.0];
const PANEL_MARGIN: [f64; 2] = [52.0, 44.0];
/// Panels beside each other.
const PANELS_PER_ROW: usize = 2;

/// A panel for each recording: the least shape of surge and sway over the size, a curve for each
/// strategy, with a dot at the fit.
pub fn svg(fitted: &[Fitted], strategies: &[Strategy]) -> String {
    let rows = fitted.len().div_ceil(PANELS_PER_ROW);
    let (width, height) = (
        PANELS_PER_ROW as f64 * (PANEL_SIZE[0] + PANEL_MARGIN[0]) + 24.0,
        rows as f64 * (PANEL_SIZE[1] + 2.0 * PANEL_MARGIN[1]) + 40.0,
    );
    let mut text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>"##
    );
    for (index, strategy) in strategies.iter().enumerate() {
        let x = PANEL_MARGIN[0] + 110.0 * index as f64;
        text += &format!(
            r#"<circle cx="{x}" cy="20" r="5" fill="{}"/><text x="{}" y="24">{}</text>"#,
            CURVE_COLOURS[index % CURVE_COLOURS.len()],
            x + 10.0,
            escaped(&strategy.name)
        );
    }
    for (index, recording) in fitted.iter().enumerate() {
        let (column, row) = (index % PANELS_PER_ROW, index / PANELS_PER_ROW);
        let origin = [
            PANEL_MARGIN[0] + column as f64 * (PANEL_SIZE[0] + PANEL_MARGIN[0]),
            40.0 + PANEL_MARGIN[1] * 0.6 + row as f64 * (PANEL_SIZE[1] + 2.0 * PANEL_MARGIN[1]),
        ];
        text += &panel(recording, origin);
    }
    text + "</svg>\n"
}

fn panel(recording: &Fitted, [left, top]: [f64; 2]) -> String {
    let at = |[size, shape]: [f64; 2]| {
        [left + PANEL_SIZE[0] * size.clamp(0.0, 1.0), top + PANEL_SIZE[1] * (1.0 - shape.clamp(0.0, 1.0))]
    };
    let mut text = format!(
        r##"<rect x="{left}" y="{top}" width="{}" height="{}" fill="none" stroke="#bbb"/><text x="{left}" y="{}" font-weight="bold">{}</text>"##,
        PANEL_SIZE[0],
        PANEL_SIZE[1],
        top - 6.0,
        escaped(&recording.name)
    );
    for tick in [0.0, 0.5, 1.0] {
        let ([x, bottom], [_, y]) = (at([tick, 0.0]), at([0.0, tick]));
        text += &format!(
            r#"<text x="{x}" y="{}" text-anchor="middle">{tick}</text><text x="{}" y="{}" text-anchor="end">{tick}</text>"#,
            bottom + 16.0,
            left - 6.0,
            y + 4.0
        );
    }
    let [middle, bottom] = at([0.5, 0.0]);
    text += &format!(r#"<text x="{middle}" y="{}" text-anchor="middle">size; up: shape</text>"#, bottom + 32.0);
    for (index, fit) in recording.fits.iter().enumerate() {
        let colour = CURVE_COLOURS[index % CURVE_COLOURS.len()];
        let points: Vec<String> = fit
            .curve
            .iter()
            .filter_map(|candidate| point(&candidate.shape))
            .map(at)
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        text += &format!(r#"<polyline points="{}" fill="none" stroke="{colour}"/>"#, points.join(" "));
        text += &dot(fit, at, colour, index == recording.winner);
    }
    text
}

fn dot(fit: &Fit, at: impl Fn([f64; 2]) -> [f64; 2], colour: &str, wins: bool) -> String {
    point(&fit.best.shape).map(at).map_or_else(String::new, |[x, y]| {
        let radius = if wins { 6 } else { 4 };
        format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="{radius}" fill="{colour}"/>"#)
    })
}

fn point(shape: &Shape) -> Option<[f64; 2]> {
    Some([shape.size()?, shape.least_shape()?])
}
