//! Draws the figures of `docs/motorcycle.md`: a ride, and the motorcycle's modes over speed.
//!
//!     cargo run --release -p moris-motorcycle --example figures -- docs

use std::error::Error;
use std::path::{Path, PathBuf};

use moris_motorcycle::{Input, Model, Motorcycle, Output, Parameters};
use plotters::coord::Shift;
use plotters::prelude::*;

/// A diagram: what it shows, what the axes say, and named curves.
struct Panel {
    title: &'static str,
    across: &'static str,
    curves: Vec<(&'static str, Vec<(f64, f64)>)>,
    /// Points rather than lines: for eigenvalues, which have no order.
    dotted: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("docs"), PathBuf::from);
    for (name, panels) in [("motorcycle-ride.svg", ride_panels()?), ("motorcycle-modes.svg", mode_panels()?)] {
        let path = directory.join(name);
        draw_picture(&path, &panels)?;
        println!("wrote {}", path.display());
    }
    Ok(())
}

/// Commands to the rider: accelerate, slalom, a long turn to the left, brake to a stop.
fn rider_command(time: f64) -> Input {
    let during = |begin: f64, end: f64| f64::from(time >= begin && time < end);
    let slalom = 15.0_f64.to_radians() * (2.0 * std::f64::consts::PI * 0.25 * (time - 8.0)).sin();
    Input {
        throttle: 0.4 * during(1.0, 6.5) + 0.09 * during(6.5, 26.0),
        brake: 0.6 * during(27.0, 60.0),
        lean: slalom * during(8.0, 16.0) - 30.0_f64.to_radians() * during(18.0, 24.0),
        ..Input::default()
    }
}

fn ride_panels() -> Result<Vec<Panel>, Box<dyn Error>> {
    let mut motorcycle = Motorcycle::new(&Parameters::default(), &Input::default())?;
    let mut recorded = Vec::new();
    for k in 0..36_000 {
        let time = f64::from(k) * 0.001;
        motorcycle.step(&rider_command(time), 0.001);
        if k % 50 == 49 {
            recorded.push((time + 0.001, rider_command(time), motorcycle.output()));
        }
    }
    let curve = |value: fn(&Input, &Output) -> f64| -> Vec<(f64, f64)> {
        recorded.iter().map(|(time, input, output)| (*time, value(input, output))).collect()
    };
    let across = "time [s]";
    let panel = |title, curves| Panel { title, across, curves, dotted: false };
    Ok(vec![
        panel("Speed [m/s]", vec![("speed", curve(|_, o| o.speed))]),
        panel(
            "Roll and pitch [deg]",
            vec![
                ("commanded roll", curve(|i, _| i.lean.to_degrees())),
                ("roll", curve(|_, o| o.orientation.roll.to_degrees())),
                ("pitch, nose down", curve(|_, o| o.orientation.pitch.to_degrees())),
            ],
        ),
        panel(
            "Specific force at the head, less 9.81 upwards [m/s²]",
            vec![
                ("forward", curve(|_, o| o.specific_force.x)),
                ("left", curve(|_, o| o.specific_force.y)),
                ("up", curve(|_, o| o.specific_force.z - 9.80665)),
            ],
        ),
        panel(
            "Bars",
            vec![
                ("torque [N m]", curve(|_, o| o.steer_torque)),
                ("10 × angle [deg]", curve(|_, o| 10.0 * o.steer_angle.to_degrees())),
            ],
        ),
    ])
}

fn mode_panels() -> Result<Vec<Panel>, Box<dyn Error>> {
    let motorcycle = Motorcycle::new(&Parameters::default(), &Input::default())?;
    let (mut free, mut ridden, mut frequencies) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..=50 {
        let speed = 1.2 * f64::from(k);
        for pole in motorcycle.lateral().state_matrix(speed, 0.0).complex_eigenvalues().iter() {
            if pole.re > -25.0 {
                free.push((speed, pole.re));
            }
            if pole.im > 0.1 {
                frequencies.push((speed, pole.im / (2.0 * std::f64::consts::PI)));
            }
        }
        let poles = motorcycle.rider().closed_loop(motorcycle.lateral(), speed).complex_eigenvalues();
        ridden.extend(poles.iter().filter(|pole| pole.re > -25.0).map(|pole| (speed, pole.re)));
    }
    let across = "speed [m/s]";
    let panel = |title, name, points| Panel { title, across, curves: vec![(name, points)], dotted: true };
    Ok(vec![
        panel("Eigenvalues' real parts, hands off and feet up [1/s]", "free", free),
        panel("Eigenvalues' frequencies, hands off and feet up [Hz]", "free", frequencies),
        panel("Eigenvalues' real parts with the rider [1/s]", "ridden", ridden),
    ])
}

fn draw_picture(path: &Path, panels: &[Panel]) -> Result<(), Box<dyn Error>> {
    // Drawn large, because coordinates are whole pixels; shown at about half its size.
    const PICTURE_WIDTH: u32 = 1600;
    const PANEL_HEIGHT: u32 = 330;
    let root = SVGBackend::new(path, (PICTURE_WIDTH, PANEL_HEIGHT * panels.len() as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    for (area, panel) in root.split_evenly((panels.len(), 1)).iter().zip(panels) {
        draw_panel(area, panel)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(area: &DrawingArea<SVGBackend, Shift>, panel: &Panel) -> Result<(), Box<dyn Error>> {
    const LABEL_FONT: (&str, i32) = ("sans-serif", 26);
    const GRID_COLOUR: RGBColor = RGBColor(222, 222, 222);
    const CURVE_COLOURS: [RGBColor; 3] = [RGBColor(31, 119, 180), RGBColor(214, 100, 20), RGBColor(60, 140, 60)];
    let points = || panel.curves.iter().flat_map(|(_, points)| points);
    let range = |value: fn(&(f64, f64)) -> f64| {
        points().map(value).fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)))
    };
    let ((left, right), (low, high)) = (range(|p| p.0), range(|p| p.1));
    let room = 0.08 * (high - low);
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, LABEL_FONT)
        .margin(12)
        .x_label_area_size(56)
        .y_label_area_size(80)
        .build_cartesian_2d(left..right, low - room..high + room)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .bold_line_style(GRID_COLOUR)
        .y_labels(6)
        .label_style(LABEL_FONT)
        .x_desc(panel.across)
        .draw()?;
    for ((name, points), colour) in panel.curves.iter().zip(CURVE_COLOURS) {
        if panel.dotted {
            chart.draw_series(points.iter().map(|&point| Circle::new(point, 4, colour.filled())))?;
        } else {
            chart
                .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(3)))?
                .label(*name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 30, y)], colour.stroke_width(3)));
        }
    }
    if panel.curves.len() > 1 {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .background_style(WHITE.mix(0.8))
            .label_font(LABEL_FONT)
            .draw()?;
    }
    Ok(())
}
