//! The responses as pictures: modulus over phase, as in a Bode diagram.

use std::path::Path;

use anyhow::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

use moris_analysis::frequency_response::limits::Limit;
use moris_simulation::capitalised;
use moris_simulation::frequency_response::Response;
use moris_simulation::frequency_response::channel::{Channel, name, ratio_unit};

use super::Measured;
use super::table::{modulus, phase};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const FONT_FAMILY: &str = "sans-serif";
const TEXT_COLOUR: RGBColor = RGBColor(40, 46, 56);
const GRID_COLOUR: RGBColor = RGBColor(226, 229, 233);
const TEST_COLOUR: RGBColor = RGBColor(0, 114, 178);
const SMALL_SIGNAL_COLOUR: RGBColor = RGBColor(213, 94, 0);
const LIMITED_COLOUR: RGBColor = RGBColor(255, 255, 255);

/// The frequencies shown \[rad/s\].
const SHOWN_FREQUENCIES: std::ops::Range<f64> = 0.08..20.0;
/// Least modulus drawn. A smaller one is not felt, and its phase has no meaning.
const MIN_MODULUS: f64 = 1e-3;

/// Draws the felt motion on the outputs of these pairs of channels, side by side in columns, with
/// bounds as bars behind it.
///
/// # Errors
/// The file cannot be written.
pub fn draw(
    file: &Path,
    measured: &Measured,
    limits: &[Limit],
    pairs: &[(Channel, Channel)],
    columns: usize,
) -> Result<()> {
    // Size of one diagram: modulus, and phase below it.
    const DIAGRAM_SIZE: (u32, u32) = (600, 560);
    const HEAD_HEIGHT: u32 = 44;
    let rows = pairs.len().div_ceil(columns);
    let size = (DIAGRAM_SIZE.0 * columns as u32, DIAGRAM_SIZE.1 * rows as u32 + HEAD_HEIGHT);
    let root = SVGBackend::new(file, size).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, body) = root.split_vertically(HEAD_HEIGHT);
    draw_key(&head)?;
    for (area, &pair) in body.split_evenly((rows, columns)).iter().zip(pairs) {
        draw_pair(area, measured, limits, pair)?;
    }
    root.present()?;
    Ok(())
}

/// Legend of lines and dots.
fn draw_key(area: &Area) -> Result<()> {
    let style = (FONT_FAMILY, 20).into_font().color(&TEXT_COLOUR);
    let mut x = 70;
    for (colour, dot, text, width) in [
        (TEST_COLOUR, Some(TEST_COLOUR), "with the test's amplitude", 300),
        (TEST_COLOUR, Some(LIMITED_COLOUR), "with a limit active", 310),
        (SMALL_SIGNAL_COLOUR, None, "small signal", 0),
    ] {
        area.draw(&PathElement::new([(x, 26), (x + 40, 26)], colour.stroke_width(3)))?;
        if let Some(filled) = dot {
            area.draw(&Circle::new((x + 20, 26), 6, filled.filled()))?;
            area.draw(&Circle::new((x + 20, 26), 6, colour.stroke_width(2)))?;
        }
        area.draw(&Text::new(text, (x + 52, 16), style.clone()))?;
        x += 52 + width;
    }
    Ok(())
}

fn draw_pair(area: &Area, measured: &Measured, limits: &[Limit], (input, output): (Channel, Channel)) -> Result<()> {
    const MODULUS_HEIGHT: u32 = 310;
    let limits: Vec<&Limit> = limits.iter().filter(|limit| limit.input == input && limit.output == output).collect();
    let of = |responses: &[Response]| -> Vec<Response> {
        responses.iter().filter(|response| response.input == input).cloned().collect()
    };
    let (test, small) = (of(&measured.test), of(&measured.small));
    let title = match input == output {
        true => capitalised(name(input)),
        false => format!("{} to {}", capitalised(name(input)), name(output)),
    };
    let unit = ratio_unit(input, output);
    let title = if unit.is_empty() { title } else { format!("{title}, {unit}") };
    let (above, below) = area.split_vertically(MODULUS_HEIGHT);
    draw_modulus(&above, &title, [&test, &small], &limits, output)?;
    draw_phase(&below, [&test, &small], &limits, output)
}

