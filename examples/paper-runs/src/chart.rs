//! Draws curves over time into an SVG file.
//!
//! The coordinates of a drawing are whole pixels. So the canvas and its text are large: at half
//! size, about the width of a page, the curves are smooth.

use std::ops::Range;
use std::path::Path;

use anyhow::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::thin::thin;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const LABEL_FONT: &str = "sans-serif";
const FONT_SIZE: i32 = 26;
const TEXT_COLOUR: RGBColor = RGBColor(40, 40, 40);
const LIMIT_COLOUR: RGBColor = RGBColor(190, 30, 45);

/// Fraction of a panel's height reserved for its legend, above the curves.
const LEGEND_HEIGHT: f64 = 0.16;

/// A diagram of curves over time.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Title above the diagram.
    pub title: String,
    /// Label of the vertical axis.
    pub quantity: &'static str,
    pub curves: Vec<Curve>,
    /// Limits of the curves, drawn as lines.
    pub limits: Vec<f64>,
    /// Start of a second that is drawn enlarged beside the whole \[s\].
    pub enlarged: Option<f64>,
}

/// One curve of a diagram.
#[derive(Clone, Debug)]
pub struct Curve {
    pub label: String,
    pub colour: RGBColor,
    pub stroke: Stroke,
    /// Time \[s\] and value, in the order of time.
    pub points: Vec<(f64, f64)>,
}

/// Style of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Wide enough to be seen on both sides of a fine curve on top of it.
    Broad,
    Fine,
    /// Shows a coincident curve below it through the gaps.
    Dashed,
}

impl Stroke {
    fn width(self) -> u32 {
        match self {
            Stroke::Broad => 6,
            Stroke::Fine | Stroke::Dashed => 3,
        }
    }
}

