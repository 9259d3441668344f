//! The responses as pictures: modulus over phase, as in a Bode diagram.

use std::path::Path;

use anyhow::Result;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
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
    let measured = || test.iter().chain(&small).map(|response| modulus(response, output));
    let bounds = || limits.iter().flat_map(|limit| limit.modulus).flatten();
    let values = || measured().chain(bounds()).map(|value| value.max(MIN_MODULUS));
    let low = 10_f64.powf(values().fold(0.1, f64::min).log10().floor());
    let high = 10_f64.powf(values().fold(1.1, f64::max).log10().ceil());
    let mut builder = ChartBuilder::on(&above);
    builder.caption(title, (FONT_FAMILY, 22).into_font().color(&TEXT_COLOUR)).x_label_area_size(12);
    let diagram = Diagram { test: &test, small: &small, limits: &limits, output, below: false, ends: [low, high] };
    diagram.draw(&mut builder, (low..high).log_scale(), modulus, |limit| limit.modulus)?;
    let mut builder = ChartBuilder::on(&below);
    builder.margin_bottom(8).x_label_area_size(52);
    let diagram = Diagram { below: true, ends: [-180.0, 180.0], ..diagram };
    diagram.draw(&mut builder, -190.0..190.0, phase, |limit| limit.phase)
}

/// The modulus, or the phase below it, of one pair of channels.
struct Diagram<'a> {
    test: &'a [Response],
    small: &'a [Response],
    limits: &'a [&'a Limit],
    output: Channel,
    /// True for the panel of the phase, which shows the frequencies.
    below: bool,
    /// Ends of bounds that are open.
    ends: [f64; 2],
}

impl Diagram<'_> {
    /// Draws bounds as bars at their frequencies, the small signals as a line, and the test's as a
    /// line with dots, but nothing of what cannot be felt.
    fn draw<'b, Y: AsRangedCoord<Value = f64>>(
        &self,
        builder: &mut ChartBuilder<'_, 'b, SVGBackend<'b>>,
        range: Y,
        value: fn(&Response, Channel) -> f64,
        bound: fn(&Limit) -> [Option<f64>; 2],
    ) -> Result<()>
    where
        Y::CoordDescType: ValueFormatter<f64>,
    {
        const LIMIT_COLOUR: RGBColor = RGBColor(208, 222, 205);
        let Diagram { test, small, limits, output, below, ends } = *self;
        builder.margin_right(24).y_label_area_size(74);
        let mut chart = builder.build_cartesian_2d(SHOWN_FREQUENCIES.log_scale(), range)?;
        let mut mesh = chart.configure_mesh();
        if below {
            mesh.x_desc("frequency [rad/s]");
        }
        mesh.x_label_formatter(&|value| if below { axis_number(*value) } else { String::new() })
            .y_label_formatter(&|value| axis_number(*value))
            .y_desc(if below { "phase [°]" } else { "modulus" })
            .bold_line_style(GRID_COLOUR)
            .light_line_style(TRANSPARENT)
            .axis_style(TEXT_COLOUR)
            .label_style((FONT_FAMILY, 17).into_font().color(&TEXT_COLOUR))
            .draw()?;
        for limit in limits.iter().filter(|limit| bound(limit) != [None; 2]) {
            let [low, high] = bound(limit);
            let [low, high] = [low.unwrap_or(ends[0]), high.unwrap_or(ends[1])].map(|end| end.clamp(ends[0], ends[1]));
            let bar = [(limit.frequency, low), (limit.frequency, high)];
            chart.draw_series(LineSeries::new(bar, LIMIT_COLOUR.stroke_width(12)))?;
        }
        let felt = |response: &&Response| modulus(response, output) > MIN_MODULUS;
        let point = |response: &Response| (response.frequency, value(response, output));
        // Between two neighbours that seem to be more than half a turn apart, the phase has passed 180 degrees.
        let is_near = |one: &(f64, f64), next: &(f64, f64)| !below || (one.1 - next.1).abs() <= 180.0;
        for (responses, style) in [(small, SMALL_SIGNAL_COLOUR.stroke_width(3)), (test, TEST_COLOUR.stroke_width(2))] {
            let points: Vec<(f64, f64)> = responses.iter().filter(felt).map(point).collect();
            for part in points.chunk_by(is_near) {
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
}

fn axis_number(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "−")
}