fn draw_modulus(
    area: &Area,
    title: &str,
    [test, small]: [&[Response]; 2],
    limits: &[&Limit],
    output: Channel,
) -> Result<()> {
    let bounds = || limits.iter().flat_map(|limit| limit.modulus).flatten();
    let measured = || test.iter().chain(small).map(|response| modulus(response, output));
    let values = || measured().chain(bounds()).map(|value| value.max(MIN_MODULUS));
    let low = 10_f64.powf(values().fold(0.1, f64::min).log10().floor());
    let high = 10_f64.powf(values().fold(1.1, f64::max).log10().ceil());
    let mut chart = ChartBuilder::on(area)
        .caption(title, (FONT_FAMILY, 22).into_font().color(&TEXT_COLOUR))
        .margin_right(24)
        .x_label_area_size(12)
        .y_label_area_size(74)
        .build_cartesian_2d(SHOWN_FREQUENCIES.log_scale(), (low..high).log_scale())?;
    chart
        .configure_mesh()
        .x_label_formatter(&|_| String::new())
        .y_label_formatter(&|value| axis_number(*value))
        .y_desc("modulus")
        .bold_line_style(GRID_COLOUR)
        .light_line_style(TRANSPARENT)
        .axis_style(TEXT_COLOUR)
        .label_style((FONT_FAMILY, 17).into_font().color(&TEXT_COLOUR))
        .draw()?;
    draw_limits(&mut chart, limits, |limit| limit.modulus, [low, high])?;
    draw_curves(&mut chart, test, small, output, |response| modulus(response, output), |_, _| false)
}

fn draw_phase(area: &Area, [test, small]: [&[Response]; 2], limits: &[&Limit], output: Channel) -> Result<()> {
    let mut chart = ChartBuilder::on(area)
        .margin_right(24)
        .margin_bottom(8)
        .x_label_area_size(52)
        .y_label_area_size(74)
        .build_cartesian_2d(SHOWN_FREQUENCIES.log_scale(), -190.0..190.0)?;
    chart
        .configure_mesh()
        .x_desc("frequency [rad/s]")
        .y_desc("phase [°]")
        .x_label_formatter(&|value| axis_number(*value))
        .y_label_formatter(&|value| format!("{value:.0}").replace('-', "−"))
        .bold_line_style(GRID_COLOUR)
        .light_line_style(TRANSPARENT)
        .axis_style(TEXT_COLOUR)
        .label_style((FONT_FAMILY, 17).into_font().color(&TEXT_COLOUR))
        .draw()?;
    draw_limits(&mut chart, limits, |limit| limit.phase, [-180.0, 180.0])?;
    // Between two neighbours that seem to be more than half a turn apart, the phase has passed 180 degrees.
    draw_curves(&mut chart, test, small, output, |response| phase(response, output), |a, b| (a - b).abs() > 180.0)
}

/// Bounds as bars at their frequencies, open ones up to the end of the axis.
fn draw_limits<'a, C>(
    chart: &mut ChartContext<'a, SVGBackend<'a>, C>,
    limits: &[&Limit],
    of: impl Fn(&Limit) -> [Option<f64>; 2],
    ends: [f64; 2],
) -> Result<()>
where
    C: CoordTranslate<From = (f64, f64)>,
{
    const LIMIT_COLOUR: RGBColor = RGBColor(208, 222, 205);
    for limit in limits.iter().filter(|limit| of(limit) != [None; 2]) {
        let [low, high] = of(limit);
        let [low, high] = [low.unwrap_or(ends[0]), high.unwrap_or(ends[1])].map(|end| end.clamp(ends[0], ends[1]));
        let bar = [(limit.frequency, low), (limit.frequency, high)];
        chart.draw_series(LineSeries::new(bar, LIMIT_COLOUR.stroke_width(12)))?;
    }
    Ok(())
}

/// The small signals as a line, the test's as a line with dots; no line is drawn over a `gap`
/// between neighbours, and nothing of what cannot be felt.
fn draw_curves<'a, C>(
    chart: &mut ChartContext<'a, SVGBackend<'a>, C>,
    test: &[Response],
    small: &[Response],
    output: Channel,
    value: impl Fn(&Response) -> f64,
    gap: impl Fn(f64, f64) -> bool,
) -> Result<()>
where
    C: CoordTranslate<From = (f64, f64)>,
{
    let felt = |response: &&Response| modulus(response, output) > MIN_MODULUS;
    let point = |response: &Response| (response.frequency, value(response));
    for (responses, style) in [(small, SMALL_SIGNAL_COLOUR.stroke_width(3)), (test, TEST_COLOUR.stroke_width(2))] {
        let points: Vec<(f64, f64)> = responses.iter().filter(felt).map(point).collect();
        for part in points.chunk_by(|a, b| !gap(a.1, b.1)) {
            chart.draw_series(LineSeries::new(part.iter().copied(), style))?;
        }
    }
    let dots = |style: fn(&Response) -> ShapeStyle| {
        test.iter().filter(felt).map(move |response| Circle::new(point(response), 5, style(response)))
    };
    // A measurement is hollow where something limited.
    chart.draw_series(dots(|response| {
        let is_limited = response.limited.iter().any(|&fraction| fraction > 0.0);
        if is_limited { LIMITED_COLOUR } else { TEST_COLOUR }.filled()
    }))?;
    chart.draw_series(dots(|_| TEST_COLOUR.stroke_width(2)))?;
    Ok(())
}

fn axis_number(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