/// Draws the panels one below the other, each `panel_height` pixels high.
///
/// # Errors
/// The file cannot be written.
pub fn draw(path: &Path, panels: &[Panel], panel_height: u32) -> Result<()> {
    const PICTURE_WIDTH: u32 = 1600;
    let root = SVGBackend::new(path, (PICTURE_WIDTH, panel_height * panels.len() as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    for (area, panel) in root.split_evenly((panels.len(), 1)).iter().zip(panels) {
        draw_panel(area, panel)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(area: &Area, panel: &Panel) -> Result<()> {
    // Fraction of a panel's width for the whole, where a second is enlarged beside it.
    const WHOLE_WIDTH_FRACTION: f64 = 0.72;
    let end = panel.curves.iter().filter_map(|curve| curve.points.last()).map(|point| point.0).fold(0.0, f64::max);
    let Some(from) = panel.enlarged else {
        return draw_diagram(area, panel, 0.0..end);
    };
    let (whole, second) = area.split_horizontally((100.0 * WHOLE_WIDTH_FRACTION).percent_width());
    draw_diagram(&whole, panel, 0.0..end)?;
    let part = |curve: &Curve| Curve { points: points_within(&curve.points, from, from + 1.0), ..curve.clone() };
    let curves = panel.curves.iter().map(part).collect();
    let title = "The roughest second".to_owned();
    draw_diagram(&second, &Panel { title, curves, enlarged: None, ..panel.clone() }, from..from + 1.0)
}

fn points_within(points: &[(f64, f64)], from: f64, to: f64) -> Vec<(f64, f64)> {
    points.iter().copied().filter(|&(time, _)| from <= time && time <= to).collect()
}

fn draw_diagram(area: &Area, panel: &Panel, times: Range<f64>) -> Result<()> {
    const GRID_COLOUR: RGBColor = RGBColor(222, 222, 222);
    // Background of the second that is enlarged.
    const ENLARGED_COLOUR: RGBColor = RGBColor(238, 238, 238);
    // Largest error of a drawn curve, as a fraction of the panel's height: about a fifth of a
    // pixel.
    const CURVE_TOLERANCE: f64 = 0.0005;
    let (bottom, top) = vertical_range(panel);
    let Range { start, end } = times;
    let is_part = start > 0.0;
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, (LABEL_FONT, FONT_SIZE + 4).into_font().color(&TEXT_COLOUR))
        .margin(14)
        .margin_right(40)
        .x_label_area_size(74)
        .y_label_area_size(if is_part { 70 } else { 116 })
        .build_cartesian_2d(start..end, bottom..top)?;
    if let Some(from) = panel.enlarged {
        chart.draw_series([Rectangle::new([(from, bottom), (from + 1.0, top)], ENLARGED_COLOUR.filled())])?;
    }
    chart
        .configure_mesh()
        .x_desc("time [s]")
        .y_desc(if is_part { "" } else { panel.quantity })
        .x_labels(if is_part { 5 } else { 12 })
        .y_labels(7)
        .x_label_formatter(&|value| tick_label(*value))
        .y_label_formatter(&|value| tick_label(*value))
        .bold_line_style(GRID_COLOUR)
        .light_line_style(TRANSPARENT)
        .axis_style(TEXT_COLOUR)
        .label_style((LABEL_FONT, FONT_SIZE - 2).into_font().color(&TEXT_COLOUR))
        .axis_desc_style((LABEL_FONT, FONT_SIZE).into_font().color(&TEXT_COLOUR))
        .draw()?;
    for &limit in &panel.limits {
        let line = [(start, limit), (end, limit)];
        chart.draw_series(DashedLineSeries::new(line, 18, 10, LIMIT_COLOUR.stroke_width(3)))?;
    }
    for curve in in_drawing_order(&panel.curves) {
        let points = thin(&curve.points, CURVE_TOLERANCE * (top - bottom));
        let style = curve.colour.stroke_width(curve.stroke.width());
        if curve.stroke == Stroke::Dashed {
            chart.draw_series(DashedLineSeries::new(points, 16, 16, style))?;
        } else {
            chart.draw_series(LineSeries::new(points, style))?;
        }
    }
    if is_part {
        // The legend stands beside it.
        return Ok(());
    }
    draw_legend(&chart.plotting_area().strip_coord_spec(), panel)
}

/// Dashed curves last, on top of the others.
fn in_drawing_order(curves: &[Curve]) -> impl Iterator<Item = &Curve> {
    let is_dashed = |curve: &&Curve| curve.stroke == Stroke::Dashed;
    curves.iter().filter(move |curve| !is_dashed(curve)).chain(curves.iter().filter(is_dashed))
}

/// From the lowest value to the highest, with a margin, and space for the legend above.
fn vertical_range(panel: &Panel) -> (f64, f64) {
    let values =
        || panel.curves.iter().flat_map(|curve| &curve.points).map(|point| point.1).chain(panel.limits.clone());
    let lowest = values().fold(f64::INFINITY, f64::min);
    let highest = values().fold(f64::NEG_INFINITY, f64::max);
    let height = (highest - lowest).max(0.1);
    (lowest - 0.06 * height, highest + (0.06 + 1.12 * LEGEND_HEIGHT / (1.0 - LEGEND_HEIGHT)) * height)
}

/// The curves' labels in one row at the top of the plotting area.
fn draw_legend(area: &Area, panel: &Panel) -> Result<()> {
    const GAP: i32 = 12;
    let (sample, next) = if panel.enlarged.is_some() { (28, 14) } else { (56, 36) };
    let y = (LEGEND_HEIGHT * f64::from(area.dim_in_pixel().1) / 2.0) as i32;
    let text = (LABEL_FONT, FONT_SIZE - 2).into_font().color(&TEXT_COLOUR);
    let mut x = 24;
    for (label, colour, stroke) in legend_entries(panel) {
        let dashes = if stroke == Stroke::Dashed { vec![(0, 16), (20, 36), (40, 56)] } else { vec![(0, sample)] };
        for (from, to) in dashes {
            area.draw(&PathElement::new([(x + from, y), (x + to, y)], colour.stroke_width(stroke.width())))?;
        }
        x += sample + GAP;
        area.draw(&Text::new(label, (x, y - FONT_SIZE / 2 + 2), text.clone()))?;
        x += label.chars().count() as i32 * FONT_SIZE * 11 / 20 + next;
    }
    Ok(())
}

fn legend_entries(panel: &Panel) -> Vec<(&str, RGBColor, Stroke)> {
    let curves = panel.curves.iter().map(|curve| (curve.label.as_str(), curve.colour, curve.stroke));
    let limits = panel.limits.first().map(|_| ("limits", LIMIT_COLOUR, Stroke::Dashed));
    curves.chain(limits).collect()
}

/// A tick's label, without trailing zeros, with a true minus sign.
fn tick_label(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_short() {
        assert_eq!(tick_label(-0.0001), "0");
        assert_eq!(tick_label(1.250), "1.25");
        assert_eq!(tick_label(-10.0), "−10");
    }

    #[test]
    fn the_legend_has_its_share_of_the_height_to_itself() {
        let curve =
            Curve { label: "felt".into(), colour: BLACK, stroke: Stroke::Fine, points: vec![(0.0, -1.0), (1.0, 3.0)] };
        let panel =
            Panel { title: String::new(), quantity: "", curves: vec![curve], limits: vec![4.0], enlarged: None };
        let (bottom, top) = vertical_range(&panel);
        assert!(bottom < -1.0);
        assert!((top - 4.0) / (top - bottom) > LEGEND_HEIGHT);
    }
}
