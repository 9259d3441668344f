//! Curves of size against shape, as SVG.

use anyhow::{Result, anyhow};
use moris_analysis::fit::{Fitted, Strategy};
use moris_simulation::measures::shape::Shape;
use plotters::coord::Shift;
use plotters::prelude::*;

const CURVE_COLOURS: [RGBColor; 6] = [
    RGBColor(31, 111, 180),
    RGBColor(194, 87, 26),
    RGBColor(44, 140, 74),
    RGBColor(138, 79, 176),
    RGBColor(176, 58, 91),
    RGBColor(107, 107, 107),
];
const FONT_FAMILY: &str = "sans-serif";

/// A panel for each recording: the least shape of surge and sway over the size, a curve for each
/// strategy. A dot is at the fit, a larger one at the winner's.
///
/// # Errors
/// The text cannot be drawn.
pub fn svg(fitted: &[Fitted], strategies: &[Strategy]) -> Result<String> {
    // Size of a panel, and height of the legend [px].
    const PANEL_SIZE: (u32, u32) = (420, 320);
    const LEGEND_HEIGHT: u32 = 40;
    // Panels beside each other.
    const PANELS_PER_ROW: usize = 2;
    let rows = fitted.len().div_ceil(PANELS_PER_ROW);
    let size = (PANELS_PER_ROW as u32 * PANEL_SIZE.0, rows as u32 * PANEL_SIZE.1 + LEGEND_HEIGHT);
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
    root.fill(&WHITE)?;
    let (legend, body) = root.split_vertically(LEGEND_HEIGHT);
    for (index, strategy) in strategies.iter().enumerate() {
        let x = 52 + 120 * index as i32;
        legend.draw(&Circle::new((x, 20), 5, curve_colour(index).filled()))?;
        legend.draw(&Text::new(strategy.name.clone(), (x + 10, 13), (FONT_FAMILY, 15)))?;
    }
    for (recording, area) in fitted.iter().zip(body.split_evenly((rows, PANELS_PER_ROW))) {
        draw_panel(recording, &area).map_err(|error| anyhow!("{}: {error}", recording.name))?;
    }
    root.present()?;
    drop((root, legend, body));
    Ok(text)
}

fn draw_panel(recording: &Fitted, area: &DrawingArea<SVGBackend, Shift>) -> Result<()> {
    let mut chart = ChartBuilder::on(area)
        .caption(&recording.name, (FONT_FAMILY, 16))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(44)
        .build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
    chart.configure_mesh().x_labels(3).y_labels(3).x_desc("size").y_desc("shape").disable_mesh().draw()?;
    for (index, fit) in recording.fits.iter().enumerate() {
        let points = fit.curve.iter().filter_map(|candidate| panel_point(&candidate.shape));
        chart.draw_series(LineSeries::new(points, curve_colour(index)))?;
        let radius = if index == recording.winner { 6 } else { 4 };
        let best = panel_point(&fit.best.shape).map(|best| Circle::new(best, radius, curve_colour(index).filled()));
        chart.draw_series(best)?;
    }
    Ok(())
}

fn curve_colour(index: usize) -> RGBColor {
    CURVE_COLOURS[index % CURVE_COLOURS.len()]
}

/// Size and least shape within the panel.
fn panel_point(shape: &Shape) -> Option<(f64, f64)> {
    Some((shape.size()?.clamp(0.0, 1.0), shape.least_shape()?.clamp(0.0, 1.0)))
}
